#include "distance.h"

#include <stdlib.h>

#include "support_matrix.h"
#include "unity.h"

void setUp(void) {
}
void tearDown(void) {
}

enum { MOST = 8 };
static const double half_pi = 1.5707963267948966;

static void test_angles_are_the_arccosines_ascending(void) {
    const double expected[] = {0.1, 0.7, 1.2, 1.5};
    ast_real cosines[4], angles[4];
    for (int l = 0; l < 4; l++) cosines[l] = (ast_real)cos(expected[l]);
    ast_principal_angles(cosines, 4, 4, 4, angles);
    for (int l = 0; l < 4; l++) TEST_ASSERT_DOUBLE_WITHIN(64 * ast_real_epsilon(), expected[l], angles[l]);
}

static void test_cosines_outside_their_range_are_clipped(void) {
    const ast_real cosines[] = {(ast_real)1.0000001, 1, 0, (ast_real)-1e-9};
    ast_real angles[4];
    ast_principal_angles(cosines, 4, 4, 4, angles);
    TEST_ASSERT_EQUAL_DOUBLE(0, angles[0]);
    TEST_ASSERT_EQUAL_DOUBLE(0, angles[1]);
    TEST_ASSERT_DOUBLE_WITHIN(4 * ast_real_epsilon(), half_pi, angles[2]);
    TEST_ASSERT_DOUBLE_WITHIN(4 * ast_real_epsilon(), half_pi, angles[3]);
}

/* Of n directions, n - max(a, b) are absent from both and n - min(a, b) from one at least. */
static void test_absent_directions_of_every_pair_of_ranks(void) {
    const double cosine[MOST] = {0.95, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3};
    for (int n = 1; n <= MOST; n++) {
        for (int a = 0; a <= n; a++) {
            for (int b = 0; b <= n; b++) {
                const int least = a < b ? a : b, most = a < b ? b : a;
                ast_real cosines[MOST], angles[MOST + 1];
                for (int l = 0; l < MOST; l++) cosines[l] = l < least ? (ast_real)cosine[l] : (ast_real)NAN;
                angles[n] = 77;
                ast_principal_angles(cosines, a, b, n, angles);
                for (int l = 0; l < n; l++) {
                    const int given = l - (n - most);
                    const double expected = given < 0 ? 0 : given < least ? acos(cosine[given]) : half_pi;
                    TEST_ASSERT_DOUBLE_WITHIN(64 * ast_real_epsilon(), expected, angles[l]);
                }
                TEST_ASSERT_EQUAL_DOUBLE(77, angles[n]);
            }
        }
    }
}

static void test_no_direction_needs_no_cosine(void) {
    ast_real angles[3];
    ast_principal_angles(NULL, 0, 0, 3, angles);
    for (int l = 0; l < 3; l++) TEST_ASSERT_EQUAL_DOUBLE(0, angles[l]);
    ast_principal_angles(NULL, 0, 2, 3, angles);
    TEST_ASSERT_EQUAL_DOUBLE(0, angles[0]);
    TEST_ASSERT_DOUBLE_WITHIN(4 * ast_real_epsilon(), half_pi, angles[1]);
    TEST_ASSERT_DOUBLE_WITHIN(4 * ast_real_epsilon(), half_pi, angles[2]);
}

static void test_geodesic_is_the_two_norm(void) {
    const ast_real angles[] = {(ast_real)0.3, (ast_real)0.4, (ast_real)1.2};
    TEST_ASSERT_EQUAL_DOUBLE(0, ast_geodesic(angles, 0));
    TEST_ASSERT_DOUBLE_WITHIN(4 * ast_real_epsilon(), 0.3, ast_geodesic(angles, 1));
    TEST_ASSERT_DOUBLE_WITHIN(4 * ast_real_epsilon(), 0.5, ast_geodesic(angles, 2));
    TEST_ASSERT_DOUBLE_WITHIN(4 * ast_real_epsilon(), 1.3, ast_geodesic(angles, 3));
}

/* d'(2 I - A A' - B B')d with the D x D matrix formed. */
static void test_mahalanobis_is_its_quadratic_form(void) {
    enum { D = 12, A = 3, B = 2 };
    struct noise noise = {1};
    for (int trial = 0; trial < 20; trial++) {
        double a[D * A], b[D * B], d[D], form = 0;
        matrix_orthonormal(&noise, D, A, a);
        matrix_orthonormal(&noise, D, B, b);
        noise_fill_normal(&noise, d, D);
        for (int i = 0; i < D; i++) {
            for (int j = 0; j < D; j++) {
                double element = i == j ? 2 : 0;
                for (int l = 0; l < A; l++) element -= a[l * D + i] * a[l * D + j];
                for (int l = 0; l < B; l++) element -= b[l * D + i] * b[l * D + j];
                form += d[i] * element * d[j];
            }
        }
        double along_a[A], along_b[B], square;
        ast_real given_a[A], given_b[B];
        matrix_product_transposed(A, 1, D, a, d, along_a);
        matrix_product_transposed(B, 1, D, b, d, along_b);
        matrix_product_transposed(1, 1, D, d, d, &square);
        for (int l = 0; l < A; l++) given_a[l] = (ast_real)along_a[l];
        for (int l = 0; l < B; l++) given_b[l] = (ast_real)along_b[l];
        const ast_real term = ast_mahalanobis((ast_real)square, given_a, A, given_b, B);
        TEST_ASSERT_DOUBLE_WITHIN(100 * ast_real_epsilon() * square, form, term);
        const ast_real exchanged = ast_mahalanobis((ast_real)square, given_b, B, given_a, A);
        TEST_ASSERT_DOUBLE_WITHIN(100 * ast_real_epsilon() * square, term, exchanged);
    }
}

static void test_mahalanobis_without_directions_is_twice_the_square(void) {
    TEST_ASSERT_EQUAL_DOUBLE(6, ast_mahalanobis(3, NULL, 0, NULL, 0));
}

/* A difference that lies in both subspaces costs nothing, and rounding must not make it less. */
static void test_mahalanobis_is_never_negative(void) {
    const ast_real along = (ast_real)1.0000001;
    TEST_ASSERT_EQUAL_DOUBLE(0, ast_mahalanobis(1, &along, 1, &along, 1));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_angles_are_the_arccosines_ascending);
    RUN_TEST(test_cosines_outside_their_range_are_clipped);
    RUN_TEST(test_absent_directions_of_every_pair_of_ranks);
    RUN_TEST(test_no_direction_needs_no_cosine);
    RUN_TEST(test_geodesic_is_the_two_norm);
    RUN_TEST(test_mahalanobis_is_its_quadratic_form);
    RUN_TEST(test_mahalanobis_without_directions_is_twice_the_square);
    RUN_TEST(test_mahalanobis_is_never_negative);
    return UNITY_END();
}
