// EXR by OpenEXRCore: one part of scan lines, ZIP-compressed, complete in memory before the file is written.
#include "common/store.h"
#include "formats/formats.h"

#ifndef SINGE_EXR

bool exr_available(void) { return false; }

SingeResult exr_write(const char *path, int width, int height, const ExrChannel *channels, int count,
                      const ExrText *texts, SingeError *error) {
    (void)width, (void)height, (void)channels, (void)count, (void)texts;
    return refuse(error, SINGE_ERROR_STATE, "exr", -1, "%s: this singe was built without EXR", short_name(path));
}

#else

#include <openexr.h>
#include <string.h>

typedef struct ExrJob {
    SingeAllocator allocator;
    uint8_t *out;
    size_t size, capacity;
    bool out_of_memory;
} ExrJob;

/// Called with the library's lock held, so it cannot access the job; the error code is all that is kept.
static void exr_hush(exr_const_context_t context, exr_result_t code, const char *message) {
    (void)context, (void)code, (void)message;
}

/// The library also seeks back: to the table of the lines' offsets, at the end.
static int64_t exr_put(exr_const_context_t context, void *data, const void *buffer, uint64_t size, uint64_t offset,
                       exr_stream_error_func_ptr_t fail) {
    ExrJob *job = data;
    size_t end = (size_t)(offset + size);

    if (!store_grow(job->allocator, &job->out, &job->capacity, end, 1)) {
        job->out_of_memory = true;
        fail(context, EXR_ERR_OUT_OF_MEMORY, "out of memory");
        return -1;
    }

    if (end > job->size) {
        if (offset > job->size) memset(job->out + job->size, 0, (size_t)offset - job->size);
        job->size = end;
    }

    memcpy(job->out + offset, buffer, (size_t)size);
    return (int64_t)size;
}

static exr_result_t exr_encode(exr_context_t file, int width, int height, const ExrChannel *channels, int count) {
    exr_encode_pipeline_t encoder = EXR_ENCODE_PIPELINE_INITIALIZER;
    int32_t lines = 0;
    exr_result_t result = exr_get_scanlines_per_chunk(file, 0, &lines);

    for (int y = 0; y < height && !result; y += lines) {
        exr_chunk_info_t chunk;
        result = exr_write_scanline_chunk_info(file, 0, y, &chunk);
        if (!result)
            result =
                y ? exr_encoding_update(file, 0, &chunk, &encoder) : exr_encoding_initialize(file, 0, &chunk, &encoder);
        if (result) break;

        // the encoder lists the channels by name, in its own order
        for (int16_t i = 0; i < encoder.channel_count; i++) {
            exr_coding_channel_info_t *to = &encoder.channels[i];
            for (int k = 0; k < count; k++) {
                if (strcmp(channels[k].name, to->channel_name) != 0) continue;
                size_t stride = sizeof(float) * (size_t)channels[k].stride;
                to->user_data_type = channels[k].kind == EXR_KIND_ID ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
                to->user_bytes_per_element = 4;
                to->user_pixel_stride = (int32_t)stride;
                to->user_line_stride = (int32_t)(stride * (size_t)width);
                to->encode_from_ptr = (const uint8_t *)channels[k].values + stride * (size_t)width * (size_t)y;
            }
        }

        if (y == 0) result = exr_encoding_choose_default_routines(file, 0, &encoder);
        if (!result) result = exr_encoding_run(file, 0, &encoder);
    }

    exr_encoding_destroy(file, &encoder);
    return result;
}

SingeResult exr_write(const char *path, int width, int height, const ExrChannel *channels, int count,
                      const ExrText *texts, SingeError *error) {
    if (width < 1 || height < 1 || width > IMAGE_SIDE_LIMIT || height > IMAGE_SIDE_LIMIT || count < 1)
        return refuse(error, SINGE_ERROR_ARGUMENT, "exr", -1, "%s: %d channels of %d by %d pixels cannot be written",
                      short_name(path), count, width, height);
    static const exr_pixel_type_t types[] = {EXR_PIXEL_HALF, EXR_PIXEL_FLOAT, EXR_PIXEL_UINT};

    ExrJob job = {.out_of_memory = false};
    int part;
    exr_context_initializer_t hooks = EXR_DEFAULT_CONTEXT_INITIALIZER;
    hooks.error_handler_fn = exr_hush;
    hooks.user_data = &job;
    hooks.write_fn = exr_put;

    exr_context_t file = NULL;
    exr_result_t done = exr_start_write(&file, short_name(path), EXR_WRITE_FILE_DIRECTLY, &hooks);
    if (!done) done = exr_add_part(file, NULL, EXR_STORAGE_SCANLINE, &part);
    if (!done) done = exr_initialize_required_attr_simple(file, part, width, height, EXR_COMPRESSION_ZIP);

    for (int i = 0; i < count && !done; i++)
        done = exr_add_channel(file, part, channels[i].name, types[channels[i].kind], EXR_PERCEPTUALLY_LINEAR, 1, 1);
    for (; texts && texts->name && !done; texts++) done = exr_attr_set_string(file, part, texts->name, texts->value);
    if (!done) done = exr_write_header(file);
    if (!done) done = exr_encode(file, width, height, channels, count);

    exr_result_t closed = exr_finish(&file); // writes the table of the lines' offsets
    SingeResult result = SINGE_OK;
    if (job.out_of_memory || done == EXR_ERR_OUT_OF_MEMORY) result = refuse_memory(error, "exr", path);
    else if (done || closed)
        result = refuse(error, SINGE_ERROR_FORMAT, "exr", -1, "%s: cannot encode: %s", short_name(path),
                        exr_get_default_error_message(done ? done : closed));
    else result = file_write(path, job.out, job.size, error);
    store_free(job.allocator, job.out, job.capacity, 1);
    return result;
}

bool exr_available(void) { return true; }

#endif
