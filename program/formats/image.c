// Pictures: PNG by libpng, JPEG by libjpeg. Both report errors by a jump: whatever must survive it lives in a struct, not
// in locals.
#include "common/allocator.h"
#include "common/store.h"
#include "formats/formats.h"

#include <png.h>
#include <setjmp.h>
#include <stdio.h> // jpeglib.h needs FILE
#include <string.h>

#include <jpeglib.h>
#include <jerror.h>

// ---- PNG

// ---- reading and writing

typedef struct PngJob {
    jmp_buf jump;
    png_structp png;
    png_infop info;
    SingeAllocator allocator;
    char message[160];
    bool out_of_memory;
    // reading
    const uint8_t *bytes;
    size_t size, at;
    uint8_t *pixels;
    size_t pixel_count;
    int width, height, channels;
    // writing
    uint8_t *out;
    size_t out_size, out_capacity;
    const uint8_t *rgb;
} PngJob;

static void png_fail(png_structp png, png_const_charp message) {
    PngJob *job = png_get_error_ptr(png);
    snprintf(job->message, sizeof job->message, "%s", message);
    longjmp(job->jump, 1);
}

static void png_ignore(png_structp png, png_const_charp message) { (void)png, (void)message; }

// libpng frees blocks without their size, so each block begins with it.
typedef union PngBlock {
    size_t size;
    max_align_t align;
} PngBlock;

static png_voidp png_take(png_structp png, png_alloc_size_t size) {
    PngJob *job = png_get_mem_ptr(png);
    PngBlock *block = size < SIZE_MAX / 2 ? allocator_resize(job->allocator, NULL, 0, size + sizeof *block) : NULL;
    if (!block) {
        job->out_of_memory = true;
        return NULL;
    }
    block->size = size + sizeof *block;
    return block + 1;
}

static void png_supply(png_structp png, png_voidp memory) {
    PngJob *job = png_get_mem_ptr(png);
    PngBlock *block = memory;
    if (block) allocator_resize(job->allocator, block - 1, block[-1].size, 0);
}

// ---- reading

static void png_pull(png_structp png, png_bytep data, size_t length) {
    PngJob *job = png_get_io_ptr(png);
    if (job->size - job->at < length) png_error(png, "the file ends too soon");
    memcpy(data, job->bytes + job->at, length);
    job->at += length;
}

static bool png_decode(PngJob *job) {
    if (setjmp(job->jump)) return false;
    job->png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, job, png_fail, png_ignore, job, png_take, png_supply);
    if (job->png) job->info = png_create_info_struct(job->png);

    if (!job->info) {
        job->out_of_memory = true;
        return false;
    }

    png_structp png = job->png;
    png_set_read_fn(png, job, png_pull);
    png_set_user_limits(png, IMAGE_SIDE_LIMIT, IMAGE_SIDE_LIMIT);
    png_set_chunk_cache_max(png, 1000);
    png_set_chunk_malloc_max(png, 8000000);
    png_read_info(png, job->info);

    // deflate compresses at most 1032 to 1, so a short file that claims a large picture is refused before memory is allocated
    uint64_t raw = (uint64_t)png_get_rowbytes(job->png, job->info) * png_get_image_height(job->png, job->info);
    if (raw / 1032 > job->size) png_error(job->png, "the file is too short for its width and height");

    int colour = png_get_color_type(png, job->info);
    bool clear = (colour & PNG_COLOR_MASK_ALPHA) || png_get_valid(png, job->info, PNG_INFO_tRNS);

    png_set_expand(png);
    png_set_scale_16(png);
    png_set_gray_to_rgb(png);
    job->channels = clear ? 4 : 3;
    job->width = (int)png_get_image_width(png, job->info);
    job->height = (int)png_get_image_height(png, job->info);

    int passes = png_set_interlace_handling(png);
    png_read_update_info(png, job->info);
    size_t row = (size_t)job->width * (size_t)job->channels;
    if (png_get_rowbytes(png, job->info) != row) png_error(png, "unsupported pixel type");
    job->pixel_count = (size_t)job->width * (size_t)job->height;
    job->pixels = store_new(job->allocator, job->pixel_count, (size_t)job->channels);

    if (!job->pixels) {
        job->out_of_memory = true;
        png_error(png, "out of memory");
    }

    // rows of an interlaced picture build on earlier passes
    memset(job->pixels, 0, job->pixel_count * (size_t)job->channels);
    for (int pass = 0; pass < passes; pass++)
        for (int y = 0; y < job->height; y++) png_read_row(png, job->pixels + row * (size_t)y, NULL);
    png_read_end(png, NULL);

    return true;
}

static SingeResult png_read(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator, Image *image,
                            SingeError *error) {
    PngJob job;
    memset(&job, 0, sizeof job);
    job.allocator = allocator;
    job.bytes = bytes;
    job.size = size;

    bool done = png_decode(&job);
    png_destroy_read_struct(&job.png, &job.info, NULL);

    // blends the picture with white, in place, and reduces the array to three bytes a pixel
    if (done && job.channels != 3) {
        const uint8_t *in = job.pixels;
        uint8_t *out = job.pixels;
        for (size_t i = 0; i < job.pixel_count; i++, in += 4, out += 3) {
            unsigned alpha = in[3], white = 255 * (255 - alpha);
            for (int k = 0; k < 3; k++) out[k] = (uint8_t)((in[k] * alpha + white + 127) / 255);
        }

        uint8_t *cut = allocator_resize(allocator, job.pixels, 4 * job.pixel_count, 3 * job.pixel_count);
        done = cut != NULL;
        job.out_of_memory = !done;
        if (done) {
            job.pixels = cut;
            job.channels = 3;
        }
    }

    if (!done) {
        store_free(allocator, job.pixels, job.pixel_count, (size_t)job.channels);

        if (job.out_of_memory) return refuse_memory(error, "png", name);
        return refuse(error, SINGE_ERROR_FORMAT, "png", (int64_t)job.at, "%s: byte %llu: %s", short_name(name),
                      (unsigned long long)job.at, job.message);
    }

    *image = (Image){job.width, job.height, job.pixels, allocator};
    return SINGE_OK;
}

// ---- writing

static void png_push(png_structp png, png_bytep data, size_t length) {
    PngJob *job = png_get_io_ptr(png);
    if (!store_grow(job->allocator, &job->out, &job->out_capacity, job->out_size + length, 1)) {
        job->out_of_memory = true;
        png_error(png, "out of memory");
    }
    memcpy(job->out + job->out_size, data, length);
    job->out_size += length;
}

static void png_flush_nothing(png_structp png) { (void)png; }

static bool png_encode(PngJob *job) {
    if (setjmp(job->jump)) return false;
    job->png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, job, png_fail, png_ignore, job, png_take, png_supply);
    if (job->png) job->info = png_create_info_struct(job->png);

    if (!job->info) {
        job->out_of_memory = true;
        return false;
    }

    png_structp png = job->png;
    png_set_write_fn(png, job, png_push, png_flush_nothing);

    // hundreds of frames are written: a fast level, and one filter that suits smooth pictures
    png_set_compression_level(png, 2);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
    png_set_IHDR(png, job->info, (png_uint_32)job->width, (png_uint_32)job->height, 8, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, job->info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(png, job->info);

    for (int y = 0; y < job->height; y++) png_write_row(png, job->rgb + (size_t)y * (size_t)job->width * 3);
    png_write_end(png, job->info);
    return true;
}

SingeResult png_write(const char *path, int width, int height, const uint8_t *rgb, SingeError *error) {
    if (width < 1 || height < 1 || width > IMAGE_SIDE_LIMIT || height > IMAGE_SIDE_LIMIT)
        return refuse(error, SINGE_ERROR_ARGUMENT, "png", -1, "%s: a picture of %d by %d pixels cannot be written",
                      short_name(path), width, height);

    PngJob job;
    memset(&job, 0, sizeof job);
    job.width = width;
    job.height = height;
    job.rgb = rgb;

    SingeResult result = SINGE_OK;
    if (png_encode(&job)) result = file_write(path, job.out, job.out_size, error);
    else if (job.out_of_memory) result = refuse_memory(error, "png", path);
    else result = refuse(error, SINGE_ERROR_FORMAT, "png", -1, "%s: cannot encode: %s", short_name(path), job.message);
    png_destroy_write_struct(&job.png, &job.info);
    store_free(job.allocator, job.out, job.out_capacity, 1);
    return result;
}

// ---- JPEG. libjpeg has no allocator hook: its own working memory comes from libc, the picture and its row from the hook

typedef struct JpegJob {
    struct jpeg_error_mgr errors; // first, so that libjpeg's pointer to it is a pointer to the job
    struct jpeg_progress_mgr progress;
    jmp_buf jump;
    struct jpeg_decompress_struct jpeg;
    SingeAllocator allocator;
    char message[JMSG_LENGTH_MAX];
    bool out_of_memory, created;
    uint8_t *rgb, *row; // row: one line of CMYK
    size_t pixel_count;
} JpegJob;

static void jpeg_fail(j_common_ptr jpeg) {
    JpegJob *job = (JpegJob *)jpeg->err;
    job->out_of_memory = jpeg->err->msg_code == JERR_OUT_OF_MEMORY;
    jpeg->err->format_message(jpeg, job->message);
    longjmp(job->jump, 1);
}

static void jpeg_fail_with(JpegJob *job, const char *message) {
    snprintf(job->message, sizeof job->message, "%s", message);
    longjmp(job->jump, 1);
}

// Warnings after which pixels are invented count as errors; the others are harmless.
static void jpeg_notice(j_common_ptr jpeg, int level) {
    if (level >= 0) return;

    switch (jpeg->err->msg_code) {
    case JWRN_JPEG_EOF: jpeg_fail_with((JpegJob *)jpeg->err, "the file ends too soon"); break;
    case JWRN_HIT_MARKER:
    case JWRN_HUFF_BAD_CODE:
    case JWRN_MUST_RESYNC:
    case JWRN_ARITH_BAD_CODE:
    case JWRN_BOGUS_PROGRESSION: jpeg_fail(jpeg); break;
    default: break;
    }
}

static void jpeg_say_nothing(j_common_ptr jpeg) { (void)jpeg; }

// Each scan of a progressive file, however short, costs a pass over the picture.
static void jpeg_watch(j_common_ptr jpeg) {
    if (jpeg->is_decompressor && ((j_decompress_ptr)jpeg)->input_scan_number > 100)
        jpeg_fail_with((JpegJob *)jpeg->err, "more than 100 scans");
}

static bool jpeg_decode(JpegJob *job, const uint8_t *bytes, size_t size) {
    struct jpeg_decompress_struct *jpeg = &job->jpeg;
    if (setjmp(job->jump)) return false;

    jpeg_create_decompress(jpeg);
    job->created = true;
    jpeg->progress = &job->progress;
    jpeg_mem_src(jpeg, bytes, (unsigned long)size);
    jpeg_read_header(jpeg, TRUE);

    // a coded block of 64 pixels takes at least a bit; otherwise a few bytes could request gigabytes
    if ((uint64_t)jpeg->image_width * jpeg->image_height / 4096 > size)
        jpeg_fail_with(job, "the file is too short for its width and height");
    bool ink = jpeg->jpeg_color_space == JCS_CMYK || jpeg->jpeg_color_space == JCS_YCCK;
    jpeg->out_color_space = ink ? JCS_CMYK : JCS_RGB;
    jpeg->dct_method = JDCT_ISLOW;

    if (jpeg->image_width > IMAGE_SIDE_LIMIT || jpeg->image_height > IMAGE_SIDE_LIMIT)
        jpeg_fail_with(job, "larger than 16384 by 16384 pixels");
    job->pixel_count = (size_t)jpeg->image_width * jpeg->image_height;
    job->rgb = store_new(job->allocator, job->pixel_count, 3);
    if (job->rgb && ink) job->row = store_new(job->allocator, jpeg->image_width, 4);

    if (!job->rgb || (ink && !job->row)) {
        job->out_of_memory = true;
        jpeg_fail_with(job, "out of memory");
    }

    jpeg_start_decompress(jpeg);
    while (jpeg->output_scanline < jpeg->output_height) {
        uint8_t *target = job->rgb + (size_t)jpeg->output_scanline * jpeg->image_width * 3;
        JSAMPROW row = ink ? job->row : target;
        jpeg_read_scanlines(jpeg, &row, 1);

        // ink to light without a profile: R = (1 - C)(1 - K). Adobe stores 255 minus the ink
        const unsigned flip = jpeg->saw_Adobe_marker ? 0 : 255;
        const uint8_t *p = job->row;
        for (JDIMENSION x = 0; ink && x < jpeg->image_width; x++, p += 4, target += 3)
            for (int k = 0; k < 3; k++) target[k] = (uint8_t)(((p[k] ^ flip) * (p[3] ^ flip) + 127) / 255);
    }

    jpeg_finish_decompress(jpeg);
    return true;
}

static SingeResult jpeg_read(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator,
                             Image *image, SingeError *error) {
    JpegJob job;
    memset(&job, 0, sizeof job);
    job.allocator = allocator;
    job.jpeg.err = jpeg_std_error(&job.errors);
    job.errors.error_exit = jpeg_fail;
    job.errors.emit_message = jpeg_notice;
    job.errors.output_message = jpeg_say_nothing;
    job.progress.progress_monitor = jpeg_watch;

    bool done = jpeg_decode(&job, bytes, size);
    int width = (int)job.jpeg.image_width, height = (int)job.jpeg.image_height;
    store_free(allocator, job.row, job.jpeg.image_width, 4);
    if (job.created) jpeg_destroy_decompress(&job.jpeg);

    if (done) {
        *image = (Image){width, height, job.rgb, allocator};
        return SINGE_OK;
    }

    store_free(allocator, job.rgb, job.pixel_count, 3);
    if (job.out_of_memory) return refuse_memory(error, "jpeg", name);
    return refuse(error, SINGE_ERROR_FORMAT, "jpeg", -1, "%s: %s", short_name(name), job.message);
}

// ---- either

SingeResult image_read(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator, Image *image,
                       SingeError *error) {
    memset(image, 0, sizeof *image);
    if (size == 0) return refuse(error, SINGE_ERROR_FORMAT, "image", -1, "%s: is empty", short_name(name));
    if (size >= 8 && memcmp(bytes, "\x89PNG\r\n\x1a\n", 8) == 0)
        return png_read(name, bytes, size, allocator, image, error);
    if (size >= 3 && memcmp(bytes, "\xff\xd8\xff", 3) == 0)
        return jpeg_read(name, bytes, size, allocator, image, error);
    return refuse(error, SINGE_ERROR_FORMAT, "image", -1, "%s: neither a PNG nor a JPEG picture", short_name(name));
}

// ---- size only

static int be16(const uint8_t *p) { return p[0] << 8 | p[1]; }

static bool head_size(const uint8_t *head, size_t size, int *width, int *height) {
    if (size >= 24 && memcmp(head, "\x89PNG\r\n\x1a\n", 8) == 0) {
        if (head[16] || head[17] || head[20] || head[21]) return false; // larger than the reader accepts
        *width = be16(head + 18);
        *height = be16(head + 22);
        return true;
    }

    // the frame header of a JPEG (ITU T.81, B.2.2) follows segments of stated lengths
    bool jpeg = size >= 3 && memcmp(head, "\xff\xd8\xff", 3) == 0;

    for (size_t at = 2; jpeg && at + 9 < size && head[at] == 0xff;) {
        const uint8_t marker = head[at + 1];
        if (marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc) {
            *height = be16(head + at + 5);
            *width = be16(head + at + 7);
            return true;
        }

        at += marker == 0xff ? 1 : 2 + (size_t)be16(head + at + 2);
    }

    return false;
}

bool image_size(const char *path, int *width, int *height) {
    enum { HEAD = 65536 };
    uint8_t *head = malloc(HEAD);
    *width = *height = 0;
    const bool known = head && head_size(head, file_read_head(path, head, HEAD), width, height);
    free(head);
    return known;
}

void image_free(Image *image) {
    store_free(image->allocator, image->rgb, (size_t)image->width * (size_t)image->height, 3);
    memset(image, 0, sizeof *image);
}

// Luma of Rec. 709 on the encoded values, Y = (2126 R + 7152 G + 722 B) / (10000 * 255): integers up to the last
// division, so that white is exactly 1.
SingeResult image_luminance(const Image *image, SingeAllocator allocator, SingeTexture *picture, SingeError *error) {
    memset(picture, 0, sizeof *picture);
    size_t pixels = (size_t)image->width * (size_t)image->height;
    float *values = store_new(allocator, pixels, sizeof *values);
    if (!values) return refuse(error, SINGE_ERROR_MEMORY, "image", -1, "out of memory for a picture's luminance");

    const uint8_t *p = image->rgb;
    for (size_t i = 0; i < pixels; i++, p += 3)
        values[i] = (float)(2126 * p[0] + 7152 * p[1] + 722 * p[2]) / 2550000.0f;
    *picture = (SingeTexture){image->width, image->height, values};
    return SINGE_OK;
}
