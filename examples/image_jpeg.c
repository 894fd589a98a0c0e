#include "image_jpeg.h"

#ifdef AST_WITH_JPEG

#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include <jpeglib.h>

/* Of annotated pictures: thin coloured lines stay clean. */
#define QUALITY 90
/* Scans of a progressive file; encoders write about ten, hostile files thousands to burn time. */
#define MAX_SCANS 64

/* libjpeg reports by callbacks that may not return; this takes them back to the caller. The public part comes first, so that the
 * callbacks find the rest behind it. */
typedef struct failure {
    struct jpeg_error_mgr manager;
    jmp_buf escape;
    char *error;
    size_t error_size;
} failure;

static void on_error(j_common_ptr info) {
    failure *f = (failure *)(void *)info->err;
    char text[JMSG_LENGTH_MAX];
    (*info->err->format_message)(info, text);
    snprintf(f->error, f->error_size, "JPEG: %s", text);
    longjmp(f->escape, 1);
}

/* level < 0 is a warning: data was damaged and libjpeg went on with a guess. */
static void on_message(j_common_ptr info, int level) {
    if (level < 0) {
        on_error(info);
    }
}

static void install(failure *f, char *error, size_t error_size) {
    memset(f, 0, sizeof *f);
    (void)jpeg_std_error(&f->manager);
    f->manager.error_exit = on_error;
    f->manager.emit_message = on_message;
    f->error = error;
    f->error_size = error_size;
}

static void limit_scans(j_common_ptr info) {
    if (((j_decompress_ptr)(void *)info)->input_scan_number > MAX_SCANS) {
        failure *f = (failure *)(void *)info->err;
        snprintf(f->error, f->error_size, "JPEG: more than %d scans", MAX_SCANS);
        longjmp(f->escape, 1);
    }
}

bool image_jpeg_available(void) {
    return true;
}

bool image_jpeg_decode(const uint8_t *data, size_t size, image *grey, char *error, size_t error_size) {
    struct jpeg_decompress_struct info;
    struct jpeg_progress_mgr progress;
    failure f;
    memset(&info, 0, sizeof info);
    memset(&progress, 0, sizeof progress);
    install(&f, error, error_size);
    info.err = &f.manager;
    if (setjmp(f.escape) != 0) {
        jpeg_destroy_decompress(&info);
        return false;
    }
    jpeg_create_decompress(&info);
    progress.progress_monitor = limit_scans;
    info.progress = &progress;
    /* older libjpeg takes a pointer to data that is not const, and does not write there */
    jpeg_mem_src(&info, (unsigned char *)(uintptr_t)data, (unsigned long)size);
    (void)jpeg_read_header(&info, TRUE);
    info.out_color_space = JCS_GRAYSCALE;
    if (info.image_width > AST_MAX_FRAME || info.image_height > AST_MAX_FRAME ||
        (size_t)info.image_width * info.image_height > IMAGE_MAX_PIXELS) {
        snprintf(error, error_size, "%u x %u pixels: outside what can be read", (unsigned)info.image_width,
                 (unsigned)info.image_height);
        jpeg_destroy_decompress(&info);
        return false;
    }
    (void)jpeg_start_decompress(&info);
    if (!image_reserve(grey, (int32_t)info.output_width, (int32_t)info.output_height, 1)) {
        snprintf(error, error_size, "out of memory");
        jpeg_destroy_decompress(&info);
        return false;
    }
    while (info.output_scanline < info.output_height) {
        JSAMPROW row = grey->pixels + (size_t)info.output_scanline * (size_t)info.output_width;
        (void)jpeg_read_scanlines(&info, &row, 1);
    }
    (void)jpeg_finish_decompress(&info);
    jpeg_destroy_decompress(&info);
    return true;
}

bool image_jpeg_encode(FILE *stream, const image *picture, char *error, size_t error_size) {
    struct jpeg_compress_struct info;
    failure f;
    memset(&info, 0, sizeof info);
    install(&f, error, error_size);
    info.err = &f.manager;
    if (setjmp(f.escape) != 0) {
        jpeg_destroy_compress(&info);
        return false;
    }
    jpeg_create_compress(&info);
    jpeg_stdio_dest(&info, stream);
    info.image_width = (JDIMENSION)picture->width;
    info.image_height = (JDIMENSION)picture->height;
    info.input_components = picture->channels;
    info.in_color_space = picture->channels == 3 ? JCS_RGB : JCS_GRAYSCALE;
    jpeg_set_defaults(&info);
    jpeg_set_quality(&info, QUALITY, TRUE);
    if (picture->channels == 3) {
        info.comp_info[0].h_samp_factor = 1; /* full colour resolution: one-pixel lines keep their colour */
        info.comp_info[0].v_samp_factor = 1;
    }
    jpeg_start_compress(&info, TRUE);
    while (info.next_scanline < info.image_height) {
        JSAMPROW row = picture->pixels + (size_t)info.next_scanline * (size_t)picture->width * (size_t)picture->channels;
        (void)jpeg_write_scanlines(&info, &row, 1);
    }
    jpeg_finish_compress(&info);
    jpeg_destroy_compress(&info);
    return true;
}

#else

static bool fail(char *error, size_t error_size) {
    snprintf(error, error_size, "JPEG support was not built in: install libjpeg-dev and rebuild");
    return false;
}

bool image_jpeg_available(void) {
    return false;
}

bool image_jpeg_decode(const uint8_t *data, size_t size, image *grey, char *error, size_t error_size) {
    (void)data;
    (void)size;
    (void)grey;
    return fail(error, error_size);
}

bool image_jpeg_encode(FILE *stream, const image *picture, char *error, size_t error_size) {
    (void)stream;
    (void)picture;
    return fail(error, error_size);
}

#endif
