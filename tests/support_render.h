/* Frames rendered in memory: a textured target on a textured background, with known truth. */
#ifndef SUPPORT_RENDER_H
#define SUPPORT_RENDER_H

#include "asttrack.h"

struct render {
    int width, height;
    float *ground;       /* the background's tones, 0 .. 1 */
    float *target;       /* the target's tones on a lattice */
    uint8_t *pixels;     /* of the frame rendered last */
    double gain, offset; /* of the light: level = 255 (gain tone + offset); 1 and 0 unless set */
};

/* Makes the textures of a seed; ends the program when there is no memory. */
void render_open(struct render *r, int width, int height, uint64_t seed);
void render_close(struct render *r);
/* The frame with the target filling this box, or without a target (NULL). Borrows r->pixels. */
ast_frame render_frame(struct render *r, const ast_box *box);
/* The box of a frame of a smooth closed path about the middle, 100 frames long: its centre strays by up to reach times the frame's
 * side (0.2 in frames of 160 x 120 is at most 2 pixels a frame in x and 3 in y), its scale is between 1 / swell and swell. */
ast_box render_path(const struct render *r, int frame, double w, double h, double reach, double swell);
/* Frames rendered beforehand, two of the path's apart, with a target of w x h: film (frames x height x width bytes) and truth. */
void render_film(uint8_t *film, ast_box *truth, int frames, int width, int height, double w, double h);
/* Distance of two boxes' centres, pixels. */
double box_distance(const ast_box *a, const ast_box *b);

#endif
