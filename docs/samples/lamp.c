// A heat source of one's own: a function that adds a flux to every particle, here a line of light that travels.
//
// Prints:
//   ignited at 0.4 s, hottest 1300 K
#include "sample.h"

typedef struct Laser {
    float power, width; ///< W/m2 in its middle, m
} Laser;

static void laser(void *context, const SingeView *view, float *flux, float *conductance, float *temperature) {
    const Laser *light = context;
    (void)conductance, (void)temperature; // a flux needs neither
    const float x = -0.08f + 0.06f * (float)view->time;
    for (uint32_t i = 0; i < view->particle_count; i++) {
        const float d = (view->rest_position[i][0] - x) / light->width;
        flux[i] += light->power * expf(-d * d);
    }
}

int main(void) {
    Laser light = {30e3f, 0.004f};
    SingeSim *sim = sample_sim(singe_default_sim());
    sample_sheet(sim, singe_default_sheet(), 0.12f, 24, 0.001f);
    sample_table(sim);
    SingeSourceDef source = singe_default_source();
    source.kind = SINGE_SOURCE_CALLBACK, source.callback = laser, source.callback_context = &light;
    TRY(sim, singe_sim_add_source(sim, &source, NULL));
    TRY(sim, singe_sim_commit(sim));
    double ignited = 0;
    while (ignited == 0 && singe_sim_view(sim).time < 2) {
        TRY(sim, singe_sim_advance(sim, 1.0 / 24, 0, NULL));
        size_t count;
        const SingeEvent *events = singe_sim_events(sim, &count);
        for (size_t i = 0; i < count && ignited == 0; i++)
            if (events[i].kind == SINGE_EVENT_IGNITED) ignited = events[i].time;
    }
    TRY(sim, singe_sim_advance(sim, 1, 0, NULL));
    printf("ignited at %.1f s, hottest %.0f K\n", ignited,
           100 * round((double)singe_sim_stats(sim).temperature_max / 100));
    singe_sim_destroy(sim);
}
