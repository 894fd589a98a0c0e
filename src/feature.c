#include "feature.h"

/* A part of the vector. A new feature is a new file and a row below. */
struct part {
    /* 0: not in this configuration */
    int (*length)(const ast_config *cfg);
    void (*layout)(struct ast_features *f, const ast_config *cfg, struct ast_arena *arena); /* NULL: nothing, as the next two */
    void (*scratch_layout)(struct ast_features_scratch *own, const ast_config *cfg, struct ast_arena *arena);
    void (*prepare)(struct ast_features *f, const ast_frame *image, float object_width, float object_height);
    void (*vector)(const struct ast_features *f, struct ast_features_scratch *own, const ast_frame *image, const ast_box *window,
                   float *out);
};

static int patch_length(const ast_config *cfg) {
    return cfg->patch_weight > 0.0f ? cfg->patch_width * cfg->patch_height : 0;
}
static void patch_scratch_layout(struct ast_features_scratch *own, const ast_config *cfg, struct ast_arena *arena) {
    ast_sampler_layout(&own->patch, cfg, arena);
}
static void patch_vector(const struct ast_features *f, struct ast_features_scratch *own, const ast_frame *image,
                         const ast_box *window, float *out) {
    ast_sampler_patch(&own->patch, image, window, out);
    const float weight = f->cfg.patch_weight;
    const int length = patch_length(&f->cfg);
    for (int i = 0; weight != 1.0f && i < length; i++) out[i] *= weight;
}

#ifndef AST_NO_GRADIENT
static int gradient_length(const ast_config *cfg) {
    return cfg->gradient_weight > 0.0f ? cfg->gradient_cells * cfg->gradient_cells * AST_DIRECTIONS : 0;
}
static void gradient_layout(struct ast_features *f, const ast_config *cfg, struct ast_arena *arena) {
    ast_gradient_layout(&f->gradient, cfg, arena);
}
static void gradient_prepare(struct ast_features *f, const ast_frame *image, float object_width, float object_height) {
    ast_gradient_prepare(&f->gradient, image, object_width, object_height);
}
static void gradient_vector(const struct ast_features *f, struct ast_features_scratch *own, const ast_frame *image,
                            const ast_box *window, float *out) {
    (void)own;
    (void)image;
    ast_gradient_cells(&f->gradient, window, out);
}
#endif

static const struct part parts[] = {
    {patch_length, NULL, patch_scratch_layout, NULL, patch_vector},
#ifndef AST_NO_GRADIENT
    {gradient_length, gradient_layout, NULL, gradient_prepare, gradient_vector},
#endif
};
enum { PARTS = sizeof parts / sizeof parts[0] };

int ast_features_length(const ast_config *cfg) {
    int length = 0;
    for (int p = 0; p < PARTS; p++) length += parts[p].length(cfg);
    return length;
}

/* The first that this configuration has; there is one. */
static const struct part *first_part(const ast_config *cfg) {
    int p = 0;
    while (p + 1 < PARTS && parts[p].length(cfg) == 0) p++;
    return &parts[p];
}

int ast_features_glance_length(const ast_config *cfg) {
    const struct part *part = first_part(cfg);
    return part->length(cfg);
}

void ast_features_layout(struct ast_features *f, const ast_config *cfg, struct ast_arena *arena) {
    f->cfg = *cfg;
    for (int p = 0; p < PARTS; p++)
        if (parts[p].length(cfg) > 0 && parts[p].layout != NULL) parts[p].layout(f, cfg, arena);
}

void ast_features_scratch_layout(struct ast_features_scratch *own, const ast_config *cfg, struct ast_arena *arena) {
    for (int p = 0; p < PARTS; p++)
        if (parts[p].length(cfg) > 0 && parts[p].scratch_layout != NULL) parts[p].scratch_layout(own, cfg, arena);
}

void ast_features_prepare(struct ast_features *f, const ast_frame *image, float object_width, float object_height) {
    for (int p = 0; p < PARTS; p++)
        if (parts[p].length(&f->cfg) > 0 && parts[p].prepare != NULL) parts[p].prepare(f, image, object_width, object_height);
}

void ast_features_vector(const struct ast_features *f, struct ast_features_scratch *own, const ast_frame *image,
                         const ast_box *window, float *vector) {
    for (int p = 0; p < PARTS; p++) {
        const int length = parts[p].length(&f->cfg);
        if (length == 0) continue;
        parts[p].vector(f, own, image, window, vector);
        vector += length;
    }
}

void ast_features_glance(const struct ast_features *f, struct ast_features_scratch *own, const ast_frame *image,
                         const ast_box *window, float *vector) {
    const struct part *part = first_part(&f->cfg);
    part->vector(f, own, image, window, vector);
}
