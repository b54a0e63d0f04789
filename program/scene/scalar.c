// fy_token_get_text of libfyaml 0.7 reads '''' (two quotes in quotes) as three quotes, finds that they do not fit,
// leaks and returns an empty text. So single quotes are removed here, and other styles are read chunk by chunk.
#include "scene/scalar.h"

#include <stdbool.h>
#include <string.h>

/// The bytes between the quotes of a single-quoted token; false if they are not at its marks.
static bool quoted_range(struct fy_token *token, const char *bytes, size_t size, const char **begin, const char **end) {
    const struct fy_mark *first = fy_token_start_mark(token), *last = fy_token_end_mark(token);
    if (!first || !last || first->input_pos < 1 || first->input_pos > last->input_pos || last->input_pos >= size)
        return false;
    *begin = bytes + first->input_pos;
    *end = bytes + last->input_pos;
    return (*begin)[-1] == '\'' && **end == '\'';
}

static bool is_blank(char c) { return c == ' ' || c == '\t'; }

/// Length of the line break at c: \n, \r or \r\n.
static int line_break(const char *c, const char *end) {
    if (c == end || (*c != '\n' && *c != '\r')) return 0;
    return *c == '\r' && end - c > 1 && c[1] == '\n' ? 2 : 1;
}

/// YAML 1.2, 7.3.2: '' is one quote. Lines are folded: blanks around a break vanish, one break is a space, and n breaks
/// are n - 1 newlines. `out` has room for as many bytes as the input.
static size_t scalar_unquote(const char *c, const char *end, char *out) {
    size_t length = 0, line = 0; // `line`: where trailing blanks of the current line may begin
    while (c < end) {
        int width = line_break(c, end);
        if (!width) {
            out[length++] = *c;
            c += *c == '\'' && end - c > 1 ? 2 : 1;
            continue;
        }
        while (length > line && is_blank(out[length - 1])) length--;
        int breaks = 0;
        for (; (width = line_break(c, end)) > 0; breaks++) {
            c += width;
            while (c < end && is_blank(*c)) c++;
        }
        if (breaks == 1) out[length++] = ' ';
        else memset(out + length, '\n', (size_t)breaks - 1), length += (size_t)breaks - 1;
        line = length;
    }
    return length;
}

/// Bytes of a token, copied to `out` if that is not NULL.
static size_t copy_chunks(struct fy_token_iter *iterator, char *out) {
    const struct fy_iter_chunk *chunk = NULL;
    size_t length = 0;
    int error = 0;
    while ((chunk = fy_token_iter_chunk_next(iterator, chunk, &error))) {
        if (out) memcpy(out + length, chunk->str, chunk->len);
        length += chunk->len;
    }
    return length;
}

static char *read_chunks(SceneArena *arena, struct fy_token *token, size_t *length) {
    struct fy_token_iter *count = fy_token_iter_create(token), *copy = fy_token_iter_create(token);
    char *text = NULL;
    if (count && copy) {
        *length = copy_chunks(count, NULL);
        text = arena_new(arena, *length + 1, 1);
        if (text) copy_chunks(copy, text);
    }
    fy_token_iter_destroy(count);
    fy_token_iter_destroy(copy);
    return text;
}

char *scalar_text(SceneArena *arena, struct fy_token *token, const char *bytes, size_t size, size_t *length) {
    const char *begin, *end;
    *length = 0;
    if (!token) return arena_text(arena, "", 0);
    if (fy_token_scalar_style(token) != FYSS_SINGLE_QUOTED || !quoted_range(token, bytes, size, &begin, &end))
        return read_chunks(arena, token, length);
    char *text = arena_new(arena, (size_t)(end - begin) + 1, 1);
    if (text) text[ *length = scalar_unquote(begin, end, text)] = 0;
    return text;
}
