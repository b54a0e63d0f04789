#include "cli/contact_sheet.h"

#include <stdlib.h>

enum { SHEET_WIDTH = 1920 };

SingeResult contact_sheet_make(ContactSheet *sheet, int columns, int rows, int frame_width, int frame_height,
                               SingeError *error) {
    int shrink = (columns * frame_width + SHEET_WIDTH - 1) / SHEET_WIDTH;
    int shortest = frame_width < frame_height ? frame_width : frame_height;
    if (shrink > shortest) shrink = shortest;
    if (shrink < 1) shrink = 1;
    *sheet = (ContactSheet){.columns = columns,
                            .rows = rows,
                            .frame_width = frame_width,
                            .frame_height = frame_height,
                            .shrink = shrink,
                            .width = columns * (frame_width / shrink),
                            .height = rows * (frame_height / shrink)};
    sheet->rgb = calloc((size_t)sheet->width * 3, (size_t)sheet->height);
    if (sheet->rgb) return SINGE_OK;
    *error = (SingeError){.code = SINGE_ERROR_MEMORY, .stage = "sheet.png", .element = -1};
    return SINGE_ERROR_MEMORY;
}

static uint8_t mean(const uint8_t *rgb, int stride, int shrink) {
    unsigned sum = 0;
    for (int y = 0; y < shrink; y++)
        for (int x = 0; x < shrink; x++) sum += rgb[(size_t)y * (size_t)stride + 3 * (size_t)x];
    unsigned count = (unsigned)(shrink * shrink);
    return (uint8_t)((sum + count / 2) / count);
}

void contact_sheet_put(ContactSheet *sheet, int tile, const uint8_t *rgb) {
    int shrink = sheet->shrink, w = sheet->frame_width / shrink, h = sheet->frame_height / shrink;
    int left = tile % sheet->columns * w, top = tile / sheet->columns * h, stride = 3 * sheet->frame_width;
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++)
            for (int k = 0; k < 3; k++) {
                size_t to = 3 * ((size_t)(top + y) * (size_t)sheet->width + (size_t)(left + x)) + (size_t)k;
                size_t from = (size_t)(y * shrink) * (size_t)stride + 3 * (size_t)(x * shrink) + (size_t)k;
                sheet->rgb[to] = mean(rgb + from, stride, shrink);
            }
}

void contact_sheet_free(ContactSheet *sheet) {
    free(sheet->rgb);
    *sheet = (ContactSheet){0};
}

int contact_sheet_frame(int tile, int tiles, int first, int last) {
    return tiles < 2 ? first : first + (int)(((long)(last - first) * tile + (tiles - 1) / 2) / (tiles - 1));
}
