/* The number type of the small problems (inner products of a history, eigen-problems, distances, likelihoods).
 *
 * Pixels, bases and means are always float. What is derived from them by subtraction and inversion is held in ast_real: double
 * unless AST_REAL says otherwise (-DAST_REAL=float for processors whose FPU has single precision only). */
#ifndef AST_REAL_H
#define AST_REAL_H

#include <float.h>

#include "build.h"
#include "dialect.h"
#include "maths.h"

typedef AST_REAL ast_real;

/* 1 or 0, for the preprocessor: a float build compiles no double function. */
#define AST_REAL_IS_float 0
#define AST_REAL_IS_double 1
#define AST_REAL_NAMED(type) AST_REAL_IS_##type
#define AST_REAL_EXPANDED(type) AST_REAL_NAMED(type)
#define AST_REAL_IS_DOUBLE AST_REAL_EXPANDED(AST_REAL)

#if AST_REAL_IS_DOUBLE
#define AST_REAL_LEAST DBL_MIN
static inline ast_real ast_real_epsilon(void) {
    return DBL_EPSILON;
}
static inline ast_real ast_sqrt(ast_real v) {
    return AST_SQUARE_ROOT(v);
}
static inline ast_real ast_acos(ast_real v) {
    return ast_acos_double(v);
}
/* For |v| <= pi / 3. */
static inline ast_real ast_cos(ast_real v) {
    return ast_cos_double(v);
}
static inline ast_real ast_exp(ast_real v) {
    return ast_exp_double(v);
}
#else
#define AST_REAL_LEAST FLT_MIN
static inline ast_real ast_real_epsilon(void) {
    return FLT_EPSILON;
}
static inline ast_real ast_sqrt(ast_real v) {
    return ast_sqrtf(v);
}
static inline ast_real ast_acos(ast_real v) {
    return ast_acosf(v);
}
static inline ast_real ast_cos(ast_real v) {
    return ast_cosf(v);
}
static inline ast_real ast_exp(ast_real v) {
    return ast_expf(v);
}
#endif
static inline ast_real ast_fabs(ast_real v) {
    return v < 0 ? -v : v;
}

#define AST_HALF_PI ((ast_real)1.57079632679489661923)

#endif
