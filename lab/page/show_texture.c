#include "page/show_texture.h"

#include <math.h>
#include <stdlib.h>

void texture_show(Lab *lab, const SingeTexture *picture) {
    uint8_t *rgb = malloc((size_t)picture->width * (size_t)picture->height * 3);
    for (int i = 0; rgb && i < picture->width * picture->height; i++)
        for (int k = 0; k < 3; k++) rgb[3 * i + k] = (uint8_t)lrintf(255 * fminf(1, fmaxf(0, picture->values[i])));
    if (rgb) report_picture(lab->report, "the texture", picture->width, picture->height, rgb);
    free(rgb);
}

double texture_mean(const SingeTexture *picture) {
    const int count = picture->width * picture->height;
    double sum = 0;
    for (int i = 0; i < count; i++) sum += (double)picture->values[i];
    return sum / count;
}

double texture_correlation(const SingeView *view, const SingeTexture *picture, bool mirrored, const float *field) {
    double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
    for (uint32_t v = 0; v < view->vertex_count; v++) {
        if (view->source_vertex[v] < 0) continue; // in reserve for tears
        const float uv[2] = {mirrored ? 1 - view->uv[v][0] : view->uv[v][0], view->uv[v][1]};

        int column = (int)(uv[0] * (float)picture->width), row = (int)((1 - uv[1]) * (float)picture->height);
        column = column < 0 ? 0 : column >= picture->width ? picture->width - 1 : column;
        row = row < 0 ? 0 : row >= picture->height ? picture->height - 1 : row;
        double a = (double)picture->values[row * picture->width + column], b = (double)field[v];
        n++;
        x += a;
        y += b;
        xx += a * a;
        yy += b * b;
        xy += a * b;
    }

    return (n * xy - x * y) / sqrt((n * xx - x * x) * (n * yy - y * y));
}
