/* The kernels of every instruction set that this processor has give the same bits as the plain ones, and those what they
 * promise. */
#include "kernels.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support_matrix.h"
#include "support_noise.h"
#include "support_precision.h"
#include "support_render.h"
#include "support_tracker.h"
#include "unity.h"
#include "vector.h"

void setUp(void) {
}
void tearDown(void) {
}

static char label[160];

static void test_the_best_is_the_last_and_the_plain_the_first(void) {
    int count = 0;
    TEST_ASSERT_EQUAL_PTR(&ast_kernels_plain, ast_kernels_at(0));
    TEST_ASSERT_NULL(ast_kernels_at(-1));
    while (ast_kernels_at(count) != NULL) count++;
    TEST_ASSERT_EQUAL_PTR(ast_kernels(), ast_kernels_at(count - 1));
    TEST_ASSERT_NULL(ast_kernels_at(count + 5));
    printf("kernels here:");
    for (int i = 0; i < count; i++) printf(" %s", ast_kernels_at(i)->name);
    printf("\n");
#if AST_X86_KERNELS
    TEST_ASSERT_TRUE(count > 1 || !__builtin_cpu_supports("avx2"));
#endif
}

/* ---- Panels ---- */

enum { MOST_COLUMNS = 40, LD = AST_PANEL_DEPTH + 3, LD_SUMS = AST_LANES + 5 };

static void test_packing_interleaves_columns(void) {
    static float m[AST_LANES * LD], panel[AST_PANEL_DEPTH * AST_LANES + 1];
    struct noise noise = {1};
    noise_fill(&noise, m, sizeof m / sizeof *m, -1, 1);
    for (int i = 0; ast_kernels_at(i) != NULL; i++) {
        for (int depth = 1; depth <= AST_PANEL_DEPTH; depth++) {
            for (int used = 1; used <= AST_LANES; used++) {
                panel[depth * AST_LANES] = 42.0f;
                ast_kernels_at(i)->pack(panel, m, LD, used, depth);
                for (int d = 0; d < depth; d++)
                    for (int l = 0; l < AST_LANES; l++)
                        TEST_ASSERT_TRUE(panel[d * AST_LANES + l] == m[(l < used ? l : 0) * LD + d]);
                TEST_ASSERT_EQUAL_FLOAT(42.0f, panel[depth * AST_LANES]);
            }
        }
    }
}

static void test_a_panel_product_is_the_sums_in_order_on_every_instruction_set(void) {
    static float panel[AST_PANEL_DEPTH * AST_LANES], columns[MOST_COLUMNS * LD], sums[(MOST_COLUMNS + 1) * LD_SUMS];
    struct noise noise = {2};
    noise_fill(&noise, panel, sizeof panel / sizeof *panel, -1, 1);
    noise_fill(&noise, columns, sizeof columns / sizeof *columns, -1, 1);
    const int depths[] = {1, 2, 3, 17, AST_PANEL_DEPTH - 1, AST_PANEL_DEPTH};
    for (int i = 0; ast_kernels_at(i) != NULL; i++) {
        for (int k = 0; k < (int)(sizeof depths / sizeof depths[0]); k++) {
            for (int count = 1; count <= MOST_COLUMNS; count++) {
                const int depth = depths[k];
                for (int e = 0; e < (MOST_COLUMNS + 1) * LD_SUMS; e++) sums[e] = (float)(e % 7);
                ast_kernels_at(i)->panel_product(panel, depth, columns, LD, count, sums, LD_SUMS);
                snprintf(label, sizeof label, "%s, depth %d, %d columns", ast_kernels_at(i)->name, depth, count);
                for (int e = 0; e < (MOST_COLUMNS + 1) * LD_SUMS; e++) {
                    const int c = e / LD_SUMS, l = e % LD_SUMS;
                    volatile float sum = 0.0f; /* volatile: rounded to float at every step */
                    for (int d = 0; c < count && l < AST_LANES && d < depth; d++) {
                        const volatile float term = panel[d * AST_LANES + l] * columns[c * LD + d];
                        sum += term;
                    }
                    const volatile float wanted = (float)(e % 7) + sum;
                    TEST_ASSERT_TRUE_MESSAGE(sums[e] == wanted, label);
                }
            }
        }
    }
}

/* ---- Vectors ---- */

static void test_departing_subtracts_and_measures(void) {
    enum { LONGEST = 200, APART = LONGEST + 3, COUNT = 6 }; /* six: some side by side, some alone */
    static float origin[LONGEST], x[COUNT * APART], plain[COUNT * APART], moved[COUNT * APART];
    struct noise noise = {3};
    noise_fill(&noise, origin, LONGEST, -1, 1);
    noise_fill(&noise, x, COUNT * APART, -1, 1);
    for (int n = 0; n < LONGEST; n = n < 40 ? n + 1 : n + 23) {
        ast_real square[COUNT], found[COUNT];
        memcpy(plain, x, sizeof plain);
        ast_kernels_plain.depart(plain, APART, COUNT, origin, n, square);
        for (int i = 0; i < COUNT * APART; i++) {
            const int d = i % APART;
            TEST_ASSERT_TRUE(plain[i] == (d < n ? x[i] - origin[d] : x[i]));
        }
        for (int i = 0; i < COUNT; i++) TEST_ASSERT_TRUE(square[i] == ast_dot(plain + i * APART, plain + i * APART, n));
        for (int i = 1; ast_kernels_at(i) != NULL; i++) {
            memcpy(moved, x, sizeof moved);
            ast_kernels_at(i)->depart(moved, APART, COUNT, origin, n, found);
            TEST_ASSERT_EQUAL_MEMORY(square, found, sizeof square);
            TEST_ASSERT_EQUAL_MEMORY(plain, moved, sizeof plain);
        }
    }
}

static void test_solving_undoes_the_triangle(void) {
    enum { MOST = 70 };
    static float factor[MOST * MOST], x[MOST * AST_LANES], right[MOST * AST_LANES], plain[MOST * AST_LANES],
        found[MOST * AST_LANES];
    struct noise noise = {4};
    for (int size = 1; size <= MOST; size = size < 10 ? size + 1 : size + 15) {
        for (int r = 0; r < size; r++)
            for (int c = 0; c < size; c++) /* above the diagonal nothing is read */
                factor[r * size + c] = c < r ? (float)(0.3 * noise_normal(&noise) / sqrt(size)) : c == r ? 0.5f : NAN;
        noise_fill(&noise, x, (size_t)(size * AST_LANES), -1, 1);
        for (int r = 0; r < size; r++)
            for (int l = 0; l < AST_LANES; l++) {
                double sum = 2 * (double)x[r * AST_LANES + l]; /* the diagonal is held inverted */
                for (int c = 0; c < r; c++) sum += (double)factor[r * size + c] * (double)x[c * AST_LANES + l];
                right[r * AST_LANES + l] = (float)sum;
            }
        memcpy(plain, right, sizeof plain);
        ast_kernels_plain.solve(factor, size, plain);
        for (int e = 0; e < size * AST_LANES; e++) TEST_ASSERT_DOUBLE_WITHIN(2e-6, (double)x[e], (double)plain[e]);
        for (int i = 1; ast_kernels_at(i) != NULL; i++) {
            memcpy(found, right, sizeof found);
            ast_kernels_at(i)->solve(factor, size, found);
            TEST_ASSERT_EQUAL_MEMORY(plain, found, (size_t)(size * AST_LANES) * sizeof *found);
        }
    }
}

/* ---- Eigen-problems ---- */

enum { MOST_N = 16 };
static ast_real lanes[MOST_N * MOST_N * AST_LANES], work[MOST_N * MOST_N * AST_LANES];
static ast_real values[MOST_N * AST_LANES], vectors[MOST_N * MOST_N * AST_LANES], spare[(MOST_N + 1) * AST_LANES];
static ast_real plain_values[MOST_N * AST_LANES], plain_vectors[MOST_N * MOST_N * AST_LANES];

static void put_lane(int n, int l, const double *a) {
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) lanes[(i * n + j) * AST_LANES + l] = i <= j ? (ast_real)a[j * n + i] : (ast_real)NAN;
}

/* A lane of the found values and vectors: descending, orthonormal, and A v = lambda v. */
static void check_lane(int n, int l, const double *a) {
    double q[MOST_N * MOST_N], largest = 1e-300;
    for (int e = 0; e < n * n; e++) largest = fmax(largest, fabs(a[e]));
    for (int k = 0; k < n; k++) {
        const double value = (double)values[k * AST_LANES + l];
        TEST_ASSERT_TRUE(k == 0 || value <= (double)values[(k - 1) * AST_LANES + l]);
        for (int i = 0; i < n; i++) q[k * n + i] = (double)vectors[(k * n + i) * AST_LANES + l];
        for (int i = 0; i < n; i++) {
            double sum = -value * q[k * n + i];
            for (int j = 0; j < n; j++) sum += a[j * n + i] * q[k * n + j];
            TEST_ASSERT_DOUBLE_WITHIN(real_eigen_slack(n) * largest, 0, sum);
        }
    }
    TEST_ASSERT_TRUE(matrix_orthonormality_error(n, n, q) < real_eigen_slack(n));
}

/* Semidefinite matrices of all ranks, a different one in each lane; one lane of zeros, and one that is diagonal already. */
static void test_lanes_of_eigenproblems(void) {
    struct noise noise = {5};
    for (int n = 1; n <= MOST_N; n = n < 6 ? n + 1 : n + 5) {
        double a[AST_LANES][MOST_N * MOST_N], factor[MOST_N * MOST_N];
        for (int l = 0; l < AST_LANES; l++) {
            for (int e = 0; e < n * n; e++) factor[e] = e / n <= l % n ? noise_normal(&noise) * pow(10, -(l % 5) * (e / n)) : 0;
            if (l == 7) memset(factor, 0, sizeof factor);
            matrix_product_transposed(n, n, n, factor, factor, a[l]);
            for (int e = 0; l == 9 && e < n * n; e++) a[l][e] = e % (n + 1) == 0 ? e : 0;
            put_lane(n, l, a[l]);
        }
        for (int i = 0; ast_kernels_at(i) != NULL; i++) {
            memcpy(work, lanes, sizeof work);
            ast_kernels_at(i)->eigen(n, work, values, vectors);
            for (int l = 0; l < AST_LANES; l++) check_lane(n, l, a[l]);
            if (i == 0) {
                memcpy(plain_values, values, sizeof values);
                memcpy(plain_vectors, vectors, sizeof vectors);
            }
            TEST_ASSERT_EQUAL_MEMORY(plain_values, values, (size_t)(n * AST_LANES) * sizeof *values);
            TEST_ASSERT_EQUAL_MEMORY(plain_vectors, vectors, (size_t)(n * n * AST_LANES) * sizeof *vectors);
            memcpy(work, lanes, sizeof work);
            ast_kernels_at(i)->eigenvalues(n, work, values, spare);
            for (int e = 0; e < n * AST_LANES; e++) {
                const double size = (double)plain_values[e % AST_LANES];
                TEST_ASSERT_DOUBLE_WITHIN(by_real(1e-12, real_eigen_slack(n)) * size + 1e-300, (double)plain_values[e],
                                          (double)values[e]);
            }
        }
    }
}

/* Squared cosines of two subspaces with three directions each: from all alike to none alike, values equal, nearly equal and far
 * apart, in neighbouring lanes, so that the closed form and the rotations meet. */
static void test_every_constellation_of_three_eigenvalues(void) {
    static const double levels[] = {1, 1 - 1e-12, 1 - 1e-6, 0.9, 0.5, 1e-3, 1e-9, 0};
    enum { LEVELS = sizeof levels / sizeof levels[0] };
    struct noise noise = {6};
    for (int trial = 0; trial < LEVELS * LEVELS * LEVELS; trial++) {
        double wanted[AST_LANES][3];
        for (int l = 0; l < AST_LANES; l++) {
            const int code = trial + l * 37;
            double q[9], scaled[9], a[9];
            wanted[l][0] = levels[code % LEVELS];
            wanted[l][1] = levels[code / LEVELS % LEVELS];
            wanted[l][2] = levels[code / LEVELS / LEVELS % LEVELS];
            matrix_orthonormal(&noise, 3, 3, q);
            for (int k = 0; k < 3; k++)
                for (int i = 0; i < 3; i++) scaled[i * 3 + k] = q[k * 3 + i] * wanted[l][k];
            double across[9];
            for (int k = 0; k < 3; k++)
                for (int i = 0; i < 3; i++) across[i * 3 + k] = q[k * 3 + i];
            matrix_product_transposed(3, 3, 3, scaled, across, a);
            put_lane(3, l, a);
            for (int x = 0; x < 2; x++) /* descending */
                for (int y = 0; y < 2 - x; y++)
                    if (wanted[l][y] < wanted[l][y + 1]) {
                        const double keep = wanted[l][y];
                        wanted[l][y] = wanted[l][y + 1];
                        wanted[l][y + 1] = keep;
                    }
        }
        for (int i = 0; ast_kernels_at(i) != NULL; i++) {
            memcpy(work, lanes, sizeof work);
            ast_kernels_at(i)->eigenvalues(3, work, values, spare);
            if (i == 0) memcpy(plain_values, values, sizeof values);
            TEST_ASSERT_EQUAL_MEMORY(plain_values, values, 3 * AST_LANES * sizeof *values);
            for (int l = 0; l < AST_LANES; l++)
                for (int k = 0; k < 3; k++)
                    TEST_ASSERT_DOUBLE_WITHIN(by_real(1e-11, real_eigen_slack(3)) * wanted[l][0] + 1e-18, wanted[l][k],
                                              (double)values[k * AST_LANES + l]);
        }
    }
}

/* ---- All together ---- */

/* Trackers that differ in nothing but their kernels: the same bits in every result and every distance. */
static void test_a_tracker_gives_the_same_bits_with_all_kernels(void) {
    for (int which = 0; which < SMALL_CONFIGS; which++) {
        const ast_config cfg = small_config_of(which);
        ast_tracker *t[8] = {NULL};
        struct render scene;
        int count = 0;
        while (ast_kernels_at(count) != NULL) count++;
        TEST_ASSERT_LESS_OR_EQUAL_INT(8, count);
        for (int i = 0; i < count; i++) {
            t[i] = tracker_new(&cfg, &ast_linalg_builtin);
            t[i]->kernels = t[i]->desk->features.patch.resampler.kernels = t[i]->features.gradient.kernels =
                t[i]->view.resampler.kernels = ast_kernels_at(i);
        }
        render_open(&scene, 150, 110, 4);
        for (int f = 0; f < 25; f++) {
            const ast_box box = render_path(&scene, f, 30, 24, 0.2, 1.1);
            const ast_frame frame = render_frame(&scene, &box);
            ast_result first = {0}, result = {0};
            for (int i = 0; i < count; i++) {
                ast_particles plain, particles;
                if (f == 0) {
                    TEST_ASSERT_EQUAL_INT(AST_OK, ast_start(t[i], &frame, &box));
                    continue;
                }
                TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(t[i], &frame, i == 0 ? &first : &result));
                TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(t[0], &plain));
                TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(t[i], &particles));
                snprintf(label, sizeof label, "configuration %d, frame %d, %s", which, f, t[i]->kernels->name);
                if (i > 0) TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&first, &result, sizeof result, label);
                TEST_ASSERT_EQUAL_INT(plain.models, particles.models);
                TEST_ASSERT_EQUAL_MEMORY_MESSAGE(plain.distance, particles.distance,
                                                 (size_t)(plain.scored * plain.models) * sizeof(float), label);
            }
        }
        render_close(&scene);
        for (int i = 0; i < count; i++) ast_free(t[i]);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_the_best_is_the_last_and_the_plain_the_first);
    RUN_TEST(test_packing_interleaves_columns);
    RUN_TEST(test_a_panel_product_is_the_sums_in_order_on_every_instruction_set);
    RUN_TEST(test_departing_subtracts_and_measures);
    RUN_TEST(test_solving_undoes_the_triangle);
    RUN_TEST(test_lanes_of_eigenproblems);
    RUN_TEST(test_every_constellation_of_three_eigenvalues);
    RUN_TEST(test_a_tracker_gives_the_same_bits_with_all_kernels);
    return UNITY_END();
}
