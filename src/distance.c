#include "distance.h"

void ast_principal_angles(const ast_real *cosines, int rank_a, int rank_b, int n, ast_real *angles) {
    const int both = rank_a < rank_b ? rank_a : rank_b;
    const int either = rank_a < rank_b ? rank_b : rank_a;
    int l = 0;
    for (; l < n - either; l++) angles[l] = 0;
    for (int c = 0; c < both; c++, l++) angles[l] = cosines[c] >= 1 ? 0 : cosines[c] > 0 ? ast_acos(cosines[c]) : AST_HALF_PI;
    for (; l < n; l++) angles[l] = AST_HALF_PI;
}

ast_real ast_geodesic(const ast_real *angles, int n) {
    ast_real sum = 0;
    for (int l = 0; l < n; l++) sum += angles[l] * angles[l];
    return ast_sqrt(sum);
}

ast_real ast_mahalanobis(ast_real square, const ast_real *a, int rank_a, const ast_real *b, int rank_b) {
    ast_real term = 2 * square;
    for (int l = 0; l < rank_a; l++) term -= a[l] * a[l];
    for (int l = 0; l < rank_b; l++) term -= b[l] * b[l];
    return term > 0 ? term : 0;
}
