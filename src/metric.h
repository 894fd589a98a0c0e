/* The metric in which distances are measured (the M of the paper's eq. 2): the identity, or one in which directions along which the
 * background varies count less,
 *
 *     M = I - Zc' (Zc Zc' + ridge tr(Zc Zc') I)^-1 Zc,   Zc = the background's vectors minus their mean m_b, as rows.
 *
 * M is never formed. With L L' the Cholesky factorisation of the matrix in brackets and t(x) = L^-1 Zc x, x'My = x'y - t(x)'t(y); so
 * ordinary inner products become M's by a correction of length `size`. */
#ifndef AST_METRIC_H
#define AST_METRIC_H

#include "arena.h"
#include "asttrack.h"
#include "linalg.h"

struct ast_metric {
    int size;    /* background vectors; 0: the identity */
    int columns; /* capacity of the columns' corrections */
    float ridge;
    float *factor;     /* L, row-major, its diagonal inverted: size x size */
    float *known;      /* t of each column: size floats a column */
    float *fresh;      /* t of a tile, interleaved: size x tile */
    float *packed;     /* the same, one after the other */
    float *correction; /* known' packed: columns x tile */
};

/* size vectors at most; columns of the product; tile vectors at a time. */
void ast_metric_layout(struct ast_metric *m, int size, float ridge, int columns, int tile, struct ast_arena *arena);
/* gram: inner products of [m_b, z_1 .. z_size] with all columns, one row of `columns` floats each; mean is the index of m_b among the
 * columns, the vectors follow it. Factorises, and finds t of every column. */
void ast_metric_prepare(struct ast_metric *m, const float *gram, int columns, int mean);
/* Turns inner products of count <= tile vectors with all columns (count rows) into M's, and their squared norms too. */
int ast_metric_apply(struct ast_metric *m, const struct ast_linalg *la, int columns, int mean, float *inner, int count,
                     ast_real *square);
/* t(x)'t(y) for two columns. */
ast_real ast_metric_correction(const struct ast_metric *m, int x, int y);

#endif
