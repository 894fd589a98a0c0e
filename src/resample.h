/* Resampling of a window of a frame to a grid, with linear interpolation and, where the window is larger than the grid, averaging. */
#ifndef AST_RESAMPLE_H
#define AST_RESAMPLE_H

#include "arena.h"
#include "asttrack.h"
#include "kernels.h"

/* Source pixels that one output pixel of an axis may weigh. It bounds time and memory: windows up to about 30 times the grid are
 * averaged completely, larger ones over 30 pixels around each sample. */
enum { AST_TAPS = 32 };

/* Rows of the grid that are made at once, source pixels of each that are summed at a time, and of them in one step of vectors. */
enum { AST_RESAMPLER_ROWS = AST_LANES, AST_RESAMPLER_PIXELS = 128, AST_RESAMPLER_CHUNK = 16 };

/* The resampling of one axis: output i = sum over j < count[i] of weight[j * length + i] * source[first[i] + j]. */
struct ast_axis {
    int length;
    int taps; /* most of count; the weights between are zero */
    int32_t *first, *count;
    float *at; /* where the output's sample lies in the source */
    float *weight;
};

struct ast_resampler {
    const struct ast_kernels *kernels;
    struct ast_axis columns, rows;
    float *line; /* source rows, summed for AST_RESAMPLER_ROWS output rows, interleaved: AST_RESAMPLER_PIXELS of each, and
                    a chunk on both sides */
};

/* For grids of at most width x height. */
void ast_resampler_layout(struct ast_resampler *r, int width, int height, struct ast_arena *arena);
/* Aims at a window, its sides positive, of a frame with the given size, for a grid of width x height. */
void ast_resampler_aim(struct ast_resampler *r, const ast_frame *frame, const ast_box *window, int width, int height);
/* count <= AST_RESAMPLER_ROWS rows of the grid (as many floats each as it has columns, 0 .. 255; ld floats apart) from the frame aimed
 * at. */
void ast_resampler_rows(struct ast_resampler *r, const ast_frame *frame, int row, int count, float *out, size_t ld);

#endif
