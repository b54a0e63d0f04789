#include "windows/posix.h"

// the names that posix.h gives new meanings
#undef access
#undef fclose
#undef fopen
#undef fstat
#undef mkdir
#undef open
#undef rename
#undef rmdir
#undef stat
#undef unlink

#define WIN32_LEAN_AND_MEAN
#include <windows.h>

#include <psapi.h>
#include <stdarg.h>
#include <wchar.h>

enum { PATH_UNITS = 4200 }; ///< of UTF-16; longer paths do not fit where the command holds them

/// A path as Windows takes it.
typedef struct WidePath {
    wchar_t text[PATH_UNITS];
} WidePath;

static WidePath widen(const char *path) {
    WidePath wide;
    if (strcmp(path, "/dev/null") == 0) path = "NUL";
    if (!MultiByteToWideChar(CP_UTF8, 0, path, -1, wide.text, PATH_UNITS)) wide.text[0] = 0;
    return wide;
}

char *windows_utf8(const wchar_t *wide) {
    const int size = WideCharToMultiByte(CP_UTF8, 0, wide, -1, NULL, 0, NULL, NULL);
    char *text = malloc((size_t)size + 1);
    if (!text) return NULL;
    WideCharToMultiByte(CP_UTF8, 0, wide, -1, text, size, NULL, NULL);
    for (char *c = text; *c; c++)
        if (*c == '\\') *c = '/';
    return text;
}

/// 0 if it is good; else -1 with errno.
static int outcome(BOOL good) {
    static const struct {
        DWORD code;
        int reason;
    } reasons[] = {{ERROR_FILE_NOT_FOUND, ENOENT},   {ERROR_PATH_NOT_FOUND, ENOENT}, {ERROR_INVALID_NAME, ENOENT},
                   {ERROR_BAD_PATHNAME, ENOENT},     {ERROR_ACCESS_DENIED, EACCES},  {ERROR_SHARING_VIOLATION, EACCES},
                   {ERROR_LOCK_VIOLATION, EAGAIN},   {ERROR_ALREADY_EXISTS, EEXIST}, {ERROR_FILE_EXISTS, EEXIST},
                   {ERROR_DIR_NOT_EMPTY, ENOTEMPTY}, {ERROR_DIRECTORY, ENOTDIR},     {ERROR_DISK_FULL, ENOSPC},
                   {ERROR_NOT_ENOUGH_MEMORY, ENOMEM}};
    if (good) return 0;

    const DWORD code = GetLastError();
    errno = EIO;
    for (size_t i = 0; i < sizeof reasons / sizeof *reasons; i++)
        if (reasons[i].code == code) errno = reasons[i].reason;
    return -1;
}

// ---- files

int windows_open(const char *path, int flags, ...) {
    // others may remove or replace an open file, as POSIX has it
    const DWORD share = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;
    const DWORD access = flags & O_RDWR     ? GENERIC_READ | GENERIC_WRITE
                         : flags & O_WRONLY ? GENERIC_WRITE
                                            : GENERIC_READ;
    const DWORD made = flags & O_EXCL    ? CREATE_NEW
                       : flags & O_CREAT ? flags & O_TRUNC ? CREATE_ALWAYS : OPEN_ALWAYS
                       : flags & O_TRUNC ? TRUNCATE_EXISTING
                                         : OPEN_EXISTING;
    SECURITY_ATTRIBUTES inherited = {.nLength = sizeof inherited, .bInheritHandle = !(flags & O_CLOEXEC)};
    HANDLE handle = CreateFileW(widen(path).text, access, share, &inherited, made, FILE_FLAG_BACKUP_SEMANTICS, NULL);
    if (handle == INVALID_HANDLE_VALUE) return outcome(FALSE);

    return _open_osfhandle((intptr_t)handle, flags & (O_APPEND | O_CLOEXEC));
}

FILE *windows_fopen(const char *path, const char *mode) {
    const int kind = *mode == 'r' ? O_RDONLY : *mode == 'w' ? O_CREAT | O_TRUNC : O_CREAT | O_APPEND;
    const int file = windows_open(path, kind | (strchr(mode, '+') ? O_RDWR : *mode == 'r' ? 0 : O_WRONLY) | O_CLOEXEC);
    char binary[8];
    if (file < 0) return NULL;
    snprintf(binary, sizeof binary, "%.3s%s", mode, strchr(mode, 'b') ? "" : "b");
    FILE *stream = _fdopen(file, binary);
    if (!stream) _close(file);
    return stream;
}

static int about_handle(HANDLE handle, struct windows_stat *about) {
    BY_HANDLE_FILE_INFORMATION found;
    *about = (struct windows_stat){.st_mode = S_IFCHR, .st_nlink = 1};
    if (GetFileType(handle) == FILE_TYPE_PIPE) about->st_mode = S_IFIFO;
    if (GetFileType(handle) != FILE_TYPE_DISK) return 0;
    if (!GetFileInformationByHandle(handle, &found)) return outcome(FALSE);

    const uint64_t since_1601 =
        (uint64_t)found.ftLastWriteTime.dwHighDateTime << 32 | found.ftLastWriteTime.dwLowDateTime;
    *about = (struct windows_stat){
        .st_dev = found.dwVolumeSerialNumber,
        .st_ino = (uint64_t)found.nFileIndexHigh << 32 | found.nFileIndexLow,
        .st_mode = found.dwFileAttributes & FILE_ATTRIBUTE_REPARSE_POINT ? S_IFLNK
                   : found.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY   ? S_IFDIR
                                                                         : S_IFREG,
        .st_nlink = found.nNumberOfLinks,
        .st_size = (int64_t)((uint64_t)found.nFileSizeHigh << 32 | found.nFileSizeLow),
        .st_mtime = (time_t)(since_1601 / 10000000) - 11644473600,
    };

    return 0;
}

/// `link`: of a link itself.
static int about_path(const wchar_t *path, DWORD link, struct windows_stat *about) {
    HANDLE handle = CreateFileW(path, 0, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, NULL, OPEN_EXISTING,
                                FILE_FLAG_BACKUP_SEMANTICS | link, NULL);
    if (handle == INVALID_HANDLE_VALUE) return outcome(FALSE);
    const int result = about_handle(handle, about);
    CloseHandle(handle);
    return result;
}

int windows_stat(const char *path, struct windows_stat *about) { return about_path(widen(path).text, 0, about); }

int lstat(const char *path, struct windows_stat *about) {
    return about_path(widen(path).text, FILE_FLAG_OPEN_REPARSE_POINT, about);
}

int windows_fstat(int file, struct windows_stat *about) { return about_handle((HANDLE)_get_osfhandle(file), about); }

int windows_access(const char *path, int mode) { return _waccess(widen(path).text, mode); }

int windows_mkdir(const char *path) { return outcome(CreateDirectoryW(widen(path).text, NULL)); }

int windows_rmdir(const char *path) { return outcome(RemoveDirectoryW(widen(path).text)); }

int windows_unlink(const char *path) { return outcome(DeleteFileW(widen(path).text)); }

int windows_rename(const char *from, const char *to) {
    return outcome(MoveFileExW(widen(from).text, widen(to).text, MOVEFILE_REPLACE_EXISTING));
}

int link(const char *from, const char *to) { return outcome(CreateHardLinkW(widen(to).text, widen(from).text, NULL)); }

char *realpath(const char *path, char *buffer) {
    wchar_t whole[PATH_UNITS];
    (void)buffer;
    if (windows_access(path, F_OK) || !GetFullPathNameW(widen(path).text, PATH_UNITS, whole, NULL)) return NULL;
    char *text = windows_utf8(whole);
    for (size_t n = text ? strlen(text) : 0; n > 3 && text[n - 1] == '/'; n--) text[n - 1] = 0;
    return text;
}

int fsync(int file) { return _commit(file); }

ssize_t pread(int file, void *bytes, size_t size, off_t at) {
    return _lseeki64(file, at, SEEK_SET) < 0 ? -1 : _read(file, bytes, (unsigned)size);
}

ssize_t pwrite(int file, const void *bytes, size_t size, off_t at) {
    return _lseeki64(file, at, SEEK_SET) < 0 ? -1 : _write(file, bytes, (unsigned)size);
}

// ---- locks

int fcntl(int file, int what, ...) {
    HANDLE handle = (HANDLE)_get_osfhandle(file);
    if (what != F_SETLK && what != F_GETLK) return 0;

    va_list list;
    va_start(list, what);
    struct flock *lock = va_arg(list, struct flock *);
    va_end(list);

    const short wanted = lock->l_type;
    if (what == F_GETLK) lock->l_type = F_UNLCK;
    if (what == F_GETLK) return 0;

    // one byte beyond any content, since Windows lets nobody else read what is locked
    OVERLAPPED place = {.Offset = 0xfffffffe, .OffsetHigh = 0x7fffffff};
    UnlockFileEx(handle, 0, 1, 0, &place);
    if (wanted == F_UNLCK) return 0;

    const DWORD kind = LOCKFILE_FAIL_IMMEDIATELY | (wanted == F_WRLCK ? LOCKFILE_EXCLUSIVE_LOCK : 0);
    const int result = outcome(LockFileEx(handle, kind, 0, 1, 0, &place));
    if (result) errno = EAGAIN;
    return result;
}

// ---- folders

struct WindowsFolder {
    int file;
    HANDLE search;
    bool begun;
    WIN32_FIND_DATAW found;
    struct dirent entry;
};

/// The path of an open folder, and a name in it.
static WidePath path_in(int folder, const wchar_t *name) {
    WidePath path;
    const DWORD length = GetFinalPathNameByHandleW((HANDLE)_get_osfhandle(folder), path.text, PATH_UNITS, 0);
    path.text[length < PATH_UNITS ? length : 0] = 0;
    if (length + wcslen(name) + 2 < PATH_UNITS) wcscat(wcscat(path.text, L"\\"), name);
    return path;
}

DIR *fdopendir(int file) {
    struct windows_stat about;
    if (windows_fstat(file, &about)) return NULL;
    errno = S_ISDIR(about.st_mode) ? ENOMEM : ENOTDIR;
    DIR *folder = S_ISDIR(about.st_mode) ? calloc(1, sizeof *folder) : NULL;
    if (!folder) return NULL;

    folder->file = file;
    folder->search = FindFirstFileW(path_in(file, L"*").text, &folder->found);
    if (folder->search != INVALID_HANDLE_VALUE) return folder;
    free(folder);
    outcome(FALSE);
    return NULL;
}

DIR *opendir(const char *path) {
    const int file = windows_open(path, O_RDONLY | O_CLOEXEC);
    DIR *folder = file < 0 ? NULL : fdopendir(file);
    if (file >= 0 && !folder) _close(file);
    return folder;
}

struct dirent *readdir(DIR *folder) {
    if (folder->begun && !FindNextFileW(folder->search, &folder->found)) return NULL;
    folder->begun = true;
    WideCharToMultiByte(CP_UTF8, 0, folder->found.cFileName, -1, folder->entry.d_name, sizeof folder->entry.d_name,
                        NULL, NULL);
    return &folder->entry;
}

int dirfd(DIR *folder) { return folder->file; }

int closedir(DIR *folder) {
    FindClose(folder->search);
    _close(folder->file);
    free(folder);
    return 0;
}

int unlinkat(int folder, const char *name, int flags) {
    (void)flags;
    return outcome(DeleteFileW(path_in(folder, widen(name).text).text));
}

int fstatat(int folder, const char *name, struct windows_stat *about, int flags) {
    (void)flags;
    return about_path(path_in(folder, widen(name).text).text, FILE_FLAG_OPEN_REPARSE_POINT, about);
}

// ---- streams in memory: files that go when they are closed, and are read into memory then

typedef struct MemoryStream {
    struct MemoryStream *next;
    FILE *stream;
    char **text;
    size_t *size;
} MemoryStream;

static MemoryStream *memory_streams;
static SRWLOCK memory_streams_lock = SRWLOCK_INIT;

FILE *temporary_stream(void) {
    wchar_t folder[MAX_PATH + 1], path[MAX_PATH + 1];
    if (!GetTempPathW(MAX_PATH, folder) || !GetTempFileNameW(folder, L"sng", 0, path)) return NULL;
    HANDLE handle = CreateFileW(path, GENERIC_READ | GENERIC_WRITE, FILE_SHARE_DELETE, NULL, CREATE_ALWAYS,
                                FILE_ATTRIBUTE_TEMPORARY | FILE_FLAG_DELETE_ON_CLOSE, NULL);
    if (handle == INVALID_HANDLE_VALUE) return NULL;
    return _fdopen(_open_osfhandle((intptr_t)handle, _O_NOINHERIT), "w+b");
}

FILE *open_memstream(char **text, size_t *size) {
    MemoryStream *memory = malloc(sizeof *memory);
    FILE *stream = memory ? temporary_stream() : NULL;
    *text = NULL;
    *size = 0;

    if (!stream) {
        free(memory);
        return NULL;
    }

    AcquireSRWLockExclusive(&memory_streams_lock);
    *memory = (MemoryStream){memory_streams, stream, text, size};
    memory_streams = memory;
    ReleaseSRWLockExclusive(&memory_streams_lock);
    return stream;
}

int windows_fclose(FILE *stream) {
    AcquireSRWLockExclusive(&memory_streams_lock);
    MemoryStream **at = &memory_streams, *memory;
    while (*at && (*at)->stream != stream) at = &(*at)->next;
    memory = *at;
    if (memory) *at = memory->next;
    ReleaseSRWLockExclusive(&memory_streams_lock);
    if (!memory) return fclose(stream);

    bool good = fflush(stream) == 0;
    const int64_t size = _ftelli64(stream);
    char *text = good && size >= 0 ? malloc((size_t)size + 1) : NULL;

    rewind(stream);
    good = text && fread(text, 1, (size_t)size, stream) == (size_t)size;
    if (good) {
        text[size] = 0;
        *memory->text = text;
        *memory->size = (size_t)size;
    } else {
        free(text);
    }
    fclose(stream);
    free(memory);

    return good ? 0 : EOF;
}

// ---- processes and signals

int sigaction(int number, const struct sigaction *next, struct sigaction *old) {
    (void)old;
    if (number == SIGINT || number == SIGTERM) signal(number, next->sa_handler);
    return 0;
}

int kill(pid_t process, int number) {
    (void)number;
    return outcome(TerminateProcess((HANDLE)(intptr_t)process, 1));
}

pid_t waitpid(pid_t process, int *status, int flags) {
    HANDLE handle = (HANDLE)(intptr_t)process;
    DWORD code = 0;
    if (WaitForSingleObject(handle, flags & WNOHANG ? 0 : INFINITE) != WAIT_OBJECT_0) return 0;
    GetExitCodeProcess(handle, &code);
    CloseHandle(handle);
    if (status) *status = (int)code;
    return process;
}

// ---- the system

long sysconf(int what) {
    SYSTEM_INFO system;
    MEMORYSTATUSEX memory = {.dwLength = sizeof memory};
    GetSystemInfo(&system);
    if (what == _SC_PAGESIZE) return (long)system.dwPageSize;
    if (what == _SC_NPROCESSORS_ONLN) return (long)system.dwNumberOfProcessors;
    return GlobalMemoryStatusEx(&memory) ? (long)(memory.ullTotalPhys / system.dwPageSize) : -1;
}

int gethostname(char *name, size_t size) {
    DWORD length = (DWORD)size;
    return outcome(GetComputerNameA(name, &length));
}

int getrlimit(int what, struct rlimit *limit) {
    (void)what;
    (void)limit;
    return -1;
}

int getrusage(int whose, struct rusage *used) {
    FILETIME begun, ended, times[2];
    PROCESS_MEMORY_COUNTERS memory = {.cb = sizeof memory};
    (void)whose;
    if (!GetProcessTimes(GetCurrentProcess(), &begun, &ended, &times[1], &times[0])) return outcome(FALSE);

    struct timeval *parts[] = {&used->ru_utime, &used->ru_stime};
    for (int i = 0; i < 2; i++) {
        const uint64_t tenths = (uint64_t)times[i].dwHighDateTime << 32 | times[i].dwLowDateTime; // of a microsecond
        *parts[i] = (struct timeval){(long)(tenths / 10000000), (long)(tenths % 10000000 / 10)};
    }

    GetProcessMemoryInfo(GetCurrentProcess(), &memory, sizeof memory);
    used->ru_maxrss = (long)(memory.PeakWorkingSetSize / 1024);
    return 0;
}

int getentropy(void *bytes, size_t size) {
    for (size_t i = 0; i < size; i++) {
        unsigned number;
        if (rand_s(&number)) return -1;
        ((uint8_t *)bytes)[i] = (uint8_t)(number >> 8);
    }
    return 0;
}

int strerror_r(int reason, char *text, size_t size) { return strerror_s(text, size, reason); }

struct tm *gmtime_r(const time_t *at, struct tm *parts) {
    return gmtime_s(parts, at) ? NULL : parts;
}

char *strndup(const char *text, size_t max) {
    const size_t length = strnlen(text, max);
    char *copy = malloc(length + 1);
    if (copy) memcpy(copy, text, length);
    if (copy) copy[length] = 0;
    return copy;
}

char *mkdtemp(char *path) {
    uint32_t number;
    if (getentropy(&number, sizeof number)) return NULL;
    snprintf(path + strlen(path) - 6, 7, "%06x", (unsigned)(number & 0xffffff));
    return windows_mkdir(path) ? NULL : path;
}
