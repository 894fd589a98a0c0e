#include "resample.h"

static void axis_layout(struct ast_axis *axis, int length, struct ast_arena *arena) {
    axis->first = ast_arena_take(arena, (size_t)length, sizeof *axis->first);
    axis->count = ast_arena_take(arena, (size_t)length, sizeof *axis->count);
    axis->at = ast_arena_take(arena, (size_t)length, sizeof *axis->at);
    axis->weight = ast_arena_take(arena, (size_t)length * AST_TAPS, sizeof *axis->weight);
}

void ast_resampler_layout(struct ast_resampler *r, int width, int height, struct ast_arena *arena) {
    r->kernels = ast_kernels();
    axis_layout(&r->columns, width, arena);
    axis_layout(&r->rows, height, arena);
    r->line = ast_arena_take(arena, (AST_RESAMPLER_PIXELS + 2 * AST_RESAMPLER_CHUNK) * AST_RESAMPLER_ROWS, sizeof *r->line);
}

void ast_resampler_aim(struct ast_resampler *r, const ast_frame *frame, const ast_box *window, int width, int height) {
    r->columns.length = width;
    r->rows.length = height;
    r->kernels->axis(&r->columns, window->x, window->w, frame->width);
    r->kernels->axis(&r->rows, window->y, window->h, frame->height);
}

void ast_resampler_rows(struct ast_resampler *r, const ast_frame *frame, int row, int count, float *out, size_t ld) {
    r->kernels->rows(&r->columns, &r->rows, frame, row, count, r->line, out, ld);
}
