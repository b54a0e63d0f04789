// What sheets hang from, as triangles: clothes-pegs, clips of bent steel and curtain rings, and cords and rods.
//
// All of it is swept: a section with rounded corners goes along a line, and changes its size on the way. Sizes are those of
// real things, in mm, times the scale of what is held, in its axes: `along` the edge, `over` the sheet's face, and `out`.

#include "preview/internal.h"

/// Where a section stands, and half its size. `over` zero: across the line and the side.
typedef struct Station {
    Float3 at, side, over;
    float half[2];
} Station;

enum { ROUND = 3, EDGED = 4 };  ///< vertices of a section's corner: of wires, and of what has edges
enum { BEVEL = 4, MOST = 128 }; ///< sections of a rounded end, and of a line

/// The triangles of a part, in its shape's frame.
typedef struct Builder {
    PreviewHolderPart *part;
    size_t vertex_room, triangle_room;
    bool no_memory;
} Builder;

typedef enum Stuff { WOOD, STEEL, BRASS, ZINC, CORD } Stuff;

/// Begins a part at a point, whose patterns run along x.
static Builder begin(PreviewHolderPart *part, Stuff stuff, const float at[3], Float3 x, Float3 y) {
    static const PreviewShape looks[] = {[WOOD] = {.surface = PREVIEW_SURFACE_WOOD, .colour = {0.62f, 0.44f, 0.26f}},
                                         [STEEL] = {.surface = PREVIEW_SURFACE_METAL, .colour = {0.66f, 0.65f, 0.63f}},
                                         [BRASS] = {.surface = PREVIEW_SURFACE_METAL, .colour = {0.75f, 0.53f, 0.26f}},
                                         [ZINC] = {.surface = PREVIEW_SURFACE_METAL, .colour = {0.66f, 0.65f, 0.63f}},
                                         [CORD] = {.surface = PREVIEW_SURFACE_CORD, .colour = {0.60f, 0.53f, 0.41f}}};
    *part = (PreviewHolderPart){.shape = looks[stuff]};
    part->shape.kind = SINGE_COLLIDER_MESH;
    memcpy(part->shape.position, at, sizeof part->shape.position);
    quat_of_axes(x, y, float3_cross(x, y), part->shape.rotation);
    return (Builder){.part = part};
}

/// Adds a vertex of the world.
static uint32_t put_vertex(Builder *b, Float3 p) {
    PreviewSolid *s = &b->part->solid;
    const size_t size = 3 * ((size_t)s->vertex_count + 1);
    b->no_memory = b->no_memory || !store_grow((SingeAllocator){0}, &s->vertices, &b->vertex_room, size, sizeof(float));
    if (b->no_memory) return 0;
    p = quat_unrotate(b->part->shape.rotation, float3_sub(p, float3_load(b->part->shape.position)));
    float3_store(s->vertices + 3 * (size_t)s->vertex_count, p);
    return s->vertex_count++;
}

static void put_triangle(Builder *b, uint32_t i, uint32_t j, uint32_t k) {
    PreviewSolid *s = &b->part->solid;
    const size_t size = 3 * ((size_t)s->triangle_count + 1);
    b->no_memory = b->no_memory || !store_grow((SingeAllocator){0}, &s->triangles, &b->triangle_room, size, sizeof i);
    if (!b->no_memory) memcpy(s->triangles + 3 * (size_t)s->triangle_count++, (uint32_t[]){i, j, k}, 3 * sizeof i);
}

/// Adds a section's vertices, and joins them to those of the one before, which begin at `before`. Returns the first.
static uint32_t put_section(Builder *b, const Station *s, float radius, float shrink, int corner, int64_t before) {
    const uint32_t sides = 4 * (uint32_t)corner;
    const float inner = maxf(radius - shrink, 0);
    uint32_t first = 0;
    for (uint32_t k = 0; k < sides; k++) {
        const uint32_t quarter = k / (uint32_t)corner, step = k % (uint32_t)corner;
        const float turn = PI_F / 6 * ((float)(3 * quarter + step) + (corner == ROUND ? 0.5f : 0));
        const float x = (s->half[0] - radius) * (quarter % 3 ? -1.0f : 1.0f) + inner * cosf(turn);
        const float y = (s->half[1] - radius) * (quarter < 2 ? 1.0f : -1.0f) + inner * sinf(turn);
        const uint32_t vertex = put_vertex(b, float3_mad(float3_mad(s->at, s->side, x), s->over, y));
        if (!k) first = vertex;
    }
    for (uint32_t k = 0; k < sides && before >= 0; k++) {
        const uint32_t next = (k + 1) % sides, from = (uint32_t)before;
        put_triangle(b, from + k, from + next, first + next);
        put_triangle(b, from + k, first + next, first + k);
    }
    return first;
}

/// Sweeps along a line whose ends are rounded, or which is closed. The corners have that radius.
static void sweep(Builder *b, Station *line, int count, float radius, int corner, bool closed) {
    const uint32_t sides = 4 * (uint32_t)corner;
    int64_t before = -1;
    for (int i = 0; i < count + closed; i++) {
        Station s = line[i % count];
        const int last = i > 0 || closed ? (i + count - 1) % count : 0,
                  next = i + 1 < count || closed ? (i + 1) % count : i;
        const Float3 forward = float3_unit(float3_sub(line[next].at, line[last].at));
        s.side = float3_unit(float3_mad(s.side, forward, -float3_dot(s.side, forward)));
        if (float3_dot(s.over, s.over) > 0) s.side = line[i % count].side;
        else s.over = float3_cross(forward, s.side);

        // the ends in several sections, the first or the last with a face
        const bool begins = i == 0 && !closed, ends = i + 1 == count && !closed;
        for (int k = 0; k < (begins || ends ? BEVEL : 1); k++) {
            const float turn = 0.5f * PI_F * (float)(begins ? k : BEVEL - 1 - k) / (BEVEL - 1);
            const float shrink = begins || ends ? radius * (1 - sinf(turn)) : 0, away = radius * cosf(turn);
            Station part = s;
            if (begins || ends) part.at = float3_mad(s.at, forward, (begins ? 1.0f : -1.0f) * (radius - away));
            before = put_section(b, &part, radius, 0.95f * shrink, corner, before);
            if (!(begins && k == 0) && !(ends && k == BEVEL - 1)) continue;
            const uint32_t middle = put_vertex(b, part.at), from = (uint32_t)before;
            for (uint32_t j = 0; j < sides; j++)
                put_triangle(b, middle, from + (begins ? (j + 1) % sides : j), from + (begins ? j : (j + 1) % sides));
        }
    }
}

/// A round wire through points; `side` is across its beginning.
static void wire(Builder *b, const Float3 *points, int count, float radius, Float3 side, bool closed) {
    Station line[MOST];
    for (int i = 0; i < count; i++) {
        const Float3 to = points[i + 1 < count ? i + 1
                                 : closed      ? 0
                                               : i],
                     from = points[i > 0    ? i - 1
                                   : closed ? count - 1
                                            : 0];
        const Float3 forward = float3_unit(float3_sub(to, from));
        side = float3_unit_or(float3_mad(side, forward, -float3_dot(side, forward)), side);
        line[i] = (Station){.at = points[i], .side = side, .half = {radius, radius}};
    }
    sweep(b, line, count, radius, ROUND, closed);
}

// ---- what is held

static float unit_of(const PreviewHeld *h) { return 0.001f * h->scale; }

/// A point, in mm at the scale of what is held.
static Float3 spot(const PreviewHeld *h, float along, float over, float out) {
    const float u = unit_of(h);
    const Float3 p = float3_mad(float3_load(h->at), float3_load(h->along), u * along);
    return float3_mad(float3_mad(p, float3_load(h->over), u * over), float3_load(h->out), u * out);
}

// ---- clothes-pegs

#define PEG_BITE 12.0f ///< mm of the sheet between the jaws
#define PEG_CORD 6.0f  ///< mm from the edge to the cord
#define CORD_RADIUS 1.3f

/// One of its two prongs, on the side that the sign says.
static void peg_prong(Builder *b, const PreviewHeld *h, float sign) {
    // mm from the tip, and there from the sheet to its faces: jaws, notch of the cord, groove of the coil, handle; outside,
    // the groove of the wire
    static const float rows[][3] = {
        {0, 0.3f, 1.9f},     {2, 0.15f, 2.7f},    {6, 0.15f, 4.0f},    {11, 0.15f, 5.3f},   {15.2f, 0.2f, 5.9f},
        {15.8f, 1.5f, 6.0f}, {17, 2.4f, 6.2f},    {18, 2.6f, 6.3f},    {19, 2.4f, 6.4f},    {20.2f, 1.5f, 6.5f},
        {20.8f, 0.2f, 6.5f}, {21.6f, 0.2f, 5.7f}, {22.8f, 0.2f, 5.7f}, {23.6f, 0.4f, 6.6f}, {24.4f, 1.9f, 6.7f},
        {25.4f, 2.8f, 6.8f}, {27, 3.2f, 6.9f},    {28.6f, 2.9f, 7.0f}, {29.6f, 2.2f, 7.1f}, {31, 1.2f, 7.2f},
        {40, 2.2f, 7.3f},    {50, 3.6f, 7.7f},    {60, 5.0f, 8.7f},    {68, 6.1f, 9.9f},    {72, 6.6f, 10.2f}};
    enum { ROWS = sizeof rows / sizeof *rows };
    const float u = unit_of(h);
    const Float3 side = float3_scale(float3_load(h->along), sign), over = float3_scale(float3_load(h->over), sign);
    Station line[ROWS];
    for (int i = 0; i < ROWS; i++)
        line[i] = (Station){.at = spot(h, 0, 0.5f * sign * (rows[i][1] + rows[i][2]), rows[i][0] - PEG_BITE),
                            .side = side,
                            .over = over,
                            .half = {4.8f * u, 0.5f * u * (rows[i][2] - rows[i][1])}};
    sweep(b, line, ROWS, 0.6f * u, EDGED, false);
}

/// Its spring: a coil between the prongs, whose ends lie in their grooves.
static void peg_spring(Builder *b, const PreviewHeld *h) {
    enum { TURNS = 5, STEPS = 12 };
    const float u = unit_of(h), coil = 27 - PEG_BITE, groove = 22.2f - PEG_BITE;
    Float3 points[TURNS * STEPS + 1];
    for (int i = 0; i <= TURNS * STEPS; i++) {
        const float turn = 2 * PI_F * (float)i / STEPS;
        points[i] = spot(h, 10.4f * ((float)i / (TURNS * STEPS) - 0.5f), 2.5f * sinf(turn), coil + 2.5f * cosf(turn));
    }
    wire(b, points, TURNS * STEPS + 1, 0.75f * u, float3_load(h->along), false);
    for (int side = -1; side <= 1; side += 2) {
        const float s = (float)side;
        const Float3 arm[] = {spot(h, 5.5f * s, 1.5f * s, coil + 2),
                              spot(h, 5.7f * s, 4.2f * s, coil - 1),
                              spot(h, 5.6f * s, 5.7f * s, groove + 0.5f),
                              spot(h, 4.9f * s, 6.3f * s, groove),
                              spot(h, 0, 6.4f * s, groove),
                              spot(h, -4.4f * s, 6.3f * s, groove)};
        wire(b, arm, 6, 0.75f * u, float3_load(h->out), false);
    }
}

// ---- clips

#define CLIP_WIDEST 18.0f ///< mm, half
#define CLIP_LIP 7.5f     ///< mm, from the edge of what it holds down to the middle of its rolled lips
#define CLIP_ROLL 1.6f    ///< mm, radius of these
#define CLIP_BACK 13.0f   ///< mm, from the edge up to its back

/// Half of what is between its lips, and half of its back, in mm.
static float clip_gap(const PreviewHeld *h) { return 0.5f * h->gape / unit_of(h) + 0.6f; }
static float clip_back(const PreviewHeld *h) { return maxf(clip_gap(h) + 0.5f, 8.5f); }

/// Its spring: a plate that is bent to a back and two jaws, which end in rolled lips.
static void clip_body(Builder *b, const PreviewHeld *h) {
    enum { ROLL = 12, BEND = 6, HALF = ROLL + BEND };
    const float u = unit_of(h), half = minf(0.5f * h->width / u, CLIP_WIDEST), thick = 0.45f, bend = 3.5f;
    Station line[2 * HALF];
    for (int i = 0; i < HALF; i++) {
        // the roll from within to where it meets the jaw, and the bend from the jaw to the back
        const bool rolls = i < ROLL;
        const float turn =
            PI_F * (rolls ? 2.35f - 1.35f * (float)i / (ROLL - 1) : 0.5f * (float)(i - ROLL) / (BEND - 1));
        const float radius = rolls ? CLIP_ROLL : bend,
                    over = rolls ? clip_gap(h) + thick + CLIP_ROLL : clip_back(h) - bend,
                    out = rolls ? -CLIP_LIP : CLIP_BACK - bend;
        const float away = over + radius * cosf(turn), up = out + radius * sinf(turn);
        for (int side = 0; side < 2; side++)
            line[side ? 2 * HALF - 1 - i : i] = (Station){.at = spot(h, 0, side ? -away : away, up),
                                                          .side = float3_load(h->along),
                                                          .half = {half * u, thick * u}};
    }
    sweep(b, line, 2 * HALF, 0.9f * thick * u, EDGED, false);
}

/// One of its two arms, on the side that the sign says: a wire from the lip over the jaw, that goes on beyond the back.
static void clip_arm(Builder *b, const PreviewHeld *h, float sign) {
    enum { SIDE = 5, TIP = 9 };
    const float wide = minf(0.5f * h->width / unit_of(h), CLIP_WIDEST) / CLIP_WIDEST, thick = 1.0f;
    const float lip = clip_gap(h) + 0.45f + CLIP_ROLL, lean = clip_back(h) + 1.6f, tip = 5 * wide, far = CLIP_BACK + 13;
    // from the lip to the tip: along, over and out
    const float way[SIDE][3] = {{13 * wide, lip, -CLIP_LIP},
                                {9.4f * wide, lip, -CLIP_LIP},
                                {8.6f * wide, lip + 1.0f, -CLIP_LIP + 1.2f},
                                {6.6f * wide, lean, CLIP_BACK - 3},
                                {5.1f * wide, lean + 0.2f, far}};
    Float3 points[2 * SIDE + TIP];
    for (int i = 0; i < SIDE; i++) {
        points[i] = spot(h, way[i][0], sign * way[i][1], way[i][2]);
        points[2 * SIDE + TIP - 1 - i] = spot(h, -way[i][0], sign * way[i][1], way[i][2]);
    }
    for (int i = 0; i < TIP; i++) {
        const float turn = PI_F * (float)(i + 1) / (TIP + 1);
        points[SIDE + i] = spot(h, tip * cosf(turn), sign * (lean + 0.2f), far + tip * sinf(turn));
    }
    wire(b, points, 2 * SIDE + TIP, thick * unit_of(h), float3_load(h->over), false);
}

/// The rod that it is the end of: a wire, where it hangs.
static void clip_rod(Builder *b, const PreviewHeld *h) {
    const float hangs = h->out[2] > 0.7f ? 0.5f : 1, u = unit_of(h);
    const Float3 from = spot(h, 0, 0, CLIP_BACK), collar = spot(h, 0, 0, CLIP_BACK + 6),
                 far = float3_mad(from, float3_load(h->out), h->reach);
    wire(b, (const Float3[]){from, far}, 2, 1.9f * hangs * u, float3_load(h->along), false);
    wire(b, (const Float3[]){from, collar}, 2, 3.1f * hangs * u, float3_load(h->along), false);
}

// ---- curtain rings

static void circle(Builder *b, const PreviewHeld *h, Float3 middle, float radius, float thick) {
    enum { STEPS = 48 };
    Float3 points[STEPS];
    for (int i = 0; i < STEPS; i++) {
        const float turn = 2 * PI_F * (float)i / STEPS;
        const Float3 p = float3_mad(middle, float3_load(h->out), radius * cosf(turn));
        points[i] = float3_mad(p, float3_load(h->over), radius * sinf(turn));
    }
    wire(b, points, STEPS, thick, float3_load(h->along), true);
}

// ---- all of them

/// A peg hangs a little askew, about its cord.
static void peg(const PreviewHeld *held, uint32_t number, Builder *prongs, Builder *spring) {
    PreviewHeld askew = *held;
    const float turn = 0.07f * (hash_unit(number * 7 + 3) - 0.5f), rise = PEG_CORD * unit_of(held);
    const Float3 x = float3_load(held->out), y = float3_load(held->along);
    const Float3 up = float3_mad(float3_scale(x, cosf(turn)), y, -sinf(turn));
    float3_store(askew.along, float3_mad(float3_scale(y, cosf(turn)), x, sinf(turn)));
    float3_store(askew.at, float3_mad(float3_load(held->at), float3_sub(x, up), rise));
    float3_store(askew.out, up);
    for (int side = -1; side <= 1; side += 2) peg_prong(prongs, &askew, (float)side);
    peg_spring(spring, &askew);
}

/// It rests on its rod, and an eye below it holds the cloth.
static void ring(Builder *b, const PreviewHeld *h) {
    const Float3 out = float3_load(h->out);
    const float u = unit_of(h), thick = 1.3f * u, eye = 2.2f * u, hole = h->drop - 0.6f * eye;
    const float radius = 0.5f * (hole - eye + h->rod);
    const Float3 rod = float3_mad(float3_load(h->at), out, h->drop);
    circle(b, h, float3_mad(rod, out, h->rod + thick - radius), radius, thick);
    circle(b, h, float3_mad(rod, out, -hole), eye, 0.5f * thick);
}

bool preview_holder_grip(PreviewHolder holder, const PreviewHeld *held, uint32_t number,
                         PreviewHolderPart parts[PREVIEW_HOLDER_PARTS]) {
    static const Stuff stuff[][PREVIEW_HOLDER_PARTS] = {[PREVIEW_HOLDER_PEG] = {WOOD, STEEL},
                                                        [PREVIEW_HOLDER_CLIP] = {ZINC, ZINC},
                                                        [PREVIEW_HOLDER_RING] = {BRASS, BRASS}};
    const Float3 out = float3_load(held->out), along = float3_load(held->along);
    float at[3];
    float3_store(at, float3_mad(float3_load(held->at), out, holder == PREVIEW_HOLDER_RING ? held->drop : 0));
    Builder first = begin(&parts[0], stuff[holder][0], at, out, along),
            second = begin(&parts[1], stuff[holder][1], at, out, along);
    parts[0].shape.grips = holder == PREVIEW_HOLDER_PEG;
    if (holder == PREVIEW_HOLDER_PEG) peg(held, number, &first, &second);
    if (holder == PREVIEW_HOLDER_RING) ring(&first, held);
    if (holder == PREVIEW_HOLDER_CLIP) {
        clip_body(&first, held);
        for (int side = -1; side <= 1; side += 2) clip_arm(&second, held, (float)side);
        clip_rod(&second, held);
    }
    return !first.no_memory && !second.no_memory;
}

bool preview_holder_line(PreviewHolder holder, const PreviewHeld *held, uint32_t count, PreviewHolderPart *part) {
    *part = (PreviewHolderPart){.solid = {0}};
    if (holder == PREVIEW_HOLDER_CLIP) return true;
    const bool cord = holder == PREVIEW_HOLDER_PEG;
    const float u = unit_of(held);
    const Float3 along = float3_load(held->along), over = float3_load(held->over);
    // it hangs, as far as it does not stand upright
    const Float3 up = float3_mad(float3(0, 0, 1), along, -along.z);
    enum { STEPS = 16 };
    Float3 points[MOST];
    int used = 0;
    Builder b = begin(part, cord ? CORD : BRASS, held->at, along, over);
    for (uint32_t i = 0; i <= count; i++) {
        const PreviewHeld *from = &held[i ? i - 1 : 0], *to = &held[i < count ? i : i - 1];
        const float rise = cord ? u * PEG_CORD : held->drop;
        Float3 a = float3_mad(float3_load(from->at), float3_load(from->out), rise),
               c = float3_mad(float3_load(to->at), float3_load(to->out), rise);
        const float lift = cord ? 0.08f : 0;
        if (i == 0) a = float3_mad(float3_mad(a, along, -held->reach), up, lift * held->reach);
        if (i == count) c = float3_mad(float3_mad(c, along, held->reach), up, lift * held->reach);
        const float span = float3_length(float3_sub(c, a));
        const int steps = !cord ? 1 : (int)minf(STEPS, (float)(MOST - 2) / (float)(count + 1));
        for (int k = 0; k < steps; k++) {
            const float f = (float)k / (float)steps, sag = cord ? -0.02f * span * f * (1 - f) : 0;
            if (used < MOST - 1) points[used++] = float3_mad(float3_mix(a, c, f), up, sag);
        }
        if (i == count) points[used++] = c;
    }
    part->shape.radius = cord ? CORD_RADIUS * u : held->rod;
    wire(&b, points, used, part->shape.radius, over, false);
    return !b.no_memory;
}
