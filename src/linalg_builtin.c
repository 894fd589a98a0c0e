/* Linear algebra in portable C99: the backend without dependencies. Sums are taken in a fixed order, so that a build without
 * floating-point contraction gives the same bits on every machine. */
#include "linalg.h"

/* The product works on panels: LANES columns of a against COLS columns of b, both interleaved over DEPTH elements. The innermost
 * loops run over independent sums in contiguous memory, which compilers vectorise without reassociating any of them; summing DEPTH
 * elements at a time keeps the rounding error well below that of one long sum. */
enum { LANES = 8, COLS = 4, DEPTH = 64 };

static int prepare(void) {
    return 0;
}

/* Columns 0 .. used - 1 of m, interleaved width at a time; the rest of the panel repeats column 0 and is never read back. */
static void pack(float *panel, int width, const float *m, int ld, int used, int depth) {
    for (int l = 0; l < width; l++) {
        const float *column = m + (size_t)(l < used ? l : 0) * (size_t)ld;
        for (int d = 0; d < depth; d++) panel[d * width + l] = column[d];
    }
}

static void panel_product(const float *a, const float *b, int depth, float *sum) {
    float s[COLS][LANES] = {{0}};
    for (int d = 0; d < depth; d++)
        for (int q = 0; q < COLS; q++)
            for (int l = 0; l < LANES; l++) s[q][l] += a[LANES * d + l] * b[COLS * d + q];
    for (int q = 0; q < COLS; q++)
        for (int l = 0; l < LANES; l++) sum[LANES * q + l] = s[q][l];
}

static int product(int rows, int cols, int depth, const float *a, int lda, const float *b, int ldb, float *c, int ldc) {
    float panel_a[DEPTH * LANES], panel_b[DEPTH * COLS], sum[COLS * LANES];

    for (int j = 0; j < cols; j++)
        for (int i = 0; i < rows; i++) c[(size_t)j * (size_t)ldc + (size_t)i] = 0.0f;

    for (int i = 0; i < rows; i += LANES) {
        const int lanes = rows - i < LANES ? rows - i : LANES;
        for (int d = 0; d < depth; d += DEPTH) {
            const int part = depth - d < DEPTH ? depth - d : DEPTH;
            pack(panel_a, LANES, a + (size_t)i * (size_t)lda + d, lda, lanes, part);
            for (int j = 0; j < cols; j += COLS) {
                const int used = cols - j < COLS ? cols - j : COLS;
                pack(panel_b, COLS, b + (size_t)j * (size_t)ldb + d, ldb, used, part);
                panel_product(panel_a, panel_b, part, sum);
                for (int q = 0; q < used; q++) {
                    float *out = c + (size_t)(j + q) * (size_t)ldc + (size_t)i;
                    for (int l = 0; l < lanes; l++) out[l] += sum[LANES * q + l];
                }
            }
        }
    }
    return 0;
}

static ast_real dot(const ast_real *x, const ast_real *y, int n) {
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
