/* The score of a winner, and the status with hysteresis. */
#include "confidence.h"

#include <math.h>
#include <string.h>

#include "support_noise.h"
#include "unity.h"

enum { DIM = 100, STRIDE = 112, MODELS = 3 };

static unsigned char block[16384];
static struct ast_bag bag;
static float patch[DIM], anchor[DIM], other[DIM];

void setUp(void) {
    struct noise noise = {1};
    struct ast_arena arena = {ast_align(block), 0};
    memset(block, 0xff, sizeof block); /* NaN: what is not in use must not be read */
    ast_bag_layout(&bag, DIM, STRIDE, 0, 1, MODELS, AST_NO, &arena);
    TEST_ASSERT_TRUE(arena.used + AST_ALIGNMENT <= sizeof block);
    noise_fill(&noise, patch, DIM, 0.0, 1.0);
    noise_fill(&noise, anchor, DIM, 0.0, 1.0);
    noise_fill(&noise, other, DIM, 0.0, 1.0);
}
void tearDown(void) {
}

/* Pearson's coefficient from centred vectors. */
static double correlation(const float *x, const float *y) {
    double mean_x = 0, mean_y = 0, xx = 0, yy = 0, xy = 0;
    for (int d = 0; d < DIM; d++) {
        mean_x += (double)x[d] / DIM;
        mean_y += (double)y[d] / DIM;
    }
    for (int d = 0; d < DIM; d++) {
        const double a = (double)x[d] - mean_x, b = (double)y[d] - mean_y;
        xx += a * a;
        yy += b * b;
        xy += a * b;
    }
    return xy / sqrt(xx * yy);
}

static void add_model(const float *mean) {
    float basis[STRIDE] = {0};
    ast_bag_add(&bag, mean, basis, 0);
}

/* The patch turned away from `mean` so that their correlation is about c. */
static void mix(float *out, const float *mean, const float *away, float c) {
    const float s = sqrtf(1.0f - c * c);
    for (int d = 0; d < DIM; d++) out[d] = c * mean[d] + s * away[d];
}

static void test_same_patch_scores_one(void) {
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, 1.0f, ast_confidence_score(anchor, anchor, &bag));
    add_model(anchor);
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, 1.0f, ast_confidence_score(anchor, anchor, &bag));
    add_model(other);
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, 1.0f, ast_confidence_score(anchor, anchor, &bag));
}

static void test_empty_bag_leaves_the_anchor(void) {
    mix(patch, anchor, other, 0.8f);
    TEST_ASSERT_FLOAT_WITHIN(1e-5f, (float)correlation(patch, anchor), ast_confidence_score(patch, anchor, &bag));
}

static void test_mean_of_the_anchor_and_the_likest_model(void) {
    float far_off[DIM];
    struct noise noise = {7};
    noise_fill(&noise, far_off, DIM, 0.0, 1.0);
    mix(patch, anchor, other, 0.6f);
    add_model(far_off);
    add_model(other);
    add_model(anchor);
    const double a = correlation(patch, anchor), o = correlation(patch, other), f = correlation(patch, far_off);
    TEST_ASSERT_TRUE(o > a + 0.05 && a > f + 0.05);
    TEST_ASSERT_FLOAT_WITHIN(1e-5f, (float)(0.5 * (a + o)), ast_confidence_score(patch, anchor, &bag));
}

/* A bag that knows nothing like the patch does not take from what the anchor gives. */
static void test_unlike_models_do_not_lower_the_score(void) {
    float negative[DIM];
    for (int d = 0; d < DIM; d++) negative[d] = -anchor[d];
    add_model(negative);
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, 1.0f, ast_confidence_score(anchor, anchor, &bag));
}

static void test_light_does_not_count(void) {
    add_model(other);
    const float before = ast_confidence_score(patch, anchor, &bag);
    for (int d = 0; d < DIM; d++) patch[d] = 3.0f * patch[d] + 0.5f;
    TEST_ASSERT_FLOAT_WITHIN(1e-5f, before, ast_confidence_score(patch, anchor, &bag));
}

static void test_score_is_clipped(void) {
    for (int d = 0; d < DIM; d++) patch[d] = -anchor[d];
    TEST_ASSERT_TRUE(ast_confidence_score(patch, anchor, &bag) == 0.0f);
    add_model(anchor);
    TEST_ASSERT_TRUE(ast_confidence_score(patch, anchor, &bag) == 0.0f);
    for (int trial = 0; trial < 50; trial++) {
        for (int d = 0; d < DIM; d++) patch[d] = (float)trial * 0.01f * anchor[d] + 5.0f;
        const float score = ast_confidence_score(patch, anchor, &bag);
        TEST_ASSERT_TRUE(score >= 0.0f && score <= 1.0f);
    }
}

/* A flat patch or a flat anchor is like nothing: 0, not 0 / 0. */
static void test_flat_patches_score_zero(void) {
    static const float levels[] = {0.0f, 0.3f, 1.0f, 1e-20f};
    float flat[DIM];
    add_model(other);
    for (size_t l = 0; l < sizeof levels / sizeof levels[0]; l++) {
        for (int d = 0; d < DIM; d++) flat[d] = levels[l];
        TEST_ASSERT_TRUE(ast_confidence_score(flat, anchor, &bag) == 0.0f);
        TEST_ASSERT_TRUE(ast_confidence_score(flat, flat, &bag) == 0.0f);
        const float half = ast_confidence_score(patch, flat, &bag);
        TEST_ASSERT_FLOAT_WITHIN(1e-5f, (float)fmax(0, 0.5 * correlation(patch, other)), half);
    }
}

/* ---- Status ---- */

static ast_config thresholds(float uncertain, float lost, int32_t lost_after) {
    ast_config cfg;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&cfg, AST_PRESET_PAPER));
    cfg.score_uncertain = uncertain;
    cfg.score_lost = lost;
    cfg.lost_after = lost_after;
    return cfg;
}

static void assert_statuses(const ast_config *cfg, const float *scores, const char *expected) {
    struct ast_confidence state = {AST_TRACKING, 0};
    for (int i = 0; expected[i] != '\0'; i++) {
        state = ast_confidence_next(state, cfg, scores[i]);
        TEST_ASSERT_EQUAL_INT(expected[i], "TUL"[state.status]);
        TEST_ASSERT_TRUE(state.low >= 0 && state.low <= cfg->lost_after);
    }
}

static void test_status_has_hysteresis(void) {
    const ast_config cfg = thresholds(0.5f, 0.3f, 3);
    /* doubtful frames alone never make it lost; three low ones in a row do; lost ends at score_uncertain only */
    static const float scores[] = {0.9f, 0.4f, 0.4f, 0.4f, 0.4f, 0.2f,  0.2f, 0.4f, 0.2f, 0.2f, 0.6f, 0.2f,
                                   0.2f, 0.2f, 0.2f, 0.4f, 0.2f, 0.49f, 0.5f, 0.4f, 0.2f, 0.2f, 0.1f, 0.9f};
    assert_statuses(&cfg, scores, "TUUUUUUUUUTUULLLLLTUUULT");
}

static void test_thresholds_are_exclusive(void) {
    const ast_config cfg = thresholds(0.5f, 0.3f, 1);
    static const float scores[] = {0.5f, 0.49999f, 0.3f, 0.3f, 0.29999f};
    assert_statuses(&cfg, scores, "TUUUL");
}

static void test_lost_after_one_and_after_many(void) {
    static const float low[] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    ast_config cfg = thresholds(0.5f, 0.3f, 1);
    assert_statuses(&cfg, low, "LLL");
    cfg = thresholds(0.5f, 0.3f, 10);
    assert_statuses(&cfg, low, "UUUUUUUUUL");
}

static void test_zero_thresholds_turn_it_off(void) {
    static const float low[] = {0, 0, 0, 0};
    ast_config cfg = thresholds(0.0f, 0.0f, 1);
    assert_statuses(&cfg, low, "TTTT");
    cfg = thresholds(0.5f, 0.0f, 1);
    assert_statuses(&cfg, low, "UUUU");
}

/* Each piece of evidence has a direction of its own, whatever the others say. */
static void test_probability_follows_the_evidence(void) {
    static const float better[][3] = {{0.1f, 0, 0}, {0, -0.04f, 0}, {0, 0, 0.1f}};
    for (int a = 0; a < 27; a++) {
        const struct ast_evidence seen = {-0.2f + 0.5f * (float)(a % 3), 0.05f + 0.4f * (float)(a / 3 % 3),
                                          0.7f + 0.1f * (float)(a / 9)};
        const float p = ast_confidence_probability(&seen);
        TEST_ASSERT_TRUE(p > 0.0f && p < 1.0f);
        for (int b = 0; b < 3; b++) {
            const struct ast_evidence more = {seen.start + better[b][0], seen.spread + better[b][1], seen.inside + better[b][2]};
            TEST_ASSERT_TRUE(ast_confidence_probability(&more) > p);
        }
    }
}

/* The ends of the evidence give no infinity and no NaN. */
static void test_probability_is_finite_at_the_ends(void) {
    static const struct ast_evidence ends[] = {{1, 0, 1}, {-1, 1e6f, 0}, {-1, 0, 0}, {1, 1e6f, 1}};
    for (int e = 0; e < 4; e++) {
        const float p = ast_confidence_probability(&ends[e]);
        TEST_ASSERT_TRUE(p >= 0.0f && p <= 1.0f);
    }
    TEST_ASSERT_TRUE(ast_confidence_probability(&ends[0]) > 0.99f);
    TEST_ASSERT_TRUE(ast_confidence_probability(&ends[1]) < 0.01f);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_same_patch_scores_one);
    RUN_TEST(test_empty_bag_leaves_the_anchor);
    RUN_TEST(test_mean_of_the_anchor_and_the_likest_model);
    RUN_TEST(test_unlike_models_do_not_lower_the_score);
    RUN_TEST(test_light_does_not_count);
    RUN_TEST(test_score_is_clipped);
    RUN_TEST(test_flat_patches_score_zero);
    RUN_TEST(test_status_has_hysteresis);
    RUN_TEST(test_thresholds_are_exclusive);
    RUN_TEST(test_lost_after_one_and_after_many);
    RUN_TEST(test_zero_thresholds_turn_it_off);
    RUN_TEST(test_probability_follows_the_evidence);
    RUN_TEST(test_probability_is_finite_at_the_ends);
    return UNITY_END();
}
