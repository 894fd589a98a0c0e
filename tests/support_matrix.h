/* Dense double-precision matrices for tests, column-major, written from their definitions and sharing nothing with the library. */
#ifndef SUPPORT_MATRIX_H
#define SUPPORT_MATRIX_H

#include "support_noise.h"

/* Zeroed; ends the program when there is no memory. free() it. */
double *matrix_new(int rows, int cols);
/* c (rows x cols) = a (rows x inner) b (inner x cols), all packed. */
void matrix_product(int rows, int cols, int inner, const double *a, const double *b, double *c);
/* c (rows x cols) = a' b, a: depth x rows, b: depth x cols, all packed. */
void matrix_product_transposed(int rows, int cols, int depth, const double *a, const double *b, double *c);
/* Random orthonormal columns, rows x cols, cols <= rows: an orthogonal matrix when it is square. */
void matrix_orthonormal(struct noise *noise, int rows, int cols, double *q);
/* u diag(values) v' with random orthonormal u (rows x count) and v (cols x count): a matrix with these singular values, the others
 * zero. */
void matrix_with_singular_values(struct noise *noise, int rows, int cols, int count, const double *values, double *a);
/* Largest |x_i'x_j - (i == j)| of the columns of x: 0 when they are orthonormal. NaN when x holds one. */
double matrix_orthonormality_error(int rows, int cols, const double *x);
/* Largest |value|; NaN when there is one. */
double matrix_largest(const double *x, size_t count);

#endif
