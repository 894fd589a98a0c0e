/* A small scene in whole numbers alone, so that every machine renders the same bytes: a textured thing that drifts and grows in
 * front of a textured ground, with a sensor's noise. */
#ifndef SMALL_SCENE_H
#define SMALL_SCENE_H

#include <stdint.h>

#include "asttrack.h"

/* Row y of a frame, frame 0 first. */
void small_scene_row(uint8_t *row, int32_t frame, int32_t y, int32_t width, int32_t height);
/* Where the thing is in it. */
ast_box small_scene_box(int32_t frame, int32_t width, int32_t height);

#endif
