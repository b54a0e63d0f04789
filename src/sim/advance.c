// Steps of a fixed length for frames of any length.
#include "sim/calls.h"

#include <string.h>

/// Fraction of a step by which a time of whole steps may fall short. A time_step is a float, and so it is off by up to
/// 6e-8 of itself in each step.
static const double ADVANCE_SLACK = 0.01;

SingeResult call_advance(SingeSim *sim, double seconds, uint32_t steps_max, uint32_t *steps) {
    const double h = (double)sim->def.time_step;
    uint32_t done = 0;

    if (steps) *steps = 0;
    if (!sim->committed)
        return sim_fail(sim, SINGE_ERROR_STATE, "advance", -1, "singe_sim_commit must come before the first step");
    if (!(seconds >= 0 && seconds <= 1e6))
        return sim_fail(sim, SINGE_ERROR_ARGUMENT, "advance", -1, "seconds must be between 0 and 1e6");

    // room for the events of all steps: as many as a simulation can have
    EventList *list = &sim->gathered;
    if (!list->items) {
        if (!NEW(&sim->memory, list->items, sim->events.capacity))
            return sim_fail(sim, SINGE_ERROR_MEMORY, "advance", -1, "out of memory for events");
        list->capacity = sim->events.capacity;
    }

    // steps that fit in the remainder
    list->count = 0;
    sim->gathers = true;
    sim->remainder += seconds;
    while (sim->remainder >= h * (1 - ADVANCE_SLACK)) {
        if (steps_max && done == steps_max) { // a caller that falls behind slows down: whole steps are dropped
            sim->remainder = fmod(sim->remainder, h);
            break;
        }

        TRY(sim_step(sim));
        size_t room = list->capacity - list->count, count = sim->events.count < room ? sim->events.count : room;
        if (count) memcpy(list->items + list->count, sim->events.items, count * sizeof *list->items);
        list->count += count;
        sim->remainder -= h;
        done++;
        if (steps) *steps = done;
    }

    return SINGE_OK;
}

double singe_sim_remainder(const SingeSim *sim) { return sim->remainder; }
