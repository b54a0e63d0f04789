// Arrival maps: a picture says when the fire's front is where, and the sheet's temperature is held to it. With the time t
// of motion and the map's time a of a particle, after the step's conduction,
//
//   t < a    w <= T <= max(w, T_c),   w = T_a + (T_ign - T_a) exp((t - a)/l),   T_c = T_a + c (T_ign - T_a)
//   t >= a   T >= T_ign + r, while more than f_e of the fuel is left
//   never    T <= T_c
//
//   T_a, T_ign  K   ambient, and of ignition
//   l           s   lead: over v l ahead of a front of speed v the sheet is scorched, as by conduction
//   c           3/4: what the fire's heat may do before its time. The sheet browns, but cannot ignite in a step
//   r           K   half the rise at which the rate stops growing, at most 100 K: enough to go on burning
//   f_e         2 % what is left after the flame
//
// So every particle ignites in the first step at or after its time, whatever the cells, the pace and the material, and
// the fire behind the front is the material's own. The heat that this takes or gives is heat in, C (T' - T).
#include <math.h>

#include "common/real.h"
#include "heat/heat_plan.h"

static const float ARRIVAL_WARM = 0.75f, ARRIVAL_RISE = 100, ARRIVAL_FUEL = 0.02f, ARRIVAL_LEADS = 6;

/// White of a map: 255 of 255, but not 254.
static const float ARRIVAL_WHITE = 0.998f;

float heat_sample_arrival(const SingeTexture *map, float u, float v) {
    const int size[2] = {map->width, map->height};
    const double uv[2] = {(double)u, 1 - (double)v};
    int low[2], high[2];
    double part[2], weight[2] = {0, 0}, sum = 0;

    // the four pixels around the point, as shell_sample_texture has them
    for (int k = 0; k < 2; k++) {
        double at = uv[k] * size[k] - 0.5, limit = size[k] - 1;
        at = !(at > 0) ? 0 : at < limit ? at : limit;
        low[k] = (int)at;
        high[k] = low[k] + 1 < size[k] ? low[k] + 1 : low[k];
        part[k] = at - low[k];
    }

    // white is no late time: the mean of the others, or never where white weighs more
    for (int k = 0; k < 4; k++) {
        const int column = k & 1 ? high[0] : low[0], row = k & 2 ? high[1] : low[1];
        const double share = (k & 1 ? part[0] : 1 - part[0]) * (k & 2 ? part[1] : 1 - part[1]);
        const float value = map->values[(size_t)row * (size_t)size[0] + (size_t)column];
        weight[value >= ARRIVAL_WHITE] += share;
        if (value < ARRIVAL_WHITE) sum += share * (double)value;
    }

    return weight[1] > weight[0] ? SOURCE_NEVER : (float)(sum / weight[0]);
}

/// Arguments of a task for one map.
typedef struct ArrivalJob {
    HeatPass *pass;
    const Source *source;
} ArrivalJob;

static void arrival_blocks(void *context, int begin, int end) {
    const ArrivalJob *job = context;
    HeatPlan *plan = job->pass->plan;
    const Matter *matter = &job->pass->shell->matter;
    const float *fuel = job->pass->state->burn->fuel, ambient = plan->settings.ambient_temperature;
    const float lead = job->source->def.lead;
    HeatState *heat = job->pass->heat;

    for (int block = begin; block < end; block++) {
        const uint32_t last = heat_group_last(plan, heat_group_end(plan, block) - 1);
        double given = 0;
        for (uint32_t i = heat_group_first(block) * HEAT_GROUP; i < last; i++) {
            const float map = job->source->texture[i];
            if (map == SOURCE_UNMAPPED || !plan->alive[i]) continue;

            const float ignition = field_at(matter->ignition_temperature, i), T = heat->temperature[i];
            const float warm = float_max(ambient, ambient + ARRIVAL_WARM * (ignition - ambient));
            const double late = job->pass->state->time - source_arrival(job->source, i);
            float low = 0, high = INFINITY;

            if (late >= 0) {
                const float rise = float_min(0.5f * field_at(matter->rate_ceiling, i), ARRIVAL_RISE);
                if (fuel[i] > ARRIVAL_FUEL) low = ignition + rise;
            } else {
                const float lag = (float)(late / (double)lead); // -infinity: never
                if (lag > -ARRIVAL_LEADS) low = ambient + (ignition - ambient) * real_expf(lag);
                high = float_max(low, warm);
            }

            const float held = T < low ? low : T > high ? high : T; // NaN stays
            if (!(held != T)) continue;
            given += (double)matter->capacity[i] * ((double)held - (double)T);
            heat->temperature[i] = held;
            heat->temperature_peak[i] = float_max(heat->temperature_peak[i], held);
        }
        plan->partial[block][0] = given;
    }
}

double heat_arrive(HeatPass *pass, const SourceList *sources) {
    double given = 0;
    for (uint32_t k = 0; sources && k < sources->count; k++) {
        const Source *source = &sources->items[k];
        if (!source_is_lit(source, pass->state->time) || source->def.kind != SINGE_SOURCE_ARRIVAL) continue;
        ArrivalJob job = {pass, source};
        if (!source->texture) continue;
        pool_for(pass->pool, pass->plan->blocks, 1, arrival_blocks, &job);
        given += heat_sum(pass->plan, 0);
    }

    return given;
}
