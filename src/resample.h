/* Resampling of a window of a frame to a grid, with linear interpolation and, where the window is larger than the grid, averaging. */
#ifndef AST_RESAMPLE_H
#define AST_RESAMPLE_H

#include "arena.h"
#include "asttrack.h"

/* Source pixels that one output pixel of an axis may weigh. It bounds time and memory: windows up to about 30 times the grid are
 * averaged completely, larger ones over 30 pixels around each sample. */
enum { AST_TAPS = 32 };

/* The resampling of one axis: output i = sum over j < count[i] of weight[i * AST_TAPS + j] * source[first[i] + j]. */
struct ast_axis {
    int length;
    int32_t *first, *count;
    int32_t *place; /* where source[first[i]] lies in a line that holds only the pixels that some output weighs */
    float *weight;
};

struct ast_resampler {
    struct ast_axis columns, rows;
    float *line; /* source rows, summed for one output row: at most width x AST_TAPS pixels */
};

/* For grids of at most width x height. */
void ast_resampler_layout(struct ast_resampler *r, int width, int height, struct ast_arena *arena);
/* Aims at a window, its sides positive, of a frame with the given size, for a grid of width x height. */
void ast_resampler_aim(struct ast_resampler *r, const ast_frame *frame, const ast_box *window, int width, int height);
/* One row of the grid (as many floats as it has columns, 0 .. 255) from the frame aimed at. */
void ast_resampler_row(struct ast_resampler *r, const ast_frame *frame, int row, float *out);

#endif
