// Splits a face's ring of corners into loops that can be cut into triangles. Parts that double back are left out. Where
// the ring returns to a vertex it is split in two, unless the part in between is a hole.
#include "mesh/loops.h"

#include "common/real.h"

#include <string.h>

/// Max distance from a side at which a corner of the same face lies on it, as a share of the side's length.
static const double beside = 1e-5;

static uint32_t vertex_of(const Loops *loops, uint32_t half) { return loops->cut.faces->corner[half]; }
static const double *position_of(const Loops *loops, uint32_t half) {
    return loops->cut.work->position[vertex_of(loops, half)];
}

bool loops_begin(Loops *loops, Work *work, const Faces *faces) {
    if (!polygon_begin(&loops->cut, work, faces)) return false;
    const uint32_t max = loops->cut.capacity;
    loops->ring = work_new(work, max, sizeof *loops->ring);
    loops->stack = work_new(work, max, sizeof *loops->stack);
    loops->corner = work_new(work, 2 * (size_t)max, sizeof *loops->corner);
    loops->end = work_new(work, (size_t)max + 1, sizeof *loops->end);
    loops->triangles = work_new(work, (size_t)max + 1, sizeof *loops->triangles);
    return !work->no_memory;
}

// ---- spikes

/// Leaves out corners at which the ring doubles back, to the same vertex or without area, and repeated vertices. Returns
/// the number of corners left.
static uint32_t leave_out_spikes(const Loops *loops, uint32_t *ring, uint32_t n) {
    uint32_t good = 0; // consecutive corners that stay
    for (uint32_t at = 0; n >= 3 && good < n;) {
        at %= n;
        const uint32_t a = ring[(at + n - 1) % n], b = ring[at], c = ring[(at + 1) % n];
        bool spike = vertex_of(loops, a) == vertex_of(loops, c) || vertex_of(loops, a) == vertex_of(loops, b);
        if (!spike) {
            double p[3], q[3], normal[3];
            sub3(position_of(loops, a), position_of(loops, b), p);
            sub3(position_of(loops, c), position_of(loops, b), q);
            cross3(p, q, normal);
            spike = dot3(p, q) > 0 && dot3(normal, normal) <= FACE_THIN * FACE_THIN * dot3(p, p) * dot3(q, q);
        }

        if (!spike) {
            at++;
            good++;
            continue;
        }

        memmove(ring + at, ring + at + 1, (n - 1 - at) * sizeof *ring);
        n--;
        at = (at + n - 1) % (n ? n : 1); // the corner before may be a spike now
        good = good > 2 ? good - 2 : 0;
    }

    return n >= 3 ? n : 0;
}

static bool has_repeats(const Loops *loops, const uint32_t *ring, uint32_t n) {
    for (uint32_t i = 1; i < n; i++)
        for (uint32_t k = 0; k < i; k++)
            if (vertex_of(loops, ring[i]) == vertex_of(loops, ring[k])) return true;
    return false;
}

// ---- loops

static void end_loop(Loops *loops, const uint32_t *ring, uint32_t n) {
    uint32_t *to = loops->corner + loops->end[loops->count];
    memcpy(to, ring, n * sizeof *ring);
    n = leave_out_spikes(loops, to, n);
    if (!n) return;
    loops->end[loops->count + 1] = loops->end[loops->count] + n;
    loops->count++;
}

/// Splits a ring at the vertices that it names twice: at all of them, or only where both parts have the winding of the
/// whole, so that holes stay with their surroundings.
static void fall_apart(Loops *loops, uint32_t n, bool all) {
    double normal[3];
    polygon_normal(&loops->cut, loops->ring, n, normal);
    double left = dot3(normal, normal);
    const double min = 1e-9 * left;
    uint32_t depth = 0;
    loops->count = loops->end[0] = 0;

    for (uint32_t i = 0; i < n; i++) {
        for (uint32_t at = depth; at-- > 0;) {
            if (vertex_of(loops, loops->stack[at]) != vertex_of(loops, loops->ring[i])) continue;

            double area = 0, part[3]; // along the normal of the whole
            if (depth - at >= 3) {
                polygon_normal(&loops->cut, loops->stack + at, depth - at, part);
                area = dot3(part, normal);
            }

            if (!all && fabs(area) > min && !(area > 0 && left - area > min)) continue;
            end_loop(loops, loops->stack + at, depth - at);
            left -= area;
            depth = at;
        }
        loops->stack[depth++] = loops->ring[i];
    }

    end_loop(loops, loops->stack, depth);
}

bool loops_is_flat(const Loops *loops, const uint32_t *ring, uint32_t n) {
    double longest = 0, area = 0;
    for (uint32_t i = 0; i < n; i++) {
        double p[3], q[3], m[3];
        const double *a = position_of(loops, ring[i]), *b = position_of(loops, ring[(i + 1) % n]);
        longest = double_max(longest, distance3(a, b));
        sub3(a, position_of(loops, ring[0]), p);
        sub3(b, position_of(loops, ring[0]), q);
        cross3(p, q, m);
        area += sqrt(dot3(m, m));
    }

    return !(area > FACE_THIN * longest * longest);
}

/// Cuts the loops into triangles, except those without area and those with the corners of an earlier one. False if one
/// crosses itself or another.
static bool cut_loops(Loops *loops) {
    double largest[3] = {0}, normal[3];
    loops->cut.count = 0;
    for (uint32_t k = 0; k < loops->count; k++) {
        const uint32_t *ring = loops->corner + loops->end[k], n = loops->end[k + 1] - loops->end[k];
        loops->triangles[k] = loops->cut.count;
        polygon_normal(&loops->cut, ring, n, normal);

        bool idle = loops_is_flat(loops, ring, n);
        for (uint32_t other = 0; other < k && !idle; other++) {
            idle = loops->end[other + 1] - loops->end[other] == n;
            for (uint32_t i = 0; i < n && idle; i++) {
                uint32_t j = 0, own = vertex_of(loops, ring[i]);
                while (j < n && vertex_of(loops, loops->corner[loops->end[other] + j]) != own) j++;
                idle = j < n;
            }
        }

        if (idle) continue;
        if (!polygon_cut(&loops->cut, ring, n)) return false;
        if (dot3(normal, normal) > dot3(largest, largest)) memcpy(largest, normal, sizeof largest);
    }

    loops->triangles[loops->count] = loops->cut.count;
    return loops->cut.count <= 2 || !polygon_overlaps(&loops->cut, largest);
}

bool loops_is_star(Loops *loops, uint32_t loop) {
    return polygon_is_star(&loops->cut, loops->corner + loops->end[loop], loops->end[loop + 1] - loops->end[loop]);
}

FaceKind loops_find(Loops *loops, uint32_t face) {
    const Faces *faces = loops->cut.faces;
    const uint32_t corners = faces->first[face + 1] - faces->first[face];
    for (uint32_t i = 0; i < corners; i++) loops->ring[i] = faces->first[face] + i;
    loops->repeats = has_repeats(loops, loops->ring, corners);
    uint32_t n = leave_out_spikes(loops, loops->ring, corners);
    loops->spikes = n < corners && !loops->repeats;
    if (n == 0) return FACE_IDLE;

    const bool repeats = loops->repeats && has_repeats(loops, loops->ring, n);
    if (!repeats && (n == 3 || polygon_is_star(&loops->cut, loops->ring, n))) {
        loops->count = loops->end[0] = 0;
        end_loop(loops, loops->ring, n);
        return loops_is_flat(loops, loops->ring, n) ? FACE_IDLE : FACE_WHOLE;
    }

    // corners that lie on a side of the ring become corners of that side, too
    for (uint32_t i = 0; i < n && n < loops->cut.capacity; i++) {
        const uint32_t a = loops->ring[i], b = loops->ring[(i + 1) % n];
        double d[3], nearest = 1;
        uint32_t on = MESH_NONE; // the one nearest to a
        sub3(position_of(loops, b), position_of(loops, a), d);

        const double square = dot3(d, d);
        for (uint32_t other = 0; other < n; other++) {
            const uint32_t half = loops->ring[other];
            double e[3], off[3];
            sub3(position_of(loops, half), position_of(loops, a), e);
            double t = dot3(e, d) / square;
            if (!(t > beside && t < 1 - beside && t < nearest)) continue;

            for (int k = 0; k < 3; k++) off[k] = e[k] - t * d[k];
            if (dot3(off, off) <= beside * beside * square) {
                nearest = t;
                on = half;
            }
        }

        if (on == MESH_NONE) continue;
        memmove(loops->ring + i + 2, loops->ring + i + 1, (n - 1 - i) * sizeof *loops->ring);
        loops->ring[i + 1] = on;
        n++;
    }

    for (int all = 0; all < 2; all++) {
        fall_apart(loops, n, all);
        if (cut_loops(loops)) return loops->cut.count ? FACE_CUT : FACE_IDLE;
    }

    return FACE_CROSSED;
}
