// The rows of a plan: every combination, a list, or random.
//
// A Latin hypercube of n rows cuts each parameter's range into n parts of equal size, draws a number in each part and
// assigns the parts to the rows in random order: McKay, Beckman and Conover, Technometrics 21 (1979) 239.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/number.h"
#include "sweep/sweep_plan.h"

/// A 64-bit generator (SplitMix64: Steele, Lea and Flood 2014). The rows are the same on every machine.
static uint64_t draw(uint64_t *state) {
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

static double draw_unit(uint64_t *state) { return (double)(draw(state) >> 11) * 0x1p-53; }

/// The text of the number at `unit` in [0, 1] of a range.
static char *range_text(Plan *plan, const PlanParameter *parameter, double unit) {
    const double from = parameter->from, to = parameter->to;
    double number = parameter->logarithmic ? exp(log(from) + (log(to) - log(from)) * unit) : from + (to - from) * unit;
    char text[80];
    if (unit == 0) number = from;
    if (unit == 1) number = to;
    if (parameter->whole) number = round(number);
    // 9 digits: more than a float has, and 0.1 remains 0.1
    int length = snprintf(text, sizeof text, "%.9g", number);
    char *value = arena_new(plan->arena, (size_t)length + strlen(parameter->unit) + 2, 1);
    if (value) sprintf(value, "%s%s%s", text, parameter->unit[0] ? " " : "", parameter->unit);
    return value;
}

/// The number of the parameter's values in a grid or a list; 0: not given.
static uint32_t choices(const PlanParameter *parameter) {
    return parameter->count ? parameter->count : parameter->steps;
}

static char *choice(Plan *plan, const PlanParameter *parameter, uint32_t index) {
    if (parameter->count) return parameter->values[index];
    return range_text(plan, parameter, (double)index / (parameter->steps - 1));
}

/// The parameter's value at a coordinate in [0, 1).
static char *value_at(Plan *plan, const PlanParameter *parameter, double unit) {
    if (!parameter->count && !parameter->whole) return range_text(plan, parameter, unit);
    if (parameter->count) return parameter->values[(uint32_t)(unit * parameter->count)];
    // all integers are equally likely
    PlanParameter wide = *parameter;
    wide.from = ceil(fmin(parameter->from, parameter->to));
    wide.to = floor(fmax(parameter->from, parameter->to));
    const double number = wide.from + floor(unit * (wide.to - wide.from + 1));
    return range_text(plan, &wide, wide.to > wide.from ? (number - wide.from) / (wide.to - wide.from) : 0);
}

static bool make_values(Plan *plan, uint64_t rows) {
    plan->row_count = (uint32_t)rows;
    plan->values = arena_new(plan->arena, (size_t)rows * plan->parameter_count, sizeof *plan->values);
    return plan->values;
}

static bool make_grid(Plan *plan, uint32_t *parameter, char *message, size_t size) {
    uint64_t rows = 1;
    for (uint32_t p = 0; p < plan->parameter_count; p++) {
        rows *= choices(&plan->parameters[p]);
        *parameter = p;
        if (rows > PLAN_ROWS_MAX) {
            snprintf(message, size, "the grid has more than %d rows", PLAN_ROWS_MAX);
            return false;
        }
    }
    if (!make_values(plan, rows)) return false;
    for (uint32_t row = 0; row < plan->row_count; row++)
        for (uint32_t p = plan->parameter_count, rest = row; p-- > 0;) {
            const uint32_t count = choices(&plan->parameters[p]);
            plan->values[(size_t)row * plan->parameter_count + p] = choice(plan, &plan->parameters[p], rest % count);
            rest /= count;
        }
    return true;
}

static bool make_list(Plan *plan, uint32_t *parameter, char *message, size_t size) {
    const uint32_t rows = choices(&plan->parameters[0]);
    for (uint32_t p = 1; p < plan->parameter_count; p++)
        if (choices(&plan->parameters[p]) != rows) {
            *parameter = p;
            snprintf(message, size,
                     "a list needs the same number of values for each parameter: %u here, %u for the first",
                     choices(&plan->parameters[p]), rows);
            return false;
        }
    if (!make_values(plan, rows)) return false;
    for (uint32_t row = 0; row < rows; row++)
        for (uint32_t p = 0; p < plan->parameter_count; p++)
            plan->values[(size_t)row * plan->parameter_count + p] = choice(plan, &plan->parameters[p], row);
    return true;
}

/// A random order of 0 to count - 1 (Fisher and Yates).
static void shuffle(uint32_t *order, uint32_t count, uint64_t *state) {
    for (uint32_t i = 0; i < count; i++) order[i] = i;
    for (uint32_t i = count; i > 1; i--) {
        const uint32_t j = (uint32_t)(draw_unit(state) * i), kept = order[i - 1];
        order[i - 1] = order[j], order[j] = kept;
    }
}

static bool make_drawn(Plan *plan) {
    uint32_t *order = arena_new(plan->arena, plan->samples, sizeof *order);
    if (!order || !make_values(plan, plan->samples)) return false;
    for (uint32_t p = 0; p < plan->parameter_count; p++) {
        uint64_t state = ((uint64_t)plan->seed << 32) + p; // a parameter's values do not depend on the others
        shuffle(order, plan->samples, &state);
        for (uint32_t row = 0; row < plan->samples; row++) {
            const double unit = draw_unit(&state);
            const double at = plan->method == PLAN_RANDOM ? unit : (order[row] + unit) / plan->samples;
            plan->values[(size_t)row * plan->parameter_count + p] = value_at(plan, &plan->parameters[p], at);
        }
    }
    return true;
}

static bool make_fit(Plan *plan, uint32_t *parameter, char *message, size_t size) {
    for (uint32_t p = 0; p < plan->parameter_count; p++)
        if (plan->parameters[p].count || plan->parameters[p].steps) {
            *parameter = p;
            snprintf(message, size, "a fit needs a range {from: A, to: B} without steps");
            return false;
        }
    return make_values(plan, plan->evaluations);
}

bool plan_set_row(Plan *plan, uint32_t row, const double *coordinates) {
    bool good = true;
    for (uint32_t p = 0; p < plan->parameter_count; p++) {
        char *value = range_text(plan, &plan->parameters[p], fmin(fmax(coordinates[p], 0), 1));
        plan->values[(size_t)row * plan->parameter_count + p] = value;
        good = good && value;
    }
    return good;
}

bool plan_make_rows(Plan *plan, uint32_t *parameter, char *message, size_t size) {
    message[0] = 0;
    if (plan->target.given) return make_fit(plan, parameter, message, size);
    if (plan->method == PLAN_RANDOM || plan->method == PLAN_LATIN_HYPERCUBE) return make_drawn(plan);
    for (uint32_t p = 0; p < plan->parameter_count; p++)
        if (!choices(&plan->parameters[p])) {
            *parameter = p;
            snprintf(message, size, "a range needs 'steps' for a grid or a list");
            return false;
        }
    if (plan->method == PLAN_LIST) return make_list(plan, parameter, message, size);
    return make_grid(plan, parameter, message, size);
}
