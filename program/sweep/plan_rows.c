// The rows of a plan: every combination of the values, a list, or random.
//
// A Latin hypercube of n rows cuts each parameter's range into n parts of equal size, draws a number in each part and
// assigns the parts to the rows in random order: McKay, Beckman and Conover, Technometrics 21 (1979) 239.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/printable.h"
#include "formats/number.h"
#include "sweep/sweep_plan.h"

/// A number in [0, 1) of a 64-bit generator (SplitMix64: Steele, Lea and Flood 2014). The rows are the same on every
/// machine.
static double draw_unit(uint64_t *state) {
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return (double)((z ^ z >> 31) >> 11) * 0x1p-53;
}

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

static bool make_values(Plan *plan, uint64_t rows) {
    plan->row_count = (uint32_t)rows;
    plan->values = arena_new(plan->arena, (size_t)rows * plan->parameter_count, sizeof *plan->values);
    return plan->values;
}

/// Whether two values are the same to a scene, as 2, 2.0 and "2" are.
static bool values_agree(const char *a, const char *b) {
    bool in_word = false;
    for (;;) {
        a += strspn(a, " \"");
        b += strspn(b, " \"");

        double x, y;
        const uint8_t *after_a = (const uint8_t *)a, *after_b = (const uint8_t *)b;
        if (!in_word && number_double(&after_a, after_a + strlen(a), &x) == NUMBER_OK &&
            number_double(&after_b, after_b + strlen(b), &y) == NUMBER_OK) {
            if (x != y) return false;
            a = (const char *)after_a;
            b = (const char *)after_b;
            continue;
        }

        if (*a != *b) return false;
        if (!*a) return true;
        in_word = !strchr(" [{,:", *a);
        a++;
        b++;
    }
}

/// Finds values that make two rows the same: of a parameter of a grid, or of all of a list. `message` names them.
static void find_equal_rows(const Plan *plan, uint32_t *parameter, char *message, size_t size) {
    uint32_t stride = 1; // rows between two values of a grid's parameter; the last one varies fastest
    for (uint32_t p = plan->parameter_count; p-- > 0 && !*message;) {
        const bool list = plan->method == PLAN_LIST;
        const uint32_t count = choices(&plan->parameters[p]);
        *parameter = list ? 0 : p;

        for (uint32_t b = 1; b < count && !*message; b++)
            for (uint32_t a = 0; a < b && !*message; a++) {
                bool same = values_agree(plan_value(plan, a * stride, p), plan_value(plan, b * stride, p));
                for (uint32_t q = 0; q < p && list && same; q++)
                    same = values_agree(plan_value(plan, a, q), plan_value(plan, b, q));
                if (same)
                    snprintf(message, size, "%s %u and %u are the same: %.60s", list ? "rows" : "values", a + 1, b + 1,
                             shown(plan_value(plan, b * stride, p)).text);
            }

        if (list) return;
        stride *= count;
    }
}

/// Every combination, or the n-th values of all parameters. `message` says why there are none, about `parameter`.
static void make_chosen(Plan *plan, uint32_t *parameter, char *message, size_t size) {
    const bool list = plan->method == PLAN_LIST;
    uint64_t rows = list ? choices(&plan->parameters[0]) : 1;

    for (uint32_t p = 0; p < plan->parameter_count; p++) {
        const uint32_t count = choices(&plan->parameters[p]);
        *parameter = p;

        if (list && count != rows) {
            snprintf(message, size,
                     "a list needs the same number of values for each parameter: %u here, %u for the first", count,
                     (uint32_t)rows);
            return;
        }

        if (!list) rows *= count;
        if (rows > PLAN_ROWS_MAX) {
            snprintf(message, size, "the %s has more than %d rows", list ? "list" : "grid", PLAN_ROWS_MAX);
            return;
        }
    }

    if (!make_values(plan, rows)) return;

    for (uint32_t row = 0; row < plan->row_count; row++)
        for (uint32_t p = plan->parameter_count, rest = row; p-- > 0;) {
            const uint32_t count = choices(&plan->parameters[p]);
            char **value = &plan->values[(size_t)row * plan->parameter_count + p];
            const uint32_t index = list ? row : rest % count;
            *value = plan->parameters[p].count
                         ? plan->parameters[p].values[index]
                         : range_text(plan, &plan->parameters[p], (double)index / (plan->parameters[p].steps - 1));
            rest /= count;
        }
    if (!arena_failed(plan->arena)) find_equal_rows(plan, parameter, message, size);
}

/// Random values; without memory the arena has failed.
static void make_drawn(Plan *plan) {
    uint32_t *order = arena_new(plan->arena, plan->samples, sizeof *order);
    if (!order || !make_values(plan, plan->samples)) return;

    for (uint32_t p = 0; p < plan->parameter_count; p++) {
        const PlanParameter *parameter = &plan->parameters[p];
        uint64_t state = ((uint64_t)plan->seed << 32) + p; // a parameter's values do not depend on the others

        // a random order of the parts (Fisher and Yates)
        for (uint32_t i = 0; i < plan->samples; i++) order[i] = i;
        for (uint32_t i = plan->samples; i > 1; i--) {
            const uint32_t j = (uint32_t)(draw_unit(&state) * i), kept = order[i - 1];
            order[i - 1] = order[j];
            order[j] = kept;
        }

        for (uint32_t row = 0; row < plan->samples; row++) {
            const double unit = draw_unit(&state);
            const double at = plan->method == PLAN_RANDOM ? unit : (order[row] + unit) / plan->samples;
            char **value = &plan->values[(size_t)row * plan->parameter_count + p];
            if (parameter->count) {
                *value = parameter->values[(uint32_t)(at * parameter->count)];
            } else if (!parameter->whole) {
                *value = range_text(plan, parameter, at);
            } else {
                // all integers are equally likely
                PlanParameter wide = *parameter;
                wide.from = ceil(fmin(parameter->from, parameter->to));
                wide.to = floor(fmax(parameter->from, parameter->to));
                const double number = wide.from + floor(at * (wide.to - wide.from + 1));
                *value =
                    range_text(plan, &wide, wide.to > wide.from ? (number - wide.from) / (wide.to - wide.from) : 0);
            }
        }
    }
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

void plan_make_rows(Plan *plan, bool fit, uint32_t *parameter, char *message, size_t size) {
    const bool drawn = plan->method == PLAN_RANDOM || plan->method == PLAN_LATIN_HYPERCUBE, chosen = !fit && !drawn;
    for (uint32_t p = 0; p < plan->parameter_count && !*message; p++) {
        *parameter = p;
        if (fit && (plan->parameters[p].count || plan->parameters[p].steps))
            snprintf(message, size, "a fit needs a range {from: A, to: B} without steps");
        if (chosen && !choices(&plan->parameters[p]))
            snprintf(message, size, "a range needs 'steps' for a grid or a list");
    }

    if (!*message && fit) make_values(plan, plan->evaluations);
    else if (!*message && drawn) make_drawn(plan);
    else if (!*message) make_chosen(plan, parameter, message, size);
}
