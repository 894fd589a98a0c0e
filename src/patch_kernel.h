/* Normalisation of a grey patch. */
#include "real.h"

static void normalise(float *restrict patch, int length, int normalisation) {
    enum { SUMS = 16 }; /* independent sums, so that none waits for the last one's rounding */
    ast_real sums[SUMS] = {0}, sum = 0, square = 0;
    int i = 0;
    for (; i + SUMS <= length; i += SUMS) {
        for (int l = 0; l < SUMS; l++) {
            const float value = patch[i + l] * (1.0f / 255.0f);
            patch[i + l] = value;
            sums[l] += (ast_real)value;
        }
    }
    for (; i < length; i++) {
        patch[i] *= 1.0f / 255.0f;
        sums[0] += (ast_real)patch[i];
    }
    if (normalisation == AST_NORMALISE_NONE) return;
    for (int l = 0; l < SUMS; l++) sum += sums[l];
    const float mean = (float)(sum / (ast_real)length);
    for (int l = 0; l < SUMS; l++) sums[l] = 0;
    for (i = 0; i + SUMS <= length; i += SUMS) {
        for (int l = 0; l < SUMS; l++) {
            const float rest = patch[i + l] - mean;
            patch[i + l] = rest;
            sums[l] += (ast_real)rest * (ast_real)rest;
        }
    }
    for (; i < length; i++) {
        patch[i] -= mean;
        sums[0] += (ast_real)patch[i] * (ast_real)patch[i];
    }
    if (normalisation == AST_NORMALISE_MEAN) return;
    for (int l = 0; l < SUMS; l++) square += sums[l];
    const float factor = (float)(1 / (ast_sqrt(square) + (ast_real)1 / 255));
    for (i = 0; i < length; i++) patch[i] *= factor;
}
