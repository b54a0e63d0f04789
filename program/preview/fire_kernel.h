// Flames at several positions at once, for the instruction set of the file that includes it; FIRE_LOOK names what comes out.
// The page's shaders have shade_flame and eddies_passed from here (scripts/write_look.py), one position at a time.
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
// builds up in it gradually, dim and so thin that the rim shows through; in tongues it builds up faster. Tongues
// are wide at the bottom: with narrow, hot feet they seemed to hang in the air. Young soot is hot, and what is dim is thin:
// it is a clear yellow. Cool and dense, it was a salmon film over lit paper, and rust over char.
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

#include "preview/fire_lanes.h"
#include "preview/wide.h"

// Gas leaves the paper slowly and accelerates: v^2 = BASE_SPEED^2 + 2 BUOYANCY h at the height h. An eddy that was formed
// at the base grows longer as it rises, and moves by the same share of its length in every frame.
#define BASE_SPEED 0.25f  ///< m/s
#define BUOYANCY 2.0f     ///< m/s2
#define EDDY_WIDE 0.0135f ///< m across
#define EDDY_FINE 0.0065f
#define FINE_OFTEN 2.2f
#define EDDY_THREAD 0.010f  ///< of the soot's threads
#define THREAD_BLUR 0.0016f ///< m, blur from which on they are wider
#define EDDY_FILAMENT 0.009f
#define FOLD_SHARP 2.2f         ///< times as steep is the one side of a filament
#define THREAD_WARP 0.01f       ///< m, by which wide eddies bend them
#define ROLL 0.5f               ///< of an eddy's length, by which they roll them
#define BLUE_DENSE 3.6f         ///< 1/m: radiance of the root per metre
#define BLUE_ENDS 0.005f        ///< m above the paper
#define SHELL_RISE 0.0005f      ///< m, w
#define SHELL_RISE_MOST 0.0016f ///< more would dim thin tongues
#define SHELL 0.0018f           ///< m
#define EDGE 0.42f              ///< f at a flame's edge
#define STAND_OFF 0.0006f       ///< m above the paper, below which nothing is visible
#define JOINED_HOT 0.15f
#define LARGE_HOT 0.14f ///< more where flames are twice as large: more soot glows in them
#define FILAMENT_HOT 0.55f
#define HIGH_COOL 0.18f
#define SPENT_COOL 0.25f
#define SPENT_THIN 0.4f
#define FOOT_CLEAR 0.004f   ///< m above the paper, up to which a flame is all foot
#define FOOT_FULL 0.027f    ///< m, from which none of it is foot
#define FOOT_SOOT 0.0075f   ///< m, at which a tongue's middle has all its soot
#define FOOT_BESIDE 0.0145f ///< m, the same beside tongues
#define FOOT_WARM 0.015f    ///< m, at which a tongue's middle is as hot as above
#define FOOT_LATE 0.030f    ///< m, the same beside tongues
#define FOOT_COOL 0.65f     ///< share of the temperature range that fresh soot has
#define FOOT_GLOWS 0.8f     ///< soot glows that much more there
#define FOOT_HIDES 0.4f     ///< and hides that much less: what burns shows through
#define FOOT_HAZE 0.27f     ///< share of the soot that is beside tongues
#define TONGUE_MIDDLE 0.05f ///< value of the noise whose creases are tongues
#define TONGUE_ENDS 0.33f
#define TONGUE_ROOTED 0.6f ///< the same in the foot, where they are wide
#define BORDER_WIDE 0.003f ///< m inside its edge over which a flame thins out: seen edge-on it must not draw an outline
#define BORDER_THIN 0.4f
#define BORDER_GAIN 1.25f   ///< factor on soot that makes up for what the border loses
#define YOUNG_HOT 0.50f     ///< share of the temperature range, below which no young soot is
#define YOUNG_BEGINS 0.006f ///< m above the paper, from which on it may be cooler
#define YOUNG_ENDS 0.025f   ///< m, from which on it may be as cool as any
#define FOOT_BORDER 1.7f    ///< times as wide is the border of a foot, or it is a film with sides
#define FOOT_THIN 0.25f     ///< as BORDER_THIN
#define FOOT_GAIN 1.45f     ///< as BORDER_GAIN, times that
#define CORE_BEGINS 0.0030f ///< m
#define CORE_FULL 0.0240f
#define CORE_HIDES 0.22f ///< more than it glows

// ---- arithmetic that wide.h lacks. What is one number may be given for many.

#define WIDE(x) ((x) - (Wide){0})
#define wide_min(a, b) wide_min(WIDE(a), WIDE(b))
#define wide_max(a, b) wide_max(WIDE(a), WIDE(b))
#define wide_clamp(x, low, high) wide_min(wide_max(x, low), high)
#define wide_mix(a, b, s) mixed(WIDE(a), WIDE(b), WIDE(s))
#define wide_step(a, b, x) step_at(WIDE(a), WIDE(b), WIDE(x))

static inline Wide mixed(Wide a, Wide b, Wide s) { return a + (b - a) * s; }
static inline Wide step_at(Wide a, Wide b, Wide x) {
    const Wide s = wide_clamp((x - a) / (b - a), 0, 1);
    return s * s * (3 - 2 * s);
}
static inline Wide wide_abs(Wide a) { return wide_max(a, -a); }
static inline bool wide_any(WideMask mask) { return wide_bits(mask) != 0; }

/// e to the power of x, within two units of its last place (Cephes, expf). It is 0 far below 0.
static inline Wide wide_exp(Wide x) {
    const Wide bounded = wide_clamp(x, -87, 88), halves = 1.44269504f * bounded;
    const WideMask power = __builtin_convertvector(halves + wide_select(halves < 0, WIDE(-0.5f), WIDE(0.5f)), WideMask);
    const Wide whole = __builtin_convertvector(power, Wide),
               r = bounded - whole * 0.693359375f + whole * 2.12194440e-4f;
    Wide sum = 1.9875691500e-4f * r + 1.3981999507e-3f;
    sum = sum * r + 8.3334519073e-3f;
    sum = sum * r + 4.1665795894e-2f;
    sum = sum * r + 1.6666665459e-1f;
    sum = sum * r + 5.0000001201e-1f;
    return (sum * r * r + r + 1) * (Wide)((power + 127) << 23);
}

static inline Wide3 wide3(Wide x, Wide y, Wide z) { return (Wide3){x, y, z}; }
static inline Wide3 wide3_mad(Wide3 a, Wide3 b, float s) {
    return (Wide3){a.x + b.x * s, a.y + b.y * s, a.z + b.z * s};
}
static inline Wide3 wide3_scale(Wide3 a, Wide s) { return (Wide3){a.x * s, a.y * s, a.z * s}; }
static inline Wide3 wide3_of(Float3 a, Wide s) { return (Wide3){a.x * s, a.y * s, a.z * s}; }

// ---- looking up. What is to be looked up lies in rows of four: each lane has its own vector, and four of them are turned.

typedef struct Noise {
    Wide a, b, c, d;
} Noise;

/// The flames of several positions, as FirePoint.
typedef struct WidePoint {
    Wide3 soot, root;
    Wide depth, profile, shell, opaque;
} WidePoint;

/// Linear between the eight corners of a cell.
static inline Four blend(const float (*corner)[4], size_t back, size_t up, float x, float y, float z) {
    Four layer[2];
    for (int k = 0; k < 2; k++, corner += up) {
        Four a = four_load(corner[0]), b = four_load(corner[back]);
        a += (four_load(corner[1]) - a) * x;
        b += (four_load(corner[back + 1]) - b) * x;
        layer[k] = a + (b - a) * y;
    }
    return layer[0] + (layer[1] - layer[0]) * z;
}

/// `first`: number of the cell's first corner; `f`: the place in the cell.
static inline Noise blend_all(const float (*rows)[4], WideMask first, size_t back, size_t up, Wide3 f) {
    int32_t at[WIDTH];
    float x[WIDTH], y[WIDTH], z[WIDTH], out[4][WIDTH];
    memcpy(at, &first, sizeof at);
    wide_store(x, f.x), wide_store(y, f.y), wide_store(z, f.z);
    for (int lane = 0; lane < WIDTH; lane += 4) {
        Four q[4];
        for (int k = 0; k < 4; k++) q[k] = blend(rows + at[lane + k], back, up, x[lane + k], y[lane + k], z[lane + k]);
        float4_transpose(q);
        for (int k = 0; k < 4; k++) float4_store(&out[k][lane], q[k]);
    }
    return (Noise){wide_load(out[0]), wide_load(out[1]), wide_load(out[2]), wide_load(out[3])};
}

/// The cell of a noise along an axis, and the smooth place in it.
static inline WideMask noise_cell_at(Wide x, Wide *f) {
    WideMask whole = __builtin_convertvector(x, WideMask); // positions are within some kilometres, so they fit
    whole += x < __builtin_convertvector(whole, Wide);
    const Wide part = x - __builtin_convertvector(whole, Wide);
    *f = part * part * (3 - 2 * part);
    return whole & (FIRE_NOISE - 1);
}

static inline Noise noise_at(const Fire *fire, Wide3 p) {
    Wide3 f;
    const WideMask x = noise_cell_at(p.x, &f.x), y = noise_cell_at(p.y, &f.y), z = noise_cell_at(p.z, &f.z);
    return blend_all((const float(*)[4])fire->noise, x + FIRE_CORNERS * (y + FIRE_CORNERS * z), FIRE_CORNERS,
                     FIRE_CORNERS * FIRE_CORNERS, f);
}

typedef Wide Real;
typedef Wide3 Real3;
#define real3 wide3
#include "preview/fire_eddies.h"

/// Places in cells, counted from the centre of the first, within `inside` cells of the bounds.
static inline Wide3 in_cells(const Fire *fire, Wide3 p, float inside) {
    const float each = 1 / fire->cell, less = 1 + inside;
    return (Wide3){wide_clamp((p.x - fire->origin.x) * each, inside, (float)fire->size[0] - less),
                   wide_clamp((p.y - fire->origin.y) * each, inside, (float)fire->size[1] - less),
                   wide_clamp((p.z - fire->origin.z) * each, inside, (float)fire->size[2] - less)};
}

/// The cells that positions lie in, and their places in those.
static inline WideMask cell_numbers(const Fire *fire, Wide3 at, Wide3 *f) {
    const WideMask x = __builtin_convertvector(at.x, WideMask), y = __builtin_convertvector(at.y, WideMask);
    const WideMask z = __builtin_convertvector(at.z, WideMask);
    *f = (Wide3){at.x - __builtin_convertvector(x, Wide), at.y - __builtin_convertvector(y, Wide),
                 at.z - __builtin_convertvector(z, Wide)};
    return x + fire->size[0] * (y + fire->size[1] * z);
}

/// The weights of three cells in a quadratic B-spline, and their changes per cell; f from the middle one.
static inline void spline(Wide f, float weight[3][WIDTH], float change[3][WIDTH]) {
    wide_store(weight[0], 0.5f * (0.5f - f) * (0.5f - f));
    wide_store(weight[1], 0.75f - f * f);
    wide_store(weight[2], 0.5f * (0.5f + f) * (0.5f + f));
    wide_store(change[0], f - 0.5f);
    wide_store(change[1], -2 * f);
    wide_store(change[2], f + 0.5f);
}

/// The sums of 3 x 3 rows, each of three cells along x and one more: by their weights along y and z, and with the change
/// along y, or along z, in place of the weight.
static inline void add_rows(const Fire *fire, const float *first, float y[2][3][WIDTH], float z[2][3][WIDTH], int lane,
                            Four sum[3]) {
    const size_t back = (size_t)fire->size[0], up = back * (size_t)fire->size[1];
    sum[0] = sum[1] = sum[2] = (Four){0};
    for (int k = 0; k < 3; k++, first += up) {
        const Four a = four_load(first), b = four_load(first + back), c = four_load(first + 2 * back);
        const Four row = a * y[0][0][lane] + b * y[0][1][lane] + c * y[0][2][lane];
        const Four change = a * y[1][0][lane] + b * y[1][1][lane] + c * y[1][2][lane];
        sum[0] += row * z[0][k][lane];
        sum[1] += change * z[0][k][lane];
        sum[2] += row * z[1][k][lane];
    }
}

/// The flame at p and, in b, c and d, its gradient per cell.
static inline Noise flame_at(const Fire *fire, Wide3 p) {
    Wide3 f;
    const Wide3 at = in_cells(fire, p, 1);
    const WideMask middle = cell_numbers(fire, (Wide3){at.x + 0.5f, at.y + 0.5f, at.z + 0.5f}, &f);
    const int32_t corner = 1 + fire->size[0] * (1 + fire->size[1]);
    int32_t first[WIDTH];
    float w[3][2][3][WIDTH], sum[3][4][WIDTH];
    memcpy(first, &middle, sizeof first);
    spline(f.x - 0.5f, w[0][0], w[0][1]);
    spline(f.y - 0.5f, w[1][0], w[1][1]);
    spline(f.z - 0.5f, w[2][0], w[2][1]);
    for (int lane = 0; lane < WIDTH; lane += 4) {
        Four rows[3][4];
        for (int k = 0; k < 4; k++) {
            Four own[3];
            add_rows(fire, fire->flames + (first[lane + k] - corner), w[1], w[2], lane + k, own);
            for (int m = 0; m < 3; m++) rows[m][k] = own[m];
        }
        for (int m = 0; m < 3; m++) {
            float4_transpose(rows[m]);
            for (int k = 0; k < 3; k++) float4_store(&sum[m][k][lane], rows[m][k]);
        }
    }

    Wide along[4] = {{0}, {0}, {0}, {0}};
    for (int k = 0; k < 3; k++) {
        const Wide weight = wide_load(w[0][0][k]), row = wide_load(sum[0][k]);
        along[0] += row * weight;
        along[1] += row * wide_load(w[0][1][k]);
        along[2] += wide_load(sum[1][k]) * weight;
        along[3] += wide_load(sum[2][k]) * weight;
    }
    return (Noise){along[0], along[1], along[2], along[3]};
}

/// Whether the small eddies can bring flame there.
static inline WideMask may_burn(const Fire *fire, Wide3 p) {
    Wide3 f;
    const Wide3 at = in_cells(fire, p, 0);
    const WideMask near = cell_numbers(fire, (Wide3){at.x + 0.5f, at.y + 0.5f, at.z + 0.5f}, &f);
    int32_t cells[WIDTH], burns[WIDTH];
    memcpy(cells, &near, sizeof cells);
    for (int k = 0; k < WIDTH; k++) burns[k] = fire->burns[cells[k]] ? -1 : 0;
    WideMask mask;
    memcpy(&mask, burns, sizeof mask);
    return mask;
}

static inline Wide3 flame_colour(const Fire *fire, Wide hot) {
    const Wide x = hot * (FIRE_COLOURS - 1);
    const WideMask number = __builtin_convertvector(wide_min(x, FIRE_COLOURS - 2), WideMask);
    int32_t at[WIDTH];
    float part[WIDTH], out[4][WIDTH];
    memcpy(at, &number, sizeof at);
    wide_store(part, x - __builtin_convertvector(number, Wide));
    for (int lane = 0; lane < WIDTH; lane += 4) {
        Four q[4];
        for (int k = 0; k < 4; k++) {
            const Four a = four_load(&fire->colours[at[lane + k]].x), b = four_load(&fire->colours[at[lane + k] + 1].x);
            q[k] = a + (b - a) * part[lane + k];
        }
        float4_transpose(q);
        for (int k = 0; k < 3; k++) float4_store(&out[k][lane], q[k]);
    }
    return (Wide3){wide_load(out[0]), wide_load(out[1]), wide_load(out[2])};
}

// ---- the flame

/// The number of eddies that have passed z, at a height above what burns, since the start: grows with time, and by one over
/// each eddy. What burns higher up has others: up a sheet that burns everywhere the height stays the same, and by that alone
/// eddies would be as long as the sheet, and its flames a comb.
static inline Wide eddies_passed(Wide height, Wide z, float time) {
    const float steady = (RISE_MOST * RISE_MOST - BASE_SPEED * BASE_SPEED) / (2 * BUOYANCY); // m
    Wide speed = wide_sqrt(BASE_SPEED * BASE_SPEED + 2 * BUOYANCY * wide_clamp(height, 0, steady));
    Wide risen = (speed - BASE_SPEED) / BUOYANCY + wide_max(height - steady, 0) / RISE_MOST; // s
    Wide below = (z - height) / RISE_MOST + wide_min(height, 0) / BASE_SPEED;
    return EDDY_RATE * (time - risen - below);
}

/// The flame at a position p that large eddies have moved, from its share, the gradient of that in 1/m, and the noises.
static inline void shade_flame(const Fire *fire, Wide flame, Wide3 p, Wide rise, Wide passed, Wide slope, Noise wide,
                               Noise fine, Wide blur, WidePoint *point) {
    Wide torn = wide_step(0, 0.02f, rise);
    Wide tall = rise / (fire->scale * FLAME_HEIGHT);
    Wide coarse = 0.075f + 0.425f * torn, small = 0.025f + 0.225f * torn;
    Wide edge = flame + coarse * (0.67f - 2.4f * wide_abs(wide.c)) + small * (0.4f - 2 * wide_abs(fine.c)) - EDGE -
                TAPER * (1 - wide_exp(-tall)) - 0.1f * (1 - torn);
    edge = wide_min(edge, 2 * (flame - FLAME_SEEN));
    Wide noisy = 2 * (coarse / EDDY_WIDE + small / EDDY_FINE) / fire->scale;
    point->depth = wide_max(edge / wide_sqrt(slope * slope + 0.4f * noisy * noisy + 1), FIRE_OUTSIDE);
    if (!wide_any(point->depth > 0)) return;

    // the shell's profile, and its integral from the edge
    Wide tip = wide_step(0.35f, 1.4f, tall), fill = wide_mix(0.02f, 0.12f, tip);
    Wide first = wide_clamp(blur, SHELL_RISE, SHELL_RISE_MOST * fire->scale),
         outer = wide_clamp(point->depth, 0, first), inner = wide_max(point->depth - first, 0);
    Wide fading = (1 - fill) * wide_exp(-inner / SHELL), same = (0.5f * SHELL_RISE + SHELL) / (0.5f * first + SHELL);
    point->profile = same * outer / first * (fill + fading);
    point->shell = same * (0.5f * outer * outer / first + fill * inner + SHELL * (1 - fill - fading));

    const Wide foot = rise + 0.0012f * fine.d + 0.0016f * wide.d;

    // the foot, lower where flames are small, is one sheet along what burns: at first clear and blue; then dim orange soot
    // builds up, in the middle of tongues sooner than beside them
    const float small_foot = minf(fire->scale, 1), range = FLAME_BRIGHT - FLAME_DIM;
    const Wide above = wide_step(small_foot * FOOT_CLEAR, small_foot * FOOT_FULL, rise);
    const Wide tongue = 1 - wide_step(TONGUE_MIDDLE, wide_mix(TONGUE_ROOTED, TONGUE_ENDS, above),
                                      wide_abs(wide.c) + 0.3f * wide_abs(fine.c));
    const Wide warm = wide_step(0, small_foot * wide_mix(FOOT_LATE, FOOT_WARM, tongue), foot);
    const Wide dense = wide_mix(wide_mix(FOOT_HAZE, 1, tongue), 1, above);
    Wide soot = wide_step(0, small_foot * wide_mix(FOOT_BESIDE, FOOT_SOOT, tongue), foot);

    // threads are clear and hot, what is between them is denser and cooler
    const Wide3 bent =
        wide3_mad(p, wide3(wide.b + 0.2f * fine.b, wide.a + 0.2f * fine.a, wide_all(0)), fire->scale * THREAD_WARP);
    Noise thread = {wide_all(0), wide_all(0), wide_all(0), wide_all(0)};
    if (wide_any(soot > 0))
        thread = eddies(fire, bent, passed + ROLL * wide.d, sqrtf(fire->scale) * EDDY_THREAD, 3 * sqrtf(fire->scale));
    const Wide sharp =
        wide_max(3 * wide_min(THREAD_BLUR / wide_max(blur, 1e-6f), 1), 2.2f); // thin ones would look like combs
    Wide clear = wide_step(
        -0.5f, 0.6f, 0.15f * (wide.d + fine.d) + torn * (0.57f - 0.17f * (3 - sharp) - sharp * wide_abs(thread.a)));

    // filaments along the flow, and gaps between them, through which what is behind is seen
    Wide filament = wide_all(0), pane = wide_all(0);
    if (wide_any(above > 0)) {
        const Noise n =
            eddies(fire, bent, passed + ROLL * wide.d, sqrtf(fire->scale) * EDDY_FILAMENT, 2 * sqrtf(fire->scale));
        filament = above * wide_min(1.5f * THREAD_BLUR / wide_max(blur, 1e-6f), 1) *
                   wide_clamp(0.55f - 2.6f * wide_max(n.a, -FOLD_SHARP * n.a) + 0.9f * n.b, -1, 1);
        pane = above * wide_clamp(1.6f * n.d + 0.8f * thread.d, -1, 1);
    }

    Wide core = wide_step(0.35f, 0.7f, flame) * wide_step(CORE_BEGINS, CORE_FULL, rise);
    Wide strong = wide_step(0, 0.7f, edge), low = 1 - wide_step(0.1f, 0.9f, tall);
    Wide hot = 0.14f * strong + (0.04f + 0.13f * core) * low + 0.25f * core + 0.74f * clear - 0.14f * tip - 0.138f;
    hot += FILAMENT_HOT * filament + 0.15f * pane * (1 - clear) - HIGH_COOL * wide_step(0.1f, 1.5f, tall);
    hot += JOINED_HOT * wide_step(1.1f, 1.6f, flame); // where tongues have joined
    hot += LARGE_HOT * wide_clamp(fire->scale - 1, 0, 1);
    hot *= wide_mix(FOOT_COOL, 1, warm);

    // what is above a body of flame without its noise, is cooler and thinner: tongues end faint
    const Wide body = wide_step(-0.35f, 0.1f, flame - EDGE - TAPER * (1 - wide_exp(-tall)));
    const Wide spent = wide_step(0.5f, 1.6f, tall) * (1 - body);
    hot = wide_clamp(hot - SPENT_COOL * spent, 0, 1);

    soot *= (1 - SPENT_THIN * spent) * dense * wide_step(2 * STAND_OFF, 6 * STAND_OFF, rise);
    Wide root = wide_clamp((rise + STAND_OFF) / (8 * STAND_OFF), 0, 1) * (1 - soot) *
                (1 - wide_step(BLUE_ENDS / 2, BLUE_ENDS, rise));
    const Wide fold = (1 - clear) * (1 - clear) * wide_mix(0.25f, 1, above);
    soot *= 0.35f + 3.5f * fold * (1 + 0.7f * pane) + 1.2f * clear * clear + FOOT_GLOWS * tongue * (1 - above);
    const Wide border = fire->scale * BORDER_WIDE * wide_mix(FOOT_BORDER, 1, above);
    soot *= wide_mix(wide_mix(FOOT_THIN, BORDER_THIN, above), 1, wide_step(0, border, point->depth));
    soot *= BORDER_GAIN * wide_mix(FOOT_GAIN, 1, above);
    soot *= (0.6f + 0.9f * torn * wide_max(thread.b, -0.5f)) * (1 - 0.75f * tip) * (1 + 0.95f * filament);

    // low in a flame what would be a cooler soot is thinner, and shines as much
    const Wide seen = wide_max(hot, YOUNG_HOT * (1 - wide_step(YOUNG_BEGINS, YOUNG_ENDS, rise)));
    soot *= (FLAME_DIM + range * hot * hot * hot) / (FLAME_DIM + range * seen * seen * seen);
    point->opaque = SOOT_DENSE * soot * wide_mix(FOOT_HIDES, 1 + CORE_HIDES * core, above);
    point->soot = wide3_scale(flame_colour(fire, seen), SOOT_DENSE * soot);
    point->root = wide3_of(float3(0.28f, 0.56f, 1.18f), BLUE_DENSE * root);
}

/// The flames at WIDTH positions.
static inline WidePoint look(const Fire *fire, Wide3 p, Wide blur) {
    WidePoint point = {.depth = WIDE(FIRE_OUTSIDE)};

    // how far the widest eddies move the flame there, and its height above the paper, linear between the cells
    const size_t back = (size_t)fire->size[0];
    Wide3 f;
    const WideMask corner = cell_numbers(fire, in_cells(fire, p, 0.005f), &f);
    const Noise sway = blend_all((const float(*)[4])fire->sway, corner, back, back * (size_t)fire->size[1], f);
    p.x += sway.a;
    p.y += sway.b;

    // large eddies move it, then small ones
    const float scale = fire->scale;
    const Wide passed = eddies_passed(sway.c / scale, p.z / scale, fire->moment / sqrtf(scale));
    const Noise wide = eddies(fire, p, passed, scale * EDDY_WIDE, 1);
    const Wide3 shifted = wide3_mad(p, wide3(wide.a, wide.b, wide_all(0)), scale * 0.7f * FIRE_WARP_WIDE);
    const WideMask burns = may_burn(fire, shifted);
    if (!wide_any(burns)) return point;

    const Noise fine = eddies(fire, shifted, passed, sqrtf(scale) * EDDY_FINE, FINE_OFTEN * sqrtf(scale));
    const Wide3 there = wide3_mad(shifted, wide3(fine.a, fine.b, wide_all(0)), sqrtf(scale) * 0.7f * FIRE_WARP_FINE);
    const Noise flame = flame_at(fire, there);
    const Wide slope = wide_sqrt(flame.b * flame.b + flame.c * flame.c + flame.d * flame.d) / fire->cell;
    shade_flame(fire, flame.a, shifted, sway.c, passed, slope, wide, fine, blur, &point);
    point.depth = wide_select(burns & (flame.a > 0.02f), point.depth, WIDE(FIRE_OUTSIDE));
    return point;
}

void FIRE_LOOK(const Fire *fire, int count, const FirePlaces *places, FirePoints *points) {
    for (int k = 0; k < count; k += WIDTH) {
        const Wide3 p = {wide_load(&places->x[k]), wide_load(&places->y[k]), wide_load(&places->z[k])};
        const WidePoint point = look(fire, p, wide_load(&places->blur[k]));
        wide_store(&points->depth[k], point.depth);
        if (!wide_any(point.depth > 0)) continue;
        const Wide out[] = {point.soot.x, point.soot.y,  point.soot.z, point.root.x, point.root.y,
                            point.root.z, point.profile, point.shell,  point.opaque};
        for (int c = 0; c < FIRE_VALUES; c++) wide_store(&points->values[c][k], out[c]);
    }
}
