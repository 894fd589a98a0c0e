#include "product.h"

#include <string.h>

#include "kernels.h"

/* c[i * step_i + j * step_j] = a_i'b_j, the columns of a in lanes. */
static void lanes_product(int rows, int cols, int depth, const float *a, size_t lda, const float *b, size_t ldb, float *c,
                          size_t step_i, size_t step_j) {
    enum { CHUNK = 12 }; /* columns whose sums are kept beside c where c cannot take whole panels */
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
void ast_product(int rows, int cols, int depth, const float *a, int lda, const float *b, int ldb, float *c, int ldc) {
    if (panels_cost(rows, cols) <= panels_cost(cols, rows)) {
        lanes_product(rows, cols, depth, a, (size_t)lda, b, (size_t)ldb, c, 1, (size_t)ldc);
    } else {
        /* NOLINTNEXTLINE(readability-suspicious-call-argument): swapped on purpose */
        lanes_product(cols, rows, depth, b, (size_t)ldb, a, (size_t)lda, c, (size_t)ldc, 1);
    }
}
