/* Grey patches: the window of a state, resampled to a vector of patch_height x patch_width floats (paper section 2.2). */
#ifndef AST_PATCH_H
#define AST_PATCH_H

#include "resample.h"

struct ast_sampler {
    int width, height; /* patch size */
    int normalisation; /* AST_NORMALISE_* */
    struct ast_resampler resampler;
};

void ast_sampler_layout(struct ast_sampler *sampler, const ast_config *cfg, struct ast_arena *arena);
/* Resamples a window of a frame, its sides positive, into patch (width x height floats, row-major) and normalises it. */
void ast_sampler_patch(struct ast_sampler *sampler, const ast_frame *frame, const ast_box *window, float *patch);

#endif
