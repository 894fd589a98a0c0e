/* Linear algebra in portable C99: the backend without dependencies. Sums are taken in a fixed order, so that a build without
 * floating-point contraction gives the same bits on every machine. */
#include "linalg.h"

#include "product.h"
#include "total.h"

static int prepare(void) {
    return 0;
}

static int product(int rows, int cols, int depth, const float *a, int lda, const float *b, int ldb, float *c, int ldc) {
    ast_product(rows, cols, depth, a, lda, b, ldb, c, ldc);
    return 0;
}

static ast_real dot(const ast_real *x, const ast_real *y, int n) {
    enum { SUMS = 8 };
    ast_real sum[SUMS] = {0};
    int d = 0;
    for (; d + SUMS <= n; d += SUMS)
        for (int s = 0; s < SUMS; s++) sum[s] += x[d + s] * y[d + s];
    for (; d < n; d++) sum[0] += x[d] * y[d];
    return total_of_eight(sum);
}

static int product_real(int rows, int cols, int depth, const ast_real *a, int lda, const ast_real *b, int ldb, ast_real *c,
                        int ldc) {
    for (int j = 0; j < cols; j++)
        for (int i = 0; i < rows; i++)
            c[(size_t)j * (size_t)ldc + (size_t)i] = dot(a + (size_t)i * (size_t)lda, b + (size_t)j * (size_t)ldb, depth);
    return 0;
}

static size_t svd_work(int rows, int cols) {
    (void)rows;
    return (size_t)cols;
}

static void swap_columns(ast_real *x, ast_real *y, int n) {
    for (int d = 0; d < n; d++) {
        const ast_real keep = x[d];
        x[d] = y[d];
        y[d] = keep;
    }
}

/* One-sided Jacobi (Hestenes): rotate pairs of columns until all are orthogonal; their norms are then the singular values. It finds
 * small singular values to high relative accuracy, which the rank rule needs. */
static int svd(int rows, int cols, ast_real *a, int vectors, ast_real *values, ast_real *work, size_t work_count) {
    enum { SWEEPS = 40 };
    const ast_real tolerance = 4 * ast_real_epsilon();
    ast_real *square = work; /* squared column norms */

    if (work_count < (size_t)cols) return -1;
    for (int j = 0; j < cols; j++) {
        const ast_real *column = a + (size_t)j * (size_t)rows;
        square[j] = dot(column, column, rows);
    }
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        int rotations = 0;
        for (int p = 0; p + 1 < cols; p++) {
            for (int q = p + 1; q < cols; q++) {
                ast_real *x = a + (size_t)p * (size_t)rows, *y = a + (size_t)q * (size_t)rows;
                const ast_real cross = dot(x, y, rows);
                if (ast_fabs(cross) <= tolerance * ast_sqrt(square[p]) * ast_sqrt(square[q])) continue;
                rotations++;
                const ast_real zeta = (square[q] - square[p]) / (2 * cross);
                const ast_real t = (zeta < 0 ? -1 : 1) / (ast_fabs(zeta) + ast_sqrt(1 + zeta * zeta));
                const ast_real c = 1 / ast_sqrt(1 + t * t), s = c * t;
                for (int d = 0; d < rows; d++) {
                    const ast_real keep = x[d];
                    x[d] = c * keep - s * y[d];
                    y[d] = s * keep + c * y[d];
                }
                square[p] = dot(x, x, rows);
                square[q] = dot(y, y, rows);
            }
        }
        if (rotations == 0) break;
    }

    const int count = rows < cols ? rows : cols;
    for (int j = 0; j < count; j++) {
        int largest = j;
        for (int q = j + 1; q < cols; q++)
            if (square[q] > square[largest]) largest = q;
        if (largest != j) {
            const ast_real keep = square[j];
            square[j] = square[largest];
            square[largest] = keep;
            swap_columns(a + (size_t)j * (size_t)rows, a + (size_t)largest * (size_t)rows, rows);
        }
        values[j] = ast_sqrt(square[j]);
        if (vectors && values[j] > 0) {
            ast_real *column = a + (size_t)j * (size_t)rows;
            for (int d = 0; d < rows; d++) column[d] /= values[j];
        }
    }
    return 0;
}

const struct ast_linalg ast_linalg_builtin = {"builtin", prepare, product, product_real, svd_work, svd};
