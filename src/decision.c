#include "decision.h"

#include <stddef.h>

#include "real.h"

int ast_decide(const float *distance, int count, int models, const ast_config *cfg, float *weight) {
    for (int i = 0; i < count; i++) weight[i] = 0.0f;
    for (int j = 0; j < models; j++) {
        float least = distance[j];
        for (int i = 1; i < count; i++) {
            const float v = distance[(size_t)i * (size_t)models + (size_t)j];
            if (v < least) least = v;
        }
        ast_real mean = 0;
        for (int i = 0; i < count; i++) mean += (ast_real)distance[(size_t)i * (size_t)models + (size_t)j] / (ast_real)count;
        ast_real scale = (ast_real)cfg->sigma;
        if (cfg->likelihood == AST_LIKELIHOOD_SCALED) scale *= mean - (ast_real)least;
        const ast_real rate = scale > (ast_real)FLT_MIN ? 1 / scale : 0; /* all particles alike: all likelihoods too */
        /* Differences to the least: the nearest particle's likelihood is 1, so the sum neither under- nor overflows. */
        ast_real sum = 0;
        for (int i = 0; i < count; i++)
            sum += ast_exp(-((ast_real)distance[(size_t)i * (size_t)models + (size_t)j] - (ast_real)least) * rate);
        const ast_real share = 1 / (sum * (ast_real)models);
        for (int i = 0; i < count; i++)
            weight[i] +=
                (float)(share * ast_exp(-((ast_real)distance[(size_t)i * (size_t)models + (size_t)j] - (ast_real)least) * rate));
    }
    int best = 0;
    for (int i = 1; i < count; i++)
        if (weight[i] > weight[best]) best = i;
    return best;
}
