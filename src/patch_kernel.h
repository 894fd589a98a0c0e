/* Normalisation of a grey patch. */
#include "kernel_vectors.h"
#include "real.h"

enum { LEVELS = 16 }; /* levels side by side: independent sums, so that none waits for the last one's rounding */
#define WHITE (1.0f / 255.0f)

/* Levels from 0 .. 255 to 0 .. 1; sums[l] += the levels l, l + LEVELS, .. of the patch, of which `whole` is a multiple of
 * LEVELS. */
static void sum_levels(float *restrict patch, int whole, ast_real *restrict sums) {
#if AST_HAS_VECTORS
    for (int i = 0; i < whole; i += LEVELS)
        for (int l = 0; l < LEVELS; l++) {
            patch[i + l] *= WHITE;
            sums[l] += (ast_real)patch[i + l];
        }
#else
    for (int l = 0; l < LEVELS; l += 4) { /* four of them in registers */
        ast_real a = 0, b = 0, c = 0, d = 0;
        for (float *at = patch + l; at < patch + whole; at += LEVELS) {
            const float w = at[0] * WHITE, x = at[1] * WHITE, y = at[2] * WHITE, z = at[3] * WHITE;
            at[0] = w;
            at[1] = x;
            at[2] = y;
            at[3] = z;
            a += (ast_real)w;
            b += (ast_real)x;
            c += (ast_real)y;
            d += (ast_real)z;
        }
        sums[l] = a;
        sums[l + 1] = b;
        sums[l + 2] = c;
        sums[l + 3] = d;
    }
#endif
}

/* The same of the squares of what is left without the mean, which is taken from the patch. */
static void sum_squares(float *restrict patch, int whole, float mean, ast_real *restrict sums) {
#if AST_HAS_VECTORS
    for (int i = 0; i < whole; i += LEVELS) {
        for (int l = 0; l < LEVELS; l++) {
            const float rest = patch[i + l] - mean;
            patch[i + l] = rest;
            sums[l] += (ast_real)rest * (ast_real)rest;
        }
    }
#else
    for (int l = 0; l < LEVELS; l += 4) {
        ast_real a = 0, b = 0, c = 0, d = 0;
        for (float *at = patch + l; at < patch + whole; at += LEVELS) {
            const float w = at[0] - mean, x = at[1] - mean, y = at[2] - mean, z = at[3] - mean;
            at[0] = w;
            at[1] = x;
            at[2] = y;
            at[3] = z;
            a += (ast_real)w * (ast_real)w;
            b += (ast_real)x * (ast_real)x;
            c += (ast_real)y * (ast_real)y;
            d += (ast_real)z * (ast_real)z;
        }
        sums[l] = a;
        sums[l + 1] = b;
        sums[l + 2] = c;
        sums[l + 3] = d;
    }
#endif
}

static void normalise(float *restrict patch, int length, int normalisation) {
    ast_real sums[LEVELS] = {0}, sum = 0, square = 0;
    const int whole = length - length % LEVELS;
    sum_levels(patch, whole, sums);
    for (int i = whole; i < length; i++) {
        patch[i] *= WHITE;
        sums[0] += (ast_real)patch[i];
    }
    if (normalisation == AST_NORMALISE_NONE) return;
    for (int l = 0; l < LEVELS; l++) sum += sums[l];
    const float mean = (float)(sum / (ast_real)length);
    for (int l = 0; l < LEVELS; l++) sums[l] = 0;
    sum_squares(patch, whole, mean, sums);
    for (int i = whole; i < length; i++) {
        patch[i] -= mean;
        sums[0] += (ast_real)patch[i] * (ast_real)patch[i];
    }
    if (normalisation == AST_NORMALISE_MEAN) return;
    for (int l = 0; l < LEVELS; l++) square += sums[l];
    const float factor = (float)(1 / (ast_sqrt(square) + (ast_real)1 / 255));
    int i = 0;
    for (; i < whole; i += 4) {
        patch[i] *= factor;
        patch[i + 1] *= factor;
        patch[i + 2] *= factor;
        patch[i + 3] *= factor;
    }
    for (; i < length; i++) patch[i] *= factor;
}
