/* Small dense symmetric eigen-problems. */
#ifndef AST_EIGEN_H
#define AST_EIGEN_H

#include "real.h"

/* Eigenvalues of a symmetric n x n matrix (column-major, both triangles; destroyed), descending, by cyclic Jacobi rotations.
 * vectors: n x n, receives the eigenvectors as columns in the same order; NULL when they are not wanted. For many matrices at once:
 * kernels.h. */
void ast_eigen_symmetric(int n, ast_real *a, ast_real *values, ast_real *vectors);

#endif
