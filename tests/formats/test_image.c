#include "format_test.h"

#include <jpeglib.h>
#include <png.h>

TEST_IN_FOLDER("a.png")

// what a case works on
static Image image;
static SingeError error;

static SingeResult read_copy(const uint8_t *data, size_t size, Image *made, SingeError *why) {
    uint8_t *copy = calloc(size ? size : 1, 1);
    memcpy(copy, data, size);
    SingeResult result = image_read("a.png", copy, size, (SingeAllocator){0}, made, why);
    free(copy);
    return result;
}

// ---- pictures made here

typedef struct Encoded {
    uint8_t bytes[1 << 16];
    size_t size;
} Encoded;

static void encoded_push(png_structp png, png_bytep data, size_t length) {
    Encoded *encoded = png_get_io_ptr(png);
    assert_true(encoded->size + length <= sizeof encoded->bytes);
    memcpy(encoded->bytes + encoded->size, data, length);
    encoded->size += length;
}

static void encoded_flush(png_structp png) { (void)png; }

typedef struct PngKind {
    int width, height, depth, colour, interlace;
    int transparent; // 0, or a tRNS chunk
} PngKind;

static void encode_png(Encoded *encoded, PngKind kind, const uint8_t *rows, size_t row_bytes) {
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    encoded->size = 0;
    png_set_write_fn(png, encoded, encoded_push, encoded_flush);
    png_set_IHDR(png, info, (png_uint_32)kind.width, (png_uint_32)kind.height, kind.depth, kind.colour, kind.interlace,
                 0, 0);

    static const png_color palette[] = {{10, 20, 30}, {40, 50, 60}, {200, 100, 0}};
    static const png_byte alpha[] = {255, 0, 51};

    if (kind.colour == PNG_COLOR_TYPE_PALETTE) png_set_PLTE(png, info, palette, 3);
    if (kind.transparent && kind.colour == PNG_COLOR_TYPE_PALETTE) png_set_tRNS(png, info, alpha, 3, NULL);
    if (kind.transparent && kind.colour == PNG_COLOR_TYPE_GRAY)
        png_set_tRNS(png, info, NULL, 0, &(png_color_16){.gray = 7});
    png_write_info(png, info);

    png_bytep pointers[64];
    for (int y = 0; y < kind.height; y++) pointers[y] = (png_bytep)(rows + row_bytes * (size_t)y);
    png_write_image(png, pointers);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
}

static void expect_pixels(const Encoded *encoded, int width, int height, const uint8_t *rgb) {
    if (read_copy(encoded->bytes, encoded->size, &image, &error)) fail_msg("%s", error.message);
    assert_int_equal(image.width, width);
    assert_int_equal(image.height, height);
    assert_memory_equal(image.rgb, rgb, (size_t)width * (size_t)height * 3);
    image_free(&image);
    assert_null(image.rgb);
}

TEST(reads_every_kind_of_png) {
    static Encoded encoded;
    static const uint8_t rgb[] = {1, 2, 3, 4, 5, 6, 250, 251, 252, 0, 0, 255};
    encode_png(&encoded, (PngKind){2, 2, 8, PNG_COLOR_TYPE_RGB, 0, 0}, rgb, 6);
    expect_pixels(&encoded, 2, 2, rgb);

    static const uint8_t rgba[] = {100, 0, 255, 255, 100, 0, 255, 0, 100, 0, 255, 51, 0, 0, 0, 128};
    static const uint8_t flat[] = {100, 0, 255, 255, 255, 255, 224, 204, 255, 127, 127, 127};
    encode_png(&encoded, (PngKind){2, 2, 8, PNG_COLOR_TYPE_RGBA, 0, 0}, rgba, 8);
    expect_pixels(&encoded, 2, 2, flat);

    static const uint8_t grey[] = {0, 7, 255};
    static const uint8_t grey_rgb[] = {0, 0, 0, 7, 7, 7, 255, 255, 255},
                         keyed[] = {0, 0, 0, 255, 255, 255, 255, 255, 255};
    encode_png(&encoded, (PngKind){3, 1, 8, PNG_COLOR_TYPE_GRAY, 0, 0}, grey, 3);
    expect_pixels(&encoded, 3, 1, grey_rgb);
    encode_png(&encoded, (PngKind){3, 1, 8, PNG_COLOR_TYPE_GRAY, 0, 1}, grey, 3);
    expect_pixels(&encoded, 3, 1, keyed);

    static const uint8_t grey_alpha[] = {0, 255, 0, 0};
    static const uint8_t grey_flat[] = {0, 0, 0, 255, 255, 255};
    encode_png(&encoded, (PngKind){2, 1, 8, PNG_COLOR_TYPE_GRAY_ALPHA, 0, 0}, grey_alpha, 4);
    expect_pixels(&encoded, 2, 1, grey_flat);

    static const uint8_t bits[] = {0xa0}; // 1 0 1
    static const uint8_t bits_rgb[] = {255, 255, 255, 0, 0, 0, 255, 255, 255};
    encode_png(&encoded, (PngKind){3, 1, 1, PNG_COLOR_TYPE_GRAY, 0, 0}, bits, 1);
    expect_pixels(&encoded, 3, 1, bits_rgb);

    static const uint8_t deep[] = {0xff, 0xff, 0x80, 0x80, 0x00, 0x00};
    static const uint8_t deep_rgb[] = {255, 128, 0};
    encode_png(&encoded, (PngKind){1, 1, 16, PNG_COLOR_TYPE_RGB, 0, 0}, deep, 6);
    expect_pixels(&encoded, 1, 1, deep_rgb);

    static const uint8_t indices[] = {0, 1, 2};
    static const uint8_t colours[] = {10, 20, 30, 40, 50, 60, 200, 100, 0},
                         over_white[] = {10, 20, 30, 255, 255, 255, 244, 224, 204};

    encode_png(&encoded, (PngKind){3, 1, 8, PNG_COLOR_TYPE_PALETTE, 0, 0}, indices, 3);
    expect_pixels(&encoded, 3, 1, colours);
    encode_png(&encoded, (PngKind){3, 1, 8, PNG_COLOR_TYPE_PALETTE, 0, 1}, indices, 3);
    expect_pixels(&encoded, 3, 1, over_white);

    uint8_t ramp[20 * 20 * 3];
    for (size_t i = 0; i < sizeof ramp; i++) ramp[i] = (uint8_t)(i * 7);
    encode_png(&encoded, (PngKind){20, 20, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_ADAM7, 0}, ramp, 60);
    expect_pixels(&encoded, 20, 20, ramp);
}

TEST(png_write_reads_back) {
    enum { WIDTH = 33, HEIGHT = 17 };
    uint8_t rgb[WIDTH * HEIGHT * 3];
    for (size_t i = 0; i < sizeof rgb; i++) rgb[i] = (uint8_t)(i * i >> 3);
    if (png_write(path, WIDTH, HEIGHT, rgb, &error)) fail_msg("%s", error.message);

    OwnBytes bytes = take_file(path);
    assert_int_equal(read_copy(bytes.data, bytes.size, &image, &error), SINGE_OK);
    assert_int_equal(image.width, WIDTH);
    assert_int_equal(image.height, HEIGHT);
    assert_memory_equal(image.rgb, rgb, sizeof rgb);

    image_free(&image);
    for (size_t size = 0; size < bytes.size; size++) {
        if (read_copy(bytes.data, size, &image, &error) == SINGE_OK) fail_msg("cut to %d bytes", (int)size);
        assert_null(image.rgb);
        assert_true(error.message[0] != 0);
    }

    assert_int_equal(png_write(path, 0, 4, rgb, &error), SINGE_ERROR_ARGUMENT);
    assert_int_equal(png_write(path, 4, 20000, rgb, &error), SINGE_ERROR_ARGUMENT);
    assert_int_equal(png_write("/proc/nowhere/a.png", 4, 4, rgb, &error), SINGE_ERROR_FILE);
}

// ---- JPEG

static void encode_jpeg(Encoded *encoded, int width, int height, int components, J_COLOR_SPACE space,
                        const uint8_t *rows, bool progressive) {
    struct jpeg_compress_struct jpeg;
    struct jpeg_error_mgr errors;
    unsigned char *out = NULL;
    unsigned long size = 0;

    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    jpeg_mem_dest(&jpeg, &out, &size);
    jpeg.image_width = (JDIMENSION)width, jpeg.image_height = (JDIMENSION)height;
    jpeg.input_components = components, jpeg.in_color_space = space;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, 100, TRUE);
    if (progressive) jpeg_simple_progression(&jpeg);

    jpeg_start_compress(&jpeg, TRUE);
    while (jpeg.next_scanline < jpeg.image_height) {
        JSAMPROW row = (JSAMPROW)(rows + (size_t)jpeg.next_scanline * (size_t)(width * components));
        jpeg_write_scanlines(&jpeg, &row, 1);
    }

    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    assert_true(size <= sizeof encoded->bytes);
    memcpy(encoded->bytes, out, size);
    encoded->size = size;
    free(out);
}

TEST(reads_jpeg) {
    static Encoded encoded;
    enum { WIDTH = 24, HEIGHT = 16 };
    uint8_t rgb[WIDTH * HEIGHT * 3];
    for (int i = 0; i < WIDTH * HEIGHT; i++) rgb[3 * i] = 200, rgb[3 * i + 1] = 100, rgb[3 * i + 2] = 50;

    for (int progressive = 0; progressive < 2; progressive++) {
        encode_jpeg(&encoded, WIDTH, HEIGHT, 3, JCS_RGB, rgb, progressive);
        if (read_copy(encoded.bytes, encoded.size, &image, &error)) fail_msg("%s", error.message);
        assert_int_equal(image.width, WIDTH);
        assert_int_equal(image.height, HEIGHT);
        for (size_t i = 0; i < sizeof rgb; i++) assert_in_range(image.rgb[i] + 3, rgb[i], rgb[i] + 6);
        image_free(&image);
        for (size_t size = 0; size < encoded.size; size++)
            if (read_copy(encoded.bytes, size, &image, &error) == SINGE_OK) fail_msg("cut to %d bytes", (int)size);
    }
}

TEST(reads_grey_and_ink) {
    static Encoded encoded;
    uint8_t grey[8 * 8], ink[8 * 8 * 4];
    memset(grey, 77, sizeof grey);
    encode_jpeg(&encoded, 8, 8, 1, JCS_GRAYSCALE, grey, false);
    assert_int_equal(read_copy(encoded.bytes, encoded.size, &image, NULL), SINGE_OK);
    for (int i = 0; i < 8 * 8 * 3; i++) assert_in_range(image.rgb[i], 75, 79);
    image_free(&image);

    // libjpeg writes an Adobe marker, under which 255 is no ink: light = C K / 255
    for (int i = 0; i < 64; i++) ink[4 * i] = 255, ink[4 * i + 1] = 128, ink[4 * i + 2] = 0, ink[4 * i + 3] = 200;
    encode_jpeg(&encoded, 8, 8, 4, JCS_CMYK, ink, false);
    assert_int_equal(read_copy(encoded.bytes, encoded.size, &image, NULL), SINGE_OK);
    for (int i = 0; i < 64; i++) {
        assert_in_range(image.rgb[3 * i], 197, 203);
        assert_in_range(image.rgb[3 * i + 1], 97, 103);
        assert_in_range(image.rgb[3 * i + 2], 0, 3);
    }
    image_free(&image);
}

// ---- what is no picture, or too large

static void put_big(uint8_t *p, uint32_t value) {
    p[0] = (uint8_t)(value >> 24), p[1] = (uint8_t)(value >> 16), p[2] = (uint8_t)(value >> 8), p[3] = (uint8_t)value;
}

static uint32_t crc_of(const uint8_t *p, size_t size) {
    uint32_t crc = 0xffffffff;
    for (size_t i = 0; i < size; i++) {
        crc ^= p[i];
        for (int k = 0; k < 8; k++) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
    }
    return ~crc;
}

// A picture of 2 by 2 pixels whose header claims more.
static void claim_png(Encoded *encoded, uint32_t width, uint32_t height) {
    static const uint8_t rgb[12] = {0};
    encode_png(encoded, (PngKind){2, 2, 8, PNG_COLOR_TYPE_RGB, 0, 0}, rgb, 6);
    put_big(encoded->bytes + 16, width);
    put_big(encoded->bytes + 20, height);
    put_big(encoded->bytes + 29, crc_of(encoded->bytes + 12, 17));
}

TEST(files_that_are_not_pictures_are_refused) {
    static Encoded encoded;
    assert_int_equal(read_copy((const uint8_t *)"", 0, &image, &error), SINGE_ERROR_FORMAT);
    assert_message(&error, "empty");
    assert_int_equal(read_copy((const uint8_t *)"GIF89a..", 8, &image, &error), SINGE_ERROR_FORMAT);
    assert_message(&error, "neither a PNG nor a JPEG");
    assert_int_equal(read_copy((const uint8_t *)"\xff\xd8\xff", 3, &image, &error), SINGE_ERROR_FORMAT);
    assert_int_equal(read_copy((const uint8_t *)"\x89PNG\r\n\x1a\n", 8, &image, &error), SINGE_ERROR_FORMAT);

    TestAllocator counter = {0};
    static const uint32_t claims[][2] = {{16384, 16384}, {16385, 1}, {1, 0x7fffffff}, {0, 2}, {100000, 100000}};
    for (size_t i = 0; i < sizeof claims / sizeof *claims; i++) {
        claim_png(&encoded, claims[i][0], claims[i][1]);
        assert_int_equal(image_read("a.png", encoded.bytes, encoded.size, test_allocator(&counter), &image, &error),
                         SINGE_ERROR_FORMAT);
        assert_true(counter.largest < 100000);
    }

    static const uint8_t grey[64] = {0};
    encode_jpeg(&encoded, 8, 8, 1, JCS_GRAYSCALE, grey, false);
    for (size_t i = 0; i + 8 < encoded.size; i++)
        if (encoded.bytes[i] == 0xff && encoded.bytes[i + 1] == 0xc0) memset(encoded.bytes + i + 5, 0x3f, 4);
    assert_int_equal(image_read("a.jpg", encoded.bytes, encoded.size, test_allocator(&counter), &image, &error),
                     SINGE_ERROR_FORMAT);
    assert_message(&error, "too short for its width");
    assert_true(counter.largest < 100000);
    test_allocator_check(&counter);

    // damage in the data is found by its checksum
    static const uint8_t rgb[12] = {0};
    encode_png(&encoded, (PngKind){2, 2, 8, PNG_COLOR_TYPE_RGB, 0, 0}, rgb, 6);
    encoded.bytes[44] ^= 1;
    assert_int_equal(read_copy(encoded.bytes, encoded.size, &image, &error), SINGE_ERROR_FORMAT);
}

static void expect_size(const char *file, const void *bytes, size_t size, bool known, int width, int height) {
    int w = -1, h = -1;
    assert_int_equal(file_write(file, bytes, size, NULL), SINGE_OK);
    assert_int_equal(image_size(file, &w, &h), known);
    if (known) assert_true(w == width && h == height);
    else assert_true(w >= 0 && h >= 0);
    unlink(file);
}

/// From a file's first bytes, without reading it; each of its beginnings is handled.
TEST(a_size_is_known_beforehand) {
    char file[512];
    static const uint8_t rgb[3 * 48] = {0};
    static Encoded encoded;
    int w, h;

    snprintf(file, sizeof file, "%s/image", folder);
    assert_false(image_size(file, &w, &h));
    assert_false(image_size("/", &w, &h));

    for (int progressive = 0; progressive < 2; progressive++) {
        encode_jpeg(&encoded, 8, 6, 3, JCS_RGB, rgb, progressive);
        expect_size(file, encoded.bytes, encoded.size, true, 8, 6);
        for (size_t cut = 0; cut < 20; cut++) expect_size(file, encoded.bytes, cut, false, 0, 0);
    }

    claim_png(&encoded, 16000, 12000);
    expect_size(file, encoded.bytes, encoded.size, true, 16000, 12000);
    expect_size(file, encoded.bytes, 23, false, 0, 0);
    claim_png(&encoded, 1u << 20, 1);
    expect_size(file, encoded.bytes, encoded.size, false, 0, 0);
    expect_size(file, "no picture, but some text that goes on", 38, false, 0, 0);
}

TEST(luminance_is_exact_at_the_ends) {
    uint8_t rgb[] = {0, 0, 0, 255, 255, 255, 255, 0, 0, 0, 255, 0, 0, 0, 255, 51, 51, 51};
    Image ends = {.width = 3, .height = 2, .rgb = rgb};
    SingeTexture picture;
    TestAllocator counter = {0};
    assert_int_equal(image_luminance(&ends, test_allocator(&counter), &picture, &error), SINGE_OK);
    assert_int_equal(picture.width, 3);
    assert_int_equal(picture.height, 2);

    static const float expected[] = {0, 1, 0.2126f, 0.7152f, 0.0722f, 0.2f};
    for (int i = 0; i < 6; i++) assert_float_equal(picture.values[i], expected[i], 1e-7f);
    assert_true(picture.values[0] == 0 && picture.values[1] == 1);
    test_allocator(&counter).resize(&counter, (void *)picture.values, 6 * sizeof(float), 0);
    test_allocator_check(&counter);

    TestAllocator failing = {.fail_at = 1, .once = true};
    assert_int_equal(image_luminance(&ends, test_allocator(&failing), &picture, &error), SINGE_ERROR_MEMORY);
}

TEST(allocation_failure_is_clean) {
    static Encoded encoded[2];
    static const uint8_t rgba[16] = {1, 2, 3, 4}, ink[8 * 8 * 4] = {0};
    encode_png(&encoded[0], (PngKind){2, 2, 8, PNG_COLOR_TYPE_RGBA, PNG_INTERLACE_ADAM7, 0}, rgba, 8);
    encode_jpeg(&encoded[1], 8, 8, 4, JCS_CMYK, ink, false);
    for (int i = 0; i < 2; i++)
        test_allocations_fail(2, image_read("a", encoded[i].bytes, encoded[i].size, allocator, &image, &error),
                              image_free(&image));
}
