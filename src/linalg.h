/* The linear-algebra seam: everything that may come from a BLAS/LAPACK. Column-major, raw pointers, no allocation after prepare().
 *
 * A backend is one constant table; the build chooses which (AST_LINALG), the logic never asks. Every routine returns 0, or
 * non-zero when the backend could not compute it. */
#ifndef AST_LINALG_H
#define AST_LINALG_H

#include <stddef.h>

#include "real.h"

struct ast_linalg {
    const char *name;

    /* Once per ast_init: whatever the backend would otherwise allocate or create at its first call. */
    int (*prepare)(void);

    /* c = a' b: a is depth x rows (lda), b depth x cols (ldb), c rows x cols (ldc). */
    int (*product)(int rows, int cols, int depth, const float *a, int lda, const float *b, int ldb, float *c, int ldc);
    /* The same in ast_real. */
    int (*product_real)(int rows, int cols, int depth, const ast_real *a, int lda, const ast_real *b, int ldb, ast_real *c,
                        int ldc);

    /* ast_real elements of workspace that svd wants for a rows x cols matrix. */
    size_t (*svd_work)(int rows, int cols);
    /* Thin singular value decomposition of a (rows x cols, leading dimension rows). values: min(rows, cols), descending. With
     * vectors != 0 the first min(rows, cols) columns of a become the left singular vectors (those of zero values are undefined),
     * otherwise a is destroyed. */
    int (*svd)(int rows, int cols, ast_real *a, int vectors, ast_real *values, ast_real *work, size_t work_count);
};

/* Which of the two is linked is the build's choice. */
extern const struct ast_linalg ast_linalg_builtin;
extern const struct ast_linalg ast_linalg_lapacke;

#endif
