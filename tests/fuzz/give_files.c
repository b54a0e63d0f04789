// Gives a fuzz target the files of folders, one after the other, and no bytes at all: what libFuzzer does with a
// corpus.
#include <dirent.h>
#include <stdio.h>

#include "input.h"

static int give(const char *folder, const char *name) {
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, name);

    FILE *file = fopen(path, "rb");
    if (!file || fseek(file, 0, SEEK_END)) {
        perror(path);
        return 1;
    }

    long size = ftell(file);
    uint8_t *data = malloc(size > 0 ? (size_t)size : 1); // of its very size, so that a byte too many is seen
    rewind(file);

    if (size < 0 || !data || fread(data, 1, (size_t)size, file) != (size_t)size) {
        perror(path);
        return 1;
    }

    fclose(file);
    fprintf(stderr, "%s\n", path); // the last one is the culprit
    LLVMFuzzerTestOneInput(data, (size_t)size);
    free(data);
    return 0;
}

/// Counts the files in *given. Returns how many could not be read.
static int give_all(const char *name, int *given) {
    int failed = 0;
    DIR *folder = opendir(name);
    if (!folder) {
        perror(name);
        return 1;
    }

    for (struct dirent *entry; (entry = readdir(folder));) {
        if (entry->d_name[0] == '.') continue;
        failed += give(name, entry->d_name);
        ++*given;
    }

    closedir(folder);
    return failed;
}

int main(int argc, char **argv) {
    int given = 0, failed = 0;
    LLVMFuzzerTestOneInput((const uint8_t *)"", 0);
    for (int i = 1; i < argc; i++) failed += give_all(argv[i], &given);
    fprintf(stderr, "%d files\n", given);
    return failed || !given;
}
