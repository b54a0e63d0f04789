// The public interface to the paper's solver on the caller's own networks (singe/research.h).
#include "common/error.h"
#include "common/store.h"
#include "reference/spring_network.h"
#include "singe/research.h"
#include "sim/sim_internal.h"

#include <math.h>
#include <string.h>

struct SingeNetwork {
    Memory memory;
    Pool *pool;
    Network network;
};

static const SingeNetworkDef network_standard = {
    .struct_size = sizeof(SingeNetworkDef),
#define SINGE_ROWS_STAY
#define SINGE_FIELD(type, name, length, dimension, standard, range, kinds, text) .name = standard,
#define SINGE_OTHER(declaration, name, standard, text) .name = standard,
#include "singe/network.def"
#undef SINGE_ROWS_STAY
#include "singe/rows_end.def"
};

void singe_init_network(SingeNetworkDef *def, size_t struct_size) {
    if (struct_size < sizeof struct_size) return;
    memset(def, 0, struct_size);
    memcpy(def, &network_standard, struct_size < sizeof network_standard ? struct_size : sizeof network_standard);
    memcpy(def, &struct_size, sizeof struct_size);
}

// ---- checks

static SingeResult network_refuse(SingeError *error, int64_t element, const char *what) {
    return error_set(error, SINGE_ERROR_ARGUMENT, "network", element, "%s", what);
}

/// Checks an array that may be NULL: `each` numbers for each of `count`; 0: a field of one number.
static SingeResult network_within(const char *name, const double *values, size_t each, size_t count, SingeError *error,
                                  double low, double high, bool open, const char *words) {
    for (size_t k = 0; values && k < (each ? each * count : 1); k++)
        if (!(values[k] >= low && values[k] <= high) || (open && values[k] == low))
            return error_set(error, SINGE_ERROR_ARGUMENT, "network", each ? (int64_t)(k / each) : -1, "%s must be %s",
                             name, words);
    return SINGE_OK;
}

// A row of the table checks its field.
#undef WITHIN
#undef OVER_UP_TO
#define WITHIN(low, high) low, high, false, "between " #low " and " #high
#define OVER_UP_TO(low, high) low, high, true, "above " #low " and at most " #high
#define SINGE_FIELD(type, name, length, dimension, standard, range, kinds, text) \
    TRY(network_within(#name, &(const double){(double)def->name}, 0, 1, error, range));
#define SINGE_NUMBERS(each, count, name, dimension, range, text) \
    TRY(network_within(#name, def->name, each, def->count, error, range));

static SingeResult network_check(const SingeNetworkDef *def, SingeError *error) {
    if (def->tasks.enqueue && !def->tasks.finish) return network_refuse(error, -1, "tasks.enqueue needs tasks.finish");
    if (def->particle_count == 0 || !def->positions) return network_refuse(error, -1, "there are no particles");
    if (def->spring_count == 0 || !def->ends || !def->lengths) return network_refuse(error, -1, "there are no springs");
    if (def->spring_count > INT32_MAX / 4 || def->particle_count > INT32_MAX / 4)
        return error_set(error, SINGE_ERROR_LIMIT, "network", -1,
                         "too many springs or particles: at most 536870911 of each");
    if (def->set_count == 0 || def->set_count > def->spring_count)
        return network_refuse(error, -1, "set_count must be between 1 and the number of springs");

        // numbers and arrays of them
#include "singe/network.def"

    // ends and sets of the springs
    for (uint32_t k = 0; k < def->spring_count; k++) {
        uint32_t a = def->ends[2 * (size_t)k], b = def->ends[2 * (size_t)k + 1];
        if (a >= def->particle_count || b >= def->particle_count || a == b)
            return network_refuse(error, k, "a spring must end at two different particles");
        if (def->sets && def->sets[k] >= def->set_count)
            return network_refuse(error, k, "a spring's set must be below set_count");
    }

    return SINGE_OK;
}

// ---- creation

static uint32_t set_of(const SingeNetworkDef *def, uint32_t spring) { return def->sets ? def->sets[spring] : 0; }

/// Sorts the springs by set, keeping their order within each.
static SingeResult network_build(const SingeNetworkDef *def, SingeNetwork *network) {
    Memory *memory = &network->memory;
    NetworkSprings *sets;
    uint32_t(*ends)[2], *rows;
    bool ok = NEW(memory, sets, def->set_count);
    ok = NEW(memory, rows, def->set_count) && ok;
    ok = NEW(memory, ends, def->spring_count) && ok;

    SingeResult result = SINGE_ERROR_MEMORY;
    if (ok) {
        // sort the springs by set
        for (uint32_t k = 0; k < def->spring_count; k++) sets[set_of(def, k)].count++;
        for (uint32_t s = 0, first = 0; s < def->set_count; first += sets[s++].count) {
            sets[s].ends = (const uint32_t(*)[2])(ends + first);
            rows[s] = first;
        }

        for (uint32_t k = 0; k < def->spring_count; k++)
            memcpy(ends[rows[set_of(def, k)]++], def->ends + 2 * (size_t)k, sizeof *ends);
        result = network_create(memory, def->particle_count, def->set_count, sets, true, &network->network);
    }

    // numbers
    if (!result) {
        Network *filled = &network->network;
        for (uint32_t i = 0; i < def->particle_count; i++) {
            for (int c = 0; c < 3; c++) filled->position[i][c] = def->positions[3 * (size_t)i + (size_t)c];
            filled->inverse_mass[i] = def->inverse_masses ? def->inverse_masses[i] : 1;
            filled->held[i] = def->held && def->held[i];
        }

        for (uint32_t s = 0; s < def->set_count; s++) {
            rows[s] = 0;
            filled->groups[s].regularisation = def->regularisation;
        }

        // springs, in the rows of their sets
        for (uint32_t k = 0; k < def->spring_count; k++) {
            SpringGroup *group = &filled->groups[set_of(def, k)];
            uint32_t row = rows[set_of(def, k)]++;
            group->length[row] = def->lengths[k];
            group->weight[row] = def->weights ? def->weights[k] : 1;
            group->compliance[row] = def->compliances ? def->compliances[k] : 0;
        }

        filled->rules = (ProjectionRules){.literal = def->literal,
                                          .tolerance = def->tolerance,
                                          .iterations = (uint32_t)def->iterations,
                                          .inverse_h2 = 1 / (def->time_step * def->time_step)};
    }

    FREE(memory, sets, def->set_count);
    FREE(memory, rows, def->set_count);
    FREE(memory, ends, def->spring_count);
    return result;
}

SingeResult singe_network_create(const SingeNetworkDef *given, SingeNetwork **out, SingeError *error) {
    *out = NULL;
    SingeNetworkDef def = network_standard;
    if (!given || !sim_read_def(&def, sizeof def, given, given->struct_size))
        return network_refuse(error, -1, STRUCT_SIZE_UNKNOWN(singe_default_network));

    TRY(network_check(&def, error));
    Memory memory = memory_make(def.allocator);
    SingeNetwork *network = memory_new(&memory, 1, sizeof *network);
    if (!network) return error_set(error, SINGE_ERROR_MEMORY, "network", -1, "out of memory");

    network->memory = memory;
    if (pool_create(&network->memory, def.tasks, def.thread_count, &network->pool) || network_build(&def, network)) {
        singe_network_destroy(network);
        return error_set(error, SINGE_ERROR_MEMORY, "network", -1, "out of memory");
    }

    *out = network;
    return SINGE_OK;
}

void singe_network_destroy(SingeNetwork *network) {
    if (!network) return;
    pool_destroy(&network->memory, network->pool);
    if (network->network.position) network_free(&network->memory, &network->network);
    Memory last = network->memory;
    FREE(&last, network, 1);
}

// ---- use

double *singe_network_positions(SingeNetwork *network) { return network->network.position[0]; }

uint32_t singe_network_set_size(const SingeNetwork *network, uint32_t set) {
    return set < network->network.group_count ? network->network.groups[set].count : 0;
}

SingeResult singe_network_project(SingeNetwork *network, uint32_t set, SingeNetworkReport *report) {
    if (set >= network->network.group_count) return SINGE_ERROR_ARGUMENT;
    ProjectionReport done = network_project(&network->network, set, network->pool);
    if (report) *report = (SingeNetworkReport){done.iterations, done.residual};
    return done.broken ? SINGE_ERROR_DIVERGED : SINGE_OK;
}

double singe_network_errors(const SingeNetwork *network, uint32_t set, double *errors) {
    double sum = 0;
    for (uint32_t k = 0; k < singe_network_set_size(network, set); k++) {
        double error = network_constraint(&network->network, set, k);
        if (errors) errors[k] = error;
        sum += error * error;
    }
    return sqrt(sum);
}

void singe_network_jacobian(SingeNetwork *network, uint32_t set, double *jacobian) {
    Network *inner = &network->network;
    if (set >= inner->group_count) return;

    const SpringGroup *group = &inner->groups[set];
    size_t columns = 3 * (size_t)inner->particle_count;
    memset(jacobian, 0, group->count * columns * sizeof *jacobian);
    network_rows(inner, set, network->pool);

    for (uint32_t k = 0; k < group->count; k++)
        for (uint32_t end = 0; end < 2; end++) {
            uint32_t particle = group->ends[k][end];
            double factor = (end ? 1 : -1) * sqrt(inner->inverse_mass[particle]);
            for (uint32_t c = 0; c < 3; c++)
                jacobian[k * columns + 3 * (size_t)particle + c] += factor * inner->gradient[k][c];
        }
}

void singe_network_matrix(SingeNetwork *network, uint32_t set, double *matrix) {
    Network *inner = &network->network;
    if (set >= inner->group_count) return;
    size_t count = inner->groups[set].count;
    memset(matrix, 0, count * count * sizeof *matrix);
    network_rows(inner, set, network->pool);
    ellpack_assemble(inner, set, network->pool);
    ellpack_dense(inner, set, matrix);
}
