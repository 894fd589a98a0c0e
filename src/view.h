/* The view: the part of a frame that the particles can reach, at a resolution that shows the object with a fixed number of pixels.
 * Made once a frame, in fixed memory; features see only it, so their cost depends on neither the frame's size nor the object's. */
#ifndef AST_VIEW_H
#define AST_VIEW_H

#include "arena.h"
#include "asttrack.h"
#include "resample.h"

struct ast_view {
    int side;        /* most pixels in width and height; 0: views show the whole frame as it is */
    int object;      /* pixels that the geometric mean of the object's sides should take at most */
    uint8_t *pixels; /* side x side, when resampled */
    float *rows;     /* AST_RESAMPLER_ROWS of the columns made at a time */
    struct ast_resampler resampler;
    /* The current view: a point at p view pixels from its corner is at origin + p * pixel in the frame. */
    ast_frame image;
    float origin_x, origin_y;
    float pixel; /* frame pixels in a view pixel, >= 1 */
};

void ast_view_layout(struct ast_view *view, const ast_config *cfg, struct ast_arena *arena);
/* Shows the region (frame pixels) of the frame; object: the box whose size sets the resolution. Borrows the frame. */
void ast_view_show(struct ast_view *view, const ast_frame *frame, const ast_box *region, const ast_box *object);
/* A box of the frame in the view's pixels. */
ast_box ast_view_box(const struct ast_view *view, const ast_box *box);

#endif
