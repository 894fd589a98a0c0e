/* The feature vector of a window: the configured parts, each with its weight, one after the other. */
#ifndef AST_FEATURE_H
#define AST_FEATURE_H

#include "gradient.h"
#include "patch.h"

struct ast_features {
    ast_config cfg;
    struct ast_gradient gradient;
};

/* Of a vector: vectors that are made at the same time have one each. */
struct ast_features_scratch {
    struct ast_sampler patch;
};

/* Floats in a vector of this configuration. */
int ast_features_length(const ast_config *cfg);
/* Of them, those of the first part. */
int ast_features_glance_length(const ast_config *cfg);
void ast_features_layout(struct ast_features *f, const ast_config *cfg, struct ast_arena *arena);
void ast_features_scratch_layout(struct ast_features_scratch *own, const ast_config *cfg, struct ast_arena *arena);
/* Once for each image: whatever all its windows share. object_*: the object's size in it, pixels. */
void ast_features_prepare(struct ast_features *f, const ast_frame *image, float object_width, float object_height);
/* The vector of a window of that image. */
void ast_features_vector(const struct ast_features *f, struct ast_features_scratch *own, const ast_frame *image,
                         const ast_box *window, float *vector);
/* Its first part alone: the grey patch, where the configuration has one. */
void ast_features_glance(const struct ast_features *f, struct ast_features_scratch *own, const ast_frame *image,
                         const ast_box *window, float *vector);

#endif
