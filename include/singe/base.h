/// Singe: results, errors, hooks and handles shared by every public header.
///
/// ABI rule: a Def begins with `struct_size`. Its `singe_default_...()` function is inline and sets it to the size that
/// the caller's header knows. Fields are only ever appended. A smaller Def from an older header is accepted: the fields
/// that it lacks take their defaults. Of a larger Def from a newer header the unknown fields are not read. The same
/// holds for a Def inside another. Structs that a simulation returns (views, statistics, timers, counts, ranges,
/// surfaces, gas) grow at their end, too. A function fills them: it takes the caller's sizeof, writes no more than
/// that, and zeroes fields that the library does not know. An inline function returns the same struct by value. All
/// other structs (parameters, textures, keys, hooks) keep their size within a SINGE_VERSION_MAJOR. Enumerators never
/// change their values. tests/abi/abi.txt lists all of them.
///
/// Units are SI and kelvin throughout. Nothing here depends on the locale.
#ifndef SINGE_BASE_H
#define SINGE_BASE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define SINGE_VERSION_MAJOR 0
#define SINGE_VERSION_MINOR 2
#define SINGE_VERSION_PATCH 0
#define SINGE_VERSION "0.2.0"

#if defined(SINGE_SHARED) && defined(_WIN32)
#if defined(SINGE_BUILD)
#define SINGE_API __declspec(dllexport)
#else
#define SINGE_API __declspec(dllimport)
#endif
#elif defined(__GNUC__) && !defined(_WIN32)
#define SINGE_API __attribute__((visibility("default")))
#else
#define SINGE_API
#endif

#if defined(__GNUC__)
#define SINGE_NODISCARD __attribute__((warn_unused_result))
#if defined(__MINGW32__) && !defined(__clang__) // formats of C, not of Microsoft's library
#define SINGE_PRINTF(string_index, first) __attribute__((format(gnu_printf, string_index, first)))
#else
#define SINGE_PRINTF(string_index, first) __attribute__((format(printf, string_index, first)))
#endif
#else
#define SINGE_NODISCARD
#define SINGE_PRINTF(string_index, first)
#endif

#ifdef __cplusplus
extern "C" {
#endif

/// What a fallible function returns. Zero is success.
typedef enum SingeResult {
    SINGE_OK = 0,
    SINGE_ERROR_ARGUMENT = 1,   ///< a Def field or argument is out of its range
    SINGE_ERROR_MEMORY = 2,     ///< the allocator returned NULL
    SINGE_ERROR_MESH = 3,       ///< the mesh is degenerate, non-manifold or indexes out of range
    SINGE_ERROR_HANDLE = 4,     ///< the handle is stale or invalid
    SINGE_ERROR_STATE = 5,      ///< the call is not allowed now (a sheet added after the first step)
    SINGE_ERROR_DIVERGED = 6,   ///< a stage produced a value that is not finite; state rolled back
    SINGE_ERROR_FORMAT = 7,     ///< bytes do not follow their format (file, snapshot, scene)
    SINGE_ERROR_VERSION = 8,    ///< the snapshot is of another version
    SINGE_ERROR_FILE = 9,       ///< the operating system refused a file
    SINGE_ERROR_LIMIT = 10,     ///< an input larger than the format or the index type allows
    SINGE_ERROR_CANCELLED = 11, ///< the host has asked to give the step up (SingeCancel); state rolled back
} SingeResult;

/// The short English name of a result ("out of memory").
SINGE_API const char *singe_result_name(SingeResult result);

/// The library's version as it was built, "major.minor.patch".
SINGE_API const char *singe_version(void);

/// Where and why something failed. Filled only on failure; it holds nothing to be freed.
typedef struct SingeError {
    SingeResult code;
    char stage[24];    ///< "sheet", "heat", "burn", "ablate", "dynamics", "obj", "scene", ...
    int64_t element;   ///< index of the cell, vertex, line, ... concerned, or -1
    char message[400]; ///< one sentence, zero-terminated
} SingeError;

/// Memory hook. `resize` behaves as realloc: (NULL, 0, n) allocates, (p, n, 0) frees and returns
/// NULL. Blocks must be aligned for any standard type. A zeroed struct means libc's allocator.
typedef struct SingeAllocator {
    void *(*resize)(void *context, void *block, size_t old_size, size_t new_size);
    void *context;
} SingeAllocator;

typedef enum SingeLogLevel { SINGE_LOG_INFO = 0, SINGE_LOG_WARNING = 1, SINGE_LOG_ERROR = 2 } SingeLogLevel;

/// Receives one line without its newline: a summary at the commit, and warnings of what will look wrong. Errors are
/// returned as results. The library itself never prints.
typedef struct SingeLog {
    void (*write)(void *context, SingeLogLevel level, const char *line);
    void *context;
} SingeLog;

/// Receives a recording (docs/replay.md), in pieces and in order: how the simulation was made, and every call that
/// changes it. `write` gets a call's arguments before the call does anything, so that what has been written reproduces a
/// crash. If it returns false, the recording ends, with a warning in the log; the simulation goes on.
typedef struct SingeRecord {
    bool (*write)(void *context, const void *bytes, size_t size);
    void *context;
} SingeRecord;

/// Asked often during a step, on any of its threads, whether to give it up; so it must be quick. Once it has answered true
/// the step fails with SINGE_ERROR_CANCELLED, and the simulation is as it was before it. A step may also end as usual, if
/// it was nearly done. A zeroed struct means that no step is given up.
typedef struct SingeCancel {
    bool (*asked)(void *context);
    void *context;
} SingeCancel;

/// A range of independent work items [begin, end).
typedef void SingeTaskFn(void *task, int begin, int end);

/// Task hook, for hosts with a scheduler of their own. `enqueue` may split [0, count) into ranges of
/// at least `grain` items, which may run in any order on any thread. It returns a token for `finish`, which returns
/// when all ranges are done. Results do not depend on the split. Both hooks must be set, or neither: a zeroed struct
/// means the simulation's own pool of `thread_count` threads.
typedef struct SingeTasks {
    void *(*enqueue)(void *context, SingeTaskFn *run, void *task, int count, int grain);
    void (*finish)(void *context, void *token);
    void *context;
} SingeTasks;

/// Handles: an index with a generation, so that a handle to a removed object is detected. Zeroed
/// handles are never valid.
typedef struct SingeSheetId {
    uint32_t index, generation;
} SingeSheetId;
typedef struct SingeSourceId {
    uint32_t index, generation;
} SingeSourceId;
typedef struct SingeColliderId {
    uint32_t index, generation;
} SingeColliderId;
typedef struct SingePinId {
    uint32_t index, generation;
} SingePinId;

#ifdef __cplusplus
}
#endif
#endif
