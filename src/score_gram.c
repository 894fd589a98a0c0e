/* The fast path: the same distances from inner products alone.
 *
 * All candidates of a frame share the history H = [h_1 .. h_p]. Let `reference` be its mean and Q an orthonormal basis of H about the
 * basis's origin (the mean for a centred basis, zero for a raw one), with H H' = Q diag(spectrum) Q' there. For a candidate patch c
 * let d = c - reference, q = Q'd, and e the unit vector along d - Q q, of length rho. Then in the coordinates [Q e]:
 *
 *   - the scatter matrix of the set [H c] is diag(spectrum, 0) + gamma v v', v = (q + Q'(reference - origin), rho), gamma = p / (p + 1)
 *     for a centred basis and 1 for a raw one. Its eigenvectors W give U_i = [Q e] W, its eigenvalues the squared singular values;
 *   - U_i'U_j = W' [Q e]'U_j, where Q'U_j is shared by the frame and e'U_j = (d'U_j - q'Q'U_j) / rho;
 *   - mu_i = reference + d / (p + 1), which gives the Mahalanobis term in the same inner products.
 *
 * All inner products, norms and orthogonality are the configured metric's (metric.h); in the identity nothing changes.
 *
 * So one product of the patches d with the columns [reference Q U_1 mu_1 .. U_k mu_k] holds everything, and because d is a small
 * difference, single precision is enough for it. Unlike the Gram matrix of the set, the history enters through its own singular
 * values, not through their squares minus rounding. */
#include <stddef.h>

#include "distance.h"
#include "eigen.h"
#include "score.h"
#include "subspace.h"
#include "vector.h"

/* Below this fraction of |d|^2, rho^2 = |d|^2 - |q|^2 has lost too many digits, and the residual is computed from its definition. */
#define RESIDUAL_TOLERANCE ((ast_real)1e-1)

/* Columns in front of the bag's: reference, Q_1 .. Q_P, and with a background its mean m_b and its vectors. */
enum { REFERENCE = 0, Q_FIRST = 1 };

static int background_mean(const ast_config *cfg) {
    return Q_FIRST + cfg->history;
}

static int lead(const ast_config *cfg) {
    return background_mean(cfg) + (cfg->background > 0 ? 1 + cfg->background : 0);
}

static void layout(union ast_scratch *scratch, const ast_config *cfg, const struct ast_linalg *la, int dim,
                   struct ast_arena *arena) {
    struct ast_gram *s = &scratch->gram;
    (void)la;
    const size_t p = (size_t)cfg->history, m = p + 1, n = (size_t)cfg->basis_size;
    const size_t k = (size_t)cfg->bag_size, in_front = (size_t)lead(cfg), columns = in_front + k * (n + 1);
    s->dim = dim;
    s->spectrum = ast_arena_take(arena, p, sizeof *s->spectrum);
    s->offset = ast_arena_take(arena, p, sizeof *s->offset);
    s->gap_square = ast_arena_take(arena, k, sizeof *s->gap_square);
    s->basis_gap = ast_arena_take(arena, k * n, sizeof *s->basis_gap);
    s->factor = ast_arena_take(arena, k * n * n, sizeof *s->factor);
    s->square = ast_arena_take(arena, AST_TILE, sizeof *s->square);
    ast_metric_layout(&s->metric, cfg->background, cfg->ridge, (int)columns, AST_TILE, arena);
    s->inner = ast_arena_take(arena, columns * AST_TILE, sizeof *s->inner);
    s->shared = ast_arena_take(arena, columns * in_front, sizeof *s->shared);
    s->basis_cross = ast_arena_take(arena, m * n, sizeof *s->basis_cross);
    s->matrix = ast_arena_take(arena, m * m, sizeof *s->matrix);
    s->vectors = ast_arena_take(arena, m * m, sizeof *s->vectors);
    s->values = ast_arena_take(arena, m, sizeof *s->values);
    s->cross = ast_arena_take(arena, n * n, sizeof *s->cross);
    s->small = ast_arena_take(arena, n * n, sizeof *s->small);
}

static const float *lead_column(const struct ast_bag *bag, int column) {
    return bag->columns + (size_t)column * (size_t)bag->stride;
}

/* The history: its mean, and its basis about the origin, orthonormal in the ordinary sense. */
static int decompose_history(struct ast_gram *s, const struct ast_scene *scene) {
    struct ast_bag *bag = scene->bag;
    float *reference = bag->columns;
    const float *column[AST_MAX_HISTORY];
    const struct ast_images images = {column, scene->history->count, s->dim};
    for (int j = 0; j < images.count; j++) column[j] = ast_history_patch(scene->history, j);

    ast_images_mean(&images, reference);
    const float *origin = NULL;
    if (scene->cfg->basis == AST_BASIS_CENTRED)
        origin = reference;
    else if (scene->background > 0)
        origin = lead_column(bag, background_mean(scene->cfg));
    const int failed = ast_images_svd(scene->la, &images, origin, s->values, scene->work, scene->work_count);
    if (failed) return failed;
    const ast_real norm = ast_images_norm(&images);
    const int count = images.count < s->dim ? images.count : s->dim;
    /* Keep more than the rank rule does: a candidate decides what is absent. What is dropped lies far below that. */
    s->rank = 0;
    while (s->rank < count && s->values[s->rank] > (ast_real)0.1 * AST_RANK_TOLERANCE * norm) s->rank++;
    for (int l = 0; l < scene->cfg->history; l++) {
        float *to = bag->columns + (size_t)(Q_FIRST + l) * (size_t)bag->stride;
        const ast_real *from = scene->work + (size_t)l * (size_t)s->dim;
        for (int d = 0; d < s->dim; d++) to[d] = l < s->rank ? (float)from[d] : 0.0f;
    }
    for (int l = 0; l < s->rank; l++) {
        s->spectrum[l] = s->values[l] * s->values[l];
        s->offset[l] = 0;
        if (origin == reference) continue;
        s->offset[l] = ast_dot(lead_column(bag, Q_FIRST + l), reference, s->dim);
        if (origin != NULL) s->offset[l] -= ast_dot(lead_column(bag, Q_FIRST + l), origin, s->dim);
    }
    s->history_square = norm * norm;
    s->reference_square = ast_dot(reference, reference, s->dim);
    return 0;
}

/* Replaces `rank` numbers, `step` apart, by their combinations with the matrix's columns. */
static void combine(const ast_real *matrix, int rank, float *numbers, size_t step) {
    ast_real old[AST_MAX_HISTORY];
    for (int k = 0; k < rank; k++) old[k] = (ast_real)numbers[(size_t)k * step];
    for (int l = 0; l < rank; l++) {
        ast_real sum = 0;
        for (int k = 0; k < rank; k++) sum += matrix[l * rank + k] * old[k];
        numbers[(size_t)l * step] = (float)sum;
    }
}

/* Makes Q orthonormal in the metric: with Q S the history about its origin and S Q'MQ S = W diag(lambda) W', the new basis is
 * Q S W lambda^(-1/2), and lambda the new spectrum. */
static void adapt_history(struct ast_gram *s, const struct ast_scene *scene, int columns) {
    struct ast_bag *bag = scene->bag;
    const int r = s->rank;
    ast_real *matrix = s->matrix, *vectors = s->vectors;
    ast_real scale[AST_MAX_HISTORY], offset[AST_MAX_HISTORY];
    for (int i = 0; i < r; i++) scale[i] = ast_sqrt(s->spectrum[i]);
    for (int j = 0; j < r; j++)
        for (int i = 0; i < r; i++)
            matrix[j * r + i] =
                scale[i] * scale[j] * ((i == j ? 1 : 0) - ast_metric_correction(&s->metric, Q_FIRST + i, Q_FIRST + j));
    ast_eigen_symmetric(r, matrix, s->values, vectors);
    for (int l = 0; l < r; l++) {
        s->spectrum[l] = s->values[l] > 0 ? s->values[l] : 0;
        for (int k = 0; k < r; k++) vectors[l * r + k] *= s->values[l] > 0 ? scale[k] / ast_sqrt(s->values[l]) : 0;
    }
    for (int d = 0; d < s->dim; d++)
        combine(vectors, r, bag->columns + (size_t)Q_FIRST * (size_t)bag->stride + d, (size_t)bag->stride);
    for (int x = 0; x < columns; x++) combine(vectors, r, s->shared + (size_t)Q_FIRST * (size_t)columns + x, (size_t)columns);
    for (int b = 0; b < s->metric.size; b++)
        combine(vectors, r, s->metric.known + (size_t)Q_FIRST * (size_t)s->metric.size + b, (size_t)s->metric.size);

    /* reference - origin in the new basis: both inner products in the metric. */
    const int mean = background_mean(scene->cfg);
    for (int l = 0; l < r; l++) {
        const float *row = s->shared + (size_t)(Q_FIRST + l) * (size_t)columns;
        offset[l] = ((ast_real)row[REFERENCE] - ast_metric_correction(&s->metric, Q_FIRST + l, REFERENCE)) -
                    ((ast_real)row[mean] - ast_metric_correction(&s->metric, Q_FIRST + l, mean));
        s->offset[l] = scene->cfg->basis == AST_BASIS_CENTRED ? 0 : offset[l];
    }
}

/* Solves L x = v in place for the Cholesky factor of a model's basis: inner products with U_j become those with its orthonormal form. */
static void orthonormalise(const ast_real *factor, int n, int rank, float *v) {
    for (int b = 0; b < rank; b++) {
        ast_real sum = (ast_real)v[b];
        for (int a = 0; a < b; a++) sum -= factor[b * n + a] * (ast_real)v[a];
        v[b] = (float)(sum / factor[b * n + b]);
    }
}

static ast_real *model_factor(const struct ast_gram *s, const struct ast_bag *bag, int slot) {
    return s->factor + (size_t)slot * (size_t)bag->n * (size_t)bag->n;
}

/* A model's basis is orthonormal in the ordinary sense; U_j'MU_j = L L'. */
static void factorise_model(struct ast_gram *s, const struct ast_bag *bag, int slot) {
    const int n = bag->n, first = bag->lead + slot * (n + 1);
    ast_real *factor = model_factor(s, bag, slot);
    for (int b = 0; b < bag->rank[slot]; b++) {
        for (int a = 0; a <= b; a++) {
            ast_real sum = (a == b ? 1 : 0) - ast_metric_correction(&s->metric, first + a, first + b);
            for (int c = 0; c < a; c++) sum -= factor[a * n + c] * factor[b * n + c];
            factor[b * n + a] = a < b ? sum / factor[a * n + a] : ast_sqrt(sum > ast_real_epsilon() ? sum : ast_real_epsilon());
        }
    }
}

static int prepare(union ast_scratch *scratch, const struct ast_scene *scene) {
    struct ast_gram *s = &scratch->gram;
    struct ast_bag *bag = scene->bag;
    const int columns = ast_bag_columns(bag), mean = background_mean(scene->cfg), n = bag->n;
    const float *reference = bag->columns;
    int failed = decompose_history(s, scene);
    if (!failed)
        failed = scene->la->product(columns, bag->lead, s->dim, bag->columns, bag->stride, bag->columns, bag->stride, s->shared,
                                    columns);
    if (failed) return failed;

    const int adapted = scene->background > 0;
    if (adapted) {
        ast_metric_prepare(&s->metric, s->shared + (size_t)mean * (size_t)columns, columns, mean);
        adapt_history(s, scene, columns);
        for (int row = 0; row < Q_FIRST + s->rank; row++)
            for (int x = 0; x < columns; x++)
                s->shared[(size_t)row * (size_t)columns + (size_t)x] -= (float)ast_metric_correction(&s->metric, row, x);
        const ast_real m_b_square =
            (ast_real)s->shared[(size_t)mean * (size_t)columns + (size_t)mean] - ast_metric_correction(&s->metric, mean, mean);
        s->origin_square = (ast_real)s->shared[REFERENCE] - 2 * (ast_real)s->shared[mean] + m_b_square;
    }
    for (int j = 0; j < bag->count; j++) {
        const int first = bag->lead + j * (n + 1), centre = first + n, rank = bag->rank[j];
        /* From the difference itself: as a sum of large inner products it would lose what the distance lives on. */
        const float *model_mean = ast_bag_mean(bag, j);
        ast_real sum = 0;
        for (int d = 0; d < s->dim; d++) {
            const ast_real gap = (ast_real)model_mean[d] - (ast_real)reference[d];
            sum += gap * gap;
        }
        float along[AST_MAX_BASIS]; /* U_j'mu_j */
        for (int b = 0; b < rank; b++)
            along[b] = (float)(bag->basis_mean[j * n + b] - (adapted ? ast_metric_correction(&s->metric, first + b, centre) : 0));
        if (adapted) {
            sum -= ast_metric_correction(&s->metric, centre, centre) - 2 * ast_metric_correction(&s->metric, centre, REFERENCE) +
                   ast_metric_correction(&s->metric, REFERENCE, REFERENCE);
            const ast_real *factor = model_factor(s, bag, j);
            factorise_model(s, bag, j);
            for (int row = 0; row < Q_FIRST + s->rank; row++)
                orthonormalise(factor, n, rank, s->shared + (size_t)row * (size_t)columns + first);
            orthonormalise(factor, n, rank, along);
        }
        s->gap_square[j] = sum > 0 ? sum : 0;
        for (int b = 0; b < rank; b++) s->basis_gap[j * n + b] = (ast_real)along[b] - (ast_real)s->shared[first + b];
    }
    return 0;
}

/* A candidate, as the inner products that its distances need. */
struct candidate {
    const float *inner; /* d'columns */
    ast_real square;    /* |d|^2 */
    ast_real length;    /* the same before the metric: what rounding is relative to */
    ast_real rho;       /* length of what Q does not explain of d; 0 when that is nothing */
    ast_real q[AST_MAX_HISTORY];
    const ast_real *residual; /* d - Q q where e's inner products must be computed from it; else NULL */
    int dims;                 /* coordinates: r, and one more when rho > 0 */
    int rank;                 /* directions of U_i present */
};

/* Subtracts from d what Q explains of it, twice, since Q is orthonormal to single precision only; q receives the coordinates. Returns
 * the squared length of what is left. */
static ast_real residual_of(const struct ast_gram *s, const struct ast_bag *bag, const float *d, ast_real *residual, ast_real *q) {
    enum { PASSES = 2 };
    ast_real rest = 0;
    for (int i = 0; i < s->dim; i++) residual[i] = (ast_real)d[i];
    for (int l = 0; l < s->rank; l++) q[l] = 0;
    for (int pass = 0; pass < PASSES; pass++) {
        for (int l = 0; l < s->rank; l++) {
            const float *column = lead_column(bag, Q_FIRST + l);
            ast_real along = 0;
            for (int i = 0; i < s->dim; i++) along += residual[i] * (ast_real)column[i];
            for (int i = 0; i < s->dim; i++) residual[i] -= along * (ast_real)column[i];
            q[l] += along;
        }
    }
    for (int i = 0; i < s->dim; i++) rest += residual[i] * residual[i];
    return rest;
}

/* Splits d into its part in Q and the rest. */
static void project(const struct ast_gram *s, const struct ast_scene *scene, const float *d, struct candidate *c) {
    const struct ast_bag *bag = scene->bag;
    ast_real *residual = scene->work;
    ast_real explained = 0;
    for (int l = 0; l < s->rank; l++) {
        c->q[l] = (ast_real)c->inner[1 + l];
        explained += c->q[l] * c->q[l];
    }
    c->residual = NULL;
    ast_real rest = c->square - explained;
    if (scene->background > 0) {
        /* Inner products corrected for the metric carry single precision's rounding: below it there is no direction to speak of. */
        if (rest < (ast_real)1e-6 * c->length) rest = 0;
    } else if (rest < RESIDUAL_TOLERANCE * c->square) {
        rest = residual_of(s, bag, d, residual, c->q);
        c->residual = residual;
    }
    /* What is left of a patch that lies in Q is Q's own rounding: no direction. */
    const ast_real noise = (ast_real)FLT_EPSILON;
    c->rho = rest > noise * noise * (c->square + s->reference_square) ? ast_sqrt(rest) : 0;
    c->dims = s->rank + (c->rho > 0);
}

/* Eigenvectors (in s->vectors, descending) of the set's scatter matrix, and the rank of its basis. */
static void decompose(struct ast_gram *s, const struct ast_scene *scene, struct candidate *c) {
    const int p = scene->history->count, dims = c->dims;
    const ast_real gamma = scene->cfg->basis == AST_BASIS_CENTRED ? (ast_real)p / (p + 1) : 1;
    ast_real v[AST_MAX_HISTORY + 1] = {0};
    for (int l = 0; l < s->rank; l++) v[l] = c->q[l] + s->offset[l];
    if (dims > s->rank) v[s->rank] = c->rho;
    for (int j = 0; j < dims; j++)
        for (int i = 0; i < dims; i++) s->matrix[j * dims + i] = gamma * v[i] * v[j] + (i == j && i < s->rank ? s->spectrum[i] : 0);
    ast_eigen_symmetric(dims, s->matrix, s->values, s->vectors);

    const ast_real patch_square = c->square + 2 * (ast_real)c->inner[0] + s->reference_square;
    const ast_real norm = ast_sqrt(s->history_square + (patch_square > 0 ? patch_square : 0));
    for (int l = 0; l < dims; l++) s->values[l] = s->values[l] > 0 ? ast_sqrt(s->values[l]) : 0;
    c->rank = ast_rank(s->values, dims, scene->cfg->basis_size, norm);
}

/* e'x for a column of the bag, given d'x and Q'x. */
static ast_real residual_product(const struct ast_gram *s, const struct ast_bag *bag, const struct candidate *c, int column) {
    const float *along_q = s->shared + column; /* Q_l'x at (1 + l) * columns */
    const size_t columns = (size_t)ast_bag_columns(bag);
    ast_real sum = 0;
    if (c->residual != NULL) {
        const float *x = lead_column(bag, column);
        for (int d = 0; d < s->dim; d++) sum += c->residual[d] * (ast_real)x[d];
        return sum / c->rho;
    }
    sum = (ast_real)c->inner[column];
    for (int l = 0; l < s->rank; l++) sum -= c->q[l] * (ast_real)along_q[(size_t)(1 + l) * columns];
    return sum / c->rho;
}

static ast_real geodesic(struct ast_gram *s, const struct ast_bag *bag, const struct candidate *c, int other) {
    ast_real cosines[AST_MAX_BASIS], angles[AST_MAX_BASIS];
    const int rank = c->rank;
    /* U_i'U_j = W' [Q e]'U_j */
    for (int b = 0; b < other; b++) {
        for (int a = 0; a < rank; a++) {
            ast_real sum = 0;
            for (int l = 0; l < c->dims; l++) sum += s->vectors[a * c->dims + l] * s->basis_cross[b * c->dims + l];
            s->cross[b * rank + a] = sum;
        }
    }
    /* Its singular values: square roots of the eigenvalues of the smaller Gram matrix. */
    const int size = rank < other ? rank : other;
    for (int y = 0; y < size; y++) {
        for (int x = 0; x <= y; x++) {
            ast_real sum = 0;
            if (other <= rank)
                for (int a = 0; a < rank; a++) sum += s->cross[x * rank + a] * s->cross[y * rank + a];
            else
                for (int b = 0; b < other; b++) sum += s->cross[b * rank + x] * s->cross[b * rank + y];
            s->small[y * size + x] = s->small[x * size + y] = sum;
        }
    }
    ast_eigen_symmetric(size, s->small, cosines, NULL);
    for (int l = 0; l < size; l++) cosines[l] = cosines[l] > 0 ? ast_sqrt(cosines[l]) : 0;
    ast_principal_angles(cosines, rank, other, bag->n, angles);
    return ast_geodesic(angles, bag->n);
}

static ast_real distance_to(struct ast_gram *s, const struct ast_scene *scene, const struct candidate *c, int slot) {
    const struct ast_bag *bag = scene->bag;
    const int first = bag->lead + slot * (bag->n + 1), mean = first + bag->n, other = bag->rank[slot];
    const size_t columns = (size_t)ast_bag_columns(bag);
    for (int b = 0; b < other; b++) {
        for (int l = 0; l < s->rank; l++)
            s->basis_cross[b * c->dims + l] = (ast_real)s->shared[(size_t)(1 + l) * columns + (size_t)(first + b)];
        if (c->dims > s->rank) s->basis_cross[b * c->dims + s->rank] = residual_product(s, bag, c, first + b);
    }
    ast_real total = geodesic(s, bag, c, other);
    if (scene->cfg->model == AST_MODEL_LINEAR) return total;

    /* difference = mu_i - mu_j = share d - g, g = mu_j - reference */
    const ast_real share = 1 / (ast_real)(scene->history->count + 1);
    const ast_real d_g = (ast_real)c->inner[mean] - (ast_real)c->inner[0];
    ast_real square = share * share * c->square - 2 * share * d_g + s->gap_square[slot];
    if (square < 0) square = 0;

    ast_real along[AST_MAX_HISTORY + 1]; /* [Q e]'difference */
    for (int l = 0; l < s->rank; l++) {
        const float *q_column = s->shared + (size_t)(1 + l) * columns;
        along[l] = share * c->q[l] - ((ast_real)q_column[mean] - (ast_real)q_column[0]);
    }
    if (c->dims > s->rank) along[s->rank] = share * c->rho - (residual_product(s, bag, c, mean) - residual_product(s, bag, c, 0));

    ast_real along_candidate[AST_MAX_BASIS], along_model[AST_MAX_BASIS];
    for (int a = 0; a < c->rank; a++) {
        along_candidate[a] = 0;
        for (int l = 0; l < c->dims; l++) along_candidate[a] += s->vectors[a * c->dims + l] * along[l];
    }
    for (int b = 0; b < other; b++) along_model[b] = share * (ast_real)c->inner[first + b] - s->basis_gap[slot * bag->n + b];
    ast_real mean_term = ast_mahalanobis(square, along_candidate, c->rank, along_model, other);
    if (scene->background > 0) {
        /* The likelihood ratio of object to background: what is far from the background's mean m_b is the likelier to be the object. */
        const ast_real d_origin = (ast_real)c->inner[REFERENCE] - (ast_real)c->inner[background_mean(scene->cfg)];
        const ast_real from_background = s->origin_square + 2 * share * d_origin + share * share * c->square;
        mean_term -= 2 * (ast_real)scene->cfg->background_ratio * from_background;
    }
    return total + (ast_real)scene->cfg->alpha * mean_term;
}

static int tile(union ast_scratch *scratch, const struct ast_scene *scene, float *patches, int count, float *distance) {
    struct ast_gram *s = &scratch->gram;
    struct ast_bag *bag = scene->bag;
    const int columns = ast_bag_columns(bag);
    const float *reference = bag->columns;
    ast_real length[AST_TILE];
    for (int i = 0; i < count; i++) {
        float *d = patches + (size_t)i * (size_t)bag->stride;
        for (int p = 0; p < s->dim; p++) d[p] -= reference[p];
    }
    const int failed =
        scene->la->product(columns, count, s->dim, bag->columns, bag->stride, patches, bag->stride, s->inner, columns);
    if (failed) return failed;
    for (int i = 0; i < count; i++) {
        const float *d = patches + (size_t)i * (size_t)bag->stride;
        s->square[i] = length[i] = ast_dot(d, d, s->dim);
    }
    if (scene->background > 0) {
        const int mean = background_mean(scene->cfg);
        const int refused = ast_metric_apply(&s->metric, scene->la, columns, mean, s->inner, count, s->square);
        if (refused) return refused;
        for (int i = 0; i < count; i++) {
            for (int j = 0; j < bag->count; j++) {
                const int first = bag->lead + j * (bag->n + 1);
                orthonormalise(model_factor(s, bag, j), bag->n, bag->rank[j], s->inner + (size_t)i * (size_t)columns + first);
            }
        }
    }
    for (int i = 0; i < count; i++) {
        struct candidate c = {.inner = s->inner + (size_t)i * (size_t)columns, .square = s->square[i], .length = length[i]};
        project(s, scene, patches + (size_t)i * (size_t)bag->stride, &c);
        decompose(s, scene, &c);
        for (int j = 0; j < bag->count; j++)
            distance[(size_t)i * (size_t)bag->count + (size_t)j] = (float)distance_to(s, scene, &c, j);
    }
    return 0;
}

const struct ast_scoring ast_scoring_gram = {lead, layout, prepare, tile};
