/* A picture in memory: 8 bits a channel, rows without padding, its buffer reused from one frame to the next. */
#ifndef IMAGE_H
#define IMAGE_H

#include <asttrack.h>

#include <stdbool.h>

/* Largest picture that is read or written, pixels (an 8K frame has half as many): a damaged header cannot claim gigabytes. */
#define IMAGE_MAX_PIXELS ((size_t)1 << 26)

typedef struct image {
    uint8_t *pixels;
    size_t capacity;       /* bytes at pixels */
    int32_t width, height; /* 0 x 0: no picture */
    int32_t channels;      /* 1 grey, 3 RGB */
} image;

/* Makes room for a picture of this shape; its pixels are unspecified. A zeroed image is a valid start. False when out of memory or
 * for sides outside 1..AST_MAX_FRAME or more than IMAGE_MAX_PIXELS: the image is then as it was. */
bool image_reserve(image *picture, int32_t width, int32_t height, int32_t channels);
/* Releases the buffer; fine on a zeroed or released image. */
void image_free(image *picture);
/* A grey image as the library wants it; borrows the pixels. */
ast_frame image_frame(const image *grey);

#endif
