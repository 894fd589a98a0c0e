/* The paper as written, candidate by candidate: form B_i, thin SVD, U_i'U_j, thin SVD again. The reference for the fast path. */
#include <stddef.h>

#include "distance.h"
#include "score.h"
#include "subspace.h"
#include "vector.h"

static int lead(const ast_config *cfg) {
    (void)cfg;
    return 0;
}

static void layout(union ast_scratch *scratch, const ast_config *cfg, int dim, struct ast_arena *arena) {
    struct ast_literal *s = &scratch->literal;
    s->dim = dim;
    s->models = ast_arena_take(arena, (size_t)dim * (size_t)cfg->basis_size * (size_t)cfg->bag_size, sizeof *s->models);
}

static void tile_layout(union ast_tile_scratch *own, const ast_config *cfg, const struct ast_linalg *la, int dim,
                        struct ast_arena *arena) {
    struct ast_literal_tile *t = &own->literal;
    const size_t n = (size_t)cfg->basis_size;
    t->values = ast_arena_take(arena, (size_t)cfg->history + 1, sizeof *t->values);
    t->cross = ast_arena_take(arena, n * n, sizeof *t->cross);
    t->small_count = la->svd_work((int)n, (int)n);
    t->small = ast_arena_take(arena, t->small_count, sizeof *t->small);
    t->mean = ast_arena_take(arena, (size_t)dim, sizeof *t->mean);
    t->difference = ast_arena_take(arena, (size_t)dim, sizeof *t->difference);
}

static int prepare(union ast_scratch *scratch, union ast_tile_scratch *own, const struct ast_scene *scene) {
    struct ast_literal *s = &scratch->literal;
    (void)own;
    const struct ast_bag *bag = scene->bag;
    for (int j = 0; j < bag->count; j++) {
        for (int l = 0; l < bag->n; l++) {
            const float *from = ast_bag_basis(bag, j) + (size_t)l * (size_t)bag->stride;
            ast_real *to = s->models + (size_t)(j * bag->n + l) * (size_t)s->dim;
            for (int d = 0; d < s->dim; d++) to[d] = (ast_real)from[d];
        }
    }
    return 0;
}

/* The Mahalanobis term to model j, from its D-dimensional definition. basis: U_i. */
static ast_real mean_term(int dim, struct ast_literal_tile *t, const ast_real *basis, const struct ast_bag *bag, int j, int rank) {
    const float *mean = ast_bag_mean(bag, j);
    ast_real along_candidate[AST_MAX_BASIS], along_model[AST_MAX_BASIS];
    for (int d = 0; d < dim; d++) t->difference[d] = t->mean[d] - mean[d];
    for (int l = 0; l < rank; l++) {
        const ast_real *u = basis + (size_t)l * (size_t)dim;
        along_candidate[l] = 0;
        for (int d = 0; d < dim; d++) along_candidate[l] += u[d] * (ast_real)t->difference[d];
    }
    for (int l = 0; l < bag->rank[j]; l++)
        along_model[l] = ast_dot(ast_bag_basis(bag, j) + (size_t)l * (size_t)bag->stride, t->difference, dim);
    return ast_mahalanobis(ast_dot(t->difference, t->difference, dim), along_candidate, rank, along_model, bag->rank[j]);
}

static int score(const struct ast_literal *s, struct ast_literal_tile *t, const struct ast_scene *scene, const float *patch,
                 float *distance) {
    const ast_config *cfg = scene->cfg;
    const struct ast_bag *bag = scene->bag;
    ast_real *basis = scene->work; /* U_i, and the decomposition's workspace behind it */
    const float *column[AST_MAX_HISTORY + 1];
    struct ast_images images = {column, scene->history->count + 1, s->dim};
    for (int j = 0; j < scene->history->count; j++) column[j] = ast_history_patch(scene->history, j);
    column[scene->history->count] = patch;

    ast_images_mean(&images, t->mean);
    int failed =
        ast_images_svd(scene->la, &images, cfg->basis == AST_BASIS_CENTRED ? t->mean : NULL, t->values, basis, scene->work_count);
    if (failed) return failed;
    const int count = images.count < s->dim ? images.count : s->dim;
    const int rank = ast_rank(t->values, count, bag->n, ast_images_norm(&images));

    for (int j = 0; j < bag->count; j++) {
        const int other = bag->rank[j];
        ast_real cosines[AST_MAX_BASIS], angles[AST_MAX_BASIS];
        if (rank > 0 && other > 0) {
            const ast_real *model = s->models + (size_t)(j * bag->n) * (size_t)s->dim;
            failed = scene->la->product_real(rank, other, s->dim, basis, s->dim, model, s->dim, t->cross, rank);
            if (!failed) failed = scene->la->svd(rank, other, t->cross, 0, cosines, t->small, t->small_count);
            if (failed) return failed;
        }
        ast_principal_angles(cosines, rank, other, bag->n, angles);
        ast_real total = ast_geodesic(angles, bag->n);
        if (cfg->model == AST_MODEL_AFFINE) total += (ast_real)cfg->alpha * mean_term(s->dim, t, basis, bag, j, rank);
        distance[j] = (float)total;
    }
    return 0;
}

static int tile(const union ast_scratch *scratch, union ast_tile_scratch *own, const struct ast_scene *scene, float *patches,
                int count, float *distance) {
    for (int i = 0; i < count; i++) {
        const int failed = score(&scratch->literal, &own->literal, scene, patches + (size_t)i * (size_t)scene->bag->stride,
                                 distance + (size_t)i * (size_t)scene->bag->count);
        if (failed) return failed;
    }
    return 0;
}

const struct ast_scoring ast_scoring_literal = {lead, layout, tile_layout, prepare, NULL, tile};
