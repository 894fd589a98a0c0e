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

/* ---- The winner, where it is expected ---- */

static float across[MOST_PARTICLES], down[MOST_PARTICLES];

static int winner(int count, float at_x, float at_y, float reach) {
    const struct ast_cloud cloud = {.count = MOST_PARTICLES, .x = across, .y = down, .scale = place, .weight = weight};
    const struct ast_expectation about = {at_x, at_y, reach};
    return ast_winner(&cloud, count, &about);
}

/* Logarithm of weight times prior. */
static double merit(int i, float at_x, float at_y, float reach) {
    const double dx = (double)across[i] - (double)at_x, dy = (double)down[i] - (double)at_y, r = (double)reach;
    return log((double)weight[i]) - (dx * dx + dy * dy) / (2 * r * r);
}

static void test_winner_is_the_likeliest_under_the_prior(void) {
    static const float reaches[] = {0.5f, 3.0f, 20.0f, 100.0f, 1e4f};
    struct noise noise = {11};
    for (size_t r = 0; r < sizeof reaches / sizeof reaches[0]; r++) {
        int others = 0; /* winners that are not the greatest weight */
        for (int trial = 0; trial < 60; trial++) {
            const int count = trial % 3 == 0 ? MOST_PARTICLES : 40;
            noise_fill(&noise, across, MOST_PARTICLES, 250.0, 350.0);
            noise_fill(&noise, down, MOST_PARTICLES, 100.0, 180.0);
            noise_fill(&noise, weight, MOST_PARTICLES, 1e-3, 1.0);
            const float at_x = (float)noise_int(&noise, 260, 340), at_y = (float)noise_int(&noise, 90, 190);
            const int found = winner(count, at_x, at_y, reaches[r]);
            int best = 0, greatest = 0;
            for (int i = 1; i < count; i++) {
                if (merit(i, at_x, at_y, reaches[r]) > merit(best, at_x, at_y, reaches[r])) best = i;
                if (weight[i] > weight[greatest]) greatest = i;
            }
            const double least = merit(best, at_x, at_y, reaches[r]);
            TEST_ASSERT_TRUE(found >= 0 && found < count);
            /* Squares of up to 2e4 are good to 2e-3, nothing beside the reach but at the shortest. */
            TEST_ASSERT_TRUE(merit(found, at_x, at_y, reaches[r]) >= least - 1e-5 - 1e-2 / (double)(reaches[r] * reaches[r]));
            others += found != greatest;
        }
        TEST_ASSERT_TRUE(r < 3 ? others > 30 : r < 4 || others == 0);
    }
}

static void test_without_a_reach_the_greatest_weight_wins(void) {
    struct noise noise = {12};
    noise_fill(&noise, across, MOST_PARTICLES, 0.0, 500.0);
    noise_fill(&noise, down, MOST_PARTICLES, 0.0, 500.0);
    for (int trial = 0; trial < 50; trial++) {
        for (int i = 0; i < MOST_PARTICLES; i++) weight[i] = (float)noise_int(&noise, 0, 20) / 20.0f; /* many are equal */
        int best = 0;
        for (int i = 1; i < 300; i++)
            if (weight[i] > weight[best]) best = i;
        weight[300] = 2.0f; /* beyond those that count */
        TEST_ASSERT_EQUAL_INT(best, winner(300, across[best] + 400.0f, down[best], 0.0f));
    }
}

/* The same weight at the same distance on all sides. */
static void test_lowest_index_wins_a_tie_under_the_prior(void) {
    static const float sides[][2] = {{9, 0}, {0, -4}, {4, 0}, {0, 4}, {-4, 0}};
    for (int i = 0; i < 5; i++) {
        across[i] = 50.0f + sides[i][0];
        down[i] = 60.0f + sides[i][1];
        weight[i] = 0.2f;
    }
    TEST_ASSERT_EQUAL_INT(1, winner(5, 50.0f, 60.0f, 2.0f));
}

/* A cloud so far from where the winner is expected that the prior itself is nothing in a float still has its likeliest. */
static void test_a_cloud_far_from_what_is_expected(void) {
    static const float places[] = {3001.0f, 3000.0f, 3000.5f}, weights[] = {0.1f, 0.4f, 0.6f};
    for (int i = 0; i < 3; i++) {
        across[i] = places[i];
        down[i] = 0.0f;
        weight[i] = weights[i];
    }
    TEST_ASSERT_EQUAL_INT(2, winner(3, 0.0f, 0.0f, 100.0f)); /* .6 e^-.15 */
    TEST_ASSERT_EQUAL_INT(1, winner(3, 0.0f, 0.0f, 30.0f));  /* .6 e^-1.7 */
    TEST_ASSERT_EQUAL_INT(1, winner(3, 0.0f, 0.0f, 1e-3f));
    TEST_ASSERT_EQUAL_INT(1, winner(3, 0.0f, 0.0f, 1e-30f)); /* whose square is nothing in a float */
    for (int i = 0; i < 3; i++) across[i] = 65536.0f - (float)i;
    TEST_ASSERT_EQUAL_INT(2, winner(3, 0.0f, 65536.0f, 1.0f));
}

static void test_what_weighs_nothing_never_wins(void) {
    struct noise noise = {13};
    for (int trial = 0; trial < 200; trial++) {
        noise_fill(&noise, across, 30, 0.0, 4000.0);
        noise_fill(&noise, down, 30, 0.0, 3000.0);
        const float reach = (float)exp(12 * noise_uniform(&noise) - 5);
        const int alone = noise_int(&noise, 1, 29), at = noise_int(&noise, 0, 29);
        for (int i = 0; i < 30; i++) weight[i] = 0.0f;
        weight[alone] = 1e-37f;
        TEST_ASSERT_EQUAL_INT(alone, winner(30, across[at], down[at], reach));
        weight[0] = 1.0f;
        const int found = winner(30, across[at], down[at], reach);
        TEST_ASSERT_TRUE(found == 0 || found == alone);
    }
    for (int i = 0; i < 30; i++) weight[i] = 0.0f;
    TEST_ASSERT_EQUAL_INT(0, winner(30, across[5], down[5], 10.0f));
}

/* ---- Whose doing it was ---- */

static void test_attribution_is_each_models_part_of_the_weight(void) {
    static const float sigmas[] = {0.05f, 0.5f, 20.0f};
    struct noise noise = {14};
    for (int way = 0; way < 12; way++) {
        const int count = 120, models = way % 2 ? 18 : 3;
        ast_config cfg = configured(way / 2 % 2 ? AST_LIKELIHOOD_SCALED : AST_LIKELIHOOD_FIXED, sigmas[way / 4]);
        cfg.vote = way % 3 == 0 ? AST_VOTE_CONTRAST : AST_VOTE_EQUAL;
        noise_fill(&noise, distance, (size_t)(count * models), 0.0, 2.0);
        ast_weigh(distance, count, models, &cfg, weight, voice);
        for (int i = 0; i < count; i++) {
            float say[MOST_MODELS];
            double part[MOST_MODELS], total = 0, sum = 0, least_power = 0;
            for (int j = 0; j < models; j++) {
                double least = INFINITY, mean = 0, all = 0, sigma = (double)cfg.sigma;
                for (int k = 0; k < count; k++) least = fmin(least, (double)distance[k * models + j]);
                for (int k = 0; k < count; k++) mean += ((double)distance[k * models + j] - least) / count;
                if (cfg.likelihood == AST_LIKELIHOOD_SCALED) sigma *= mean;
                for (int k = 0; k < count; k++) all += exp((least - (double)distance[k * models + j]) / sigma);
                const double power = (least - (double)distance[i * models + j]) / sigma;
                part[j] = (cfg.vote == AST_VOTE_CONTRAST ? mean : 1) * exp(power) / all;
                least_power = fmin(least_power, power);
                total += part[j];
            }
            for (int j = 0; j < models; j++) say[j] = NAN;
            ast_attribute(distance + i * models, voice, models, say);
            for (int j = 0; j < models; j++) {
                TEST_ASSERT_DOUBLE_WITHIN(1e-6 + real_power_slack(count, least_power), part[j] / total, (double)say[j]);
                sum += (double)say[j];
            }
            TEST_ASSERT_DOUBLE_WITHIN(1e-6 * models, 1.0, sum);
        }
    }
}

static void test_a_model_that_speaks_alone_has_all_of_the_say(void) {
    ast_config cfg = configured(AST_LIKELIHOOD_SCALED, 0.1f);
    float say[3] = {NAN, NAN, NAN};
    cfg.vote = AST_VOTE_CONTRAST;
    for (int i = 0; i < 10; i++) {
        distance[3 * i] = distance[3 * i + 2] = 5.0f; /* to these all particles are alike */
        distance[3 * i + 1] = (float)i;
    }
    ast_weigh(distance, 10, 3, &cfg, weight, voice);
    ast_attribute(distance, voice, 3, say);
    TEST_ASSERT_TRUE(say[0] == 0.0f && say[1] == 1.0f && say[2] == 0.0f);
    ast_weigh(distance, 10, 1, &cfg, weight, voice);
    ast_attribute(distance, voice, 1, say);
    TEST_ASSERT_TRUE(say[0] == 1.0f);
    /* One for which no model speaks. */
    cfg = configured(AST_LIKELIHOOD_FIXED, 1e-6f);
    for (int i = 0; i < 20; i++) distance[i] = (float)(i / 2);
    ast_weigh(distance, 10, 2, &cfg, weight, voice);
    ast_attribute(distance + 2 * 9, voice, 2, say);
    TEST_ASSERT_TRUE(say[0] == 0.0f && say[1] == 0.0f);
    ast_attribute(distance, voice, 2, say);
    TEST_ASSERT_TRUE(say[0] == 0.5f && say[1] == 0.5f);
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
    RUN_TEST(test_winner_is_the_likeliest_under_the_prior);
    RUN_TEST(test_without_a_reach_the_greatest_weight_wins);
    RUN_TEST(test_lowest_index_wins_a_tie_under_the_prior);
    RUN_TEST(test_a_cloud_far_from_what_is_expected);
    RUN_TEST(test_what_weighs_nothing_never_wins);
    RUN_TEST(test_attribution_is_each_models_part_of_the_weight);
    RUN_TEST(test_a_model_that_speaks_alone_has_all_of_the_say);
    return UNITY_END();
}
