#include "view.h"

#include "maths.h"

/* Columns of the view that are made at a time. */
enum { COLUMNS = 4 * AST_LANES };

void ast_view_layout(struct ast_view *view, const ast_config *cfg, struct ast_arena *arena) {
    const size_t side = (size_t)cfg->view;
    view->side = cfg->view;
    view->object = cfg->view_object;
    if (view->side == 0) return;
    view->pixels = ast_arena_take(arena, side * side, sizeof *view->pixels);
    const int columns = view->side < COLUMNS ? view->side : COLUMNS;
    view->rows = ast_arena_take(arena, (size_t)columns * AST_RESAMPLER_ROWS, sizeof *view->rows);
    ast_resampler_layout(&view->resampler, columns, arena);
}

static int within(float v, int low, int high) {
    return v <= (float)low ? low : v >= (float)high ? high : (int)v;
}

void ast_view_show(struct ast_view *view, const ast_frame *frame, const ast_box *region, const ast_box *object) {
    const float size = ast_sqrtf(object->w * object->h);
    view->image = *frame;
    view->origin_x = view->origin_y = 0.0f;
    view->pixel = 1.0f;
    if (view->side == 0) return;

    /* The region's part inside the frame; at least one pixel. */
    const int left = within(ast_floorf(region->x), 0, frame->width - 1), top = within(ast_floorf(region->y), 0, frame->height - 1);
    const int right = within(ast_ceilf(region->x + region->w), left + 1, frame->width);
    const int bottom = within(ast_ceilf(region->y + region->h), top + 1, frame->height);
    const float longest = (float)(right - left > bottom - top ? right - left : bottom - top);
    view->origin_x = (float)left;
    view->origin_y = (float)top;
    if (size > (float)view->object) view->pixel = size / (float)view->object;
    if (longest > view->pixel * (float)(view->side - 2)) view->pixel = longest / (float)(view->side - 2);

    if (view->pixel <= 1.0f) { /* fine as it is: a part of the frame itself */
        view->image.pixels = frame->pixels + (size_t)top * (size_t)frame->stride + left;
        view->image.width = right - left;
        view->image.height = bottom - top;
        return;
    }
    const int width = within(ast_ceilf((float)(right - left) / view->pixel), 1, view->side);
    const int height = within(ast_ceilf((float)(bottom - top) / view->pixel), 1, view->side);
    const ast_box window = {(float)left, (float)top, (float)width * view->pixel, (float)height * view->pixel};
    for (int begin = 0; begin < width; begin += COLUMNS) {
        const int columns = width - begin < COLUMNS ? width - begin : COLUMNS;
        ast_resampler_aim_columns(&view->resampler, frame, &window, width, height, begin, columns);
        for (int r = 0; r < height; r += AST_RESAMPLER_ROWS) {
            const int rows = height - r < AST_RESAMPLER_ROWS ? height - r : AST_RESAMPLER_ROWS;
            ast_resampler_rows(&view->resampler, frame, r, rows, view->rows, (size_t)columns);
            for (int k = 0; k < rows; k++) {
                uint8_t *out = view->pixels + (size_t)(r + k) * (size_t)view->side + begin;
                const float *row = view->rows + (size_t)k * (size_t)columns;
                for (int c = 0; c < columns; c++) out[c] = (uint8_t)within(row[c] + 0.5f, 0, 255);
            }
        }
    }
    view->image.pixels = view->pixels;
    view->image.width = width;
    view->image.height = height;
    view->image.stride = view->side;
}

ast_box ast_view_box(const struct ast_view *view, const ast_box *box) {
    const float scale = 1.0f / view->pixel;
    const ast_box inside = {(box->x - view->origin_x) * scale, (box->y - view->origin_y) * scale, box->w * scale, box->h * scale};
    return inside;
}
