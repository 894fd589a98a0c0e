#include "vector.h"

#include <string.h>

#include "support_noise.h"
#include "unity.h"

void setUp(void) {
}
void tearDown(void) {
}

enum { LONGEST = 1500 };

static double reference_dot(const float *x, const float *y, int n) {
    long double sum = 0;
    for (int d = 0; d < n; d++) sum += (long double)x[d] * (long double)y[d];
    return (double)sum;
}

static void test_matches_the_definition_at_every_length(void) {
    static float x[LONGEST], y[LONGEST];
    struct noise noise = {1};
    for (int n = 0; n <= LONGEST; n = n < 70 ? n + 1 : n + 110) {
        noise_fill(&noise, x, (size_t)n, -1, 1);
        noise_fill(&noise, y, (size_t)n, -1, 1);
        TEST_ASSERT_DOUBLE_WITHIN(4 * (double)ast_real_epsilon() * n, reference_dot(x, y, n), ast_dot(x, y, n));
    }
}

static void test_every_element_counts_once_and_none_beyond(void) {
    float x[40], y[40];
    for (int n = 1; n < 40; n++) {
        for (int d = 0; d < n; d++) {
            for (int i = 0; i < 40; i++) {
                x[i] = i == d ? 2.0f : i < n ? 0.0f : NAN;
                y[i] = i < n ? (float)(i + 3) : NAN;
            }
            TEST_ASSERT_EQUAL_DOUBLE(2.0 * (d + 3), ast_dot(x, y, n));
        }
    }
}

static void test_of_nothing_is_zero(void) {
    const float value = NAN;
    TEST_ASSERT_EQUAL_DOUBLE(0.0, ast_dot(&value, &value, 0));
}

/* Single-precision sums would lose the one, whose absolute weight is below the rounding of the others. */
static void test_sums_are_held_in_double_precision(void) {
    if (sizeof(ast_real) == sizeof(float)) TEST_IGNORE_MESSAGE("not applicable: ast_real is float in this build");
    const float x[] = {1e8f, 1.0f, -1e8f, 1e-3f}, y[] = {1.0f, 1.0f, 1.0f, 1.0f};
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, 1.0 + (double)1e-3f, ast_dot(x, y, 4));
}

static void test_is_symmetric_and_the_same_bits_at_any_address(void) {
    static float x[LONGEST + 16], y[LONGEST + 16], copy[LONGEST + 16];
    struct noise noise = {2};
    const int n = 1023;
    noise_fill(&noise, x, LONGEST, -1, 1);
    noise_fill(&noise, y, LONGEST, -1, 1);
    const ast_real once = ast_dot(x, y, n);
    const ast_real swapped = ast_dot(y, x, n);
    TEST_ASSERT_EQUAL_MEMORY(&once, &swapped, sizeof once);
    for (int offset = 1; offset < 16; offset++) {
        memcpy(copy + offset, x, (size_t)n * sizeof *x);
        const ast_real again = ast_dot(copy + offset, y, n);
        TEST_ASSERT_EQUAL_MEMORY(&once, &again, sizeof once);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_matches_the_definition_at_every_length);
    RUN_TEST(test_every_element_counts_once_and_none_beyond);
    RUN_TEST(test_of_nothing_is_zero);
    RUN_TEST(test_sums_are_held_in_double_precision);
    RUN_TEST(test_is_symmetric_and_the_same_bits_at_any_address);
    return UNITY_END();
}
