#define WIN32_LEAN_AND_MEAN
#include <windows.h>

#include <shellapi.h>

/// The command: its own main, renamed by the compiler.
int singe_main(int count, char **words);

/// Runs the command on arguments in UTF-8, with binary streams.
int main(void) {
    int count;
    wchar_t **wide = CommandLineToArgvW(GetCommandLineW(), &count);
    char **words = wide ? calloc((size_t)count + 1, sizeof *words) : NULL;
    for (int i = 0; words && i < count; i++)
        if (!(words[i] = windows_utf8(wide[i]))) return 1;
    if (!words) return 1;
    LocalFree(wide);

    _setmode(_fileno(stdin), _O_BINARY);
    _setmode(_fileno(stdout), _O_BINARY);
    _setmode(_fileno(stderr), _O_BINARY);
    SetConsoleOutputCP(CP_UTF8);

    const int code = singe_main(count, words);
    for (int i = 0; i < count; i++) free(words[i]);
    free(words);
    return code;
}
