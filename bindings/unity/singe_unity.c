// The native plug-in for Unity: a burning sheet by plain functions. Unity's axes are y up and left-handed, so z is mirrored
// on the way in and out.
#include "burning_sheet.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// As SingeSheet.cs has it.
typedef struct UnitySettings {
    float width, height; ///< m
    int32_t columns, rows, threads;
    float pace, detail, gravity[3];
} UnitySettings;

typedef struct UnityState {
    int32_t vertices, triangles, springs;
    float burnt; ///< share of the mass
    double milliseconds, processor_milliseconds;
    int64_t allocations;
} UnityState;

static void mirror(const float from[3], float to[3]) {
    to[0] = from[0];
    to[1] = from[1];
    to[2] = -from[2];
}

static int32_t answer(const BurningSheet *sheet, bool good, char *why, int32_t size) {
    if (!good) snprintf(why, (size_t)size, "%s", sheet->error.message);
    return good;
}

/// NULL, with the reason in `why`, if it cannot start. To be freed by singe_unity_stop.
SINGE_API BurningSheet *singe_unity_start(const UnitySettings *settings, const char *material, char *why, int32_t size);
SINGE_API void singe_unity_stop(BurningSheet *sheet);
/// 0, with the reason in `why`: nothing has changed. So for all below.
SINGE_API int32_t singe_unity_advance(BurningSheet *sheet, double seconds, char *why, int32_t size);
SINGE_API int32_t singe_unity_pin(BurningSheet *sheet, const float *point, float radius, char *why, int32_t size);
SINGE_API int32_t singe_unity_ignite(BurningSheet *sheet, const float *point, float radius, float seconds, char *why,
                                     int32_t size);
SINGE_API int32_t singe_unity_blow(BurningSheet *sheet, const float *velocity, float gust, char *why, int32_t size);
SINGE_API int32_t singe_unity_add_sphere(BurningSheet *sheet, const float *centre, float radius, char *why,
                                         int32_t size);
SINGE_API int32_t singe_unity_add_plane(BurningSheet *sheet, const float *point, const float *normal, char *why,
                                        int32_t size);
SINGE_API void singe_unity_state(const BurningSheet *sheet, UnityState *state);
/// Fills arrays of `vertices` and 3 * `triangles` elements of the state.
SINGE_API void singe_unity_read(const BurningSheet *sheet, float (*positions)[3], float (*normals)[3], float (*uv)[2],
                                uint8_t (*colours)[4], int32_t *corners);

BurningSheet *singe_unity_start(const UnitySettings *settings, const char *material, char *why, int32_t size) {
    BurningSheet *sheet = malloc(sizeof *sheet);
    if (!sheet) {
        snprintf(why, (size_t)size, "out of memory");
        return NULL;
    }
    *sheet = burning_default();
    sheet->size[0] = settings->width;
    sheet->size[1] = settings->height;
    sheet->cells[0] = (uint32_t)(settings->columns > 0 ? settings->columns : 0);
    sheet->cells[1] = (uint32_t)(settings->rows > 0 ? settings->rows : 0);
    snprintf(sheet->material, sizeof sheet->material, "%s", material);
    sheet->pace = settings->pace;
    sheet->detail = settings->detail;
    sheet->threads = settings->threads;
    mirror(settings->gravity, sheet->gravity);
    if (answer(sheet, burning_start(sheet), why, size)) return sheet;
    free(sheet);
    return NULL;
}

void singe_unity_stop(BurningSheet *sheet) {
    if (sheet) burning_stop(sheet);
    free(sheet);
}

int32_t singe_unity_advance(BurningSheet *sheet, double seconds, char *why, int32_t size) {
    return answer(sheet, burning_advance(sheet, seconds), why, size);
}

int32_t singe_unity_pin(BurningSheet *sheet, const float *point, float radius, char *why, int32_t size) {
    float here[3];
    mirror(point, here);
    return answer(sheet, burning_pin(sheet, here, radius), why, size);
}

int32_t singe_unity_ignite(BurningSheet *sheet, const float *point, float radius, float seconds, char *why,
                           int32_t size) {
    float here[3];
    mirror(point, here);
    return answer(sheet, burning_ignite(sheet, here, radius, seconds), why, size);
}

int32_t singe_unity_blow(BurningSheet *sheet, const float *velocity, float gust, char *why, int32_t size) {
    float here[3];
    mirror(velocity, here);
    return answer(sheet, burning_blow(sheet, here, gust), why, size);
}

int32_t singe_unity_add_sphere(BurningSheet *sheet, const float *centre, float radius, char *why, int32_t size) {
    float here[3];
    mirror(centre, here);
    return answer(sheet, burning_add_sphere(sheet, here, radius), why, size);
}

int32_t singe_unity_add_plane(BurningSheet *sheet, const float *point, const float *normal, char *why, int32_t size) {
    float here[3], up[3];
    mirror(point, here);
    mirror(normal, up);
    return answer(sheet, burning_add_plane(sheet, here, up), why, size);
}

void singe_unity_state(const BurningSheet *sheet, UnityState *state) {
    const SingeStats stats = singe_sim_stats(sheet->sim);
    *state = (UnityState){.vertices = (int32_t)sheet->surface.vertex_count,
                          .triangles = (int32_t)sheet->surface.triangle_count,
                          .springs = (int32_t)stats.springs,
                          .burnt = (float)stats.burnt_fraction,
                          .milliseconds = sheet->milliseconds,
                          .processor_milliseconds = sheet->processor_time,
                          .allocations = (int64_t)sheet->allocations};
}

void singe_unity_read(const BurningSheet *sheet, float (*positions)[3], float (*normals)[3], float (*uv)[2],
                      uint8_t (*colours)[4], int32_t *corners) {
    const SingeSurface *surface = &sheet->surface;
    for (uint32_t i = 0; i < surface->vertex_count; i++) {
        mirror(surface->position[i], positions[i]);
        mirror(surface->normal[i], normals[i]);
        memcpy(uv[i], surface->uv[i], sizeof uv[i]);
        burning_colour(surface->temperature[i], surface->temperature_peak[i], surface->burn[i], colours[i]);
    }
    // fronts turn clockwise there, as the mirror leaves them counter-clockwise for Unity's eye
    for (uint32_t t = 0; t < surface->triangle_count; t++)
        for (int k = 0; k < 3; k++) corners[3 * t + (uint32_t)k] = (int32_t)surface->triangles[t][2 - k];
}
