/* Every backend that is linked here, each by itself against definitions and all against each other. */
#include "linalg.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "asttrack.h"
#include "backend.h"
#include "support_backends.h"
#include "support_matrix.h"
#include "unity.h"

static char label[240];

void tearDown(void) {
}

static ast_real *reals(size_t count) {
    ast_real *x = malloc((count + 1) * sizeof *x);
    TEST_ASSERT_NOT_NULL(x);
    return x;
}

static void test_the_build_names_its_backend(void) {
    TEST_ASSERT_EQUAL_STRING("builtin", ast_linalg_builtin.name);
#ifdef AST_TEST_LAPACKE
    TEST_ASSERT_EQUAL_STRING("lapacke", ast_linalg_lapacke.name);
#endif
    TEST_ASSERT_EQUAL_STRING(ast_default_linalg()->name, ast_backend());
}

/* ---- Products ---- */

/* Sizes on both sides of every block that a product could work in. */
static const int row_counts[] = {1, 2, 7, 8, 9, 16, 33}, column_counts[] = {1, 3, 4, 5, 12, 32},
                 depths[] = {1, 2, 63, 64, 65, 256, 1023};
#define LENGTH(array) ((int)(sizeof(array) / sizeof(array)[0]))

static void check_product(const struct ast_linalg *la, int rows, int cols, int depth, int pad) {
    struct noise noise = {(uint64_t)(rows + 100 * cols + 10000 * depth)};
    const int lda = depth + pad, ldb = depth + 2 * pad, ldc = rows + pad;
    float *a = malloc((size_t)lda * (size_t)rows * sizeof *a), *b = malloc((size_t)ldb * (size_t)cols * sizeof *b);
    float *c = malloc((size_t)ldc * (size_t)cols * sizeof *c);
    TEST_ASSERT_TRUE(a != NULL && b != NULL && c != NULL);
    for (int i = 0; i < lda * rows; i++) a[i] = i % lda < depth ? (float)noise_normal(&noise) : NAN;
    for (int i = 0; i < ldb * cols; i++) b[i] = i % ldb < depth ? (float)noise_normal(&noise) : NAN;
    for (int i = 0; i < ldc * cols; i++) c[i] = i % ldc < rows ? NAN : 42.0f;

    TEST_ASSERT_EQUAL_INT(0, la->product(rows, cols, depth, a, lda, b, ldb, c, ldc));
    snprintf(label, sizeof label, "%s: %d x %d, depth %d, padding %d", la->name, rows, cols, depth, pad);
    for (int j = 0; j < cols; j++) {
        for (int i = 0; i < rows; i++) {
            double exact = 0, size = 0;
            for (int d = 0; d < depth; d++) {
                const double term = (double)a[i * lda + d] * (double)b[j * ldb + d];
                exact += term;
                size += fabs(term);
            }
            /* Far below depth x epsilon: the sums are blocked. */
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE((double)FLT_EPSILON * (1 + 0.02 * depth) * size, exact, (double)c[j * ldc + i],
                                              label);
        }
        for (int i = rows; i < ldc; i++) TEST_ASSERT_EQUAL_FLOAT_MESSAGE(42.0f, c[j * ldc + i], label);
    }
    free(a);
    free(b);
    free(c);
}

static void test_product(void) {
    for (int backend = 0; backend < BACKENDS; backend++)
        for (int r = 0; r < LENGTH(row_counts); r++)
            for (int c = 0; c < LENGTH(column_counts); c++)
                for (int d = 0; d < LENGTH(depths); d++)
                    check_product(backends[backend], row_counts[r], column_counts[c], depths[d], (r + c + d) % 2 * 3);
}

static void check_product_real(const struct ast_linalg *la, int rows, int cols, int depth, int pad) {
    struct noise noise = {(uint64_t)(rows + 100 * cols + 10000 * depth)};
    const int lda = depth + pad, ldb = depth + 2 * pad, ldc = rows + pad;
    ast_real *a = reals((size_t)lda * (size_t)rows), *b = reals((size_t)ldb * (size_t)cols), *c = reals((size_t)ldc * (size_t)cols);
    for (int i = 0; i < lda * rows; i++) a[i] = i % lda < depth ? (ast_real)noise_normal(&noise) : (ast_real)NAN;
    for (int i = 0; i < ldb * cols; i++) b[i] = i % ldb < depth ? (ast_real)noise_normal(&noise) : (ast_real)NAN;
    for (int i = 0; i < ldc * cols; i++) c[i] = i % ldc < rows ? (ast_real)NAN : 42;

    TEST_ASSERT_EQUAL_INT(0, la->product_real(rows, cols, depth, a, lda, b, ldb, c, ldc));
    snprintf(label, sizeof label, "%s: %d x %d, depth %d, padding %d", la->name, rows, cols, depth, pad);
    for (int j = 0; j < cols; j++) {
        for (int i = 0; i < rows; i++) {
            long double exact = 0, size = 0;
            for (int d = 0; d < depth; d++) {
                const long double term = (long double)a[i * lda + d] * (long double)b[j * ldb + d];
                exact += term;
                size += fabsl(term);
            }
            const double slack = (double)ast_real_epsilon() * (1 + 0.2 * depth) * (double)size;
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(slack, (double)exact, c[j * ldc + i], label);
        }
        for (int i = rows; i < ldc; i++) TEST_ASSERT_EQUAL_DOUBLE_MESSAGE(42, c[j * ldc + i], label);
    }
    free(a);
    free(b);
    free(c);
}

static void test_product_real(void) {
    static const int sides[] = {1, 2, 5, 8}, lengths[] = {1, 7, 8, 9, 31, 256, 1021};
    for (int backend = 0; backend < BACKENDS; backend++)
        for (int r = 0; r < LENGTH(sides); r++)
            for (int c = 0; c < LENGTH(sides); c++)
                for (int d = 0; d < LENGTH(lengths); d++)
                    check_product_real(backends[backend], sides[r], sides[c], lengths[d], (r + c + d) % 2 * 3);
}

/* ---- Singular value decomposition ---- */

/* A matrix to decompose; expected: its singular values descending, or NULL. */
struct problem {
    char name[80];
    int rows, cols;
    double *a, *expected;
};

enum { MOST_PROBLEMS = 64 };
static struct problem problems[MOST_PROBLEMS];
static int problem_count;

static struct problem *add_problem(const char *kind, int rows, int cols) {
    TEST_ASSERT_LESS_THAN_INT(MOST_PROBLEMS, problem_count);
    struct problem *problem = &problems[problem_count++];
    snprintf(problem->name, sizeof problem->name, "%s, %d x %d", kind, rows, cols);
    problem->rows = rows;
    problem->cols = cols;
    problem->a = matrix_new(rows, cols);
    problem->expected = NULL;
    return problem;
}

/* As many of these singular values as there is room for. */
static void add_problem_with(struct noise *noise, const char *kind, int rows, int cols, const double *values, int count) {
    const int room = rows < cols ? rows : cols;
    struct problem *problem = add_problem(kind, rows, cols);
    problem->expected = matrix_new(room, 1);
    memcpy(problem->expected, values, (size_t)(count < room ? count : room) * sizeof *values);
    matrix_with_singular_values(noise, rows, cols, room, problem->expected, problem->a);
}

static void make_problems(void) {
    /* image sets, products of bases, and shapes that are only just legal */
    static const int shapes[][2] = {{256, 4}, {1024, 6}, {37, 16}, {16, 16}, {3, 3}, {8, 8},
                                    {3, 7},   {2, 10},   {1, 5},   {5, 1},   {1, 1}};
    static const double ill[] = {1, 0.5, 1e-3, 1e-6, 1e-9, 1e-12}, deficient[] = {3, 1, 0.25}, repeated[] = {2, 2, 2, 2, 1, 1, 1},
                        cosines[] = {1, 1, 1 - 1e-9, 0.5, 1e-4, 0, 0, 0}, large[] = {1e12, 1e11, 1e10}, tiny[] = {1e-12, 1e-13},
                        zero[] = {0};
    struct noise noise = {5};
    for (int s = 0; s < LENGTH(shapes); s++) {
        const int rows = shapes[s][0], cols = shapes[s][1];
        struct problem *random = add_problem("random", rows, cols);
        noise_fill_normal(&noise, random->a, (size_t)rows * (size_t)cols);
        add_problem_with(&noise, "ill-conditioned", rows, cols, ill, LENGTH(ill));
        add_problem_with(&noise, "rank-deficient", rows, cols, deficient, LENGTH(deficient));
    }
    add_problem_with(&noise, "repeated", 40, 7, repeated, LENGTH(repeated));
    add_problem_with(&noise, "cosines", 8, 8, cosines, LENGTH(cosines));
    add_problem_with(&noise, "large", 64, 3, large, LENGTH(large));
    add_problem_with(&noise, "tiny", 64, 3, tiny, LENGTH(tiny));
    add_problem_with(&noise, "zero", 50, 4, zero, 1);
    add_problem_with(&noise, "zero", 2, 5, zero, 1);

    struct problem *equal = add_problem("equal columns", 100, 5);
    for (int i = 0; i < 500; i++) equal->a[i] = i < 100 ? noise_uniform(&noise) : equal->a[i % 100];
    struct problem *one_zero = add_problem("a zero column among others", 60, 4);
    noise_fill_normal(&noise, one_zero->a, 240);
    memset(one_zero->a + 60, 0, 60 * sizeof *one_zero->a);
    struct problem *orthogonal = add_problem("orthogonal columns, ascending", 30, 4);
    matrix_orthonormal(&noise, 30, 4, orthogonal->a);
    for (int i = 0; i < 120; i++) orthogonal->a[i] *= 1 + i / 30;
}

void setUp(void) {
    TEST_ASSERT_EQUAL_INT(0, backends_prepare());
    if (problem_count == 0) make_problems();
}

static void free_problems(void) {
    for (int p = 0; p < problem_count; p++) {
        free(problems[p].a);
        free(problems[p].expected);
    }
}

struct decomposition {
    ast_real *vectors; /* rows x cols, as svd left them */
    double *values;
};

static struct decomposition decompose(const struct ast_linalg *la, const struct problem *problem, int vectors) {
    const size_t elements = (size_t)problem->rows * (size_t)problem->cols, work_count = la->svd_work(problem->rows, problem->cols);
    const int room = problem->rows < problem->cols ? problem->rows : problem->cols;
    ast_real *values = reals((size_t)room), *work = reals(work_count);
    struct decomposition result = {reals(elements), matrix_new(room, 1)};
    TEST_ASSERT_GREATER_THAN_UINT(0, work_count);
    for (size_t i = 0; i < elements; i++) result.vectors[i] = (ast_real)problem->a[i];
    for (size_t i = 0; i < work_count; i++) work[i] = (ast_real)NAN;
    for (int l = 0; l < room; l++) values[l] = (ast_real)NAN;
    values[room] = work[work_count] = result.vectors[elements] = 42;
    snprintf(label, sizeof label, "%s: %.79s", la->name, problem->name);

    TEST_ASSERT_EQUAL_INT_MESSAGE(0, la->svd(problem->rows, problem->cols, result.vectors, vectors, values, work, work_count),
                                  label);
    TEST_ASSERT_EQUAL_DOUBLE_MESSAGE(42, values[room], label);
    TEST_ASSERT_EQUAL_DOUBLE_MESSAGE(42, work[work_count], label);
    TEST_ASSERT_EQUAL_DOUBLE_MESSAGE(42, result.vectors[elements], label);
    for (int l = 0; l < room; l++) result.values[l] = (double)values[l];
    free(values);
    free(work);
    return result;
}

static void release(struct decomposition *result) {
    free(result->vectors);
    free(result->values);
}

/* Values above the rounding of the largest: only their vectors are defined. */
static int numerical_rank(const double *values, int room) {
    int rank = 0;
    while (rank < room && values[rank] > 1e4 * (double)ast_real_epsilon() * values[0]) rank++;
    return rank;
}

/* All that defines left singular vectors: U'U = I, U'A has orthogonal rows of lengths `values`, and no more of A is left. */
static void check_vectors(const struct problem *problem, const struct decomposition *result) {
    const int rows = problem->rows, cols = problem->cols, room = rows < cols ? rows : cols;
    const int rank = numerical_rank(result->values, room);
    if (rank == 0) return;
    double *u = matrix_new(rows, rank), *along = matrix_new(rank, cols), *across = matrix_new(cols, rank),
           *gram = matrix_new(rank, rank);
    double *explained = matrix_new(rows, cols);
    for (size_t i = 0; i < (size_t)rows * (size_t)rank; i++) u[i] = (double)result->vectors[i];
    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(200 * ast_real_epsilon() * result->values[0] / result->values[rank - 1], 0,
                                      matrix_orthonormality_error(rows, rank, u), label);

    matrix_product_transposed(rank, cols, rows, u, problem->a, along);
    for (int j = 0; j < cols; j++)
        for (int l = 0; l < rank; l++) across[l * cols + j] = along[j * rank + l];
    matrix_product_transposed(rank, rank, cols, across, across, gram);
    const double slack = 200 * ast_real_epsilon() * result->values[0];
    for (int j = 0; j < rank; j++)
        for (int i = 0; i < rank; i++)
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(slack * (result->values[i] + result->values[j]),
                                              i == j ? result->values[i] * result->values[i] : 0, gram[j * rank + i], label);

    matrix_product(rows, cols, rank, u, along, explained);
    for (size_t i = 0; i < (size_t)rows * (size_t)cols; i++)
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(2e4 * ast_real_epsilon() * result->values[0], problem->a[i], explained[i], label);
    free(u);
    free(along);
    free(across);
    free(gram);
    free(explained);
}

static void test_svd(void) {
    for (int b = 0; b < BACKENDS; b++) {
        for (int p = 0; p < problem_count; p++) {
            const struct problem *problem = &problems[p];
            const int room = problem->rows < problem->cols ? problem->rows : problem->cols;
            struct decomposition result = decompose(backends[b], problem, 1), alone = decompose(backends[b], problem, 0);
            const double slack = 100 * ast_real_epsilon() * (result.values[0] + 1e-300);
            for (int l = 0; l < room; l++) {
                TEST_ASSERT_TRUE_MESSAGE(result.values[l] >= 0, label);
                TEST_ASSERT_TRUE_MESSAGE(l == 0 || result.values[l - 1] >= result.values[l], label);
                TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(slack, result.values[l], alone.values[l], label);
                if (problem->expected != NULL)
                    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(slack, problem->expected[l], result.values[l], label);
            }
            check_vectors(problem, &result);
            release(&result);
            release(&alone);
        }
    }
}

/* Nothing may be left to chance in a workspace that is too small. */
static void test_svd_refuses_a_small_workspace(void) {
    for (int b = 0; b < BACKENDS; b++) {
        ast_real a[64 * 4], values[4], work[1];
        struct noise noise = {6};
        for (int i = 0; i < 64 * 4; i++) a[i] = (ast_real)noise_normal(&noise);
        TEST_ASSERT_TRUE(backends[b]->svd(64, 4, a, 1, values, work, 1) != 0);
    }
}

/* The directions that a basis takes come from differences of patches: many small values far above rounding. Both backends must give
 * them, and the same subspaces. */
static void test_lapacke_and_builtin_agree(void) {
#ifdef AST_TEST_LAPACKE
    for (int p = 0; p < problem_count; p++) {
        const struct problem *problem = &problems[p];
        const int rows = problem->rows, room = rows < problem->cols ? rows : problem->cols;
        struct decomposition one = decompose(&ast_linalg_builtin, problem, 1), other = decompose(&ast_linalg_lapacke, problem, 1);
        snprintf(label, sizeof label, "builtin and lapacke: %.79s", problem->name);
        const double slack = 100 * ast_real_epsilon() * (one.values[0] + 1e-300);
        for (int l = 0; l < room; l++) TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(slack, one.values[l], other.values[l], label);
        /* A leading subspace is defined where a gap ends it: then the cosines between the two are 1, and so is each row of U'V. */
        for (int l = 0; l < numerical_rank(one.values, room); l++) {
            const double gap = (one.values[l] - (l + 1 < room ? one.values[l + 1] : 0)) / one.values[0];
            if (gap < 1e-6) continue;
            for (int i = 0; i <= l; i++) {
                double square = 0;
                for (int j = 0; j <= l; j++) {
                    double along = 0;
                    for (int d = 0; d < rows; d++) along += (double)one.vectors[i * rows + d] * (double)other.vectors[j * rows + d];
                    square += along * along;
                }
                TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-12 / gap, 1, square, label);
            }
        }
        release(&one);
        release(&other);
    }

    struct noise noise = {7};
    static float a[1024 * 33], b[1024 * 32], one[33 * 32], other[33 * 32];
    noise_fill(&noise, a, 1024 * 33, -1, 1);
    noise_fill(&noise, b, 1024 * 32, -1, 1);
    TEST_ASSERT_EQUAL_INT(0, ast_linalg_builtin.product(33, 32, 1024, a, 1024, b, 1024, one, 33));
    TEST_ASSERT_EQUAL_INT(0, ast_linalg_lapacke.product(33, 32, 1024, a, 1024, b, 1024, other, 33));
    for (int i = 0; i < 33 * 32; i++) TEST_ASSERT_FLOAT_WITHIN(2e-5f, one[i], other[i]);
#else
    TEST_IGNORE_MESSAGE("lapacke not compared with builtin: this build is without OpenBLAS and LAPACKE");
#endif
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_the_build_names_its_backend);
    RUN_TEST(test_product);
    RUN_TEST(test_product_real);
    RUN_TEST(test_svd);
    RUN_TEST(test_svd_refuses_a_small_workspace);
    RUN_TEST(test_lapacke_and_builtin_agree);
    const int failures = UNITY_END();
    free_problems();
    return failures;
}
