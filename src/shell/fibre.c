// Directions of the springs relative to the fibres. A fibre runs at `fibre_angle` phi from e1, the direction of
// increasing u in the cell's tangent plane (its first side if the uv are degenerate), towards e2 = n x e1. A spring
// along d has
//
//   grain = [(x^2 - y^2) cos 2 phi + 2 x y sin 2 phi] / |d|^2,   x = d . e1,   y = d . e2
//
// which is cos 2(angle to the fibres) in the plane of the sheet, and less for a spring out of the plane. A spring of
// two cells has the mean of both.
#include "common/assertion.h"
#include "common/real.h"
#include "shell/fibre.h"

#include "common/float3.h"

#include <math.h>

typedef struct FibreFrame {
    Float3 e1, e2;
    float cosine, sine; ///< of 2 phi
} FibreFrame;

/// The direction in which u grows and v is constant; the first side if there is none.
static Float3 fibre_along_u(const Shell *shell, uint32_t cell, Float3 a, Float3 b) {
    SINGE_ASSERT(cell < shell->cell_count);
    const uint32_t *corner = shell->cells[cell];
    float da[2], db[2];
    for (int k = 0; k < 2; k++) {
        da[k] = shell_corner_uv(shell, cell, 2)[k] - shell_corner_uv(shell, cell, 0)[k];
        db[k] = shell_corner_uv(shell, cell, 3)[k] - shell_corner_uv(shell, cell, 1)[k];
    }
    float turn = da[0] * db[1] - db[0] * da[1];
    if (turn == 0)
        return float3_sub(float3_load(shell->rest_position[corner[1]]), float3_load(shell->rest_position[corner[0]]));
    Float3 along = float3_sub(float3_scale(a, db[1]), float3_scale(b, da[1]));
    return turn > 0 ? along : float3_scale(along, -1);
}

static FibreFrame fibre_frame(const Shell *shell, uint32_t cell) {
    SINGE_ASSERT(cell < shell->cell_count);
    const uint32_t *corner = shell->cells[cell];
    Float3 p[4];
    for (int i = 0; i < 4; i++) p[i] = float3_load(shell->rest_position[corner[i]]);
    Float3 a = float3_sub(p[2], p[0]), b = float3_sub(p[3], p[1]), normal = float3_unit(float3_cross(a, b));
    Float3 along = fibre_along_u(shell, cell, a, b);
    Float3 e1 = float3_unit(float3_mad(along, normal, -float3_dot(along, normal)));
    float angle = field_at(shell->matter.fibre_angle, shell_centre(shell, cell));
    return (FibreFrame){e1, float3_cross(normal, e1), real_cosf(2 * angle), real_sinf(2 * angle)};
}

/// Adds `share` of a spring's grain in a cell's frame.
static void fibre_add(Shell *shell, const FibreFrame *frame, SingeColour colour, uint32_t spring, float share) {
    SINGE_ASSERT((unsigned)colour < SINGE_COLOUR_COUNT);
    SINGE_ASSERT(spring < shell->springs[colour].count);
    SpringSet *set = &shell->springs[colour];
    const uint32_t *ends = set->ends[spring];
    Float3 d = float3_sub(float3_load(shell->rest_position[ends[1]]), float3_load(shell->rest_position[ends[0]]));
    float x = float3_dot(d, frame->e1), y = float3_dot(d, frame->e2), square = float3_dot(d, d);
    set->grain[spring] += share * ((x * x - y * y) * frame->cosine + 2 * x * y * frame->sine) / square;
}

static void fibre_cell(Shell *shell, uint32_t cell) {
    SINGE_ASSERT(cell < shell->cell_count);
    const CellSprings *springs = &shell->cell_springs[cell];
    FibreFrame frame = fibre_frame(shell, cell);
    for (int i = 0; i < 4; i++) {
        bool alone = springs->green[i] == SHELL_NONE;
        fibre_add(shell, &frame, SINGE_RED, springs->red[i], 1);
        fibre_add(shell, &frame, SINGE_BLUE, springs->blue[i], alone ? 1 : 0.5f);
        if (!alone) fibre_add(shell, &frame, SINGE_GREEN, springs->green[i], 0.5f);
    }
    for (int i = 0; i < 2; i++) fibre_add(shell, &frame, SINGE_YELLOW, springs->yellow[i], 1);
}

bool fibre_measure(Memory *memory, Shell *shell) {
    const Field ratio = shell->matter.fibre_shrink;
    if (ratio.mask == 0 && field_at(ratio, 0) == 1) return true;
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
        if (!NEW(memory, shell->springs[colour].grain, shell->springs[colour].count)) return false;
    for (uint32_t c = 0; c < shell->cell_count; c++) fibre_cell(shell, c);
    return true;
}
