#include "metric.h"

#include "vector.h"

/* The least ridge, relative to the vectors' squares: above what rounding of single-precision inner products makes of a background
 * that does not vary, far below one that does. */
#define ROUNDING_FLOOR ((ast_real)1e-6)

void ast_metric_layout(struct ast_metric *m, int size, float ridge, int mean, int columns, struct ast_arena *arena) {
    const size_t b = (size_t)size;
    m->size = size;
    m->ridge = ridge;
    m->mean = mean;
    if (size == 0) return;
    m->factor = ast_arena_take(arena, b * b, sizeof *m->factor);
    m->known = ast_arena_take(arena, b * (size_t)(columns - size), sizeof *m->known);
}

/* Cholesky of a positive definite matrix (row-major, lower triangle), in place; the diagonal is left inverted. */
static void factorise(float *a, int n) {
    for (int r = 0; r < n; r++) {
        float *row = a + (size_t)r * (size_t)n;
        for (int c = 0; c <= r; c++) {
            const float *other = a + (size_t)c * (size_t)n;
            ast_real sum = (ast_real)row[c];
            sum -= ast_dot(row, other, c);
            if (c < r)
                row[c] = (float)(sum * (ast_real)other[c]);
            else
                row[r] = sum > 0 ? (float)(1 / ast_sqrt(sum)) : 0.0f; /* the ridge keeps it positive unless all vectors are equal */
        }
    }
}

/* Columns of which t is known, counted without the background's vectors; `behind` is the first behind them. */
static int known_columns(const struct ast_metric *m, int columns) {
    return columns - m->size;
}
static int behind(const struct ast_metric *m) {
    return m->mean + 1 + m->size;
}

void ast_metric_prepare(struct ast_metric *m, const struct ast_kernels *kernels, const float *gram, int columns, int ld,
                        float *fresh) {
    const int b = m->size, mean = m->mean, known = known_columns(m, columns);
    const float *mean_row = gram;
    ast_real trace = 0, total = 0;
    /* Zc Zc' from the rows of z and m_b. */
    for (int r = 0; r < b; r++) {
        const float *row = gram + (size_t)(1 + r) * (size_t)ld;
        for (int c = 0; c <= r; c++) {
            const float *other = gram + (size_t)(1 + c) * (size_t)ld;
            m->factor[(size_t)r * (size_t)b + (size_t)c] = (row[mean + 1 + c] - row[mean]) - (other[mean] - mean_row[mean]);
        }
        trace += (ast_real)m->factor[(size_t)r * (size_t)b + (size_t)r];
        total += (ast_real)row[mean + 1 + r];
    }
    const ast_real ridge = (ast_real)m->ridge * trace, floor = ROUNDING_FLOOR * total, diagonal = ridge > floor ? ridge : floor;
    for (int r = 0; r < b; r++) m->factor[(size_t)r * (size_t)b + (size_t)r] += (float)diagonal;
    factorise(m->factor, b);
    for (int first = 0; first < known; first += AST_LANES) {
        const int used = known - first < AST_LANES ? known - first : AST_LANES;
        for (int l = 0; l < AST_LANES; l++) {
            const int k = first + (l < used ? l : 0), x = k <= mean ? k : k + b;
            for (int r = 0; r < b; r++)
                fresh[(size_t)r * AST_LANES + (size_t)l] = gram[(size_t)(1 + r) * (size_t)ld + (size_t)x] - mean_row[x];
        }
        kernels->solve(m->factor, b, fresh);
        for (int l = 0; l < used; l++)
            for (int r = 0; r < b; r++)
                m->known[(size_t)(first + l) * (size_t)b + (size_t)r] = fresh[(size_t)r * AST_LANES + (size_t)l];
    }
}

void ast_metric_apply(const struct ast_metric *m, const struct ast_kernels *kernels, int columns, float *inner, ast_real *square,
                      float *fresh) {
    const int b = m->size, in_front = m->mean + 1;
    const float *mean = inner + (size_t)m->mean * AST_LANES, *vectors = mean + AST_LANES;
    for (int r = 0; r < b; r++)
        for (int l = 0; l < AST_LANES; l++)
            fresh[(size_t)r * AST_LANES + (size_t)l] = vectors[(size_t)r * AST_LANES + (size_t)l] - mean[l];
    kernels->solve(m->factor, b, fresh);
    for (int r = 0; r < b; r++) {
        float *t = fresh + (size_t)r * AST_LANES;
        for (int l = 0; l < AST_LANES; l++) {
            square[l] -= (ast_real)t[l] * (ast_real)t[l];
            t[l] = -t[l]; /* so that the products are subtracted */
        }
    }
    for (int l = 0; l < AST_LANES; l++)
        if (square[l] < 0) square[l] = 0;
    for (int r = 0; r < b; r += AST_PANEL_DEPTH) {
        const int depth = b - r < AST_PANEL_DEPTH ? b - r : AST_PANEL_DEPTH;
        const float *panel = fresh + (size_t)r * AST_LANES, *known = m->known + r;
        kernels->panel_product(panel, depth, known, (size_t)b, in_front, inner, AST_LANES);
        if (columns > behind(m))
            kernels->panel_product(panel, depth, known + (size_t)in_front * (size_t)b, (size_t)b, columns - behind(m),
                                   inner + (size_t)behind(m) * AST_LANES, AST_LANES);
    }
}

void ast_metric_back(const struct ast_metric *m, ast_real *t) {
    const int b = m->size;
    for (int r = b - 1; r >= 0; r--) {
        ast_real sum = t[r];
        for (int c = r + 1; c < b; c++) sum -= (ast_real)m->factor[(size_t)c * (size_t)b + (size_t)r] * t[c];
        t[r] = sum * (ast_real)m->factor[(size_t)r * (size_t)b + (size_t)r];
    }
}

float *ast_metric_known(const struct ast_metric *m, int column) {
    return m->known + (size_t)(column <= m->mean ? column : column - m->size) * (size_t)m->size;
}

ast_real ast_metric_correction(const struct ast_metric *m, int x, int y) {
    return ast_dot(ast_metric_known(m, x), ast_metric_known(m, y), m->size);
}
