/* Inner products of vectors, in eight independent sums that a compiler can hold side by side without reordering any of them. */
#include "real.h"

static ast_real dot(const float *x, const float *y, int n) {
    enum { SUMS = 8 };
    ast_real sum[SUMS] = {0};
    int d = 0;
    for (; d + SUMS <= n; d += SUMS)
        for (int l = 0; l < SUMS; l++) sum[l] += (ast_real)x[d + l] * (ast_real)y[d + l];
    for (; d < n; d++) sum[0] += (ast_real)x[d] * (ast_real)y[d];
    return ((sum[0] + sum[4]) + (sum[2] + sum[6])) + ((sum[1] + sum[5]) + (sum[3] + sum[7]));
}
