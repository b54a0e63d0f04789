// The gas in a file: the same bits back, sparse, and no byte believed unchecked. test_vdb_library.py asks OpenVDB
// itself.

#include "gas_sample.h"
#include "format_test.h"

TEST_IN_FOLDER("a.vdb")

// what a case works on
static SingeError error;

static Bytes written(const Gas *gas, double time) {
    if (vdb_write_gas(path, gas, time, &error)) fail_msg("%s", error.message);
    return take_file(path);
}

static void make(uint32_t nx, uint32_t ny, uint32_t nz, Gas *gas) {
    GasSample sample;
    assert_true(gas_sample_make(&sample, nx, ny, nz));
    if (gas_copy(&sample.gas, (SingeAllocator){0}, gas, &error)) fail_msg("%s", error.message);
    gas_sample_free(&sample);
}

static void assert_same(const SingeGas *a, const SingeGas *b) {
    assert_memory_equal(a->size, b->size, sizeof a->size);
    assert_memory_equal(a->origin, b->origin, sizeof a->origin);
    assert_true(a->cell == b->cell);
    size_t count = (size_t)a->size[0] * a->size[1] * a->size[2];
    assert_memory_equal(a->temperature, b->temperature, count * sizeof(float));
    assert_memory_equal(a->smoke, b->smoke, count * sizeof(float));
    assert_memory_equal(a->flame, b->flame, count * sizeof(float));
    assert_memory_equal(a->velocity, b->velocity, count * sizeof(float[3]));
}

TEST(round_trip_is_bitwise) {
    static const uint32_t sizes[][3] = {{1, 1, 1}, {8, 8, 8}, {37, 21, 60}, {9, 140, 17}, {130, 3, 129}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        Gas gas, read;
        double time = 0;

        make(sizes[i][0], sizes[i][1], sizes[i][2], &gas);
        Bytes bytes = written(&gas, 1 / 24.0 + 7);
        if (vdb_read_gas("a.vdb", bytes.data, bytes.size, (SingeAllocator){0}, &read, &time, &error))
            fail_msg("%s", error.message);
        assert_true(time == 1 / 24.0 + 7);
        assert_same(&gas.view, &read.view);

        Bytes again = written(&read, time);
        assert_int_equal(again.size, bytes.size);
        assert_memory_equal(again.data, bytes.data, bytes.size);
        bytes_free(&again), bytes_free(&bytes);
        gas_free(&gas), gas_free(&read);
    }
}

/// Still air costs nothing but the root.
TEST(empty_is_small) {
    enum { SIDE = 64 };
    GasSample sample;
    Gas gas, read;

    assert_true(gas_sample_make(&sample, SIDE, SIDE, SIDE));
    for (size_t i = 0; i < SIDE * SIDE * SIDE; i++)
        sample.temperature[i] = 300 + (float)(i % 3) * 0.5f, sample.smoke[i] = 1e-9f, sample.flame[i] = 1;
    assert_int_equal(gas_copy(&sample.gas, (SingeAllocator){0}, &gas, NULL), SINGE_OK);
    for (size_t i = 0; i < SIDE * SIDE * SIDE; i++)
        assert_true(gas.temperature[i] == 300 && gas.smoke[i] == 0 && gas.flame[i] == 0 && gas.velocity[i][2] == 0);

    Bytes bytes = written(&gas, 0);
    assert_in_range(bytes.size, 100, 4000);
    assert_int_equal(vdb_read_gas("a.vdb", bytes.data, bytes.size, (SingeAllocator){0}, &read, NULL, NULL), SINGE_OK);
    assert_same(&gas.view, &read.view);
    bytes_free(&bytes), gas_free(&gas), gas_free(&read);

    // one warm cell: one block in each grid
    sample.temperature[SIDE * SIDE * SIDE / 2 + 5] = 310;
    assert_int_equal(gas_copy(&sample.gas, (SingeAllocator){0}, &gas, NULL), SINGE_OK);
    bytes = written(&gas, 0);
    assert_in_range(bytes.size, 512 * 4 * 6, 512 * 4 * 6 + 45000);
    bytes_free(&bytes), gas_free(&gas);
    gas_sample_free(&sample);
}

TEST(bad_gas_is_refused) {
    GasSample sample;
    Gas gas, none = {0};

    assert_true(gas_sample_make(&sample, 4, 5, 6));
    sample.velocity[7][1] = INFINITY;
    assert_int_equal(gas_copy(&sample.gas, (SingeAllocator){0}, &gas, &error), SINGE_ERROR_ARGUMENT);
    sample.velocity[7][1] = 0, sample.gas.size[0] = 5000;
    assert_int_equal(gas_copy(&sample.gas, (SingeAllocator){0}, &gas, &error), SINGE_ERROR_LIMIT);
    sample.gas.size[0] = 4, sample.gas.cell = 0;
    assert_int_equal(gas_copy(&sample.gas, (SingeAllocator){0}, &gas, &error), SINGE_ERROR_LIMIT);
    sample.gas = (SingeGas){0};
    assert_int_equal(gas_copy(&sample.gas, (SingeAllocator){0}, &gas, &error), SINGE_OK); // there is none
    assert_int_equal(gas.view.size[0], 0);
    assert_int_equal(vdb_write_gas(path, &none, 0, &error), SINGE_ERROR_ARGUMENT);

    assert_int_not_equal(access(path, F_OK), 0);
    gas_free(&gas);
    gas_sample_free(&sample);
}

/// Cut off anywhere, and with any byte of the head changed: refused or read, and nothing is leaked.
TEST(bad_bytes_are_refused) {
    Gas gas, read;
    make(12, 9, 20, &gas);

    Bytes bytes = written(&gas, 0.25);
    TestAllocator counter = {0};
    size_t step = 1;
    for (size_t size = 0; size < bytes.size; size += step, step = size < 3000 ? 1 : 977) {
        uint8_t *cut = malloc(size + 1); // of its own, so that a sanitizer sees what is read behind it
        memcpy(cut, bytes.data, size);
        SingeResult result = vdb_read_gas("a.vdb", cut, size, test_allocator(&counter), &read, NULL, &error);
        free(cut);
        if (!result) fail_msg("read whole from %zu of %zu bytes", size, bytes.size);
        assert_int_equal(result, SINGE_ERROR_FORMAT);
        assert_message(&error, "a.vdb");
        assert_null(read.smoke);
    }

    // more metadata than there are: the file's end ends them
    uint8_t few = bytes.data[0x39];
    assert_int_equal(few, 5);
    memset(bytes.data + 0x39, 0xff, 4);
    assert_int_equal(vdb_read_gas("a.vdb", bytes.data, bytes.size, test_allocator(&counter), &read, NULL, &error),
                     SINGE_ERROR_FORMAT);
    assert_message(&error, "metadata");
    memset(bytes.data + 0x39, 0, 4), bytes.data[0x39] = few;

    for (size_t at = 0; at < bytes.size; at += at < 1500 ? 1 : 499) {
        uint8_t before = bytes.data[at];
        bytes.data[at] ^= 0x9d;
        if (!vdb_read_gas("a.vdb", bytes.data, bytes.size, test_allocator(&counter), &read, NULL, &error))
            gas_free(&read);
        bytes.data[at] = before;
    }

    test_allocator_check(&counter);
    bytes_free(&bytes), gas_free(&gas);
}

TEST(no_memory_is_reported) {
    GasSample sample;
    Gas gas, read;

    assert_true(gas_sample_make(&sample, 12, 9, 20));
    OwnBytes bytes = {0};
    for (long fail_at = 1;; fail_at++) {
        TestAllocator counter = {.fail_at = fail_at, .once = true};
        SingeResult result = gas_copy(&sample.gas, test_allocator(&counter), &gas, &error);
        if (!result) result = vdb_write_gas(path, &gas, 0, &error);
        if (!result && !bytes.data) assert_int_equal(file_read(path, (SingeAllocator){0}, &bytes, &error), SINGE_OK);
        if (!result)
            result = vdb_read_gas("a.vdb", bytes.data, bytes.size, test_allocator(&counter), &read, NULL, &error);
        if (!result) gas_free(&read);
        gas_free(&gas);

        test_allocator_check(&counter);
        if (!result) break;

        assert_int_equal(result, SINGE_ERROR_MEMORY);
        assert_in_range(fail_at, 1, 40);
    }

    unlink(path);
    gas_sample_free(&sample);
}
