#include "format_test.h"

#include <dirent.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

TEST_IN_FOLDER("any")
// what a case works on
static SingeError error;

static const SingeAllocator libc_allocator = {0};

static const char *inside(const char *name) {
    static char paths[4][512];
    static int next;
    char *target = paths[next++ % 4];
    snprintf(target, sizeof paths[0], "%s/%s", folder, name);
    return target;
}

static int files_in_folder(void) {
    DIR *directory = opendir(folder);
    int count = 0;
    for (struct dirent *entry; (entry = readdir(directory));) count += entry->d_name[0] != '.';
    closedir(directory);
    return count;
}

static void assert_contents(const char *target, const char *expected) {
    OwnBytes bytes;
    assert_int_equal(file_read(target, libc_allocator, &bytes, NULL), SINGE_OK);
    assert_string_equal((char *)bytes.data, expected);
    assert_int_equal(bytes.size, strlen(expected));
}

TEST(writes_and_reads) {
    const char *target = inside("a.txt");
    assert_int_equal(file_write(target, "hello", 5, NULL), SINGE_OK);
    assert_contents(target, "hello");
    assert_int_equal(file_write(target, "", 0, NULL), SINGE_OK);
    assert_contents(target, "");
    assert_int_equal(file_write(target, "again", 5, NULL), SINGE_OK);
    assert_contents(target, "again");
    assert_int_equal(files_in_folder(), 1);

    // a name without a folder is in the working one
    char before[512];
    assert_non_null(getcwd(before, sizeof before));
    assert_int_equal(chdir(folder), 0);
    assert_int_equal(file_write("b.txt", "b", 1, NULL), SINGE_OK);
    assert_contents("b.txt", "b");
    assert_int_equal(unlink("b.txt"), 0);
    assert_int_equal(chdir(before), 0);
    assert_int_equal(unlink(target), 0);
}

/// As a stranger may do in a folder that all may write to.
TEST(taken_names_are_no_obstacle) {
    char *const target = strdup(inside("c.txt")), name[64];
    for (int i = 0; i < 100; i++) {
        snprintf(name, sizeof name, "c.txt.%ld-%d.tmp", (long)getpid(), i);
        assert_int_equal(symlink("/nowhere", inside(name)), 0);
    }

    assert_int_equal(file_write(target, "hello", 5, NULL), SINGE_OK);
    assert_contents(target, "hello");

    for (int i = 0; i < 100; i++) {
        snprintf(name, sizeof name, "c.txt.%ld-%d.tmp", (long)getpid(), i);
        assert_int_equal(unlink(inside(name)), 0);
    }

    assert_int_equal(unlink(target), 0);
    assert_int_equal(files_in_folder(), 0);
    free(target);
}

TEST(reading_says_why) {
    Bytes bytes;
    assert_int_equal(file_read(inside("missing"), libc_allocator, &bytes, &error), SINGE_ERROR_FILE);
    assert_message(&error, "missing: cannot read: No such file");
    assert_null(bytes.data);

    assert_int_equal(file_read(folder, libc_allocator, &bytes, &error), SINGE_ERROR_FILE);
    assert_message(&error, "directory");
    assert_int_equal(file_read("/dev/null", libc_allocator, &bytes, &error), SINGE_ERROR_FILE);
    assert_message(&error, "not a regular file");
    assert_int_equal(mkfifo(inside("pipe"), 0600), 0);
    assert_int_equal(file_read(inside("pipe"), libc_allocator, &bytes, &error), SINGE_ERROR_FILE);
    unlink(inside("pipe"));

    // a sparse file of 2 GiB and a byte takes no room
    assert_int_equal(file_write(inside("large"), "", 0, &error), SINGE_OK);
    if (truncate(inside("large"), (off_t)2147483649LL) == 0) {
        assert_int_equal(file_read(inside("large"), libc_allocator, &bytes, &error), SINGE_ERROR_LIMIT);
        assert_message(&error, "2048 MiB");
    }
    unlink(inside("large"));
}

TEST(writing_says_why) {
    assert_int_equal(file_write(inside("no/where"), "x", 1, &error), SINGE_ERROR_FILE);
    assert_message(&error, "No such file");
    assert_int_equal(file_write(folder, "x", 1, &error), SINGE_ERROR_FILE);
    assert_message(&error, "directory");
    assert_int_equal(file_write("", "x", 1, &error), SINGE_ERROR_FILE);
    assert_int_equal(file_write("/dev/full", "x", 1, &error), SINGE_ERROR_FILE);
    assert_message(&error, "not a regular file");

    struct stat about;
    assert_int_equal(stat("/dev/full", &about), 0);
    assert_true(S_ISCHR(about.st_mode));

    char longest[6000];
    memset(longest, 'a', sizeof longest);
    longest[sizeof longest - 1] = 0;
    assert_int_equal(file_write(longest, "x", 1, &error), SINGE_ERROR_FILE);
    assert_message(&error, "too long");
    assert_int_equal(file_write("/proc/singe", "x", 1, &error), SINGE_ERROR_FILE);

    // root may write anywhere
    if (geteuid() != 0) {
        assert_int_equal(mkdir(inside("locked"), 0500), 0);
        assert_int_equal(file_write(inside("locked/x"), "x", 1, &error), SINGE_ERROR_FILE);
        assert_message(&error, "denied");
        rmdir(inside("locked"));
    }
    assert_int_equal(files_in_folder(), 0);
}

// The target of a link belongs to somebody else.
TEST(links_are_replaced) {
    struct stat about;
    assert_int_equal(file_write(inside("theirs"), "theirs", 6, NULL), SINGE_OK);

    const char *const targets[] = {"theirs", "nothing", "/dev/null", "."};
    for (int i = 0; i < 4; i++) {
        assert_int_equal(symlink(targets[i], inside("link")), 0);
        assert_int_equal(file_write(inside("link"), "ours", 4, NULL), SINGE_OK);
        assert_int_equal(lstat(inside("link"), &about), 0);
        assert_true(S_ISREG(about.st_mode));
        assert_contents(inside("link"), "ours");
        assert_contents(inside("theirs"), "theirs");
        assert_int_equal(unlink(inside("link")), 0);
    }

    assert_int_equal(unlink(inside("theirs")), 0);
    assert_int_equal(files_in_folder(), 0);
}

TEST(drafts_take_the_place_later) {
    const char *target = inside("film");
    char *first, *second;

    assert_int_equal(file_write(target, "old", 3, &error), SINGE_OK);
    assert_int_equal(file_draft(target, &first, &error), SINGE_OK);
    assert_int_equal(file_draft(target, &second, &error), SINGE_OK);
    assert_string_not_equal(first, second);
    assert_int_equal(file_write(first, "new", 3, &error), SINGE_OK);

    assert_contents(target, "old");
    assert_int_equal(file_publish(first, target, &error), SINGE_OK);
    assert_contents(target, "new");
    file_discard(second);
    file_discard(NULL);

    assert_int_equal(files_in_folder(), 1);
    // one whose file has gone leaves what was there
    assert_int_equal(file_draft(target, &first, &error), SINGE_OK);
    assert_int_equal(unlink(first), 0);
    assert_int_equal(file_publish(first, target, &error), SINGE_ERROR_FILE);
    assert_message(&error, "film: cannot write: No such file");

    assert_contents(target, "new");
    assert_int_equal(unlink(target), 0);
    assert_int_equal(file_draft(inside("no/where"), &first, &error), SINGE_ERROR_FILE);
    assert_null(first);
    assert_int_equal(file_draft(folder, &first, &error), SINGE_ERROR_FILE);
}

// The limit on a file's size makes the write fail in the middle, as a full disk does.
TEST(failed_write_keeps_the_old_file) {
    const char *target = inside("old.txt");
    enum { LARGE = 1 << 20 };
    char *data = calloc(1, LARGE);
    assert_int_equal(file_write(target, "old", 3, &error), SINGE_OK);

    struct rlimit before, small;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    small = before;
    small.rlim_cur = 65536;
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);

    SingeResult result = file_write(target, data, LARGE, &error);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    assert_int_equal(result, SINGE_ERROR_FILE);
    assert_message(&error, "old.txt: cannot write: File too large");
    assert_contents(target, "old");
    assert_int_equal(files_in_folder(), 1);
    free(data);
    unlink(target);
}

TEST(allocation_failure_is_clean) {
    assert_int_equal(file_write(inside("a"), "abc", 3, &error), SINGE_OK);
    TestAllocator counter = {.fail_at = 1, .once = true};
    Bytes bytes;
    assert_int_equal(file_read(inside("a"), test_allocator(&counter), &bytes, &error), SINGE_ERROR_MEMORY);
    assert_int_equal(file_read(inside("a"), test_allocator(&counter), &bytes, &error), SINGE_OK);
    assert_true(counter.bytes > 0);
    bytes_free(&bytes);
    test_allocator_check(&counter);
    unlink(inside("a"));
}
