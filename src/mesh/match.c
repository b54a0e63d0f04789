// A maximum matching of a graph: pairs are swapped along paths from one single node to another, and odd cycles are
// shrunk to a point when they are met (Edmonds, Paths, trees, and flowers, 1965). The search for one path visits a
// limited number of nodes, so that the whole is linear in practice.
#include "mesh/work.h"

#include <string.h>

enum {
    MATCH_REACH = 6000,    ///< max nodes that a search may visit if there are many searches
    MATCH_WORK = 20000000, ///< max nodes of all searches together, if there are few
};

typedef struct Match {
    const uint32_t *arc_first, *arc_to;
    const uint8_t *open;
    uint32_t *mate;
    uint32_t *parent, *base; ///< of the search; MESH_NONE and the node itself if not visited
    uint8_t *outer, *blossom;
    uint32_t *queue, *touched; ///< outer nodes to continue from; all nodes that the search has changed
    uint32_t queued, touched_count;
    uint8_t *is_touched;
    uint32_t *on_path; ///< stamp
    uint32_t stamp, reach;
} Match;

static void touch(Match *m, uint32_t v) {
    if (m->is_touched[v]) return;
    m->is_touched[v] = 1;
    m->touched[m->touched_count++] = v;
}

/// Marks the bases on the path from v down to `base`, and reverses its parents.
static void mark_path(Match *m, uint32_t v, uint32_t base, uint32_t child) {
    while (m->base[v] != base) {
        m->blossom[m->base[v]] = m->blossom[m->base[m->mate[v]]] = 1;
        m->parent[v] = child;
        child = m->mate[v];
        v = m->parent[m->mate[v]];
    }
}

/// Shrinks the odd cycle that an edge between two outer nodes closes.
static void shrink_cycle(Match *m, uint32_t v, uint32_t u) {
    // its base: the first that the paths from both nodes to the root have in common
    m->stamp++;
    for (uint32_t a = v;;) {
        a = m->base[a];
        m->on_path[a] = m->stamp;
        if (m->mate[a] == MESH_NONE) break;
        a = m->parent[m->mate[a]];
    }

    uint32_t base = m->base[u];
    while (m->on_path[base] != m->stamp) base = m->base[m->parent[m->mate[base]]];

    for (uint32_t i = 0; i < m->touched_count; i++) m->blossom[m->touched[i]] = 0;
    mark_path(m, v, base, u);
    mark_path(m, u, base, v);

    for (uint32_t i = 0; i < m->touched_count; i++) {
        uint32_t w = m->touched[i];
        if (!m->blossom[m->base[w]]) continue;
        m->base[w] = base;
        if (!m->outer[w]) {
            m->outer[w] = 1;
            m->queue[m->queued++] = w;
        }
    }
}

/// Swaps the pairs along the path from `v`, an inner or a single node, to the root.
static void change_over(Match *m, uint32_t v) {
    while (v != MESH_NONE) {
        uint32_t before = m->parent[v], next = m->mate[before];
        m->mate[v] = before;
        m->mate[before] = v;
        v = next;
    }
}

/// Tries to give the root a mate.
static bool search(Match *m, uint32_t root) {
    touch(m, root);
    m->outer[root] = 1;
    m->queue[m->queued++] = root;

    for (uint32_t at = 0; at < m->queued && m->touched_count < m->reach; at++) {
        uint32_t v = m->queue[at];
        for (uint32_t i = m->arc_first[v]; i < m->arc_first[v + 1]; i++) {
            uint32_t u = m->arc_to[i];
            if (m->base[v] == m->base[u] || m->mate[v] == u) continue;

            if (u == root || (m->mate[u] != MESH_NONE && m->parent[m->mate[u]] != MESH_NONE)) {
                shrink_cycle(m, v, u);
            } else if (m->parent[u] == MESH_NONE) {
                touch(m, u);
                m->parent[u] = v;
                if (m->mate[u] == MESH_NONE) {
                    change_over(m, u);
                    return true;
                }

                uint32_t w = m->mate[u];
                touch(m, w);

                if (m->open && m->open[w]) {
                    m->mate[w] = MESH_NONE;
                    change_over(m, u);
                    return true;
                }

                m->outer[w] = 1;
                m->queue[m->queued++] = w;
            }
        }
    }

    return false;
}

void match_grow(Work *work, uint32_t count, const uint32_t *arc_first, const uint32_t *arc_to, const uint8_t *open,
                uint32_t *mate) {
    Match m = {.arc_first = arc_first, .arc_to = arc_to, .open = open, .mate = mate};
    m.parent = work_new(work, count, sizeof *m.parent);
    m.base = work_sets(work, count);
    m.outer = work_new(work, count, 1);
    m.blossom = work_new(work, count, 1);
    m.is_touched = work_new(work, count, 1);
    m.queue = work_new(work, count, sizeof *m.queue);
    m.touched = work_new(work, count, sizeof *m.touched);
    m.on_path = work_new(work, count, sizeof *m.on_path);
    if (work->no_memory) return;

    memset(m.parent, 0xff, count * sizeof *m.parent);
    uint32_t alone = 1;
    for (uint32_t v = 0; v < count; v++) alone += mate[v] == MESH_NONE && !(open && open[v]);
    m.reach = MATCH_WORK / alone > MATCH_REACH ? MATCH_WORK / alone : MATCH_REACH;

    for (uint32_t v = 0; v < count; v++) {
        if (mate[v] != MESH_NONE || (open && open[v])) continue;
        (void)search(&m, v);

        // forgets the search
        for (uint32_t i = 0; i < m.touched_count; i++) {
            const uint32_t u = m.touched[i];
            m.parent[u] = MESH_NONE;
            m.base[u] = u;
            m.outer[u] = m.blossom[u] = m.is_touched[u] = 0;
        }
        m.touched_count = m.queued = 0;
    }
}
