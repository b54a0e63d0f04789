// The text of the USD root, and functions that append to it.
#ifndef FORMATS_USD_TEXT_H
#define FORMATS_USD_TEXT_H

#include "formats/usd.h"

#include <string.h>

typedef struct Root {
    Sink sink;
    const OutputScene *scene;
    char name[USD_NAME];
} Root;

static inline void put(Root *r, const char *text) { sink_bytes(&r->sink, text, strlen(text)); }

static inline void put_numbers(Root *r, const float *values, int count) {
    put(r, "(");
    for (int i = 0; i < count; i++) {
        put(r, i ? ", " : "");
        sink_float(&r->sink, values[i]);
    }
    put(r, ")");
}

static inline void put_float(Root *r, const char *before, float value) {
    put(r, before);
    sink_float(&r->sink, value);
    put(r, "\n");
}

static inline void put_triple(Root *r, const char *before, float x, float y, float z) {
    const float values[3] = {x, y, z};
    put(r, before);
    put_numbers(r, values, 3);
    put(r, "\n");
}

static inline float usd_dot(const float a[3], const float b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// usd_props.c: the prim `props`, the ground and the shapes, with their motion.
void usd_put_props(Root *r);

#endif
