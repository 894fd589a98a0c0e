#include "gradient.h"

#include <string.h>

void ast_gradient_layout(struct ast_gradient *g, const ast_config *cfg, struct ast_arena *arena) {
    const size_t side = (size_t)cfg->view;
    g->kernels = ast_kernels();
    g->cells = cfg->gradient_cells;
    g->side = cfg->view;
    g->maps = ast_arena_take(arena, side * side * AST_DIRECTIONS, sizeof *g->maps);
    /* The energy takes the maps' second half: a row of maps is written where no row of the energy is still to be read. */
    g->energy = g->maps != NULL ? (float *)(void *)(g->maps + side * side * (AST_DIRECTIONS - sizeof *g->energy)) : NULL;
    g->row = ast_arena_take(arena, 2 * side * AST_DIRECTIONS, sizeof *g->row);
}

/* Running means over 2 radius + 1 samples, edges replicated, of `lanes` interleaved signals, from `in` to `out`. */
static void blur_line(const float *in, float *out, int samples, int lanes, int radius) {
    const float share = 1.0f / (float)(2 * radius + 1);
    float sum[AST_DIRECTIONS] = {0};
    for (int i = -radius; i <= radius; i++)
        for (int l = 0; l < lanes; l++) sum[l] += in[ast_gradient_edge(i, samples) * lanes + l];
    for (int i = 0; i < samples; i++) {
        const float *enter = in + (size_t)ast_gradient_edge(i + radius + 1, samples) * (size_t)lanes;
        const float *leave = in + (size_t)ast_gradient_edge(i - radius, samples) * (size_t)lanes;
        for (int l = 0; l < lanes; l++) {
            out[i * lanes + l] = sum[l] * share;
            sum[l] += enter[l] - leave[l];
        }
    }
}

/* Mean of the squared gradient around each pixel, in place. */
static void blur_energy(struct ast_gradient *g, int radius_x, int radius_y) {
    float *line = g->row, *blurred = g->row + g->side;
    for (int y = 0; y < g->height; y++) {
        float *energy = g->energy + (size_t)y * (size_t)g->side;
        memcpy(line, energy, (size_t)g->width * sizeof *line);
        blur_line(line, energy, g->width, 1, radius_x);
    }
    for (int x = 0; x < g->width; x++) {
        for (int y = 0; y < g->height; y++) line[y] = g->energy[(size_t)y * (size_t)g->side + (size_t)x];
        blur_line(line, blurred, g->height, 1, radius_y);
        for (int y = 0; y < g->height; y++) g->energy[(size_t)y * (size_t)g->side + (size_t)x] = blurred[y];
    }
}

/* Means down the columns of the maps, in place, in whole numbers. */
static void blur_maps_down(struct ast_gradient *g, int radius) {
    const size_t step = (size_t)g->side * AST_DIRECTIONS;
    /* sum / count, rounded, as (sum + count / 2) * inverse / 2^24: exact, because count < 256 and the sum is at most 255 count. */
    const uint32_t count = (uint32_t)(2 * radius + 1), inverse = (1u << 24) / count + 1;
    uint8_t *line = (uint8_t *)g->row; /* one column */
    for (int x = 0; x < g->width; x++) {
        uint8_t *column = g->maps + (size_t)x * AST_DIRECTIONS;
        uint32_t sum[AST_DIRECTIONS] = {0};
        for (int y = 0; y < g->height; y++) memcpy(line + (size_t)y * AST_DIRECTIONS, column + (size_t)y * step, AST_DIRECTIONS);
        for (int y = -radius; y <= radius; y++)
            for (int k = 0; k < AST_DIRECTIONS; k++) sum[k] += line[ast_gradient_edge(y, g->height) * AST_DIRECTIONS + k];
        for (int y = 0; y < g->height; y++) {
            const uint8_t *enter = line + (size_t)ast_gradient_edge(y + radius + 1, g->height) * AST_DIRECTIONS;
            const uint8_t *leave = line + (size_t)ast_gradient_edge(y - radius, g->height) * AST_DIRECTIONS;
            for (int k = 0; k < AST_DIRECTIONS; k++) {
                column[(size_t)y * step + (size_t)k] = (uint8_t)((sum[k] + count / 2) * inverse >> 24);
                sum[k] += (uint32_t)enter[k] - (uint32_t)leave[k];
            }
        }
    }
}

static int radius_of(float width) {
    const int radius = (int)((width - 1.0f) / 2.0f + 0.5f);
    return radius < 1 ? 1 : radius;
}

/* Central differences at a pixel in 0 .. 255 units, edges replicated. */
static void difference(const ast_frame *image, int x, int y, float *gx, float *gy) {
    const size_t stride = (size_t)image->stride;
    const uint8_t *row = image->pixels + (size_t)y * stride;
    const uint8_t *above = y > 0 ? row - stride : row, *below = y + 1 < image->height ? row + stride : row;
    *gx = (float)row[x + 1 < image->width ? x + 1 : x] - (float)row[x > 0 ? x - 1 : x];
    *gy = (float)below[x] - (float)above[x];
}

/* Per pixel, with g the gradient: in direction u_k the response max(0, g . u_k)^4 / |g|^3, which is |g| along u_k and falls off
 * quickly beside it; times a local gain that evens out contrast; then the mean over a cell. */
void ast_gradient_prepare(struct ast_gradient *g, const ast_frame *image, float object_width, float object_height) {
    /* cos and sin of k 45 degrees */
    static const float cosine[AST_DIRECTIONS] = {1.0f, 0.70710678f, 0.0f, -0.70710678f, -1.0f, -0.70710678f, 0.0f, 0.70710678f};
    static const float sine[AST_DIRECTIONS] = {0.0f, 0.70710678f, 1.0f, 0.70710678f, 0.0f, -0.70710678f, -1.0f, -0.70710678f};
    const float cell_x = object_width / (float)g->cells, cell_y = object_height / (float)g->cells;
    float *blurred = g->row + (size_t)g->side * AST_DIRECTIONS;
    g->width = image->width;
    g->height = image->height;

    for (int y = 0; y < g->height; y++) {
        for (int x = 0; x < g->width; x++) {
            float gx, gy;
            difference(image, x, y, &gx, &gy);
            g->energy[(size_t)y * (size_t)g->side + (size_t)x] = gx * gx + gy * gy;
        }
    }
    const int gain_x = (int)(1.5f * cell_x + 0.5f), gain_y = (int)(1.5f * cell_y + 0.5f);
    blur_energy(g, gain_x < 1 ? 1 : gain_x, gain_y < 1 ? 1 : gain_y);

    for (int y = 0; y < g->height; y++) {
        for (int x = 0; x < g->width; x++) {
            float gx, gy;
            difference(image, x, y, &gx, &gy);
            const float square = gx * gx + gy * gy, mean = g->energy[(size_t)y * (size_t)g->side + (size_t)x];
            const float gain = 1.0f / (ast_sqrtf(mean > 0.0f ? mean : 0.0f) + 6.0f); /* 6: a camera's noise is not raised */
            const float rate = square > 0.0f ? gain / (square * ast_sqrtf(square)) : 0.0f;
            float *map = g->row + (size_t)x * AST_DIRECTIONS;
            for (int k = 0; k < AST_DIRECTIONS; k++) {
                const float along = gx * cosine[k] + gy * sine[k];
                const float positive = along > 0.0f ? along * along : 0.0f;
                map[k] = positive * positive * rate;
            }
        }
        blur_line(g->row, blurred, g->width, AST_DIRECTIONS, radius_of(cell_x));
        uint8_t *maps = g->maps + (size_t)y * (size_t)g->side * AST_DIRECTIONS;
        for (int i = 0; i < g->width * AST_DIRECTIONS; i++) {
            const float level = blurred[i] * AST_GRADIENT_UNIT + 0.5f;
            maps[i] = level < 255.0f ? (uint8_t)level : 255;
        }
    }
    blur_maps_down(g, radius_of(cell_y));
}

void ast_gradient_cells(const struct ast_gradient *g, const ast_box *window, float *out) {
    g->kernels->cells(g, window, out);
}
