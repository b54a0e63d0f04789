// Conjugate gradients for every processor: two lanes, which x86-64 and AArch64 have.
#define CONJUGATE_KERNEL conjugate_plain
#include "reference/conjugate_kernel.h"
