/* Resampling: an axis' weights for all outputs side by side, and four rows of a grid at once, because then the second pass works on
 * four outputs side by side. */
#include "kernel_vectors.h"
#include "maths.h"
#include "resample.h"

/* Integral of the triangle max(0, 1 - |t|) from -infinity to t. */
static inline float triangle_integral(float t) {
    const float low = t > -1.0f ? t : -1.0f, inside = low < 1.0f ? low : 1.0f, rest = inside < 0.0f ? 1.0f + inside : 1.0f - inside;
    const float half = 0.5f * rest * rest;
    return inside < 0.0f ? half : 1.0f - half;
}

/* Samples lie at start + (i + 1/2) step - 1/2 (pixel centres at integers), linearly interpolated, averaged over a box of width
 * sqrt(step^2 - 1) where the window is larger than the grid. That width gives the filter the variance of a box of one step; it starts
 * at zero, so that the patch changes smoothly with the scale. */
static void axis(struct ast_axis *restrict axis, float start, float extent, int source_length) {
    const int length = axis->length, last = source_length - 1;
    const float step = extent / (float)length, limit = (float)(AST_TAPS - 3);
    float blur = step > 1.0f ? ast_sqrtf(step * step - 1.0f) : 0.0f;
    if (blur > limit) blur = limit;
    const float half = 0.5f * blur;
    const int averaged = blur > 1e-2f; /* below, the quotient of differences would be rounding noise */
    int32_t *restrict first = axis->first, *restrict count = axis->count;
    float *restrict at = axis->at, *restrict weight = axis->weight;

    int taps = 1, least = 0, most = last;
    for (int i = 0; i < length; i++) {
        at[i] = start + ((float)i + 0.5f) * step - 0.5f;
        first[i] = (int32_t)ast_floorf(at[i] - half);
        count[i] = (int32_t)ast_floorf(at[i] + half) + 2 - first[i];
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

enum { CHUNK = AST_RESAMPLER_CHUNK };

/* The source rows of an output row, summed over CHUNK pixels. */
AST_ALWAYS_INLINE void sum_chunk(const uint8_t *source, size_t stride, const float *weight, size_t step, int used, float *out) {
#if AST_HAS_VECTORS
    sixteen sum = {0};
    for (int j = 0; j < used; j++) sum += SIXTEEN_NUMBERS(source + (size_t)j * stride) * weight[(size_t)j * step];
    *(sixteen *)out = sum;
#else
    for (int i = 0; i < CHUNK; i++) out[i] = 0.0f;
    for (int j = 0; j < used; j++)
        for (int i = 0; i < CHUNK; i++) out[i] += (float)source[(size_t)j * stride + (size_t)i] * weight[(size_t)j * step];
#endif
}

/* Sums the source rows of four output rows over the pixels first .. first + pixels - 1, and interleaves them: line[4 (CHUNK + x) + k].
 * What lies in front of the first pixel and beyond the last has no meaning. */
static void sum_rows(const struct ast_axis *rows, const ast_frame *frame, const int row[AST_RESAMPLER_ROWS], int first, int pixels,
                     float *restrict line) {
    const size_t length = (size_t)rows->length, stride = (size_t)frame->stride;
    for (int begin = 0; begin < pixels; begin += CHUNK) {
        float sum[AST_RESAMPLER_ROWS][CHUNK];
        /* Whole chunks, the last one moved back where it would leave the frame. */
        int x = begin;
        if (first + x + CHUNK > frame->width) x = frame->width - CHUNK - first;
        for (int k = 0; k < AST_RESAMPLER_ROWS; k++) {
            const float *weight = rows->weight + row[k];
            const uint8_t *source = frame->pixels + (size_t)rows->first[row[k]] * stride;
            const int used = rows->count[row[k]];
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
        float *to = line + (CHUNK + (frame->width >= CHUNK ? x : begin)) * AST_RESAMPLER_ROWS;
#if AST_HAS_VECTORS
        for (int i = 0; i < CHUNK; i += 4)
            transpose_four(sum[0] + i, sum[1] + i, sum[2] + i, sum[3] + i, to + i * AST_RESAMPLER_ROWS, AST_RESAMPLER_ROWS);
#else
        for (int i = 0; i < CHUNK; i++)
            for (int k = 0; k < AST_RESAMPLER_ROWS; k++) to[i * AST_RESAMPLER_ROWS + k] = sum[k][i];
#endif
    }
}

static void rows(const struct ast_axis *columns, const struct ast_axis *rows, const ast_frame *frame, int first_row, int count,
                 float *restrict line, float *restrict out, size_t ld) {
    const int length = columns->length;
    int row[AST_RESAMPLER_ROWS];
    for (int k = 0; k < AST_RESAMPLER_ROWS; k++) row[k] = first_row + (k < count ? k : 0);
    for (int c = 0, next; c < length; c = next) {
        /* As many outputs as a line holds the pixels of. */
        const int first = columns->first[c];
        int end = first + columns->count[c];
        for (next = c + 1; next < length && columns->first[next] + columns->count[next] - first <= AST_RESAMPLER_PIXELS; next++)
            end = columns->first[next] + columns->count[next];
        sum_rows(rows, frame, row, first, end - first, line);
        for (int i = c; i < next; i++) {
            const float *source = line + (CHUNK + columns->first[i] - first) * AST_RESAMPLER_ROWS, *weight = columns->weight + i;
            float sum[AST_RESAMPLER_ROWS] = {0};
#if AST_HAS_VECTORS
            four sums = {0};
            for (int j = 0; j < columns->count[i]; j++)
                sums += *(const four *)(source + j * AST_RESAMPLER_ROWS) * weight[(size_t)j * (size_t)length];
            *(four *)sum = sums;
#else
            for (int j = 0; j < columns->count[i]; j++)
                for (int k = 0; k < AST_RESAMPLER_ROWS; k++)
                    sum[k] += source[j * AST_RESAMPLER_ROWS + k] * weight[(size_t)j * (size_t)length];
#endif
            for (int k = 0; k < count; k++) out[(size_t)k * ld + (size_t)i] = sum[k];
        }
    }
}
