// Marches rays through flame and smoke.
//
//     dL/ds = j - (a + k) L + k S,   front to back in steps, with j, a of the flame and k, S of the smoke
//                                    (fire_shade.c)

#include "preview/block.h"

#include <string.h>

// of the usual step, in flames: .35 leaves ribs in thin sheets, and longer ones deep inside draw contours of distance where
// eddies fold edges of their own
#define FIRE_SHORT 0.21f
#define FIRE_LEAP 0.3f  ///< of the way to an edge, that a step outside of it may go: the depth is not quite a distance
#define FIRE_NOTED 0.8f ///< of the usual step, which what is noted is longer than
#define SMOKE_APART 0.005f ///< m, between rays that have smoke
#define SMOKE_STEP 0.010f  ///< m, distance at most between the places of a ray where its smoke is looked up
#define HOT_HIDES 0.1f     ///< transmittance below which nothing is seen to shimmer
#define HOT_BEYOND 0.002f  ///< m outside of flames, over which gas is hot
#define FIRE_SOFT 3.0f     ///< rays, over which the edges of flames begin, as depths are rough
#define FIRE_EVEN 0.020f   ///< difference of light, as l / (1 + l), that may be interpolated

/// Smoke is looked up at multiples of a length, and is even between two of them, whatever the steps of the ray are: these
/// differ from ray to ray, and so would what they add up.
typedef struct SmokeLine {
    FireTile *tile; ///< where smoke is shared with other rays; NULL: nowhere
    int ray;
    float length, first; ///< m; number of the place of the nearer of `ends`
    Smoke ends[2];
    Matter mean; ///< between them
    float pixel; ///< its size, per m from the eye
} SmokeLine;

static Smoke smoke_mix(const Smoke *a, const Smoke *b, float part) {
    return (Smoke){.light = float3_mix(a->light, b->light, part),
                   .dense = mixf(a->dense, b->dense, part),
                   .fold = mixf(a->fold, b->fold, part),
                   .old = mixf(a->old, b->old, part)};
}

/// The smoke of a place of one of the rays that have it.
static const Smoke *smoke_shared(const Fire *fire, Float3 eye, FireTile *tile, int column, int row, int place) {
    const int line = row * SMOKE_ACROSS + column;
    Smoke *smoke = &tile->smoke[line][place];
    if (tile->smoke_known[line][place]) return smoke;
    tile->smoke_known[line][place] = true;
    const Float3 ray = tile->rays[tile->apart * (row * FIRE_ACROSS + column)];
    *smoke = fire_smoke_at(fire, float3_mad(eye, ray, (float)(tile->first + place) * tile->length));
    return smoke;
}

/// The smoke of a place of a ray, from the four around it.
static Smoke smoke_place(const Fire *fire, Float3 eye, Float3 d, float number, const SmokeLine *line) {
    FireTile *tile = line->tile;
    const float from = tile ? number - (float)tile->first : -1;
    if (!(from >= 0 && from < SMOKE_PLACES)) return fire_smoke_at(fire, float3_mad(eye, d, number * line->length));
    const int x = line->ray % FIRE_ACROSS, y = line->ray / FIRE_ACROSS, apart = tile->apart, place = (int)from;
    const int column = x / apart, row = y / apart, right = column + (x % apart > 0), down = row + (y % apart > 0);
    const float u = (float)(x % apart) / (float)apart, v = (float)(y % apart) / (float)apart;
    const Smoke upper = smoke_mix(smoke_shared(fire, eye, tile, column, row, place),
                                  smoke_shared(fire, eye, tile, right, row, place), u);
    if (down == row) return upper;
    const Smoke lower = smoke_mix(smoke_shared(fire, eye, tile, column, down, place),
                                  smoke_shared(fire, eye, tile, right, down, place), u);
    return smoke_mix(&upper, &lower, v);
}

/// The mean between a place and the next, on a ray along which they grow.
static const Matter *smoke_after(const Fire *fire, Float3 eye, Float3 d, float first, SmokeLine *line) {
    if (first == line->first) return &line->mean;
    line->ends[0] = first == line->first + 1 ? line->ends[1] : smoke_place(fire, eye, d, first, line);
    line->ends[1] = smoke_place(fire, eye, d, first + 1, line);
    line->mean = fire_smoke_between(fire, &line->ends[0], &line->ends[1], line->pixel * (first + 1) * line->length);
    line->first = first;
    return &line->mean;
}

/// The mean over a step, which is no longer than places are apart.
static Matter smoke_along(const Fire *fire, Float3 eye, Float3 d, float from, float to, SmokeLine *line) {
    const float first = floorf(from / line->length + 1e-3f), beyond = to - (first + 1) * line->length;
    const Matter near = *smoke_after(fire, eye, d, first, line);
    if (beyond <= 1e-3f * line->length) return near;
    const Matter *far = smoke_after(fire, eye, d, first + 1, line);
    const float share = beyond / (to - from);
    return (Matter){float3_mix(near.light, far->light, share), mixf(near.dense, far->dense, share)};
}

// ---- where flames are

/// The parts of a ray that are near flames, in order, as its neighbours have found.
typedef struct Guide {
    int count;
    float runs[4 * FIRE_RUNS][2];
} Guide;

/// Makes a run the last of a view, or extends that.
static void view_extend(FireView *view, float from, float to) {
    float *last = view->run_count ? view->runs[view->run_count - 1] : NULL;
    if (last && (from <= last[1] || view->run_count == FIRE_RUNS)) last[1] = to;
    else memcpy(view->runs[view->run_count++], (const float[2]){from, to}, sizeof *view->runs);
}

static void guide_add(Guide *guide, const FireView *view) {
    for (int k = 0; k < view->run_count; k++) {
        int at = guide->count++;
        for (; at && guide->runs[at - 1][0] > view->runs[k][0]; at--)
            memcpy(guide->runs[at], guide->runs[at - 1], sizeof *guide->runs);
        memcpy(guide->runs[at], view->runs[k], sizeof *guide->runs);
    }
}

/// Whether flames may be near at t; sets *until to where that may change. `run` is the first that does not end before t.
static bool guide_near(const Guide *guide, float t, int *run, float *until) {
    *until = INFINITY;
    if (!guide) return true;
    while (*run < guide->count && guide->runs[*run][1] <= t) ++*run;
    if (*run == guide->count) return false;
    if (guide->runs[*run][0] <= t) return true;
    *until = guide->runs[*run][0];
    return false;
}

/// How many short steps a step is long that begins at a depth: outside the more, the further the edge is. Powers of two, so
/// that what is at an edge is at the same places whatever came before.
static float steps_to_edge(float depth, float little) {
    float times = 1;
    while (2 * times * little <= -FIRE_LEAP * depth) times *= 2;
    return times;
}

/// Where a ray enters and leaves the bounds; it misses them if it leaves no later.
static void fire_pass(const Fire *fire, Float3 eye, Float3 d, float *enters, float *leaves) {
    const float from[3] = {eye.x, eye.y, eye.z}, ray[3] = {d.x, d.y, d.z};
    const float low[3] = {fire->low.x, fire->low.y, fire->low.z}, high[3] = {fire->high.x, fire->high.y, fire->high.z};
    *enters = 0;
    *leaves = INFINITY;
    for (int c = 0; c < 3; c++) {
        const float inverse = 1 / (fabsf(ray[c]) > 1e-9f ? ray[c] : 1e-9f);
        const float a = (low[c] - from[c]) * inverse, b = (high[c] - from[c]) * inverse;
        *enters = maxf(*enters, minf(a, b));
        *leaves = minf(*leaves, maxf(a, b));
    }
}

float fire_leaves(const Fire *fire, Float3 origin, Float3 direction) {
    float enters, leaves;
    fire_pass(fire, origin, direction, &enters, &leaves);
    return leaves;
}

// ---- a ray on its way

/// A ray stops wherever it needs a flame, so that several rays look up theirs together.
typedef struct March {
    const Preview *preview;
    Float3 eye, d;
    FireView *view;
    float t, far;
    float usual, fine, min; ///< m, steps: outside of flames, in them, and the shortest
    float leave;            ///< where it leaves its brick
    float again;            ///< up to where steps are short, as a long one has met an edge
    float until;            ///< where flames may begin
    float next;             ///< end of the step
    float asks;             ///< where it needs a flame
    float soft;             ///< m per m from the eye, over which edges of flames begin
    float clear;
    Float3 light;
    float hot[2];
    int in_brick, what; ///< seen in the brick, and from here
    int run;            ///< of the guide, the next
    bool dark;          ///< long steps until there is flame, longer far from it
    bool known;         ///< whether `here` is the point at t
    bool seek;          ///< the step looks for flames
    bool leaps;         ///< it is longer than such steps are
    bool guided;        ///< else flames may be everywhere
    FirePoint ends[2];  ///< of the step
    int here;           ///< which of them is at t
    SmokeLine line;
    Guide guide;
} March;

static const FirePoint outside = {.depth = FIRE_OUTSIDE};

/// `tile` and `number`: of which it is one; NULL: of none. `coarse`: times as long as usual are its steps in flames.
static void march_begin(March *march, const Preview *preview, Float3 eye, Float3 d, FireTile *tile, int number,
                        float coarse, FireView *view) {
    const Fire *fire = &preview->fire;
    *march = (March){
        .preview = preview, .eye = eye, .d = d, .view = view, .leave = -1, .again = -1, .clear = 1, .dark = true};
    view->count = view->run_count = 0;
    fire_pass(fire, eye, d, &march->t, &march->far);
    march->usual = minf(0.17f * fire->cell, 0.0016f);
    march->fine = coarse * march->usual; // a coarse one seeks flames no less
    march->soft = FIRE_SOFT * (float)(tile ? tile->every : FIRE_EVERY) * preview->camera.pixel;

    // far away a step must still change a float
    march->min = maxf((march->far - march->t) / (16 * FIRE_STEPS), 1e-5f * march->far);
    march->line = (SmokeLine){.length = maxf(minf(fire->cell, SMOKE_STEP), march->min),
                              .first = -2,
                              .ray = number,
                              .pixel = preview->camera.pixel};
    if (tile && tile->apart && march->line.length == tile->length) march->line.tile = tile;
}

/// What is in the brick here, and where the ray leaves it.
static void march_brick(March *march) {
    const Fire *fire = &march->preview->fire;
    const float ray[3] = {march->d.x, march->d.y, march->d.z}, t = march->t, side = FIRE_BRICK * fire->cell;
    const Float3 from = float3_sub(float3_mad(march->eye, march->d, t + 1e-5f), fire->origin);
    const Float3 g = float3_scale(from, 1 / side);
    const float at[3] = {g.x, g.y, g.z};
    size_t brick = 0, over = 1;
    march->leave = INFINITY;
    for (int c = 0; c < 3; c++) {
        float f;
        int i = noise_floor(at[c], &f);
        brick += over * (size_t)(i < 0 ? 0 : i < fire->bricks[c] ? i : fire->bricks[c] - 1);
        over *= (size_t)fire->bricks[c];
        if (fabsf(ray[c]) > 1e-9f) march->leave = minf(march->leave, t + ((ray[c] > 0 ? 1 : 0) - f) * side / ray[c]);
    }
    march->in_brick = fire->seen[brick];
}

/// Goes on to where there is something; false: it has ended.
static bool march_enter(March *march) {
    while (march->t < march->far && march->clear > 0.02f) {
        const float t = march->t;
        if (t >= march->leave) march_brick(march);
        march->what = march->in_brick;
        march->until = INFINITY;
        const Guide *guide = march->guided ? &march->guide : NULL;
        if (march->what & FIRE_FLAME && !guide_near(guide, t, &march->run, &march->until)) march->what &= ~FIRE_FLAME;
        if (march->what) return true;
        march->t = minf(maxf(minf(march->leave, march->far), t) + 2e-5f + 1e-6f * t, march->until);
        march->known = false;
    }
    if (march->t < march->far) // hidden: others may look past what hides it
        view_extend(march->view, march->t, march->far);
    return false;
}

/// The end of the next step. Steps begin at multiples of their length: neighbouring rays then look at neighbouring positions.
static void march_plan(March *march) {
    const bool flame = march->what & FIRE_FLAME;
    const float t = march->t, fine = march->fine, depth = march->ends[march->here].depth;
    march->seek = march->dark && flame;
    const float away = depth > FIRE_OUTSIDE ? 2 * march->usual : 3 * march->usual;
    float length = march->dark ? away : FIRE_SHORT * fine;
    const bool may_leap = flame && !march->dark && t >= march->again;
    const float times = may_leap ? steps_to_edge(depth, FIRE_SHORT * fine) : 1;
    march->leaps = times > 1;
    length *= times;
    const float step = maxf(flame ? length : march->line.length, march->min);
    march->next = minf(maxf((floorf(t / step + 1e-3f) + 1) * step, t + 0.1f * step), march->until);
}

/// Takes the step, whose other end is known, or the same distance again in short steps.
static void march_step(March *march) {
    const FirePoint *here = &march->ends[march->here], *there = &march->ends[!march->here];
    const float step = march->next - march->t, fine = march->fine;
    if (march->leaps && there->depth > -FIRE_SHORT * fine) {
        march->again = march->next;
        return;
    }
    march->dark = there->depth < -2 * march->usual;
    if (march->seek && !march->dark) return;
    if (maxf(here->depth, there->depth) > FIRE_OUTSIDE) view_extend(march->view, march->t, march->next);
    Matter m = {{0, 0, 0}, 0};
    if (march->what & FIRE_SMOKE)
        m = smoke_along(&march->preview->fire, march->eye, march->d, march->t, march->next, &march->line);
    fire_between(here, there, step, &m);
    march->here = !march->here;

    // light of the step, absorbed within the step: (1 - exp(-d)) / d
    float depth = m.dense * step, kept = depth > 0 ? expf(-depth) : 1,
          mean = depth > 1e-3f ? (1 - kept) / depth : 1 - 0.5f * depth;
    march->light = float3_mad(march->light, m.light, march->clear * step * mean);
    march->clear *= kept;

    const float inside = clampf(1 + 0.5f * (here->depth + there->depth) / HOT_BEYOND, 0, 1), hot = inside * step;
    march->hot[0] += hot;
    march->hot[1] += hot * (march->t + 0.5f * step);

    // short steps are noted together, and what is left after the last note is one
    FireView *view = march->view;
    int k = view->count - 1;
    if (k < 0 || view->distance[k] != march->t || march->t - view->from[k] > FIRE_NOTED * fine) {
        k = view->count < FIRE_STEPS ? view->count++ : FIRE_STEPS - 1;
        view->from[k] = march->t;
    }
    view->distance[k] = march->next;
    view->light[k] = march->light;
    view->clear[k] = march->clear;
    memcpy(view->hot[k], march->hot, sizeof march->hot);
    march->t = march->next;
}

/// Goes on to where a ray needs a flame; false: it has ended.
static bool march_on(March *march) {
    while (march_enter(march)) {
        const bool flame = march->what & FIRE_FLAME;
        march->asks = march->t;
        if (!march->known && flame) return true;
        if (!march->known) march->ends[march->here] = outside;
        march->known = true;
        march_plan(march);
        march->asks = march->next;
        if (flame) return true;
        march->ends[!march->here] = outside;
        march_step(march);
    }
    return false;
}

/// Begins the next of several rays; false: there is none.
typedef bool NextMarch(void *rays, March *march);

/// Marches rays to their ends, as many at a time as flames are looked up together.
static void march_all(const Fire *fire, NextMarch *next, void *rays) {
    March marches[FIRE_LANES], *active[FIRE_LANES];
    FirePlaces places;
    FirePoints points;
    int count = 0;
    bool more = true;
    for (int k = 0; k < FIRE_LANES; k++) active[k] = &marches[k];
    for (;;) {
        while (more && count < FIRE_LANES) {
            more = next(rays, active[count]);
            if (more && march_on(active[count])) count++;
        }
        if (!count) return;

        for (int k = 0; k < FIRE_LANES; k++) { // those without a ray are the last one's
            const March *march = active[k < count ? k : count - 1];
            fire_place(&places, k, float3_mad(march->eye, march->d, march->asks), march->soft * march->asks);
        }
        fire->look(fire, count, &places, &points);
        for (int k = count - 1; k >= 0; k--) {
            March *march = active[k];
            march->ends[march->known ? !march->here : march->here] = fire_point(&points, k);
            if (march->known) march_step(march);
            march->known = true;
            if (march_on(march)) continue;
            active[k] = active[--count]; // it has had its flame
            active[count] = march;
        }
    }
}

// ---- the rays of a tile

/// Ray k of a tile that begins at pixel (x, y) and has one every so many pixels.
static Float3 corner_ray(const Preview *preview, int x, int y, int every, int k, Float3 *eye) {
    const float disc[2] = {0, 0};
    float u = 2 * (float)(x + every * (k % FIRE_ACROSS)) / (float)preview->def.width - 1;
    float v = 1 - 2 * (float)(y + every * (k / FIRE_ACROSS)) / (float)preview->def.height;
    Float3 direction;
    camera_ray(&preview->camera, u, v, disc, eye, &direction);
    return direction;
}

/// Corners of a tile whose rays are marched.
typedef struct Corners {
    const Preview *preview;
    FireTile *tile;
    int x, y;  ///< the tile's first pixel
    int apart; ///< those around a corner that are 2 * `apart` from each other have been marched; 0: none have
    int next, count;
    int list[FIRE_ACROSS * FIRE_ACROSS];
} Corners;

/// The rays around a corner guide its own, if they are near enough.
static bool next_corner(void *rays, March *march) {
    Corners *corners = rays;
    if (corners->next == corners->count) return false;
    FireTile *tile = corners->tile;
    const int k = corners->list[corners->next++], apart = corners->apart;
    const int column = k % FIRE_ACROSS, row = k / FIRE_ACROSS, step = 2 * apart;
    Float3 eye;
    tile->rays[k] = corner_ray(corners->preview, corners->x, corners->y, tile->every, k, &eye);
    march_begin(march, corners->preview, eye, tile->rays[k], tile, k, 1, &tile->views[k]);
    march->guided = apart && 1.5f * (float)(tile->every * apart) * tile->pixel < -0.5f * FIRE_OUTSIDE;
    for (int m = 0; march->guided && m < 4; m++) {
        const bool right = m % 2, down = m / 2;
        if ((right && column % step == 0) || (down && row % step == 0)) continue;
        guide_add(&march->guide,
                  &tile->views[(row / step + down) * step * FIRE_ACROSS + (column / step + right) * step]);
    }
    return true;
}

static void see_corners(Corners *corners, bool *known) {
    march_all(&corners->preview->fire, next_corner, corners);
    for (int i = 0; i < corners->count; i++) {
        known[corners->list[i]] = true;
        corners->tile->empty = corners->tile->empty && !corners->tile->views[corners->list[i]].count;
    }
    corners->next = corners->count = 0;
}

/// Prepares a tile for rays from the eye.
static void tile_begin(const Preview *preview, int x, int y, FireTile *tile) {
    const Fire *fire = &preview->fire;
    const Float3 middle = float3_scale(float3_add(fire->low, fire->high), 0.5f);
    const float radius = 0.5f * float3_length(float3_sub(fire->high, fire->low));
    const float distance = float3_length(float3_sub(middle, preview->camera.eye));
    tile->empty = true;
    tile->every = fire_every(preview);
    memset(tile->fine, 0, sizeof tile->fine);
    tile->pixel = preview->camera.pixel * (distance + radius);
    tile->length = minf(fire->cell, SMOKE_STEP);
    tile->first = (int)minf(maxf(distance - radius, 0) / tile->length, 1e9f);
    tile->apart = 0;
    for (int apart = 4; apart > 1 && !tile->apart; apart /= 2)
        if ((float)(tile->every * apart) * tile->pixel < SMOKE_APART * fire->scale) tile->apart = apart;
    if (!tile->apart) return;

    memset(tile->smoke_known, 0, sizeof tile->smoke_known);
    Float3 eye;
    for (int i = 0; i < FIRE_ACROSS; i += tile->apart)
        for (int j = 0; j < FIRE_ACROSS; j += tile->apart)
            tile->rays[i * FIRE_ACROSS + j] = corner_ray(preview, x, y, tile->every, i * FIRE_ACROSS + j, &eye);
}

/// Whether the rays that are known in a square of 3 x 3, the first of which is `k`, see nearly the same.
static bool is_even(const FireTile *tile, const bool *known, int k) {
    float low[2] = {INFINITY, INFINITY}, high[2] = {0, 0};
    for (int m = 0; m < 9; m++) {
        const int i = k + m / 3 * FIRE_ACROSS + m % 3;
        if (!known[i]) continue;
        const FireView *view = &tile->views[i];
        float light = view->count ? float3_luminance(view->light[view->count - 1]) : 0;
        float value[2] = {light / (1 + light), view->count ? 1 - view->clear[view->count - 1] : 0};
        for (int c = 0; c < 2; c++) {
            low[c] = minf(low[c], value[c]);
            high[c] = maxf(high[c], value[c]);
        }
    }

    return high[0] - low[0] < FIRE_EVEN && high[1] - low[1] < 2 * FIRE_EVEN;
}

int fire_every(const Preview *preview) { return is_still(preview) ? 1 : FIRE_EVERY; }

void fire_see(const Preview *preview, int x, int y, FireTile *tile) {
    enum { COUNT = FIRE_ACROSS * FIRE_ACROSS };
    bool known[COUNT] = {false}, wanted[COUNT] = {false};
    Corners corners;
    corners.preview = preview;
    corners.tile = tile;
    corners.x = x;
    corners.y = y;
    corners.next = corners.count = 0;
    tile_begin(preview, x, y, tile);
    for (int apart = 4; apart > 1; apart /= 2) {
        corners.apart = apart == 4 ? 0 : apart;
        for (int i = 0; i < FIRE_ACROSS; i += apart)
            for (int j = 0; j < FIRE_ACROSS; j += apart)
                if (!known[i * FIRE_ACROSS + j]) corners.list[corners.count++] = i * FIRE_ACROSS + j;
        see_corners(&corners, known);
    }

    // a ray between two corners may meet what both miss: then the square beyond it is looked at, too, and so on along a
    // tongue that is thinner than the corners are apart
    corners.apart = 1;
    for (bool again = true; again;) {
        again = false;
        for (int square = 0; square < FIRE_COARSE * FIRE_COARSE; square++) {
            const int first = 2 * (square / FIRE_COARSE) * FIRE_ACROSS + 2 * (square % FIRE_COARSE);
            if (tile->fine[square] || is_even(tile, known, first)) continue;
            again = tile->fine[square] = true;
            for (int m = 0; m < 9; m++) {
                const int k = first + m / 3 * FIRE_ACROSS + m % 3;
                if (!known[k] && !wanted[k]) corners.list[corners.count++] = k;
                wanted[k] = true;
            }
        }
        see_corners(&corners, known);
    }
}

/// The number of steps that are wholly in front of a distance; the next one is partly, by *part.
static int steps_before(const FireView *view, float distance, float *part) {
    int low = 0, high = view->count;
    if (high && view->distance[high - 1] <= distance) low = high;
    while (low < high) {
        int mid = (low + high) / 2;
        if (view->distance[mid] <= distance) low = mid + 1;
        else high = mid;
    }

    *part = 0;
    if (low < view->count && view->from[low] < distance)
        *part = (distance - view->from[low]) / (view->distance[low] - view->from[low]);
    return low;
}

/// Adds a ray's light and transmittance, times a weight.
static void add_view(const FireView *view, float distance, float weight, Float3 *light, float *clear) {
    float part;
    const int low = steps_before(view, distance, &part);
    Float3 sum = low ? view->light[low - 1] : float3(0, 0, 0);
    float left = low ? view->clear[low - 1] : 1;

    if (part > 0) {
        sum = float3_mix(sum, view->light[low], part);
        left = mixf(left, view->clear[low], part);
    }

    *light = float3_mad(*light, sum, weight);
    *clear += weight * left;
}

/// Rays that are in no tile.
typedef struct Lone {
    const Preview *preview;
    const Float3 *origin, *direction;
    float coarse;
    int next, count;
    FireView views[FIRE_LANES];
} Lone;

static bool next_lone(void *rays, March *march) {
    Lone *lone = rays;
    if (lone->next == lone->count) return false;
    const int k = lone->next++;
    march_begin(march, lone->preview, lone->origin[k], lone->direction[k], NULL, 0, lone->coarse, &lone->views[k]);
    return true;
}

void fire_along(const Preview *preview, int count, const Float3 *origin, const Float3 *direction, const float *distance,
                float coarse, Float3 *light, float *clear) {
    Lone lone;
    lone.preview = preview;
    lone.origin = origin;
    lone.direction = direction;
    lone.coarse = coarse;
    lone.next = 0;
    lone.count = count;
    march_all(&preview->fire, next_lone, &lone);
    for (int k = 0; k < count; k++) {
        light[k] = float3(0, 0, 0);
        clear[k] = 0;
        add_view(&lone.views[k], distance[k], 1, &light[k], &clear[k]);
    }
}

/// The rays around a pixel, and their weights.
static void views_around(const FireTile *tile, int x, int y, const FireView *views[4], float weight[4]) {
    x %= FIRE_SQUARES * tile->every;
    y %= FIRE_SQUARES * tile->every;
    const int square = 2 * tile->every;
    const bool fine = tile->fine[y / square * FIRE_COARSE + x / square];
    const int apart = fine ? 1 : 2, side = tile->every * apart; // in rays and in pixels
    const FireView *view = &tile->views[y / side * apart * FIRE_ACROSS + x / side * apart];
    const float right = ((float)(x % side) + 0.5f) / (float)side, down = ((float)(y % side) + 0.5f) / (float)side;
    for (int k = 0; k < 4; k++) {
        views[k] = view + k % 2 * apart + k / 2 * apart * FIRE_ACROSS;
        weight[k] = (k % 2 ? right : 1 - right) * (k / 2 ? down : 1 - down);
    }
}

void fire_until(const FireTile *tile, int x, int y, float distance, Float3 *light, float *clear) {
    const FireView *views[4];
    float weight[4];
    views_around(tile, x, y, views, weight);
    *light = float3(0, 0, 0);
    *clear = 0;
    for (int k = 0; k < 4; k++) add_view(views[k], distance, weight[k], light, clear);
}

bool fire_is_hot(const FireTile *tile, int x, int y) {
    const int every = tile->every, wide = BLOCK / every;
    const int column = x % (FIRE_SQUARES * every) / every, row = y % (FIRE_SQUARES * every) / every;
    for (int k = 0; k < 4; k++) {
        const FireView *view = &tile->views[(row + k / 2 * wide) * FIRE_ACROSS + column + k % 2 * wide];
        const int last = view->count - 1;
        if (last >= 0 && view->hot[last][0] > 0 && view->clear[last] > HOT_HIDES) return true;
    }
    return false;
}

float fire_heats(const FireTile *tile, int x, int y, float distance, float *where) {
    const FireView *views[4];
    float weight[4], hot[2] = {0, 0};
    views_around(tile, x, y, views, weight);
    for (int k = 0; k < 4; k++) {
        float part;
        const int low = steps_before(views[k], distance, &part);
        for (int c = 0; c < 2; c++) {
            const float sum = low ? views[k]->hot[low - 1][c] : 0;
            hot[c] += weight[k] * (part > 0 ? mixf(sum, views[k]->hot[low][c], part) : sum);
        }
    }
    *where = hot[0] > 0 ? hot[1] / hot[0] : 0;
    return hot[0];
}
