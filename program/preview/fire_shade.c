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
// A flame over paper is a thin shell of glowing soot around clear, hot vapour. With f the flame (fire.c), r the height
// above the paper and N, n noises of the width of a tongue and of a streak, its edge lies where
//
//     e = f + a(r) (0.67 - 2.4 |N|) + b(r) (0.4 - 2 |n|) - EDGE - TAPER (1 - exp(-r/H)) = 0
//
// |N| has creases, where it is 0: they are the middles of thin sheets and sharp tongues. A smooth noise has round hills
// instead, and its flames are domes. Its hills are of three sizes (fire.c), so its creases, and with them tongues, are at
// no one distance. Eddies are at most five times or so as long as wide, and larger ones roll and bend smaller ones: else
// flames are combs of vertical stripes. The taper is steep at first, and so tongues narrow below and end in long tips. They
// are as tall as their fire is strong. The depth inside of the edge is d = e/|grad e|, in metres, whatever the size of
// the cells. Light comes from the shell's profile
//
//     P(d) = 0 outside, d/w in the first w, then fill + (1 - fill) exp(-(d - w)/SHELL)
//
// and a step of a ray takes its mean between the depths of its ends, by the integral of P: the shell is thinner than
// a step. w is SHELL_RISE, or more where rays are further apart, as edges would have steps; the light of a flame
// stays. It begins at the paper, is faint, clear and blue in the first millimetres, where there is little soot, then
// pale in its core, and orange at its tips. Its foot, some two centimetres tall, is one low sheet along what burns. Soot
// builds up in it gradually, dim, orange and so thin that the rim shows through; in tongues it builds up faster. Tongues
// are wide at the bottom: with narrow, hot feet they seemed to hang in the air.
// Near its edge a flame is thinner than the shell alone: rays run along the shell there and would draw outlines.
// Soot glows as a black body between FLAME_COOL and FLAME_HOT, and hides as much as it glows. It is the hotter the
// more heat is released around it (core) and the further it is from the edge (strong): so a flame of one or two
// sheets has a pale core, too.
//
// Soot is clear and hot in threads, the creases of a noise, and denser and cooler in the folds between them. So a sheet in
// front hides much of what burns behind it, and a body of many sheets does not add up to one flat yellow: in a strong fire
// above its foot, soot hides somewhat more than it glows, as what is nearest is cooler than what it hides. Above the foot
// filaments run along the flow, hotter and denser, with gaps between them. They are folds of a sheet, sharp at one side and
// soft at the other: alike at both they would be strands. Soot cools with height and thins out towards the tips.

#include "common/float4.h"
#include "preview/internal.h"

// Gas leaves the paper slowly and accelerates: v^2 = BASE_SPEED^2 + 2 BUOYANCY h at the height h. An eddy that was formed
// at the base grows longer as it rises, and moves by the same share of its length in every frame.
#define BASE_SPEED 0.25f  ///< m/s
#define BUOYANCY 2.0f     ///< m/s2
#define RISE_MOST 0.55f   ///< m/s, which it reaches
#define EDDY_RATE 8.0f    ///< 1/s, eddies that pass a height
#define EDDY_WIDE 0.0135f ///< m across
#define EDDY_FINE 0.0065f
#define FINE_OFTEN 2.2f
#define EDDY_THREAD 0.010f  ///< of the soot's threads
#define THREAD_BLUR 0.0016f ///< m, blur from which on they are wider
#define EDDY_FILAMENT 0.009f
#define FOLD_SHARP 2.2f   ///< times as steep is the one side of a filament
#define THREAD_WARP 0.01f ///< m, by which wide eddies bend them
#define ROLL 0.5f         ///< of an eddy's length, by which they roll them
#define SWAY_WIDE 0.08f   ///< m, of the eddies that bend whole tongues
#define SWAY_SMALL 0.6f   ///< of that, others that curl them
#define SWAY_SHARE 0.35f  ///< of what the wide ones do
#define SWAY_GAIN 1.35f   ///< a smooth noise seldom comes near 1
#define SWAY_SLOPE 0.55f  ///< m aside per m above the paper
#define LICK_WIDE 0.045f  ///< m, of the eddies that feed and starve whole tongues
#define LICK_FULL 0.05f   ///< m above the paper, where they do so fully
#define LICK 0.6f
#define UNLIKE 1.5f       ///< octaves, by which the heights of tongues differ
#define JOIN 0.7f         ///< of a full flame: what they join into where the creases of those eddies are
#define JOIN_BEGINS 0.02f ///< m above the paper
#define JOIN_FULL 0.08f
#define GROUP_WIDE 0.075f ///< m along what burns, over which tongues are high or low together
#define GROUP_RATE 2.0f   ///< 1/s
#define GROUP 0.35f
#define GROUP_UNLIKE 1.5f   ///< octaves
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
#define FLAME_DIM 0.26f ///< radiance of a thick flame at its coolest and its hottest
#define FLAME_BRIGHT 5.9f
#define FLAME_CAST 0.875f       ///< of that range, 1900 K: the colour of the light that they cast
#define FLAME_BAKED 3.0f        ///< radiance of what is 1 where gas is baked
#define SOOT_DENSE 198.0f       ///< 1/m, extinction: what glows also hides, by Kirchhoff's law
#define BLUE_DENSE 3.6f         ///< 1/m: radiance of the root per metre
#define BLUE_ENDS 0.005f        ///< m above the paper
#define SHELL_RISE 0.0005f      ///< m, w
#define SHELL_RISE_MOST 0.0016f ///< more would dim thin tongues
#define SHELL 0.0018f           ///< m
#define EDGE 0.42f              ///< f at a flame's edge
#define TAPER 0.55f             ///< what is added to it above a flame's height
#define STAND_OFF 0.0006f       ///< m above the paper, below which nothing is visible
#define JOINED_HOT 0.15f
#define LARGE_HOT 0.14f ///< more where flames are twice as large: more soot glows in them
#define FILAMENT_HOT 0.55f
#define HIGH_COOL 0.18f
#define SPENT_COOL 0.25f
#define SPENT_THIN 0.4f
#define FOOT_CLEAR 0.004f   ///< m above the paper, up to which a flame is all foot
#define FOOT_FULL 0.027f    ///< m, from which none of it is foot
#define FOOT_SOOT 0.009f    ///< m, at which a tongue's middle has all its soot
#define FOOT_BESIDE 0.017f  ///< m, the same beside tongues
#define FOOT_WARM 0.015f    ///< m, at which a tongue's middle is as hot as above
#define FOOT_LATE 0.030f    ///< m, the same beside tongues
#define FOOT_COOL 0.65f     ///< share of the temperature range that fresh soot has
#define FOOT_GLOWS 0.8f     ///< soot glows that much more there
#define FOOT_HIDES 0.4f     ///< and hides that much less: what burns shows through
#define FOOT_HAZE 0.22f     ///< share of the soot that is beside tongues
#define TONGUE_MIDDLE 0.05f ///< value of the noise whose creases are tongues
#define TONGUE_ENDS 0.33f
#define TONGUE_ROOTED 0.6f ///< the same in the foot, where they are wide
#define BORDER_WIDE 0.003f ///< m inside its edge over which a flame thins out: seen edge-on it must not draw an outline
#define BORDER_THIN 0.4f
#define BORDER_GAIN 1.25f   ///< factor on soot that makes up for what the border loses
#define CORE_BEGINS 0.0030f ///< m
#define CORE_FULL 0.0240f
#define CORE_HIDES 0.22f ///< more than it glows

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

/// The number of eddies that have passed z, at a height above what burns, since the start: grows with time, and by one over
/// each eddy. What burns higher up has others: up a sheet that burns everywhere the height stays the same, and by that alone
/// eddies would be as long as the sheet, and its flames a comb.
static inline float eddies_passed(float height, float z, float time) {
    const float steady = (RISE_MOST * RISE_MOST - BASE_SPEED * BASE_SPEED) / (2 * BUOYANCY); // m
    float speed = sqrtf(BASE_SPEED * BASE_SPEED + 2 * BUOYANCY * clampf(height, 0, steady));
    float risen = (speed - BASE_SPEED) / BUOYANCY + maxf(height - steady, 0) / RISE_MOST; // s
    float below = (z - height) / RISE_MOST + minf(height, 0) / BASE_SPEED;
    return EDDY_RATE * (time - risen - below);
}

/// Noise of eddies `width` across, of which `often` pass where one of the largest does; rotated away from the axes.
static inline Noise eddies(const Fire *fire, Float3 p, float passed, float width, float often) {
    const float c = 0.829f, s = 0.559f; // 34 degrees around the vertical
    float across = 1 / width;
    return noise_at(fire, float3((c * p.x - s * p.y) * across + 0.21f * passed,
                                 (s * p.x + c * p.y) * across + 0.17f * passed, -often * passed));
}

// ---- flame and smoke

void fire_fill_colours(Preview *preview) {
    for (int i = 0; i < FIRE_COLOURS; i++) {
        float hot = (float)i / (FIRE_COLOURS - 1);
        Float3 glow = blackbody_glow(preview->blackbody, mixf(FLAME_COOL, FLAME_HOT, hot));
        float brightness = mixf(FLAME_DIM, FLAME_BRIGHT, hot * hot * hot);
        preview->fire.colours[i] = float3_scale(glow, brightness / maxf(float3_luminance(glow), 1e-6f));
    }
}

static Float3 flame_colour(const Fire *fire, float hot) {
    float x = hot * (FIRE_COLOURS - 1);
    int i = (int)minf(x, FIRE_COLOURS - 2);
    return float3_mix(fire->colours[i], fire->colours[i + 1], x - (float)i);
}

Float3 fire_cast_colour(const Preview *preview) {
    const Float3 colour = flame_colour(&preview->fire, FLAME_CAST);
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

/// The flame at a position p that large eddies have moved, from its share, the gradient of that in 1/m, and the noises.
static void shade_flame(const Fire *fire, float flame, Float3 p, float rise, float passed, float slope, Noise wide,
                        Noise fine, float blur, FirePoint *point) {
    float torn = stepf(0, 0.02f, rise);
    float tall = rise / (fire->scale * FLAME_HEIGHT);
    float coarse = 0.075f + 0.425f * torn, small = 0.025f + 0.225f * torn;
    float edge = flame + coarse * (0.67f - 2.4f * fabsf(wide.c)) + small * (0.4f - 2 * fabsf(fine.c)) - EDGE -
                 TAPER * (1 - expf(-tall)) - 0.1f * (1 - torn);
    edge = minf(edge, 2 * (flame - FLAME_SEEN));
    float noisy = 2 * (coarse / EDDY_WIDE + small / EDDY_FINE) / fire->scale;
    point->depth = maxf(edge / sqrtf(slope * slope + 0.4f * noisy * noisy + 1), FIRE_OUTSIDE);
    if (!(point->depth > 0)) return;

    // the shell's profile, and its integral from the edge
    float tip = stepf(0.35f, 1.4f, tall), fill = mixf(0.02f, 0.12f, tip);
    float first = clampf(blur, SHELL_RISE, SHELL_RISE_MOST * fire->scale), outer = clampf(point->depth, 0, first),
          inner = maxf(point->depth - first, 0);
    float fading = (1 - fill) * expf(-inner / SHELL), same = (0.5f * SHELL_RISE + SHELL) / (0.5f * first + SHELL);
    point->profile = same * outer / first * (fill + fading);
    point->shell = same * (0.5f * outer * outer / first + fill * inner + SHELL * (1 - fill - fading));

    const float foot = rise + 0.0012f * fine.d + 0.0016f * wide.d;

    // the foot, lower where flames are small, is one sheet along what burns: at first clear and blue; then dim orange soot
    // builds up, in the middle of tongues sooner than beside them
    const float small_foot = minf(fire->scale, 1);
    const float above = stepf(small_foot * FOOT_CLEAR, small_foot * FOOT_FULL, rise);
    const float tongue =
        1 - stepf(TONGUE_MIDDLE, mixf(TONGUE_ROOTED, TONGUE_ENDS, above), fabsf(wide.c) + 0.3f * fabsf(fine.c));
    const float warm = stepf(0, small_foot * mixf(FOOT_LATE, FOOT_WARM, tongue), foot);
    const float dense = mixf(mixf(FOOT_HAZE, 1, tongue), 1, above);
    float soot = stepf(0, small_foot * mixf(FOOT_BESIDE, FOOT_SOOT, tongue), foot);

    // threads are clear and hot, what is between them is denser and cooler
    const Float3 bent =
        float3_mad(p, float3(wide.b + 0.2f * fine.b, wide.a + 0.2f * fine.a, 0), fire->scale * THREAD_WARP);
    Noise thread = {0, 0, 0, 0};
    if (soot > 0)
        thread = eddies(fire, bent, passed + ROLL * wide.d, sqrtf(fire->scale) * EDDY_THREAD, 3 * sqrtf(fire->scale));
    const float sharp = maxf(3 * minf(THREAD_BLUR / maxf(blur, 1e-6f), 1), 2.2f); // thin ones would look like combs
    float clear =
        stepf(-0.5f, 0.6f, 0.15f * (wide.d + fine.d) + torn * (0.57f - 0.17f * (3 - sharp) - sharp * fabsf(thread.a)));

    // filaments along the flow, and gaps between them, through which what is behind is seen
    float filament = 0, pane = 0;
    if (above > 0) {
        const Noise n =
            eddies(fire, bent, passed + ROLL * wide.d, sqrtf(fire->scale) * EDDY_FILAMENT, 2 * sqrtf(fire->scale));
        filament = above * minf(1.5f * THREAD_BLUR / maxf(blur, 1e-6f), 1) *
                   clampf(0.55f - 2.6f * maxf(n.a, -FOLD_SHARP * n.a) + 0.9f * n.b, -1, 1);
        pane = above * clampf(1.6f * n.d + 0.8f * thread.d, -1, 1);
    }

    float core = stepf(0.35f, 0.7f, flame) * stepf(CORE_BEGINS, CORE_FULL, rise);
    float strong = stepf(0, 0.7f, edge), low = 1 - stepf(0.1f, 0.9f, tall);
    float hot = 0.14f * strong + (0.04f + 0.13f * core) * low + 0.25f * core + 0.74f * clear - 0.14f * tip - 0.138f;
    hot += FILAMENT_HOT * filament + 0.15f * pane * (1 - clear) - HIGH_COOL * stepf(0.1f, 1.5f, tall);
    hot += JOINED_HOT * stepf(1.1f, 1.6f, flame); // where tongues have joined
    hot += LARGE_HOT * clampf(fire->scale - 1, 0, 1);
    hot *= mixf(FOOT_COOL, 1, warm);

    // what is above a body of flame without its noise, is cooler and thinner: tongues end faint
    const float body = stepf(-0.35f, 0.1f, flame - EDGE - TAPER * (1 - expf(-tall)));
    const float spent = stepf(0.5f, 1.6f, tall) * (1 - body);
    hot -= SPENT_COOL * spent;

    soot *= (1 - SPENT_THIN * spent) * dense * stepf(2 * STAND_OFF, 6 * STAND_OFF, rise);
    float root =
        clampf((rise + STAND_OFF) / (8 * STAND_OFF), 0, 1) * (1 - soot) * (1 - stepf(BLUE_ENDS / 2, BLUE_ENDS, rise));
    const float fold = (1 - clear) * (1 - clear) * mixf(0.25f, 1, above);
    soot *= 0.35f + 3.5f * fold * (1 + 0.7f * pane) + 1.2f * clear * clear + FOOT_GLOWS * tongue * (1 - above);
    soot *= BORDER_GAIN * mixf(BORDER_THIN, 1, stepf(0, fire->scale * BORDER_WIDE, point->depth));
    soot *= (0.6f + 0.9f * torn * maxf(thread.b, -0.5f)) * (1 - 0.75f * tip) * (1 + 0.95f * filament);
    point->opaque = SOOT_DENSE * soot * mixf(FOOT_HIDES, 1 + CORE_HIDES * core, above);
    point->soot = float3_scale(flame_colour(fire, clampf(hot, 0, 1)), SOOT_DENSE * soot);
    point->root = float3_scale(float3(0.28f, 0.56f, 1.18f), BLUE_DENSE * root);
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

/// The flame at p and its gradient per cell, in that order.
static inline Four flame_at(const Fire *fire, Float3 p) {
    Four w[3], v[3], along[3][3], sum = {0, 0, 0, 0};
    const FireCell *first = &fire->cells[spline_at(fire, p, w, v)];
    for (int k = 0; k < 3; k++) { // v in place of w where the gradient's component is along that axis
        const Four low = FLOAT4_SHUFFLE(w[k], v[k], 0, 4, 1, 5), high = FLOAT4_SHUFFLE(w[k], v[k], 2, 6, 3, 7);
        along[0][k] = FLOAT4_SHUFFLE(low, w[k], 0, 1, 4, 4);
        along[1][k] = FLOAT4_SHUFFLE(w[k], low, 1, 1, 7, 6);
        along[2][k] = FLOAT4_SHUFFLE(w[k], high, 2, 2, 4, 5);
    }

    for (int z = 0; z < 3; z++, first += (size_t)fire->size[0] * (size_t)fire->size[1]) {
        Four layer = {0, 0, 0, 0};
        const FireCell *row = first;
        for (int y = 0; y < 3; y++, row += fire->size[0])
            layer +=
                along[1][y] * (along[0][0] * row[0].flame + along[0][1] * row[1].flame + along[0][2] * row[2].flame);
        sum += along[2][z] * layer;
    }

    return sum;
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

FirePoint fire_at_point(const Fire *fire, Float3 p, float blur) {
    FirePoint point = {.depth = FIRE_OUTSIDE};

    // how far the widest eddies move the flame there, and its height above the paper, linear between the cells
    const size_t right = 1, back = (size_t)fire->size[0], up = back * (size_t)fire->size[1];
    const Four at = in_cells(fire, p, 0.005f);
    const Float4Mask whole = __builtin_convertvector(at, Float4Mask);
    const Four f = at - __builtin_convertvector(whole, Four);
    const float(*corner)[4] = (const float(*)[4])fire->sway + cell_number(fire, whole);
    Four layer[2];
    for (int k = 0; k < 2; k++, corner += up) {
        Four a = four_load(corner[0]), b = four_load(corner[back]);
        a += (four_load(corner[right]) - a) * f[0];
        b += (four_load(corner[back + right]) - b) * f[0];
        layer[k] = a + (b - a) * f[1];
    }
    const Four sway = layer[0] + (layer[1] - layer[0]) * f[2];
    p = float3_add(p, float3(sway[0], sway[1], 0));

    // large eddies move it, then small ones
    const float scale = fire->scale, passed = eddies_passed(sway[2] / scale, p.z / scale, fire->moment / sqrtf(scale));
    Noise wide = eddies(fire, p, passed, scale * EDDY_WIDE, 1);
    Float3 shifted = float3_mad(p, float3(wide.a, wide.b, 0), scale * 0.7f * FIRE_WARP_WIDE);

    // whether the small eddies can bring flame there
    const Four near = in_cells(fire, shifted, 0) + 0.5f;
    if (!fire->burns[cell_number(fire, __builtin_convertvector(near, Float4Mask))]) return point;

    Noise fine = eddies(fire, shifted, passed, sqrtf(scale) * EDDY_FINE, FINE_OFTEN * sqrtf(scale));
    const Four flame =
        flame_at(fire, float3_mad(shifted, float3(fine.a, fine.b, 0), sqrtf(scale) * 0.7f * FIRE_WARP_FINE));
    const float slope = sqrtf(flame[1] * flame[1] + flame[2] * flame[2] + flame[3] * flame[3]) / fire->cell;
    if (flame[0] > 0.02f) shade_flame(fire, flame[0], shifted, sway[2], passed, slope, wide, fine, blur, &point);
    return point;
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

    for (int c = 0; c < 3; c++) size[c] = (fire->size[c] - 2 * FIRE_BORDER) * detail;
    size_t i = 0;
    for (int z = 0; z < size[2]; z++)
        for (int y = 0; y < size[1]; y++)
            for (int x = 0; x < size[0]; x++, i++) {
                const Float3 p = float3_mad(origin, float3((float)x, (float)y, (float)z), side);
                const FirePoint point = fire_at_point(fire, p, 0);
                Matter burning = {{0, 0, 0}, 0};
                fire_between(&point, &point, side, &burning);
                const Smoke at = fire_smoke_at(fire, p);
                smoke[i] = fire_smoke_between(fire, &at, &at, 0.5f * side).dense;
                flame[i] = float3_luminance(burning.light) / bright;
            }

    return SINGE_OK;
}
