// Motion of single particles in vectors of four numbers, which every processor has.
#include "common/float4.h"

enum { LANES = 4 };
typedef Float4 Lanes;

static inline Lanes lanes_all(float a) { return float4_all(a); }
static inline Lanes lanes_load(const float *p) { return float4_load(p); }
static inline void lanes_store(float *p, Lanes a) { float4_store(p, a); }
static inline Lanes lanes_quadruple(const float p[4]) { return float4_load(p); }
static inline Lanes lanes_fourths(Lanes a) { return FLOAT4_SHUFFLE(a, a, 3, 3, 3, 3); }
static inline Lanes lanes_sums(Lanes a) {
    return FLOAT4_SHUFFLE(a, a, 0, 0, 0, 0) + FLOAT4_SHUFFLE(a, a, 1, 1, 1, 1) + FLOAT4_SHUFFLE(a, a, 2, 2, 2, 2);
}
static inline Lanes lanes_abs(Lanes a) { return (Lanes)((Float4Mask)a & INT32_MAX); }
static inline Lanes lanes_with_fourth(Lanes a, Lanes fourth) {
    return float4_select((Float4Mask){-1, -1, -1, 0}, a, fourth);
}
static inline Lanes lanes_where_less(Lanes a, Lanes b, Lanes yes, Lanes no) { return float4_select(a < b, yes, no); }

#define MOVE_RANGE move_range_four
#include "dynamics/move_kernel.h"
