/* Linear algebra in portable C99: the backend without dependencies. Sums are taken in a fixed order, so that a build without
 * floating-point contraction gives the same bits on every machine. */
#include "linalg.h"

#include <string.h>

#include "kernels.h"

static int prepare(void) {
    return 0;
}

/* c[i * step_i + j * step_j] = a_i'b_j, the columns of a in lanes. */
static void lanes_product(int rows, int cols, int depth, const float *a, size_t lda, const float *b, size_t ldb, float *c,
                          size_t step_i, size_t step_j) {
    enum { CHUNK = 24 }; /* columns whose sums are kept beside c where c cannot take whole panels */
    const struct ast_kernels *kernels = ast_kernels();
    AST_LANES_ALIGNED float panel[AST_PANEL_DEPTH * AST_LANES];
    float sums[CHUNK * AST_LANES];

    for (int j = 0; j < cols; j++)
        for (int i = 0; i < rows; i++) c[(size_t)i * step_i + (size_t)j * step_j] = 0.0f;

    for (int i = 0; i < rows; i += AST_LANES) {
        const int lanes = rows - i < AST_LANES ? rows - i : AST_LANES;
        for (int d = 0; d < depth; d += AST_PANEL_DEPTH) {
            const int part = depth - d < AST_PANEL_DEPTH ? depth - d : AST_PANEL_DEPTH;
            kernels->pack(panel, a + (size_t)i * lda + d, lda, lanes, part);
            if (step_i == 1 && lanes == AST_LANES) {
                kernels->panel_product(panel, part, b + d, ldb, cols, c + i, step_j);
                continue;
            }
            for (int j = 0; j < cols; j += CHUNK) {
                const int used = cols - j < CHUNK ? cols - j : CHUNK;
                memset(sums, 0, sizeof sums);
                kernels->panel_product(panel, part, b + (size_t)j * ldb + d, ldb, used, sums, AST_LANES);
                for (int q = 0; q < used; q++)
                    for (int l = 0; l < lanes; l++)
                        c[(size_t)(i + l) * step_i + (size_t)(j + q) * step_j] += sums[q * AST_LANES + l];
            }
        }
    }
}

/* What packing a panel costs, in columns against which it is multiplied. */
static int panels_cost(int in_lanes, int others) {
    enum { PACKING = 16 };
    return (in_lanes + AST_LANES - 1) / AST_LANES * (others + PACKING);
}

/* Either operand may be in the lanes: the products commute, and the order of each sum is the same. */
static int product(int rows, int cols, int depth, const float *a, int lda, const float *b, int ldb, float *c, int ldc) {
    if (panels_cost(rows, cols) <= panels_cost(cols, rows))
        lanes_product(rows, cols, depth, a, (size_t)lda, b, (size_t)ldb, c, 1, (size_t)ldc);
    else
        lanes_product(cols, rows, depth, b, (size_t)ldb, a, (size_t)lda, c, (size_t)ldc, 1);
    return 0;
}

static ast_real dot(const ast_real *x, const ast_real *y, int n) {
    enum { LANES = 8 };
    ast_real sum[LANES] = {0};
    int d = 0;
    for (; d + LANES <= n; d += LANES)
        for (int l = 0; l < LANES; l++) sum[l] += x[d + l] * y[d + l];
    for (; d < n; d++) sum[0] += x[d] * y[d];
    return ((sum[0] + sum[4]) + (sum[2] + sum[6])) + ((sum[1] + sum[5]) + (sum[3] + sum[7]));
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
