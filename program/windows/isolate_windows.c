// Without fork: the work is done in this process, and writes its answer to a file that goes when it is closed.
#include "formats/isolate.h"
#include "common/store.h"

bool isolate_possible(void) { return true; }

void isolate_put(IsolateAnswer *answer, const void *bytes, size_t size) {
    if (_write(answer->pipe, bytes, (unsigned)size) != (int)size) answer->pipe = -1;
}

SingeResult isolate_run(const char *name, IsolateWork *work, void *context, IsolateLimits limits,
                        SingeAllocator allocator, Bytes *answer, SingeError *error) {
    FILE *stream = temporary_stream();
    IsolateAnswer given = {stream ? _fileno(stream) : -1};
    *answer = (Bytes){.allocator = allocator};
    if (!stream) return refuse(error, SINGE_ERROR_FILE, "file", -1, "%s: no temporary file", short_name(name));

    SingeResult result = work(context, &given, error);
    const int64_t size = _lseeki64(_fileno(stream), 0, SEEK_END);
    if (!result && (given.pipe < 0 || size < 0 || (uint64_t)size > limits.memory))
        result = refuse(error, SINGE_ERROR_LIMIT, "file", (int64_t)limits.memory, "%s: too large", short_name(name));

    if (!result) {
        answer->data = store_new(allocator, (size_t)size + 1, 1);
        answer->size = (size_t)size;
        if (!answer->data) result = refuse_memory(error, "file", name);
        else if (pread(given.pipe, answer->data, answer->size, 0) != (ssize_t)answer->size)
            result = refuse(error, SINGE_ERROR_FILE, "file", -1, "%s: no temporary file", short_name(name));
        if (!result) answer->data[answer->size] = 0;
    }

    if (result) bytes_free(answer);
    fclose(stream);
    return result;
}
