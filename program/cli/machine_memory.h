// The machine's memory, as far as this process may use it.
#ifndef CLI_MACHINE_MEMORY_H
#define CLI_MACHINE_MEMORY_H

/// Bytes of memory that this process may use: the machine's, or its limit (ulimit, a container) if that is less; 0 if
/// unknown.
double machine_memory(void);

#endif
