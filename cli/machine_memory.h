// What the machine gives to this process.
#ifndef CLI_MACHINE_MEMORY_H
#define CLI_MACHINE_MEMORY_H

/// Bytes of memory that this process may have: the machine's, or less where it is limited (ulimit, a container); 0
/// where that is not known.
double machine_memory(void);

#endif
