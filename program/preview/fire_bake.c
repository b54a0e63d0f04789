// The gas on finer cells, with the tongues and streaks that pictures add by noise, for programs that draw the cells
// themselves.

#include "preview/internal.h"

#include <math.h>

SingeResult preview_bake_gas(Preview *preview, const SingeSurface *surface, double time, int detail, float *smoke,
                             float *flame, SingeError *error) {
    const Fire *fire = &preview->fire;
    if (!isfinite(time) || detail < 1 || detail > PREVIEW_BAKE_MAX)
        return preview_fail(error, SINGE_ERROR_ARGUMENT, -1, "the time is not finite, or the detail not 1 to %d",
                            PREVIEW_BAKE_MAX);
    if (!fire->size[0]) return preview_fail(error, SINGE_ERROR_ARGUMENT, -1, "there is no gas");
    preview->time = time;
    SingeResult result = tracer_load(preview, surface, error);
    if (result) return result;
    fire_raise(preview);
    const float side = fire->cell / (float)detail, first = (FIRE_BORDER - 0.5f) * fire->cell + 0.5f * side;
    const Float3 origin = float3_add(fire->origin, float3(first, first, first));
    int size[3];
    for (int c = 0; c < 3; c++) size[c] = (fire->size[c] - 2 * FIRE_BORDER) * detail;
    size_t i = 0;
    for (int z = 0; z < size[2]; z++)
        for (int y = 0; y < size[1]; y++)
            for (int x = 0; x < size[0]; x++, i++)
                fire_look(preview, float3_mad(origin, float3((float)x, (float)y, (float)z), side), &flame[i],
                          &smoke[i]);
    return SINGE_OK;
}
