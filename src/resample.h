/* Resampling of a window of a frame to a grid, with linear interpolation and, where the window is larger than the grid,
 * averaging. */
#ifndef AST_RESAMPLE_H
#define AST_RESAMPLE_H

#include "arena.h"
#include "asttrack.h"
#include "kernels.h"

/* Source pixels that one output pixel of an axis may weigh. It bounds time and memory: windows up to about 30 times the grid are
 * averaged completely, larger ones over 30 pixels around each sample. */
enum { AST_TAPS = 32 };

/* Rows of the grid that are made at once, and source pixels of each that are summed at a time: no fewer than the taps, and with few
 * lanes no more, to save memory. With vectors of all lanes a chunk of pixels is summed in one step, and may lie partly beside what
 * is wanted. */
enum {
    AST_RESAMPLER_ROWS = AST_LANES,
    AST_RESAMPLER_PIXELS = AST_LANES < 16 ? AST_TAPS : 128,
    AST_RESAMPLER_CHUNK = 16,
    AST_RESAMPLER_MARGIN = AST_LANES < AST_RESAMPLER_CHUNK ? 0 : AST_RESAMPLER_CHUNK
};

/* The resampling of one axis, of its outputs `begin` .. `begin + length - 1`: output begin + i = sum over j < count[i] of
 * weight[j * length + i] * source[first[i] + j]. */
struct ast_axis {
    int total; /* outputs of the whole axis */
    int begin, length;
    int taps; /* most of count; the weights between are zero */
    int32_t *first, *count;
    float *at; /* where the output's sample lies in the source */
    float *weight;
};

struct ast_resampler {
    const struct ast_kernels *kernels;
    struct ast_axis columns, rows; /* of the rows no more than the lanes at a time */
    ast_box window;
    float *line; /* source rows, summed for AST_RESAMPLER_ROWS output rows, interleaved: AST_RESAMPLER_PIXELS of each, and
                    a margin on both sides */
};

/* For grids of at most `width` columns at a time. */
void ast_resampler_layout(struct ast_resampler *r, int width, struct ast_arena *arena);
/* Aims at a window, its sides positive, of a frame with the given size, for a grid of width x height. */
void ast_resampler_aim(struct ast_resampler *r, const ast_frame *frame, const ast_box *window, int width, int height);
/* The same for `count` of the grid's columns from `begin` on. */
void ast_resampler_aim_columns(struct ast_resampler *r, const ast_frame *frame, const ast_box *window, int width, int height,
                               int begin, int count);
/* count <= AST_RESAMPLER_ROWS rows of the grid (as many floats each as columns are aimed at, 0 .. 255; ld floats apart) from the
 * frame aimed at. */
void ast_resampler_rows(struct ast_resampler *r, const ast_frame *frame, int row, int count, float *out, size_t ld);

#endif
