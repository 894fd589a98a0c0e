/* The metric in which distances are measured (the M of the paper's eq. 2): the identity, or one in which directions along which the
 * background varies count less,
 *
 *     M = I - Zc' (Zc Zc' + ridge tr(Zc Zc') I)^-1 Zc,   Zc = the background's vectors minus their mean m_b, as rows.
 *
 * M is never formed. With L L' the Cholesky factorisation of the matrix in brackets and t(x) = L^-1 Zc x, x'My = x'y - t(x)'t(y);
 * so ordinary inner products become M's by a correction of length `size`. */
#ifndef AST_METRIC_H
#define AST_METRIC_H

#include "arena.h"
#include "asttrack.h"
#include "kernels.h"
#include "real.h"

struct ast_metric {
    int size; /* background vectors; 0: the identity */
    int mean; /* column of m_b, which they follow */
    float ridge;
    float *factor; /* L, row-major, its diagonal inverted: size x size */
    float *known;  /* t of every column but theirs: size floats a column */
};

/* size vectors at most, which follow column `mean`; columns of the product in all. */
void ast_metric_layout(struct ast_metric *m, int size, float ridge, int mean, int columns, struct ast_arena *arena);
/* gram: inner products of [m_b, z_1 .. z_size] with the columns, one row of ld floats each. Factorises, and finds t of the columns.
 * fresh: room for lanes of t, here and below. */
void ast_metric_prepare(struct ast_metric *m, const struct ast_kernels *kernels, const float *gram, int columns, int ld,
                        float *fresh);
/* Turns inner products with the columns (lanes) into M's, but for those with the background's vectors, and lanes of squared norms
 * too. */
void ast_metric_apply(const struct ast_metric *m, const struct ast_kernels *kernels, int columns, float *inner, ast_real *square,
                      float *fresh);
/* y = L'^-1 t (size), in place: what M takes away from a vector with this t is Zc'y. */
void ast_metric_back(const struct ast_metric *m, ast_real *t);
/* t of a column that is none of the background's vectors. */
float *ast_metric_known(const struct ast_metric *m, int column);
/* t(x)'t(y) for two of them. */
ast_real ast_metric_correction(const struct ast_metric *m, int x, int y);

#endif
