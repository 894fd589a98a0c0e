#include "support_faulty.h"

static const struct ast_linalg *worker;
static int calls, failing, prepare_failing;

void faulty_arm(const struct ast_linalg *behind, int fail_at) {
    worker = behind;
    failing = fail_at;
    calls = 0;
    prepare_failing = 0;
}

int faulty_calls(void) {
    return calls;
}

void faulty_prepare_fails(int fails) {
    prepare_failing = fails;
}

static int fails_now(void) {
    return ++calls == failing;
}

static int prepare(void) {
    return prepare_failing ? -1 : worker->prepare();
}

static int product(int rows, int cols, int depth, const float *a, int lda, const float *b, int ldb, float *c, int ldc) {
    if (!fails_now()) return worker->product(rows, cols, depth, a, lda, b, ldb, c, ldc);
    for (int j = 0; j < cols; j++)
        for (int i = 0; i < rows; i++) c[(size_t)j * (size_t)ldc + (size_t)i] = NAN;
    return -1;
}

static int product_real(int rows, int cols, int depth, const ast_real *a, int lda, const ast_real *b, int ldb, ast_real *c,
                        int ldc) {
    if (!fails_now()) return worker->product_real(rows, cols, depth, a, lda, b, ldb, c, ldc);
    for (int j = 0; j < cols; j++)
        for (int i = 0; i < rows; i++) c[(size_t)j * (size_t)ldc + (size_t)i] = (ast_real)NAN;
    return -1;
}

static size_t svd_work(int rows, int cols) {
    return worker->svd_work(rows, cols);
}

static int svd(int rows, int cols, ast_real *a, int vectors, ast_real *values, ast_real *work, size_t work_count) {
    if (!fails_now()) return worker->svd(rows, cols, a, vectors, values, work, work_count);
    for (int i = 0; i < rows * cols; i++) a[i] = (ast_real)NAN;
    for (int i = 0; i < rows && i < cols; i++) values[i] = (ast_real)NAN;
    return 7; /* LAPACK reports what did not converge as a positive number */
}

const struct ast_linalg faulty_linalg = {"faulty", prepare, product, product_real, svd_work, svd};
