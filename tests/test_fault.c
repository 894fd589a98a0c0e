/* A backend that fails at its k-th call, for every k there is: the call returns the error, the tracker is what it was, byte for
 * byte, and what follows is what would have followed. */
#include <stdio.h>
#include <string.h>

#include "support_faulty.h"
#include "support_render.h"
#include "support_tracker.h"
#include "unity.h"

enum { WIDTH = 80, HEIGHT = 60 };

static struct render scene;

void setUp(void) {
    render_open(&scene, WIDTH, HEIGHT, 5);
}
void tearDown(void) {
    render_close(&scene);
}

static ast_box truth(int frame) {
    return render_path(&scene, frame, 18, 14, 0.2, 1.0);
}

/* From as many boxes as the history holds, so that there is a model at once. larger: pixels by which the object is taller. */
static int start(ast_tracker *t, int history, float larger) {
    const ast_box box = truth(0);
    const ast_frame frame = render_frame(&scene, &box);
    ast_frame frames[AST_MAX_HISTORY];
    ast_box boxes[AST_MAX_HISTORY];
    for (int j = 0; j < history; j++) {
        frames[j] = frame;
        boxes[j] = box;
        boxes[j].x += 0.5f * (float)(history - 1 - j);
        boxes[j].h += larger;
    }
    return ast_start_sequence(t, frames, boxes, history);
}

/* One step at a time; what has been seen of it. */
struct trial {
    const ast_config *cfg;
    const struct ast_linalg *la;
    ast_tracker *subject, *control; /* the one that fails, and one that never does */
    int failed_starts, failed_steps;
};

/* A start that fails at each of its calls leaves a fresh tracker fresh. */
static void fail_first_start(struct trial *trial) {
    faulty_arm(trial->la, 0);
    TEST_ASSERT_EQUAL_INT(AST_OK, start(trial->control, trial->cfg->history, 0.0f));
    for (int code = AST_E_BACKEND, k = 1; code != AST_OK; k++) {
        faulty_arm(trial->la, k);
        code = start(trial->subject, trial->cfg->history, 0.0f);
        TEST_ASSERT_EQUAL_INT(faulty_calls() == k ? AST_E_BACKEND : AST_OK, code);
        TEST_ASSERT_EQUAL_INT(code == AST_OK ? 1 : AST_E_NOT_STARTED, ast_bag_count(trial->subject));
        trial->failed_starts += code != AST_OK;
    }
}

static void fail_step(struct trial *trial, const ast_frame *frame) {
    struct saved before = saved_from(trial->subject);
    ast_result result, mark, expected;
    ast_particles particles;
    memset(&mark, 0x5a, sizeof mark);
    result = mark;
    for (int code = AST_E_BACKEND, k = 1; code != AST_OK; k++) {
        faulty_arm(trial->la, k);
        code = ast_step(trial->subject, frame, &result);
        TEST_ASSERT_EQUAL_INT(faulty_calls() == k ? AST_E_BACKEND : AST_OK, code);
        if (code == AST_OK) continue;
        TEST_ASSERT_EQUAL_MEMORY(&mark, &result, sizeof mark);
        saved_check(&before, trial->subject, "a step that failed");
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(trial->subject, &particles));
        TEST_ASSERT_NULL(particles.distance); /* the one thing that is gone */
        trial->failed_steps++;
    }
    faulty_arm(trial->la, 0);
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(trial->control, frame, &expected));
    TEST_ASSERT_EQUAL_MEMORY(&expected, &result, sizeof result);
    saved_free(&before);
}

/* A start that fails in the middle of tracking leaves the tracking. */
static void fail_restart(struct trial *trial) {
    struct saved expected = saved_from(trial->control);
    saved_check(&expected, trial->subject, "after the failures");
    for (int code = AST_E_BACKEND, k = 1; code != AST_OK; k++) {
        faulty_arm(trial->la, k);
        code = start(trial->subject, trial->cfg->history, 5.0f);
        TEST_ASSERT_EQUAL_INT(faulty_calls() == k ? AST_E_BACKEND : AST_OK, code);
        if (code == AST_OK) continue;
        saved_check(&expected, trial->subject, "a start that failed");
        trial->failed_starts++;
    }
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_restore(trial->subject, expected.bytes, expected.size)); /* the last one did not fail */
    saved_free(&expected);
}

static void fail_everywhere(const char *what, const ast_config *cfg, const struct ast_linalg *la, int frames) {
    char figures[128];
    faulty_arm(la, 0);
    struct trial trial = {cfg, la, tracker_new(cfg, &faulty_linalg), tracker_new(cfg, &faulty_linalg), 0, 0};
    fail_first_start(&trial);
    for (int f = 1; f <= frames; f++) {
        const ast_box box = truth(f);
        const ast_frame frame = render_frame(&scene, &box);
        fail_step(&trial, &frame);
        fail_restart(&trial);
    }
    snprintf(figures, sizeof figures, "%s, %s: failed in %d starts and %d steps", what, la->name, trial.failed_starts,
             trial.failed_steps);
    puts(figures);
    TEST_ASSERT_TRUE_MESSAGE(trial.failed_starts > frames && trial.failed_steps > frames, figures);
    ast_free(trial.subject);
    ast_free(trial.control);
}

/* Rounds of the bag: models are added, then replaced. */
static void test_small_trackers(void) {
    enum { VARIANTS = 8 };
    static const char *const names[VARIANTS] = {"gram",        "literal",   "gram, raw",          "literal, raw",
                                                "linear, raw", "all parts", "all parts, centred", "gradients alone"};
    for (int b = 0; b < BACKENDS; b++) {
        for (int v = 0; v < VARIANTS; v++) {
            ast_config cfg = v < 5 ? small_config() : small_robust_config();
            if (v < 5) cfg.scoring = v & 1 ? AST_SCORING_LITERAL : AST_SCORING_GRAM;
            if (v >= 2 && v < 5) cfg.basis = AST_BASIS_RAW;
            if (v == 4) cfg.model = AST_MODEL_LINEAR;
            if (v == 6) cfg.basis = AST_BASIS_CENTRED;
            if (v == 7) cfg.patch_weight = 0.0f;
            fail_everywhere(names[v], &cfg, backends[b], 7);
        }
    }
}

/* At the sizes that are used, each step with a model due. The literal scoring makes calls for each candidate and model: fewer. */
static void test_presets(void) {
    static const char *const names[] = {"preset paper", "preset robust", "preset compact", "preset tiny", "preset paper, literal"};
    static const int presets[] = {AST_PRESET_PAPER, AST_PRESET_ROBUST, AST_PRESET_COMPACT, AST_PRESET_TINY, AST_PRESET_PAPER};
    for (int b = 0; b < BACKENDS; b++) {
        for (int p = 0; p < 5; p++) {
            ast_config cfg;
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&cfg, presets[p]));
            cfg.bag_interval = 1;
            if (p == 4) {
                cfg.scoring = AST_SCORING_LITERAL;
                cfg.particles = 6;
            }
            fail_everywhere(names[p], &cfg, backends[b], 2);
        }
    }
}

/* ---- The geometry on its own ---- */

int faulty_subspace_fit(const float *images, int32_t dim, int32_t stride, int32_t count, int basis_kind, int32_t n, float *mean,
                        float *basis, ast_subspace *out, void *work, size_t work_size);
int faulty_subspace_distance(const ast_subspace *a, const ast_subspace *b, float alpha, ast_distance *out, void *work,
                             size_t work_size);

static void test_geometry(void) {
    enum { DIM = 20, COUNT = 4, N = 3, WORK = 1 << 16 };
    static float images[DIM * COUNT], mean[DIM], basis[DIM * N];
    static unsigned char work[WORK];
    int failed = 0;
    for (int i = 0; i < DIM * COUNT; i++) images[i] = (float)(i * i % 17) / 17.0f;
    TEST_ASSERT_TRUE(ast_subspace_work_size(DIM, COUNT) <= sizeof work);
    for (int b = 0; b < BACKENDS; b++) {
        ast_subspace fitted, mark;
        ast_distance distance, unset;
        memset(&mark, 0x5a, sizeof mark);
        memset(&unset, 0x5a, sizeof unset);
        for (int code = AST_E_BACKEND, k = 1; code != AST_OK; k++) {
            fitted = mark;
            faulty_arm(backends[b], k);
            code = faulty_subspace_fit(images, DIM, DIM, COUNT, AST_BASIS_CENTRED, N, mean, basis, &fitted, work, sizeof work);
            TEST_ASSERT_EQUAL_INT(faulty_calls() == k ? AST_E_BACKEND : AST_OK, code);
            if (code != AST_OK) TEST_ASSERT_EQUAL_MEMORY(&mark, &fitted, sizeof mark);
            failed += code != AST_OK;
        }
        for (int code = AST_E_BACKEND, k = 1; code != AST_OK; k++) {
            distance = unset;
            faulty_arm(backends[b], k);
            code = faulty_subspace_distance(&fitted, &fitted, 1.0f, &distance, work, sizeof work);
            TEST_ASSERT_EQUAL_INT(faulty_calls() == k ? AST_E_BACKEND : AST_OK, code);
            if (code != AST_OK) TEST_ASSERT_EQUAL_MEMORY(&unset, &distance, sizeof unset);
            failed += code != AST_OK;
        }
    }
    TEST_ASSERT_TRUE(failed >= 4 * BACKENDS);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_small_trackers);
    RUN_TEST(test_presets);
    RUN_TEST(test_geometry);
    return UNITY_END();
}
