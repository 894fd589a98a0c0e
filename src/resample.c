#include "resample.h"

static void axis_layout(struct ast_axis *axis, int length, struct ast_arena *arena) {
    axis->first = ast_arena_take(arena, (size_t)length, sizeof *axis->first);
    axis->count = ast_arena_take(arena, (size_t)length, sizeof *axis->count);
    axis->at = ast_arena_take(arena, (size_t)length, sizeof *axis->at);
    axis->weight = ast_arena_take(arena, (size_t)length * AST_TAPS, sizeof *axis->weight);
}

void ast_resampler_layout(struct ast_resampler *r, int width, struct ast_arena *arena) {
    r->kernels = ast_kernels();
    axis_layout(&r->columns, width, arena);
    axis_layout(&r->rows, AST_LANES, arena);
    r->line = ast_arena_take(arena, (AST_RESAMPLER_PIXELS + 2 * AST_RESAMPLER_MARGIN) * AST_RESAMPLER_ROWS, sizeof *r->line);
}

void ast_resampler_aim_columns(struct ast_resampler *r, const ast_frame *frame, const ast_box *window, int width, int height,
                               int begin, int count) {
    r->window = *window;
    r->columns.total = width;
    r->columns.begin = begin;
    r->columns.length = count;
    r->kernels->axis(&r->columns, window->x, window->w, frame->width);
    r->rows.total = height;
    r->rows.length = 0; /* none yet */
}

void ast_resampler_aim(struct ast_resampler *r, const ast_frame *frame, const ast_box *window, int width, int height) {
    ast_resampler_aim_columns(r, frame, window, width, height, 0, width);
}

void ast_resampler_rows(struct ast_resampler *r, const ast_frame *frame, int row, int count, float *out, size_t ld) {
    struct ast_axis *rows = &r->rows;
    if (rows->length == 0 || row < rows->begin || row + count > rows->begin + rows->length) {
        const int left = rows->total - row;
        rows->begin = row;
        rows->length = left < AST_LANES ? left : AST_LANES;
        r->kernels->axis(rows, r->window.y, r->window.h, frame->height);
    }
    r->kernels->rows(&r->columns, rows, frame, row - rows->begin, count, r->line, out, ld);
}
