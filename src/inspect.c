/* Looking inside a tracker. */
#include "tracker.h"

int32_t ast_feature_length(const ast_config *cfg) {
    return ast_config_check(cfg, NULL) == AST_OK ? ast_features_length(cfg) : 0;
}

int ast_get_config(const ast_tracker *t, ast_config *cfg) {
    if (t == NULL || cfg == NULL) return AST_E_NULL;
    *cfg = t->cfg;
    return AST_OK;
}

int ast_get_particles(const ast_tracker *t, ast_particles *out) {
    if (t == NULL || out == NULL) return AST_E_NULL;
    if (!t->started) return AST_E_NOT_STARTED;
    out->x = t->cloud.x;
    out->y = t->cloud.y;
    out->scale = t->cloud.scale;
    out->weight = t->cloud.weight;
    out->count = t->cloud.count;
    out->models = t->models;
    out->scored = t->models > 0 ? t->scored : 0;
    out->distance = t->models > 0 ? t->distance : NULL;
    out->reference.x = t->estimate.x;
    out->reference.y = t->estimate.y;
    out->reference.w = t->box_width;
    out->reference.h = t->box_height;
    return AST_OK;
}

int ast_bag_count(const ast_tracker *t) {
    if (t == NULL) return AST_E_NULL;
    return t->started ? t->bag.count : AST_E_NOT_STARTED;
}

int ast_get_model(const ast_tracker *t, int32_t index, ast_subspace *out) {
    if (t == NULL || out == NULL) return AST_E_NULL;
    if (!t->started) return AST_E_NOT_STARTED;
    if (index < 0 || index >= t->bag.count) return AST_E_RANGE;
    const int slot = ast_bag_slot(&t->bag, index);
    out->mean = ast_bag_mean(&t->bag, slot);
    out->basis = ast_bag_basis(&t->bag, slot);
    out->dim = t->dim;
    out->stride = t->stride;
    out->n = t->bag.n;
    out->rank = t->bag.rank[slot];
    return AST_OK;
}

int ast_history_count(const ast_tracker *t) {
    if (t == NULL) return AST_E_NULL;
    return t->started ? t->history.count : AST_E_NOT_STARTED;
}

int ast_get_history(const ast_tracker *t, int32_t index, const float **vector) {
    if (t == NULL || vector == NULL) return AST_E_NULL;
    if (!t->started) return AST_E_NOT_STARTED;
    if (index < 0 || index >= t->history.count) return AST_E_RANGE;
    *vector = ast_history_patch(&t->history, index);
    return AST_OK;
}
