// Many small frames in one picture: an overview of a run.
#ifndef CLI_CONTACT_SHEET_H
#define CLI_CONTACT_SHEET_H

#include "singe/base.h"

typedef struct ContactSheet {
    int columns, rows;
    int frame_width, frame_height; ///< of the source frames
    int shrink;                    ///< frames are averaged over shrink × shrink pixels
    int width, height;
    uint8_t *rgb;
} ContactSheet;

/// At most about 1920 pixels wide.
SINGE_NODISCARD SingeResult contact_sheet_make(ContactSheet *sheet, int columns, int rows, int frame_width,
                                               int frame_height, SingeError *error);
void contact_sheet_put(ContactSheet *sheet, int tile, const uint8_t *rgb);
void contact_sheet_free(ContactSheet *sheet);

/// The frame of [first, last] that a tile shows: spread evenly, both ends included.
int contact_sheet_frame(int tile, int tiles, int first, int last);

#endif
