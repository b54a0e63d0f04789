// Which positions are drawn: burnt edges crumble.
//
// A noise r(x) of the rest position, from 0 to `reach` and fixed to the paper, is the depth to which the edge is eroded
// at x:
//
//   L(x) = min { S(x), S(x + r u_1), S(x + r u_2), S(x + r u_3) },   u_i three directions 120 degrees apart
//
// with S the lesser of the smooth level m' and the level of the remaining cells (fine_spline.c); the angle of the
// directions is another noise. Positions with L >= 0 are drawn: about those farther than r from the edge of S. As S
// never grows, L never grows, whatever the front's width and speed: burnt parts do not return, the edge stops where the
// fire stops, and the noise displaces the edge by a length. Nothing is drawn outside S >= 0. The mass drawn is that of
// the point at which the minimum is taken, so that char follows the edge.
//
// r is a sum of octaves, each half the size of the one before, down to the size of the fine triangles. Its lattice is
// rotated out of the sheet's plane and grid.
#include "common/real.h"
#include "surface/surface_fine.h"
#include "common/random.h"

/// The largest features of the noise, m; its mean depth over the reach; an octave's strength over that of the one
/// before; the first octave's strength.
#define NOISE_SIZE 3e-3f
#define NOISE_MEAN 0.45f
#define NOISE_STRENGTH 0.7f
#define NOISE_GAIN 2.3f

int fine_octaves(float spacing) {
    int octaves = 1;
    for (float size = 0.5f * NOISE_SIZE; size >= 1.6f * spacing && octaves < 8; size *= 0.5f) octaves++;
    return octaves;
}

static const float two_pi = 6.2831853f;

Float3 fine_rest(const Shell *shell, FineLocation location) {
    const uint32_t *at = shell->cells[location.cell];
    float quarter = 0.25f * location.weight[2];
    Float3 sum = {0, 0, 0};
    for (int i = 0; i < 4; i++) {
        float weight = quarter;
        if (i == location.side) weight += location.weight[0];
        if (i == ((location.side + 1) & 3)) weight += location.weight[1];
        sum = float3_mad(sum, float3_load(shell->rest_position[at[i]]), weight);
    }
    return sum;
}

Float3 fine_askew(Float3 p) {
    return float3(0.7447f * p.x - 0.5389f * p.y + 0.3937f * p.z, 0.6325f * p.x + 0.7574f * p.y - 0.1598f * p.z,
                  -0.2121f * p.x + 0.3680f * p.y + 0.9053f * p.z);
}

/// The noise at a position: the depth of erosion, m, and the direction, as an angle.
static float eaten(const Fine *fine, FineLocation location, const FineSheet *sheet, float *angle) {
    Float3 p = float3_scale(fine_askew(fine_rest(fine->shell, location)), 1 / NOISE_SIZE);
    float sum = 0, strength = NOISE_GAIN;
    for (int octave = 0; octave < sheet->octaves; octave++) {
        float noise = random_noise(p.x, p.y, p.z, sheet->seed + (uint32_t)octave);
        if (octave <= 1) *angle = 3 * two_pi * noise;
        sum += strength * (noise - 0.5f);
        strength *= NOISE_STRENGTH;
        p = float3_add(float3_scale(p, 2), float3(17.31f, 5.77f, 11.83f));
    }
    float depth = fabsf(NOISE_MEAN + sum); // reflected into 0 to 1, so that no edge is smooth
    if (depth > 1) depth = fmaxf(2 - depth, 0);
    return sheet->reach * depth;
}

/// A length in cells, at most a half.
static float half_max(float length, float axis) { return length < 0.5f * axis ? length / axis : length > 0 ? 0.5f : 0; }

/// S at a position.
static float smooth_level(const Fine *fine, FineLocation location) {
    float level = fine_spline_at(fine->shell, &fine->splines[SPLINE_LEVEL], location);
    if (fine->flags[location.cell] & FINE_WHOLE) return level;
    return fminf(level, fine_whole_level(fine_spline_at(fine->shell, &fine->splines[SPLINE_WHOLE], location)));
}

FineValue fine_value(const Fine *fine, FineLocation location) {
    const Shell *shell = fine->shell;
    uint32_t sheet = shell->matter.sheet[shell_centre(shell, location.cell)];
    FineLocation min_location = location;
    float min = smooth_level(fine, location), angle = 0, x, y;
    if (fine->sheets[sheet].reach > 0) {
        float depth = eaten(fine, location, &fine->sheets[sheet], &angle);
        x = half_max(depth, fine->axes[location.cell][0]);
        y = half_max(depth, fine->axes[location.cell][1]);

        // the min over three directions
        float c = real_cosf(angle), s = real_sinf(angle);
        const float across = 0.8660254f; // of 120 degrees
        const float direction[3][2] = {
            {c, s}, {-0.5f * c - across * s, across * c - 0.5f * s}, {-0.5f * c + across * s, -across * c - 0.5f * s}};
        for (int i = 0; i < 3; i++) {
            FineLocation there = fine_walk(shell, location, x * direction[i][0], y * direction[i][1]);
            float value = smooth_level(fine, there);
            if (value < min) {
                min = value;
                min_location = there;
            }
        }
    }

    // edges of tears
    if (fine->flags[location.cell] & FINE_TEAR_EDGE) min = fminf(min, fine_tear_level(fine, location));
    return (FineValue){min, fine_spline_at(shell, &fine->splines[SPLINE_MASS], min_location)};
}
