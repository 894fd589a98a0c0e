/* Drawing on an RGB image: anti-aliased rectangles and text. Coordinates run along pixel edges: pixel i covers i .. i + 1. Whatever
 * lies outside the image is clipped. */
#ifndef CANVAS_H
#define CANVAS_H

#include "image.h"

typedef struct colour {
    uint8_t red, green, blue;
} colour;

/* Makes canvas a width x height RGB picture of one colour. False when out of memory. */
bool canvas_fill(image *canvas, int32_t width, int32_t height, colour c);
/* Makes canvas a width x height RGB picture of the grey image, resampled with a tent filter (bilinear when it grows, averaging when
 * it shrinks). False when out of memory. */
bool canvas_from_grey(image *canvas, int32_t width, int32_t height, const image *grey);
/* Copies an RGB picture into the canvas with its top-left corner at (x, y); all of it must fit. */
void canvas_place(image *canvas, int32_t x, int32_t y, const image *picture);

/* opacity 0..1 */
void canvas_rectangle(image *canvas, float x0, float y0, float x1, float y1, colour c, float opacity);
/* A frame of this line width around the rectangle's edges, half of it on either side. */
void canvas_outline(image *canvas, float x0, float y0, float x1, float y1, float line, colour c, float opacity);
/* Text whose dots are squares of this size; (x, y) is its top-left corner. */
void canvas_text(image *canvas, float x, float y, float dot, const char *text, colour c);
float canvas_text_width(float dot, const char *text);

#endif
