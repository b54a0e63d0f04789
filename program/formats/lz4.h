// LZ4's block format: OpenUSD compresses integers and names with it.
#pragma once

#include <stddef.h>
#include <stdint.h>

/// Max compressed size of `size` bytes.
static inline size_t lz4_size_max(size_t size) { return size + size / 255 + 16; }

/// Compresses a block and returns its length; `out` has room for lz4_size_max(size).
size_t lz4_pack(const uint8_t *in, size_t size, uint8_t *out);
