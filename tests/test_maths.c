/* The library's own elementary functions against the C library's in higher precision: the ulp bounds that maths.h states. */
#include "maths.h"

#include <float.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "real.h"
#include "support_watched.h"
#include "unity.h"

void setUp(void) {
}
void tearDown(void) {
}

/* The spacing of floats (digits = FLT_MANT_DIG) or doubles at an exact value. */
static long double ulp(long double exact, int digits, int least_exponent) {
    int exponent;
    (void)frexpl(exact, &exponent);
    if (exponent < least_exponent) exponent = least_exponent;
    return ldexpl(1.0L, exponent - digits);
}

/* ---- Single precision: the reference is the C library in double precision ---- */

struct single {
    const char *name;
    float (*own)(float);
    double (*reference)(double);
    float from, to;
    double bound;  /* ulps */
    double finest; /* results below it are measured in its ulps */
};

/* The floats of an interval, `step` apart in their order, both ends among them. */
static int32_t order_of(float x) {
    int32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits < 0 ? INT32_MIN - bits : bits;
}
static float float_at(int32_t order) {
    const int32_t bits = order < 0 ? INT32_MIN - order : order;
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static double worst_of(const struct single *f, int32_t step, float *where) {
    double worst = 0;
    const int64_t last = order_of(f->to);
    for (int64_t at = order_of(f->from);; at = at + step < last ? at + step : last) {
        const float x = float_at((int32_t)at);
        const double exact = f->reference((double)x), size = fabs(exact) < f->finest ? f->finest : fabs(exact);
        const double error = fabs((double)f->own(x) - exact) / (double)ulp(size, FLT_MANT_DIG, FLT_MIN_EXP);
        if (!(error <= worst)) {
            worst = error;
            *where = x;
        }
        if (at == last) return worst;
    }
}

static void test_single_precision_keeps_its_bounds(void) {
    static const struct single functions[] = {
        {"expf, results in the normal range", ast_expf, exp, -87.3365f, 88.7228f, 1.0, 0},
        {"expf, small arguments", ast_expf, exp, -1.0f, 1.0f, 1.0, 0},
        {"logf, all positive floats", ast_logf, log, FLT_MIN, FLT_MAX, 1.0, 0},
        {"logf, around 1", ast_logf, log, 0.5f, 2.0f, 1.0, 0},
        {"sinf, a turn", ast_sinf, sin, -6.2831853f, 6.2831853f, 2.5, 0x1p-10},
        {"sinf, its domain", ast_sinf, sin, -1000.0f, 1000.0f, 2.5, 0x1p-10},
        {"cosf, a turn", ast_cosf, cos, -6.2831853f, 6.2831853f, 2.5, 0x1p-10},
        {"cosf, its domain", ast_cosf, cos, -1000.0f, 1000.0f, 2.5, 0x1p-10},
        {"acosf", ast_acosf, acos, -1.0f, 1.0f, 1.5, 0},
    };
    for (size_t f = 0; f < sizeof functions / sizeof functions[0]; f++) {
        char text[120];
        float where = 0.0f;
        const double worst = worst_of(&functions[f], 1009, &where); /* a prime: about two million arguments each */
        (void)snprintf(text, sizeof text, "%s: %.3f ulps at %.9g, bound %.1f", functions[f].name, worst, (double)where,
                       functions[f].bound);
        puts(text);
        TEST_ASSERT_TRUE_MESSAGE(worst <= functions[f].bound, text);
        TEST_ASSERT_TRUE_MESSAGE(worst > 0.45, "a float function that is better than correctly rounded is not measured rightly");
    }
}

/* ---- Double precision: the reference is the C library in long double, where that is wider ---- */

#if AST_REAL_IS_DOUBLE && LDBL_MANT_DIG > DBL_MANT_DIG

struct twice {
    const char *name;
    double (*own)(double);
    long double (*reference)(long double);
    double from, to, bound;
};

/* What the reference itself may be off by, ulps: nothing that counts, but where long double has no more digits than double, as on
 * some processors and under valgrind. */
static double doubt(void) {
    const volatile long double one = 1.0L, little = DBL_EPSILON / 4;
    return one + little == one ? 1.0 : 0.0;
}

static void test_double_precision_keeps_its_bounds(void) {
    enum { POINTS = WATCHED ? 100000 : 1000000 };
    static const struct twice functions[] = {
        {"exp, results in the normal range", ast_exp_double, expl, -708.396, 709.782, 1.0},
        {"exp, small arguments", ast_exp_double, expl, -1.0, 1.0, 1.0},
        {"cos", ast_cos_double, cosl, -1.0471975511965976, 1.0471975511965976, 1.5},
        {"acos", ast_acos_double, acosl, -1.0, 1.0, 1.5},
        {"acos near 1", ast_acos_double, acosl, 1.0 - 1e-6, 1.0, 1.5},
    };
    for (size_t f = 0; f < sizeof functions / sizeof functions[0]; f++) {
        char text[120];
        long double worst = 0;
        double where = 0;
        for (int i = 0; i <= POINTS; i++) {
            const double x = functions[f].from + (functions[f].to - functions[f].from) * (double)i / POINTS;
            const long double exact = functions[f].reference((long double)x);
            const long double error = fabsl((long double)functions[f].own(x) - exact) / ulp(exact, DBL_MANT_DIG, DBL_MIN_EXP);
            if (!(error <= worst)) {
                worst = error;
                where = x;
            }
        }
        (void)snprintf(text, sizeof text, "%s: %.3f ulps at %.17g, bound %.1f", functions[f].name, (double)worst, where,
                       functions[f].bound);
        puts(text);
        TEST_ASSERT_TRUE_MESSAGE(worst <= (long double)(functions[f].bound + doubt()), text);
        TEST_ASSERT_TRUE_MESSAGE(worst > 0.45L, "a function that is better than correctly rounded is not measured rightly");
    }
}

static void test_double_precision_is_defined_everywhere(void) {
    TEST_ASSERT_TRUE(ast_exp_double(-1e300) == 0.0 && ast_exp_double(-HUGE_VAL) == 0.0 && ast_exp_double(1e300) == HUGE_VAL);
    TEST_ASSERT_TRUE(ast_exp_double(0.0) == 1.0);
    TEST_ASSERT_TRUE(ast_acos_double(1.0) == 0.0 && ast_acos_double(2.0) == 0.0 && ast_acos_double(-2.0) == acos(-1.0));
    TEST_ASSERT_TRUE(ast_acos_double(0.0) == acos(0.0) && ast_cos_double(0.0) == 1.0);
    TEST_ASSERT_TRUE(ast_exp_double((double)NAN) != ast_exp_double((double)NAN));
}

#endif

/* ---- What is exact ---- */

static void test_rounding_is_exact(void) {
    static const float values[] = {0.0f,       0.25f,       0.5f, 1.0f,  1.5f,    2.0f,   8388607.5f,
                                   8388608.0f, 16777215.0f, 3e9f, 1e30f, FLT_MAX, FLT_MIN};
    for (size_t v = 0; v < sizeof values / sizeof values[0]; v++) {
        for (int sign = -1; sign <= 1; sign += 2) {
            const float x = (float)sign * values[v];
            TEST_ASSERT_TRUE(ast_floorf(x) == floorf(x));
            TEST_ASSERT_TRUE(ast_ceilf(x) == ceilf(x));
            TEST_ASSERT_TRUE(ast_fabsf(x) == fabsf(x));
        }
    }
    for (int32_t at = order_of(-1e9f); at < order_of(1e9f) - 100003; at += 100003) {
        const float x = float_at(at);
        TEST_ASSERT_TRUE(ast_floorf(x) == floorf(x) && ast_ceilf(x) == ceilf(x));
    }
}

static void test_square_root_is_correctly_rounded(void) {
    for (int32_t at = order_of(FLT_MIN); at < order_of(FLT_MAX) - 100003; at += 100003) {
        const float x = float_at(at);
        TEST_ASSERT_TRUE(ast_sqrtf(x) ==
                         (float)sqrt((double)x)); /* a double has more than twice the digits: rounding twice is right */
    }
}

static void test_single_precision_is_defined_everywhere(void) {
    TEST_ASSERT_TRUE(ast_expf(-1e30f) == 0.0f && ast_expf(-HUGE_VALF) == 0.0f && ast_expf(1e30f) == HUGE_VALF);
    TEST_ASSERT_TRUE(ast_expf(0.0f) == 1.0f);
    TEST_ASSERT_TRUE(ast_logf(1.0f) == 0.0f && ast_logf(HUGE_VALF) == HUGE_VALF);
    TEST_ASSERT_TRUE(ast_logf(0.0f) == ast_logf(FLT_MIN) && ast_logf(-1.0f) == ast_logf(FLT_MIN));
    TEST_ASSERT_TRUE(ast_sinf(0.0f) == 0.0f && ast_cosf(0.0f) == 1.0f);
    TEST_ASSERT_TRUE(ast_sinf(HUGE_VALF) == 0.0f && ast_cosf(-HUGE_VALF) == 1.0f && ast_sinf(NAN) == 0.0f);
    TEST_ASSERT_TRUE(ast_acosf(1.0f) == 0.0f && ast_acosf(1.5f) == 0.0f && ast_acosf(-1.5f) == (float)acos(-1.0));
    TEST_ASSERT_TRUE(ast_acosf(0.0f) == (float)acos(0.0));
    TEST_ASSERT_TRUE(ast_expf(NAN) != ast_expf(NAN) && ast_logf(NAN) != ast_logf(NAN));
    TEST_ASSERT_TRUE(ast_floorf(NAN) != ast_floorf(NAN) && ast_floorf(HUGE_VALF) == HUGE_VALF);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_single_precision_keeps_its_bounds);
    RUN_TEST(test_single_precision_is_defined_everywhere);
#if AST_REAL_IS_DOUBLE && LDBL_MANT_DIG > DBL_MANT_DIG
    RUN_TEST(test_double_precision_keeps_its_bounds);
    RUN_TEST(test_double_precision_is_defined_everywhere);
#endif
    RUN_TEST(test_rounding_is_exact);
    RUN_TEST(test_square_root_is_correctly_rounded);
    return UNITY_END();
}
