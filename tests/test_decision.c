/* From distances to weights and a winner, against sums in double. */
#include "decision.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "support_noise.h"
#include "support_precision.h"
#include "unity.h"

void setUp(void) {
}
void tearDown(void) {
}

enum { MOST_PARTICLES = 700, MOST_MODELS = 64 };

static float distance[MOST_PARTICLES * MOST_MODELS], weight[MOST_PARTICLES];
static double expected[MOST_PARTICLES];
static float place[MOST_PARTICLES]; /* of all particles: the same */
static struct ast_voice voice[MOST_MODELS];

/* Weighs the particles and takes the likeliest, wherever it is. */
static int decide(int count, int models, const ast_config *cfg, float *weights) {
    const struct ast_cloud cloud = {.count = count, .x = place, .y = place, .scale = place, .weight = weights};
    const struct ast_expectation anywhere = {0.0f, 0.0f, 0.0f};
    ast_weigh(distance, count, models, cfg, weights, voice);
    return ast_winner(&cloud, count, &anywhere);
}

static ast_config configured(int likelihood, float sigma) {
    ast_config cfg;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&cfg, AST_PRESET_PAPER));
    cfg.likelihood = likelihood;
    cfg.sigma = sigma;
    return cfg;
}

/* Equations 6 to 9 of the paper with each model's distances shifted by their least, which cancels in the normalisation; the scaled
 * likelihood's sigma is in units of the mean of the shifted distances, and so is a vote by contrast. */
static void reference(int count, int models, const ast_config *cfg) {
    double total = 0, votes = 0;
    for (int i = 0; i < count; i++) expected[i] = 0;
    for (int j = 0; j < models; j++) {
        double least = INFINITY, sum = 0, mean = 0, sigma = (double)cfg->sigma;
        for (int i = 0; i < count; i++) least = fmin(least, (double)distance[i * models + j]);
        for (int i = 0; i < count; i++) mean += ((double)distance[i * models + j] - least) / count;
        if (cfg->likelihood == AST_LIKELIHOOD_SCALED) sigma *= mean > 0 ? mean : 1;
        if (!AST_REAL_IS_DOUBLE && sigma > (double)FLT_MAX) sigma = INFINITY; /* then all weigh alike */
        for (int i = 0; i < count; i++) sum += exp((least - (double)distance[i * models + j]) / sigma);
        const double vote = cfg->vote == AST_VOTE_CONTRAST ? mean : 1;
        votes += vote;
        for (int i = 0; i < count; i++) expected[i] += vote * exp((least - (double)distance[i * models + j]) / sigma) / sum;
    }
    TEST_ASSERT_TRUE(votes > 0);
    for (int i = 0; i < count; i++) total += expected[i];
    for (int i = 0; i < count; i++) expected[i] /= total;
}

static int decide_and_compare_by(int count, int models, const ast_config *cfg) {
    for (int i = 0; i < count; i++) weight[i] = NAN; /* what was there counts for nothing */
    const int best = decide(count, models, cfg, weight);
    double sum = 0;
    reference(count, models, cfg);
    for (int i = 0; i < count; i++) {
        TEST_ASSERT_TRUE(weight[i] >= 0.0f && weight[i] <= 1.000001f);
        /* The weight is at most the likelihood, so that its logarithm bounds the exponent. */
        const double slack = 2e-6 + real_power_slack(count, log(expected[i] + 1e-300));
        TEST_ASSERT_DOUBLE_WITHIN(slack * expected[i] + 1e-37, expected[i], (double)weight[i]);
        sum += (double)weight[i];
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-5 + real_sum_slack(count), 1.0, sum);
    for (int i = 0; i < count; i++) TEST_ASSERT_TRUE(weight[i] < weight[best] || (weight[i] == weight[best] && i >= best));
    return best;
}

static int decide_and_compare_as(int count, int models, int likelihood, float sigma) {
    const ast_config cfg = configured(likelihood, sigma);
    return decide_and_compare_by(count, models, &cfg);
}

static int decide_and_compare(int count, int models, float sigma) {
    return decide_and_compare_as(count, models, AST_LIKELIHOOD_FIXED, sigma);
}

static void test_weights_are_the_likelihoods_summed_over_the_bag(void) {
    static const float sigmas[] = {0.01f, 0.1f, 1.0f, 100.0f};
    struct noise noise = {1};
    for (size_t s = 0; s < sizeof sigmas / sizeof sigmas[0]; s++) {
        for (int models = 1; models <= 12; models += 3) {
            noise_fill(&noise, distance, (size_t)(600 * models), 0.0, 3.0);
            (void)decide_and_compare(600, models, sigmas[s]);
        }
    }
    noise_fill(&noise, distance, (size_t)(70 * MOST_MODELS), 0.0, 0.2);
    (void)decide_and_compare(70, MOST_MODELS, 0.05f);
}

static void test_scaled_likelihood(void) {
    static const float sigmas[] = {1e-6f, 0.05f, 0.1f, 1.0f, 1e6f};
    struct noise noise = {4};
    for (size_t s = 0; s < sizeof sigmas / sizeof sigmas[0]; s++) {
        for (int models = 1; models <= 20; models += 19) {
            noise_fill(&noise, distance, (size_t)(350 * models), 5.0, 9.0);
            (void)decide_and_compare_as(350, models, AST_LIKELIHOOD_SCALED, sigmas[s]);
        }
    }
}

/* A scaled likelihood has no unit: distances that are all larger by a factor and a shift give the same weights. */
static void test_scaled_likelihood_has_no_unit(void) {
    const ast_config cfg = configured(AST_LIKELIHOOD_SCALED, 0.1f);
    struct noise noise = {5};
    float before[60];
    for (int i = 0; i < 60; i++) distance[i] = (float)noise_int(&noise, 0, 255) / 256.0f;
    const int best = decide(60, 1, &cfg, before);
    for (int i = 0; i < 60; i++) distance[i] = 64.0f * distance[i] + 128.0f; /* exact */
    TEST_ASSERT_EQUAL_INT(best, decide_and_compare_as(60, 1, AST_LIKELIHOOD_SCALED, 0.1f));
    for (int i = 0; i < 60; i++) {
        const double was = (double)before[i], slack = 1e-7 + real_power_slack(60, log(was + 1e-300)) * was;
        TEST_ASSERT_DOUBLE_WITHIN(slack, was, (double)weight[i]);
    }
}

/* All at one distance: no scale, and no preference. */
static void test_scaled_likelihood_of_equal_distances(void) {
    static const float levels[] = {0.0f, 1e-30f, 3.0f, 1e30f};
    for (size_t l = 0; l < sizeof levels / sizeof levels[0]; l++) {
        for (int i = 0; i < 40; i++) distance[i] = levels[l];
        TEST_ASSERT_EQUAL_INT(0, decide_and_compare_as(40, 1, AST_LIKELIHOOD_SCALED, 0.1f));
        for (int i = 0; i < 40; i++) TEST_ASSERT_FLOAT_WITHIN(1e-7f, 1.0f / 40.0f, weight[i]);
    }
}

static void test_nearest_particle_wins(void) {
    struct noise noise = {2};
    for (int wanted = 0; wanted < 40; wanted++) {
        noise_fill(&noise, distance, 40, 1.0, 2.0);
        distance[wanted] = 0.5f;
        TEST_ASSERT_EQUAL_INT(wanted, decide_and_compare(40, 1, 0.1f));
    }
}

/* Each model's likelihoods are normalised over the particles: a model that is far from all of them has as much to say. */
static void test_models_have_equal_votes(void) {
    /* model 0 slightly prefers particle 0; model 1, far away, strongly prefers particle 1 */
    static const float far_away[] = {1.00f, 900.0f, 1.01f, 899.0f, 1.05f, 901.0f};
    for (int i = 0; i < 6; i++) distance[i] = far_away[i];
    TEST_ASSERT_EQUAL_INT(1, decide_and_compare(3, 2, 0.1f));
}

/* Two models of the same shape, one of them with four times the contrast: by contrast it decides, by equal votes it is a tie. */
static void test_a_vote_by_contrast_is_as_large_as_the_contrast(void) {
    static const float unequal[] = {0.0f, 4.0f, 1.0f, 0.0f, 1.0f, 4.0f, 1.0f, 4.0f};
    ast_config cfg = configured(AST_LIKELIHOOD_SCALED, 0.01f);
    for (int i = 0; i < 8; i++) distance[i] = unequal[i];
    TEST_ASSERT_EQUAL_INT(0, decide_and_compare_by(4, 2, &cfg));
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, 0.5f, weight[0]);
    cfg.vote = AST_VOTE_CONTRAST;
    TEST_ASSERT_EQUAL_INT(1, decide_and_compare_by(4, 2, &cfg));
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, 0.8f, weight[1]);
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, 0.2f, weight[0]);
    /* One that prefers nobody has nothing to say, and where none has, all particles are alike. */
    for (int i = 0; i < 4; i++) distance[2 * i + 1] = 7.0f;
    TEST_ASSERT_EQUAL_INT(0, decide_and_compare_by(4, 2, &cfg));
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, 1.0f, weight[0]);
    for (int i = 0; i < 8; i++) distance[i] = 7.0f;
    TEST_ASSERT_EQUAL_INT(0, decide(4, 2, &cfg, weight));
    for (int i = 0; i < 4; i++) TEST_ASSERT_FLOAT_WITHIN(1e-7f, 0.25f, weight[i]);
}

static void test_votes_by_contrast(void) {
    struct noise noise = {6};
    for (int likelihood = AST_LIKELIHOOD_FIXED; likelihood <= AST_LIKELIHOOD_SCALED; likelihood++) {
        ast_config cfg = configured(likelihood, 0.1f);
        cfg.vote = AST_VOTE_CONTRAST;
        for (int models = 1; models <= 18; models += 17) {
            noise_fill(&noise, distance, (size_t)(350 * models), 0.0, 2.0);
            for (int i = 0; i < 350; i++) distance[i * models] *= 0.1f;
            (void)decide_and_compare_by(350, models, &cfg);
        }
    }
}

static void test_shift_of_a_model_changes_nothing(void) {
    struct noise noise = {3};
    float before[50];
    for (int i = 0; i < 100; i++) distance[i] = (float)noise_int(&noise, 0, 64) / 64.0f;
    const ast_config cfg = configured(AST_LIKELIHOOD_FIXED, 0.25f);
    const int best = decide(50, 2, &cfg, before);
    for (int i = 0; i < 50; i++) distance[2 * i + 1] += 1024.0f; /* exact */
    TEST_ASSERT_EQUAL_INT(best, decide_and_compare(50, 2, 0.25f));
    TEST_ASSERT_EQUAL_MEMORY(before, weight, sizeof before);
}

static void test_lowest_index_wins_a_tie(void) {
    for (int i = 0; i < 30; i++) distance[i] = i == 7 || i == 12 || i == 29 ? 0.5f : 0.75f;
    TEST_ASSERT_EQUAL_INT(7, decide_and_compare(30, 1, 0.1f));
    for (int i = 0; i < 30; i++) distance[i] = 0.5f;
    TEST_ASSERT_EQUAL_INT(0, decide_and_compare(30, 1, 0.1f));
    for (int i = 0; i < 30; i++) TEST_ASSERT_FLOAT_WITHIN(1e-8f, 1.0f / 30.0f, weight[i]);
}

static void test_one_particle_has_all_the_weight(void) {
    for (int models = 1; models <= MOST_MODELS; models++) {
        distance[models - 1] = 7.0f;
        TEST_ASSERT_EQUAL_INT(0, decide_and_compare(1, models, 0.01f));
        TEST_ASSERT_FLOAT_WITHIN(1e-6f, 1.0f, weight[0]);
    }
}

/* Distances and scales at the ends of their ranges: nothing under- or overflows into zero in all places, infinity or NaN. */
static void test_extreme_distances(void) {
    static const float sigmas[] = {1e-6f, 1.0f, 1e6f};
    static const float extremes[] = {0.0f, 1e-30f, 1e-6f, 2.7f, 1e6f, 1e20f, FLT_MAX};
    enum { COUNT = sizeof extremes / sizeof extremes[0] };
    for (size_t s = 0; s < sizeof sigmas / sizeof sigmas[0]; s++) {
        for (int from = 0; from < COUNT; from++) {
            for (int i = from; i < COUNT; i++) distance[i - from] = extremes[i];
            TEST_ASSERT_EQUAL_INT(0, decide_and_compare(COUNT - from, 1, sigmas[s]));
            TEST_ASSERT_EQUAL_INT(0, decide_and_compare_as(COUNT - from, 1, AST_LIKELIHOOD_SCALED, sigmas[s]));
        }
        for (int i = 0; i < COUNT; i++) {
            distance[2 * i] = extremes[i];
            distance[2 * i + 1] = extremes[COUNT - 1 - i];
        }
        (void)decide_and_compare(COUNT, 2, sigmas[s]);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_weights_are_the_likelihoods_summed_over_the_bag);
    RUN_TEST(test_scaled_likelihood);
    RUN_TEST(test_scaled_likelihood_has_no_unit);
    RUN_TEST(test_scaled_likelihood_of_equal_distances);
    RUN_TEST(test_nearest_particle_wins);
    RUN_TEST(test_models_have_equal_votes);
    RUN_TEST(test_a_vote_by_contrast_is_as_large_as_the_contrast);
    RUN_TEST(test_votes_by_contrast);
    RUN_TEST(test_shift_of_a_model_changes_nothing);
    RUN_TEST(test_lowest_index_wins_a_tie);
    RUN_TEST(test_one_particle_has_all_the_weight);
    RUN_TEST(test_extreme_distances);
    return UNITY_END();
}
