// The lamps that flames are.
//
// Flames cast the light with which they are drawn: that of the shell of glowing soot (fire_shade.c), which is looked up in each
// cell. Points are drawn from it, each with the same share of the light. They are split into lamps: again and again the
// lamp whose points are furthest apart is cut in two where that leaves the least variance. A lamp shines from the mean of
// its points as light does that is spread over them, and its shadows are those of the points themselves (lamps.c): so they
// are as soft as flames are tall and wide.

#include "preview/internal.h"

// a flame is drawn a few times as bright as white paper, so that its colour stays; in a room by day it is some thirty
// times as bright (a candle of 12 cd and 4 cm2 has 3e4 cd/m2, white paper at 1000 lx 3e2). At night the exposure makes
// up for a part of it. By day the light that flames cast is that much nearer to a real one's, or the room would not flicker
#define CAST 1.7f
#define BY_DAY 4.0f
#define DUSK 1.0f ///< light on white paper, on the scale of `light` and `sky`
#define NOON 1.8f

/// The points of a lamp.
typedef struct Group {
    Float3 *points;
    int count;
    Float3 mean;
    float spread; ///< m2, the sum of their variances along x, y and z, times their number
} Group;

/// A place in a cell, counted from its middle.
static Float3 anywhere(size_t number) {
    const uint32_t key = hash_u32((uint32_t)number);
    return float3(hash_unit(key) - 0.5f, hash_unit(key + 1) - 0.5f, hash_unit(key + 2) - 0.5f);
}

/// Cells whose flames are looked up together.
typedef struct Asked {
    FirePlaces places;
    size_t cells[FIRE_LANES];
    int count;
} Asked;

static void glow(Fire *fire, Asked *asked) {
    FirePoints points;
    fire->look(fire, asked->count, &asked->places, &points);
    for (int k = 0; k < asked->count; k++) {
        const FirePoint point = fire_point(&points, k);
        Matter matter = {{0, 0, 0}, 0};
        fire_between(&point, &point, fire->cell, &matter);
        fire->cells[asked->cells[k]].glow = float3_luminance(matter.light) * fire->cell * fire->cell * fire->cell;
    }
    asked->count = 0;
}

/// Draws points, in the order of the cells. The light of each cell, radiance times area, lies where the light on smoke will be.
/// Returns the number of points.
static int draw_points(Fire *fire, Float3 points[FLAME_POINTS], float *total) {
    Asked asked = {.count = 0};
    int count = 0;
    float sum = 0;
    size_t at = 0;
    *total = 0;
    for (int z = 0; z < fire->size[2]; z++)
        for (int y = 0; y < fire->size[1]; y++)
            for (int x = 0; x < fire->size[0]; x++, at++) {
                const int brick[] = {x / FIRE_BRICK, y / FIRE_BRICK, z / FIRE_BRICK}, *bricks = fire->bricks;
                fire->cells[at].glow = 0;
                if (!(fire->seen[brick[0] + bricks[0] * (brick[1] + bricks[1] * brick[2])] & FIRE_FLAME)) continue;
                const Float3 middle = float3((float)x, (float)y, (float)z), in = float3_add(middle, anywhere(at));
                asked.cells[asked.count] = at;
                fire_place(&asked.places, asked.count++, float3_mad(fire->origin, in, fire->cell), 0);
                if (asked.count == FIRE_LANES) glow(fire, &asked);
            }
    glow(fire, &asked);
    for (size_t i = 0; i < at; i++) *total += fire->cells[i].glow;

    at = 0;
    for (int z = 0; z < fire->size[2]; z++)
        for (int y = 0; y < fire->size[1]; y++)
            for (int x = 0; x < fire->size[0]; x++, at++) {
                sum += fire->cells[at].glow;
                for (; count < FLAME_POINTS && sum * FLAME_POINTS > *total * ((float)count + 0.5f); count++) {
                    const Float3 middle = float3((float)x, (float)y, (float)z),
                                 in = float3_add(middle, anywhere((size_t)count));
                    points[count] = float3_mad(fire->origin, in, fire->cell);
                }
            }
    return count;
}

static float along(Float3 p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

static void sort(Float3 *points, int count, int axis) {
    for (int gap = count / 2; gap > 0; gap /= 2)
        for (int i = gap; i < count; i++) {
            const Float3 p = points[i];
            int k = i;
            for (; k >= gap && along(points[k - gap], axis) > along(p, axis); k -= gap) points[k] = points[k - gap];
            points[k] = p;
        }
}

static int longest(const Float3 *points, int count) {
    Float3 low = points[0], high = low;
    for (int i = 1; i < count; i++) {
        const Float3 p = points[i];
        low = float3(minf(low.x, p.x), minf(low.y, p.y), minf(low.z, p.z));
        high = float3(maxf(high.x, p.x), maxf(high.y, p.y), maxf(high.z, p.z));
    }
    const Float3 size = float3_sub(high, low);
    return size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
}

/// Orders points so that neighbours follow each other: evenly spaced ones then represent them all.
static void order(Float3 *points, int count) {
    if (count < 3) return;
    sort(points, count, longest(points, count));
    order(points, count / 2);
    order(points + count / 2, count - count / 2);
}

static Group group_of(Float3 *points, int count) {
    Group group = {.points = points, .count = count, .mean = {0, 0, 0}};
    for (int i = 0; i < count; i++) group.mean = float3_mad(group.mean, points[i], 1 / (float)count);
    for (int i = 0; i < count; i++) {
        const Float3 to = float3_sub(points[i], group.mean);
        group.spread += float3_dot(to, to);
    }
    return group;
}

/// Sorts a group along its longest axis, and returns how many of its points the first of two parts has.
static int sort_and_cut(Group *group) {
    const int axis = longest(group->points, group->count);
    sort(group->points, group->count, axis);

    // the least variance of two parts is where the square of their sums, counted from the mean, over their numbers is most
    const float middle = along(group->mean, axis);
    float sum = 0, most = 0;
    int first = group->count / 2;
    for (int i = 1; i < group->count; i++) {
        sum += along(group->points[i - 1], axis) - middle;
        const float gained = sum * sum / ((float)i * (float)(group->count - i));
        if (gained <= most) continue;
        most = gained;
        first = i;
    }
    return first;
}

float flame_lamps_add(Preview *preview, int most) {
    PreviewScene *scene = &preview->scene;
    Fire *fire = &preview->fire;
    Group groups[LIGHT_LIMIT];
    scene->flames[0] = scene->flames[1] = scene->light_count;
    if (!fire->visible) return 0;
    float total;
    const int count = draw_points(fire, scene->flame_points, &total);
    if (!count) return 0;

    int lamps = 1;
    groups[0] = group_of(scene->flame_points, count);
    for (; lamps < most; lamps++) {
        int widest = 0;
        for (int k = 1; k < lamps; k++)
            if (groups[k].spread > groups[widest].spread) widest = k;
        if (groups[widest].count < 2) break;
        for (int k = lamps; k > widest + 1; k--) groups[k] = groups[k - 1]; // they stay in the points' order
        Group *group = &groups[widest];
        const int first = sort_and_cut(group);
        group[1] = group_of(group->points + first, group->count - first);
        group[0] = group_of(group->points, first);
    }

    const float day =
        float3_luminance(float3_load(preview->def.sun_colour)) + float3_luminance(float3_load(preview->def.sky_colour));
    const float cast = CAST * mixf(1, BY_DAY, stepf(DUSK, NOON, day)) * total / ((float)count * PI_F);
    const Float3 colour = fire_cast_colour(preview);
    for (int k = 0; k < lamps; k++) {
        order(groups[k].points, groups[k].count);
        const float square = groups[k].spread / (float)groups[k].count + fire->cell * fire->cell;
        light_add(scene, groups[k].mean, float3_scale(colour, cast * (float)groups[k].count), 0.6f * square,
                  sqrtf(square));
        scene->lights.first_point[scene->light_count - 1] = (int)(groups[k].points - scene->flame_points);
        scene->lights.point_count[scene->light_count - 1] = groups[k].count;
    }
    scene->flames[1] = scene->light_count;
    return cast * (float)count * float3_luminance(colour);
}
