#include "cli/spawn.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stddef.h>
#include <unistd.h>

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
