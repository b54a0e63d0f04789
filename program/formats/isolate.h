// Runs a function in a process of its own: third-party code that may crash, or use all memory or time, reads a file
// there. This process continues with an answer or an error.
#pragma once

#include "formats/formats.h"

typedef struct IsolateLimits {
    size_t memory;  ///< max bytes that the function may use, and that its answer may have; at least 1 MiB
    double seconds; ///< max processor time; four times as much on the clock. At most 10^6
} IsolateLimits;

/// Receives the function's answer.
typedef struct IsolateAnswer {
    int pipe;
} IsolateAnswer;

/// Appends bytes to the answer. Ends the process if the parent is gone.
void isolate_put(IsolateAnswer *answer, const void *bytes, size_t size);

/// Runs in the child: writes its answer, or fills *error (never NULL) and returns its code. It sees a copy of all
/// memory; its changes are lost. Its output is discarded.
typedef SingeResult IsolateWork(void *context, IsolateAnswer *answer, SingeError *error);

/// Whether isolate_run can create a child: this process has one thread.
bool isolate_possible(void);

/// Runs work(context) in a child and waits for it. *answer is its answer; the caller validates it like a file, and
/// frees it with bytes_free. `name` is the file's, for messages. Call it only while this process has one thread.
/// Errors: what `work` returned; SINGE_ERROR_LIMIT if it exceeded the memory of `limits` or an allocation failed
/// (error->element is limits.memory), or exceeded the time (-1); SINGE_ERROR_FORMAT if it crashed; SINGE_ERROR_MEMORY
/// without memory for the answer or a process; SINGE_ERROR_STATE if other threads run, or a signal stopped the child.
///
/// Linux enforces the memory limit at each allocation. Elsewhere, and under sanitizers, whose shadow memory counts,
/// too, it is checked several times a second.
SINGE_NODISCARD SingeResult isolate_run(const char *name, IsolateWork *work, void *context, IsolateLimits limits,
                                        SingeAllocator allocator, Bytes *answer, SingeError *error);
