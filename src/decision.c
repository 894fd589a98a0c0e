#include "decision.h"

#include <stddef.h>

#include "kernels.h"

enum { BLOCK = 64 };

/* A block of likelihoods for model j, from particle `first` on. Differences to the least: the nearest particle's likelihood is 1,
 * so that sums neither under- nor overflow. Returns how many they are. */
static int likelihoods(const struct ast_kernels *kernels, const float *distance, int first, int count, int models, int j,
                       float least, ast_real rate, ast_real *likelihood) {
    const int used = count - first < BLOCK ? count - first : BLOCK;
    for (int i = 0; i < used; i++)
        likelihood[i] = -((ast_real)distance[(size_t)(first + i) * (size_t)models + (size_t)j] - (ast_real)least) * rate;
    kernels->exponentials(likelihood, used);
    return used;
}

/* Of a model's distances to the particles. */
struct summary {
    float least;
    ast_real contrast; /* by how much the mean exceeds it */
};

static struct summary summary_of(const float *distance, int count, int models, int j) {
    struct summary summary = {distance[j], 0};
    ast_real mean = 0;
    for (int i = 0; i < count; i++) {
        const float v = distance[(size_t)i * (size_t)models + (size_t)j];
        if (v < summary.least) summary.least = v;
        mean += (ast_real)v / (ast_real)count;
    }
    summary.contrast = mean - (ast_real)summary.least;
    return summary;
}

int ast_decide(const float *distance, int count, int models, const ast_config *cfg, float *weight) {
    const struct ast_kernels *kernels = ast_kernels();
    ast_real likelihood[BLOCK];
    for (int i = 0; i < count; i++) weight[i] = 0.0f;
    struct summary of_model[AST_MAX_BAG];
    ast_real votes = 0; /* all that the models have to say */
    for (int j = 0; j < models; j++) {
        of_model[j] = summary_of(distance, count, models, j);
        votes += of_model[j].contrast;
    }
    const int equal = cfg->vote == AST_VOTE_EQUAL || !(votes > (ast_real)FLT_MIN);
    if (equal) votes = (ast_real)models;
    for (int j = 0; j < models; j++) {
        const float least = of_model[j].least;
        const ast_real contrast = of_model[j].contrast;
        ast_real scale = (ast_real)cfg->sigma;
        if (cfg->likelihood == AST_LIKELIHOOD_SCALED) scale *= contrast;
        const ast_real rate = scale > (ast_real)FLT_MIN ? 1 / scale : 0; /* all particles alike: all likelihoods too */
        ast_real sum = 0;
        for (int first = 0; first < count; first += BLOCK) {
            const int used = likelihoods(kernels, distance, first, count, models, j, least, rate, likelihood);
            for (int i = 0; i < used; i++) sum += likelihood[i];
        }
        const ast_real share = (equal ? 1 : contrast) / (sum * votes);
        for (int first = 0; first < count; first += BLOCK) {
            const int used = likelihoods(kernels, distance, first, count, models, j, least, rate, likelihood);
            for (int i = 0; i < used; i++) weight[first + i] += (float)(share * likelihood[i]);
        }
    }
    int best = 0;
    for (int i = 1; i < count; i++)
        if (weight[i] > weight[best]) best = i;
    return best;
}
