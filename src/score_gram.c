/* The fast path: the same distances from inner products alone.
 *
 * All candidates of a frame share the history H = [h_1 .. h_p]. Let `reference` be its mean and Q an orthonormal basis of H about
 * the basis's origin (the mean for a centred basis, zero for a raw one), with H H' = Q diag(spectrum) Q' there. For a candidate
 * patch c let d = c - reference, q = Q'd, and e the unit vector along d - Q q, of length rho. Then in the coordinates [Q e]:
 *
 *   - the scatter matrix of the set [H c] is diag(spectrum, 0) + gamma v v', v = (q + Q'(reference - origin), rho),
 *     gamma = p / (p + 1) for a centred basis and 1 for a raw one. Its eigenvectors W give U_i = [Q e] W, its
 *     eigenvalues the squared singular values;
 *   - U_i'U_j = W' [Q e]'U_j, where Q'U_j is shared by the frame and e'U_j = (d'U_j - q'Q'U_j) / rho;
 *   - mu_i = reference + d / (p + 1), which gives the Mahalanobis term in the same inner products.
 *
 * All inner products, norms and orthogonality are the configured metric's (metric.h); in the identity nothing changes.
 *
 * So one product of the patches d with the columns [reference Q U_1 mu_1 .. U_k mu_k] holds everything, and because d is a small
 * difference, single precision is enough for it. Unlike the Gram matrix of the set, the history enters through its own singular
 * values, not through their squares minus rounding.
 *
 * Candidates are taken AST_LANES at a time, one in each lane (score_kernel.h): what is done here for one is done there for all.
 * What has not changed since the last frame is not computed again: inner products of the background with itself and with the
 * models. */
#include <stddef.h>
#include <string.h>

#include "eigen.h"
#include "product.h"
#include "score.h"
#include "shortlist.h"
#include "subspace.h"
#include "vector.h"

/* Below this fraction of |d|^2, rho^2 = |d|^2 - |q|^2 has lost too many digits, and the residual is computed from its
 * definition. */
#define RESIDUAL_TOLERANCE ((ast_real)1e-1)

/* Columns in front of the bag's: reference, Q_1 .. Q_P, and with a background its mean m_b and its vectors. */
enum { REFERENCE = 0, Q_FIRST = 1 };

static int background_mean(const ast_config *cfg) {
    return Q_FIRST + cfg->history;
}

static int lead(const ast_config *cfg) {
    return background_mean(cfg) + (cfg->background > 0 ? 1 + cfg->background : 0);
}

static size_t columns_at_most(const ast_config *cfg) {
    return (size_t)lead(cfg) + (size_t)cfg->bag_size * ((size_t)cfg->basis_size + 1);
}

static void tile_layout(union ast_tile_scratch *own, const ast_config *cfg, const struct ast_linalg *la, int dim,
                        struct ast_arena *arena) {
    struct ast_gram_tile *t = &own->gram;
    const size_t p = (size_t)cfg->history, m = p + 1, n = (size_t)cfg->basis_size, columns = columns_at_most(cfg);
    (void)la;
    (void)dim;
    t->inner = ast_arena_take(arena, columns * AST_LANES, sizeof *t->inner);
    t->beside_buffer = cfg->background > 0 ? NULL : ast_arena_take(arena, columns * AST_LANES, sizeof *t->beside_buffer);
    t->square = ast_arena_take(arena, AST_LANES, sizeof *t->square);
    t->length = ast_arena_take(arena, AST_LANES, sizeof *t->length);
    t->apart = ast_arena_take(arena, AST_LANES, sizeof *t->apart);
    t->background = ast_arena_take(arena, AST_LANES, sizeof *t->background);
    t->q = ast_arena_take(arena, p * AST_LANES, sizeof *t->q);
    t->rest = ast_arena_take(arena, AST_LANES, sizeof *t->rest);
    t->rho = ast_arena_take(arena, AST_LANES, sizeof *t->rho);
    t->matrix = ast_arena_take(arena, m * m * AST_LANES, sizeof *t->matrix);
    t->values = ast_arena_take(arena, (m > n ? m : n) * AST_LANES, sizeof *t->values);
    t->vectors = ast_arena_take(arena, m * m * AST_LANES, sizeof *t->vectors);
    t->absent = ast_arena_take(arena, n * AST_LANES, sizeof *t->absent);
    t->constant = ast_arena_take(arena, n * AST_LANES, sizeof *t->constant);
    t->cross = ast_arena_take(arena, n * n * AST_LANES, sizeof *t->cross);
    t->small = ast_arena_take(arena, n * n * AST_LANES, sizeof *t->small);
    t->spare = ast_arena_take(arena, (n + 1) * AST_LANES, sizeof *t->spare);
    t->fresh = cfg->background > 0 ? ast_arena_take(arena, (size_t)cfg->background * AST_LANES, sizeof *t->fresh) : NULL;
}

static void layout(union ast_scratch *scratch, const ast_config *cfg, int dim, struct ast_arena *arena) {
    struct ast_gram *s = &scratch->gram;
    const size_t p = (size_t)cfg->history, n = (size_t)cfg->basis_size, k = (size_t)cfg->bag_size;
    s->dim = dim;
    s->size = cfg->basis_size;
    s->columns = columns_at_most(cfg);
    s->spectrum = ast_arena_take(arena, p, sizeof *s->spectrum);
    s->offset = ast_arena_take(arena, p, sizeof *s->offset);
    s->matrix = ast_arena_take(arena, p * p, sizeof *s->matrix);
    s->vectors = ast_arena_take(arena, p * p, sizeof *s->vectors);
    s->values = ast_arena_take(arena, p, sizeof *s->values);
    s->gap_square = ast_arena_take(arena, k, sizeof *s->gap_square);
    s->basis_gap = ast_arena_take(arena, k * n, sizeof *s->basis_gap);
    s->factor = ast_arena_take(arena, k * n * n, sizeof *s->factor);
    ast_metric_layout(&s->metric, cfg->background, cfg->ridge, background_mean(cfg), (int)s->columns, arena);
    if (ast_shortlist_length(cfg) < cfg->particles) s->taken = ast_arena_take(arena, (size_t)cfg->background, sizeof *s->taken);
    s->shared = ast_arena_take(arena, s->columns * (p + 1), sizeof *s->shared);
    if (cfg->background > 0) s->kept = ast_arena_take(arena, s->columns * (1 + (size_t)cfg->background), sizeof *s->kept);
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
    const size_t ld = s->columns;
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
    for (int x = 0; x < columns; x++) combine(vectors, r, s->shared + Q_FIRST * ld + x, ld);
    for (int b = 0; b < s->metric.size; b++) combine(vectors, r, ast_metric_known(&s->metric, Q_FIRST) + b, (size_t)s->metric.size);

    /* reference - origin in the new basis: both inner products in the metric. */
    const int mean = background_mean(scene->cfg);
    for (int l = 0; l < r; l++) {
        const float *row = s->shared + (size_t)(Q_FIRST + l) * ld;
        offset[l] = ((ast_real)row[REFERENCE] - ast_metric_correction(&s->metric, Q_FIRST + l, REFERENCE)) -
                    ((ast_real)row[mean] - ast_metric_correction(&s->metric, Q_FIRST + l, mean));
        s->offset[l] = scene->cfg->basis == AST_BASIS_CENTRED ? 0 : offset[l];
    }
}

/* Solves L x = v in place for the Cholesky factor of a model's basis: inner products with U_j become those with its orthonormal
 * form. */
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

/* One column's inner products with all, found in lane l of products. */
static void keep_products(struct ast_gram *s, const struct ast_scene *scene, int column, int columns, const float *products,
                          int l) {
    const int mean = background_mean(scene->cfg);
    float *row = NULL;
    if (column < mean)
        row = s->shared + (size_t)column * s->columns;
    else if (column < scene->bag->lead)
        row = s->kept + (size_t)(column - mean) * s->columns;
    for (int x = 0; row != NULL && x < columns; x++) row[x] = products[x * AST_LANES + l];
    for (int z = mean; z < scene->bag->lead; z++)
        s->kept[(size_t)(z - mean) * s->columns + (size_t)column] = products[z * AST_LANES + l];
}

/* Inner products of reference and Q, which change every frame, with all columns; and those of the background with all columns,
 * where one of the two was changed. By the library's own product whatever the backend, whose bits do not depend on what else is
 * computed with it: a restored tracker, which computes all anew, finds the same. */
static void update_products(struct ast_gram *s, struct ast_gram_tile *t, const struct ast_scene *scene, int columns) {
    struct ast_bag *bag = scene->bag;
    const int always = background_mean(scene->cfg);
    int column[AST_TILE], waiting = 0;
    for (int x = 0; x < columns; x++) {
        if (x < always || (scene->background > 0 && bag->changed[x])) column[waiting++] = x;
        if (waiting < AST_TILE && x + 1 < columns) continue;
        for (int l = 0; l < waiting; l++)
            memcpy(scene->spare + (size_t)l * (size_t)bag->stride, lead_column(bag, column[l]), (size_t)s->dim * sizeof(float));
        ast_product(waiting, columns, s->dim, scene->spare, bag->stride, bag->columns, bag->stride, t->inner, AST_LANES);
        for (int l = 0; l < waiting; l++) keep_products(s, scene, column[l], columns, t->inner, l);
        waiting = 0;
    }
    memset(bag->changed, 0, (size_t)columns);
}

static int prepare(union ast_scratch *scratch, union ast_tile_scratch *own, const struct ast_scene *scene) {
    struct ast_gram *s = &scratch->gram;
    struct ast_gram_tile *t = &own->gram;
    struct ast_bag *bag = scene->bag;
    const int columns = ast_bag_columns(bag), mean = background_mean(scene->cfg), n = bag->n, p = scene->history->count;
    const size_t ld = s->columns;
    const float *reference = bag->columns;
    const int failed = decompose_history(s, scene);
    if (failed) return failed;
    s->share = 1 / (ast_real)(p + 1);
    s->gamma = scene->cfg->basis == AST_BASIS_CENTRED ? (ast_real)p / (ast_real)(p + 1) : 1;
    s->alpha = scene->cfg->model == AST_MODEL_LINEAR ? -1 : (ast_real)scene->cfg->alpha;
    update_products(s, t, scene, columns);

    const int adapted = scene->background > 0;
    if (adapted) {
        ast_metric_prepare(&s->metric, scene->kernels, s->kept, columns, (int)ld, t->fresh);
        adapt_history(s, scene, columns);
        for (int row = 0; row < Q_FIRST + s->rank; row++)
            for (int x = 0; x < columns; x = x == mean ? bag->lead : x + 1)
                s->shared[(size_t)row * ld + (size_t)x] -= (float)ast_metric_correction(&s->metric, row, x);
        const ast_real m_b_square = (ast_real)s->kept[mean] - ast_metric_correction(&s->metric, mean, mean);
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
            for (int row = 0; row < Q_FIRST + s->rank; row++) orthonormalise(factor, n, rank, s->shared + (size_t)row * ld + first);
            orthonormalise(factor, n, rank, along);
        }
        s->gap_square[j] = sum > 0 ? sum : 0;
        for (int b = 0; b < rank; b++) s->basis_gap[j * n + b] = (ast_real)along[b] - (ast_real)s->shared[first + b];
    }
    return 0;
}

/* Replaces d by what Q does not explain of it, taken away twice, since Q is orthonormal to single precision only; the lane's q
 * receives the coordinates. Returns the squared length of what is left. */
static ast_real residual_of(const struct ast_gram *s, const struct ast_scene *scene, float *d, ast_real *q) {
    enum { PASSES = 2 };
    ast_real *residual = scene->work, rest = 0;
    for (int i = 0; i < s->dim; i++) residual[i] = (ast_real)d[i];
    for (int l = 0; l < s->rank; l++) q[l * AST_LANES] = 0;
    for (int pass = 0; pass < PASSES; pass++) {
        for (int l = 0; l < s->rank; l++) {
            const float *column = lead_column(scene->bag, Q_FIRST + l);
            ast_real along = 0;
            for (int i = 0; i < s->dim; i++) along += residual[i] * (ast_real)column[i];
            for (int i = 0; i < s->dim; i++) residual[i] -= along * (ast_real)column[i];
            q[l * AST_LANES] += along;
        }
    }
    for (int i = 0; i < s->dim; i++) {
        rest += residual[i] * residual[i];
        d[i] = (float)residual[i];
    }
    return rest;
}

/* Sets the lanes apart whose inner products with e must be computed from the residual itself. */
static void set_apart(const struct ast_gram *s, const struct ast_scene *scene, struct ast_gram_tile *t, float *patches, int count,
                      int columns) {
    t->beside = t->inner;
    for (int i = 0; i < count; i++) {
        if (!(t->rest[i] < RESIDUAL_TOLERANCE * t->square[i])) continue;
        if (t->beside == t->inner) memcpy(t->beside_buffer, t->inner, (size_t)columns * AST_LANES * sizeof *t->inner);
        t->beside = t->beside_buffer;
        float *residual = patches + (size_t)i * (size_t)scene->bag->stride;
        t->apart[i] = 1;
        t->rest[i] = residual_of(s, scene, residual, t->q + i);
        for (int x = 0; x < columns; x = x == REFERENCE ? scene->bag->lead : x + 1)
            t->beside_buffer[(size_t)x * AST_LANES + (size_t)i] = (float)ast_dot(residual, lead_column(scene->bag, x), s->dim);
    }
}

/* In the learned metric: what rounding leaves is no direction, and what is far from the background's mean m_b is the likelier to be
 * the object. */
static void meet_background(const struct ast_gram *s, const struct ast_scene *scene, struct ast_gram_tile *t) {
    const float *reference = t->inner, *mean = t->inner + (size_t)background_mean(scene->cfg) * AST_LANES;
    t->beside = t->inner;
    for (int i = 0; i < AST_LANES; i++) {
        if (t->rest[i] < (ast_real)1e-6 * t->length[i]) t->rest[i] = 0;
        const ast_real d_origin = (ast_real)reference[i] - (ast_real)mean[i];
        const ast_real from_background = s->origin_square + 2 * s->share * d_origin + s->share * s->share * t->square[i];
        t->background[i] = 2 * (ast_real)scene->cfg->background_ratio * from_background;
    }
}

static int tile(const union ast_scratch *scratch, union ast_tile_scratch *own, const struct ast_scene *scene, float *patches,
                int count, float *distance) {
    const struct ast_kernels *kernels = scene->kernels;
    const struct ast_gram *s = &scratch->gram;
    struct ast_gram_tile *t = &own->gram;
    const struct ast_bag *bag = scene->bag;
    const int columns = ast_bag_columns(bag), n = bag->n;
    kernels->depart(patches, (size_t)bag->stride, count, bag->columns, s->dim, t->square);
    for (int i = 0; i < AST_LANES; i++) {
        if (i >= count) t->square[i] = 0;
        t->length[i] = t->square[i];
        t->apart[i] = t->background[i] = 0;
    }
    if (count < AST_LANES) memset(t->inner, 0, (size_t)columns * AST_LANES * sizeof *t->inner);
    const int failed =
        scene->la->product(count, columns, s->dim, patches, bag->stride, bag->columns, bag->stride, t->inner, AST_LANES);
    if (failed) return failed;
    if (scene->background > 0) ast_metric_apply(&s->metric, scene->kernels, columns, t->inner, t->square, t->fresh);
    kernels->project(s, t);
    if (scene->background > 0)
        meet_background(s, scene, t);
    else
        set_apart(s, scene, t, patches, count, columns);
    kernels->decompose(s, t);
    for (int j = 0; j < bag->count; j++) {
        const struct ast_gram_model model = {.first = bag->lead + j * (n + 1),
                                             .rank = bag->rank[j],
                                             .factor = scene->background > 0 ? model_factor(s, bag, j) : NULL,
                                             .basis_gap = s->basis_gap + j * n,
                                             .gap_square = s->gap_square[j]};
        float to_model[AST_LANES];
        kernels->pair(s, t, &model, to_model);
        for (int i = 0; i < count; i++) distance[(size_t)i * (size_t)bag->count + (size_t)j] = to_model[i];
    }
    return 0;
}

/* With the likelihood ratio the squares of mu_i cancel in the Mahalanobis term, and what is left of it is linear in the patch:
 * -(mu_j - m_b)'M x but for a factor, for each model. */
static void aim(const union ast_scratch *scratch, const struct ast_scene *scene, const float *say, int length, float *direction) {
    const ast_real floor = (ast_real)1e-3; /* a model that did not speak for the last winner may for this one */
    const struct ast_gram *s = &scratch->gram;
    const struct ast_bag *bag = scene->bag;
    const int size = s->metric.size, mean = background_mean(scene->cfg);
    const float *origin = lead_column(bag, mean), *of_origin = ast_metric_known(&s->metric, mean);
    ast_real *taken = s->taken, total = 0;
    for (int r = 0; r < size; r++) taken[r] = 0;
    for (int d = 0; d < length; d++) direction[d] = 0.0f;
    for (int j = 0; j < bag->count; j++) {
        const ast_real part = (ast_real)say[j] + floor;
        const float share = (float)part, *centre = ast_bag_mean(bag, j);
        const float *of_centre = ast_metric_known(&s->metric, bag->lead + j * (bag->n + 1) + bag->n);
        for (int r = 0; r < size; r++) taken[r] += part * ((ast_real)of_centre[r] - (ast_real)of_origin[r]);
        for (int d = 0; d < length; d++) direction[d] += share * (centre[d] - origin[d]);
    }
    ast_metric_back(&s->metric, taken);
    for (int r = 0; r < size; r++) {
        const float share = (float)taken[r], *vector = lead_column(bag, mean + 1 + r);
        total += taken[r];
        for (int d = 0; d < length; d++) direction[d] -= share * vector[d];
    }
    const float share = (float)total;
    for (int d = 0; d < length; d++) direction[d] += share * origin[d];
}

const struct ast_scoring ast_scoring_gram = {lead, layout, tile_layout, prepare, aim, tile};
