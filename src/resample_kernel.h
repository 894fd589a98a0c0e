/* Resampling: an axis' weights for all outputs side by side, and a row of a grid in each lane, because then the second pass works
 * on the same output of all of them side by side. */
#include "kernel_vectors.h"
#include "maths.h"
#include "resample.h"

#include <string.h>

/* Integral of the triangle max(0, 1 - |t|) from -infinity to t. */
static inline float triangle_integral(float t) {
    const float low = t > -1.0f ? t : -1.0f, inside = low < 1.0f ? low : 1.0f, rest = inside < 0.0f ? 1.0f + inside : 1.0f - inside;
    const float half = 0.5f * rest * rest;
    return inside < 0.0f ? half : 1.0f - half;
}

/* The greatest whole number that is not above v. */
static inline int32_t whole_below(float v) {
    const int32_t whole = (int32_t)v;
    return whole - ((float)whole > v ? 1 : 0);
}

/* Samples lie at start + (i + 1/2) step - 1/2 (pixel centres at integers), linearly interpolated, averaged over a box of width
 * sqrt(step^2 - 1) where the window is larger than the grid. That width gives the filter the variance of a box of one step; it
 * starts at zero, so that the patch changes smoothly with the scale. */
static void axis(struct ast_axis *restrict axis, float start, float extent, int source_length) {
    const int length = axis->length, last = source_length - 1;
    const float step = extent / (float)axis->total, limit = (float)(AST_TAPS - 3);
    float blur = step > 1.0f ? ast_sqrtf(step * step - 1.0f) : 0.0f;
    if (blur > limit) blur = limit;
    const float half = 0.5f * blur;
    const int averaged = blur > 1e-2f; /* below, the quotient of differences would be rounding noise */
    int32_t *restrict first = axis->first, *restrict count = axis->count;
    float *restrict at = axis->at, *restrict weight = axis->weight;

    int taps = 1, least = 0, most = last;
    for (int i = 0; i < length; i++) {
        at[i] = start + ((float)(axis->begin + i) + 0.5f) * step - 0.5f;
        first[i] = whole_below(at[i] - half);
        count[i] = whole_below(at[i] + half) + 2 - first[i];
    }
    for (int i = 0; i < length; i++) {
        const int end = first[i] + count[i] - 1;
        taps = count[i] > taps ? count[i] : taps;
        least = first[i] < least ? first[i] : least;
        most = end > most ? end : most;
    }
    for (int j = 0; j < taps; j++) {
        float *restrict to = weight + (size_t)j * (size_t)length;
        if (averaged) {
            for (int i = 0; i < length; i++) {
                const float t = (float)(first[i] + j) - at[i];
                const float w = (triangle_integral(t + half) - triangle_integral(t - half)) / blur;
                to[i] = j < count[i] && w > 0.0f ? w : 0.0f;
            }
        } else {
            for (int i = 0; i < length; i++) {
                const float t = (float)(first[i] + j) - at[i], w = t < 0.0f ? 1.0f + t : 1.0f - t;
                to[i] = j < count[i] && w > 0.0f ? w : 0.0f;
            }
        }
    }
    axis->taps = taps;
    if (least >= 0 && most <= last) return;
    /* Sources are clamped to the frame: what lies outside counts for the pixel at the edge. */
    for (int i = 0; i < length; i++) {
        float clamped[AST_TAPS] = {0};
        const int from = first[i] < 0 ? 0 : first[i] > last ? last : first[i];
        int used = 1;
        for (int j = 0; j < count[i]; j++) {
            const int s = first[i] + j, inside = s < 0 ? 0 : s > last ? last : s;
            clamped[inside - from] += weight[(size_t)j * (size_t)length + (size_t)i];
            used = inside - from + 1;
        }
        for (int j = 0; j < taps; j++) weight[(size_t)j * (size_t)length + (size_t)i] = clamped[j];
        first[i] = from;
        count[i] = used;
    }
}

enum { CHUNK = AST_RESAMPLER_CHUNK, MARGIN = AST_RESAMPLER_MARGIN, GRID_ROWS = AST_RESAMPLER_ROWS };

/* Source pixels to take for output i: as many for each, since a processor foresees that, but none outside the source. */
static inline int taps_at(const struct ast_axis *axis, int i, int source_length) {
    const int rest = source_length - axis->first[i];
    return axis->taps < rest ? axis->taps : rest;
}

#if AST_HAS_VECTORS && AST_LANES == 16
/* The source rows of an output row, summed over CHUNK pixels. */
AST_ALWAYS_INLINE void sum_chunk(const uint8_t *source, size_t stride, const float *weight, size_t step, int used, float *out) {
    vector sum[CHUNK / WIDTH];
    for (int v = 0; v < CHUNK / WIDTH; v++) sum[v] = (vector){0};
    for (int j = 0; j < used; j++) {
        vector level[CHUNK / WIDTH];
        widen_sixteen(source + (size_t)j * stride, level);
        for (int v = 0; v < CHUNK / WIDTH; v++) sum[v] += level[v] * weight[(size_t)j * step];
    }
    for (int v = 0; v < CHUNK / WIDTH; v++) *(vector *)(out + v * WIDTH) = sum[v];
}

/* Sums the source rows of `count` output rows from `row` on over the pixels first .. first + pixels - 1, and interleaves them:
 * line[GRID_ROWS (MARGIN + x) + k]. What lies in front of the first pixel and beyond the last, and in the lanes of no row, has no
 * meaning. */
static void sum_rows(const struct ast_axis *rows, const ast_frame *frame, int row, int count, int first, int pixels,
                     float *restrict line) {
    const size_t length = (size_t)rows->length, stride = (size_t)frame->stride;
    AST_LANES_ALIGNED float sum[GRID_ROWS][CHUNK];
    for (int k = count; k % 4 != 0; k++) memset(sum[k], 0, sizeof sum[k]);
    for (int begin = 0; begin < pixels; begin += CHUNK) {
        /* Whole chunks, the last one moved back where it would leave the frame. */
        int x = begin;
        if (first + x + CHUNK > frame->width) x = frame->width - CHUNK - first;
        for (int k = 0; k < count; k++) {
            const float *weight = rows->weight + row + k;
            const uint8_t *source = frame->pixels + (size_t)rows->first[row + k] * stride;
            const int used = taps_at(rows, row + k, frame->height);
            if (frame->width >= CHUNK) {
                sum_chunk(source + first + x, stride, weight, length, used, sum[k]);
                continue;
            }
            for (int i = 0; i < CHUNK; i++) { /* a frame narrower than a chunk */
                sum[k][i] = 0.0f;
                for (int j = 0; begin + i < pixels && j < used; j++)
                    sum[k][i] += (float)source[(size_t)j * stride + (size_t)(first + begin + i)] * weight[(size_t)j * length];
            }
        }
        float *to = line + (CHUNK + (frame->width >= CHUNK ? x : begin)) * GRID_ROWS;
        for (int k = 0; k < count; k += 4)
            for (int i = 0; i < CHUNK; i += 4)
                transpose_four(sum[k] + i, sum[k + 1] + i, sum[k + 2] + i, sum[k + 3] + i, to + i * GRID_ROWS + k, GRID_ROWS);
    }
}

/* One output of all rows. source: its first pixel in the line. */
AST_ALWAYS_INLINE void sum_columns(const float *restrict source, const float *restrict weight, size_t step, int used,
                                   float *restrict out) {
    vector sum[GRID_ROWS / WIDTH];
    for (int v = 0; v < GRID_ROWS / WIDTH; v++) sum[v] = (vector){0};
    for (int j = 0; j < used; j++)
        for (int v = 0; v < GRID_ROWS / WIDTH; v++)
            sum[v] += *(const vector *)(source + j * GRID_ROWS + v * WIDTH) * weight[(size_t)j * step];
    for (int v = 0; v < GRID_ROWS / WIDTH; v++) *(vector *)(out + v * WIDTH) = sum[v];
}

/* The outputs c .. next - 1 of count rows, from the line, which begins with the first pixel of output c. */
static void sum_outputs(const struct ast_axis *columns, const ast_frame *frame, int c, int next, int count, const float *line,
                        float *restrict out, size_t ld) {
    const int length = columns->length;
    for (int i = c; i < next; i += 4) {
        const int used = next - i < 4 ? next - i : 4;
        AST_LANES_ALIGNED float sum[4][GRID_ROWS];
        for (int q = 0; q < used; q++)
            sum_columns(line + (MARGIN + columns->first[i + q] - columns->first[c]) * GRID_ROWS, columns->weight + i + q,
                        (size_t)length, taps_at(columns, i + q, frame->width), sum[q]);
        int k = 0;
        for (; used == 4 && k + 4 <= count; k += 4)
            transpose_four(sum[0] + k, sum[1] + k, sum[2] + k, sum[3] + k, out + (size_t)k * ld + i, ld);
        for (; k < count; k++)
            for (int q = 0; q < used; q++) out[(size_t)k * ld + (size_t)(i + q)] = sum[q][k];
    }
}
#else
/* The same without vectors: four pixels at a time, their sums in registers. */
static void sum_rows(const struct ast_axis *rows, const ast_frame *frame, int row, int count, int first, int pixels,
                     float *restrict line) {
    const size_t length = (size_t)rows->length, stride = (size_t)frame->stride;
    for (int k = 0; k < count; k++) {
        const float *weights = rows->weight + row + k;
        const uint8_t *from = frame->pixels + (size_t)rows->first[row + k] * stride + first;
        float *to = line + MARGIN * GRID_ROWS + k;
        const int used = rows->count[row + k];
        int x = 0;
        for (; x + 4 <= pixels; x += 4, from += 4, to += 4 * GRID_ROWS) {
            float a = 0.0f, b = 0.0f, c = 0.0f, d = 0.0f;
            const uint8_t *source = from;
            const float *weight = weights;
            for (int j = used; j > 0; j--, source += stride, weight += length) {
                const float w = *weight;
                a += (float)source[0] * w;
                b += (float)source[1] * w;
                c += (float)source[2] * w;
                d += (float)source[3] * w;
            }
            to[0] = a;
            to[GRID_ROWS] = b;
            to[2 * GRID_ROWS] = c;
            to[3 * GRID_ROWS] = d;
        }
        for (; x < pixels; x++, from++, to += GRID_ROWS) {
            float sum = 0.0f;
            for (int j = 0; j < used; j++) sum += (float)from[(size_t)j * stride] * weights[(size_t)j * length];
            *to = sum;
        }
    }
}

static void sum_outputs(const struct ast_axis *columns, const ast_frame *frame, int c, int next, int count, const float *line,
                        float *restrict out, size_t ld) {
    const int length = columns->length;
    (void)frame;
    for (int i = c; i < next; i++) {
        for (int k = 0; k < count; k += 4) { /* four rows in registers */
            const float *source = line + (MARGIN + columns->first[i] - columns->first[c]) * GRID_ROWS + k,
                        *weight = columns->weight + i;
            float *to = out + (size_t)k * ld + i;
            float p = 0.0f, q = 0.0f, r = 0.0f, s = 0.0f;
            for (int j = columns->count[i]; j > 0; j--, source += GRID_ROWS, weight += length) {
                const float w = *weight;
                p += source[0] * w;
                q += source[1] * w;
                r += source[2] * w;
                s += source[3] * w;
            }
            to[0] = p;
            if (count - k > 1) to[ld] = q;
            if (count - k > 2) to[2 * ld] = r;
            if (count - k > 3) to[3 * ld] = s;
        }
    }
}
#endif

static void rows(const struct ast_axis *columns, const struct ast_axis *rows, const ast_frame *frame, int first_row, int count,
                 float *restrict line, float *restrict out, size_t ld) {
    const int length = columns->length;
    for (int c = 0, next; c < length; c = next) {
        /* As many outputs as a line holds the pixels of. */
        const int first = columns->first[c];
        int end = first + taps_at(columns, c, frame->width);
        for (next = c + 1; next < length; next++) {
            const int behind = columns->first[next] + taps_at(columns, next, frame->width);
            if (behind - first > AST_RESAMPLER_PIXELS) break;
            end = behind;
        }
        sum_rows(rows, frame, first_row, count, first, end - first, line);
        sum_outputs(columns, frame, c, next, count, line, out, ld);
    }
}
