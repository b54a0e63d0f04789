#include "cli/recording.h"

#include <errno.h>
#include <string.h>

static ExitCode recording_fail(const Recording *recording, int reason, Console *console) {
    console_error(console, "cannot write the recording %s: %s", recording->path, strerror(reason));
    return EXIT_FAILED;
}

ExitCode recording_open(Recording *recording, const char *path, Console *console) {
    recording->path = path;
    recording->file = fopen(path, "wb");
    if (!recording->file) return recording_fail(recording, errno, console);
    setvbuf(recording->file, NULL, _IONBF, 0);
    return EXIT_GOOD;
}

static bool recording_write(void *context, const void *bytes, size_t size) {
    Recording *recording = context;
    errno = 0;
    if (fwrite(bytes, 1, size, recording->file) == size) return true;
    recording->reason = errno ? errno : EIO;
    return false;
}

SingeRecord recording_hook(Recording *recording) {
    return (SingeRecord){recording->file ? recording_write : NULL, recording};
}

ExitCode recording_close(Recording *recording, ExitCode code, Console *console) {
    if (!recording->file) return code;
    if (fclose(recording->file) && !recording->reason) recording->reason = errno;
    recording->file = NULL;
    if (!recording->reason) return code;
    const ExitCode failed = recording_fail(recording, recording->reason, console);
    return code ? code : failed;
}
