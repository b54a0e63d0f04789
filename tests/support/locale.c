#include "support.h"

#include <locale.h>

bool test_comma_locale(void) {
    static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "ps_AF.UTF-8"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (setlocale(LC_ALL, names[i]) && localeconv()->decimal_point[0] != '.') return true;
    setlocale(LC_ALL, "C");
    print_message("skipped: no locale with a decimal comma is installed, and localedef could make none\n");
    return false;
}
