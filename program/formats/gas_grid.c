// A gas that owns its arrays: copied, pruned, freed.
#include "formats/gas_grid.h"
#include "common/store.h"

#include <string.h>

bool gas_shape_is_good(const SingeGas *gas) {
    const uint32_t max = 4096; // one node under a VDB tree's root
    const uint32_t *n = gas->size;
    if (!n[0] && !n[1] && !n[2]) return true;
    bool good = n[0] && n[1] && n[2] && n[0] <= max && n[1] <= max && n[2] <= max &&
                (uint64_t)n[0] * n[1] * n[2] <= GAS_CELL_LIMIT && gas->cell > 0 && isfinite(gas->cell);
    for (int c = 0; c < 3; c++) good = good && isfinite(gas->origin[c]);
    return good;
}

float gas_coolest(const SingeGas *gas) {
    size_t count = gas_cells(gas);
    float coolest = count ? gas->temperature[0] : 0;
    for (size_t i = 1; i < count; i++)
        if (gas->temperature[i] < coolest) coolest = gas->temperature[i];
    return coolest;
}

bool gas_block_holds(const SingeGas *gas, const uint32_t block[3], float coolest) {
    uint32_t low[3], high[3];
    gas_block_box(gas, block, low, high);

    for (uint32_t z = low[2]; z < high[2]; z++)
        for (uint32_t y = low[1]; y < high[1]; y++)
            for (uint32_t x = low[0]; x < high[0]; x++) {
                size_t i = gas_index(gas, x, y, z);
                if (gas->smoke[i] > GAS_SMOKE_MIN || gas->flame[i] > GAS_FLAME_MIN ||
                    gas->temperature[i] - coolest > GAS_WARM_MIN)
                    return true;
            }

    return false;
}

void gas_fill(Gas *gas, float coolest) {
    size_t count = gas_cells(&gas->view);
    if (coolest == 0) memset(gas->temperature, 0, count * sizeof *gas->temperature);
    else
        for (size_t i = 0; i < count; i++) gas->temperature[i] = coolest;
}

SingeResult gas_make(Gas *gas, const char *name, float coolest, SingeError *error) {
    size_t count = gas_cells(&gas->view);
    gas->temperature = store_new(gas->allocator, count, sizeof *gas->temperature);
    gas->smoke = store_new(gas->allocator, count, sizeof *gas->smoke);
    gas->flame = store_new(gas->allocator, count, sizeof *gas->flame);
    gas->extinction = store_new(gas->allocator, count, sizeof *gas->extinction);
    gas->flame_share = store_new(gas->allocator, count, sizeof *gas->flame_share);
    gas->velocity = store_new(gas->allocator, count, sizeof *gas->velocity);
    if (!gas->temperature || !gas->smoke || !gas->flame || !gas->extinction || !gas->flame_share || !gas->velocity)
        return refuse_memory(error, "gas", name);

    gas_fill(gas, coolest);
    memset(gas->smoke, 0, count * sizeof *gas->smoke);
    memset(gas->flame, 0, count * sizeof *gas->flame);
    memset(gas->extinction, 0, count * sizeof *gas->extinction);
    memset(gas->flame_share, 0, count * sizeof *gas->flame_share);
    memset(gas->velocity, 0, count * sizeof *gas->velocity);

    gas->view.temperature = gas->temperature;
    gas->view.smoke = gas->smoke;
    gas->view.flame = gas->flame;
    gas->view.velocity = (const float(*)[3])gas->velocity;
    return SINGE_OK;
}

bool gas_decode(Gas *gas) {
    size_t count = gas_cells(&gas->view);
    float sum = 0; // of zeros, unless something is not finite
    for (size_t i = 0; i < count; i++) {
        gas->smoke[i] = gas->extinction[i] / GAS_EXTINCTION;
        gas->flame[i] = gas->flame_share[i] * GAS_FLAME_UNIT;
        sum += 0 * gas->smoke[i] + 0 * gas->flame[i];
    }

    return sum == 0;
}

/// Blocks that hold nothing become still air as cool as the coolest cell.
static void clear_still_blocks(Gas *copy, float coolest) {
    const uint32_t *n = copy->view.size;
    uint32_t block[3];

    for (block[2] = 0; block[2] * GAS_BLOCK < n[2]; block[2]++)
        for (block[1] = 0; block[1] * GAS_BLOCK < n[1]; block[1]++)
            for (block[0] = 0; block[0] * GAS_BLOCK < n[0]; block[0]++)
                if (!gas_block_holds(&copy->view, block, coolest)) {
                    uint32_t low[3], high[3];
                    gas_block_box(&copy->view, block, low, high);
                    for (uint32_t z = low[2]; z < high[2]; z++)
                        for (uint32_t y = low[1]; y < high[1]; y++)
                            for (uint32_t x = low[0]; x < high[0]; x++) {
                                size_t cell = gas_index(&copy->view, x, y, z);
                                copy->temperature[cell] = coolest;
                                copy->smoke[cell] = copy->flame[cell] = copy->extinction[cell] =
                                    copy->flame_share[cell] = 0;
                                copy->velocity[cell][0] = copy->velocity[cell][1] = copy->velocity[cell][2] = 0;
                            }
                }
}

SingeResult gas_copy(const SingeGas *gas, SingeAllocator allocator, Gas *copy, SingeError *error) {
    *copy = (Gas){.allocator = allocator};
    if (!gas_shape_is_good(gas))
        return refuse(error, SINGE_ERROR_LIMIT, "gas", -1,
                      "a gas of %u x %u x %u cells: the limits are 4096 a side and %d in total", gas->size[0],
                      gas->size[1], gas->size[2], GAS_CELL_LIMIT);

    size_t count = gas_cells(gas);
    if (!count) return SINGE_OK;

    float sum = 0; // of zeros, unless something is not finite
    for (size_t i = 0; i < count; i++) {
        const float *v = gas->velocity[i];
        sum += 0 * gas->temperature[i] + 0 * (GAS_EXTINCTION * gas->smoke[i]) + 0 * gas->flame[i] + 0 * v[0] +
               0 * v[1] + 0 * v[2];
    }

    if (sum != 0) return refuse(error, SINGE_ERROR_ARGUMENT, "gas", -1, "a value is not finite");
    copy->view = *gas;

    float coolest = gas_coolest(gas);
    SingeResult result = gas_make(copy, "gas", coolest, error);

    if (result) {
        gas_free(copy);
        return result;
    }

    memcpy(copy->temperature, gas->temperature, count * sizeof *gas->temperature);
    memcpy(copy->velocity, gas->velocity, count * sizeof *gas->velocity);

    for (size_t i = 0; i < count; i++) {
        copy->extinction[i] = GAS_EXTINCTION * gas->smoke[i];
        copy->flame_share[i] = gas->flame[i] / GAS_FLAME_UNIT;
    }

    if (!gas_decode(copy)) {
        gas_free(copy);
        return refuse(error, SINGE_ERROR_ARGUMENT, "gas", -1, "a value is too large for a file");
    }

    clear_still_blocks(copy, coolest);
    return SINGE_OK;
}

void gas_free(Gas *gas) {
    size_t count = gas_cells(&gas->view);
    store_free(gas->allocator, gas->temperature, count, sizeof *gas->temperature);
    store_free(gas->allocator, gas->smoke, count, sizeof *gas->smoke);
    store_free(gas->allocator, gas->flame, count, sizeof *gas->flame);
    store_free(gas->allocator, gas->extinction, count, sizeof *gas->extinction);
    store_free(gas->allocator, gas->flame_share, count, sizeof *gas->flame_share);
    store_free(gas->allocator, gas->velocity, count, sizeof *gas->velocity);
    *gas = (Gas){.allocator = gas->allocator};
}
