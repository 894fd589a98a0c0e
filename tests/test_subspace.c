/* Fitting affine subspaces, with every backend that is linked here. */
#include "subspace.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support_backends.h"
#include "support_matrix.h"
#include "support_precision.h"
#include "unity.h"

enum { MOST_IMAGES = 16, MOST_DIM = 512, MOST_N = 8, PAD = 5 };

/* A set of images, and what is fitted to it. The basis has padding between its columns. */
static struct fit {
    float image[MOST_IMAGES][MOST_DIM];
    int count, dim, n;
    float mean[MOST_DIM], basis[MOST_N * (MOST_DIM + PAD)];
    int rank;
} fit;

static const float *columns[MOST_IMAGES];
static char label[160];

void setUp(void) {
    for (int j = 0; j < MOST_IMAGES; j++) columns[j] = fit.image[j];
    TEST_ASSERT_EQUAL_INT(0, backends_prepare());
}
void tearDown(void) {
}

static struct ast_images images_of(void) {
    const struct ast_images images = {columns, fit.count, fit.dim};
    return images;
}

static void resize(int dim, int count, int n) {
    fit.dim = dim;
    fit.count = count;
    fit.n = n;
    memset(fit.image, 0, sizeof fit.image);
}

static void random_images(struct noise *noise, int dim, int count, int n) {
    resize(dim, count, n);
    for (int j = 0; j < count; j++) noise_fill(noise, fit.image[j], (size_t)dim, 0, 1);
}

/* Fits, and checks what holds for every set: a whole workspace and no more is used, the mean is the mean, the present columns are
 * orthonormal and first, the absent ones exactly zero, the padding untouched. */
static void run_fit(const struct ast_linalg *la, int centred) {
    const struct ast_images images = images_of();
    const int stride = fit.dim + PAD;
    const size_t work_count = ast_subspace_work(la, fit.dim, fit.count);
    ast_real *work = malloc((work_count + 1) * sizeof *work);
    TEST_ASSERT_NOT_NULL(work);
    for (size_t i = 0; i < work_count; i++) work[i] = (ast_real)NAN;
    work[work_count] = 42;
    for (int i = 0; i < fit.n * stride; i++) fit.basis[i] = NAN;
    fit.rank = -1;
    snprintf(label, sizeof label, "%s, %s: %d images of %d, n %d", la->name, centred ? "centred" : "raw", fit.count, fit.dim,
             fit.n);
    TEST_ASSERT_EQUAL_INT_MESSAGE(
        0, ast_subspace_of(la, &images, centred, NULL, fit.n, fit.mean, fit.basis, stride, &fit.rank, work, work_count), label);
    TEST_ASSERT_EQUAL_DOUBLE_MESSAGE(42, work[work_count], label);
    free(work);

    for (int d = 0; d < fit.dim; d++) {
        double sum = 0, size = 0;
        for (int j = 0; j < fit.count; j++) {
            sum += (double)fit.image[j][d];
            size += fabs((double)fit.image[j][d]);
        }
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(((double)FLT_EPSILON + real_sum_slack(fit.count)) * size / fit.count, sum / fit.count,
                                          (double)fit.mean[d], label);
    }
    const int room = fit.count - centred < fit.dim ? fit.count - centred : fit.dim;
    TEST_ASSERT_TRUE_MESSAGE(fit.rank >= 0 && fit.rank <= fit.n && fit.rank <= room, label);
    double *present = matrix_new(fit.dim, fit.n);
    for (int l = 0; l < fit.n; l++) {
        for (int d = 0; d < fit.dim; d++) {
            const float value = fit.basis[l * stride + d];
            if (l < fit.rank)
                present[l * fit.dim + d] = (double)value;
            else
                TEST_ASSERT_TRUE_MESSAGE(value == 0.0f, label);
        }
        for (int d = fit.dim; d < stride; d++) TEST_ASSERT_TRUE_MESSAGE(isnan(fit.basis[l * stride + d]), label);
    }
    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(2e-6, 0, matrix_orthonormality_error(fit.dim, fit.rank, present), label);
    free(present);
}

/* Sum over the images of what the basis explains of image - origin; *whole receives the sum of their squared norms. */
static double explained(const float *origin, int directions, double *whole) {
    double sum = 0;
    *whole = 0;
    for (int j = 0; j < fit.count; j++) {
        for (int l = -1; l < directions; l++) {
            double along = 0;
            for (int d = 0; d < fit.dim; d++) {
                const double x = (double)fit.image[j][d] - (origin == NULL ? 0 : (double)origin[d]);
                along += l < 0 ? x * x : x * (double)fit.basis[l * (fit.dim + PAD) + d];
            }
            if (l < 0)
                *whole += along;
            else
                sum += along * along;
        }
    }
    return sum;
}

static void test_every_size_gives_an_orthonormal_basis(void) {
    static const int dims[] = {1, 2, 3, 16, 63, 500}, counts[] = {1, 2, 3, 4, 7, 16};
    struct noise noise = {1};
    for (int b = 0; b < BACKENDS; b++) {
        for (int d = 0; d < 6; d++) {
            for (int c = 0; c < 6; c++) {
                for (int n = 1; n <= MOST_N; n += n < 3 ? 1 : 5) {
                    random_images(&noise, dims[d], counts[c], n);
                    for (int centred = 0; centred <= 1; centred++) {
                        run_fit(backends[b], centred);
                        /* Random images are in general position. */
                        int expected = counts[c] - centred < dims[d] ? counts[c] - centred : dims[d];
                        if (n < expected) expected = n;
                        TEST_ASSERT_EQUAL_INT_MESSAGE(expected, fit.rank, label);
                    }
                }
            }
        }
    }
}

static void test_the_basis_spans_the_set(void) {
    struct noise noise = {2};
    double whole;
    for (int b = 0; b < BACKENDS; b++) {
        random_images(&noise, 100, 6, 5);
        run_fit(backends[b], 1);
        double part = explained(fit.mean, fit.rank, &whole);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-5 * whole, whole, part, label);
        random_images(&noise, 100, 6, 6);
        run_fit(backends[b], 0);
        part = explained(NULL, fit.rank, &whole);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-5 * whole, whole, part, label);
    }
}

/* The directions kept are those that explain most: each image set has its own about an own mean, of known lengths. */
static void test_the_basis_takes_the_dominant_directions_in_order(void) {
    enum { DIM = 60, COUNT = 6 };
    const double lengths[] = {4, 2, 1, 0.5, 0.1};
    struct noise noise = {3};
    double direction[DIM * 5], side[COUNT * COUNT], away[DIM];
    matrix_orthonormal(&noise, DIM, 5, direction);
    /* An orthogonal COUNT x COUNT matrix with a constant first column: the other columns sum to zero over the images. */
    for (int i = 0; i < COUNT * COUNT; i++) side[i] = i < COUNT ? 1 : noise_normal(&noise);
    for (int j = 0; j < COUNT; j++) {
        for (int i = 0; i < j; i++) {
            double along = 0;
            for (int d = 0; d < COUNT; d++) along += side[j * COUNT + d] * side[i * COUNT + d];
            for (int d = 0; d < COUNT; d++) side[j * COUNT + d] -= along * side[i * COUNT + d];
        }
        double square = 0;
        for (int d = 0; d < COUNT; d++) square += side[j * COUNT + d] * side[j * COUNT + d];
        for (int d = 0; d < COUNT; d++) side[j * COUNT + d] /= sqrt(square);
    }
    noise_fill_normal(&noise, away, DIM);
    for (int b = 0; b < BACKENDS; b++) {
        for (int centred = 0; centred <= 1; centred++) {
            resize(DIM, COUNT, 3);
            for (int j = 0; j < COUNT; j++) {
                for (int d = 0; d < DIM; d++) {
                    double value = centred ? 10 * away[d] : 0;
                    for (int l = 0; l < 5; l++) value += lengths[l] * side[(l + 1) * COUNT + j] * direction[l * DIM + d];
                    fit.image[j][d] = (float)value;
                }
            }
            run_fit(backends[b], centred);
            TEST_ASSERT_EQUAL_INT_MESSAGE(3, fit.rank, label);
            for (int l = 0; l < 3; l++) {
                double along = 0;
                for (int d = 0; d < DIM; d++) along += direction[l * DIM + d] * (double)fit.basis[l * (DIM + PAD) + d];
                TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-5, 1, fabs(along), label);
            }
        }
    }
}

/* ||Ua'Ub||^2 of two bases of equal rank: that rank when they span the same. */
static double squared_cosines(const float *a, const float *b, int stride, int rank) {
    double sum = 0;
    for (int i = 0; i < rank; i++) {
        for (int j = 0; j < rank; j++) {
            double along = 0;
            for (int d = 0; d < fit.dim; d++) along += (double)a[i * stride + d] * (double)b[j * stride + d];
            sum += along * along;
        }
    }
    return sum;
}

/* ---- The rank rule ---- */

static void expect_rank(int expected, int centred, const char *what) {
    for (int b = 0; b < BACKENDS; b++) {
        run_fit(backends[b], centred);
        snprintf(label, sizeof label, "%s, %s, %s", what, backends[b]->name, centred ? "centred" : "raw");
        TEST_ASSERT_EQUAL_INT_MESSAGE(expected, fit.rank, label);
    }
}

static void test_a_frozen_set_has_only_its_image(void) {
    struct noise noise = {4};
    /* Numbers of images whose mean is no exact float: centring leaves rounding, which is no direction. */
    for (int count = 1; count <= MOST_IMAGES; count++) {
        random_images(&noise, 200, count, 3);
        for (int j = 1; j < count; j++) memcpy(fit.image[j], fit.image[0], sizeof fit.image[0]);
        expect_rank(0, 1, "frozen");
        expect_rank(1, 0, "frozen");
        for (int j = 0; j < count; j++)
            for (int d = 0; d < 200; d++) fit.image[j][d] = 0.1f;
        expect_rank(0, 1, "frozen, flat");
        expect_rank(1, 0, "frozen, flat");
    }
}

static void test_a_black_set_has_no_direction(void) {
    for (int count = 1; count <= MOST_IMAGES; count += 5) {
        resize(64, count, 2);
        expect_rank(0, 1, "black");
        expect_rank(0, 0, "black");
    }
}

static void test_a_set_of_rank_two(void) {
    struct noise noise = {5};
    random_images(&noise, 128, 8, 5);
    /* All images on the plane through the first three: two directions about the mean, three about zero. */
    for (int j = 3; j < 8; j++) {
        const double a = noise_normal(&noise), b = noise_normal(&noise);
        for (int d = 0; d < 128; d++)
            fit.image[j][d] =
                (float)((1 - a - b) * (double)fit.image[0][d] + a * (double)fit.image[1][d] + b * (double)fit.image[2][d]);
    }
    expect_rank(2, 1, "a plane");
    expect_rank(3, 0, "a plane");
}

static void test_a_saturated_patch_among_others(void) {
    struct noise noise = {6};
    random_images(&noise, 64, 4, 5);
    for (int d = 0; d < 64; d++) fit.image[2][d] = 1.0f;
    memset(fit.image[3], 0, sizeof fit.image[3]);
    expect_rank(3, 1, "one white, one black");
    expect_rank(3, 0, "one white, one black");
}

/* Two images base +- small: about their mean the one singular value is small sqrt(2), of a set whose norm is sqrt(2) base. What
 * counts is the norm of the images as they are. */
static void test_the_tolerance_is_relative_to_the_uncentred_norm(void) {
    static const float ratios[] = {0.9e-5f, 1.1e-5f};
    static const float bases[] = {1e-6f, 1.0f, 4096.0f};
    for (int r = 0; r < 2; r++) {
        for (int s = 0; s < 3; s++) {
            resize(32, 2, 2);
            fit.image[0][3] = fit.image[1][3] = bases[s];
            fit.image[0][7] = ratios[r] * bases[s];
            fit.image[1][7] = -ratios[r] * bases[s];
            expect_rank(r, 1, r ? "above the tolerance" : "below the tolerance");
            expect_rank(1 + r, 0, r ? "above the tolerance" : "below the tolerance");
        }
    }
}

static void test_rank_counts_values_above_the_tolerance(void) {
    const ast_real norm = 1000, at = AST_RANK_TOLERANCE * norm;
    const ast_real values[] = {900, 2 * at, at, at / 2, 0};
    TEST_ASSERT_EQUAL_INT(2, ast_rank(values, 5, 5, norm)); /* at most this fraction is absent */
    TEST_ASSERT_EQUAL_INT(1, ast_rank(values, 5, 1, norm));
    TEST_ASSERT_EQUAL_INT(1, ast_rank(values, 1, 5, norm));
    TEST_ASSERT_EQUAL_INT(0, ast_rank(values, 0, 5, norm));
    TEST_ASSERT_EQUAL_INT(3, ast_rank(values, 5, 5, norm / 2 * (ast_real)1.5));
    const ast_real nothing[] = {0, 0};
    TEST_ASSERT_EQUAL_INT(0, ast_rank(nothing, 2, 2, 0));
}

/* ---- The parts ---- */

static void test_norm_is_that_of_all_elements(void) {
    resize(2, 2, 1);
    fit.image[0][0] = 3.0f;
    fit.image[0][1] = -4.0f;
    fit.image[1][1] = 12.0f;
    fit.image[1][2] = NAN; /* beyond dim */
    fit.image[2][0] = NAN; /* beyond count */
    const struct ast_images images = images_of();
    TEST_ASSERT_DOUBLE_WITHIN(32 * ast_real_epsilon(), 13, ast_images_norm(&images));
}

static void test_svd_about_an_origin(void) {
    enum { DIM = 40, COUNT = 3 };
    struct noise noise = {7};
    random_images(&noise, DIM, COUNT, 1);
    const struct ast_images images = images_of();
    float origin[DIM];
    noise_fill(&noise, origin, DIM, -1, 1);
    for (int b = 0; b < BACKENDS; b++) {
        for (int about = 0; about <= 1; about++) {
            const size_t work_count = ast_subspace_work(backends[b], DIM, COUNT);
            ast_real *work = malloc(work_count * sizeof *work), values[COUNT];
            TEST_ASSERT_NOT_NULL(work);
            TEST_ASSERT_EQUAL_INT(0, ast_images_svd(backends[b], &images, about ? origin : NULL, values, work, work_count));
            double shifted[DIM * COUNT], u[DIM * COUNT], along[COUNT * COUNT];
            for (int i = 0; i < DIM * COUNT; i++) {
                shifted[i] = (double)fit.image[i / DIM][i % DIM] - (about ? (double)origin[i % DIM] : 0);
                u[i] = (double)work[i];
            }
            TEST_ASSERT_DOUBLE_WITHIN(200 * ast_real_epsilon(), 0, matrix_orthonormality_error(DIM, COUNT, u));
            matrix_product_transposed(COUNT, COUNT, DIM, u, shifted, along);
            for (int l = 0; l < COUNT; l++) {
                double square = 0;
                for (int j = 0; j < COUNT; j++) square += along[j * COUNT + l] * along[j * COUNT + l];
                TEST_ASSERT_DOUBLE_WITHIN(1000 * ast_real_epsilon(), (double)values[l], sqrt(square));
            }
            free(work);
        }
    }
}

static void test_a_workspace_too_small_is_refused(void) {
    struct noise noise = {8};
    random_images(&noise, 50, 4, 2);
    const struct ast_images images = images_of();
    ast_real work[50 * 4 + 8];
    for (int b = 0; b < BACKENDS; b++) {
        for (size_t work_count = 0; work_count <= 50 * 4; work_count += 50) {
            TEST_ASSERT_TRUE(
                ast_subspace_of(backends[b], &images, 1, NULL, 2, fit.mean, fit.basis, 50, &fit.rank, work, work_count) != 0);
        }
    }
}

/* ---- The origin ---- */

/* About an origin: the subspace of the images minus it; the mean stays the images' own. A centred basis has its own origin. */
static void test_a_raw_basis_about_an_origin(void) {
    enum { DIM = 70, COUNT = 4, N = 3 };
    struct noise noise = {10};
    float origin[DIM], mean[DIM], basis[DIM * N], shifted_mean[DIM], shifted_basis[DIM * N];
    for (int b = 0; b < BACKENDS; b++) {
        random_images(&noise, DIM, COUNT, N);
        noise_fill(&noise, origin, DIM, -1, 1);
        const struct ast_images images = images_of();
        const size_t work_count = ast_subspace_work(backends[b], DIM, COUNT);
        ast_real *work = malloc(work_count * sizeof *work);
        int rank, shifted_rank;
        TEST_ASSERT_NOT_NULL(work);
        for (int centred = 0; centred <= 1; centred++) {
            TEST_ASSERT_EQUAL_INT(
                0, ast_subspace_of(backends[b], &images, centred, origin, N, mean, basis, DIM, &rank, work, work_count));
            float kept[COUNT][DIM];
            for (int j = 0; j < COUNT; j++) {
                memcpy(kept[j], fit.image[j], sizeof kept[j]);
                for (int d = 0; d < DIM; d++) fit.image[j][d] = centred ? fit.image[j][d] : fit.image[j][d] - origin[d];
            }
            TEST_ASSERT_EQUAL_INT(0, ast_subspace_of(backends[b], &images, centred, NULL, N, shifted_mean, shifted_basis, DIM,
                                                     &shifted_rank, work, work_count));
            for (int j = 0; j < COUNT; j++) memcpy(fit.image[j], kept[j], sizeof kept[j]);
            TEST_ASSERT_EQUAL_INT(shifted_rank, rank);
            TEST_ASSERT_EQUAL_INT(N, rank);
            for (int d = 0; d < DIM; d++)
                TEST_ASSERT_FLOAT_WITHIN(1e-6f, centred ? shifted_mean[d] : shifted_mean[d] + origin[d], mean[d]);
            TEST_ASSERT_DOUBLE_WITHIN(1e-5, N, squared_cosines(basis, shifted_basis, DIM, N));
        }
        free(work);
    }
}

/* ---- Invariants of the fit ---- */

static void test_order_of_images_shift_and_scale_keep_the_subspace(void) {
    enum { DIM = 90, COUNT = 5, RANK = 4 }; /* all directions kept, so that the subspace needs no gap */
    static float first_basis[MOST_N * (MOST_DIM + PAD)], first[COUNT][DIM];
    struct noise noise = {9};
    for (int b = 0; b < BACKENDS; b++) {
        random_images(&noise, DIM, COUNT, RANK);
        run_fit(backends[b], 1);
        memcpy(first_basis, fit.basis, sizeof first_basis);
        for (int j = 0; j < COUNT; j++) memcpy(first[j], fit.image[j], sizeof first[j]);

        for (int j = 0; j < COUNT; j++) memcpy(fit.image[j], first[(j * 2 + 3) % COUNT], sizeof first[j]);
        run_fit(backends[b], 1);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-5, RANK, squared_cosines(first_basis, fit.basis, DIM + PAD, RANK), label);

        for (int j = 0; j < COUNT; j++)
            for (int d = 0; d < DIM; d++) fit.image[j][d] = first[j][d] + 0.5f * (float)(d % 3);
        run_fit(backends[b], 1);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-5, RANK, squared_cosines(first_basis, fit.basis, DIM + PAD, RANK), label);

        for (int j = 0; j < COUNT; j++)
            for (int d = 0; d < DIM; d++) fit.image[j][d] = 255.0f * first[j][d];
        run_fit(backends[b], 1);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-5, RANK, squared_cosines(first_basis, fit.basis, DIM + PAD, RANK), label);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_every_size_gives_an_orthonormal_basis);
    RUN_TEST(test_the_basis_spans_the_set);
    RUN_TEST(test_the_basis_takes_the_dominant_directions_in_order);
    RUN_TEST(test_a_frozen_set_has_only_its_image);
    RUN_TEST(test_a_black_set_has_no_direction);
    RUN_TEST(test_a_set_of_rank_two);
    RUN_TEST(test_a_saturated_patch_among_others);
    RUN_TEST(test_the_tolerance_is_relative_to_the_uncentred_norm);
    RUN_TEST(test_rank_counts_values_above_the_tolerance);
    RUN_TEST(test_norm_is_that_of_all_elements);
    RUN_TEST(test_svd_about_an_origin);
    RUN_TEST(test_a_workspace_too_small_is_refused);
    RUN_TEST(test_a_raw_basis_about_an_origin);
    RUN_TEST(test_order_of_images_shift_and_scale_keep_the_subspace);
    return UNITY_END();
}
