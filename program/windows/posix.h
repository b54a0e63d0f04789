// The part of POSIX that the command uses and Windows lacks. The compiler includes this file first in every file of the
// command (posix.cmake), which also writes the headers that Windows lacks: they lead here. Paths are UTF-8, with / between their parts.
#pragma once

#define _CRT_RAND_S // before the first of Windows' headers
#include <direct.h>
#include <errno.h>
#include <fcntl.h>
#include <io.h>
#include <process.h>
#include <pthread.h>
#include <signal.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <time.h>
#include <unistd.h>

// ---- files

#define O_NONBLOCK 0
#define O_CLOEXEC _O_NOINHERIT
#define O_NOFOLLOW 0
#define O_DIRECTORY 0
#define S_IFLNK 0120000
#define S_ISLNK(mode) (((mode)&0170000) == S_IFLNK)
#define AT_SYMLINK_NOFOLLOW 1
#ifndef ELOOP
#define ELOOP 114
#endif
#ifndef ENOTSUP
#define ENOTSUP 129
#endif

/// UTF-8 with / in place of \\, allocated; NULL without memory.
char *windows_utf8(const wchar_t *wide);

/// What is known of a file, with its number, which Windows' own lacks.
struct windows_stat {
    uint64_t st_dev, st_ino;
    uint32_t st_mode, st_nlink;
    int64_t st_size;
    time_t st_mtime;
};

int windows_open(const char *path, int flags, ...);
FILE *windows_fopen(const char *path, const char *mode);
/// Of a file, or of what a link leads to.
int windows_stat(const char *path, struct windows_stat *about);
/// Of a file or a link itself.
int lstat(const char *path, struct windows_stat *about);
int windows_fstat(int file, struct windows_stat *about);
int windows_access(const char *path, int mode);
int windows_mkdir(const char *path);
int windows_rmdir(const char *path);
int windows_unlink(const char *path);
/// Replaces `to` if it is there.
int windows_rename(const char *from, const char *to);
int link(const char *from, const char *to);
/// The path from the drive, allocated; NULL if nothing is there. `buffer` is NULL.
char *realpath(const char *path, char *buffer);
int fsync(int file);
ssize_t pread(int file, void *bytes, size_t size, off_t at);
ssize_t pwrite(int file, const void *bytes, size_t size, off_t at);

#define stat windows_stat
#define open windows_open
#define fopen windows_fopen
#define fstat windows_fstat
#define access windows_access
#define mkdir(path, mode) windows_mkdir(path)
#define rmdir windows_rmdir
#define unlink windows_unlink
#define rename windows_rename

// ---- locks of whole files

#define F_GETFD 1
#define F_GETFL 3
#define F_SETFL 4
#define F_GETLK 5
#define F_SETLK 6
#define F_RDLCK 0
#define F_WRLCK 1
#define F_UNLCK 2

struct flock {
    short l_type, l_whence;
    off_t l_start, l_len;
    pid_t l_pid;
};

/// F_SETLK as POSIX has it; F_GETLK knows no holder; the others do nothing.
int fcntl(int file, int what, ...);

// ---- folders

struct dirent {
    char d_name[1024];
};
typedef struct WindowsFolder DIR;

DIR *opendir(const char *path);
struct dirent *readdir(DIR *folder);
int closedir(DIR *folder);
DIR *fdopendir(int file);
int dirfd(DIR *folder);
int unlinkat(int folder, const char *name, int flags);
/// Of a link itself, whatever the flags.
int fstatat(int folder, const char *name, struct windows_stat *about, int flags);

// ---- streams in memory

/// As POSIX has it, but the text is there only after fclose.
FILE *open_memstream(char **text, size_t *size);
int windows_fclose(FILE *stream);
/// A new file to write and read, which goes when it is closed.
FILE *temporary_stream(void);
#define fclose windows_fclose

// ---- processes and signals

#define SIGPIPE 13
#define SIGKILL 9
#define SIGXFSZ 25
#define SA_RESTART 0
#define WNOHANG 1
#define WIFEXITED(status) 1
#define WEXITSTATUS(status) (status)
#define WIFSIGNALED(status) 0
#define WTERMSIG(status) 0

struct sigaction {
    void (*sa_handler)(int);
    int sa_flags;
    int sa_mask;
};

#define sigemptyset(set) ((void)(*(set) = 0))
#define sigaddset(set, number) ((void)0)

/// SIGINT and SIGTERM only.
int sigaction(int number, const struct sigaction *next, struct sigaction *old);
/// Ends a process of spawn_program.
int kill(pid_t process, int number);
/// Waits for a process of spawn_program.
pid_t waitpid(pid_t process, int *status, int flags);

// ---- the system

#define _SC_NPROCESSORS_ONLN 84
#define _SC_PHYS_PAGES 85
#define _SC_PAGESIZE 30
#define RLIMIT_AS 1
#define RLIMIT_DATA 2
#define RLIMIT_STACK 3
#define RLIMIT_NOFILE 4
#define RLIM_INFINITY UINT64_MAX
#define RUSAGE_SELF 0

typedef uint64_t rlim_t;
struct rlimit {
    rlim_t rlim_cur, rlim_max;
};
struct rusage {
    struct timeval ru_utime, ru_stime;
    long ru_maxrss;
};

long sysconf(int what);
int gethostname(char *name, size_t size);
/// Windows has no such limits: -1.
int getrlimit(int what, struct rlimit *limit);
int getrusage(int whose, struct rusage *used);
int getentropy(void *bytes, size_t size);
int strerror_r(int reason, char *text, size_t size);
struct tm *gmtime_r(const time_t *at, struct tm *parts);
char *strndup(const char *text, size_t max);
char *mkdtemp(char *path);

/// Aligned to 16 bytes only: free takes no other memory.
#define aligned_alloc(alignment, size) malloc(size)

#define popen _popen
#define pclose _pclose

// ---- what libfyaml asks for

#undef alloca
#define alloca __builtin_alloca
#define PROT_READ 1
#define MAP_PRIVATE 2
#define MAP_FAILED ((void *)-1)
#define mmap(address, size, protection, flags, file, at) MAP_FAILED
#define munmap(address, size) 0
#define posix_madvise(address, size, advice) 0
#define TCSANOW 0
#define tcgetattr(file, now) (-1) // no terminal answers
#define tcsetattr(file, when, next) (-1)
#define cfmakeraw(next) ((void)(next))
#define FD_ZERO(set) ((void)(*(set) = 0))
#define FD_SET(file, set) ((void)(*(set) = 1))
#define FD_ISSET(file, set) (*(set))
#define select(count, read, write, except, wait) 0

typedef int fd_set;
struct termios {
    int unused;
};
