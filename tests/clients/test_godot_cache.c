// What the node of Godot reads of a cache: frames that are cut, damaged or no files are refused, and none halts the game.
#include "cache.h"

#include "support/test.h"

#include <sys/stat.h>
#include <unistd.h>

static const char header[] =
    "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
enum { HEADER = sizeof header - 1, SIZE = HEADER + 3 * 12 + 13 };

typedef struct Scratch {
    char folder[40], pattern[60], path[60];
    uint8_t bytes[SIZE];
    CacheFrame frame;
    char why[300];
} Scratch;

static void scratch_open(Scratch *s) {
    const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const int32_t triangle[3] = {0, 1, 2};

    *s = (Scratch){.folder = "/tmp/singe-test-XXXXXX"};
    assert_non_null(mkdtemp(s->folder));
    snprintf(s->pattern, sizeof s->pattern, "%s/a.####.ply", s->folder);
    snprintf(s->path, sizeof s->path, "%s/a.0007.ply", s->folder);
    memcpy(s->bytes, header, HEADER);
    memcpy(s->bytes + HEADER, corners, sizeof corners);
    s->bytes[HEADER + sizeof corners] = 3;
    memcpy(s->bytes + HEADER + sizeof corners + 1, triangle, sizeof triangle);
}

static void scratch_close(Scratch *s) {
    cache_free(&s->frame);
    unlink(s->path);
    rmdir(s->folder);
}

/// Writes the first bytes of the frame, and reads it.
static bool read_first(Scratch *s, size_t size) {
    FILE *file = fopen(s->path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(s->bytes, 1, size, file), size);
    fclose(file);
    return cache_read(s->pattern, 7, &s->frame, s->why, sizeof s->why);
}

TEST(damaged_frames_are_refused) {
    Scratch s;
    scratch_open(&s);
    assert_true(read_first(&s, SIZE));
    assert_int_equal(s.frame.triangle_count, 1);
    for (size_t size = 0; size < SIZE; size++) assert_false(read_first(&s, size));
    assert_int_equal(s.frame.triangle_count, 0);

    s.bytes[HEADER + 3 * 12 + 1] = 3; // there is no vertex 3
    assert_false(read_first(&s, SIZE));
    s.bytes[HEADER + 3 * 12 + 1] = 0;
    memcpy(s.bytes + HEADER + 16, &(uint32_t){0x7f800000}, 4);
    assert_false(read_first(&s, SIZE));
    assert_non_null(strstr(s.why, "vertex 1 has a y that is not finite"));
    scratch_close(&s);
}

TEST(what_is_no_file_does_not_halt) {
    Scratch s;
    scratch_open(&s);
    assert_int_equal(mkfifo(s.path, 0600), 0);
    alarm(5);
    assert_false(cache_read(s.pattern, 7, &s.frame, s.why, sizeof s.why));

    alarm(0);
    unlink(s.path);
    assert_false(cache_read(s.pattern, 7, &s.frame, s.why, sizeof s.why));
    assert_false(cache_read("/dev/zero#", 7, &s.frame, s.why, sizeof s.why));
    assert_false(cache_read(s.path, 7, &s.frame, s.why, sizeof s.why)); // without a #
    scratch_close(&s);
}
