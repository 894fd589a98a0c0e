/* Compiled several times, each with a name of its own for the table at the end. */
#include "peak_patch.h"

#include <stddef.h>

#ifndef PEAK_NAME
#define PEAK_NAME peak_portable
#endif

/* One row of the grid. A number of taps that the compiler knows lets it unroll both sums. */
static inline void row_of(const struct peak_axis *columns, const struct peak_axis *rows, int r, const uint8_t *source, int stride,
                          float *restrict line, float *restrict out, int column_taps, int row_taps) {
    for (int x = 0; x < columns->pixels; x++) {
        float sum = 0.0f;
        for (int j = 0; j < row_taps; j++) sum += rows->weight[j][r] * (float)source[j * stride + x];
        line[x] = sum;
    }
    for (int c = 0; c < columns->length; c++) {
        const float *from = line + columns->index[c];
        float sum = 0.0f;
        for (int j = 0; j < column_taps; j++) sum += columns->weight[j][c] * from[j];
        out[c] = sum;
    }
}

static inline void patch_of(const struct peak_axis *columns, const struct peak_axis *rows, const uint8_t *pixels, int stride,
                            float *line, float *out, int column_taps, int row_taps) {
    for (int r = 0; r < rows->length; r++) {
        const uint8_t *source = pixels + (ptrdiff_t)(rows->from + rows->index[r]) * stride + columns->from;
        row_of(columns, rows, r, source, stride, line, out + (ptrdiff_t)r * columns->length, column_taps, row_taps);
    }
}

/* The numbers of taps that windows up to some four times their grid need. */
#define WITH_ROW_TAPS(column_taps)                                                                                                 \
    switch (rows->taps) {                                                                                                          \
    case 2: patch_of(columns, rows, pixels, stride, line, out, column_taps, 2); return;                                            \
    case 3: patch_of(columns, rows, pixels, stride, line, out, column_taps, 3); return;                                            \
    case 4: patch_of(columns, rows, pixels, stride, line, out, column_taps, 4); return;                                            \
    case 5: patch_of(columns, rows, pixels, stride, line, out, column_taps, 5); return;                                            \
    case 6: patch_of(columns, rows, pixels, stride, line, out, column_taps, 6); return;                                            \
    default: patch_of(columns, rows, pixels, stride, line, out, column_taps, rows->taps); return;                                  \
    }

static void patch(const struct peak_axis *columns, const struct peak_axis *rows, const uint8_t *pixels, int stride, float *line,
                  float *out) {
    switch (columns->taps) {
    case 2: WITH_ROW_TAPS(2)
    case 3: WITH_ROW_TAPS(3)
    case 4: WITH_ROW_TAPS(4)
    case 5: WITH_ROW_TAPS(5)
    case 6: WITH_ROW_TAPS(6)
    default: WITH_ROW_TAPS(columns->taps)
    }
}

static void cells(const struct peak_axis *columns, const struct peak_axis *rows, const uint8_t *maps, int stride, float *out) {
    for (int r = 0; r < rows->length; r++) {
        const uint8_t *upper = maps + ((ptrdiff_t)(rows->from + rows->index[r]) * stride + columns->from) * PEAK_DIRECTIONS;
        const uint8_t *lower = upper + (ptrdiff_t)stride * PEAK_DIRECTIONS;
        const float above = rows->weight[0][r], below = rows->weight[1][r];
        for (int c = 0; c < columns->length; c++) {
            const int at = columns->index[c] * PEAK_DIRECTIONS;
            const float left = columns->weight[0][c], right = columns->weight[1][c];
            const float weight[4] = {above * left, above * right, below * left, below * right};
            for (int k = 0; k < PEAK_DIRECTIONS; k++)
                out[k] = weight[0] * (float)upper[at + k] + weight[1] * (float)upper[at + PEAK_DIRECTIONS + k] +
                         weight[2] * (float)lower[at + k] + weight[3] * (float)lower[at + PEAK_DIRECTIONS + k];
            out += PEAK_DIRECTIONS;
        }
    }
}

const struct peak_sampler PEAK_NAME = {patch, cells};
