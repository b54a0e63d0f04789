// The nearest word by the Damerau-Levenshtein distance (optimal string alignment): insertions, deletions, substitutions
// and swaps of neighbours; case is ignored.
#include "scene/schema.h"

#include <string.h>

enum { WORD_MAX = 40 };

static char lower(char c) { return c >= 'A' && c <= 'Z' ? (char)(c + 'a' - 'A') : c == '-' || c == ' ' ? '_' : c; }
static int smaller(int a, int b) { return a < b ? a : b; }

void nearest_offer(Nearest *nearest, const char *candidate) {
    size_t length = strlen(nearest->word), other = strlen(candidate);
    if (!length || length > WORD_MAX || other > WORD_MAX) return;

    // d[i][j]: the distance between the first i letters of a and the first j of b
    const char *a = nearest->word, *b = candidate;
    int m = (int)length, n = (int)other, d[WORD_MAX + 1][WORD_MAX + 1];
    for (int i = 0; i <= m; i++) d[i][0] = i;
    for (int j = 0; j <= n; j++) d[0][j] = j;

    for (int i = 1; i <= m; i++)
        for (int j = 1; j <= n; j++) {
            bool same = lower(a[i - 1]) == lower(b[j - 1]);
            d[i][j] = smaller(smaller(d[i - 1][j], d[i][j - 1]) + 1, d[i - 1][j - 1] + !same);
            if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]))
                d[i][j] = smaller(d[i][j], d[i - 2][j - 2] + 1);
        }

    int distance = d[m][n], max = (int)(length > other ? length : other) / 3;
    if (distance <= (max > 1 ? max : 1) && distance < (int)other && (!nearest->best || distance < nearest->distance)) {
        nearest->best = candidate;
        nearest->distance = distance;
    }
}

const char *nearest_hint(const Nearest *nearest, char *buffer, size_t size) {
    buffer[0] = 0;
    if (nearest->best) snprintf(buffer, size, "; did you mean '%s'?", nearest->best);
    return buffer;
}
