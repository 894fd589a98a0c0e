/* The cells of a window, read off the maps: eight directions side by side. */
#include "gradient.h"
#include "kernel_vectors.h"
#include "maths.h"

static void cells(const struct ast_gradient *g, const ast_box *window, float *restrict out) {
    const int count = g->cells, length = count * count * AST_DIRECTIONS;
    size_t left[AST_MAX_CELLS], right[AST_MAX_CELLS];
    float across[AST_MAX_CELLS];
    for (int c = 0; c < count; c++) {
        const float x = window->x + ((float)c + 0.5f) * window->w / (float)count - 0.5f, floor_x = ast_floorf(x);
        across[c] = x - floor_x;
        left[c] = (size_t)ast_gradient_edge((int)floor_x, g->width) * AST_DIRECTIONS;
        right[c] = (size_t)ast_gradient_edge((int)floor_x + 1, g->width) * AST_DIRECTIONS;
    }
    for (int r = 0; r < count; r++) {
        const float y = window->y + ((float)r + 0.5f) * window->h / (float)count - 0.5f;
        const float floor_y = ast_floorf(y), down = y - floor_y;
        const uint8_t *upper = g->maps + (size_t)ast_gradient_edge((int)floor_y, g->height) * (size_t)g->side * AST_DIRECTIONS;
        const uint8_t *lower = g->maps + (size_t)ast_gradient_edge((int)floor_y + 1, g->height) * (size_t)g->side * AST_DIRECTIONS;
        for (int c = 0; c < count; c++) {
            const float top_right = (1.0f - down) * across[c], top_left = (1.0f - down) - top_right;
            const float bottom_right = down * across[c], bottom_left = down - bottom_right;
            float *cell = out + (size_t)(r * count + c) * AST_DIRECTIONS;
#if AST_HAS_VECTORS
            *(eight *)cell = EIGHT_NUMBERS(upper + left[c]) * top_left + EIGHT_NUMBERS(upper + right[c]) * top_right +
                             EIGHT_NUMBERS(lower + left[c]) * bottom_left + EIGHT_NUMBERS(lower + right[c]) * bottom_right;
#else
            for (int k = 0; k < AST_DIRECTIONS; k++) {
                cell[k] = top_left * (float)upper[left[c] + (size_t)k] + top_right * (float)upper[right[c] + (size_t)k] +
                          bottom_left * (float)lower[left[c] + (size_t)k] + bottom_right * (float)lower[right[c] + (size_t)k];
            }
#endif
        }
    }
    const float norm = (float)ast_sqrt(dot(out, out, length));
    const float factor = 1.0f / (norm + 0.1f * AST_GRADIENT_UNIT);
    for (int i = 0; i < length; i++) out[i] *= factor;
}
