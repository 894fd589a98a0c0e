/* A camera as a microcontroller sees one: it puts a picture, some lines at a time, into one of two buffers by itself (here in the
 * timer's interrupt, on a board by DMA), while the program works on the other. When a picture is whole it waits for the program to
 * take it, so that no frame is lost however long a step takes. The pictures are the small scene's. */
#ifndef CAMERA_H
#define CAMERA_H

#include <stdint.h>

#include "asttrack.h"

enum { CAMERA_WIDTH = 160, CAMERA_HEIGHT = 120 };

/* What may be wrong with the sensor from the next picture on. */
enum camera_fault {
    CAMERA_GOOD,
    CAMERA_BLACK,     /* every pixel 0 */
    CAMERA_SATURATED, /* every pixel 255 */
    CAMERA_FROZEN,    /* the picture before, again, while the scene goes on */
    CAMERA_TORN       /* the transfer stops in the middle of a picture */
};

/* Begins to fill a buffer with the scene's frame. */
void camera_start(int32_t scene_frame);
/* The sensor's state for the pictures that begin after the next. */
void camera_break(enum camera_fault fault);
/* Waits for the next picture. The frame stays valid until the next call. Returns the number of its lines, CAMERA_HEIGHT unless it
 * is torn. */
int32_t camera_take(ast_frame *frame);

#endif
