// Assertions of invariants, which only a bug in this program can break. Inputs are checked by code that returns an
// error instead. Enabled if SINGE_ASSERTIONS is defined (the presets dev, asan, tsan and fuzz); otherwise nothing is
// computed.
#pragma once

#ifdef SINGE_ASSERTIONS
/// Prints the condition with its file and line, and aborts.
_Noreturn void assertion_failed(const char *condition, const char *file, int line);
#define SINGE_ASSERT(condition) ((condition) ? (void)0 : assertion_failed(#condition, __FILE__, __LINE__))
#else
#define SINGE_ASSERT(condition) ((void)sizeof(!(condition)))
#endif
