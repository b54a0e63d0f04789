#include "cli/cryptomatte.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/text.h"

static uint32_t rotate_left(uint32_t x, int by) { return x << by | x >> (32 - by); }

/// The number of a name: MurmurHash3 of 32 bits, kept from infinities and denormal numbers.
static uint32_t cryptomatte_id(const char *name) {
    const size_t length = strlen(name);
    uint32_t hash = 0;
    for (size_t at = 0; at < length; at += 4) {
        const size_t rest = length - at < 4 ? length - at : 4;
        uint32_t word = 0;
        for (size_t i = 0; i < rest; i++) word |= (uint32_t)(uint8_t)name[at + i] << 8 * i;
        hash ^= rotate_left(word * 0xcc9e2d51u, 15) * 0x1b873593u;
        if (rest == 4) hash = rotate_left(hash, 13) * 5 + 0xe6546b64u;
    }

    hash ^= (uint32_t)length;
    hash = (hash ^ hash >> 16) * 0x85ebca6bu;
    hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
    hash ^= hash >> 16;
    const uint32_t exponent = hash >> 23 & 255;
    return exponent == 0 || exponent == 255 ? hash ^ 1u << 23 : hash;
}

static void name_of(char name[300], bool pieces, const char *sheet, int32_t piece) {
    if (pieces) snprintf(name, 300, "%.250s/%d", sheet, piece);
    else snprintf(name, 300, "%.250s", sheet);
}

/// The mattes of a pixel, those of one sheet together if pieces do not matter, the largest first.
static void gather(const PreviewMatte *from, bool pieces, PreviewMatte to[PREVIEW_MATTES]) {
    memset(to, 0, PREVIEW_MATTES * sizeof *to);
    int count = 0;
    for (int k = 0; k < PREVIEW_MATTES && from[k].share > 0; k++) {
        int same = 0;
        while (same < count && (pieces || to[same].sheet != from[k].sheet)) same++;
        if (same == count) to[count++] = from[k];
        else to[same].share += from[k].share;
    }

    for (int i = 1; i < count; i++)
        for (int k = i; k > 0 && to[k].share > to[k - 1].share; k--) {
            const PreviewMatte swapped = to[k];
            to[k] = to[k - 1];
            to[k - 1] = swapped;
        }
}

static int compare_mattes(const void *a, const void *b) {
    const PreviewMatte *p = a, *q = b;
    if (p->sheet != q->sheet) return p->sheet < q->sheet ? -1 : 1;
    return (p->piece > q->piece) - (p->piece < q->piece);
}

/// The names that occur, each once, and their numbers. NULL if there is no memory.
static char *manifest_write(PreviewMatte *seen, size_t count, bool pieces, const char *const *sheets) {
    char *text = NULL, name[300];
    size_t size = 0, names = 0;
    qsort(seen, count, sizeof *seen, compare_mattes);
    FILE *out = open_memstream(&text, &size);
    if (!out) return NULL;

    fputc('{', out);
    for (size_t i = 0; i < count; i++) {
        if (i && compare_mattes(&seen[i - 1], &seen[i]) == 0) continue;
        name_of(name, pieces, sheets[seen[i].sheet], seen[i].piece);
        if (names++) fputc(',', out);
        text_json_string(out, name);
        fprintf(out, ":\"%08x\"", cryptomatte_id(name));
    }

    fputc('}', out);
    if (fclose(out) == 0) return text;
    free(text);
    return NULL;
}

bool cryptomatte_make(Cryptomatte *layer, const char *name, bool pieces, const char *const *sheets,
                      const PreviewMatte (*mattes)[PREVIEW_MATTES], size_t pixels) {
    *layer = (Cryptomatte){.values = calloc(pixels * CRYPTOMATTE_CHANNELS + 1, sizeof *layer->values)};
    PreviewMatte *seen = malloc((pixels * PREVIEW_MATTES + 1) * sizeof *seen);
    size_t count = 0;

    for (size_t i = 0; layer->values && seen && i < pixels; i++) {
        PreviewMatte here[PREVIEW_MATTES];
        gather(mattes[i], pieces, here);

        for (int k = 0; k < PREVIEW_MATTES && here[k].share > 0; k++) {
            char text[300];
            if (!pieces) here[k].piece = 0;
            name_of(text, pieces, sheets[here[k].sheet], here[k].piece);
            const uint32_t id = cryptomatte_id(text);
            float *value = layer->values + i * CRYPTOMATTE_CHANNELS + 2 * (size_t)k;
            memcpy(value, &id, sizeof *value);
            value[1] = here[k].share;
            if (!count || compare_mattes(&seen[count - 1], &here[k]) != 0) seen[count++] = here[k];
        }
    }

    if (seen) layer->manifest = manifest_write(seen, count, pieces, sheets);
    free(seen);
    if (!layer->values || !layer->manifest) return false;

    // names of the channels "NAME00.R", ..., and of the attributes, whose key is from the layer's own number
    for (int i = 0; i < CRYPTOMATTE_CHANNELS; i++) {
        snprintf(layer->channel_names[i], sizeof layer->channel_names[i], "%s%02d.%c", name, i / 4, "RGBA"[i % 4]);
        layer->channels[i] =
            (ExrChannel){layer->channel_names[i], EXR_KIND_FLOAT, layer->values + i, CRYPTOMATTE_CHANNELS};
    }

    const char *const rows[CRYPTOMATTE_TEXTS][2] = {
        {"name", name}, {"hash", "MurmurHash3_32"}, {"conversion", "uint32_to_float32"}, {"manifest", layer->manifest}};
    for (int i = 0; i < CRYPTOMATTE_TEXTS; i++) {
        snprintf(layer->text_names[i], sizeof layer->text_names[i], "cryptomatte/%07x/%s", cryptomatte_id(name) >> 4,
                 rows[i][0]);
        layer->texts[i] = (ExrText){layer->text_names[i], rows[i][1]};
    }

    return true;
}

void cryptomatte_free(Cryptomatte *layer) {
    free(layer->values);
    free(layer->manifest);
}
