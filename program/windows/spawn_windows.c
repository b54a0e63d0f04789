#include "cli/spawn.h"
#include "cli/text.h"

#define WIN32_LEAN_AND_MEAN
#include <windows.h>

#include <stdbool.h>

/// A growing command line, in UTF-8.
typedef struct CommandLine {
    char text[32768];
    size_t length;
} CommandLine;

static void put(CommandLine *line, char byte, size_t times) {
    while (times-- && line->length + 1 < sizeof line->text) line->text[line->length++] = byte;
    line->text[line->length] = 0;
}

/// Adds an argument in quotes, as Windows' programs take them apart: \ is itself but before a quote.
static void put_argument(CommandLine *line, const char *argument) {
    size_t slashes = 0;
    put(line, ' ', line->length > 0);
    put(line, '"', 1);

    for (const char *c = argument; *c; c++) {
        put(line, '\\', *c == '"' ? slashes + 1 : 0);
        put(line, *c, 1);
        slashes = *c == '\\' ? slashes + 1 : 0;
    }

    put(line, '\\', slashes);
    put(line, '"', 1);
}

int spawn_program(char *const *arguments, const char *log, pid_t *child) {
    static wchar_t wide[32768];
    CommandLine line = {.length = 0};
    for (int i = 0; arguments[i]; i++) put_argument(&line, arguments[i]);
    if (line.length + 1 == sizeof line.text) return E2BIG; // it is cut off
    if (!MultiByteToWideChar(CP_UTF8, 0, line.text, -1, wide, 32768)) return E2BIG;

    const int nothing = open("/dev/null", O_RDONLY),
              written = log ? open(log, O_WRONLY | O_CREAT | O_APPEND, 0666) : -1;
    HANDLE out = written >= 0 ? (HANDLE)_get_osfhandle(written) : GetStdHandle(STD_OUTPUT_HANDLE);
    if (written >= 0) SetFilePointer(out, 0, NULL, FILE_END);

    STARTUPINFOW start = {.cb = sizeof start,
                          .dwFlags = STARTF_USESTDHANDLES,
                          .hStdInput = (HANDLE)_get_osfhandle(nothing),
                          .hStdOutput = out,
                          .hStdError = written >= 0 ? out : GetStdHandle(STD_ERROR_HANDLE)};
    PROCESS_INFORMATION made;
    const DWORD group = log ? CREATE_NEW_PROCESS_GROUP : 0;
    const bool good = CreateProcessW(NULL, wide, NULL, NULL, TRUE, group, NULL, NULL, &start, &made);
    const int reason = good ? 0 : GetLastError() == ERROR_FILE_NOT_FOUND ? ENOENT : EACCES;

    if (good) {
        CloseHandle(made.hThread);
        *child = (pid_t)(intptr_t)made.hProcess;
    }

    close(nothing);
    if (written >= 0) close(written);
    return reason;
}

char *spawn_own_path(void) {
    wchar_t wide[4096];
    char path[3 * 4096];
    const DWORD length = GetModuleFileNameW(NULL, wide, 4096);
    if (!length || length == 4096) return text_format("singe");
    WideCharToMultiByte(CP_UTF8, 0, wide, -1, path, sizeof path, NULL, NULL);
    return text_format("%s", path);
}
