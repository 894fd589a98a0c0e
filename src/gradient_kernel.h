/* The maps of oriented gradients, and the cells of a window read off them: eight directions side by side. */
#include "gradient.h"
#include "kernel_vectors.h"
#include "maths.h"

#include <string.h>

/* Central differences of a row in 0 .. 255 units, edges replicated. */
static void differences(const ast_frame *image, int y, float *restrict gx, float *restrict gy) {
    const size_t stride = (size_t)image->stride;
    const int last = image->width - 1;
    const uint8_t *row = image->pixels + (size_t)y * stride;
    const uint8_t *above = y > 0 ? row - stride : row, *below = y + 1 < image->height ? row + stride : row;
    gx[0] = (float)row[last > 0 ? 1 : 0] - (float)row[0];
    gx[last] = (float)row[last] - (float)row[last > 0 ? last - 1 : 0];
    for (int x = 1; x < last; x++) gx[x] = (float)row[x + 1] - (float)row[x - 1];
    for (int x = 0; x <= last; x++) gy[x] = (float)below[x] - (float)above[x];
}

/* Mean of the squared gradient around each pixel: a row's running means, then all columns' side by side. */
static void local_energy(struct ast_gradient *g, const ast_frame *image, int radius_x, int radius_y) {
    const size_t side = (size_t)g->side;
    const int width = g->width, height = g->height;
    float *across = (float *)(void *)g->maps; /* the memory's first half */
    float *restrict gx = g->row, *restrict gy = gx + side, *restrict square = gy + side;
    const float share_x = 1.0f / (float)(2 * radius_x + 1), share_y = 1.0f / (float)(2 * radius_y + 1);
    for (int y = 0; y < height; y++) {
        float *restrict out = across + (size_t)y * side, sum = 0.0f;
        differences(image, y, gx, gy);
        for (int x = 0; x < width; x++) square[x] = gx[x] * gx[x] + gy[x] * gy[x];
        for (int x = -radius_x; x <= radius_x; x++) sum += square[ast_gradient_edge(x, width)];
        for (int x = 0; x < width; x++) {
            out[x] = sum * share_x;
            sum += square[ast_gradient_edge(x + radius_x + 1, width)] - square[ast_gradient_edge(x - radius_x, width)];
        }
    }
    float *restrict sums = g->row;
    memset(sums, 0, (size_t)width * sizeof *sums);
    for (int y = -radius_y; y <= radius_y; y++) {
        const float *restrict row = across + (size_t)ast_gradient_edge(y, height) * side;
        for (int x = 0; x < width; x++) sums[x] += row[x];
    }
    for (int y = 0; y < height; y++) {
        float *restrict out = g->energy + (size_t)y * side;
        const float *restrict enter = across + (size_t)ast_gradient_edge(y + radius_y + 1, height) * side;
        const float *restrict leave = across + (size_t)ast_gradient_edge(y - radius_y, height) * side;
        for (int x = 0; x < width; x++) {
            out[x] = sums[x] * share_y;
            sums[x] += enter[x] - leave[x];
        }
    }
}

/* The responses of a pixel with the gradient (x, y) in all directions, divided by its length. */
AST_ALWAYS_INLINE void respond(float x, float y, float rate, float *map) {
    /* cos and sin of k 45 degrees */
#if AST_HAS_VECTORS
    const eight cosine = {1.0f, 0.70710678f, 0.0f, -0.70710678f, -1.0f, -0.70710678f, 0.0f, 0.70710678f};
    const eight sine = {0.0f, 0.70710678f, 1.0f, 0.70710678f, 0.0f, -0.70710678f, -1.0f, -0.70710678f};
    const eight along = cosine * x + sine * y;
    const eight positive = (eight)((along > 0.0f) & (eight_words)(along * along));
    *(eight *)map = positive * positive * rate;
#else
    static const float cosine[AST_DIRECTIONS] = {1.0f, 0.70710678f, 0.0f, -0.70710678f, -1.0f, -0.70710678f, 0.0f, 0.70710678f};
    static const float sine[AST_DIRECTIONS] = {0.0f, 0.70710678f, 1.0f, 0.70710678f, 0.0f, -0.70710678f, -1.0f, -0.70710678f};
    for (int k = 0; k < AST_DIRECTIONS; k++) {
        const float along = x * cosine[k] + y * sine[k];
        const float positive = along > 0.0f ? along * along : 0.0f;
        map[k] = positive * positive * rate;
    }
#endif
}

/* A row of responses, eight a pixel. scratch: three floats a pixel. */
static void responses(const struct ast_gradient *g, const ast_frame *image, int y, float *restrict scratch, float *restrict map) {
    float *restrict gx = scratch, *restrict gy = scratch + g->side, *restrict rate = gy + g->side;
    const float *restrict energy = g->energy + (size_t)y * (size_t)g->side;
    differences(image, y, gx, gy);
    for (int x = 0; x < g->width; x++) {
        const float square = gx[x] * gx[x] + gy[x] * gy[x], mean = energy[x];
        const float gain = 1.0f / (ast_sqrtf(mean > 0.0f ? mean : 0.0f) + 6.0f); /* 6: a camera's noise is not raised */
        const float quotient = gain / (square * ast_sqrtf(square));
        rate[x] = square > 0.0f ? quotient : 0.0f;
    }
    for (int x = 0; x < g->width; x++) respond(gx[x], gy[x], rate[x], map + (size_t)x * AST_DIRECTIONS);
}

/* Running means of a row of responses, edges replicated, in the bytes of the maps. */
static void blur_across(const float *restrict map, int width, int radius, uint8_t *restrict out) {
    const float share = 1.0f / (float)(2 * radius + 1);
#if AST_HAS_VECTORS
    eight sum = {0};
    for (int x = -radius; x <= radius; x++) sum += *(const eight *)(map + (size_t)ast_gradient_edge(x, width) * AST_DIRECTIONS);
    for (int x = 0; x < width; x++) {
        const eight enter = *(const eight *)(map + (size_t)ast_gradient_edge(x + radius + 1, width) * AST_DIRECTIONS);
        const eight leave = *(const eight *)(map + (size_t)ast_gradient_edge(x - radius, width) * AST_DIRECTIONS);
        const eight level = sum * share * AST_GRADIENT_UNIT + 0.5f;
        const eight_words word = __builtin_convertvector(level, eight_words), least = word < 255;
        *(eight_bytes *)(out + (size_t)x * AST_DIRECTIONS) =
            __builtin_convertvector(__builtin_convertvector((word & least) | (255 & ~least), eight_halves), eight_bytes);
        sum += enter - leave;
    }
#else
    float sum[AST_DIRECTIONS] = {0};
    for (int x = -radius; x <= radius; x++)
        for (int k = 0; k < AST_DIRECTIONS; k++) sum[k] += map[ast_gradient_edge(x, width) * AST_DIRECTIONS + k];
    for (int x = 0; x < width; x++) {
        const float *enter = map + (size_t)ast_gradient_edge(x + radius + 1, width) * AST_DIRECTIONS;
        const float *leave = map + (size_t)ast_gradient_edge(x - radius, width) * AST_DIRECTIONS;
        for (int k = 0; k < AST_DIRECTIONS; k++) {
            const float level = sum[k] * share * AST_GRADIENT_UNIT + 0.5f;
            out[x * AST_DIRECTIONS + k] = level < 255.0f ? (uint8_t)level : 255;
            sum[k] += enter[k] - leave[k];
        }
    }
#endif
}

enum { BLOCK = 8 * AST_DIRECTIONS }; /* bytes of a row of maps that are averaged side by side */

/* sum / count, rounded, of BLOCK sums, as (sum + count / 2) * inverse / 2^24: exact, because count < 256 and a sum is at most 255
 * count; then the sums move on. */
AST_ALWAYS_INLINE void average_and_move(uint32_t *restrict sum, uint32_t half, uint32_t inverse, const uint8_t *restrict enter,
                                        const uint8_t *restrict leave, uint8_t *restrict out) {
#if AST_HAS_VECTORS
    for (int k = 0; k < BLOCK; k += 16) {
        sixteen_counts *sums = (sixteen_counts *)(sum + k);
        const sixteen_counts mean = (*sums + half) * inverse >> 24;
        *(sixteen_bytes *)(out + k) = __builtin_convertvector(__builtin_convertvector(mean, sixteen_halves), sixteen_bytes);
        *sums += SIXTEEN_COUNTS(enter + k) - SIXTEEN_COUNTS(leave + k);
    }
#else
    for (int k = 0; k < BLOCK; k++) {
        out[k] = (uint8_t)((sum[k] + half) * inverse >> 24);
        sum[k] += (uint32_t)enter[k] - (uint32_t)leave[k];
    }
#endif
}

/* Means down `bytes` <= BLOCK columns of bytes, in place. line: BLOCK bytes a row. */
static void blur_down(uint8_t *restrict top, size_t step, int height, int radius, int bytes, uint8_t *restrict line) {
    const uint32_t count = (uint32_t)(2 * radius + 1), inverse = (1u << 24) / count + 1;
    AST_LANES_ALIGNED uint32_t sum[BLOCK] = {0};
    uint8_t mean[BLOCK];
    memset(line, 0, (size_t)height * BLOCK);
    for (int y = 0; y < height; y++) memcpy(line + (size_t)y * BLOCK, top + (size_t)y * step, (size_t)bytes);
    for (int y = -radius; y <= radius; y++)
        for (int k = 0; k < BLOCK; k++) sum[k] += line[(size_t)ast_gradient_edge(y, height) * BLOCK + (size_t)k];
    for (int y = 0; y < height; y++) {
        const uint8_t *enter = line + (size_t)ast_gradient_edge(y + radius + 1, height) * BLOCK;
        const uint8_t *leave = line + (size_t)ast_gradient_edge(y - radius, height) * BLOCK;
        average_and_move(sum, count / 2, inverse, enter, leave, mean);
        memcpy(top + (size_t)y * step, mean, (size_t)bytes);
    }
}

static int radius_of(float width) {
    const int radius = (int)((width - 1.0f) / 2.0f + 0.5f);
    return radius < 1 ? 1 : radius;
}

/* Per pixel, with g the gradient: in direction u_k the response max(0, g . u_k)^4 / |g|^3, which is |g| along u_k and falls off
 * quickly beside it; times a local gain that evens out contrast; then the mean over a cell. */
static void maps(struct ast_gradient *g, const ast_frame *image, float cell_x, float cell_y) {
    const int gain_x = (int)(1.5f * cell_x + 0.5f), gain_y = (int)(1.5f * cell_y + 0.5f);
    const size_t step = (size_t)g->side * AST_DIRECTIONS;
    float *map = g->row, *scratch = g->row + step;
    g->width = image->width;
    g->height = image->height;
    local_energy(g, image, gain_x < 1 ? 1 : gain_x, gain_y < 1 ? 1 : gain_y);
    for (int y = 0; y < g->height; y++) {
        responses(g, image, y, scratch, map);
        blur_across(map, g->width, radius_of(cell_x), g->maps + (size_t)y * step);
    }
    const int bytes = g->width * AST_DIRECTIONS, radius = radius_of(cell_y);
    for (int first = 0; first < bytes; first += BLOCK)
        blur_down(g->maps + first, step, g->height, radius, bytes - first < BLOCK ? bytes - first : BLOCK, (uint8_t *)g->row);
}

static void cells(const struct ast_gradient *g, const ast_box *window, float *restrict out) {
    const int count = g->cells, length = count * count * AST_DIRECTIONS;
    size_t left[AST_MAX_CELLS], right[AST_MAX_CELLS];
    float across[AST_MAX_CELLS], top_left[AST_MAX_CELLS], top_right[AST_MAX_CELLS], bottom_left[AST_MAX_CELLS],
        bottom_right[AST_MAX_CELLS];
    for (int c = 0; c < count; c++) {
        const float x = window->x + ((float)c + 0.5f) * window->w / (float)count - 0.5f, floor_x = ast_floorf(x);
        across[c] = x - floor_x;
        left[c] = (size_t)ast_gradient_edge((int)floor_x, g->width) * AST_DIRECTIONS;
        right[c] = (size_t)ast_gradient_edge((int)floor_x + 1, g->width) * AST_DIRECTIONS;
    }
#if AST_HAS_VECTORS
    reals squares[SQUARES / REALS];
    for (int v = 0; v < SQUARES / REALS; v++) squares[v] = (reals){0};
#endif
    for (int r = 0; r < count; r++) {
        const float y = window->y + ((float)r + 0.5f) * window->h / (float)count - 0.5f;
        const float floor_y = ast_floorf(y), down = y - floor_y;
        const uint8_t *upper = g->maps + (size_t)ast_gradient_edge((int)floor_y, g->height) * (size_t)g->side * AST_DIRECTIONS;
        const uint8_t *lower = g->maps + (size_t)ast_gradient_edge((int)floor_y + 1, g->height) * (size_t)g->side * AST_DIRECTIONS;
        for (int c = 0; c < count; c++) {
            top_right[c] = (1.0f - down) * across[c];
            top_left[c] = (1.0f - down) - top_right[c];
            bottom_right[c] = down * across[c];
            bottom_left[c] = down - bottom_right[c];
        }
        for (int c = 0; c < count; c++) {
            float *cell = out + (size_t)(r * count + c) * AST_DIRECTIONS;
#if AST_HAS_VECTORS
            *(eight *)cell = EIGHT_NUMBERS(upper + left[c]) * top_left[c] + EIGHT_NUMBERS(upper + right[c]) * top_right[c] +
                             EIGHT_NUMBERS(lower + left[c]) * bottom_left[c] + EIGHT_NUMBERS(lower + right[c]) * bottom_right[c];
            add_squares(cell, squares);
#else
            for (int k = 0; k < AST_DIRECTIONS; k++) {
                cell[k] = top_left[c] * (float)upper[left[c] + (size_t)k] + top_right[c] * (float)upper[right[c] + (size_t)k] +
                          bottom_left[c] * (float)lower[left[c] + (size_t)k] + bottom_right[c] * (float)lower[right[c] + (size_t)k];
            }
#endif
        }
    }
#if AST_HAS_VECTORS
    ast_real sum[SQUARES];
    memcpy(sum, squares, sizeof sum);
    const float norm = (float)ast_sqrt(total_of_eight(sum));
#else
    const float norm = (float)ast_sqrt(dot(out, out, length));
#endif
    const float factor = 1.0f / (norm + 0.1f * AST_GRADIENT_UNIT);
    const float weight = g->weight;
    for (int i = 0; i < length; i++) out[i] = out[i] * factor * weight;
}
