/* The elementary functions that the tracker needs, of its own: a C library's differ from one to the next in the last bits, and the
 * same frames must give the same bits on every machine. Only arithmetic that IEEE 754 rounds exactly is used, in a fixed order, so
 * that holds wherever a float is a float (FLT_EVAL_METHOD 0) and products are not contracted (-ffp-contract=off).
 *
 * A bound in ulps is the largest error against the exact value, in units of the result's last place, over the domain stated;
 * tests/test_maths.c measures it. Outside a domain the result is defined, never a trap. */
#ifndef AST_MATHS_H
#define AST_MATHS_H

#include <math.h>

/* Square roots are exact everywhere. With -fno-math-errno the compiler emits the processor's instruction and calls nothing. */
#if defined(__GNUC__)
#define AST_SQUARE_ROOT_F __builtin_sqrtf
#define AST_SQUARE_ROOT __builtin_sqrt
#else
#define AST_SQUARE_ROOT_F sqrtf
#define AST_SQUARE_ROOT sqrt
#endif

static inline float ast_sqrtf(float x) {
    return AST_SQUARE_ROOT_F(x);
}
static inline float ast_fabsf(float x) {
    return x < 0.0f ? -x : x;
}
/* Exact. */
static inline float ast_floorf(float x) {
    if (!(ast_fabsf(x) < 8388608.0f)) return x; /* from 2^23 on every float is whole */
    const float whole = (float)(int)x;
    return whole > x ? whole - 1.0f : whole;
}
static inline float ast_ceilf(float x) {
    return -ast_floorf(-x);
}

/* e^x: 1 ulp. 0 where the result would be below FLT_MIN, infinity where it would be above FLT_MAX. */
float ast_expf(float x);
/* Natural logarithm: 1 ulp for x >= FLT_MIN. What is smaller counts as FLT_MIN. */
float ast_logf(float x);
/* Sine and cosine: 2.5 ulps of the result, or of 2^-10 where that is more, for |x| <= 1000. 0 and 1 beyond 10000. */
float ast_sinf(float x);
float ast_cosf(float x);
/* Arc cosine: 1.5 ulps, 0 .. pi. An argument outside -1 .. 1 counts as the nearer end. */
float ast_acosf(float x);

/* The same in double precision, for builds whose ast_real (real.h) is double: 1 ulp for the exponential, 1.5 for the cosine and its
 * inverse; the cosine for |x| <= pi / 3 only, all that is asked of it. */
double ast_exp_double(double x);
double ast_cos_double(double x);
double ast_acos_double(double x);

#endif
