/* Inner products of vectors, in eight independent sums that a compiler can hold side by side without reordering any of them. */
#include "total.h"

static ast_real dot(const float *x, const float *y, int n) {
    enum { SUMS = 8 };
    ast_real sum[SUMS] = {0};
    int d = 0;
#if AST_HAS_VECTORS
    for (; d + SUMS <= n; d += SUMS)
        for (int l = 0; l < SUMS; l++) sum[l] += (ast_real)x[d + l] * (ast_real)y[d + l];
#else
    for (int l = 0; l < SUMS; l += 4) { /* four of them in registers */
        ast_real p = 0, q = 0, r = 0, s = 0;
        for (d = 0; d + SUMS <= n; d += SUMS) {
            p += (ast_real)x[d + l] * (ast_real)y[d + l];
            q += (ast_real)x[d + l + 1] * (ast_real)y[d + l + 1];
            r += (ast_real)x[d + l + 2] * (ast_real)y[d + l + 2];
            s += (ast_real)x[d + l + 3] * (ast_real)y[d + l + 3];
        }
        sum[l] = p;
        sum[l + 1] = q;
        sum[l + 2] = r;
        sum[l + 3] = s;
    }
#endif
    for (; d < n; d++) sum[0] += (ast_real)x[d] * (ast_real)y[d];
    return total_of_eight(sum);
}
