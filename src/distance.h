/* Principal angles and the distance of two affine subspaces (paper eq. 2 to 5), from the numbers that every way of computing them
 * ends with. */
#ifndef AST_DISTANCE_H
#define AST_DISTANCE_H

#include "real.h"

/* Principal angles, ascending, of two subspaces of which rank_a and rank_b of n directions are present. cosines: the min(rank_a,
 * rank_b) singular values of Ua'Ub, descending; clipped to [0, 1] here. Directions absent from both are at angle 0, those absent
 * from one alone at pi/2. angles: n. */
void ast_principal_angles(const ast_real *cosines, int rank_a, int rank_b, int n, ast_real *angles);
/* |angles|_2 (eq. 3). */
ast_real ast_geodesic(const ast_real *angles, int n);
/* 2 d'd - |Ua'd|^2 - |Ub'd|^2 (from eq. 5), never below zero. */
ast_real ast_mahalanobis(ast_real square, const ast_real *a, int rank_a, const ast_real *b, int rank_b);

#endif
