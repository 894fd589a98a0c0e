/* The geometry functions of the public header: fits and distances against golden vectors, and what must hold for every input. */
#include "asttrack.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support_golden.h"
#include "support_matrix.h"
#include "support_precision.h"
#include "unity.h"

void setUp(void) {
}
void tearDown(void) {
}

static char label[200];
static const double half_pi = 1.5707963267948966;

/* ---- A set of images, and its subspace ---- */

enum { MOST_VALUES = GOLDEN_MOST_VALUES };

struct fitted {
    float mean[MOST_VALUES], basis[AST_MAX_BASIS * MOST_VALUES];
    ast_subspace subspace;
};

static void fit(struct fitted *to, const float *images, int dim, int stride, int count, int kind, int n) {
    const size_t size = ast_subspace_work_size(dim, count);
    void *work = malloc(size);
    TEST_ASSERT_NOT_NULL(work);
    TEST_ASSERT_EQUAL_INT(AST_OK,
                          ast_subspace_fit(images, dim, stride, count, kind, n, to->mean, to->basis, &to->subspace, work, size));
    free(work);
}

static ast_distance distance_of(const ast_subspace *a, const ast_subspace *b, double alpha) {
    const size_t size = ast_subspace_work_size(a->dim, a->n);
    void *work = malloc(size);
    ast_distance distance;
    TEST_ASSERT_NOT_NULL(work);
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_subspace_distance(a, b, (float)alpha, &distance, work, size));
    free(work);
    return distance;
}

/* What holds for every distance: angles ascending within 0 .. pi/2, zero beyond n, and the parts make the whole. */
static void check_distance(const ast_distance *distance, int n, double alpha) {
    double square = 0;
    for (int l = 0; l < AST_MAX_BASIS; l++) {
        const double angle = (double)distance->angle[l];
        TEST_ASSERT_TRUE_MESSAGE(angle >= 0 && angle <= half_pi + 1e-7, label); /* false for NaN */
        TEST_ASSERT_TRUE_MESSAGE(l == 0 || l >= n || distance->angle[l] >= distance->angle[l - 1], label);
        TEST_ASSERT_TRUE_MESSAGE(l < n || distance->angle[l] == 0.0f, label);
        square += angle * angle;
    }
    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-6, sqrt(square), (double)distance->geodesic, label);
    TEST_ASSERT_TRUE_MESSAGE(distance->mahalanobis >= 0.0f, label);
    const double whole = (double)distance->geodesic + (double)(float)alpha * (double)distance->mahalanobis;
    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-6 * (1 + whole), whole, (double)distance->distance, label);
}

/* The angles are those of two bases whose inner products are rounded to single precision: compare what is defined. */
static void expect_same_angles(const ast_distance *expected, const ast_distance *actual, int n) {
    for (int l = 0; l < n; l++)
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(2 * golden_angle_slack((double)expected->angle[l]), (double)expected->angle[l],
                                          (double)actual->angle[l], label);
}

static void expect_same_distance(const ast_distance *expected, const ast_distance *actual, int n, double size) {
    expect_same_angles(expected, actual, n);
    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(4e-6 * size, (double)expected->mahalanobis, (double)actual->mahalanobis, label);
}

/* ---- Golden vectors ---- */

static void check_golden_case(const struct golden_case *golden) {
    static struct fitted a, b;
    fit(&a, golden->a.images, golden->dim, golden->dim, golden->a.count, golden->basis, golden->n);
    fit(&b, golden->b.images, golden->dim, golden->dim, golden->b.count, golden->basis, golden->n);
    snprintf(label, sizeof label, "case %s", golden->name);
    TEST_ASSERT_EQUAL_INT_MESSAGE(golden->a.rank, a.subspace.rank, label);
    TEST_ASSERT_EQUAL_INT_MESSAGE(golden->b.rank, b.subspace.rank, label);

    const ast_distance distance = distance_of(&a.subspace, &b.subspace, golden->alpha);
    check_distance(&distance, golden->n, golden->alpha);
    for (int l = 0; l < golden->n; l++)
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(golden_angle_slack(golden->angles[l]), golden->angles[l], (double)distance.angle[l],
                                          label);
    const double geodesic_slack = golden_geodesic_slack(golden), term_slack = golden_mahalanobis_slack(golden);
    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(geodesic_slack, golden->geodesic, (double)distance.geodesic, label);
    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(term_slack, golden->mahalanobis, (double)distance.mahalanobis, label);
    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(geodesic_slack + golden->alpha * term_slack + 1e-6, golden->distance,
                                      (double)distance.distance, label);
}

/* Number of cases checked. */
static int check_golden_file(FILE *file, const char *path) {
    static struct golden_case golden;
    int cases = 0, more;
    while ((more = golden_next(file, &golden)) > 0) {
        check_golden_case(&golden);
        cases++;
    }
    fclose(file);
    snprintf(label, sizeof label, "%s, after %d cases: %s", path, cases, golden_fault());
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, more, label);
    return cases;
}

static void test_golden_cases_of_our_own(void) {
    const char *path = "tests/golden/subspaces.txt";
    FILE *file = fopen(path, "r");
    TEST_ASSERT_NOT_NULL_MESSAGE(file, path);
    TEST_ASSERT_EQUAL_INT(68, check_golden_file(file, path));
}

static void test_golden_cases_shared_with_others(void) {
    const char *given = getenv("AST_GOLDEN"), *path = given != NULL ? given : "../shared/golden/subspaces.txt";
    FILE *file = fopen(path, "r");
    TEST_ASSERT_TRUE_MESSAGE(file != NULL || given == NULL, "AST_GOLDEN names a file that cannot be read");
    if (file == NULL) TEST_IGNORE_MESSAGE("golden cases of others not checked: no ../shared/golden/subspaces.txt");
    TEST_ASSERT_GREATER_THAN_INT(0, check_golden_file(file, path));
}

/* ---- Constructed subspaces ---- */

/* A subspace with the basis given in double precision. */
static void make(struct fitted *to, int dim, int n, int rank, const double *basis, const double *mean) {
    for (int d = 0; d < dim; d++) to->mean[d] = (float)mean[d];
    for (int i = 0; i < n * dim; i++) to->basis[i] = i < rank * dim ? (float)basis[i] : 0.0f;
    const ast_subspace subspace = {to->mean, to->basis, dim, dim, n, rank};
    to->subspace = subspace;
}

static void test_known_angles_are_found(void) {
    static const double angles[][4] = {{0, 0, 0, 0},
                                       {0.001, 0.02, 0.3, 1},
                                       {0.5, 0.5, 0.5, 0.5},
                                       {1.5, 1.55, 1.57, 1.5707963267948966},
                                       {0, 0.7, 0.7, 1.5707963267948966}};
    enum { DIM = 50, N = 4 };
    static struct fitted a, b;
    struct noise noise = {1};
    double q[DIM * 2 * N], turned[DIM * N], mean[DIM] = {0};
    for (int set = 0; set < 5; set++) {
        matrix_orthonormal(&noise, DIM, 2 * N, q);
        for (int l = 0; l < N; l++)
            for (int d = 0; d < DIM; d++)
                turned[l * DIM + d] = cos(angles[set][l]) * q[l * DIM + d] + sin(angles[set][l]) * q[(N + l) * DIM + d];
        make(&a, DIM, N, N, q, mean);
        make(&b, DIM, N, N, turned, mean);
        snprintf(label, sizeof label, "angles %g .. %g", angles[set][0], angles[set][3]);
        const ast_distance distance = distance_of(&a.subspace, &b.subspace, 0.5);
        check_distance(&distance, N, 0.5);
        for (int l = 0; l < N; l++)
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(golden_angle_slack(angles[set][l]), angles[set][l], (double)distance.angle[l], label);
        TEST_ASSERT_EQUAL_FLOAT_MESSAGE(0.0f, distance.mahalanobis, label);
    }
}

/* A difference of means counts twice where both subspaces do not explain it, once where one does, not at all where both do. */
static void test_the_mean_term_counts_what_is_not_explained(void) {
    enum { DIM = 30, N = 2 };
    static struct fitted a, b;
    struct noise noise = {2};
    double q[DIM * 4], basis_b[DIM * N], origin[DIM] = {0}, away[DIM];
    matrix_orthonormal(&noise, DIM, 4, q);
    memcpy(basis_b, q + DIM, sizeof basis_b); /* a: q0, q1; b: q1, q2 */
    static const double expected[] = {1, 0, 1, 2};
    for (int direction = 0; direction < 4; direction++) {
        for (int d = 0; d < DIM; d++) away[d] = 3 * q[direction * DIM + d];
        make(&a, DIM, N, N, q, origin);
        make(&b, DIM, N, N, basis_b, away);
        const ast_distance distance = distance_of(&a.subspace, &b.subspace, 0);
        TEST_ASSERT_DOUBLE_WITHIN(2e-5, 9 * expected[direction], (double)distance.mahalanobis);
        TEST_ASSERT_EQUAL_FLOAT(distance.geodesic, distance.distance); /* alpha 0 */
    }
}

static void test_alpha_weighs_the_mean_term_alone(void) {
    enum { DIM = 20, N = 3 };
    static struct fitted a, b;
    struct noise noise = {3};
    float images[DIM * 8];
    noise_fill(&noise, images, DIM * 8, 0, 1);
    fit(&a, images, DIM, DIM, 4, AST_BASIS_CENTRED, N);
    fit(&b, images + 4 * DIM, DIM, DIM, 4, AST_BASIS_CENTRED, N);
    const ast_distance plain = distance_of(&a.subspace, &b.subspace, 0);
    TEST_ASSERT_TRUE(plain.mahalanobis > 0.1f);
    for (double alpha = 0.01; alpha <= 1e6; alpha *= 10) {
        const ast_distance weighed = distance_of(&a.subspace, &b.subspace, alpha);
        check_distance(&weighed, N, alpha);
        TEST_ASSERT_EQUAL_FLOAT(plain.geodesic, weighed.geodesic);
        TEST_ASSERT_EQUAL_FLOAT(plain.mahalanobis, weighed.mahalanobis);
        TEST_ASSERT_TRUE(weighed.distance > plain.distance);
    }
}

/* Absent directions of every pair of ranks: angle 0 where absent from both, pi/2 where from one alone. */
static void test_ranks_below_n(void) {
    enum { DIM = 40, N = 4 };
    static struct fitted a, b;
    struct noise noise = {4};
    double qa[DIM * N], qb[DIM * N], mean[DIM], cross[N * N];
    matrix_orthonormal(&noise, DIM, N, qa);
    matrix_orthonormal(&noise, DIM, N, qb);
    noise_fill_normal(&noise, mean, DIM);
    const double zero[DIM] = {0};
    for (int ra = 0; ra <= N; ra++) {
        for (int rb = 0; rb <= N; rb++) {
            make(&a, DIM, N, ra, qa, mean);
            make(&b, DIM, N, rb, qb, zero);
            snprintf(label, sizeof label, "ranks %d and %d of %d", ra, rb, N);
            const ast_distance distance = distance_of(&a.subspace, &b.subspace, 1);
            check_distance(&distance, N, 1);
            const int least = ra < rb ? ra : rb, most = ra < rb ? rb : ra;
            for (int l = 0; l < N - most; l++) TEST_ASSERT_EQUAL_FLOAT_MESSAGE(0.0f, distance.angle[l], label);
            for (int l = N - most + least; l < N; l++)
                TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-6, half_pi, (double)distance.angle[l], label);
            /* The squared cosines of the others sum to ||Ua'Ub||^2. */
            double sum = 0, found = 0, term = 0;
            matrix_product_transposed(N, N, DIM, qa, qb, cross);
            for (int j = 0; j < rb; j++)
                for (int i = 0; i < ra; i++) sum += cross[j * N + i] * cross[j * N + i];
            for (int l = N - most; l < N - most + least; l++) found += pow(cos((double)distance.angle[l]), 2);
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-6, sum, found, label);
            for (int d = 0; d < DIM; d++) term += 2 * mean[d] * mean[d];
            for (int l = 0; l < N; l++) {
                double along_a = 0, along_b = 0;
                for (int d = 0; d < DIM; d++) {
                    along_a += qa[l * DIM + d] * mean[d];
                    along_b += qb[l * DIM + d] * mean[d];
                }
                if (l < ra) term -= along_a * along_a;
                if (l < rb) term -= along_b * along_b;
            }
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-5 * term, term, (double)distance.mahalanobis, label);
        }
    }
}

/* ---- Invariants ---- */

enum { DIM = 48, MOST_IMAGES = 10 };

/* Random pairs of sets, near and far, of different sizes, with both kinds of basis. */
struct pair {
    float first[DIM * MOST_IMAGES], second[DIM * MOST_IMAGES];
    int first_count, second_count, kind, n;
};

static struct pair random_pair(int trial) {
    struct noise noise = {(uint64_t)trial + 100};
    struct pair pair = {.kind = trial % 2 ? AST_BASIS_RAW : AST_BASIS_CENTRED, .n = noise_int(&noise, 1, 5)};
    pair.first_count = noise_int(&noise, 1, MOST_IMAGES);
    pair.second_count = noise_int(&noise, 1, MOST_IMAGES);
    const double nearness = trial % 3 == 0 ? 0.01 : 1;
    noise_fill(&noise, pair.first, DIM * MOST_IMAGES, 0, 1);
    noise_fill(&noise, pair.second, DIM * MOST_IMAGES, 0, 1);
    for (int i = 0; i < DIM * MOST_IMAGES; i++)
        pair.second[i] = (float)(nearness * (double)pair.second[i] + (1 - nearness) * (double)pair.first[i]);
    if (trial % 3 == 0) pair.second_count = pair.first_count;
    snprintf(label, sizeof label, "trial %d: %d and %d images, %s, n %d", trial, pair.first_count, pair.second_count,
             pair.kind == AST_BASIS_RAW ? "raw" : "centred", pair.n);
    return pair;
}

static ast_distance distance_between(const struct pair *pair, double alpha) {
    static struct fitted a, b;
    fit(&a, pair->first, DIM, DIM, pair->first_count, pair->kind, pair->n);
    fit(&b, pair->second, DIM, DIM, pair->second_count, pair->kind, pair->n);
    return distance_of(&a.subspace, &b.subspace, alpha);
}

enum { TRIALS = 60 };

static void test_distance_is_symmetric(void) {
    static struct fitted a, b;
    for (int trial = 0; trial < TRIALS; trial++) {
        const struct pair pair = random_pair(trial);
        fit(&a, pair.first, DIM, DIM, pair.first_count, pair.kind, pair.n);
        fit(&b, pair.second, DIM, DIM, pair.second_count, pair.kind, pair.n);
        const ast_distance there = distance_of(&a.subspace, &b.subspace, 0.7), back = distance_of(&b.subspace, &a.subspace, 0.7);
        check_distance(&there, pair.n, 0.7);
        expect_same_distance(&there, &back, pair.n, 1);
    }
}

static void test_distance_to_itself_is_zero(void) {
    static struct fitted a;
    for (int trial = 0; trial < TRIALS; trial++) {
        const struct pair pair = random_pair(trial);
        fit(&a, pair.first, DIM, DIM, pair.first_count, pair.kind, pair.n);
        const ast_distance distance = distance_of(&a.subspace, &a.subspace, 0.7);
        for (int l = 0; l < pair.n; l++)
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(golden_angle_slack(0), 0, (double)distance.angle[l], label);
        TEST_ASSERT_EQUAL_FLOAT_MESSAGE(0.0f, distance.mahalanobis, label);
    }
}

/* The geodesic distance is a metric on subspaces of one dimension. */
static void test_geodesic_keeps_the_triangle_inequality(void) {
    static struct fitted a, b, c;
    struct noise noise = {5};
    float images[DIM * 12];
    for (int trial = 0; trial < TRIALS; trial++) {
        noise_fill(&noise, images, DIM * 12, 0, 1);
        for (int i = 0; i < 4 * DIM; i++) images[4 * DIM + i] = 0.3f * images[4 * DIM + i] + 0.7f * images[i]; /* b lies near a */
        fit(&a, images, DIM, DIM, 4, AST_BASIS_CENTRED, 3);
        fit(&b, images + 4 * DIM, DIM, DIM, 4, AST_BASIS_CENTRED, 3);
        fit(&c, images + 8 * DIM, DIM, DIM, 4, AST_BASIS_CENTRED, 3);
        const float ab = distance_of(&a.subspace, &b.subspace, 0).geodesic, bc = distance_of(&b.subspace, &c.subspace, 0).geodesic,
                    ac = distance_of(&a.subspace, &c.subspace, 0).geodesic;
        TEST_ASSERT_TRUE(ab <= ac + bc + 1e-5f && bc <= ab + ac + 1e-5f && ac <= ab + bc + 1e-5f);
        TEST_ASSERT_TRUE(ab > 0.01f && bc > 0.01f && ac > 0.01f);
    }
}

/* A basis is one of many of its subspace: U R, R orthogonal n x n, reflections included, is another. */
static void test_rotation_of_a_basis_changes_nothing(void) {
    static struct fitted a, b, rotated;
    struct noise noise = {6};
    for (int trial = 0; trial < TRIALS; trial++) {
        const struct pair pair = random_pair(trial);
        double r[AST_MAX_BASIS * AST_MAX_BASIS];
        fit(&a, pair.first, DIM, DIM, pair.first_count, pair.kind, pair.n);
        fit(&b, pair.second, DIM, DIM, pair.second_count, pair.kind, pair.n);
        const int rank = b.subspace.rank;
        if (rank == 0) continue;
        matrix_orthonormal(&noise, rank, rank, r);
        rotated = b;
        rotated.subspace.mean = rotated.mean;
        rotated.subspace.basis = rotated.basis;
        for (int l = 0; l < rank; l++) {
            for (int d = 0; d < DIM; d++) {
                double sum = 0;
                for (int i = 0; i < rank; i++) sum += (double)b.basis[i * DIM + d] * r[l * rank + i];
                rotated.basis[l * DIM + d] = (float)sum;
            }
        }
        const ast_distance before = distance_of(&a.subspace, &b.subspace, 0.7),
                           after = distance_of(&a.subspace, &rotated.subspace, 0.7);
        expect_same_distance(&before, &after, pair.n, 4);
    }
}

static void test_order_of_the_images_changes_nothing(void) {
    for (int trial = 0; trial < TRIALS; trial++) {
        const struct pair pair = random_pair(trial);
        struct pair turned = pair;
        for (int j = 0; j < pair.first_count; j++) /* backwards */
            memcpy(turned.first + j * DIM, pair.first + (pair.first_count - 1 - j) * DIM, DIM * sizeof(float));
        const ast_distance before = distance_between(&pair, 0.7), after = distance_between(&turned, 0.7);
        expect_same_distance(&before, &after, pair.n, 4);
    }
}

static void test_a_shift_of_the_images_keeps_the_centred_angles(void) {
    struct noise noise = {7};
    for (int trial = 0; trial < TRIALS; trial += 2) { /* the centred ones */
        const struct pair pair = random_pair(trial);
        struct pair one = pair, both = pair;
        float shift[DIM];
        noise_fill(&noise, shift, DIM, -1, 1);
        for (int i = 0; i < DIM * MOST_IMAGES; i++) {
            one.first[i] += shift[i % DIM];
            both.first[i] += shift[i % DIM];
            both.second[i] += shift[i % DIM];
        }
        TEST_ASSERT_EQUAL_INT(AST_BASIS_CENTRED, pair.kind);
        const ast_distance before = distance_between(&pair, 0.7), after_one = distance_between(&one, 0.7),
                           after_both = distance_between(&both, 0.7);
        expect_same_angles(&before, &after_one, pair.n);
        expect_same_distance(&before, &after_both, pair.n, 10);
    }
}

static void test_an_orthogonal_transform_of_the_space_changes_nothing(void) {
    struct noise noise = {8};
    static double q[DIM * DIM];
    matrix_orthonormal(&noise, DIM, DIM, q);
    for (int trial = 0; trial < TRIALS; trial++) {
        const struct pair pair = random_pair(trial);
        struct pair turned = pair;
        for (int j = 0; j < MOST_IMAGES; j++) {
            for (int d = 0; d < DIM; d++) {
                double first = 0, second = 0;
                for (int i = 0; i < DIM; i++) {
                    first += q[i * DIM + d] * (double)pair.first[j * DIM + i];
                    second += q[i * DIM + d] * (double)pair.second[j * DIM + i];
                }
                turned.first[j * DIM + d] = (float)first;
                turned.second[j * DIM + d] = (float)second;
            }
        }
        const ast_distance before = distance_between(&pair, 0.7), after = distance_between(&turned, 0.7);
        expect_same_distance(&before, &after, pair.n, 10);
    }
}

/* Units of the pixels: angles do not have any, the mean term goes with their square. */
static void test_scale_of_the_images(void) {
    for (int trial = 0; trial < TRIALS; trial++) {
        const struct pair pair = random_pair(trial);
        const ast_distance before = distance_between(&pair, 0.7);
        static const float scales[] = {1e-15f, 1.0f / 255, 255.0f, 1e15f};
        for (int s = 0; s < 4; s++) {
            struct pair scaled = pair;
            for (int i = 0; i < DIM * MOST_IMAGES; i++) {
                scaled.first[i] *= scales[s];
                scaled.second[i] *= scales[s];
            }
            const ast_distance after = distance_between(&scaled, 0.7);
            expect_same_angles(&before, &after, pair.n);
            const double unit = (double)scales[s] * (double)scales[s];
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(2e-5, (double)before.mahalanobis, (double)after.mahalanobis / unit, label);
        }
    }
}

/* ---- Degenerate sets ---- */

/* Every pair of sets that a camera can freeze, darken or saturate: defined numbers, symmetric, and zero from a set to itself. */
static void test_degenerate_sets_have_defined_distances(void) {
    enum { COUNT = 5, KINDS = 9 };
    static float sets[KINDS][DIM * COUNT];
    static struct fitted fits[KINDS];
    struct noise noise = {9};
    noise_fill(&noise, sets[0], DIM * COUNT, 0, 1); /* ordinary */
    for (int i = 0; i < DIM * COUNT; i++) {
        sets[1][i] = 0.0f;                                            /* black */
        sets[2][i] = 1.0f;                                            /* white */
        sets[3][i] = sets[0][i % DIM];                                /* frozen */
        sets[4][i] = (float)(i / DIM);                                /* flat, of changing light */
        sets[5][i] = sets[0][i % DIM] * (float)(1 + i / DIM % 2);     /* two images */
        sets[6][i] = i == 3 ? 1.0f : 0.0f;                            /* one pixel of one image */
        sets[7][i] = i % DIM == 0 ? 1e-30f * (float)(i / DIM) : 0.0f; /* all but black */
        sets[8][i] = 0.5f + (i % DIM == i / DIM ? 1e-6f : 0.0f);      /* movement below the tolerance */
    }
    const int all_but_black = AST_REAL_IS_DOUBLE ? 1 : 0; /* its squares are nothing in single precision */
    const int rank_centred[KINDS] = {4, 0, 0, 0, 1, 1, 1, all_but_black, 0},
              rank_raw[KINDS] = {4, 0, 1, 1, 1, 1, 1, all_but_black, 1};
    for (int n = 1; n <= 4; n += 3) {
        for (int kind = AST_BASIS_CENTRED; kind <= AST_BASIS_RAW; kind++) {
            for (int s = 0; s < KINDS; s++) {
                fit(&fits[s], sets[s], DIM, DIM, COUNT, kind, n);
                const int rank = kind == AST_BASIS_RAW ? rank_raw[s] : rank_centred[s];
                snprintf(label, sizeof label, "degenerate set %d, n %d, %s", s, n, kind == AST_BASIS_RAW ? "raw" : "centred");
                TEST_ASSERT_EQUAL_INT_MESSAGE(rank < n ? rank : n, fits[s].subspace.rank, label);
            }
            for (int s = 0; s < KINDS; s++) {
                for (int t = 0; t < KINDS; t++) {
                    snprintf(label, sizeof label, "degenerate sets %d and %d, n %d, %s", s, t, n, kind ? "raw" : "centred");
                    const ast_distance there = distance_of(&fits[s].subspace, &fits[t].subspace, 0.7),
                                       back = distance_of(&fits[t].subspace, &fits[s].subspace, 0.7);
                    check_distance(&there, n, 0.7);
                    expect_same_distance(&there, &back, n, 100);
                    if (s == t) TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(golden_angle_slack(0) * n, 0, (double)there.distance, label);
                }
            }
        }
    }
}

/* ---- Fits ---- */

static void test_the_stride_skips_what_lies_between_images(void) {
    enum { PAD = 7 };
    static struct fitted packed, spaced;
    struct noise noise = {10};
    float images[DIM * 4], apart[(DIM + PAD) * 4];
    noise_fill(&noise, images, DIM * 4, 0, 1);
    for (int i = 0; i < (DIM + PAD) * 4; i++)
        apart[i] = i % (DIM + PAD) < DIM ? images[i / (DIM + PAD) * DIM + i % (DIM + PAD)] : NAN;
    fit(&packed, images, DIM, DIM, 4, AST_BASIS_CENTRED, 3);
    fit(&spaced, apart, DIM, DIM + PAD, 4, AST_BASIS_CENTRED, 3);
    TEST_ASSERT_EQUAL_MEMORY(packed.mean, spaced.mean, DIM * sizeof(float));
    TEST_ASSERT_EQUAL_MEMORY(packed.basis, spaced.basis, 3 * DIM * sizeof(float));

    /* The same of a subspace's columns, as the tracker's models have them. */
    static float loose[3 * (DIM + PAD)];
    for (int i = 0; i < 3 * (DIM + PAD); i++)
        loose[i] = i % (DIM + PAD) < DIM ? packed.basis[i / (DIM + PAD) * DIM + i % (DIM + PAD)] : NAN;
    ast_subspace other = packed.subspace;
    other.basis = loose;
    other.stride = DIM + PAD;
    const ast_distance distance = distance_of(&packed.subspace, &other, 1);
    TEST_ASSERT_DOUBLE_WITHIN(2 * golden_angle_slack(0), 0, (double)distance.distance);
}

static void test_a_fit_says_where_its_results_are(void) {
    static struct fitted a;
    float images[DIM * 3];
    struct noise noise = {11};
    noise_fill(&noise, images, DIM * 3, 0, 1);
    fit(&a, images, DIM, DIM, 3, AST_BASIS_CENTRED, 5);
    TEST_ASSERT_EQUAL_PTR(a.mean, a.subspace.mean);
    TEST_ASSERT_EQUAL_PTR(a.basis, a.subspace.basis);
    TEST_ASSERT_EQUAL_INT(DIM, a.subspace.dim);
    TEST_ASSERT_EQUAL_INT(DIM, a.subspace.stride);
    TEST_ASSERT_EQUAL_INT(5, a.subspace.n);
    TEST_ASSERT_EQUAL_INT(2, a.subspace.rank);
    for (int i = 2 * DIM; i < 5 * DIM; i++) TEST_ASSERT_TRUE(a.basis[i] == 0.0f);
    for (int d = 0; d < DIM; d++)
        TEST_ASSERT_DOUBLE_WITHIN(1e-7, ((double)images[d] + (double)images[DIM + d] + (double)images[2 * DIM + d]) / 3,
                                  (double)a.mean[d]);
}

static void test_the_largest_problem(void) {
    enum { BIG = 2000, COUNT = AST_MAX_HISTORY + 1 };
    static struct fitted a, b;
    struct noise noise = {12};
    float *images = malloc((size_t)BIG * COUNT * sizeof *images);
    TEST_ASSERT_NOT_NULL(images);
    noise_fill(&noise, images, (size_t)BIG * COUNT, 0, 1);
    fit(&a, images, BIG, BIG, COUNT, AST_BASIS_CENTRED, AST_MAX_BASIS);
    for (size_t i = 0; i < (size_t)BIG * COUNT; i++) images[i] = -images[i];
    fit(&b, images, BIG, BIG, COUNT, AST_BASIS_CENTRED, AST_MAX_BASIS);
    const ast_distance distance = distance_of(&a.subspace, &b.subspace, 0);
    snprintf(label, sizeof label, "a set and its negative");
    check_distance(&distance, AST_MAX_BASIS, 0);
    TEST_ASSERT_EQUAL_INT(AST_MAX_BASIS, a.subspace.rank);
    TEST_ASSERT_DOUBLE_WITHIN(AST_MAX_BASIS * golden_angle_slack(0), 0, (double)distance.geodesic);
    free(images);
}

/* ---- Workspace ---- */

static void test_work_size(void) {
    TEST_ASSERT_EQUAL_UINT(0, ast_subspace_work_size(0, 1));
    TEST_ASSERT_EQUAL_UINT(0, ast_subspace_work_size(-5, 1));
    TEST_ASSERT_EQUAL_UINT(0, ast_subspace_work_size(10, 0));
    TEST_ASSERT_EQUAL_UINT(0, ast_subspace_work_size(10, -1));
    TEST_ASSERT_EQUAL_UINT(0, ast_subspace_work_size(10, AST_MAX_HISTORY + 2));
    TEST_ASSERT_GREATER_THAN_UINT(0, ast_subspace_work_size(1, 1));
    TEST_ASSERT_GREATER_THAN_UINT(0, ast_subspace_work_size(10, AST_MAX_HISTORY + 1));
}

/* At every address, of every size of problem: what lies around the workspace stays as it is. */
static void test_the_workspace_has_the_size_it_says(void) {
    enum { GUARD = 64 };
    static struct fitted a;
    float images[20 * 16];
    struct noise noise = {13};
    noise_fill(&noise, images, 20 * 16, 0, 1);
    for (int dim = 1; dim <= 20; dim += 3) {
        for (int count = 1; count <= 16; count += 3) {
            const int n = count < AST_MAX_BASIS ? count : AST_MAX_BASIS;
            const size_t size = ast_subspace_work_size(dim, count), distance_size = ast_subspace_work_size(dim, n);
            unsigned char *block = malloc(size + 3 * GUARD);
            TEST_ASSERT_NOT_NULL(block);
            for (size_t offset = 0; offset < GUARD; offset += dim == 1 ? 1 : 13) {
                unsigned char *work = block + GUARD + offset;
                memset(block, 0xa5, size + 3 * GUARD);
                ast_distance distance;
                TEST_ASSERT_EQUAL_INT(
                    AST_OK, ast_subspace_fit(images, dim, dim, count, AST_BASIS_RAW, n, a.mean, a.basis, &a.subspace, work, size));
                TEST_ASSERT_EQUAL_INT(AST_OK,
                                      ast_subspace_distance(&a.subspace, &a.subspace, 1.0f, &distance, work, distance_size));
                for (size_t i = 0; i < GUARD + offset; i++) TEST_ASSERT_EQUAL_HEX8(0xa5, block[i]);
                for (size_t i = GUARD + offset + size; i < size + 3 * GUARD; i++) TEST_ASSERT_EQUAL_HEX8(0xa5, block[i]);
            }
            free(block);
        }
    }
}

/* ---- Errors ---- */

static void test_fit_names_its_errors(void) {
    float images[8 * 3] = {0}, mean[8], basis[8 * AST_MAX_BASIS];
    ast_subspace out;
    double work[400];
    const size_t size = sizeof work;
    TEST_ASSERT_LESS_THAN_UINT(size, ast_subspace_work_size(8, 3));
#define FIT(images, dim, stride, count, kind, n, mean, basis, out, work, size)                                                     \
    ast_subspace_fit(images, dim, stride, count, kind, n, mean, basis, out, work, size)
    TEST_ASSERT_EQUAL_INT(AST_OK, FIT(images, 8, 8, 3, AST_BASIS_CENTRED, 2, mean, basis, &out, work, size));
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, FIT(NULL, 8, 8, 3, AST_BASIS_CENTRED, 2, mean, basis, &out, work, size));
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, FIT(images, 8, 8, 3, AST_BASIS_CENTRED, 2, NULL, basis, &out, work, size));
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, FIT(images, 8, 8, 3, AST_BASIS_CENTRED, 2, mean, NULL, &out, work, size));
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, FIT(images, 8, 8, 3, AST_BASIS_CENTRED, 2, mean, basis, NULL, work, size));
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, FIT(images, 8, 8, 3, AST_BASIS_CENTRED, 2, mean, basis, &out, NULL, size));
    static const int wrong[][5] = {/* dim, stride, count, kind, n */
                                   {0, 8, 3, 0, 2},
                                   {-1, 8, 3, 0, 2},
                                   {8, 7, 3, 0, 2},
                                   {8, 8, 0, 0, 2},
                                   {8, 8, -1, 0, 2},
                                   {8, 8, AST_MAX_HISTORY + 2, 0, 2},
                                   {8, 8, 3, 2, 2},
                                   {8, 8, 3, -1, 2},
                                   {8, 8, 3, 0, 0},
                                   {8, 8, 3, 0, -1},
                                   {8, 8, 3, 0, AST_MAX_BASIS + 1}};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
        TEST_ASSERT_EQUAL_INT(AST_E_RANGE, FIT(images, wrong[i][0], wrong[i][1], wrong[i][2], wrong[i][3], wrong[i][4], mean, basis,
                                               &out, work, size));
    TEST_ASSERT_EQUAL_INT(AST_E_BUFFER,
                          FIT(images, 8, 8, 3, AST_BASIS_CENTRED, 2, mean, basis, &out, work, ast_subspace_work_size(8, 3) - 1));
    TEST_ASSERT_EQUAL_INT(AST_OK,
                          FIT(images, 8, 8, 3, AST_BASIS_CENTRED, 2, mean, basis, &out, work, ast_subspace_work_size(8, 3)));
#undef FIT
}

static void test_distance_names_its_errors(void) {
    static struct fitted a;
    float images[8 * 3];
    struct noise noise = {14};
    double work[400];
    ast_distance out;
    noise_fill(&noise, images, 8 * 3, 0, 1);
    fit(&a, images, 8, 8, 3, AST_BASIS_CENTRED, 2);
    const ast_subspace *good = &a.subspace;
    const size_t size = ast_subspace_work_size(8, 2);
    TEST_ASSERT_LESS_OR_EQUAL_UINT(sizeof work, size);
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_subspace_distance(good, good, 1.0f, &out, work, size));
    TEST_ASSERT_EQUAL_INT(AST_E_BUFFER, ast_subspace_distance(good, good, 1.0f, &out, work, size - 1));
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, ast_subspace_distance(NULL, good, 1.0f, &out, work, size));
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, ast_subspace_distance(good, NULL, 1.0f, &out, work, size));
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, ast_subspace_distance(good, good, 1.0f, NULL, work, size));
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, ast_subspace_distance(good, good, 1.0f, &out, NULL, size));
    TEST_ASSERT_EQUAL_INT(AST_E_RANGE, ast_subspace_distance(good, good, -0.1f, &out, work, size));
    TEST_ASSERT_EQUAL_INT(AST_E_RANGE, ast_subspace_distance(good, good, 2e6f, &out, work, size));
    TEST_ASSERT_EQUAL_INT(AST_E_RANGE, ast_subspace_distance(good, good, NAN, &out, work, size));
    TEST_ASSERT_EQUAL_INT(AST_E_RANGE, ast_subspace_distance(good, good, INFINITY, &out, work, size));

    enum { CHANGES = 11 };
    for (int change = 0; change < CHANGES; change++) {
        ast_subspace bad = *good;
        int expected = AST_E_RANGE;
        switch (change) {
        case 0: bad.dim = 0; break;
        case 1: bad.dim = 7; break; /* legal, but not the other's */
        case 2: bad.stride = 7; break;
        case 3: bad.n = 0; break;
        case 4: bad.n = AST_MAX_BASIS + 1; break;
        case 5: bad.n = 3; break; /* legal, but not the other's */
        case 6: bad.rank = -1; break;
        case 7: bad.rank = 3; break;
        case 8: bad.stride = -8; break;
        case 9:
            bad.mean = NULL;
            expected = AST_E_NULL;
            break;
        default:
            bad.basis = NULL;
            expected = AST_E_NULL;
            break;
        }
        snprintf(label, sizeof label, "change %d", change);
        TEST_ASSERT_EQUAL_INT_MESSAGE(expected, ast_subspace_distance(good, &bad, 1.0f, &out, work, size), label);
        TEST_ASSERT_EQUAL_INT_MESSAGE(expected, ast_subspace_distance(&bad, good, 1.0f, &out, work, size), label);
    }
}

/* LAPACK's decomposition of a NaN may not end. */
static void test_values_that_are_not_finite_are_refused(void) {
    static struct fitted a;
    static const float bad[] = {NAN, INFINITY, -INFINITY};
    struct noise noise = {15};
    float images[8 * 3], kept;
    double work[400];
    ast_distance out;
    const size_t size = ast_subspace_work_size(8, 3);
    TEST_ASSERT_LESS_OR_EQUAL_UINT(sizeof work, size);
    noise_fill(&noise, images, 8 * 3, 0, 1);
    for (int i = 0; i < 9; i++) {
        fit(&a, images, 8, 8, 3, AST_BASIS_CENTRED, 2);
        float *at = i / 3 == 0 ? &images[8 * 3 - 1] : i / 3 == 1 ? &a.mean[7] : &a.basis[8];
        kept = *at;
        *at = bad[i % 3];
        if (i / 3 == 0)
            TEST_ASSERT_EQUAL_INT(AST_E_RANGE, ast_subspace_fit(images, 8, 8, 3, AST_BASIS_CENTRED, 2, a.mean, a.basis, &a.subspace,
                                                                work, sizeof work));
        else
            TEST_ASSERT_EQUAL_INT(AST_E_RANGE, ast_subspace_distance(&a.subspace, &a.subspace, 1.0f, &out, work, sizeof work));
        *at = kept;
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_golden_cases_of_our_own);
    RUN_TEST(test_golden_cases_shared_with_others);
    RUN_TEST(test_known_angles_are_found);
    RUN_TEST(test_the_mean_term_counts_what_is_not_explained);
    RUN_TEST(test_alpha_weighs_the_mean_term_alone);
    RUN_TEST(test_ranks_below_n);
    RUN_TEST(test_distance_is_symmetric);
    RUN_TEST(test_distance_to_itself_is_zero);
    RUN_TEST(test_geodesic_keeps_the_triangle_inequality);
    RUN_TEST(test_rotation_of_a_basis_changes_nothing);
    RUN_TEST(test_order_of_the_images_changes_nothing);
    RUN_TEST(test_a_shift_of_the_images_keeps_the_centred_angles);
    RUN_TEST(test_an_orthogonal_transform_of_the_space_changes_nothing);
    RUN_TEST(test_scale_of_the_images);
    RUN_TEST(test_degenerate_sets_have_defined_distances);
    RUN_TEST(test_the_stride_skips_what_lies_between_images);
    RUN_TEST(test_a_fit_says_where_its_results_are);
    RUN_TEST(test_the_largest_problem);
    RUN_TEST(test_work_size);
    RUN_TEST(test_the_workspace_has_the_size_it_says);
    RUN_TEST(test_fit_names_its_errors);
    RUN_TEST(test_distance_names_its_errors);
    RUN_TEST(test_values_that_are_not_finite_are_refused);
    return UNITY_END();
}
