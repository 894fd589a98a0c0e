/* What the type of ast_real costs: the one place for the tests' bounds that depend on it.
 *
 * In double precision all that a test sees is that results are rounded to float. With -DAST_REAL=float sums and decompositions
 * round as coarsely as their results do, and errors grow as the standard analysis says (u = FLT_EPSILON / 2, the unit roundoff):
 *
 *  - a sum of `count` terms, one after the other, is good to (count - 1) u times the sum of their sizes;
 *  - e^x is good to |x| times the relative error of x, beside its own;
 *  - the singular vectors of a set are good to u times a small multiple of its condition: its norm over the least singular value
 *    that counts; what is computed from them (inner products, whose arccosine is an angle) is no better. */
#ifndef SUPPORT_PRECISION_H
#define SUPPORT_PRECISION_H

#include <float.h>
#include <math.h>

#include "real.h"

/* One bound for each type. */
static inline double by_real(double in_double, double in_float) {
    return AST_REAL_IS_DOUBLE ? in_double : in_float;
}

/* Of a sum of `count` terms in ast_real, relative to the sum of their sizes. */
static inline double real_sum_slack(int count) {
    return by_real(0, 0.5 * (double)FLT_EPSILON * count);
}

/* Of a power e^x, relative, when x comes of a quotient whose divisor is a mean of `count` terms. */
static inline double real_power_slack(int count, double x) {
    return (real_sum_slack(count) + by_real(0, 2 * (double)FLT_EPSILON)) * (1 + fabs(x));
}

/* Of an inner product of two unit vectors that were computed in ast_real and kept in float: the rounding of what is kept, and in
 * float the sums of the orthogonalisation, whose rotations stop at 4 FLT_EPSILON. */
static inline double real_cosine_slack(void) {
    return by_real(4, 16) * (double)FLT_EPSILON;
}

/* Of what is computed from the singular vectors of a set of this condition. The fast path takes what a candidate adds to a set from
 * a difference of squares that may have lost nineteen parts of twenty: twenty times the rounding, of a dozen operations. The most
 * seen is 160. */
static inline double real_basis_slack(double condition) {
    return by_real(0, 256 * (double)FLT_EPSILON) * condition;
}

/* Of eigenvalues and eigenvectors of symmetric matrices of order n, relative to the largest eigenvalue. */
static inline double real_eigen_slack(int n) {
    return by_real(1e-13, 8 * (double)FLT_EPSILON) * n;
}

#endif
