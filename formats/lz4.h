// LZ4's block format: what OpenUSD packs integers and names with.
#ifndef FORMATS_LZ4_H
#define FORMATS_LZ4_H

#include <stddef.h>
#include <stdint.h>

/// Bytes that are enough for `size` bytes, however little they can be packed.
static inline size_t lz4_size_max(size_t size) { return size + size / 255 + 16; }

/// Packs a block and returns its length; `out` has room for lz4_size_max(size).
size_t lz4_pack(const uint8_t *in, size_t size, uint8_t *out);

#endif
