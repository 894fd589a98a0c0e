#include "eigen.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support_matrix.h"
#include "unity.h"

void setUp(void) {
}
void tearDown(void) {
}

enum { LARGEST = 16 }; /* a candidate's set has at most so many images */

/* a = q diag(values) q', q random orthogonal. */
static void symmetric_with_eigenvalues(struct noise *noise, int n, const double *values, double *a) {
    double q[LARGEST * LARGEST], scaled[LARGEST * LARGEST], transposed[LARGEST * LARGEST];
    matrix_orthonormal(noise, n, n, q);
    for (int j = 0; j < n; j++) {
        for (int i = 0; i < n; i++) {
            scaled[j * n + i] = q[j * n + i] * values[j];
            transposed[i * n + j] = q[j * n + i];
        }
    }
    matrix_product(n, n, n, scaled, transposed, a);
    for (int j = 0; j < n; j++)
        for (int i = 0; i < j; i++) a[j * n + i] = a[i * n + j];
}

/* Decomposes a copy of a, and checks everything that defines the answer. */
static void check_decomposition(int n, const double *a, ast_real *values, const char *name) {
    ast_real work[LARGEST * LARGEST], vectors[LARGEST * LARGEST];
    double wide[LARGEST * LARGEST], product[LARGEST * LARGEST];
    const double scale = matrix_largest(a, (size_t)n * (size_t)n), slack = 64 * ast_real_epsilon();
    for (int i = 0; i < n * n; i++) work[i] = (ast_real)a[i];
    ast_eigen_symmetric(n, work, values, vectors);

    for (int i = 0; i < n * n; i++) wide[i] = (double)vectors[i];
    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(slack, 0, matrix_orthonormality_error(n, n, wide), name);
    matrix_product(n, n, n, a, wide, product);
    for (int j = 0; j < n; j++) {
        for (int i = 0; i < n; i++)
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(slack * scale * n, (double)values[j] * wide[j * n + i], product[j * n + i], name);
        TEST_ASSERT_TRUE_MESSAGE(j == 0 || values[j - 1] >= values[j], name);
    }

    /* Without vectors: the same values, by another way for 3 x 3. */
    ast_real alone[LARGEST];
    for (int i = 0; i < n * n; i++) work[i] = (ast_real)a[i];
    ast_eigen_symmetric(n, work, alone, NULL);
    for (int i = 0; i < n; i++) {
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(n == 3 ? 1e5 * ast_real_epsilon() * scale : 0, values[i], alone[i], name);
        TEST_ASSERT_TRUE_MESSAGE(i == 0 || alone[i - 1] >= alone[i], name);
    }
}

static void test_random_matrices_of_every_size(void) {
    struct noise noise = {1};
    double a[LARGEST * LARGEST];
    ast_real values[LARGEST];
    char name[80];
    for (int n = 1; n <= LARGEST; n++) {
        for (int trial = 0; trial < 20; trial++) {
            for (int j = 0; j < n; j++)
                for (int i = 0; i <= j; i++) a[j * n + i] = a[i * n + j] = noise_normal(&noise);
            snprintf(name, sizeof name, "%d x %d, trial %d", n, n, trial);
            check_decomposition(n, a, values, name);
        }
    }
}

static void test_known_eigenvalues_come_descending(void) {
    static const double spectra[][LARGEST] = {
        {-3, 7, 0.5, 2, -0.25, 11},      /* indefinite, unsorted */
        {2, 2, 2, 2, 2, 2},              /* one value six times */
        {1, 1, 0, 0, 0, 5},              /* semidefinite, repeated */
        {1, 1 + 1e-9, 1 - 1e-9, 3, 0, 0} /* clustered */
    };
    enum { SPECTRA = sizeof spectra / sizeof spectra[0], N = 6 };
    struct noise noise = {2};
    double a[LARGEST * LARGEST];
    ast_real values[LARGEST];
    for (int s = 0; s < SPECTRA; s++) {
        double sorted[N];
        memcpy(sorted, spectra[s], sizeof sorted);
        for (int i = 0; i < N; i++) {
            for (int j = i + 1; j < N; j++) {
                if (sorted[j] > sorted[i]) {
                    const double keep = sorted[i];
                    sorted[i] = sorted[j];
                    sorted[j] = keep;
                }
            }
        }
        symmetric_with_eigenvalues(&noise, N, spectra[s], a);
        check_decomposition(N, a, values, "known eigenvalues");
        for (int i = 0; i < N; i++) TEST_ASSERT_DOUBLE_WITHIN(200 * ast_real_epsilon(), sorted[i], values[i]);
    }
}

/* Squared cosines of two subspaces with three directions each: from all alike to none alike, values equal, nearly equal and far
 * apart, with and without vectors. */
static void test_every_constellation_of_three_eigenvalues(void) {
    static const double gaps[] = {0, 1e-16, 1e-12, 1e-8, 1e-4, 0.01, 0.1, 0.5, 1};
    enum { GAPS = sizeof gaps / sizeof gaps[0] };
    struct noise noise = {5};
    double a[LARGEST * LARGEST];
    ast_real values[LARGEST];
    char name[80];
    for (int i = 0; i < GAPS; i++) {
        for (int j = 0; j < GAPS; j++) {
            for (int trial = 0; trial < 10; trial++) {
                const double most = trial < 5 ? 1 : noise_uniform(&noise);
                const double spectrum[] = {most, most * (1 - gaps[i]), most * (1 - gaps[i]) * (1 - gaps[j])};
                symmetric_with_eigenvalues(&noise, 3, spectrum, a);
                snprintf(name, sizeof name, "1, %g and %g below", gaps[i], gaps[j]);
                check_decomposition(3, a, values, name);
                for (int l = 0; l < 3; l++)
                    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(200 * ast_real_epsilon(), spectrum[l], values[l], name);
            }
        }
    }
}

static void test_a_diagonal_matrix_is_sorted_exactly(void) {
    const double diagonal[] = {0.5, -2, 8, 0, 3};
    const double expected[] = {8, 3, 0.5, 0, -2};
    double a[25] = {0};
    ast_real values[5];
    for (int i = 0; i < 5; i++) a[i * 6] = diagonal[i];
    check_decomposition(5, a, values, "diagonal");
    for (int i = 0; i < 5; i++) TEST_ASSERT_EQUAL_DOUBLE(expected[i], values[i]);
}

/* A diagonal of zeros gives no scale to compare the rest with. */
static void test_zeros_on_the_diagonal(void) {
    const double a[] = {0, 1, 1, 0}, zero[9] = {0};
    ast_real values[3];
    check_decomposition(2, a, values, "exchange");
    TEST_ASSERT_DOUBLE_WITHIN(4 * ast_real_epsilon(), 1, values[0]);
    TEST_ASSERT_DOUBLE_WITHIN(4 * ast_real_epsilon(), -1, values[1]);
    check_decomposition(3, zero, values, "zero");
    for (int i = 0; i < 3; i++) TEST_ASSERT_EQUAL_DOUBLE(0, values[i]);
}

static void test_rank_one_has_one_eigenvalue(void) {
    struct noise noise = {3};
    double v[8], a[64], square = 0;
    ast_real values[8];
    noise_fill_normal(&noise, v, 8);
    for (int j = 0; j < 8; j++) {
        square += v[j] * v[j];
        for (int i = 0; i < 8; i++) a[j * 8 + i] = v[i] * v[j];
    }
    check_decomposition(8, a, values, "rank one");
    TEST_ASSERT_DOUBLE_WITHIN(64 * ast_real_epsilon() * square, square, values[0]);
    for (int i = 1; i < 8; i++) TEST_ASSERT_DOUBLE_WITHIN(64 * ast_real_epsilon() * square, 0, values[i]);
}

/* Scatter matrices are graded: the eigenvalues are squares of singular values, and the rank rule looks at 1e-5 of the largest and
 * below. In d b d, d diagonal and b well-conditioned, each of them is well determined relative to itself. */
static void test_small_eigenvalues_of_a_graded_matrix_keep_their_digits(void) {
    if (sizeof(ast_real) == sizeof(float)) TEST_IGNORE_MESSAGE("not applicable: the grading underflows where ast_real is float");
    const double d[] = {1, 1e-3, 1e-6, 1e-9};
    double a[16];
    ast_real values[4], scaled[4];
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++) a[j * 4 + i] = d[i] * d[j] * (i == j ? 1 : 0.3);
    check_decomposition(4, a, values, "graded");
    /* So steep a grading separates them: eigenvalue i is pivot i of the elimination, up to (d[i + 1] / d[i])^2 = 1e-6. */
    double pivots[16];
    memcpy(pivots, a, sizeof pivots);
    for (int k = 0; k < 4; k++)
        for (int i = k + 1; i < 4; i++)
            for (int j = k + 1; j < 4; j++) pivots[j * 4 + i] -= pivots[k * 4 + i] * pivots[j * 4 + k] / pivots[k * 4 + k];
    for (int i = 0; i < 4; i++) TEST_ASSERT_DOUBLE_WITHIN(1e-5, 1, (double)values[i] / pivots[i * 5]);

    /* And the order of the rows does not matter. */
    const int order[] = {2, 0, 3, 1};
    double shuffled[16];
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++) shuffled[j * 4 + i] = a[order[j] * 4 + order[i]];
    check_decomposition(4, shuffled, scaled, "graded, shuffled");
    for (int i = 0; i < 4; i++) TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1, (double)(scaled[i] / values[i]));
}

/* From the squared cosines of subspaces that are all but orthogonal, whose cubes are no numbers any more, to the squares of the
 * largest pixels that fit a float. */
static void test_the_scale_of_the_matrix_does_not_matter(void) {
    struct noise noise = {4};
    const int narrow = sizeof(ast_real) == sizeof(float);
    const double spectrum[] = {5, 3, 1, 0.1, 0}, least = narrow ? 1e-15 : 1e-140, most = narrow ? 1e15 : 1e80;
    double a[25], scaled[25];
    ast_real values[5], other[5];
    char name[80];
    for (int n = 2; n <= 5; n++) {
        symmetric_with_eigenvalues(&noise, n, spectrum, a);
        check_decomposition(n, a, values, "scale 1");
        for (double scale = least; scale < 2 * most; scale *= 1e10) {
            for (int i = 0; i < n * n; i++) scaled[i] = a[i] * scale;
            snprintf(name, sizeof name, "%d x %d, scale %g", n, n, scale);
            check_decomposition(n, scaled, other, name);
            for (int i = 0; i < n; i++)
                TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(200 * ast_real_epsilon(), values[i], (double)other[i] / scale, name);
        }
    }
}

static void test_an_empty_problem_writes_nothing(void) {
    ast_real a = 7, values = 8, vectors = 9;
    ast_eigen_symmetric(0, &a, &values, &vectors);
    TEST_ASSERT_EQUAL_DOUBLE(7, a);
    TEST_ASSERT_EQUAL_DOUBLE(8, values);
    TEST_ASSERT_EQUAL_DOUBLE(9, vectors);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_random_matrices_of_every_size);
    RUN_TEST(test_known_eigenvalues_come_descending);
    RUN_TEST(test_every_constellation_of_three_eigenvalues);
    RUN_TEST(test_a_diagonal_matrix_is_sorted_exactly);
    RUN_TEST(test_zeros_on_the_diagonal);
    RUN_TEST(test_rank_one_has_one_eigenvalue);
    RUN_TEST(test_small_eigenvalues_of_a_graded_matrix_keep_their_digits);
    RUN_TEST(test_the_scale_of_the_matrix_does_not_matter);
    RUN_TEST(test_an_empty_problem_writes_nothing);
    return UNITY_END();
}
