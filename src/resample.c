#include "resample.h"

#include "maths.h"

static void axis_layout(struct ast_axis *axis, int length, struct ast_arena *arena) {
    axis->first = ast_arena_take(arena, (size_t)length, sizeof *axis->first);
    axis->count = ast_arena_take(arena, (size_t)length, sizeof *axis->count);
    axis->place = ast_arena_take(arena, (size_t)length, sizeof *axis->place);
    axis->weight = ast_arena_take(arena, (size_t)length * AST_TAPS, sizeof *axis->weight);
}

void ast_resampler_layout(struct ast_resampler *r, int width, int height, struct ast_arena *arena) {
    axis_layout(&r->columns, width, arena);
    axis_layout(&r->rows, height, arena);
    r->line = ast_arena_take(arena, (size_t)width * AST_TAPS, sizeof *r->line);
}

/* Integral of the triangle max(0, 1 - |t|) from -infinity to t. */
static float triangle_integral(float t) {
    if (t <= -1.0f) return 0.0f;
    if (t >= 1.0f) return 1.0f;
    return t < 0.0f ? 0.5f * (1.0f + t) * (1.0f + t) : 1.0f - 0.5f * (1.0f - t) * (1.0f - t);
}

/* Weights of an axis: samples at start + (i + 1/2) step - 1/2 (pixel centres at integers), linear interpolation, averaged over a
 * box of width sqrt(step^2 - 1) where the window is larger than the patch. That width gives the filter the variance of a box of one
 * step; it starts at zero, so that the patch changes smoothly with the scale. Source indices are clamped to the frame. */
static void axis_weights(struct ast_axis *axis, float start, float extent, int source_length) {
    const float step = extent / (float)axis->length;
    const float limit = (float)(AST_TAPS - 3);
    float blur = step > 1.0f ? ast_sqrtf(step * step - 1.0f) : 0.0f;
    if (blur > limit) blur = limit;
    const float half = 0.5f * blur;
    const int averaged = blur > 1e-2f; /* below, the quotient of differences would be rounding noise */

    for (int i = 0; i < axis->length; i++) {
        const float at = start + ((float)i + 0.5f) * step - 0.5f;
        const int low = (int)ast_floorf(at - half), high = (int)ast_floorf(at + half) + 1;
        const int last = source_length - 1;
        const int first = low < 0 ? 0 : low > last ? last : low;
        float *weight = axis->weight + (size_t)i * AST_TAPS;
        int count = 1;

        weight[0] = 0.0f;
        for (int s = low; s <= high; s++) {
            const float t = (float)s - at;
            const float w =
                averaged ? (triangle_integral(t + half) - triangle_integral(t - half)) / blur : (t < 0.0f ? 1.0f + t : 1.0f - t);
            const int inside = s < 0 ? 0 : s > last ? last : s;
            while (inside - first >= count) weight[count++] = 0.0f;
            weight[inside - first] += w > 0.0f ? w : 0.0f;
        }
        axis->first[i] = first;
        axis->count[i] = count;
    }
}

/* The end of the run of overlapping or touching supports that begins with output `from`. Only windows over AST_TAPS times the patch
 * leave gaps between supports. Sets `place` for the run, whose pixels start at `at` in the line. */
static int axis_run(struct ast_axis *axis, int from, int at, int *pixels) {
    int end = axis->first[from] + axis->count[from], i = from + 1;
    axis->place[from] = at;
    for (; i < axis->length && axis->first[i] <= end; i++) {
        axis->place[i] = at + axis->first[i] - axis->first[from];
        if (axis->first[i] + axis->count[i] > end) end = axis->first[i] + axis->count[i];
    }
    *pixels = end - axis->first[from];
    return i;
}

void ast_resampler_aim(struct ast_resampler *r, const ast_frame *frame, const ast_box *window, int width, int height) {
    r->columns.length = width;
    r->rows.length = height;
    axis_weights(&r->columns, window->x, window->w, frame->width);
    axis_weights(&r->rows, window->y, window->h, frame->height);
}

/* Adds weight times a stretch of a source row to the line: the inner loop of all patch sampling. */
static void add_pixels(float *line, const uint8_t *source, float weight, int pixels) {
    for (int x = 0; x < pixels; x++) line[x] += weight * (float)source[x];
}

/* Rows first: the source rows of an output row are summed over the pixels that matter, then each output pixel is read off that line. */
void ast_resampler_row(struct ast_resampler *r, const ast_frame *frame, int row, float *out) {
    const float *row_weight = r->rows.weight + (size_t)row * AST_TAPS;
    const int width = r->columns.length;
    int at = 0, pixels = 0;
    for (int c = 0, next = 0; c < width; c = next, at += pixels) {
        next = axis_run(&r->columns, c, at, &pixels);
        float *line = r->line + at;
        for (int x = 0; x < pixels; x++) line[x] = 0.0f;
        for (int j = 0; j < r->rows.count[row]; j++) {
            const uint8_t *source = frame->pixels + (size_t)(r->rows.first[row] + j) * (size_t)frame->stride + r->columns.first[c];
            add_pixels(line, source, row_weight[j], pixels);
        }
    }
    for (int c = 0; c < width; c++) {
        const float *weight = r->columns.weight + (size_t)c * AST_TAPS, *line = r->line + r->columns.place[c];
        float sum = 0.0f;
        for (int j = 0; j < r->columns.count[c]; j++) sum += weight[j] * line[j];
        out[c] = sum;
    }
}
