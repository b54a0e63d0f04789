// Chains of links over a grid of particles, in both directions, 5 MB in all. One run does the work of a strand
// projection: gather two particles, a square root and two divisions, a forward and a backward recurrence, scatter. It
// is a copy, so that it does not change with the library, and takes about as long as a step of 100,000 springs, so that
// interruptions affect both alike.
#include "bench/yardstick.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <time.h>

enum { SIDE = 224, PARTICLES = SIDE * SIDE, LINKS = 2 * SIDE * (SIDE - 1), PASSES = 8 };

typedef struct Link {
    uint32_t ends[2];
    float length, factor;
    float direction[4]; // the fourth is the right side
} Link;

struct Yardstick {
    float position[PARTICLES][4];
    Link links[LINKS];
};

Yardstick *yardstick_create(void) {
    Yardstick *yardstick = malloc(sizeof *yardstick);
    if (!yardstick) return NULL;
    uint32_t link = 0;
    for (uint32_t direction = 0; direction < 2; direction++)
        for (uint32_t line = 0; line < SIDE; line++)
            for (uint32_t k = 0; k + 1 < SIDE; k++) {
                uint32_t a = direction ? k * SIDE + line : line * SIDE + k, b = a + (direction ? SIDE : 1);
                yardstick->links[link++] = (Link){.ends = {a, b}, .length = 1.05f};
            }
    return yardstick;
}

void yardstick_destroy(Yardstick *yardstick) { free(yardstick); }

double yardstick_run(Yardstick *yardstick) {
    struct timespec start, end;
    clock_gettime(CLOCK_MONOTONIC, &start);

    // the same positions before every run: the same work, and no denormal numbers
    for (uint32_t i = 0; i < PARTICLES; i++) {
        float *x = yardstick->position[i];
        x[0] = (float)(i % SIDE);
        x[1] = (float)(i / SIDE);
        x[2] = 0.1f * (float)(i * 7 % 11);
        x[3] = 1;
    }

    for (int pass = 0; pass < PASSES; pass++)
        for (int first = 0; first < LINKS; first += SIDE - 1) {
            Link *links = yardstick->links + first;
            const int count = SIDE - 1;
            float before[3] = {0, 0, 0}, inverse = 0, right = 0, lambda = 0;
            for (int k = 0; k < count; k++) {
                Link *link = &links[k];
                const float *a = yardstick->position[link->ends[0]], *b = yardstick->position[link->ends[1]];
                float d[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
                float distance = sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), over = 1 / fmaxf(distance, 1e-6f);
                for (int i = 0; i < 3; i++) d[i] *= over;
                float lower = -(before[0] * d[0] + before[1] * d[1] + before[2] * d[2]);
                link->factor = lower * inverse;
                inverse = 1 / (a[3] + b[3] + 0.01f - link->factor * lower);
                right = (distance - link->length - lower * right) * inverse;
                for (int i = 0; i < 3; i++) before[i] = link->direction[i] = d[i];
                link->direction[3] = right;
            }

            float factor = 0;
            for (int k = count; k-- > 0;) {
                Link *link = &links[k];
                float *a = yardstick->position[link->ends[0]], *b = yardstick->position[link->ends[1]];
                lambda = link->direction[3] - factor * lambda;
                factor = link->factor;
                for (int i = 0; i < 3; i++) {
                    float pull = 0.5f * lambda * link->direction[i];
                    a[i] += pull;
                    b[i] -= pull;
                }
            }
        }
    clock_gettime(CLOCK_MONOTONIC, &end);
    return 1e3 * (double)(end.tv_sec - start.tv_sec) + 1e-6 * (double)(end.tv_nsec - start.tv_nsec);
}
