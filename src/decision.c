#include "decision.h"

#include <stddef.h>

#include "kernels.h"
#include "maths.h"

enum { BLOCK = 64 };

/* A block of likelihoods for model j, from particle `first` on. Differences to the least: the nearest particle's likelihood is 1,
 * so that sums neither under- nor overflow. Returns how many they are. */
static int likelihoods(const struct ast_kernels *kernels, const float *distance, int first, int count, int models, int j,
                       const struct ast_voice *voice, ast_real *likelihood) {
    const int used = count - first < BLOCK ? count - first : BLOCK;
    for (int i = 0; i < used; i++)
        likelihood[i] =
            -((ast_real)distance[(size_t)(first + i) * (size_t)models + (size_t)j] - (ast_real)voice->least) * voice->rate;
    kernels->exponentials(likelihood, used);
    return used;
}

static struct ast_voice summary_of(const float *distance, int count, int models, int j) {
    struct ast_voice voice = {.least = distance[j]};
    ast_real mean = 0;
    for (int i = 0; i < count; i++) {
        const float v = distance[(size_t)i * (size_t)models + (size_t)j];
        if (v < voice.least) voice.least = v;
        mean += (ast_real)v / (ast_real)count;
    }
    voice.contrast = mean - (ast_real)voice.least;
    return voice;
}

void ast_weigh(const float *distance, int count, int models, const ast_config *cfg, float *weight, struct ast_voice *voice) {
    const struct ast_kernels *kernels = ast_kernels();
    ast_real likelihood[BLOCK];
    for (int i = 0; i < count; i++) weight[i] = 0.0f;
    ast_real votes = 0; /* all that the models have to say */
    for (int j = 0; j < models; j++) {
        voice[j] = summary_of(distance, count, models, j);
        votes += voice[j].contrast;
    }
    const int equal = cfg->vote == AST_VOTE_EQUAL || !(votes > (ast_real)FLT_MIN);
    if (equal) votes = (ast_real)models;
    for (int j = 0; j < models; j++) {
        struct ast_voice *v = &voice[j];
        ast_real scale = (ast_real)cfg->sigma;
        if (cfg->likelihood == AST_LIKELIHOOD_SCALED) scale *= v->contrast;
        v->rate = scale > (ast_real)FLT_MIN ? 1 / scale : 0; /* all particles alike: all likelihoods too */
        ast_real sum = 0;
        for (int first = 0; first < count; first += BLOCK) {
            const int used = likelihoods(kernels, distance, first, count, models, j, v, likelihood);
            for (int i = 0; i < used; i++) sum += likelihood[i];
        }
        v->share = (equal ? 1 : v->contrast) / (sum * votes);
        for (int first = 0; first < count; first += BLOCK) {
            const int used = likelihoods(kernels, distance, first, count, models, j, v, likelihood);
            for (int i = 0; i < used; i++) weight[first + i] += (float)(v->share * likelihood[i]);
        }
    }
}

static float square_to(const struct ast_cloud *cloud, int i, const struct ast_expectation *expected) {
    const float x = cloud->x[i] - expected->x, y = cloud->y[i] - expected->y;
    return x * x + y * y;
}

int ast_winner(const struct ast_cloud *cloud, int count, const struct ast_expectation *expected) {
    float rate = expected->reach > 0.0f ? 0.5f / (expected->reach * expected->reach) : 0.0f;
    if (rate > FLT_MAX) rate = FLT_MAX; /* a reach of next to nothing: zero times infinity would be no number */
    /* Relative to the nearest that weighs anything, so that the greatest product does not underflow with the others. */
    float nearest = FLT_MAX, greatest = -1.0f;
    for (int i = 0; i < count && rate > 0.0f; i++) {
        const float square = square_to(cloud, i, expected);
        if (cloud->weight[i] > 0.0f && square < nearest) nearest = square;
    }
    int best = 0;
    for (int i = 0; i < count; i++) {
        float value = cloud->weight[i];
        if (rate > 0.0f && value > 0.0f) value *= ast_expf((nearest - square_to(cloud, i, expected)) * rate);
        if (value > greatest) {
            greatest = value;
            best = i;
        }
    }
    return best;
}

void ast_attribute(const float *distance, const struct ast_voice *voice, int models, float *say) {
    const struct ast_kernels *kernels = ast_kernels();
    ast_real sum = 0;
    for (int j = 0; j < models; j++) {
        ast_real part = -((ast_real)distance[j] - (ast_real)voice[j].least) * voice[j].rate;
        kernels->exponentials(&part, 1);
        part *= voice[j].share;
        sum += part;
        say[j] = (float)part;
    }
    for (int j = 0; j < models; j++) say[j] = sum > 0 ? (float)((ast_real)say[j] / sum) : 0.0f;
}
