#include "cli/streams.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/text.h"
#include "formats/formats.h"

int streams_open(void) {
    // open takes the lowest free descriptor. Standard output is opened for reading only, so that writing to it fails
    static const int modes[] = {[STDIN_FILENO] = O_RDONLY, [STDOUT_FILENO] = O_RDONLY, [STDERR_FILENO] = O_WRONLY};
    for (int fd = STDIN_FILENO; fd <= STDERR_FILENO; fd++)
        if (fcntl(fd, F_GETFD) < 0 && open("/dev/null", modes[fd]) != fd) return -1;
    return 0;
}

/// Whether the path is something other than a file that we may replace.
static int write_through(const char *path, const char *text, size_t size) {
    int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_NONBLOCK | O_CLOEXEC, 0666);
    if (fd < 0) return errno;
    const int flags = fcntl(fd, F_GETFL);
    int reason = flags < 0 || fcntl(fd, F_SETFL, flags & ~O_NONBLOCK) ? errno : 0;
    while (size && !reason) {
        const ssize_t count = write(fd, text, size);
        if (count > 0) {
            text += count;
            size -= (size_t)count;
        } else if (count == 0 || errno != EINTR) reason = count ? errno : EIO;
    }
    if (close(fd) && !reason) reason = errno;
    return reason;
}

static bool is_file(const char *path) {
    struct stat about;
    return lstat(path, &about) ? errno == ENOENT : S_ISREG(about.st_mode);
}

ExitCode streams_write(Console *console, const char *path, void (*print)(FILE *file, const void *context),
                       const void *context) {
    char *text = NULL;
    size_t size = 0;
    int reason = ENOMEM;
    SingeError error = {0};
    FILE *file = open_memstream(&text, &size);
    if (file) print(file, context);
    if (text_stream_end(file, &text))
        reason = !is_file(path) ? write_through(path, text, size) : file_write(path, text, size, &error) ? -1 : 0;
    free(text);
    if (reason > 0) console_error(console, "cannot write %s: %s", path, strerror(reason));
    if (reason < 0) console_result(console, &error);
    return reason ? EXIT_FAILED : EXIT_GOOD;
}

int streams_finish(int code) {
    errno = 0;
    bool failed = fflush(stdout) != 0;
    if (!failed && !ferror(stdout)) return code;
    fprintf(stderr, "singe: error: cannot write to standard output%s%s\n", errno ? ": " : "",
            errno ? strerror(errno) : "");
    return code == EXIT_GOOD ? EXIT_FAILED : code;
}
