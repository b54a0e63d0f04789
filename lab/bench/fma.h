// Chains of multiply-adds that keep a core's floating-point units fully busy.
#pragma once

/// Runs `rounds` rounds, a multiple of 4, with the processor's widest vectors; returns the number of floating-point
/// operations.
double fma_run(long rounds);
