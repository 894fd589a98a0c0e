/* The random generator against the published PCG32, and the normal numbers made of it against the error function. */
#include "random.h"

#include <math.h>
#include <string.h>

#include "support_statistics.h"
#include "unity.h"

void setUp(void) {
}
void tearDown(void) {
}

/* ---- A reference of its own: states by jumping ahead in the congruential sequence, outputs bit by bit ---- */

#define MULTIPLIER UINT64_C(6364136223846793005)
#define LIBRARY_STREAM UINT64_C(721347520444481703) /* increment 2 stream + 1 */

/* The state that `steps` advances lead to: a^steps state + c (a^(steps - 1) + .. + 1), by repeated squaring of the affine map. */
static uint64_t jump(uint64_t state, uint64_t increment, uint64_t steps) {
    uint64_t a = 1, c = 0, square_a = MULTIPLIER, square_c = increment;
    for (; steps > 0; steps /= 2) {
        if (steps % 2 == 1) {
            a *= square_a;
            c = c * square_a + square_c;
        }
        square_c *= square_a + 1;
        square_a *= square_a;
    }
    return a * state + c;
}

/* "XSH RR": bit i of the output is bit (i + turn) mod 32 of the shifted state. */
static uint32_t output(uint64_t state) {
    const uint64_t shifted = (state ^ state / (UINT64_C(1) << 18)) / (UINT64_C(1) << 27);
    const unsigned turn = (unsigned)(state / (UINT64_C(1) << 59));
    uint32_t bits = 0;
    for (unsigned i = 0; i < 32; i++) bits |= (uint32_t)(shifted >> ((i + turn) % 32) & 1u) << i;
    return bits;
}

/* The k-th number (from 0) of a seed in a stream: the seeding takes two advances, with the seed added between them. */
static uint32_t reference(uint64_t seed, uint64_t stream, uint64_t k) {
    const uint64_t increment = 2 * stream + 1;
    return output(jump(jump(0, increment, 1) + seed, increment, 1 + k));
}

static void test_the_reference_gives_the_published_numbers(void) {
    static const uint32_t published[] = {0xa15c02b7, 0x7b47f409, 0xba1d3330, 0x83d2f293, 0xbfa4784b, 0xcbed606e};
    for (uint64_t k = 0; k < 6; k++) TEST_ASSERT_EQUAL_HEX32(published[k], reference(42, 54, k));
}

static void test_bits_are_pcg32(void) {
    static const uint64_t seeds[] = {0, 1, 42, UINT64_C(0x8000000000000000), UINT64_MAX};
    for (size_t s = 0; s < sizeof seeds / sizeof seeds[0]; s++) {
        struct ast_random random;
        ast_random_seed(&random, seeds[s]);
        for (uint64_t k = 0; k < 2000; k++)
            TEST_ASSERT_EQUAL_HEX32(reference(seeds[s], LIBRARY_STREAM, k), ast_random_bits(&random));
    }
}

static void test_seed_forgets_the_past(void) {
    struct ast_random fresh, used;
    memset(&fresh, 0, sizeof fresh);
    memset(&used, 0x5a, sizeof used);
    ast_random_seed(&fresh, 7);
    ast_random_seed(&used, 7);
    TEST_ASSERT_EQUAL_HEX64(fresh.state, used.state);
}

/* ---- Uniform numbers ---- */

/* A state whose output starts with 32 equal bits: the xor-shift of 18 bits is undone by repeating it. */
static uint64_t state_of_ones(void) {
    const uint64_t shifted = UINT64_C(0xffffffff) << 27;
    return shifted ^ shifted >> 18 ^ shifted >> 36 ^ shifted >> 54;
}

static void test_uniform_is_in_the_open_interval(void) {
    struct ast_random least = {0}, greatest = {state_of_ones()};
    TEST_ASSERT_EQUAL_HEX32(0, output(least.state));
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, output(greatest.state));
    TEST_ASSERT_EQUAL_FLOAT(0x1p-24f, ast_random_uniform(&least));
    const float top = ast_random_uniform(&greatest);
    TEST_ASSERT_TRUE(top < 1.0f);
    TEST_ASSERT_TRUE((double)top == 1.0 - 0x1p-24);
}

static void test_uniform_takes_the_leading_bits(void) {
    struct ast_random random;
    ast_random_seed(&random, 3);
    for (uint64_t k = 0; k < 1000; k++) {
        const double expected = (floor(reference(3, LIBRARY_STREAM, k) / 512.0) + 0.5) / 8388608.0;
        TEST_ASSERT_TRUE((double)ast_random_uniform(&random) == expected);
    }
}

static void test_uniform_fills_its_bins(void) {
    enum { BINS = 64, DRAWS = 200000 };
    double observed[BINS] = {0}, pairs[BINS] = {0}, expected[BINS];
    struct ast_random random;
    ast_random_seed(&random, 11);
    int last = 0;
    for (int i = 0; i < DRAWS; i++) {
        const int bin = (int)(ast_random_uniform(&random) * BINS);
        observed[bin]++;
        pairs[8 * (last / 8) + bin / 8]++; /* eighths of successive numbers */
        last = bin;
    }
    for (int b = 0; b < BINS; b++) expected[b] = (double)DRAWS / BINS;
    TEST_ASSERT_TRUE(chi_square(observed, expected, BINS) < chi_square_limit(BINS - 1));
    TEST_ASSERT_TRUE(chi_square(pairs, expected, BINS) < chi_square_limit(BINS - 1));
}

/* ---- Normal numbers ---- */

static void test_quantile_inverts_the_error_function(void) {
    double worst = 0;
    for (int i = 0; i < 4000; i++) {
        const float p = ((float)i + 0.5f) / 4000.0f;
        worst = fmax(worst, fabs((double)ast_normal_quantile(p) - normal_inverse((double)p)));
    }
    TEST_ASSERT_TRUE_MESSAGE(worst < 1e-6, "the middle");

    /* Every tail that a uniform number can have, in halvings. The approximation is good to a few units in the last place of a
     * float, which are 5e-7 each beyond 4. */
    for (float p = 0.25f; p >= 0x1p-24f; p *= 0.5f) {
        const double low = normal_inverse((double)p);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6 * fmax(1.0, -low), low, (double)ast_normal_quantile(p));
        TEST_ASSERT_DOUBLE_WITHIN(1e-6 * fmax(1.0, -low), -low, (double)ast_normal_quantile(1.0f - p));
    }
    TEST_ASSERT_TRUE(ast_normal_quantile(0.5f) == 0.0f);
}

static void test_quantile_rises_across_its_seams(void) {
    static const float seams[] = {0.075f, 0.925f, 1.3887944e-11f, 0.5f}; /* |p - 1/2| = 0.425; sqrt(-log p) = 5 */
    for (size_t s = 0; s < sizeof seams / sizeof seams[0]; s++) {
        const float width = seams[s] * 1e-3f, below = ast_normal_quantile(seams[s] - width),
                    above = ast_normal_quantile(seams[s] + width);
        const double slope_below = (double)(ast_normal_quantile(seams[s]) - below),
                     slope_above = (double)(above - ast_normal_quantile(seams[s]));
        TEST_ASSERT_TRUE(slope_below > 0 && slope_above > 0);
        TEST_ASSERT_DOUBLE_WITHIN(0.05 * slope_below, slope_below, slope_above);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-5, normal_inverse(1e-14), (double)ast_normal_quantile(1e-14f));
}

static void test_quantile_is_odd(void) {
    for (int i = 1; i < 500; i++) {
        const float p = (float)i / 1024.0f; /* 1 - p is exact */
        TEST_ASSERT_TRUE(ast_normal_quantile(p) == -ast_normal_quantile(1.0f - p));
    }
}

static void test_normal_is_the_quantile_of_one_uniform(void) {
    struct ast_random one, other;
    ast_random_seed(&one, 5);
    other = one;
    for (int i = 0; i < 100; i++) TEST_ASSERT_TRUE(ast_random_normal(&one) == ast_normal_quantile(ast_random_uniform(&other)));
    TEST_ASSERT_EQUAL_HEX64(other.state, one.state);
}

static void test_normal_has_the_normal_distribution(void) {
    enum { BINS = 40, DRAWS = 100000 };
    double observed[BINS] = {0}, expected[BINS], sum = 0, square = 0;
    struct ast_random random;
    ast_random_seed(&random, 13);
    for (int i = 0; i < DRAWS; i++) {
        const double x = (double)ast_random_normal(&random);
        sum += x;
        square += x * x;
        observed[(int)(BINS * normal_probability(x))]++; /* bins of equal probability */
    }
    for (int b = 0; b < BINS; b++) expected[b] = (double)DRAWS / BINS;
    TEST_ASSERT_TRUE(chi_square(observed, expected, BINS) < chi_square_limit(BINS - 1));
    TEST_ASSERT_DOUBLE_WITHIN(5.0 / sqrt(DRAWS), 0.0, sum / DRAWS);
    TEST_ASSERT_DOUBLE_WITHIN(5.0 * sqrt(2.0 / DRAWS), 1.0, square / DRAWS);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_the_reference_gives_the_published_numbers);
    RUN_TEST(test_bits_are_pcg32);
    RUN_TEST(test_seed_forgets_the_past);
    RUN_TEST(test_uniform_is_in_the_open_interval);
    RUN_TEST(test_uniform_takes_the_leading_bits);
    RUN_TEST(test_uniform_fills_its_bins);
    RUN_TEST(test_quantile_inverts_the_error_function);
    RUN_TEST(test_quantile_rises_across_its_seams);
    RUN_TEST(test_quantile_is_odd);
    RUN_TEST(test_normal_is_the_quantile_of_one_uniform);
    RUN_TEST(test_normal_has_the_normal_distribution);
    return UNITY_END();
}
