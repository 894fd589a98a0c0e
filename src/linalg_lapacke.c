/* Linear algebra by OpenBLAS and LAPACKE. Only *_work calls, column-major: the high-level and the row-major ones allocate. */
#include "linalg.h"

#include "build.h"

#ifndef AST_NO_LAPACKE
#include <cblas.h>
#include <lapacke.h>

/* The small problems are handed over as they are; LAPACKE is not used in single-precision builds. */
typedef char ast_real_must_be_double[sizeof(ast_real) == sizeof(double) ? 1 : -1];

static int product(int rows, int cols, int depth, const float *a, int lda, const float *b, int ldb, float *c, int ldc) {
    cblas_sgemm(CblasColMajor, CblasTrans, CblasNoTrans, rows, cols, depth, 1.0f, a, lda, b, ldb, 0.0f, c, ldc);
    return 0;
}

/* OpenBLAS splits large products over threads, which would make sums depend on the number of cores, and takes its buffer at the
 * first call that needs one: not a small product, but any triangular solve. One thread for the process, and the buffer now, so that
 * ast_step neither varies nor allocates. */
static int prepare(void) {
    const float one[1] = {1.0f};
    float solution[1] = {1.0f};
    openblas_set_num_threads(1);
    cblas_strsm(CblasColMajor, CblasLeft, CblasUpper, CblasNoTrans, CblasNonUnit, 1, 1, 1.0f, one, 1, solution, 1);
    return solution[0] == 1.0f ? 0 : -1;
}

static int product_real(int rows, int cols, int depth, const ast_real *a, int lda, const ast_real *b, int ldb, ast_real *c,
                        int ldc) {
    cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, rows, cols, depth, 1.0, a, lda, b, ldb, 0.0, c, ldc);
    return 0;
}

static size_t svd_work(int rows, int cols) {
    double best = 0, unused = 0;
    const int ld = rows > 1 ? rows : 1;
    if (LAPACKE_dgesvd_work(LAPACK_COL_MAJOR, 'O', 'N', rows, cols, &unused, ld, &unused, &unused, 1, &unused, 1, &best, -1) != 0)
        return 0;
    return (size_t)best;
}

static int svd(int rows, int cols, ast_real *a, int vectors, ast_real *values, ast_real *work, size_t work_count) {
    double unused = 0;
    const int ld = rows > 1 ? rows : 1;
    return (int)LAPACKE_dgesvd_work(LAPACK_COL_MAJOR, vectors ? 'O' : 'N', 'N', rows, cols, a, ld, values, &unused, 1, &unused, 1,
                                    work, (lapack_int)work_count);
}

const struct ast_linalg ast_linalg_lapacke = {"lapacke", prepare, product, product_real, svd_work, svd};
#endif
