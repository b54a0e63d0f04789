// Rest geometry: positions of the centres, areas of the particles, lengths and directions of the springs.
//
//   centre    x_c = (x_0 + x_1 + x_2 + x_3)/4 + t n,   n = (x_2 - x_0) x (x_3 - x_1), normalised
//   area      A_c = sum of the triangles (x_i, x_i+1, mean) [m2]; A_v = half of each triangle at v
//
// The areas of each layer sum to the sheet's area. For rectangles A_v is the usual quarter of each cell around.
//
// Directions of the springs relative to the fibres. A fibre runs at `fibre_angle` phi from e1, the direction of
// increasing u in the cell's tangent plane (its first side if the uv are degenerate), towards e2 = n x e1. A spring
// along d has
//
//   grain = [(x^2 - y^2) cos 2 phi + 2 x y sin 2 phi] / |d|^2,   x = d . e1,   y = d . e2
//
// which is cos 2(angle to the fibres) in the plane of the sheet, and less for a spring out of the plane. A spring of
// two cells has the mean of both.
#include "shell/rest_lengths.h"

#include "common/real.h"

/// If a corner's share of its cell is below this, the four shares are made equal: a concave corner has little or
/// negative area around it, but a particle needs mass.
static const double share_min = 1.0 / 32;

CellShape cell_shape(const float *const corners[4]) {
    CellShape shape = {0};
    double p[4][3], diagonal[2][3], side[3];

    // corners and centre
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) {
            p[i][k] = (double)corners[i][k];
            shape.centre[k] += p[i][k] / 4;
        }
    }

    for (int i = 0; i < 4; i++) {
        sub3(p[(i + 1) & 3], p[i], side);
        double length = sqrt(dot3(side, side));
        if (i == 0 || length < shape.shortest) shape.shortest = length;
        if (i == 0 || length > shape.longest) shape.longest = length;
    }

    // normal
    sub3(p[2], p[0], diagonal[0]);
    sub3(p[3], p[1], diagonal[1]);
    cross3(diagonal[0], diagonal[1], shape.normal);

    double length = sqrt(dot3(shape.normal, shape.normal));
    shape.vector_area = length / 2;
    for (int k = 0; k < 3 && length > 0; k++) shape.normal[k] /= length;

    // areas of the triangles (x_i, x_i+1, mean), negative where they face away from the normal
    for (int i = 0; i < 4; i++) {
        double a[3], b[3], c[3];
        sub3(p[i], shape.centre, a);
        sub3(p[(i + 1) & 3], shape.centre, b);
        cross3(a, b, c);
        double area = copysign(sqrt(dot3(c, c)) / 2, dot3(c, shape.normal));
        shape.area += area;
        shape.corner_area[i] += area / 2;
        shape.corner_area[(i + 1) & 3] += area / 2;
    }

    bool even = false;
    for (int i = 0; i < 4; i++) even |= !(shape.corner_area[i] >= share_min * shape.area);
    for (int i = 0; i < 4 && even; i++) shape.corner_area[i] = shape.area / 4;
    return shape;
}

void measure_particles(Shell *shell) {
    Matter *matter = &shell->matter;
    for (uint32_t c = 0; c < shell->cell_count; c++) {
        const float *corners[4];
        for (int i = 0; i < 4; i++) corners[i] = shell->rest_position[shell->cells[c][i]];

        CellShape shape = cell_shape(corners);
        uint32_t centre = shell_centre(shell, c);
        double thickness = (double)field_at(matter->thickness, centre);
        for (int k = 0; k < 3; k++)
            shell->rest_position[centre][k] = (float)(shape.centre[k] + thickness * shape.normal[k]);
        matter->area[centre] = (float)shape.area;
        for (int i = 0; i < 4; i++) matter->area[shell->cells[c][i]] += (float)shape.corner_area[i];
    }
}

/// The median side of a sheet's cells, digit by digit: positive floats are in the order of their bits, so a histogram
/// of 256 bins for each byte from the top finds it in four passes.
static float median_edge(const Shell *shell, const Sheet *sheet) {
    const SpringSet *blue = &shell->springs[SINGE_BLUE];
    uint64_t k = 0;
    uint32_t prefix = 0;

    for (int shift = 24; shift >= 0; shift -= 8) {
        uint64_t bins[256] = {0}, edges = 0;
        for (uint32_t c = 0; c < 4 * sheet->cell_count; c++) {
            const CellSprings *springs = &shell->cell_springs[sheet->cell_first + c / 4];
            uint32_t cell = sheet->cell_first + c / 4, other = shell_neighbour(shell, cell, c & 3), bits;
            if (other != SHELL_NONE && other < cell) continue; // each edge once
            edges++;
            memcpy(&bits, &blue->rest[springs->blue[c & 3]], sizeof bits);
            if (shift == 24 || bits >> (shift + 8) == prefix >> (shift + 8)) bins[bits >> shift & 255]++;
        }

        if (edges == 0) return 0;
        if (shift == 24) k = edges / 2;
        uint32_t digit = 0;
        while (digit < 255 && k >= bins[digit]) k -= bins[digit++];
        prefix |= digit << shift;
    }

    float length;
    memcpy(&length, &prefix, sizeof length);
    return length;
}

SingeResult measure_springs(Shell *shell, SingeError *error) {
    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++) {
        SpringSet *set = &shell->springs[colour];
        for (uint32_t s = 0; s < set->count; s++) {
            const float *a = shell->rest_position[set->ends[s][0]], *b = shell->rest_position[set->ends[s][1]];
            double x = (double)b[0] - (double)a[0], y = (double)b[1] - (double)a[1], z = (double)b[2] - (double)a[2];
            set->rest[s] = (float)sqrt(x * x + y * y + z * z);
            if (isnormal(set->rest[s])) continue;

            // a spring without length: name its vertex or cell
            uint32_t p = set->ends[s][0];
            const Sheet *sheet = &shell->sheets[shell->matter.sheet[p]];
            bool corner = shell_is_corner(shell, p);
            uint32_t element = corner ? p - sheet->vertex_first : p - shell->vertex_count - sheet->cell_first;
            return error_set(error, SINGE_ERROR_MESH, "sheet", element,
                             "sheet '%s': a spring at %s %u has no length; is the sheet too thick for its curvature?",
                             sheet->name, corner ? "vertex" : "the centre of cell", element);
        }
    }

    // median edge of each sheet
    for (uint32_t i = 0; i < shell->sheet_count; i++)
        shell->sheets[i].cell_size = median_edge(shell, &shell->sheets[i]);

    return SINGE_OK;
}

/// The frame of a cell's fibres.
typedef struct FibreFrame {
    Float3 e1, e2;
    float cosine, sine; ///< of 2 phi
} FibreFrame;

static FibreFrame fibre_frame(const Shell *shell, uint32_t cell) {
    Float3 p[4];
    float da[2], db[2];

    for (int i = 0; i < 4; i++) p[i] = float3_load(shell->rest_position[shell->cells[cell][i]]);
    for (int k = 0; k < 2; k++) {
        da[k] = shell_corner_uv(shell, cell, 2)[k] - shell_corner_uv(shell, cell, 0)[k];
        db[k] = shell_corner_uv(shell, cell, 3)[k] - shell_corner_uv(shell, cell, 1)[k];
    }

    Float3 a = float3_sub(p[2], p[0]), b = float3_sub(p[3], p[1]), normal = float3_unit(float3_cross(a, b));

    // the direction in which u grows and v is constant; the first side if there is none
    float turn = da[0] * db[1] - db[0] * da[1];
    Float3 along = float3_sub(float3_scale(a, db[1]), float3_scale(b, da[1]));
    if (turn == 0) along = float3_sub(p[1], p[0]);
    else if (!(turn > 0)) along = float3_scale(along, -1);

    Float3 e1 = float3_unit(float3_mad(along, normal, -float3_dot(along, normal)));
    float angle = field_at(shell->matter.fibre_angle, shell_centre(shell, cell));
    return (FibreFrame){e1, float3_cross(normal, e1), real_cosf(2 * angle), real_sinf(2 * angle)};
}

static float frame_grain(const FibreFrame *frame, Float3 d) {
    float x = float3_dot(d, frame->e1), y = float3_dot(d, frame->e2), square = float3_dot(d, d);
    return ((x * x - y * y) * frame->cosine + 2 * x * y * frame->sine) / square;
}

float cell_grain(const Shell *shell, uint32_t cell, Float3 along) {
    const FibreFrame frame = fibre_frame(shell, cell);
    return frame_grain(&frame, along);
}

/// Adds `share` of a spring's grain in a cell's frame.
static void fibre_add(Shell *shell, const FibreFrame *frame, SingeColour colour, uint32_t spring, float share) {
    SpringSet *set = &shell->springs[colour];
    const uint32_t *ends = set->ends[spring];
    Float3 d = float3_sub(float3_load(shell->rest_position[ends[1]]), float3_load(shell->rest_position[ends[0]]));
    set->grain[spring] += share * frame_grain(frame, d);
}

bool measure_fibres(Memory *memory, Shell *shell) {
    const Field ratio = shell->matter.fibre_shrink;
    if (ratio.mask == 0 && field_at(ratio, 0) == 1) return true;

    for (int colour = 0; colour < SINGE_COLOUR_COUNT; colour++)
        if (!NEW(memory, shell->springs[colour].grain, shell->springs[colour].count)) return false;

    for (uint32_t c = 0; c < shell->cell_count; c++) {
        const CellSprings *springs = &shell->cell_springs[c];
        FibreFrame frame = fibre_frame(shell, c);
        for (int i = 0; i < 4; i++) {
            bool alone = springs->green[i] == SHELL_NONE;
            fibre_add(shell, &frame, SINGE_RED, springs->red[i], 1);
            fibre_add(shell, &frame, SINGE_BLUE, springs->blue[i], alone ? 1 : 0.5f);
            if (!alone) fibre_add(shell, &frame, SINGE_GREEN, springs->green[i], 0.5f);
        }

        for (int i = 0; i < 2; i++) fibre_add(shell, &frame, SINGE_YELLOW, springs->yellow[i], 1);
    }

    return true;
}
