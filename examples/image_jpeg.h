/* JPEG by libjpeg; the only file that knows it. Built in where the Makefile finds its headers (AST_WITH_JPEG); without, both
 * functions fail with a text that says so. */
#ifndef IMAGE_JPEG_H
#define IMAGE_JPEG_H

#include "image.h"

#include <stdio.h>

/* Whether this build reads and writes JPEG. */
bool image_jpeg_available(void);
/* Decodes to grey. Whatever libjpeg warns about (a file that ends early, damaged data) is a failure: a tracker is better served by
 * no frame than by a half-grey one. On failure *error holds one line. */
bool image_jpeg_decode(const uint8_t *data, size_t size, image *grey, char *error, size_t error_size);
/* Writes a grey or RGB picture to the stream. On failure *error holds one line. */
bool image_jpeg_encode(FILE *stream, const image *picture, char *error, size_t error_size);

#endif
