// Writes docs/scene.md to standard output; with a file's name, compares that file with it instead.
#include "scene/scene.h"

#include <stdlib.h>
#include <string.h>

int main(int argc, char **argv) {
    char *text = NULL;
    size_t size = 0;
    FILE *memory = open_memstream(&text, &size);
    if (memory) scene_document(memory);
    if (!memory || fclose(memory) || !size) {
        fputs("out of memory\n", stderr);
        return 1;
    }

    if (argc < 2) return fwrite(text, 1, size, stdout) == size && fflush(stdout) == 0 ? 0 : 1;

    Bytes bytes = {0};
    SingeError error;
    if (file_read(argv[1], (SingeAllocator){0}, &bytes, &error)) {
        fprintf(stderr, "%s\n", error.message);
        return 1;
    }

    size_t line = 1, i = 0;
    for (; i < size && i < bytes.size && text[i] == (char)bytes.data[i]; i++) line += text[i] == '\n';
    bool same = i == size && i == bytes.size;
    if (!same) fprintf(stderr, "%s:%zu: differs from the schema; run scene_document > %s\n", argv[1], line, argv[1]);
    bytes_free(&bytes);
    free(text);

    return same ? 0 : 1;
}
