// JPEG by libjpeg. Like libpng it reports errors by a jump. libjpeg has no allocator hook: its own working memory
// comes from libc, the picture and its row from the hook.
#include "formats/codec.h"
#include "common/store.h"

#include <setjmp.h>
#include <stdio.h> // jpeglib.h needs FILE
#include <string.h>

#include <jpeglib.h>
#include <jerror.h>

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

static void jpeg_allocate(JpegJob *job) {
    struct jpeg_decompress_struct *jpeg = &job->jpeg;
    if (jpeg->image_width > IMAGE_SIDE_LIMIT || jpeg->image_height > IMAGE_SIDE_LIMIT)
        jpeg_fail_with(job, "larger than 16384 by 16384 pixels");
    job->pixel_count = (size_t)jpeg->image_width * jpeg->image_height;
    job->rgb = store_new(job->allocator, job->pixel_count, 3);
    if (job->rgb && jpeg->out_color_space == JCS_CMYK) job->row = store_new(job->allocator, jpeg->image_width, 4);
    if (job->rgb && (job->row || jpeg->out_color_space != JCS_CMYK)) return;
    job->out_of_memory = true;
    jpeg_fail_with(job, "out of memory");
}

// Ink to light without a profile: R = (1 - C)(1 - K). Adobe stores 255 minus the ink.
static void jpeg_from_cmyk(const JpegJob *job, uint8_t *rgb) {
    unsigned flip = job->jpeg.saw_Adobe_marker ? 0 : 255;
    const uint8_t *p = job->row;
    for (JDIMENSION x = 0; x < job->jpeg.image_width; x++, p += 4, rgb += 3)
        for (int k = 0; k < 3; k++) rgb[k] = (uint8_t)(((p[k] ^ flip) * (p[3] ^ flip) + 127) / 255);
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
    jpeg_allocate(job);
    jpeg_start_decompress(jpeg);
    while (jpeg->output_scanline < jpeg->output_height) {
        uint8_t *target = job->rgb + (size_t)jpeg->output_scanline * jpeg->image_width * 3;
        JSAMPROW row = ink ? job->row : target;
        jpeg_read_scanlines(jpeg, &row, 1);
        if (ink) jpeg_from_cmyk(job, target);
    }
    jpeg_finish_decompress(jpeg);
    return true;
}

SingeResult jpeg_read(const char *name, const uint8_t *bytes, size_t size, SingeAllocator allocator, Image *image,
                      SingeError *error) {
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
