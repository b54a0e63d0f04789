// Work of a picture that its threads share.
#pragma once

#include <stdint.h>

enum { SHARE_PARTS = 32 }; ///< of a list or of a picture that is long

/// Calls item(context, k) for each k below `count`, on so many threads, of which the caller is one. They take the next number by
/// turns: no item may depend on another.
void share_out(int threads, int count, void (*item)(void *context, int k), void *context);

/// The first of `all` numbers that fall to part k of so many; the last + 1 is that of the next part.
static inline uint32_t share_first(uint32_t all, int k, int parts) {
    return (uint32_t)((uint64_t)all * (uint64_t)k / (uint64_t)parts);
}
