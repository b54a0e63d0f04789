// A function in a process of its own: code of others that may crash, or take all memory or time, reads a file there,
// and this process goes on with an answer or an error.
#ifndef FORMATS_ISOLATE_H
#define FORMATS_ISOLATE_H

#include "formats/formats.h"

typedef struct IsolateLimits {
    size_t memory;  ///< bytes that the function may take, and that its answer may have; at least 1 MiB
    double seconds; ///< of the processor; four times as many on the clock. At most 10^6
} IsolateLimits;

/// Where the function puts its answer.
typedef struct IsolateAnswer {
    int pipe;
} IsolateAnswer;

/// Appends bytes to the answer. A parent that has gone ends the process.
void isolate_put(IsolateAnswer *answer, const void *bytes, size_t size);

/// What is done in the child: puts its answer, or fills *error (never NULL) and returns its code. It sees a copy of all
/// memory; what it writes there is lost. Whatever it prints goes nowhere.
typedef SingeResult IsolateWork(void *context, IsolateAnswer *answer, SingeError *error);

/// Whether isolate_run can make a child: this process has one thread.
bool isolate_possible(void);

/// Runs work(context) in a child and waits for it. *answer gets what it put; the caller checks it as any file, and
/// frees it with bytes_free. `name` is the file's, for messages. Call it only while this process has one thread.
/// Errors: what `work` returned; SINGE_ERROR_LIMIT where it took more memory than `limits` allow, or was refused what
/// it asked for (error->element is limits.memory), or more time (-1); SINGE_ERROR_FORMAT where it crashed;
/// SINGE_ERROR_MEMORY without memory for the answer or a process;
/// SINGE_ERROR_STATE where other threads run, or where a signal stopped the child.
///
/// Linux holds the child to its memory at each call. Elsewhere, and under sanitizers, whose shadow memory counts too,
/// it is looked at some times a second.
SINGE_NODISCARD SingeResult isolate_run(const char *name, IsolateWork *work, void *context, IsolateLimits limits,
                                        SingeAllocator allocator, Bytes *answer, SingeError *error);

#endif
