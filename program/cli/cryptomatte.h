// Mattes by name for compositors: layers of an EXR by the Cryptomatte specification 1.2 (Friedman & Jones 2015).
#pragma once

#include "formats/formats.h"
#include "preview/preview.h"

enum { CRYPTOMATTE_CHANNELS = 2 * PREVIEW_MATTES, CRYPTOMATTE_TEXTS = 4 };

/// One layer: for each pixel PREVIEW_MATTES pairs of a name's number and its share, the largest first.
typedef struct Cryptomatte {
    float *values; ///< [pixels * CRYPTOMATTE_CHANNELS]
    ExrChannel channels[CRYPTOMATTE_CHANNELS];
    ExrText texts[CRYPTOMATTE_TEXTS];
    char channel_names[CRYPTOMATTE_CHANNELS][32], text_names[CRYPTOMATTE_TEXTS][40];
    char *manifest; ///< names and their numbers, as JSON
} Cryptomatte;

/// Fills the layer `name` from the mattes of `pixels` pixels: by sheet, or by piece ("letter/12"). Pieces are counted as in
/// the cache. False if there is no memory. Free it in any case; until then it must not be moved.
bool cryptomatte_make(Cryptomatte *layer, const char *name, bool pieces, const char *const *sheets,
                      const PreviewMatte (*mattes)[PREVIEW_MATTES], size_t pixels);
void cryptomatte_free(Cryptomatte *layer);
