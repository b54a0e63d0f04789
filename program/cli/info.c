// singe info: what is in a run's folder. singe clean: removes frames of it.
#include <stdio.h>
#include <stdlib.h>

#include "cli/args.h"
#include "cli/folder.h"
#include "cli/job.h"
#include "cli/lock.h"
#include "cli/text.h"
#include "common/printable.h"
#include "common/store.h"
#include "common/order.h"
#include "formats/formats.h"
#include "scene/values.h"

// ---- the record

/// What a folder's record says.
typedef struct Book {
    JobRecord record;
    char *name;
    int frames, done;
} Book;

static void book_close(Book *book) {
    job_record_close(&book->record);
    free(book->name);
}

static ExitCode book_open(Book *book, Console *console, const char *folder) {
    *book = (Book){0};
    const ExitCode code = job_record_open(&book->record, console, folder);
    if (code) return EXIT_INPUT;
    book->name = text_json_words(book->record.json, "name");
    book->frames = text_json_count(book->record.json, "frames");
    book->done = text_json_count(book->record.json, "frames_done");
    const bool good = book->name && value_names_files(book->name) && book->frames > 0;
    return good ? EXIT_GOOD : job_record_refuse(&book->record, console);
}

/// Prints a member that is a string, as words or as a path.
static void print_words(const char *before, JsonText object, const char *name, bool path) {
    char *text = text_json_words(object, name);
    printf("%s%s", before, !text ? "" : path ? shown_path(text).text : shown(text).text);
    free(text);
}

// ---- info

/// The files of a kind.
typedef struct Kind {
    int *frames;
    size_t count, capacity;
    double bytes, shared;
    bool no_memory;
} Kind;

static void take_file(void *context, int frame, uint64_t size, bool shared) {
    Kind *kind = context;
    kind->bytes += (double)size;
    if (shared) kind->shared += (double)size;
    if (store_grow((SingeAllocator){0}, &kind->frames, &kind->capacity, kind->count + 1, sizeof *kind->frames))
        kind->frames[kind->count++] = frame;
    else kind->no_memory = true;
}

/// "1 to 60, 80, 96" of sorted numbers.
static void print_ranges(const int *frames, size_t count) {
    enum { RANGES_MAX = 12 };
    size_t ranges = 0;
    for (size_t i = 0; i < count; ranges++) {
        size_t end = i;
        while (end + 1 < count && frames[end + 1] == frames[end] + 1) end++;
        if (ranges < RANGES_MAX)
            printf(end > i + 1 ? "%s%d to %d" : end > i ? "%s%d, %d" : "%s%d", i ? ", " : "", frames[i], frames[end]);
        i = end + 1;
    }

    if (ranges > RANGES_MAX) printf(" and %zu more", ranges - RANGES_MAX);
}

const ArgCommand info_command = {
    "info", "DIR", "Prints what a run's folder holds: frames, sizes, checkpoints, and the run that it branches from.",
    .footer = "Exit codes: 0 success, 1 the folder cannot be listed, 2 bad input.", .examples = "singe info out"};

int command_info(int argc, char **argv) {
    const char *path;
    ExitCode code;
    if (!args_read(&info_command, argc, argv, &path, &code)) return code;

    Console console = console_make(false);
    Book book;
    code = book_open(&book, &console, path);
    if (code) {
        book_close(&book);
        return code;
    }

    Folder folder = folder_name(path, book.name);
    SingeError error = {0};
    SingeResult result = SINGE_OK;
    double bytes = 0, shared = 0;
    JsonText at = book.record.json, from;
    print_words("run           ", at, "result", false);
    print_words(", by singe ", at, "version", false);
    print_words("\nscene         ", at, "name", false);
    print_words(", from ", at, "scene_file", true);
    putchar('\n');

    for (int depth = 0; depth < 1000 && text_json_member(at, "from", &from); depth++) {
        printf("%-13s frame %d", depth ? "  itself from" : "branch from", text_json_count(from, "frame"));
        print_words(" of ", from, "folder", true);
        putchar('\n');
        at = from;
    }
    printf("%-13s %d\n", "frames asked", book.frames);
    for (int k = 0; k < FOLDER_COUNT && !result; k++) {
        Kind kind = {0};
        result = folder_each(&folder, k, take_file, &kind, &error);
        if (kind.no_memory) result = error.code = SINGE_ERROR_MEMORY;

        if (!result && kind.count) {
            qsort(kind.frames, kind.count, sizeof *kind.frames, order_by_int);
            printf("%-13s ", folder_kind(k));
            print_ranges(kind.frames, kind.count);
            printf(": %.1f MB\n", 1e-6 * kind.bytes);
        }

        bytes += kind.bytes;
        shared += kind.shared;
        store_free((SingeAllocator){0}, kind.frames, kind.capacity, sizeof *kind.frames);
    }

    if (!result) printf("%-13s %.1f MB of frames", "in all", 1e-6 * bytes);
    if (!result && shared > 0) printf(", %.1f MB of them shared with other folders", 1e-6 * shared);
    if (!result) printf("\n");
    else console_result(&console, &error);
    folder_free(&folder);
    book_close(&book);
    return result ? EXIT_FAILED : EXIT_GOOD;
}

// ---- clean

typedef struct CleanOptions {
    const char *folder;
    int every;
    bool quiet;
} CleanOptions;

static const ArgOption clean_options[] = {
    {"keep-every", 0, "N", "keeps frames N, 2N, 3N, ..., the first and the last", .read = args_int,
     offsetof(CleanOptions, every), 1, JOB_FRAMES_MAX},
    {ARGS_QUIET(CleanOptions)},
};

static bool clean_check(const ArgCommand *command, void *options) {
    return ((CleanOptions *)options)->every ||
           args_complain(command, "--keep-every is required: it says which frames remain");
}

const ArgCommand clean_command = {
    "clean",
    "DIR",
    "Removes frames of a run, and keeps every N-th one. Only files of frames that DIR/run.json lists are removed.",
    ARGS_OPTIONS(clean_options),
    "A run that lacks frames cannot be resumed or branched. Exit codes: 0 success, 1 a file cannot be removed,\n"
    "2 bad input.",
    "singe clean out --keep-every 10",
    .operand_field = offsetof(CleanOptions, folder),
    .check = clean_check};

int command_clean(int argc, char **argv) {
    CleanOptions options = {0};
    ExitCode code;
    if (!args_read(&clean_command, argc, argv, &options, &code)) return code;

    const char *path = options.folder;
    Console console = console_make(options.quiet);
    Book book;
    SingeError error = {0};

    code = book_open(&book, &console, path);
    if (!code && book.done < 1) {
        console_error(&console, "%s/run.json lists no frames: the run is unfinished; complete it with --resume",
                      shown_path(path).text);
        code = EXIT_INPUT;
    }

    if (code) {
        book_close(&book);
        return code;
    }

    Folder folder = folder_name(path, book.name);
    Lock cache = LOCK_NONE, pictures = LOCK_NONE;
    int removed = 0;
    SingeResult result = lock_take(&cache, folder.cache_lock, "frames", false, &console, &error);
    if (!result) result = lock_take(&pictures, folder.pictures_lock, "pictures", false, &console, &error);
    if (!result) result = folder_thin(&folder, options.every, book.done, &removed, &error);
    if (result) console_result(&console, &error);
    else console_note(&console, "removed %d files of %d frames in %s", removed, book.done, folder.path);

    lock_release(&pictures);
    lock_release(&cache);
    folder_free(&folder);
    book_close(&book);

    return result ? EXIT_FAILED : EXIT_GOOD;
}
