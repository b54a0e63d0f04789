// Writes docs/scene.md to standard output; with a file's name, compares that file with it instead.
#include "scene/scene.h"

#include <stdlib.h>
#include <string.h>

static char *document_text(size_t *size) {
    char *text = NULL;
    FILE *memory = open_memstream(&text, size);
    if (!memory) return NULL;
    scene_document(memory);
    if (fclose(memory) || !text || !*size) {
        free(text);
        return NULL;
    }
    return text;
}

static int document_compare(const char *path, const char *text, size_t size) {
    Bytes bytes = {0};
    SingeError error;
    if (file_read(path, (SingeAllocator){0}, &bytes, &error)) {
        fprintf(stderr, "%s\n", error.message);
        return 1;
    }
    size_t line = 1, i = 0;
    for (; i < size && i < bytes.size && text[i] == (char)bytes.data[i]; i++) line += text[i] == '\n';
    bool same = i == size && i == bytes.size;
    if (!same) fprintf(stderr, "%s:%zu: differs from the schema; run scene_document > %s\n", path, line, path);
    bytes_free(&bytes);
    return same ? 0 : 1;
}

int main(int argc, char **argv) {
    size_t size = 0;
    char *text = document_text(&size);
    if (!text) {
        fputs("out of memory\n", stderr);
        return 1;
    }
    int status = 0;
    if (argc > 1) status = document_compare(argv[1], text, size);
    else status = fwrite(text, 1, size, stdout) == size && fflush(stdout) == 0 ? 0 : 1;
    free(text);
    return status;
}
