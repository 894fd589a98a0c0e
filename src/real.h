/* The number type of the small problems (inner products of a history, eigen-problems, distances, likelihoods).
 *
 * Pixels, bases and means are always float. What is derived from them by subtraction and inversion is held in ast_real: double
 * unless AST_REAL says otherwise (-DAST_REAL=float for processors whose FPU has single precision only). */
#ifndef AST_REAL_H
#define AST_REAL_H

#include <float.h>
#include <math.h>

#ifndef AST_REAL
#define AST_REAL double
#endif
typedef AST_REAL ast_real;

/* One branch is dead at compile time, so a float build links no double function. */
static inline ast_real ast_sqrt(ast_real v) {
    return sizeof(ast_real) == sizeof(float) ? (ast_real)sqrtf((float)v) : (ast_real)sqrt((double)v);
}
static inline ast_real ast_acos(ast_real v) {
    return sizeof(ast_real) == sizeof(float) ? (ast_real)acosf((float)v) : (ast_real)acos((double)v);
}
static inline ast_real ast_cos(ast_real v) {
    return sizeof(ast_real) == sizeof(float) ? (ast_real)cosf((float)v) : (ast_real)cos((double)v);
}
static inline ast_real ast_exp(ast_real v) {
    return sizeof(ast_real) == sizeof(float) ? (ast_real)expf((float)v) : (ast_real)exp((double)v);
}
static inline ast_real ast_fabs(ast_real v) {
    return v < 0 ? -v : v;
}
static inline ast_real ast_real_epsilon(void) {
    return sizeof(ast_real) == sizeof(float) ? (ast_real)FLT_EPSILON : (ast_real)DBL_EPSILON;
}

#define AST_HALF_PI ((ast_real)1.57079632679489661923)

#endif
