// Motion of single particles and internal friction in vectors of four numbers, which every processor has.
#include "dynamics/strand/strand_four.h"

static inline Lanes lanes_quadruple(const float p[4]) { return float4_load(p); }
static inline Lanes lanes_fourths(Lanes a) { return FLOAT4_SHUFFLE(a, a, 3, 3, 3, 3); }
static inline Lanes lanes_sums(Lanes a) {
    return FLOAT4_SHUFFLE(a, a, 0, 0, 0, 0) + FLOAT4_SHUFFLE(a, a, 1, 1, 1, 1) + FLOAT4_SHUFFLE(a, a, 2, 2, 2, 2);
}
static inline Lanes lanes_abs(Lanes a) { return (Lanes)((Float4Mask)a & INT32_MAX); }
static inline Lanes lanes_with_fourth(Lanes a, Lanes fourth) {
    return float4_select((Float4Mask){-1, -1, -1, 0}, a, fourth);
}

#define LANES_SPREAD(a, e) FLOAT4_SHUFFLE(a, a, e, e, e, e)
#define FLOAT4S_SET(float4s, e, value) (float4s).at[e] = (value)
#define MOVE_RANGE move_range_four
#define UNIT_RANGE unit_range_four
#define HEIGHT_RANGE height_range_four
#define PLANE_RANGE plane_range_four
#include "dynamics/height_kernel.h"
#include "dynamics/plane_kernel.h"
#include "dynamics/move_kernel.h"

#define SMOOTH_GROUP smooth_group_four
#include "dynamics/smooth_kernel.h"
