// Every spring lies in exactly one strand: a chain through mated ends that starts at an end without a mate, or a ring
// if all have one. A strand that would meet a particle twice is cut before it does, so that its Newton matrix J M^-1
// J^T is tridiagonal; one that returns to its start becomes a ring, whose matrix has two more corner entries. Rings
// have at least three springs: two would share both ends.
#include "shell/strand.h"

#include "shell/family.h"

/// Strands in the order in which they are found. Step 2 s + k crosses spring s from its end k.
typedef struct Trace {
    const LooseSprings *springs;
    uint32_t strand_count;
    uint32_t length;   ///< steps written
    uint32_t *steps;   ///< [springs]
    uint32_t *first;   ///< [springs + 1]
    uint8_t *ring;     ///< [springs]
    uint8_t *done;     ///< [springs] spring is in a strand
    uint32_t *visitor; ///< [particles] last strand at it, SHELL_NONE before
} Trace;

static uint32_t step_from(const LooseSprings *springs, uint32_t step) { return springs->ends[step / 2][step & 1]; }
static uint32_t step_to(const LooseSprings *springs, uint32_t step) { return springs->ends[step / 2][~step & 1]; }

static void begin_strand(Trace *trace, uint32_t particle) {
    trace->first[trace->strand_count] = trace->length;
    trace->visitor[particle] = trace->strand_count;
}

static void end_strand(Trace *trace) { trace->first[++trace->strand_count] = trace->length; }

/// Follows mates from `step` until there is none or its spring is done.
static void trace_from(Trace *trace, uint32_t step) {
    const LooseSprings *springs = trace->springs;
    begin_strand(trace, step_from(springs, step));

    for (;;) {
        uint32_t next = step_to(springs, step), start = trace->first[trace->strand_count];
        bool closes = trace->length - start >= 2 && next == step_from(springs, trace->steps[start]);
        if (trace->visitor[next] == trace->strand_count && !closes) {
            end_strand(trace);
            begin_strand(trace, step_from(springs, step));
        }

        // take the spring
        trace->steps[trace->length++] = step;
        trace->done[step / 2] = 1;
        trace->visitor[next] = trace->strand_count;

        // continue with its mate
        uint32_t mate = springs->mate[step ^ 1];
        bool goes_on = mate != SHELL_NONE && !trace->done[mate / 2];
        if (closes) trace->ring[trace->strand_count] = 1;
        if (closes || !goes_on) end_strand(trace);
        if (!goes_on) return;

        if (closes) begin_strand(trace, next);
        step = mate;
    }
}

static uint32_t trace_length(const Trace *trace, uint32_t s) { return trace->first[s + 1] - trace->first[s]; }

/// The difference of the numbers of a strand's first two particles.
static uint32_t trace_stride(const Trace *trace, uint32_t s) {
    uint32_t step = trace->steps[trace->first[s]];
    uint32_t a = step_from(trace->springs, step), b = step_to(trace->springs, step);
    return a < b ? b - a : a - b;
}

/// Orders strands by length, longest first. Among equals, those whose stride is that of the first longest strand come
/// first, then the order in which they were found.
static bool order_by_length(Memory *memory, const Trace *trace, uint32_t *order) {
    uint32_t first = 0, *rank = NULL, *next = NULL;
    if (trace->strand_count == 0) return true;

    for (uint32_t s = 0; s < trace->strand_count; s++)
        if (trace_length(trace, s) > trace_length(trace, first)) first = s;

    uint32_t longest = trace_length(trace, first), stride = trace_stride(trace, first);
    bool done = NEW(memory, rank, trace->strand_count) && NEW(memory, next, 2 * (size_t)longest + 2);
    for (uint32_t s = 0; s < trace->strand_count && done; s++) {
        rank[s] = 2 * (longest - trace_length(trace, s)) + (trace_stride(trace, s) != stride);
        next[rank[s] + 1]++; // lengths are at least 1
    }

    if (done) {
        for (uint32_t i = 0; i <= 2 * longest; i++) next[i + 1] += next[i];
        for (uint32_t s = 0; s < trace->strand_count; s++) order[next[rank[s]]++] = s;
    }

    FREE(memory, rank, trace->strand_count);
    FREE(memory, next, 2 * (size_t)longest + 2);
    return done;
}

/// Colours the strands, longest first. If strands form several networks without a common particle, as the diagonals of
/// a grid's black and of its white vertices do, the longest of each get family 0: they run side by side, and lanes need
/// neighbours in one family. Returns the number of families, 0 when out of memory.
static uint32_t find_families(Memory *memory, const Trace *trace, uint32_t particle_count, uint32_t *family) {
    uint32_t strands = trace->strand_count, families = 0, total = 0, *order = NULL, *of_item = NULL;
    ItemNodes items = {.node_count = particle_count, .item_count = strands};

    if (NEW(memory, order, strands) && NEW(memory, of_item, strands) && NEW(memory, items.first, (size_t)strands + 1) &&
        NEW(memory, items.nodes, (size_t)trace->length + strands) && order_by_length(memory, trace, order)) {
        // the particles of every strand
        for (uint32_t i = 0; i < strands; i++) {
            uint32_t s = order[i], begin = trace->first[s], end = trace->first[s + 1];
            items.first[i] = total;
            for (uint32_t k = begin; k < end; k++) items.nodes[total++] = step_from(trace->springs, trace->steps[k]);
            if (!trace->ring[s]) items.nodes[total++] = step_to(trace->springs, trace->steps[end - 1]);
        }

        items.first[strands] = total;
        families = family_colour(memory, &items, of_item);
    }

    for (uint32_t i = 0; i < strands && families; i++) family[order[i]] = of_item[i];
    FREE(memory, items.nodes, (size_t)trace->length + strands);
    FREE(memory, items.first, (size_t)strands + 1);
    FREE(memory, of_item, strands);
    FREE(memory, order, strands);
    return families;
}

/// Colours the traced strands, and numbers strands and springs family by family. False when out of memory.
static bool arrange(Memory *memory, uint32_t particle_count, const Trace *trace, SpringSet *set, uint32_t *number) {
    uint32_t strands = trace->strand_count, families = 0, *family = NULL, *sorted = NULL;
    if (NEW(memory, family, strands) && NEW(memory, sorted, strands))
        families = find_families(memory, trace, particle_count, family);
    set->strand_count = strands;
    set->family_count = strands ? families : 0;
    bool done = families && NEW(memory, set->ends, set->count) && NEW(memory, set->rest, set->count) &&
                NEW(memory, set->strand_first, (size_t)strands + 1) && NEW(memory, set->strand_ring, strands) &&
                NEW(memory, set->family_first, (size_t)set->family_count + 1);
    if (done) family_sort(strands, family, set->family_count, set->family_first, sorted);

    uint32_t next = 0;
    for (uint32_t s = 0; s < strands && done; s++) {
        uint32_t begin = trace->first[sorted[s]], end = trace->first[sorted[s] + 1];
        set->strand_first[s] = next;
        set->strand_ring[s] = trace->ring[sorted[s]];
        if (end - begin > set->longest) set->longest = end - begin;

        for (uint32_t k = begin; k < end; k++, next++) {
            set->ends[next][0] = step_from(trace->springs, trace->steps[k]);
            set->ends[next][1] = step_to(trace->springs, trace->steps[k]);
            number[trace->steps[k] / 2] = next;
        }
    }

    if (done) set->strand_first[strands] = next;
    SINGE_ASSERT(!done || next == set->count); // every spring lies in one strand
    FREE(memory, family, strands);
    FREE(memory, sorted, strands);
    return done;
}

SingeResult strand_build(Memory *memory, uint32_t particle_count, const LooseSprings *springs, SpringSet *set,
                         uint32_t *number, SingeError *error) {
    Trace trace = {.springs = springs};
    uint32_t count = springs->count;
    *set = (SpringSet){.count = count};

    bool done = NEW(memory, trace.steps, count) && NEW(memory, trace.first, (size_t)count + 1) &&
                NEW(memory, trace.ring, count) && NEW(memory, trace.done, count) &&
                NEW(memory, trace.visitor, particle_count);
    if (done) {
        for (uint32_t p = 0; p < particle_count; p++) trace.visitor[p] = SHELL_NONE;

        // chains from their ends, then rings
        for (uint32_t end = 0; end < 2 * count; end++)
            if (springs->mate[end] == SHELL_NONE && !trace.done[end / 2]) trace_from(&trace, end);
        for (uint32_t s = 0; s < count; s++)
            if (!trace.done[s]) trace_from(&trace, 2 * s);
        done = arrange(memory, particle_count, &trace, set, number);
    }

    FREE(memory, trace.steps, count);
    FREE(memory, trace.first, (size_t)count + 1);
    FREE(memory, trace.ring, count);
    FREE(memory, trace.done, count);
    FREE(memory, trace.visitor, particle_count);
    if (done) return SINGE_OK;

    strand_free(memory, set);
    return error_set(error, SINGE_ERROR_MEMORY, "sheet", -1, "out of memory for the strands of %u springs", count);
}

void strand_free(Memory *memory, SpringSet *set) {
    FREE(memory, set->ends, set->count);
    FREE(memory, set->rest, set->count);
    FREE(memory, set->grain, set->count);
    FREE(memory, set->strand_first, (size_t)set->strand_count + 1);
    FREE(memory, set->strand_ring, set->strand_count);
    FREE(memory, set->family_first, (size_t)set->family_count + 1);
    *set = (SpringSet){0};
}
