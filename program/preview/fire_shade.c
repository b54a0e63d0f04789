// Flame and smoke at a position.
//
// The gas comes in cells of several millimetres and is interpolated by quadratic B-splines, so its cells are not
// visible. Finer detail is added: the lookup position is shifted by noise (domain warping), which rises with the gas and
// grows longer as the gas accelerates, so flames have tongues and streaks and flicker.
//
// The widest eddies bend whole tongues and the streaks in them: they move the position first, by an amount that grows from
// nothing at the paper and is known in each cell (fire.c). They move it by more than a cell: by less, a flame kept the
// straight sides of what burns below it. Others, half as wide, feed some tongues and starve others there:
// where they have creases, tongues join into larger flames as they rise, and between them there are gaps; and some end
// much lower than others. A noise that is wider still, and moves along what burns, raises tongues here and lowers them
// there: without it a straight front has a row of like teeth.
//
// A flame at a position is in fire_kernel.h, many at a time.

#include "common/float4.h"
#include "preview/internal.h"

#define SWAY_WIDE 0.08f  ///< m, of the eddies that bend whole tongues
#define SWAY_SMALL 0.6f  ///< of that, others that curl them
#define SWAY_SHARE 0.35f ///< of what the wide ones do
#define SWAY_GAIN 1.35f  ///< a smooth noise seldom comes near 1
#define SWAY_SLOPE 0.55f ///< m aside per m above the paper
#define LICK_WIDE 0.045f ///< m, of the eddies that feed and starve whole tongues
#define LICK_FULL 0.05f  ///< m above the paper, where they do so fully
#define LICK 0.6f
#define UNLIKE 1.5f       ///< octaves, by which the heights of tongues differ
#define JOIN 0.7f         ///< of a full flame: what they join into where the creases of those eddies are
#define JOIN_BEGINS 0.02f ///< m above the paper
#define JOIN_FULL 0.08f
#define GROUP_WIDE 0.075f ///< m along what burns, over which tongues are high or low together
#define GROUP_RATE 2.0f   ///< 1/s
#define GROUP 0.35f
#define GROUP_UNLIKE 1.5f ///< octaves
#define HOT_EDDY 0.005f   ///< m, of the eddies through which what is behind shimmers
#define HOT_OFTEN 2.0f
#define FED_WHOLLY 0.3f     ///< what burns less gains and loses less
#define SMOKE_SEEN_AS 76.0f ///< times its extinction, in the middle of a fold; what lies between folds is clear
#define SMOKE_FULL 0.6f     ///< 1/m, from which on it is wholly
#define SMOKE_FILLS 0.03f   ///< m: dense smoke has less clear air
#define SMOKE_EDDY 0.032f   ///< m across
#define SMOKE_SMALL 0.53f   ///< of that
#define SMOKE_BEND 0.5f     ///< by small eddies, of that by wide ones
#define SMOKE_FOLD 0.055f   ///< width of a fold's sharp side, of the noise whose zeros folds are
#define SMOKE_SOFT 2.0f     ///< times as wide is the other one
#define SMOKE_GREY 0.05f    ///< light of flames, of which smoke is half as warm as they are
#define SMOKE_SOFTEST 8.0f  ///< far from the fire
#define SMOKE_WIDENS 1.0f   ///< by which the sharp side is wider there
#define SMOKE_THINS 2.0f    ///< by which its middle is thinner there
#define SMOKE_CALM 0.5f     ///< of what eddies move, they do there
#define SMOKE_FINE 0.65f    ///< of folds, the share of small eddies at the fire
#define SMOKE_EVEN 0.50f    ///< share of a fold's density between its threads
#define SMOKE_THREADS 1.5f  ///< share of it that the threads add
#define SMOKE_COARSE 0.45f  ///< and far from it
#define SMOKE_DARK 0.25f    ///< light of flames, of which fresh smoke, which is brown, swallows half
#define SMOKE_SLOW 0.4f     ///< m/s, at which wide eddies rise
#define SMOKE_SPEED 0.5f    ///< m/s, small ones

#define FLAME_COOL 1200.0f ///< K
#define FLAME_HOT 2000.0f
#define FLAME_CAST 0.875f ///< of that range, 1900 K: the colour of the light that they cast
#define FLAME_BAKED 3.0f  ///< radiance of what is 1 where gas is baked

// ---- looking up

typedef struct Noise {
    float a, b, c, d;
} Noise;

static inline Four four_of(Float3 p) { return (Four){p.x, p.y, p.z, 0}; }

/// Four smooth noises from -1 to 1 at p, lattice size 1.
static inline Noise noise_at(const Fire *fire, Float3 p) {
    const Four q = four_of(p);
    Float4Mask whole = __builtin_convertvector(q, Float4Mask); // positions are within some kilometres, so they fit
    whole += q < __builtin_convertvector(whole, Four);
    Four f = q - __builtin_convertvector(whole, Four);
    f = f * f * (3 - 2 * f);
    const Float4Mask at = whole & (FIRE_NOISE - 1);
    const float(*corner)[4] = (const float(*)[4])fire->noise + fire_noise_at(at[0], at[1], at[2]);
    Four layer[2];

    for (int k = 0; k < 2; k++, corner += fire_noise_at(0, 0, 1)) {
        Four a = four_load(corner[0]), b = four_load(corner[fire_noise_at(0, 1, 0)]);
        a += (four_load(corner[1]) - a) * f[0];
        b += (four_load(corner[fire_noise_at(1, 1, 0)]) - b) * f[0];
        layer[k] = a + (b - a) * f[1];
    }

    Four n = layer[0] + (layer[1] - layer[0]) * f[2];
    return (Noise){n[0], n[1], n[2], n[3]};
}

typedef float Real;
typedef Float3 Real3;
#define real3 float3
#include "preview/fire_eddies.h"

// ---- flame and smoke

void fire_fill_colours(Preview *preview) {
    for (int i = 0; i < FIRE_COLOURS; i++) {
        float hot = (float)i / (FIRE_COLOURS - 1);
        Float3 glow = blackbody_glow(preview->blackbody, mixf(FLAME_COOL, FLAME_HOT, hot));
        float brightness = mixf(FLAME_DIM, FLAME_BRIGHT, hot * hot * hot);
        preview->fire.colours[i] = float3_scale(glow, brightness / maxf(float3_luminance(glow), 1e-6f));
    }
    preview->fire.colours[FIRE_COLOURS] = preview->fire.colours[FIRE_COLOURS - 1];
}

Float3 fire_cast_colour(const Preview *preview) {
    const float x = FLAME_CAST * (FIRE_COLOURS - 1);
    const Float3 *below = &preview->fire.colours[(int)x], colour = float3_mix(below[0], below[1], x - floorf(x));
    return float3_scale(colour, 1 / float3_luminance(colour));
}

void fire_sway(const Fire *fire, Float3 p, float height, float sway[2]) {
    const float scale = fire->scale, most = minf(SWAY_SLOPE * maxf(height, 0), FIRE_SWAY * scale);
    const float passed = EDDY_RATE * (fire->moment / sqrtf(scale) - p.z / (scale * RISE_MOST));
    const Noise wide = eddies(fire, p, passed, scale * SWAY_WIDE, 0.85f);
    const Noise small = eddies(fire, p, passed, scale * SWAY_SMALL * SWAY_WIDE, 1.1f);
    sway[0] = most * clampf(SWAY_GAIN * (wide.a + SWAY_SHARE * small.a), -1, 1);
    sway[1] = most * clampf(SWAY_GAIN * (wide.b + SWAY_SHARE * small.b), -1, 1);
}

float fire_feed(const Fire *fire, Float3 p, float height, float flame) {
    const float scale = fire->scale, passed = EDDY_RATE * (fire->moment / sqrtf(scale) - p.z / (scale * RISE_MOST));
    const Noise n = eddies(fire, p, passed, scale * LICK_WIDE, 0.9f);
    const float along = GROUP_RATE * fire->moment / sqrtf(scale) - 0.5f * p.z / (scale * GROUP_WIDE);
    const float group = clampf(0.40f + 2 * eddies(fire, float3(p.x, p.y, 0), along, scale * GROUP_WIDE, 1).a, -1, 1);
    const float more =
        LICK * n.c * stepf(0, LICK_FULL * scale, height) + GROUP * group * stepf(0, 0.02f * scale, height);
    const float crease = maxf(0.7f - 2.4f * fabsf(n.a), -0.7f);
    const float tall = maxf(height, 0) / (scale * FLAME_HEIGHT);
    float joined = JOIN * crease * stepf(JOIN_BEGINS * scale, JOIN_FULL * scale, height);
    joined += TAPER * (expf(-tall * exp2f(-UNLIKE * n.d - GROUP_UNLIKE * group)) -
                       expf(-tall)); // it ends lower or higher than others
    return maxf(flame * (1 + more) + joined * minf(flame / FED_WHOLLY, 1), 0);
}

void fire_turns(const Fire *fire, Float3 p, float turn[2]) {
    const Noise n = eddies(fire, p, EDDY_RATE * (fire->moment - p.z / RISE_MOST), HOT_EDDY, HOT_OFTEN);
    turn[0] = n.a;
    turn[1] = n.b;
}

void fire_between(const FirePoint *a, const FirePoint *b, float step, Matter *matter) {
    if (!(a->depth > 0 || b->depth > 0)) return;

    // the mean of the profile between the two depths, which differ by no more than the step
    float apart = b->depth - a->depth, part = 0.5f * (a->profile + b->profile);
    if (fabsf(apart) > 5e-5f) part = minf(fabsf(b->shell - a->shell) / minf(fabsf(apart), step), 1);
    float from = a->depth > b->depth ? 0.5f + 0.5f * (b->depth <= 0) : 0.5f * (a->depth > 0); // of the end inside
    from = 1 - from;
    Float3 light = float3_add(float3_mix(a->soot, b->soot, from), float3_mix(a->root, b->root, from));
    matter->light = float3_mad(matter->light, light, part);
    matter->dense += part * mixf(a->opaque, b->opaque, from);
}

/// p in cells, counted from the centre of the first, within `inside` cells of the bounds.
static inline Four in_cells(const Fire *fire, Float3 p, float inside) {
    const Four at = (four_of(p) - four_of(fire->origin)) * (1 / fire->cell);
    const Four last = {(float)fire->size[0], (float)fire->size[1], (float)fire->size[2], 1};
    return float4_min(last - (1 + inside), float4_max(float4_all(inside), at));
}

static inline size_t cell_number(const Fire *fire, Float4Mask at) {
    return (size_t)at[0] + (size_t)fire->size[0] * ((size_t)at[1] + (size_t)fire->size[1] * (size_t)at[2]);
}

/// The weights of 3 x 3 x 3 cells in a quadratic B-spline at p, and their changes per cell, along x, y and z. Returns the
/// number of the first.
static inline size_t spline_at(const Fire *fire, Float3 p, Four weight[3], Four change[3]) {
    const Four at = in_cells(fire, p, 1);
    const Float4Mask middle = __builtin_convertvector(at + 0.5f, Float4Mask);
    const Four f = at - __builtin_convertvector(middle, Four);
    weight[0] = 0.5f * (0.5f - f) * (0.5f - f);
    weight[1] = 0.75f - f * f;
    weight[2] = 0.5f * (0.5f + f) * (0.5f + f);
    change[0] = f - 0.5f;
    change[1] = -2 * f;
    change[2] = f + 0.5f;
    return cell_number(fire, middle - 1);
}

/// All values of the cells at p.
static FireCell cell_at(const Fire *fire, Float3 p) {
    Four w[3], v[3], sum = {0, 0, 0, 0};
    const FireCell *first = &fire->cells[spline_at(fire, p, w, v)];
    for (int z = 0; z < 3; z++, first += (size_t)fire->size[0] * (size_t)fire->size[1]) {
        const FireCell *row = first;
        for (int y = 0; y < 3; y++, row += fire->size[0])
            sum += (w[z][2] * w[y][1]) * (four_load(&row[0].flame) * w[0][0] + four_load(&row[1].flame) * w[1][0] +
                                          four_load(&row[2].flame) * w[2][0]);
    }
    return (FireCell){sum[0], sum[1], sum[2], sum[3]};
}

/// Smoke lies in folds, where a noise is 0, in some of the wide eddies and not in others: between them the air is clear. Wide
/// eddies rise slower than small ones, so that folds bend and curl as they pass. At the fire folds are thin threads. What is
/// further, by the light that reaches it, is older: its folds have spread to soft veils, and its small eddies have died.
/// Flames burn smoke, so it begins at their tips, where it is brown and hides more than it shines. Firelight comes from
/// below and is less warm where it is faint, daylight comes from above.
Smoke fire_smoke_at(const Fire *fire, Float3 p) {
    const float eddy = fire->scale * SMOKE_EDDY, small = SMOKE_SMALL * eddy, warp = fire->scale * SMOKE_WARP;
    const Noise wide = eddies(fire, p, (SMOKE_SLOW * fire->moment - p.z) / eddy, eddy, 0.72f);
    const Float3 by = float3(wide.a, wide.b, wide.c);
    const FireCell cell = cell_at(fire, float3_mad(p, by, warp));
    const float near = cell.glow / (cell.glow + SMOKE_GREY), moves = mixf(SMOKE_CALM, 1, near);

    Float3 moved = float3_mad(p, by, moves * warp);
    const float passed = (SMOKE_SPEED * fire->moment - moved.z) / eddy, bend = moves * SMOKE_BEND * warp;
    const Noise curl = eddies(fire, moved, passed, small, 0.7f);
    moved = float3_mad(moved, float3(curl.a, curl.b, curl.c), bend);
    const float turned = passed - bend * curl.c / eddy;
    const float here = eddies(fire, moved, turned, small, 0.8f).d,
                below = eddies(fire, moved, turned + 0.25f, small, 0.8f).d;

    const float fold = mixf(wide.d, here, mixf(SMOKE_COARSE, SMOKE_FINE, near)), up = 2 * (here - below);
    const float down = clampf(up - 12 * fold * up, -1, 1); // what faces down, or is below the middle of a fold
    const Float3 warm = float3_mix(float3(0.78f, 0.8f, 0.83f), float3(1, 0.45f, 0.14f), near);
    const Float3 glow = float3_scale(warm, cell.glow / (1 + cell.glow / SMOKE_DARK));
    Smoke smoke;
    // fresh smoke is brown by day, too
    const Float3 day = float3_mul(fire->daylight, float3_mix(float3(1, 1, 1), float3(0.62f, 0.46f, 0.34f), near));
    smoke.light = float3_mad(float3_scale(day, 0.33f - 0.2f * down), glow, 1.8f + 1.5f * down);
    smoke.dense = SMOKE_SEEN_AS * cell.smoke * stepf(SMOKE_THIN, SMOKE_FULL, cell.smoke) *
                  stepf(-0.35f, 0.35f, wide.d + SMOKE_FILLS * cell.smoke) * (1 - stepf(0.05f, 0.4f, cell.flame));
    smoke.dense *= SMOKE_EVEN + SMOKE_THREADS * maxf(1 - 2.2f * fabsf(curl.d), 0);
    smoke.fold = fold;
    smoke.old = 1 - near;
    return smoke;
}

/// The integral of a fold's profile, up to x of its width: (1 + x)^2 before its edge, and behind it the softer
/// (1 - x/soft)^2.
static inline float fold_sum(float x, float soft) {
    const float edge = clampf(1 + x, 0, 1), left = clampf(1 - x / soft, 0, 1);
    return (edge * edge * edge + (x > 0 ? soft * (1 - left * left * left) : 0)) / 3;
}

/// The integral of that.
static inline float fold_sum_twice(float x, float soft) {
    const float edge = clampf(1 + x, 0, 1), left = clampf(1 - x / soft, 0, 1), left2 = left * left;
    const float edge2 = edge * edge, behind = maxf(x, 0);
    return edge2 * edge2 / 12 + (1 + soft) * behind / 3 - soft * soft * (1 - left2 * left2) / 12;
}

/// Between two places the fold and the extinction are linear, and the light is even.
Matter fire_smoke_between(const Fire *fire, const Smoke *a, const Smoke *b, float blur) {
    if (a->dense + b->dense <= 0) return (Matter){float3(0, 0, 0), 0};
    const float old = 0.5f * (a->old + b->old), soft = mixf(SMOKE_SOFT, SMOKE_SOFTEST, old);
    const float sharp = SMOKE_FOLD * (1 + SMOKE_WIDENS * old);
    const float width = sharp + 1.2f * blur / (fire->scale * SMOKE_EDDY), first = a->fold / width;
    float apart = b->fold / width - first;
    apart = fabsf(apart) > 0.02f ? apart : 0.02f;
    const float last = first + apart, sum = fold_sum(last, soft), mean = (sum - fold_sum(first, soft)) / apart;

    // of the mean, what counts by the end's extinction: a fold is as dense as the air where it is
    float end = 0.5f * mean;
    if (fabsf(apart) > 0.1f) end = (sum - (fold_sum_twice(last, soft) - fold_sum_twice(first, soft)) / apart) / apart;
    const float dense = (a->dense * (mean - end) + b->dense * end) * sharp / (width * (1 + SMOKE_THINS * old));
    return (Matter){float3_scale(float3_mix(a->light, b->light, 0.5f), dense), dense};
}

// ---- for programs that draw the cells themselves

SingeResult preview_bake_gas(Preview *preview, const SingeSurface *surface, double time, int detail, float *smoke,
                             float *flame, SingeError *error) {
    const Fire *fire = &preview->fire;
    if (!isfinite(time) || detail < 1 || detail > PREVIEW_BAKE_MAX)
        return preview_fail(error, SINGE_ERROR_ARGUMENT, -1, "the time is not finite, or the detail is not 1 to %d",
                            PREVIEW_BAKE_MAX);
    if (!fire->size[0]) return preview_fail(error, SINGE_ERROR_ARGUMENT, -1, "there is no gas");

    preview->time = time;
    SingeResult result = tracer_load(preview, surface, error);
    if (result) return result;

    fire_raise(preview);

    const float side = fire->cell / (float)detail, first = (FIRE_BORDER - 0.5f) * fire->cell + 0.5f * side;
    const float bright = SOOT_DENSE * FLAME_BAKED;
    const Float3 origin = float3_add(fire->origin, float3(first, first, first));
    int size[3];
    FirePlaces places = {.x = {0}};
    FirePoints points;

    for (int c = 0; c < 3; c++) size[c] = (fire->size[c] - 2 * FIRE_BORDER) * detail;
    size_t i = 0;
    for (int z = 0; z < size[2]; z++)
        for (int y = 0; y < size[1]; y++)
            for (int x = 0; x < size[0]; x++, i++) {
                const Float3 p = float3_mad(origin, float3((float)x, (float)y, (float)z), side);
                const int k = x % FIRE_LANES;
                fire_place(&places, k, p, 0);
                const Smoke at = fire_smoke_at(fire, p);
                smoke[i] = fire_smoke_between(fire, &at, &at, 0.5f * side).dense;
                if (k < FIRE_LANES - 1 && x < size[0] - 1) continue;
                fire->look(fire, k + 1, &places, &points);
                for (int m = 0; m <= k; m++) {
                    const FirePoint point = fire_point(&points, m);
                    Matter burning = {{0, 0, 0}, 0};
                    fire_between(&point, &point, side, &burning);
                    flame[i - (size_t)(k - m)] = float3_luminance(burning.light) / bright;
                }
            }

    return SINGE_OK;
}
