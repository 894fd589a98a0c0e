#include "vector.h"

ast_real ast_dot(const float *x, const float *y, int n) {
    enum { LANES = 8 }; /* independent sums, so that a compiler can vectorise without reordering any of them */
    ast_real sum[LANES] = {0};
    int d = 0;
    for (; d + LANES <= n; d += LANES)
        for (int l = 0; l < LANES; l++) sum[l] += (ast_real)x[d + l] * (ast_real)y[d + l];
    for (; d < n; d++) sum[0] += (ast_real)x[d] * (ast_real)y[d];
    return ((sum[0] + sum[4]) + (sum[2] + sum[6])) + ((sum[1] + sum[5]) + (sum[3] + sum[7]));
}
