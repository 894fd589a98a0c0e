#include "patch.h"

void ast_sampler_layout(struct ast_sampler *sampler, const ast_config *cfg, struct ast_arena *arena) {
    sampler->width = cfg->patch_width;
    sampler->height = cfg->patch_height;
    sampler->normalisation = cfg->normalisation;
    ast_resampler_layout(&sampler->resampler, cfg->patch_width, arena);
}

void ast_sampler_patch(struct ast_sampler *sampler, const ast_frame *frame, const ast_box *window, float *patch) {
    ast_resampler_aim(&sampler->resampler, frame, window, sampler->width, sampler->height);
    for (int r = 0; r < sampler->height; r += AST_RESAMPLER_ROWS) {
        const int rows = sampler->height - r < AST_RESAMPLER_ROWS ? sampler->height - r : AST_RESAMPLER_ROWS;
        ast_resampler_rows(&sampler->resampler, frame, r, rows, patch + (size_t)r * (size_t)sampler->width, (size_t)sampler->width);
    }
    sampler->resampler.kernels->normalise(patch, sampler->width * sampler->height, sampler->normalisation);
}
