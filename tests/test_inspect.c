/* Looking inside a tracker: what is refused, and that what is shown is what tracked. */
#include "asttrack.h"

#include <limits.h>
#include <math.h>
#include <string.h>

#include "support_render.h"
#include "support_tracker.h"
#include "unity.h"

static struct render scene;
static ast_config cfg;
static ast_tracker *t;

void setUp(void) {
    render_open(&scene, 64, 48, 1);
    cfg = small_config();
    t = tracker_new(&cfg, backends[0]);
}
void tearDown(void) {
    ast_free(t);
    render_close(&scene);
}

static void start(void) {
    const ast_box box = render_path(&scene, 0, 16, 12, 0.15, 1.1);
    const ast_frame frame = render_frame(&scene, &box);
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_start(t, &frame, &box));
}

static ast_result walk(int first, int last) {
    ast_result result;
    memset(&result, 0, sizeof result);
    for (int f = first; f <= last; f++) {
        const ast_box box = render_path(&scene, f, 16, 12, 0.15, 1.1);
        const ast_frame frame = render_frame(&scene, &box);
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(t, &frame, &result));
    }
    return result;
}

/* ---- What is refused ---- */

static void test_null_is_refused(void) {
    ast_config config;
    ast_particles particles;
    ast_subspace model;
    const float *patch;
    start();
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, ast_get_config(NULL, &config));
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, ast_get_config(t, NULL));
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, ast_get_particles(NULL, &particles));
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, ast_get_particles(t, NULL));
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, ast_get_model(NULL, 0, &model));
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, ast_get_model(t, 0, NULL));
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, ast_get_history(NULL, 0, &patch));
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, ast_get_history(t, 0, NULL));
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, ast_bag_count(NULL));
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, ast_history_count(NULL));
}

/* Before a start there is only the configuration; an error leaves the result alone. */
static void test_nothing_to_see_before_the_start(void) {
    ast_config config;
    ast_particles particles;
    ast_subspace model;
    const float *patch = (const float *)&cfg, *const mark = patch;
    memset(&particles, 0x5a, sizeof particles);
    memset(&model, 0x5a, sizeof model);
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_config(t, &config));
    TEST_ASSERT_EQUAL_INT(AST_E_NOT_STARTED, ast_get_particles(t, &particles));
    TEST_ASSERT_EQUAL_INT(AST_E_NOT_STARTED, ast_get_model(t, 0, &model));
    TEST_ASSERT_EQUAL_INT(AST_E_NOT_STARTED, ast_get_history(t, 0, &patch));
    TEST_ASSERT_EQUAL_INT(AST_E_NOT_STARTED, ast_bag_count(t));
    TEST_ASSERT_EQUAL_INT(AST_E_NOT_STARTED, ast_history_count(t));
    TEST_ASSERT_EACH_EQUAL_HEX8(0x5a, &particles, sizeof particles);
    TEST_ASSERT_EACH_EQUAL_HEX8(0x5a, &model, sizeof model);
    TEST_ASSERT_TRUE(patch == mark);
}

static void test_indices_are_checked(void) {
    static const int32_t below[] = {-1, -7, INT32_MIN};
    ast_subspace model;
    const float *patch;
    start();
    for (int step = 0; step <= 8; step++) {
        const int32_t models = ast_bag_count(t), patches = ast_history_count(t);
        const int32_t beyond_bag[] = {models, models + 1, cfg.bag_size, INT32_MAX};
        const int32_t beyond_history[] = {patches, patches + 1, cfg.history, INT32_MAX};
        for (int32_t i = 0; i < models; i++) TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_model(t, i, &model));
        for (int32_t i = 0; i < patches; i++) TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_history(t, i, &patch));
        for (size_t i = 0; i < sizeof below / sizeof below[0]; i++) {
            TEST_ASSERT_EQUAL_INT(AST_E_RANGE, ast_get_model(t, below[i], &model));
            TEST_ASSERT_EQUAL_INT(AST_E_RANGE, ast_get_history(t, below[i], &patch));
        }
        for (size_t i = 0; i < 4; i++) {
            TEST_ASSERT_EQUAL_INT(AST_E_RANGE, ast_get_model(t, beyond_bag[i], &model));
            TEST_ASSERT_EQUAL_INT(AST_E_RANGE, ast_get_history(t, beyond_history[i], &patch));
        }
        (void)walk(step + 1, step + 1);
    }
}

/* ---- What is shown ---- */

static void test_config_is_a_copy(void) {
    ast_config config, again;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_config(t, &config));
    TEST_ASSERT_EQUAL_MEMORY(&cfg, &config, sizeof cfg);
    config.particles = 1;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_config(t, &again));
    TEST_ASSERT_EQUAL_MEMORY(&cfg, &again, sizeof cfg);
}

static void test_particles_after_the_start(void) {
    const ast_box box = render_path(&scene, 0, 16, 12, 0.15, 1.1);
    ast_particles p;
    start();
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(t, &p));
    TEST_ASSERT_EQUAL_INT(cfg.particles, p.count);
    TEST_ASSERT_NULL(p.distance);
    TEST_ASSERT_TRUE(p.reference.x == box.x + 0.5f * box.w && p.reference.y == box.y + 0.5f * box.h);
    TEST_ASSERT_TRUE(p.reference.w == box.w && p.reference.h == box.h);
    for (int i = 0; i < p.count; i++) {
        TEST_ASSERT_TRUE(p.x[i] == p.reference.x && p.y[i] == p.reference.y && p.scale[i] == 1.0f);
        TEST_ASSERT_FLOAT_WITHIN(1e-7f, 1.0f / (float)cfg.particles, p.weight[i]);
    }
}

static void test_particles_belong_to_the_result(void) {
    start();
    for (int step = 1; step <= 12; step++) {
        const int32_t models_before = ast_bag_count(t);
        const ast_result r = walk(step, step);
        ast_particles p;
        double sum = 0, squares = 0;
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(t, &p));
        TEST_ASSERT_EQUAL_INT(models_before > 0 ? models_before : 1, p.models);
        TEST_ASSERT_NOT_NULL(p.distance);
        for (int i = 0; i < p.count; i++) {
            TEST_ASSERT_TRUE(p.x[i] >= 0 && p.x[i] <= 64 && p.y[i] >= 0 && p.y[i] <= 48);
            TEST_ASSERT_TRUE(p.weight[i] <= p.weight[r.best]);
            sum += (double)p.weight[i];
            squares += (double)p.weight[i] * (double)p.weight[i];
            for (int j = 0; j < p.models; j++) TEST_ASSERT_TRUE(p.distance[i * p.models + j] >= 0.0f);
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-5, 1.0, sum);
        TEST_ASSERT_DOUBLE_WITHIN(1e-3, 1.0 / squares, (double)r.effective_particles);

        float nearest = p.distance[r.best * p.models];
        for (int j = 1; j < p.models; j++) nearest = fminf(nearest, p.distance[r.best * p.models + j]);
        TEST_ASSERT_TRUE(r.distance == nearest);
        TEST_ASSERT_TRUE(r.scale == p.scale[r.best]);
        TEST_ASSERT_TRUE(p.reference.x == p.x[r.best] && p.reference.y == p.y[r.best]);
        TEST_ASSERT_FLOAT_WITHIN(1e-4f, p.reference.w * r.scale, r.box.w);
        TEST_ASSERT_FLOAT_WITHIN(1e-4f, p.reference.h * r.scale, r.box.h);
        TEST_ASSERT_FLOAT_WITHIN(1e-4f, p.reference.x, r.box.x + 0.5f * r.box.w);
        TEST_ASSERT_FLOAT_WITHIN(1e-4f, p.reference.y, r.box.y + 0.5f * r.box.h);
        TEST_ASSERT_EQUAL_UINT32(step, r.frame);
    }
}

static void test_models_are_orthonormal(void) {
    int seen = 0;
    start();
    for (int step = 1; step <= 12; step++) {
        (void)walk(step, step);
        for (int32_t m = 0; m < ast_bag_count(t); m++) {
            ast_subspace s;
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_model(t, m, &s));
            TEST_ASSERT_EQUAL_INT(64, s.dim);
            TEST_ASSERT_TRUE(s.stride >= s.dim);
            TEST_ASSERT_EQUAL_INT(cfg.basis_size, s.n);
            TEST_ASSERT_TRUE(s.rank > 0 && s.rank <= s.n);
            for (int a = 0; a < s.n; a++) {
                for (int b = 0; b < s.n; b++) {
                    double sum = 0;
                    for (int d = 0; d < s.dim; d++) sum += (double)s.basis[a * s.stride + d] * (double)s.basis[b * s.stride + d];
                    TEST_ASSERT_DOUBLE_WITHIN(1e-5, a == b && a < s.rank ? 1 : 0, sum);
                }
            }
            seen++;
        }
    }
    TEST_ASSERT_TRUE(seen > 20);
}

/* Looking changes nothing. */
static void test_looking_changes_nothing(void) {
    ast_particles p;
    ast_subspace s;
    const float *patch;
    start();
    (void)walk(1, 6);
    struct saved before = saved_from(t);
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(t, &p));
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_model(t, 0, &s));
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_history(t, 0, &patch));
    TEST_ASSERT_TRUE(ast_bag_count(t) > 0 && ast_history_count(t) > 0);
    saved_check(&before, t, "after looking");
    saved_free(&before);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_null_is_refused);
    RUN_TEST(test_nothing_to_see_before_the_start);
    RUN_TEST(test_indices_are_checked);
    RUN_TEST(test_config_is_a_copy);
    RUN_TEST(test_particles_after_the_start);
    RUN_TEST(test_particles_belong_to_the_result);
    RUN_TEST(test_models_are_orthonormal);
    RUN_TEST(test_looking_changes_nothing);
    return UNITY_END();
}
