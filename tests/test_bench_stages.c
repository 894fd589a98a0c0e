/* The bench's probe: it changes nothing of what a tracker computes, and its stages make up the step. */
#include <string.h>

#include "stages.h"
#include "support_render.h"
#include "support_tracker.h"
#include "unity.h"

void setUp(void) {
}
void tearDown(void) {
}

enum { FRAMES = 14 };

/* A clock that passes a second with every reading: how much lies in a stage is how often it ended, whatever the machine does. */
static double readings;

static double counting_clock(void) {
    return readings++;
}

/* Two trackers on the same frames, one of them probed once both have a bag. */
static void track_both(const ast_config *cfg, const struct ast_linalg *la) {
    struct render render;
    struct probe probe;
    ast_tracker *plain = tracker_new(cfg, la), *probed = tracker_new(cfg, probe_linalg(&probe, la));
    render_open(&render, 160, 120, 3);
    ast_box box = render_path(&render, 0, 32, 24, 0.2, 1.2);
    ast_frame frame = render_frame(&render, &box);
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_start(plain, &frame, &box));
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_start(probed, &frame, &box));
    probe_scoring(&probe, probed);
    TEST_ASSERT_TRUE(probe.cost >= 0);
    probe.clock = counting_clock;
    probe.cost = 0;
    for (int f = 1; f <= FRAMES; f++) {
        ast_result one, other;
        box = render_path(&render, f, 32, 24, 0.2, 1.2);
        frame = render_frame(&render, &box);
        const int models = ast_bag_count(probed);
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(plain, &frame, &one));
        readings = 0;
        TEST_ASSERT_EQUAL_INT(AST_OK, probe_step(&probe, probed, &frame, &other));
        TEST_ASSERT_EQUAL_MEMORY(&one, &other, sizeof one);
        double sum = 0;
        for (int s = 0; s < STAGES; s++) sum += probe.seconds[s];
        TEST_ASSERT_EQUAL_DOUBLE(readings - 1, sum); /* the stages make up the step: from its first reading to its last */
        TEST_ASSERT_EQUAL_DOUBLE(1, probe.seconds[STAGE_DECISION]);
        /* Before there is a model, candidates are not scored: all is the last stage. */
        const double scored = models > 0;
        TEST_ASSERT_EQUAL_DOUBLE(scored, probe.seconds[STAGE_VIEW]);
        TEST_ASSERT_EQUAL_DOUBLE(scored, probe.seconds[STAGE_HISTORY]);
        const double tiles = probe.seconds[STAGE_PATCHES], products = probe.seconds[STAGE_PRODUCT];
        TEST_ASSERT_EQUAL_DOUBLE(scored * ((cfg->particles + AST_TILE - 1) / AST_TILE), tiles);
        TEST_ASSERT_TRUE(cfg->scoring == AST_SCORING_LITERAL ? products >= 0 : products >= tiles);
        TEST_ASSERT_EQUAL_DOUBLE(tiles + products, probe.seconds[STAGE_SMALL]);
    }
    TEST_ASSERT_EQUAL_INT(cfg->bag_size, ast_bag_count(probed));
    struct saved state = saved_from(plain);
    saved_check(&state, probed, "the probed tracker's state");
    saved_free(&state);
    ast_free(plain);
    ast_free(probed);
    render_close(&render);
}

static void test_a_probe_changes_nothing(void) {
    for (int b = 0; b < BACKENDS; b++) {
        for (int which = 0; which < SMALL_CONFIGS; which++) {
            const ast_config cfg = small_config_of(which);
            track_both(&cfg, backends[b]);
        }
    }
}

static void test_every_stage_has_a_name_of_its_own(void) {
    for (int s = 0; s < STAGES; s++) {
        TEST_ASSERT_NOT_NULL(stage_name((enum stage)s));
        for (int other = 0; other < s; other++)
            TEST_ASSERT_TRUE(strcmp(stage_name((enum stage)s), stage_name((enum stage)other)) != 0);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_probe_changes_nothing);
    RUN_TEST(test_every_stage_has_a_name_of_its_own);
    return UNITY_END();
}
