/* The small problems of the Gram scoring (score_gram.c has the mathematics), one candidate in each lane. */
#include "score.h"
#include "subspace.h"

#if AST_HAS_VECTORS
/* x -= origin for `count` vectors, a constant, ld floats apart: side by side, since each alone would wait for its sums. */
AST_ALWAYS_INLINE void depart_together(int count, float *x, size_t ld, const float *origin, int n, ast_real *square) {
    enum { TOGETHER = 4 };
    reals sum[TOGETHER][SQUARES / REALS];
    for (int i = 0; i < count; i++)
        for (int v = 0; v < SQUARES / REALS; v++) sum[i][v] = (reals){0};
    int d = 0;
    for (; d + SQUARES <= n; d += SQUARES) {
        for (int i = 0; i < count; i++) {
            eight *at = (eight *)(x + (size_t)i * ld + d);
            *at -= *(const eight *)(origin + d);
            add_squares(x + (size_t)i * ld + d, sum[i]);
        }
    }
    for (int i = 0; i < count; i++) {
        ast_real s[SQUARES];
        memcpy(s, sum[i], sizeof s);
        for (int e = d; e < n; e++) {
            float *at = x + (size_t)i * ld + e;
            *at -= origin[e];
            s[0] += (ast_real)*at * (ast_real)*at;
        }
        square[i] = total_of_eight(s);
    }
}

static void depart(float *x, size_t ld, int count, const float *origin, int n, ast_real *square) {
    int i = 0;
    for (; i + 4 <= count; i += 4) depart_together(4, x + (size_t)i * ld, ld, origin, n, square + i);
    for (; i < count; i++) depart_together(1, x + (size_t)i * ld, ld, origin, n, square + i);
}
#else
/* x -= origin; returns the squared length of what is left, summed as ast_dot sums. */
static ast_real depart_one(float *restrict x, const float *restrict origin, int n) {
    enum { SUMS = 8 };
    ast_real sum[SUMS] = {0};
    int d = 0;
    for (int l = 0; l < SUMS; l += 4) { /* four of them in registers */
        ast_real p = 0, q = 0, r = 0, s = 0;
        for (d = 0; d + SUMS <= n; d += SUMS) {
            float *at = x + d + l;
            const float *from = origin + d + l;
            const float a = at[0] - from[0], b = at[1] - from[1], c = at[2] - from[2], e = at[3] - from[3];
            at[0] = a;
            at[1] = b;
            at[2] = c;
            at[3] = e;
            p += (ast_real)a * (ast_real)a;
            q += (ast_real)b * (ast_real)b;
            r += (ast_real)c * (ast_real)c;
            s += (ast_real)e * (ast_real)e;
        }
        sum[l] = p;
        sum[l + 1] = q;
        sum[l + 2] = r;
        sum[l + 3] = s;
    }
    for (; d < n; d++) {
        x[d] -= origin[d];
        sum[0] += (ast_real)x[d] * (ast_real)x[d];
    }
    return total_of_eight(sum);
}

static void depart(float *x, size_t ld, int count, const float *origin, int n, ast_real *square) {
    for (int i = 0; i < count; i++) square[i] = depart_one(x + (size_t)i * ld, origin, n);
}
#endif

/* L^-1 applied to the lanes' vectors, in place; L is row-major, its diagonal inverted. Rows in fours, whose sums do not wait for
 * each other until the diagonal. */
static void solve(const float *restrict factor, int size, float *restrict vectors) {
    enum { ROWS = 4 };
    for (int r = 0; r < size; r += ROWS) {
        const int rows = size - r < ROWS ? size - r : ROWS;
        float *target = vectors + (size_t)r * AST_LANES;
        float sum[ROWS][AST_LANES];
        for (int k = 0; k < ROWS; k++)
            for (int l = 0; l < AST_LANES; l++) sum[k][l] = k < rows ? target[k * AST_LANES + l] : 0.0f;
        const float *row[ROWS];
        for (int k = 0; k < ROWS; k++) row[k] = factor + (size_t)(r + (k < rows ? k : 0)) * (size_t)size;
        for (int c = 0; c < r; c++)
            for (int k = 0; k < ROWS; k++)
                for (int l = 0; l < AST_LANES; l++) sum[k][l] -= row[k][c] * vectors[(size_t)c * AST_LANES + (size_t)l];
        for (int k = 0; k < rows; k++) {
            for (int c = 0; c < k; c++)
                for (int l = 0; l < AST_LANES; l++) sum[k][l] -= row[k][r + c] * sum[c][l];
            for (int l = 0; l < AST_LANES; l++) target[k * AST_LANES + l] = sum[k][l] *= row[k][r + k];
        }
    }
}

/* Coordinates of the candidates' d in Q, and the squared length of what Q does not explain. */
static void project(const struct ast_gram *s, struct ast_gram_tile *t) {
    for (int l = 0; l < AST_LANES; l++) t->rest[l] = t->square[l];
    for (int k = 0; k < s->rank; k++) {
        for (int l = 0; l < AST_LANES; l++) {
            const ast_real along = (ast_real)t->inner[(1 + k) * AST_LANES + l];
            t->q[k * AST_LANES + l] = along;
            t->rest[l] -= along * along;
        }
    }
}

/* From t->q and t->rest: eigenvectors W of the sets' scatter matrices, the rank of their bases, and what every pair needs of
 * them. */
static void decompose(const struct ast_gram *s, struct ast_gram_tile *t) {
    const int r = s->rank, m = r + 1, n = s->size, present = n < m ? n : m;
    ast_real inverse[AST_LANES], norm[AST_LANES];
    for (int l = 0; l < AST_LANES; l++) {
        /* What is left of a patch that lies in Q is Q's own rounding: no direction. */
        const ast_real noise = (ast_real)FLT_EPSILON * (ast_real)FLT_EPSILON * (t->square[l] + s->reference_square);
        const int any = t->rest[l] > noise;
        const ast_real rho = ast_sqrt(any ? t->rest[l] : 0);
        t->rho[l] = rho;
        inverse[l] = any ? 1 / (any ? rho : 1) : 0;
        const ast_real patch = t->square[l] + 2 * (ast_real)t->inner[l] + s->reference_square;
        norm[l] = ast_sqrt(s->history_square + (patch > 0 ? patch : 0));
    }
    for (int i = 0; i < m; i++) {
        for (int j = i; j < m; j++) {
            const ast_real *x = i < r ? t->q + i * AST_LANES : t->rho, *y = j < r ? t->q + j * AST_LANES : t->rho;
            const ast_real from_x = i < r ? s->offset[i] : 0, from_y = j < r ? s->offset[j] : 0;
            const ast_real spectrum = i == j && i < r ? s->spectrum[i] : 0;
            ast_real *to = t->matrix + (size_t)(i * m + j) * AST_LANES;
            for (int l = 0; l < AST_LANES; l++) to[l] = s->gamma * ((x[l] + from_x) * (y[l] + from_y)) + spectrum;
        }
    }
    eigen(m, t->matrix, t->values, t->vectors);

    for (int a = 0; a < n; a++) {
        ast_real *w = t->vectors + (size_t)a * (size_t)m * AST_LANES, *absent = t->absent + a * AST_LANES;
        ast_real *constant = t->constant + a * AST_LANES;
        for (int l = 0; l < AST_LANES; l++) {
            absent[l] = 1;
            constant[l] = 0;
        }
        if (a >= present) continue;
        /* The directions of U_i that its rank counts; the others are zero from here on. */
        const ast_real *value = t->values + a * AST_LANES, *before = a > 0 ? absent - AST_LANES : NULL;
        for (int l = 0; l < AST_LANES; l++) {
            const ast_real singular = ast_sqrt(value[l] > 0 ? value[l] : 0);
            const ast_real counted = singular > AST_RANK_TOLERANCE * norm[l] ? (ast_real)0 : (ast_real)1;
            absent[l] = before != NULL && before[l] > counted ? before[l] : counted;
        }
        for (int k = 0; k < m; k++) {
            const ast_real *along = k < r ? t->q + k * AST_LANES : t->rho;
            for (int l = 0; l < AST_LANES; l++) {
                const ast_real kept = absent[l] > 0 ? 0 : w[k * AST_LANES + l];
                w[k * AST_LANES + l] = kept;
                constant[l] += kept * along[l];
            }
        }
        /* W_a'[Q e]'x = sum over l of W_al Q_l'x + W_ar (d'x - sum over l of q_l Q_l'x) / rho: the coefficients of Q_l'x and
         * d'x. */
        ast_real *last = w + (size_t)r * AST_LANES;
        for (int l = 0; l < AST_LANES; l++) last[l] *= inverse[l];
        for (int k = 0; k < r; k++)
            for (int l = 0; l < AST_LANES; l++) w[k * AST_LANES + l] -= last[l] * (t->apart[l] > 0 ? 0 : t->q[k * AST_LANES + l]);
    }
}

/* along[l] = sum over k of W_ak (Q_k'x) + W_ar d'x for a column x, of which shared gives Q_k'x (in steps of `step`) and inner
 * d'x. */
static void along_candidate(const ast_real *restrict w, int rank, const float *restrict shared, size_t step,
                            const ast_real *restrict inner, ast_real *restrict along) {
    const ast_real *last = w + (size_t)rank * AST_LANES;
    for (int l = 0; l < AST_LANES; l++) along[l] = last[l] * inner[l];
    for (int k = 0; k < rank; k++) {
        const ast_real factor = (ast_real)shared[(size_t)k * step];
        for (int l = 0; l < AST_LANES; l++) along[l] += w[k * AST_LANES + l] * factor;
    }
}

/* Inner products of the lanes with a model's orthonormal basis from those with its basis as it is: v = L^-1 columns. factor may be
 * NULL. */
static void orthonormal(const ast_real *factor, int n, int rank, const float *restrict columns, ast_real *restrict v) {
    for (int b = 0; b < rank; b++) {
        ast_real *to = v + b * AST_LANES;
        for (int l = 0; l < AST_LANES; l++) to[l] = (ast_real)columns[b * AST_LANES + l];
        if (factor == NULL) continue;
        for (int a = 0; a < b; a++)
            for (int l = 0; l < AST_LANES; l++) to[l] -= factor[b * n + a] * v[a * AST_LANES + l];
        const ast_real inverse = 1 / factor[b * n + b];
        for (int l = 0; l < AST_LANES; l++) to[l] *= inverse;
    }
}

/* Geodesic distances of the lanes to a model with `other` directions, from t->cross = U_i'U_j. */
static void geodesic(const struct ast_gram *s, struct ast_gram_tile *t, int other, ast_real *restrict distance) {
    const int n = s->size;
    ast_real *cross = t->cross;
    /* Directions absent from both are alike: a cosine of 1. Those absent from one alone leave a cosine of 0. */
    for (int b = other; b < n; b++)
        for (int a = 0; a < n; a++)
            for (int l = 0; l < AST_LANES; l++) cross[(b * n + a) * AST_LANES + l] = a == b ? t->absent[a * AST_LANES + l] : 0;
    for (int y = 0; y < n; y++) {
        for (int x = 0; x <= y; x++) {
            ast_real *to = t->small + (size_t)(x * n + y) * AST_LANES;
            const ast_real *of_x = cross + (size_t)(x * n) * AST_LANES, *of_y = cross + (size_t)(y * n) * AST_LANES;
            for (int l = 0; l < AST_LANES; l++) to[l] = of_x[l] * of_y[l];
            for (int a = 1; a < n; a++)
                for (int l = 0; l < AST_LANES; l++) to[l] += of_x[a * AST_LANES + l] * of_y[a * AST_LANES + l];
        }
    }
    eigenvalues(n, t->small, t->values, t->spare);
    for (int l = 0; l < AST_LANES; l++) distance[l] = 0;
    for (int a = 0; a < n; a++) {
        for (int l = 0; l < AST_LANES; l++) {
            const ast_real value = t->values[a * AST_LANES + l], cosine = ast_sqrt(value > 0 ? value : 0);
            const ast_real angle = ast_acos_lane(cosine < 1 ? cosine : 1);
            distance[l] += angle * angle;
        }
    }
    for (int l = 0; l < AST_LANES; l++) distance[l] = ast_sqrt(distance[l]);
}

static void pair(const struct ast_gram *s, struct ast_gram_tile *t, const struct ast_gram_model *model, float *distance) {
    const int r = s->rank, m = r + 1, n = s->size, other = model->rank;
    const float *inner = t->inner + (size_t)model->first * AST_LANES, *beside = t->beside + (size_t)model->first * AST_LANES;
    const float *shared = s->shared + s->columns + model->first; /* rows Q_1 .. */
    ast_real along_model[AST_MAX_BASIS * AST_LANES], along_beside[AST_MAX_BASIS * AST_LANES], total[AST_LANES];

    orthonormal(model->factor, n, other, inner, along_model);
    const ast_real *explained = along_model;
    if (beside != inner) {
        orthonormal(model->factor, n, other, beside, along_beside);
        explained = along_beside;
    }
    for (int b = 0; b < other; b++)
        for (int a = 0; a < n; a++) {
            ast_real *to = t->cross + (size_t)(b * n + a) * AST_LANES;
            if (a < m)
                along_candidate(t->vectors + (size_t)(a * m) * AST_LANES, r, shared + b, s->columns, explained + b * AST_LANES, to);
            else
                for (int l = 0; l < AST_LANES; l++) to[l] = 0;
        }
    geodesic(s, t, other, total);
    if (s->alpha < 0) { /* linear models have no mean */
        for (int l = 0; l < AST_LANES; l++) distance[l] = (float)total[l];
        return;
    }

    /* difference = mu_i - mu_j = share d - g, g = mu_j - reference */
    const ast_real share = s->share;
    const float *mean = inner + n * AST_LANES, *mean_beside = beside + n * AST_LANES;
    ast_real term[AST_LANES], gap[AST_LANES];
    for (int l = 0; l < AST_LANES; l++) {
        const ast_real d_g = (ast_real)mean[l] - (ast_real)t->inner[l];
        const ast_real square = share * share * t->square[l] - 2 * share * d_g + model->gap_square;
        term[l] = 2 * (square > 0 ? square : 0);
        gap[l] = (ast_real)mean_beside[l] - (ast_real)t->beside[l];
    }
    for (int a = 0; a < n && a < m; a++) {
        const ast_real *w = t->vectors + (size_t)(a * m) * AST_LANES, *last = w + (size_t)r * AST_LANES;
        ast_real along[AST_LANES]; /* U_ia'difference */
        for (int l = 0; l < AST_LANES; l++) along[l] = share * t->constant[a * AST_LANES + l] - last[l] * gap[l];
        for (int k = 0; k < r; k++) {
            const float *row = s->shared + (size_t)(1 + k) * s->columns;
            const ast_real factor = (ast_real)row[model->first + n] - (ast_real)row[0];
            for (int l = 0; l < AST_LANES; l++) along[l] -= w[k * AST_LANES + l] * factor;
        }
        for (int l = 0; l < AST_LANES; l++) term[l] -= along[l] * along[l];
    }
    for (int b = 0; b < other; b++) {
        for (int l = 0; l < AST_LANES; l++) {
            const ast_real along = share * along_model[b * AST_LANES + l] - model->basis_gap[b];
            term[l] -= along * along;
        }
    }
    for (int l = 0; l < AST_LANES; l++)
        distance[l] = (float)(total[l] + s->alpha * ((term[l] > 0 ? term[l] : 0) - t->background[l]));
}
