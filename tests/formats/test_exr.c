// EXR written here, read back by OpenEXR itself.
#include "format_test.h"

#include <openexr.h>

enum { WIDTH = 37, HEIGHT = 50, COUNT = WIDTH * HEIGHT };

TEST_IN_FOLDER("a.exr")

static void swallow(exr_const_context_t context, exr_result_t code, const char *message) {
    (void)context, (void)code, (void)message;
}

/// Reads one channel, as floats or as numbers, and checks how the file keeps it.
static void read_channel(const char *name, exr_pixel_type_t kept, void *values) {
    exr_context_t file = NULL;
    exr_context_initializer_t hooks = EXR_DEFAULT_CONTEXT_INITIALIZER;
    hooks.error_handler_fn = swallow;
    assert_int_equal(exr_start_read(&file, path, &hooks), EXR_ERR_SUCCESS);

    exr_attr_box2i_t window;
    assert_int_equal(exr_get_data_window(file, 0, &window), EXR_ERR_SUCCESS);
    assert_int_equal(window.max.x - window.min.x + 1, WIDTH);
    assert_int_equal(window.max.y - window.min.y + 1, HEIGHT);
    int32_t lines;
    assert_int_equal(exr_get_scanlines_per_chunk(file, 0, &lines), EXR_ERR_SUCCESS);

    exr_decode_pipeline_t decoder = EXR_DECODE_PIPELINE_INITIALIZER;
    bool found = false;
    for (int y = 0; y < HEIGHT; y += lines) {
        exr_chunk_info_t chunk;
        assert_int_equal(exr_read_scanline_chunk_info(file, 0, y, &chunk), EXR_ERR_SUCCESS);
        if (y == 0) assert_int_equal(exr_decoding_initialize(file, 0, &chunk, &decoder), EXR_ERR_SUCCESS);
        else assert_int_equal(exr_decoding_update(file, 0, &chunk, &decoder), EXR_ERR_SUCCESS);

        for (int i = 0; i < decoder.channel_count; i++) {
            exr_coding_channel_info_t *channel = &decoder.channels[i];
            channel->decode_to_ptr = NULL;
            if (strcmp(channel->channel_name, name) != 0) continue;
            found = true;
            assert_int_equal(channel->data_type, kept);
            channel->user_data_type = kept == EXR_PIXEL_UINT ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
            channel->user_bytes_per_element = 4, channel->user_pixel_stride = 4, channel->user_line_stride = 4 * WIDTH;
            channel->decode_to_ptr = (uint8_t *)values + 4 * WIDTH * (size_t)y;
        }

        if (y == 0) assert_int_equal(exr_decoding_choose_default_routines(file, 0, &decoder), EXR_ERR_SUCCESS);
        assert_int_equal(exr_decoding_run(file, 0, &decoder), EXR_ERR_SUCCESS);
    }

    assert_true(found);
    exr_decoding_destroy(file, &decoder);
    exr_finish(&file);
}

TEST(layers_read_back) {
    static float colour[COUNT][3], depth[COUNT], got[COUNT];
    static uint32_t id[COUNT], got_id[COUNT];
    for (int i = 0; i < COUNT; i++) {
        for (int c = 0; c < 3; c++) colour[i][c] = 0.37f * (float)(i % 91) + 100 * (float)c;
        depth[i] = i % 7 ? 1 / (1 + (float)i) : INFINITY;
        id[i] = (uint32_t)i * 2654435761u;
    }

    const ExrChannel channels[] = {{"R", EXR_KIND_HALF, &colour[0][0], 3},
                                   {"G", EXR_KIND_HALF, &colour[0][1], 3},
                                   {"B", EXR_KIND_HALF, &colour[0][2], 3},
                                   {"Z", EXR_KIND_FLOAT, depth, 1},
                                   {"id.piece", EXR_KIND_ID, id, 1}};
    assert_int_equal(exr_write(path, WIDTH, HEIGHT, channels, 5, NULL, NULL), SINGE_OK);

    const char *const names[3] = {"R", "G", "B"};
    for (int c = 0; c < 3; c++) {
        read_channel(names[c], EXR_PIXEL_HALF, got);
        for (int i = 0; i < COUNT; i++) // a half has 11 bits
            assert_true(fabsf(got[i] - colour[i][c]) <= colour[i][c] / 2048);
    }

    read_channel("Z", EXR_PIXEL_FLOAT, got);
    assert_memory_equal(got, depth, sizeof depth);
    read_channel("id.piece", EXR_PIXEL_UINT, got_id);
    assert_memory_equal(got_id, id, sizeof id);
    unlink(path);
}

TEST(bad_layers_are_refused) {
    static float values[COUNT];
    const ExrChannel twice[] = {{"R", EXR_KIND_HALF, values, 1}, {"R", EXR_KIND_HALF, values, 1}};
    SingeError error = {0};

    assert_int_equal(exr_write(path, 0, 5, twice, 1, NULL, &error), SINGE_ERROR_ARGUMENT);
    assert_int_equal(exr_write(path, 5, 1 << 20, twice, 1, NULL, &error), SINGE_ERROR_ARGUMENT);
    assert_int_equal(exr_write(path, 5, 5, twice, 0, NULL, &error), SINGE_ERROR_ARGUMENT);
    assert_int_equal(exr_write(path, WIDTH, HEIGHT, twice, 2, NULL, &error), SINGE_ERROR_FORMAT);
    assert_non_null(strstr(error.message, "cannot encode"));

    char nowhere[600];
    snprintf(nowhere, sizeof nowhere, "%s/none/a.exr", folder);
    assert_int_equal(exr_write(nowhere, WIDTH, HEIGHT, twice, 1, NULL, &error), SINGE_ERROR_FILE);
    assert_int_equal(exr_write(nowhere, WIDTH, HEIGHT, twice, 1, NULL, NULL), SINGE_ERROR_FILE);
}
