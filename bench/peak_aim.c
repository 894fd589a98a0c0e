#include "peak_patch.h"

#include <math.h>
#include <string.h>

const struct peak_sampler *const peak_samplers[PEAK_SAMPLERS] = {
    &peak_portable,
#ifdef AST_BENCH_NATIVE
    &peak_native,
    &peak_narrow,
#endif
};

/* Integral of the linear interpolation's triangle up to t. */
static float interpolated(float t) {
    const float inside = fminf(1.0f, fmaxf(-1.0f, t));
    return 0.5f + inside - 0.5f * inside * fabsf(inside);
}

void peak_aim(struct peak_axis *axis, float start, float extent, int length, int average) {
    const float step = extent / (float)length, box = sqrtf(fmaxf(1e-4f, step * step - 1.0f));
    const int averaged = average && step > 1.0f;
    memset(axis, 0, sizeof *axis);
    axis->length = length;
    axis->taps = averaged ? (int)ceilf(2.0f + box) : 2;
    for (int i = 0; i < length; i++) {
        const float at = start + ((float)i + 0.5f) * step - 0.5f;
        const int first = averaged ? (int)ceilf(at - 0.5f * box - 1.0f) : (int)floorf(at);
        if (i == 0) axis->from = first;
        axis->index[i] = first - axis->from;
        for (int j = 0; j < axis->taps; j++) {
            const float t = (float)(first + j) - at;
            axis->weight[j][i] = averaged ? (interpolated(t + 0.5f * box) - interpolated(t - 0.5f * box)) / box : 1.0f - fabsf(t);
        }
    }
    axis->pixels = axis->index[length - 1] + axis->taps;
}
