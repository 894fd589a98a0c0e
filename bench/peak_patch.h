/* The least that sampling candidates can cost: the samples alone, at coordinates and weights that lie ready in tables, with no
 * window to aim at, no border to mind and nothing to normalise. */
#ifndef PEAK_PATCH_H
#define PEAK_PATCH_H

#include <stdint.h>

enum { PEAK_SIDE = 64, PEAK_TAPS = 16, PEAK_LINE = 1024, PEAK_DIRECTIONS = 8 };

/* One axis of a grid: output i is the sum over j < taps of weight[j][i] source[from + index[i] + j]. */
struct peak_axis {
    int length, taps;
    int from, pixels; /* of the source that some output weighs: the first, and how many */
    int index[PEAK_SIDE];
    float weight[PEAK_TAPS][PEAK_SIDE];
};

/* Linear interpolation; averaged, as the library's patches are, over a box where the extent (pixels) is larger than the grid and
 * `average` is not 0. The support must lie in the source; length <= PEAK_SIDE, and an extent of at most 12 pixels an output. */
void peak_aim(struct peak_axis *axis, float start, float extent, int length, int average);
/* The samplers, compiled once for any processor and, where the compiler can, for this one: which is fastest shows only when run. */
struct peak_sampler {
    /* A grey patch, columns->length x rows->length; line: PEAK_LINE floats of scratch. */
    void (*patch)(const struct peak_axis *columns, const struct peak_axis *rows, const uint8_t *pixels, int stride, float *line,
                  float *out);
    /* Cells of PEAK_DIRECTIONS bytes, each interpolated between four: axes aimed at without averaging, stride in cells. */
    void (*cells)(const struct peak_axis *columns, const struct peak_axis *rows, const uint8_t *maps, int stride, float *out);
};
extern const struct peak_sampler peak_portable;
#ifdef AST_BENCH_NATIVE
extern const struct peak_sampler peak_native, peak_narrow; /* all that the processor has, and its vectors of at most 256 bits */
enum { PEAK_SAMPLERS = 3 };
#else
enum { PEAK_SAMPLERS = 1 };
#endif
/* All of them. */
extern const struct peak_sampler *const peak_samplers[PEAK_SAMPLERS];

#endif
