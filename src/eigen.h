/* Small dense symmetric eigen-problems. */
#ifndef AST_EIGEN_H
#define AST_EIGEN_H

#include "real.h"

/* Eigenvalues of a symmetric n x n matrix (column-major, both triangles; destroyed), descending, by cyclic Jacobi rotations. vectors:
 * n x n, receives the eigenvectors as columns in the same order; NULL when they are not wanted. Without them a 3 x 3 matrix, which
 * every pair of candidate and model of the presets has, is solved in closed form where that is
 * accurate. */
void ast_eigen_symmetric(int n, ast_real *a, ast_real *values, ast_real *vectors);

#endif
