/* The arithmetic of the bench: medians, ratios, growth. */
#include <math.h>

#include "statistics.h"
#include "unity.h"

void setUp(void) {
}
void tearDown(void) {
}

static void test_a_spread_has_the_ends_and_the_middle(void) {
    const double odd[] = {5, 1, 4, 2, 3}, even[] = {4, 1, 3, 2};
    struct spread s = spread_of(odd, 5);
    TEST_ASSERT_EQUAL_DOUBLE(1, s.least);
    TEST_ASSERT_EQUAL_DOUBLE(3, s.median);
    TEST_ASSERT_EQUAL_DOUBLE(5, s.greatest);
    TEST_ASSERT_EQUAL_INT(5, s.count);
    s = spread_of(even, 4);
    TEST_ASSERT_EQUAL_DOUBLE(2.5, s.median);
    TEST_ASSERT_EQUAL_DOUBLE(5, odd[0]); /* the samples stay in their order: they are paired with others */
}

static void test_samples_that_are_none_are_left_out(void) {
    const double samples[] = {NAN, 7, NAN, 9, 8};
    struct spread s = spread_of(samples, 5);
    TEST_ASSERT_EQUAL_DOUBLE(8, s.median);
    TEST_ASSERT_EQUAL_INT(3, s.count);
    s = spread_of(samples, 1);
    TEST_ASSERT_EQUAL_INT(0, s.count);
    TEST_ASSERT_TRUE(isnan(s.least) && isnan(s.median) && isnan(s.greatest));
    TEST_ASSERT_EQUAL_INT(0, spread_of(samples, 0).count);
}

/* A machine that is twice as slow for a while must not show: the quotient is taken side by side, not between the medians. */
static void test_ratios_are_taken_side_by_side(void) {
    const double above[] = {10, 20, 10, 20, 40}, below[] = {5, 10, 5, 10, 20};
    const struct spread s = spread_of_ratios(above, below, 5);
    TEST_ASSERT_EQUAL_DOUBLE(2, s.least);
    TEST_ASSERT_EQUAL_DOUBLE(2, s.median);
    TEST_ASSERT_EQUAL_DOUBLE(2, s.greatest);
}

static void test_more_samples_than_are_looked_at(void) {
    double samples[SPREAD_MOST + 5];
    for (int i = 0; i < SPREAD_MOST + 5; i++) samples[i] = 1 + i;
    TEST_ASSERT_EQUAL_INT(SPREAD_MOST, spread_of(samples, SPREAD_MOST + 5).count);
    TEST_ASSERT_EQUAL_DOUBLE(SPREAD_MOST, spread_of(samples, SPREAD_MOST + 5).greatest);
    TEST_ASSERT_EQUAL_INT(SPREAD_MOST, spread_of_ratios(samples, samples, SPREAD_MOST + 5).count);
}

static void test_growth_finds_the_exponent_of_a_power(void) {
    const double size[] = {100, 200, 500, 1000, 2000, 5000, 10000};
    double time[7];
    for (int e = -1; e <= 3; e++) {
        for (int i = 0; i < 7; i++) time[i] = 3e-6 * pow(size[i], 0.5 * e);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.5 * e, growth_exponent(size, time, 7));
    }
}

/* Least squares: noise that is symmetric in the logarithm leaves the exponent where it is, a fixed cost lowers it. */
static void test_growth_with_noise_and_with_a_fixed_cost(void) {
    const double size[] = {1, 2, 4, 8}, noisy[] = {1.1, 2 / 1.1, 4 / 1.1, 8 * 1.1}, fixed[] = {11, 12, 14, 18};
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1, growth_exponent(size, noisy, 4));
    const double exponent = growth_exponent(size, fixed, 4);
    TEST_ASSERT_TRUE(exponent > 0.1 && exponent < 0.4);
}

static void test_growth_of_too_little(void) {
    const double size[] = {100, 100, 0}, time[] = {1, 2, 3}, none[] = {1, 0, NAN};
    TEST_ASSERT_TRUE(isnan(growth_exponent(size, time, 0)));
    TEST_ASSERT_TRUE(isnan(growth_exponent(size, time, 1)));
    TEST_ASSERT_TRUE(isnan(growth_exponent(size, time, 2)));
    TEST_ASSERT_TRUE(isnan(growth_exponent(size, time, 3)));
    TEST_ASSERT_TRUE(isnan(growth_exponent(time, none, 2)));
    TEST_ASSERT_TRUE(isnan(growth_exponent(time, none, 3)));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_spread_has_the_ends_and_the_middle);
    RUN_TEST(test_samples_that_are_none_are_left_out);
    RUN_TEST(test_ratios_are_taken_side_by_side);
    RUN_TEST(test_more_samples_than_are_looked_at);
    RUN_TEST(test_growth_finds_the_exponent_of_a_power);
    RUN_TEST(test_growth_with_noise_and_with_a_fixed_cost);
    RUN_TEST(test_growth_of_too_little);
    return UNITY_END();
}
