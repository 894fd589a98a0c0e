#include "image_read.h"

#include "image_jpeg.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Largest file that is read, bytes: above any picture of IMAGE_MAX_PIXELS at 16 bits a channel. */
#define MAX_FILE ((size_t)1 << 29)

static bool fail(image_reader *reader, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(reader->error, sizeof reader->error, format, arguments);
    va_end(arguments);
    return false;
}

/* ---- PGM and PPM ---- */

typedef struct cursor {
    const uint8_t *at, *end;
} cursor;

static bool is_space(uint8_t byte) {
    return byte == ' ' || (byte >= '\t' && byte <= '\r');
}

static void skip_comment(cursor *c) {
    while (c->at < c->end && *c->at != '\n' && *c->at != '\r') {
        ++c->at;
    }
}

/* Passes white space and comments, which run from '#' to the end of their line. */
static void skip_blank(cursor *c) {
    while (c->at < c->end) {
        if (*c->at == '#') {
            skip_comment(c);
        } else if (is_space(*c->at)) {
            ++c->at;
        } else {
            break;
        }
    }
}

/* A decimal number that ends at white space, at a comment or at the end of the data; false for anything else or above 65535, the
 * largest number that the formats allow anywhere. */
static bool read_number(cursor *c, uint32_t *number) {
    skip_blank(c);
    const uint8_t *start = c->at;
    uint32_t value = 0;
    while (c->at < c->end && *c->at >= '0' && *c->at <= '9') {
        value = value * 10 + (uint32_t)(*c->at - '0');
        if (value > 65535) return false;
        ++c->at;
    }
    *number = value;
    return c->at > start && (c->at == c->end || is_space(*c->at) || *c->at == '#');
}

/* How the samples of one file are stored. */
typedef struct raster {
    uint32_t maximum; /* the sample that means white */
    bool plain;       /* decimal numbers rather than bytes */
    int32_t channels;
} raster;

/* One row of samples, scaled to 0..255. False for a sample that is not a number or above the maximum. */
static bool read_row(cursor *c, const raster *r, uint8_t *row, size_t samples) {
    for (size_t i = 0; i < samples; ++i) {
        uint32_t sample;
        if (r->plain) {
            if (!read_number(c, &sample)) return false;
        } else if (r->maximum > 255) {
            sample = ((uint32_t)c->at[0] << 8) | c->at[1];
            c->at += 2;
        } else {
            sample = *c->at++;
        }
        if (sample > r->maximum) return false;
        row[i] = (uint8_t)(r->maximum == 255 ? sample : (sample * 255 + r->maximum / 2) / r->maximum);
    }
    return true;
}

static bool reserve_row(image_reader *reader, size_t size) {
    if (size > reader->row_capacity) {
        uint8_t *row = malloc(size);
        if (row == NULL) return false;
        free(reader->row);
        reader->row = row;
        reader->row_capacity = size;
    }
    return true;
}

static bool decode_raster(image_reader *reader, cursor *c, const raster *r, image *grey) {
    const size_t width = (size_t)grey->width, samples = width * (size_t)r->channels;
    if (r->channels == 3 && !reserve_row(reader, samples)) return fail(reader, "out of memory");
    for (int32_t y = 0; y < grey->height; ++y) {
        uint8_t *out = grey->pixels + (size_t)y * width;
        if (!read_row(c, r, r->channels == 3 ? reader->row : out, samples)) {
            return fail(reader, "truncated or damaged: no number from 0 to %u for a sample in row %d (from 0)",
                        (unsigned)r->maximum, (int)y);
        }
        if (r->channels == 3) {
            const int code = ast_grey_from_rgb(out, grey->width, reader->row, 3 * grey->width, grey->width, 1);
            if (code != AST_OK) return fail(reader, "%s", ast_strerror(code));
        }
    }
    return true;
}

static bool decode_netpbm(image_reader *reader, const uint8_t *data, size_t size, image *grey) {
    cursor c = {data + 2, data + size};
    const uint8_t kind = data[1];
    raster r = {0, kind == '2' || kind == '3', kind == '3' || kind == '6' ? 3 : 1};
    uint32_t width, height;
    if (!read_number(&c, &width) || !read_number(&c, &height) || !read_number(&c, &r.maximum) || r.maximum < 1) {
        return fail(reader, "malformed P%c header", (char)kind);
    }
    if (width < 1 || height < 1 || (size_t)width > IMAGE_MAX_PIXELS / height) {
        return fail(reader, "%u x %u pixels: outside what can be read", (unsigned)width, (unsigned)height);
    }
    /* exactly one byte of white space parts the header from binary samples; a comment here runs up to it */
    if (c.at < c.end && *c.at == '#') {
        skip_comment(&c);
    }
    if (c.at == c.end) return fail(reader, "truncated: the file ends with its header");
    ++c.at;

    /* checked before any memory is taken: a short file cannot ask for a large buffer. A plain sample is a digit and a space, the
     * last one's space may be missing. */
    const size_t samples = (size_t)width * height * (size_t)r.channels;
    const size_t needed = r.plain ? 2 * samples - 1 : samples * (r.maximum > 255 ? 2 : 1);
    const size_t present = (size_t)(c.end - c.at);
    if (present < needed) {
        return fail(reader, "truncated: %zu bytes of pixels, %u x %u need %s%zu", present, (unsigned)width, (unsigned)height,
                    r.plain ? "at least " : "", needed);
    }
    if (!image_reserve(grey, (int32_t)width, (int32_t)height, 1)) return fail(reader, "out of memory");
    return decode_raster(reader, &c, &r, grey);
}

/* ---- Any kind ---- */

static bool decode_any(image_reader *reader, const uint8_t *data, size_t size, image *grey) {
    if (size == 0) return fail(reader, "the file is empty");
    if (size >= 2 && data[0] == 'P' && (data[1] == '2' || data[1] == '3' || data[1] == '5' || data[1] == '6')) {
        return decode_netpbm(reader, data, size, grey);
    }
    if (size >= 3 && data[0] == 0xff && data[1] == 0xd8 && data[2] == 0xff) {
        return image_jpeg_decode(data, size, grey, reader->error, sizeof reader->error);
    }
    return fail(reader, "not a PGM, PPM or JPEG picture");
}

bool image_decode(image_reader *reader, const uint8_t *data, size_t size, image *grey) {
    if (!decode_any(reader, data, size, grey)) {
        grey->width = 0;
        grey->height = 0;
        return false;
    }
    return true;
}

/* Reads the rest of the stream into reader->file. */
static bool load(image_reader *reader, FILE *stream, size_t *size) {
    size_t length = 0;
    for (;;) {
        if (length == reader->file_capacity) {
            if (length >= MAX_FILE) return fail(reader, "larger than %zu bytes", MAX_FILE);
            const size_t capacity = length == 0 ? (size_t)1 << 16 : 2 * length;
            uint8_t *file = realloc(reader->file, capacity);
            if (file == NULL) return fail(reader, "out of memory");
            reader->file = file;
            reader->file_capacity = capacity;
        }
        errno = 0;
        const size_t got = fread(reader->file + length, 1, reader->file_capacity - length, stream);
        length += got;
        if (ferror(stream)) return fail(reader, "cannot read: %s", strerror(errno));
        if (got == 0) {
            *size = length;
            return true;
        }
    }
}

bool image_read(image_reader *reader, const char *path, image *grey) {
    size_t size = 0;
    grey->width = 0;
    grey->height = 0;
    FILE *stream = fopen(path, "rb");
    if (stream == NULL) return fail(reader, "cannot open: %s", strerror(errno));
    const bool loaded = load(reader, stream, &size);
    (void)fclose(stream);
    return loaded && image_decode(reader, reader->file, size, grey);
}

void image_reader_free(image_reader *reader) {
    free(reader->file);
    free(reader->row);
    memset(reader, 0, sizeof *reader);
}
