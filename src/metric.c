#include "metric.h"

#include "vector.h"

/* The least ridge, relative to the vectors' squares: above what rounding of single-precision inner products makes of a background
 * that does not vary, far below one that does. */
#define ROUNDING_FLOOR ((ast_real)1e-6)

void ast_metric_layout(struct ast_metric *m, int size, float ridge, int columns, int tile, struct ast_arena *arena) {
    const size_t b = (size_t)size;
    m->size = size;
    m->ridge = ridge;
    m->columns = columns;
    if (size == 0) return;
    m->factor = ast_arena_take(arena, b * b, sizeof *m->factor);
    m->known = ast_arena_take(arena, b * (size_t)columns, sizeof *m->known);
    m->fresh = ast_arena_take(arena, b * (size_t)tile, sizeof *m->fresh);
    m->packed = ast_arena_take(arena, b * (size_t)tile, sizeof *m->packed);
    m->correction = ast_arena_take(arena, (size_t)columns * (size_t)tile, sizeof *m->correction);
}

/* L^-1 applied to `lanes` interleaved vectors at once, in place. */
static void solve(const struct ast_metric *m, float *vectors, int lanes) {
    for (int r = 0; r < m->size; r++) {
        const float *row = m->factor + (size_t)r * (size_t)m->size;
        float *target = vectors + (size_t)r * (size_t)lanes;
        for (int c = 0; c < r; c++) {
            const float *from = vectors + (size_t)c * (size_t)lanes;
            const float factor = row[c];
            for (int l = 0; l < lanes; l++) target[l] -= factor * from[l];
        }
        for (int l = 0; l < lanes; l++) target[l] *= row[r];
    }
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

void ast_metric_prepare(struct ast_metric *m, const float *gram, int columns, int mean) {
    const int b = m->size;
    const float *mean_row = gram;
    ast_real trace = 0, total = 0;
    /* Zc Zc' from the rows of z and m_b. */
    for (int r = 0; r < b; r++) {
        const float *row = gram + (size_t)(1 + r) * (size_t)columns;
        for (int c = 0; c <= r; c++) {
            const float *other = gram + (size_t)(1 + c) * (size_t)columns;
            m->factor[(size_t)r * (size_t)b + (size_t)c] = (row[mean + 1 + c] - row[mean]) - (other[mean] - mean_row[mean]);
        }
        trace += (ast_real)m->factor[(size_t)r * (size_t)b + (size_t)r];
        total += (ast_real)row[mean + 1 + r];
    }
    const ast_real ridge = (ast_real)m->ridge * trace, floor = ROUNDING_FLOOR * total, diagonal = ridge > floor ? ridge : floor;
    for (int r = 0; r < b; r++) m->factor[(size_t)r * (size_t)b + (size_t)r] += (float)diagonal;
    factorise(m->factor, b);
    for (int x = 0; x < columns; x++) {
        float *t = m->known + (size_t)x * (size_t)b;
        for (int r = 0; r < b; r++) t[r] = gram[(size_t)(1 + r) * (size_t)columns + (size_t)x] - mean_row[x];
        solve(m, t, 1);
    }
}

int ast_metric_apply(struct ast_metric *m, const struct ast_linalg *la, int columns, int mean, float *inner, int count,
                     ast_real *square) {
    for (int i = 0; i < count; i++) {
        const float *row = inner + (size_t)i * (size_t)columns;
        for (int r = 0; r < m->size; r++) m->fresh[(size_t)r * (size_t)count + (size_t)i] = row[mean + 1 + r] - row[mean];
    }
    solve(m, m->fresh, count);
    for (int i = 0; i < count; i++) {
        float *t = m->packed + (size_t)i * (size_t)m->size;
        for (int r = 0; r < m->size; r++) t[r] = m->fresh[(size_t)r * (size_t)count + (size_t)i];
        square[i] -= ast_dot(t, t, m->size);
        if (square[i] < 0) square[i] = 0;
    }
    const int failed = la->product(columns, count, m->size, m->known, m->size, m->packed, m->size, m->correction, columns);
    if (failed) return failed;
    for (int i = 0; i < count * columns; i++) inner[i] -= m->correction[i];
    return 0;
}

ast_real ast_metric_correction(const struct ast_metric *m, int x, int y) {
    return ast_dot(m->known + (size_t)x * (size_t)m->size, m->known + (size_t)y * (size_t)m->size, m->size);
}
