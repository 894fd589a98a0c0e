/* The metric learned from a background against its definition: M = I - Zc' (Zc Zc' + ridge tr(Zc Zc') I)^-1 Zc, formed as a dense
 * matrix in double. */
#include "metric.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "kernels.h"
#include "support_backends.h"
#include "support_matrix.h"
#include "unity.h"

enum { LEAD = 3, BEHIND = 5, MOST_SIZE = AST_MAX_BACKGROUND, MOST_COLUMNS = LEAD + 1 + MOST_SIZE + BEHIND, TILE = 9 };

/* Columns as in a bag: some in front, the background's mean m_b, its vectors, some behind; then a tile of vectors that are none. */
struct problem {
    int dim, size, columns, capacity;
    float ridge;
    float *column; /* dim floats each: `columns` columns, then TILE vectors */
    double *m;     /* dim x dim */
    float *gram;   /* inner products of m_b and the background with the columns: rows of `columns` floats */
    float *inner;  /* those of the tile */
    float *fresh;
    struct ast_metric metric;
    unsigned char *block;
};

static float *mean_of(const struct problem *p) {
    return p->column + LEAD * p->dim;
}

static void open_problem(struct problem *p, int dim, int size, float ridge) {
    struct ast_arena counted = {NULL, 0}, arena = {NULL, 0};
    memset(p, 0, sizeof *p);
    p->dim = dim;
    p->size = size;
    p->ridge = ridge;
    p->columns = LEAD + 1 + size + BEHIND;
    p->capacity = p->columns + 4; /* a bag that is not full */
    p->column = calloc((size_t)dim * (size_t)(p->columns + TILE), sizeof *p->column);
    p->m = matrix_new(dim, dim);
    p->gram = calloc((size_t)(1 + size) * (size_t)p->columns, sizeof *p->gram);
    p->inner = calloc((size_t)AST_LANES * (size_t)p->columns, sizeof *p->inner);
    p->fresh = malloc((size_t)AST_LANES * (size_t)size * sizeof *p->fresh);
    ast_metric_layout(&p->metric, size, ridge, LEAD, p->capacity, &counted);
    p->block = malloc(counted.used + AST_ALIGNMENT);
    TEST_ASSERT_TRUE(p->column != NULL && p->gram != NULL && p->inner != NULL && p->fresh != NULL && p->block != NULL);
    memset(p->block, 0xff, counted.used + AST_ALIGNMENT); /* NaN */
    arena.base = ast_align(p->block);
    ast_metric_layout(&p->metric, size, ridge, LEAD, p->capacity, &arena);
    TEST_ASSERT_EQUAL_UINT(counted.used, arena.used);
}

static void close_problem(struct problem *p) {
    free(p->column);
    free(p->m);
    free(p->gram);
    free(p->inner);
    free(p->fresh);
    free(p->block);
}

void setUp(void) {
    TEST_ASSERT_EQUAL_INT(0, backends_prepare());
}
void tearDown(void) {
}

/* Vectors about the size of the robust preset's: the background varies along a few directions more than along the others, its mean
 * is not quite the mean of the set. */
static void fill(struct problem *p, uint64_t seed) {
    enum { STRONG = 4 };
    struct noise noise = {seed};
    float *strong = malloc((size_t)(STRONG * p->dim) * sizeof *strong);
    TEST_ASSERT_NOT_NULL(strong);
    const double spread = 1 / sqrt(p->dim);
    for (int i = 0; i < p->dim * (p->columns + TILE); i++) p->column[i] = (float)(spread * noise_normal(&noise));
    for (int i = 0; i < STRONG * p->dim; i++) strong[i] = (float)(2 * spread * noise_normal(&noise));
    float *mean = mean_of(p);
    for (int z = 1; z <= p->size; z++)
        for (int l = 0; l < STRONG; l++) {
            const double along = noise_normal(&noise);
            for (int d = 0; d < p->dim; d++) mean[z * p->dim + d] += (float)(along * (double)strong[l * p->dim + d]);
        }
    for (int d = 0; d < p->dim; d++) {
        double sum = 0;
        for (int z = 1; z <= p->size; z++) sum += (double)mean[z * p->dim + d];
        mean[d] = (float)(sum / p->size + 0.05 * spread * noise_normal(&noise));
    }
    free(strong);
}

/* a x = b by Gauss' elimination with pivots, n x n, cols right sides; both destroyed, x in b. */
static void solve(int n, int cols, double *a, double *b) {
    for (int k = 0; k < n; k++) {
        int pivot = k;
        for (int i = k + 1; i < n; i++)
            if (fabs(a[k * n + i]) > fabs(a[k * n + pivot])) pivot = i;
        for (int j = 0; j < n; j++) {
            const double swap = a[j * n + k];
            a[j * n + k] = a[j * n + pivot];
            a[j * n + pivot] = swap;
        }
        for (int j = 0; j < cols; j++) {
            const double swap = b[j * n + k];
            b[j * n + k] = b[j * n + pivot];
            b[j * n + pivot] = swap;
        }
        for (int i = 0; i < n; i++) {
            if (i == k) continue;
            const double factor = a[k * n + i] / a[k * n + k];
            for (int j = k; j < n; j++) a[j * n + i] -= factor * a[j * n + k];
            for (int j = 0; j < cols; j++) b[j * n + i] -= factor * b[j * n + k];
        }
    }
    for (int j = 0; j < cols; j++)
        for (int i = 0; i < n; i++) b[j * n + i] /= a[i * n + i];
}

static void form_metric(struct problem *p) {
    const int n = p->size, dim = p->dim;
    double *centred = matrix_new(dim, n), *rows = matrix_new(n, dim), *inverse = matrix_new(n, dim), *square = matrix_new(n, n),
           trace = 0;
    const float *mean = mean_of(p);
    for (int z = 0; z < n; z++)
        for (int d = 0; d < dim; d++) rows[d * n + z] = centred[z * dim + d] = (double)mean[(1 + z) * dim + d] - (double)mean[d];
    matrix_product_transposed(n, n, dim, centred, centred, square);
    for (int z = 0; z < n; z++) trace += square[z * n + z];
    for (int z = 0; z < n; z++) square[z * n + z] += (double)p->ridge * trace;
    memset(p->m, 0, (size_t)dim * (size_t)dim * sizeof *p->m);
    for (int d = 0; d < dim; d++) p->m[d * dim + d] = 1;
    memcpy(inverse, rows, (size_t)n * (size_t)dim * sizeof *rows);
    if (trace > 0) {
        solve(n, dim, square, inverse);
        for (int j = 0; j < dim; j++)
            for (int i = 0; i < dim; i++)
                for (int z = 0; z < n; z++) p->m[j * dim + i] -= rows[i * n + z] * inverse[j * n + z];
    }
    free(centred);
    free(rows);
    free(inverse);
    free(square);
}

static double ordinary(const struct problem *p, int x, int y) {
    double sum = 0;
    for (int d = 0; d < p->dim; d++) sum += (double)p->column[x * p->dim + d] * (double)p->column[y * p->dim + d];
    return sum;
}

static double in_metric(const struct problem *p, int x, int y) {
    double sum = 0;
    for (int j = 0; j < p->dim; j++) {
        double row = 0;
        for (int i = 0; i < p->dim; i++) row += p->m[j * p->dim + i] * (double)p->column[x * p->dim + i];
        sum += row * (double)p->column[y * p->dim + j];
    }
    return sum;
}

/* The products that the scoring hands over, and the preparation. */
static void prepare(struct problem *p, const struct ast_linalg *la) {
    TEST_ASSERT_EQUAL_INT(0,
                          la->product(p->columns, 1 + p->size, p->dim, p->column, p->dim, mean_of(p), p->dim, p->gram, p->columns));
    ast_metric_prepare(&p->metric, ast_kernels(), p->gram, p->columns, p->columns, p->fresh);
}

/* square: count of AST_LANES. */
static void apply(struct problem *p, const struct ast_linalg *la, int count, ast_real *square) {
    const float *tile = p->column + p->columns * p->dim;
    memset(p->inner, 0, (size_t)(AST_LANES * p->columns) * sizeof *p->inner);
    TEST_ASSERT_EQUAL_INT(0, la->product(count, p->columns, p->dim, tile, p->dim, p->column, p->dim, p->inner, AST_LANES));
    for (int i = 0; i < AST_LANES; i++) square[i] = i < count ? (ast_real)ordinary(p, p->columns + i, p->columns + i) : 0;
    ast_metric_apply(&p->metric, ast_kernels(), p->columns, p->inner, square, p->fresh);
}

/* The column behind x of those that the metric knows: all but the background's vectors. */
static int next(const struct problem *p, int x) {
    return x == LEAD ? LEAD + 1 + p->size : x + 1;
}

/* Pairs of the columns that the metric knows, and a tile with all of them, against the dense matrix; relative to the vectors'
 * lengths. Returns the largest difference. */
static double largest_error(struct problem *p, const struct ast_linalg *la, int count) {
    ast_real square[AST_LANES];
    double worst = 0;
    prepare(p, la);
    for (int x = 0; x < p->columns; x = next(p, x))
        for (int y = 0; y < p->columns; y = next(p, y)) {
            const double size = sqrt(ordinary(p, x, x) * ordinary(p, y, y)) + 1e-30;
            const double found = ordinary(p, x, y) - (double)ast_metric_correction(&p->metric, x, y);
            worst = fmax(worst, fabs(found - in_metric(p, x, y)) / size);
            TEST_ASSERT_FALSE(isnan(found));
        }
    apply(p, la, count, square);
    for (int i = 0; i < count; i++) {
        const int t = p->columns + i;
        TEST_ASSERT_FALSE(isnan((double)square[i]));
        worst = fmax(worst, fabs((double)square[i] - in_metric(p, t, t)) / (ordinary(p, t, t) + 1e-30));
        for (int x = 0; x < p->columns; x = next(p, x)) {
            const double found = (double)p->inner[x * AST_LANES + i], size = sqrt(ordinary(p, t, t) * ordinary(p, x, x)) + 1e-30;
            TEST_ASSERT_FALSE(isnan(found));
            worst = fmax(worst, fabs(found - in_metric(p, t, x)) / size);
        }
    }
    return worst;
}

/* ---- Against the definition ---- */

static void test_corrections_are_the_dense_matrix(void) {
    static const int sizes[] = {8, 21, 64}, dims[] = {12, 40, 100};
    static const float ridges[] = {1e-4f, 1e-3f, 0.1f, 1.0f, 1e6f};
    double worst = 0;
    for (int b = 0; b < BACKENDS; b++)
        for (int s = 0; s < 3; s++)
            for (int d = 0; d < 3; d++)
                for (size_t r = 0; r < sizeof ridges / sizeof ridges[0]; r++) {
                    struct problem p;
                    open_problem(&p, dims[d], sizes[s], ridges[r]);
                    fill(&p, (uint64_t)(1 + s * 3 + d));
                    form_metric(&p);
                    const double error = largest_error(&p, backends[b], TILE);
                    TEST_ASSERT_TRUE(error < (ridges[r] < 0.01f ? 1e-3 : 5e-6));
                    worst = fmax(worst, error);
                    close_problem(&p);
                }
    TEST_ASSERT_TRUE(worst > 0);
}

static void test_the_largest_background(void) {
    struct problem p;
    open_problem(&p, 60, MOST_SIZE, 0.1f);
    fill(&p, 20);
    form_metric(&p);
    TEST_ASSERT_TRUE(largest_error(&p, backends[0], TILE) < 5e-6);
    close_problem(&p);
}

static void test_tiles_of_any_size(void) {
    struct problem p;
    open_problem(&p, 40, 24, 0.1f);
    fill(&p, 21);
    form_metric(&p);
    for (int b = 0; b < BACKENDS; b++)
        for (int count = 1; count <= TILE; count++) TEST_ASSERT_TRUE(largest_error(&p, backends[b], count) < 5e-6);
    close_problem(&p);
}

/* ---- What it means ---- */

/* A background that varies by s_l along axis l alone: along that axis lengths are multiplied by r / (s_l^2 + r), r = ridge sum
 * s^2. */
static void test_directions_of_the_background_count_less(void) {
    enum { DIM = 24, SIZE = 8 };
    static const double deviations[SIZE] = {3, 2, 1, 1, 0.5, 0.25, 0.1, 0};
    struct problem p;
    double total = 0;
    open_problem(&p, DIM, SIZE, 0.05f);
    fill(&p, 22);
    for (int l = 0; l < SIZE; l++) total += deviations[l] * deviations[l];
    for (int z = 0; z <= SIZE; z++)
        for (int d = 0; d < DIM; d++) mean_of(&p)[z * DIM + d] = 0.125f + (z > 0 && d == z - 1 ? (float)deviations[z - 1] : 0.0f);
    float *behind = mean_of(&p) + (1 + SIZE) * DIM; /* five axes: three strong ones, the one without deviation, one outside */
    static const int axes[BEHIND] = {0, 2, 5, SIZE - 1, DIM - 1};
    for (int x = 0; x < BEHIND; x++)
        for (int d = 0; d < DIM; d++) behind[x * DIM + d] = d == axes[x] ? 1.0f : 0.0f;
    prepare(&p, backends[0]);
    for (int x = 0; x < BEHIND; x++) {
        const double s = axes[x] < SIZE ? deviations[axes[x]] : 0, r = 0.05 * total;
        const int column = LEAD + 1 + SIZE + x;
        TEST_ASSERT_DOUBLE_WITHIN(1e-5, r / (s * s + r), 1 - (double)ast_metric_correction(&p.metric, column, column));
        for (int y = 0; y < x; y++)
            TEST_ASSERT_DOUBLE_WITHIN(1e-5, 0, (double)ast_metric_correction(&p.metric, column, LEAD + 1 + SIZE + y));
    }
    close_problem(&p);
}

/* A huge ridge leaves nothing of the correction. */
static void test_a_huge_ridge_is_the_identity(void) {
    struct problem p;
    open_problem(&p, 40, 32, 1e6f);
    fill(&p, 23);
    prepare(&p, backends[0]);
    for (int x = 0; x < p.columns; x = next(&p, x))
        for (int y = 0; y <= x; y = next(&p, y))
            TEST_ASSERT_DOUBLE_WITHIN(1e-5 * (ordinary(&p, x, x) + ordinary(&p, y, y)), 0,
                                      (double)ast_metric_correction(&p.metric, x, y));
    close_problem(&p);
}

/* The ridge is relative: a background that varies more in all directions alike gives the same metric. */
static void test_the_backgrounds_scale_does_not_matter(void) {
    struct problem p;
    double before[TILE];
    ast_real square[AST_LANES];
    open_problem(&p, 40, 16, 0.1f);
    fill(&p, 24);
    prepare(&p, backends[0]);
    apply(&p, backends[0], TILE, square);
    for (int i = 0; i < TILE; i++) before[i] = (double)square[i];
    for (float factor = 0.125f; factor <= 8; factor *= 8) {
        float *mean = mean_of(&p);
        for (int z = 1; z <= p.size; z++)
            for (int d = 0; d < p.dim; d++) mean[z * p.dim + d] = mean[d] + factor * (mean[z * p.dim + d] - mean[d]);
        prepare(&p, backends[0]);
        apply(&p, backends[0], TILE, square);
        for (int i = 0; i < TILE; i++) TEST_ASSERT_DOUBLE_WITHIN(1e-4 * before[i], before[i], (double)square[i]);
    }
    close_problem(&p);
}

/* ---- Backgrounds that vary little or not at all ---- */

/* Repeated vectors make Zc Zc' singular; the ridge carries them. */
static void test_repeated_vectors(void) {
    static const float ridges[] = {1e-4f, 0.1f};
    for (int r = 0; r < 2; r++)
        for (int distinct = 1; distinct <= 9; distinct += 4) {
            struct problem p;
            open_problem(&p, 40, 24, ridges[r]);
            fill(&p, 25);
            float *set = mean_of(&p) + p.dim;
            for (int z = distinct; z < p.size; z++)
                memcpy(set + z * p.dim, set + z % distinct * p.dim, (size_t)p.dim * sizeof *set);
            form_metric(&p);
            const double error = largest_error(&p, backends[0], TILE);
            TEST_ASSERT_TRUE(error < (r == 0 ? 1e-3 : 5e-6));
            close_problem(&p);
        }
}

/* No vector becomes longer in the metric than it was, nor its square negative, and no inner product exceeds the lengths. */
static void assert_harmless(struct problem *p, const struct ast_linalg *la) {
    ast_real square[AST_LANES];
    prepare(p, la);
    for (int x = 0; x < p->columns; x = next(p, x)) {
        const double before = ordinary(p, x, x), taken = (double)ast_metric_correction(&p->metric, x, x);
        TEST_ASSERT_TRUE(taken >= 0 && taken <= before * (1 + 1e-5)); /* false for NaN */
    }
    apply(p, la, TILE, square);
    for (int i = 0; i < TILE; i++) {
        const double before = ordinary(p, p->columns + i, p->columns + i);
        TEST_ASSERT_TRUE(square[i] >= 0 && (double)square[i] <= before * (1 + 1e-5));
        for (int x = 0; x < p->columns; x = next(p, x))
            TEST_ASSERT_TRUE(fabs((double)p->inner[x * AST_LANES + i]) <= sqrt(before * ordinary(p, x, x)) * (1 + 1e-5));
    }
}

/* All vectors equal to their mean, or nothing at all: no direction is the background's. */
static void test_a_background_without_variation_is_the_identity(void) {
    for (int b = 0; b < BACKENDS; b++)
        for (int trial = 0; trial < 8; trial++) {
            struct problem p;
            open_problem(&p, trial % 2 ? 40 : 200, 64, trial % 3 ? 0.1f : 1e-4f);
            fill(&p, 26 + (uint64_t)trial);
            float *mean = mean_of(&p);
            if (trial < 2) memset(mean, 0, (size_t)p.dim * sizeof *mean);
            for (int z = 1; z <= p.size; z++) memcpy(mean + z * p.dim, mean, (size_t)p.dim * sizeof *mean);
            assert_harmless(&p, backends[b]);
            for (int x = 0; x < p.columns; x = next(&p, x))
                TEST_ASSERT_DOUBLE_WITHIN(1e-5, 0, (double)ast_metric_correction(&p.metric, x, x) / (ordinary(&p, x, x) + 1e-30));
            close_problem(&p);
        }
}

/* Variation of the size of single precision's rounding, as an even ramp in the picture gives: what rounding makes of it must not
 * pass for a direction of the background, least of all for one in which squares are negative. */
static void test_a_background_that_hardly_varies_is_harmless(void) {
    struct noise noise = {34};
    for (int b = 0; b < BACKENDS; b++)
        for (int trial = 0; trial < 12; trial++)
            for (double variation = 1e-8; variation < 0.5; variation *= 10) {
                struct problem p;
                open_problem(&p, trial % 3 ? 40 : 200, 64, trial % 2 ? 0.1f : 1e-4f);
                fill(&p, 35 + (uint64_t)trial);
                float *mean = mean_of(&p);
                for (int z = 1; z <= p.size; z++)
                    for (int d = 0; d < p.dim; d++)
                        mean[z * p.dim + d] = (float)((double)mean[d] + variation * noise_normal(&noise) / sqrt(p.dim));
                assert_harmless(&p, backends[b]);
                close_problem(&p);
            }
}

/* ---- Behaviour ---- */

/* The metric of the last frame is gone: nothing of it stays. */
static void test_a_preparation_forgets_the_last_one(void) {
    struct problem p, other;
    ast_real square[AST_LANES], again[AST_LANES];
    open_problem(&p, 40, 24, 0.1f);
    open_problem(&other, 40, 24, 0.1f);
    fill(&p, 27);
    fill(&other, 28);
    prepare(&p, backends[0]);
    apply(&p, backends[0], TILE, square);
    const struct ast_metric own = other.metric;
    other.metric = p.metric;
    prepare(&other, backends[0]);
    apply(&other, backends[0], 4, again);
    other.metric = own;
    prepare(&p, backends[0]);
    apply(&p, backends[0], TILE, again);
    TEST_ASSERT_EQUAL_MEMORY(square, again, sizeof square);
    close_problem(&p);
    close_problem(&other);
}

static void test_without_a_background_it_takes_no_memory(void) {
    struct ast_metric metric;
    struct ast_arena arena = {NULL, 0};
    ast_metric_layout(&metric, 0, 0.1f, 4, 200, &arena);
    TEST_ASSERT_EQUAL_UINT(0, arena.used);
    TEST_ASSERT_EQUAL_INT(0, metric.size);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_corrections_are_the_dense_matrix);
    RUN_TEST(test_the_largest_background);
    RUN_TEST(test_tiles_of_any_size);
    RUN_TEST(test_directions_of_the_background_count_less);
    RUN_TEST(test_a_huge_ridge_is_the_identity);
    RUN_TEST(test_the_backgrounds_scale_does_not_matter);
    RUN_TEST(test_repeated_vectors);
    RUN_TEST(test_a_background_without_variation_is_the_identity);
    RUN_TEST(test_a_background_that_hardly_varies_is_harmless);
    RUN_TEST(test_a_preparation_forgets_the_last_one);
    RUN_TEST(test_without_a_background_it_takes_no_memory);
    return UNITY_END();
}
