#include "cli/spawn.h"
#include "cli/text.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <unistd.h>
#ifdef __APPLE__
#include <mach-o/dyld.h>
#endif

extern char **environ;

int spawn_program(char *const *arguments, const char *log, pid_t *child) {
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    sigset_t shielded; // the child must not ignore what this program ignores

    sigemptyset(&shielded);
    sigaddset(&shielded, SIGPIPE);
    sigaddset(&shielded, SIGXFSZ);
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setsigdefault(&attributes, &shielded);

    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    if (log) {
        posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log, O_WRONLY | O_CREAT | O_APPEND, 0666);
        posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
        // otherwise Ctrl-C would reach the child twice, and the second ends a run at once
        posix_spawnattr_setpgroup(&attributes, 0);
    }

    posix_spawnattr_setflags(&attributes, (short)(POSIX_SPAWN_SETSIGDEF | (log ? POSIX_SPAWN_SETPGROUP : 0)));

    const int reason = posix_spawnp(child, arguments[0], &actions, &attributes, arguments, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    return reason;
}

char *spawn_own_path(void) {
    char path[4096];
#ifdef __APPLE__
    uint32_t length = sizeof path;
    const bool known = _NSGetExecutablePath(path, &length) == 0;
#else
    const ssize_t size = readlink("/proc/self/exe", path, sizeof path - 1);
    const bool known = size > 0;
    if (known) path[size] = 0;
#endif
    return text_format("%s", known ? path : "singe");
}
