/* The matrix product's innermost part: lanes of one operand against columns of the other. Each sum runs over its elements in order,
 * in a lane of its own, so the width of a vector does not show in the result. */

#include "kernel_vectors.h"

enum { COLUMNS = AST_PANEL_COLUMNS };
#if AST_HAS_VECTORS
enum { VECTORS = AST_PANEL_VECTORS * WIDTH <= AST_LANES ? AST_PANEL_VECTORS : AST_LANES / WIDTH };
#endif

static void pack(float *panel, const float *m, size_t ld, int used, int depth) {
    int d = 0;
#if AST_HAS_VECTORS
    for (; d + 4 <= depth; d += 4) {
        for (int l = 0; l < AST_LANES; l += 4) {
            const float *from = m + d;
            transpose_four(from + (size_t)(l < used ? l : 0) * ld, from + (size_t)(l + 1 < used ? l + 1 : 0) * ld,
                           from + (size_t)(l + 2 < used ? l + 2 : 0) * ld, from + (size_t)(l + 3 < used ? l + 3 : 0) * ld,
                           panel + (size_t)d * AST_LANES + l, AST_LANES);
        }
    }
#endif
    for (int l = 0; l < AST_LANES; l += 4) {
        const float *w = m + (size_t)(l < used ? l : 0) * ld, *x = m + (size_t)(l + 1 < used ? l + 1 : 0) * ld;
        const float *y = m + (size_t)(l + 2 < used ? l + 2 : 0) * ld, *z = m + (size_t)(l + 3 < used ? l + 3 : 0) * ld;
        float *to = panel + d * AST_LANES + l;
        for (int i = d; i < depth; i++, to += AST_LANES) {
            to[0] = w[i];
            to[1] = x[i];
            to[2] = y[i];
            to[3] = z[i];
        }
    }
}

#if AST_HAS_VECTORS
/* `block` columns at a time, a constant, their sums in registers; past the last of count, it is repeated and not written. */
AST_ALWAYS_INLINE void block_product(int block, const float *panel, int depth, const float *columns, size_t ld, int count,
                                     float *sums, size_t ld_sums) {
    const float *column[COLUMNS];
    for (int c = 0; c < block; c++) column[c] = columns + (size_t)(c < count ? c : count - 1) * ld;
    for (int l = 0; l < AST_LANES; l += VECTORS * WIDTH) {
        vector sum[COLUMNS][VECTORS];
        for (int c = 0; c < block; c++)
            for (int v = 0; v < VECTORS; v++) sum[c][v] = (vector){0};
        for (int d = 0; d < depth; d++) {
            vector lanes[VECTORS];
            for (int v = 0; v < VECTORS; v++) lanes[v] = *(const vector *)(panel + (size_t)d * AST_LANES + l + v * WIDTH);
            for (int c = 0; c < block; c++)
                for (int v = 0; v < VECTORS; v++) sum[c][v] += lanes[v] * column[c][d];
        }
        for (int c = 0; c < block && c < count; c++)
            for (int v = 0; v < VECTORS; v++) *(vector *)(sums + (size_t)c * ld_sums + l + v * WIDTH) += sum[c][v];
    }
}

/* A matrix whose columns are no multiple of COLUMNS ends in narrower blocks: of as many sums as hide how long an addition takes. */
static void panel_product(const float *panel, int depth, const float *columns, size_t ld, int count, float *sums, size_t ld_sums) {
    enum { WANTED = VECTORS < 4 ? 4 / VECTORS : 1, NARROW = WANTED < COLUMNS ? WANTED : COLUMNS };
    int c = 0;
    for (; count - c >= COLUMNS; c += COLUMNS)
        block_product(COLUMNS, panel, depth, columns + (size_t)c * ld, ld, COLUMNS, sums + (size_t)c * ld_sums, ld_sums);
    for (; c < count; c += NARROW)
        block_product(NARROW, panel, depth, columns + (size_t)c * ld, ld, count - c, sums + (size_t)c * ld_sums, ld_sums);
}
#else
/* Four lanes by name, so that they stay in registers even where the compiler unrolls nothing. */
struct lanes {
    float a, b, c, d;
};

AST_ALWAYS_INLINE void add_product(struct lanes *sum, struct lanes x, float y) {
    sum->a += x.a * y;
    sum->b += x.b * y;
    sum->c += x.c * y;
    sum->d += x.d * y;
}

AST_ALWAYS_INLINE void add_lanes(float *to, struct lanes sum) {
    to[0] += sum.a;
    to[1] += sum.b;
    to[2] += sum.c;
    to[3] += sum.d;
}

/* The same, four lanes by four columns. */
static void block_product(const float *panel, int depth, const float *columns, size_t ld, int count, float *sums, size_t ld_sums) {
    for (int l = 0; l < AST_LANES; l += 4) {
        const float *from = panel + l, *w = columns, *x = count > 1 ? w + ld : w, *y = count > 2 ? x + ld : w,
                    *z = count > 3 ? y + ld : w;
        const struct lanes none = {0, 0, 0, 0};
        struct lanes of_w = none, of_x = none, of_y = none, of_z = none;
        float *to = sums + l;
        for (int d = depth; d > 0; d--, from += AST_LANES) {
            const struct lanes part = {from[0], from[1], from[2], from[3]};
            add_product(&of_w, part, *w++);
            add_product(&of_x, part, *x++);
            add_product(&of_y, part, *y++);
            add_product(&of_z, part, *z++);
        }
        add_lanes(to, of_w);
        if (count > 1) add_lanes(to + ld_sums, of_x);
        if (count > 2) add_lanes(to + 2 * ld_sums, of_y);
        if (count > 3) add_lanes(to + 3 * ld_sums, of_z);
    }
}

static void panel_product(const float *panel, int depth, const float *columns, size_t ld, int count, float *sums, size_t ld_sums) {
    int c = 0;
    for (; count - c >= COLUMNS; c += COLUMNS)
        block_product(panel, depth, columns + (size_t)c * ld, ld, COLUMNS, sums + (size_t)c * ld_sums, ld_sums);
    if (c < count) block_product(panel, depth, columns + (size_t)c * ld, ld, count - c, sums + (size_t)c * ld_sums, ld_sums);
}
#endif
