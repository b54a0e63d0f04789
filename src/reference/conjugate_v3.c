// Conjugate gradients four lanes at a time, for x86-64-v3 (AVX2). Wider ones gain nothing: memory is the limit.
#ifdef __AVX2__
#define CONJUGATE_KERNEL conjugate_v3
#include "reference/conjugate_kernel.h"
#endif
