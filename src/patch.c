#include "patch.h"

#include "real.h"

void ast_sampler_layout(struct ast_sampler *sampler, const ast_config *cfg, struct ast_arena *arena) {
    sampler->width = cfg->patch_width;
    sampler->height = cfg->patch_height;
    sampler->normalisation = cfg->normalisation;
    ast_resampler_layout(&sampler->resampler, cfg->patch_width, cfg->patch_height, arena);
}

/* From 0 .. 255 to the configured form. */
static void normalise(float *patch, int length, int normalisation) {
    ast_real sum = 0, square = 0;
    for (int i = 0; i < length; i++) patch[i] *= 1.0f / 255.0f;
    if (normalisation == AST_NORMALISE_NONE) return;
    for (int i = 0; i < length; i++) sum += (ast_real)patch[i];
    const float mean = (float)(sum / length);
    for (int i = 0; i < length; i++) {
        patch[i] -= mean;
        square += (ast_real)patch[i] * (ast_real)patch[i];
    }
    if (normalisation == AST_NORMALISE_MEAN) return;
    const float factor = (float)(1 / (ast_sqrt(square) + (ast_real)1 / 255));
    for (int i = 0; i < length; i++) patch[i] *= factor;
}

void ast_sampler_patch(struct ast_sampler *sampler, const ast_frame *frame, const ast_box *window, float *patch) {
    ast_resampler_aim(&sampler->resampler, frame, window, sampler->width, sampler->height);
    for (int r = 0; r < sampler->height; r++)
        ast_resampler_row(&sampler->resampler, frame, r, patch + (size_t)r * (size_t)sampler->width);
    normalise(patch, sampler->width * sampler->height, sampler->normalisation);
}
