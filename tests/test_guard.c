/* What the guard lets the tracker learn from, when it calls the object lost, and where it then searches. */
#include "guard.h"

#include <math.h>
#include <string.h>

#include "support_noise.h"
#include "unity.h"

enum { DIM = 60, STRIDE = 64, MODELS = 2, COUNT = 40 };

static const struct ast_state start = {50.0f, 40.0f, 1.0f}, seen = {60.0f, 44.0f, 1.1f};
static unsigned char block[8192];
static struct ast_bag bag;
static struct ast_guard guard;
static ast_config cfg;

static float x[COUNT], y[COUNT], scale[COUNT], weight[COUNT];
static struct ast_cloud cloud = {x, y, scale, weight, COUNT};

void setUp(void) {
    struct ast_arena arena = {ast_align(block), 0};
    memset(block, 0xff, sizeof block); /* NaN: what is not in use must not be read */
    ast_bag_layout(&bag, DIM, STRIDE, 0, 1, MODELS, AST_NO, &arena);
    TEST_ASSERT_TRUE(arena.used + AST_ALIGNMENT <= sizeof block);
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&cfg, AST_PRESET_ROBUST));
    cfg.guard = 0.6f;
    cfg.recall = 0.75f;
    cfg.reacquire = 0.65f;
    cfg.selective = 0.85f;
    cfg.lost_after = 2;
    cfg.walk_x = 8.0f;
    cfg.walk_y = 4.0f;
    ast_guard_clear(&guard, &start);
}
void tearDown(void) {
}

/* One frame. */
static void see_at(float likeness_to_start, float likeness_to_known, float spread, float score) {
    const struct ast_resemblance resemblance = {likeness_to_start, likeness_to_known};
    ast_guard_see(&guard, &cfg, &seen, &resemblance, spread, score);
}

/* One that scores well. */
static void see(float likeness_to_start, float likeness_to_known, float spread) {
    see_at(likeness_to_start, likeness_to_known, spread, 0.9f);
}

static void get_lost(int frames) {
    see(0.8f, 0.9f, 0.02f);
    for (int f = 0; f < frames; f++) see(0.1f, 0.2f, 0.3f);
    TEST_ASSERT_EQUAL_INT(1, guard.lost);
}

/* ---- Likeness ---- */

static void test_likeness_is_the_cosine_about_the_origin(void) {
    struct noise noise = {7};
    float v[DIM], w[DIM], origin[DIM];
    double cross = 0, vv = 0, ww = 0;
    noise_fill(&noise, v, DIM, 0.0, 1.0);
    noise_fill(&noise, w, DIM, 0.0, 1.0);
    noise_fill(&noise, origin, DIM, 0.5, 1.0);
    for (int d = 0; d < DIM; d++) {
        const double a = (double)v[d] - (double)origin[d], b = (double)w[d] - (double)origin[d];
        cross += a * b;
        vv += a * a;
        ww += b * b;
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, cross / sqrt(vv * ww), (double)ast_guard_likeness(v, w, origin, DIM));
    TEST_ASSERT_EQUAL_FLOAT(ast_guard_likeness(v, w, origin, DIM), ast_guard_likeness(w, v, origin, DIM));
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, 1.0f, ast_guard_likeness(v, v, NULL, DIM));
    TEST_ASSERT_EQUAL_FLOAT(0.0f, ast_guard_likeness(origin, w, origin, DIM)); /* it lies at the origin: no direction */
}

static void test_known_is_the_likest_of_start_and_models(void) {
    struct noise noise = {8};
    float v[DIM], anchor[DIM], model[STRIDE] = {0};
    const float basis[STRIDE] = {0};
    noise_fill(&noise, v, DIM, 0.0, 1.0);
    noise_fill(&noise, anchor, DIM, 0.0, 1.0);
    const float alone = ast_guard_likeness(v, anchor, NULL, DIM);
    struct ast_resemblance found = ast_guard_resemblance(v, anchor, &bag, NULL);
    TEST_ASSERT_EQUAL_FLOAT(alone, found.start);
    TEST_ASSERT_EQUAL_FLOAT(alone, found.known);

    for (int d = 0; d < DIM; d++) model[d] = v[d] + 0.5f * anchor[d];
    ast_bag_add(&bag, model, basis, 0);
    found = ast_guard_resemblance(v, anchor, &bag, NULL);
    TEST_ASSERT_EQUAL_FLOAT(alone, found.start);
    TEST_ASSERT_EQUAL_FLOAT(ast_guard_likeness(v, model, NULL, DIM), found.known);
    TEST_ASSERT_TRUE(found.known > found.start);

    for (int d = 0; d < DIM; d++) model[d] = -v[d];
    ast_bag_add(&bag, model, basis, 0); /* an unlike one changes nothing */
    TEST_ASSERT_EQUAL_FLOAT(found.known, ast_guard_resemblance(v, anchor, &bag, NULL).known);
}

/* ---- Trust ---- */

static void test_only_a_frame_unlike_all_that_is_known_is_refused(void) {
    see(0.8f, 0.9f, 0.3f);
    TEST_ASSERT_EQUAL_INT(0, guard.low);
    TEST_ASSERT_EQUAL_FLOAT(0.8f, guard.usual.start);
    TEST_ASSERT_EQUAL_FLOAT(0.9f, guard.usual.known);
    const struct ast_guard met = guard;
    see(0.2f, 0.3f, 0.05f); /* one that has just been met may turn */
    TEST_ASSERT_EQUAL_INT(0, guard.low);
    guard = met;
    for (int f = 1; f < 49; f++) see(0.8f, 0.9f, 0.3f);
    see(0.2f, 0.3f, 0.05f);
    TEST_ASSERT_EQUAL_INT(0, guard.low);
    guard = met;
    for (int f = 1; f < 50; f++) see(0.8f, 0.9f, 0.3f);
    const struct ast_guard before = guard;
    see(0.2f, 0.85f, 0.3f); /* it has turned: a model knows it */
    TEST_ASSERT_EQUAL_INT(0, guard.low);
    guard = before;
    see(0.75f, 0.3f, 0.3f); /* it has come back to its looks at the start */
    TEST_ASSERT_EQUAL_INT(0, guard.low);
    guard = before;
    see(0.2f, 0.4f, 0.05f); /* it changes, and the cloud is sure about it */
    TEST_ASSERT_EQUAL_INT(0, guard.low);
    guard = before;
    see(0.2f, 0.3f, 0.05f); /* nothing of it is left: however sure the cloud is, that is something else */
    TEST_ASSERT_EQUAL_INT(1, guard.low);
    guard = before;
    guard.lasting.start = 0.4f; /* unless its looks have long been other ones than at the start */
    see(0.1f, 0.3f, 0.05f);
    TEST_ASSERT_EQUAL_INT(0, guard.low);
    guard = before;
    see(0.2f, 0.3f, 0.3f);
    TEST_ASSERT_EQUAL_INT(1, guard.low);
    TEST_ASSERT_EQUAL_INT(0, guard.lost);
    /* nothing is learned, not even what is usual */
    TEST_ASSERT_EQUAL_MEMORY(&before.usual, &guard.usual, sizeof before.usual);
    TEST_ASSERT_EQUAL_MEMORY(&before.lasting, &guard.lasting, sizeof before.lasting);
    TEST_ASSERT_EQUAL_INT(before.trusted, guard.trusted);
    TEST_ASSERT_EQUAL_MEMORY(&before.good, &guard.good, sizeof before.good);
    see(0.7f, 0.8f, 0.3f);
    TEST_ASSERT_EQUAL_INT(0, guard.low);
}

static void test_usual_follows_slowly(void) {
    see(0.8f, 0.8f, 0.02f);
    see(0.6f, 0.7f, 0.02f);
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, 0.79f, guard.usual.start); /* a twentieth of the way */
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, 0.795f, guard.usual.known);
    TEST_ASSERT_EQUAL_FLOAT(seen.x, guard.good.x);
}

/* How many frames of a likeness bring the lasting mean from 0.8 half the way to it. */
static int frames_half_way(int frames_before, float likeness) {
    int frames = 0;
    ast_guard_clear(&guard, &start);
    for (int f = 0; f < frames_before; f++) see(0.8f, 0.8f, 0.02f);
    TEST_ASSERT_FLOAT_WITHIN(1e-5f, 0.8f, guard.lasting.start);
    while (fabsf(guard.lasting.start - likeness) > 0.5f * fabsf(0.8f - likeness)) {
        see(likeness, 0.8f, 0.02f);
        frames++;
    }
    TEST_ASSERT_FLOAT_WITHIN(1e-5f, 0.8f, guard.lasting.known); /* each for itself */
    return frames;
}

static void test_the_lasting_mean_falls_slower_than_it_rises(void) {
    TEST_ASSERT_EQUAL_INT(35, frames_half_way(1000, 0.6f)); /* .98^35 = .49 */
    TEST_ASSERT_EQUAL_INT(14, frames_half_way(1000, 0.9f)); /* .95^14 = .49 */
    /* The first frames are always like the start, which says nothing of what will last. */
    TEST_ASSERT_EQUAL_INT(14, frames_half_way(1, 0.6f));
    TEST_ASSERT_EQUAL_INT(14, frames_half_way(40, 0.6f));
    TEST_ASSERT_TRUE(frames_half_way(100, 0.6f) > 20);
}

/* Leaves close over the object within some forty frames, each hardly unlike the last, and the cloud stays sure of what it sees. */
static void test_what_is_covered_little_by_little_is_lost_in_the_end(void) {
    for (int f = 0; f < 300; f++) see(0.8f, 0.9f, 0.03f);
    float covered = 0.0f;
    int frames = 0;
    while (!guard.lost && frames < 80) {
        frames++;
        if (covered < 0.8f) covered += 0.02f;
        see(0.8f * (1.0f - covered), 0.9f * (1.0f - covered), 0.03f);
    }
    TEST_ASSERT_EQUAL_INT(1, guard.lost);
    TEST_ASSERT_FLOAT_WITHIN(0.15f, 0.75f, covered);
    TEST_ASSERT_TRUE(guard.lasting.start > guard.usual.start);
    TEST_ASSERT_TRUE(guard.lasting.start > 0.6f);
}

static void test_only_what_is_like_the_start_takes_a_place(void) {
    const struct ast_resemblance like = {0.69f, 0.2f}, unlike = {0.67f, 0.99f};
    for (int f = 0; f < 5; f++) see(0.8f, 0.9f, 0.02f);
    TEST_ASSERT_TRUE(ast_guard_selects(&guard, &cfg, &like, 0.9f));
    TEST_ASSERT_FALSE(ast_guard_selects(&guard, &cfg, &unlike, 0.9f));
    cfg.selective = 0.0f;
    TEST_ASSERT_TRUE(ast_guard_selects(&guard, &cfg, &unlike, 0.9f));
    TEST_ASSERT_TRUE(ast_guard_selects(&guard, &cfg, &unlike, cfg.score_lost));
    TEST_ASSERT_FALSE(ast_guard_selects(&guard, &cfg, &like, 0.9f * cfg.score_lost)); /* it is hardly the object */
}

static void test_lost_after_refused_frames_until_both_likenesses_return(void) {
    see(0.8f, 0.9f, 0.02f);
    see(0.1f, 0.2f, 0.3f);
    TEST_ASSERT_EQUAL_INT(0, guard.lost);
    see(0.1f, 0.2f, 0.3f);
    TEST_ASSERT_EQUAL_INT(1, guard.lost);
    TEST_ASSERT_EQUAL_INT(AST_LOST, ast_guard_status(&guard, &cfg, 1.0f));
    see(0.8f, 0.3f, 0.02f); /* like the start, but nothing has looked so of late: a look-alike */
    TEST_ASSERT_EQUAL_INT(1, guard.lost);
    see(0.5f, 0.9f, 0.02f); /* known, but unlike the start; spread or not, lost asks for both */
    TEST_ASSERT_EQUAL_INT(1, guard.lost);
    TEST_ASSERT_EQUAL_INT(4, guard.low);
    see(0.55f, 0.7f, 1.0f);
    TEST_ASSERT_EQUAL_INT(0, guard.lost);
    TEST_ASSERT_EQUAL_INT(0, guard.low);
    TEST_ASSERT_EQUAL_INT(AST_TRACKING, ast_guard_status(&guard, &cfg, 1.0f));
}

static void test_count_of_refused_frames_ends(void) {
    get_lost(AST_GUARD_LONG + 5);
    TEST_ASSERT_EQUAL_INT(AST_GUARD_LONG, guard.low);
}

/* ---- The score ---- */

/* Frames of this score, however familiar they look, until the object is lost; most at most. */
static int frames_until_lost(float score, int most) {
    int frames = 0;
    while (!guard.lost && frames < most) {
        see_at(0.8f, 0.9f, 0.02f, score);
        frames++;
    }
    return frames;
}

static void test_a_score_that_stays_next_to_nothing_ends_in_a_loss(void) {
    for (int f = 0; f < 60; f++) see(0.8f, 0.9f, 0.02f);
    const struct ast_guard before = guard;
    TEST_ASSERT_EQUAL_INT(15, frames_until_lost(0.0f, 100)); /* .9 .9^15 = .19 */
    TEST_ASSERT_EQUAL_INT(1, guard.lost);                    /* at once, whatever lost_after says */
    TEST_ASSERT_EQUAL_INT(1, guard.low);
    TEST_ASSERT_EQUAL_INT(AST_LOST, ast_guard_status(&guard, &cfg, 1.0f));
    /* The level counts: with twice as much it never ends. */
    guard = before;
    TEST_ASSERT_TRUE(frames_until_lost(0.18f, 100) < 60);
    TEST_ASSERT_EQUAL_INT(1, guard.lost);
    guard = before;
    TEST_ASSERT_EQUAL_INT(500, frames_until_lost(0.22f, 500));
    TEST_ASSERT_EQUAL_INT(0, guard.lost);
}

static void test_a_few_low_scores_are_no_loss(void) {
    for (int f = 0; f < 300; f++) {
        see_at(0.8f, 0.9f, 0.02f, f % 10 < 5 ? 0.0f : 0.9f);
        TEST_ASSERT_EQUAL_INT(0, guard.lost);
        TEST_ASSERT_EQUAL_INT(0, guard.low);
    }
    ast_guard_clear(&guard, &start);                         /* the first frames have their time, too */
    TEST_ASSERT_EQUAL_INT(16, frames_until_lost(0.0f, 100)); /* .9^16 = .19 */
}

static void test_a_loss_does_not_end_with_a_low_score(void) {
    get_lost(3);
    for (int f = 0; f < 5; f++) {
        see_at(0.8f, 0.9f, 0.02f, 0.99f * cfg.score_lost);
        TEST_ASSERT_EQUAL_INT(1, guard.lost);
    }
    TEST_ASSERT_EQUAL_INT(8, guard.low);
    see_at(0.8f, 0.9f, 0.02f, cfg.score_lost);
    TEST_ASSERT_EQUAL_INT(0, guard.lost);
    TEST_ASSERT_EQUAL_INT(0, guard.low);
}

static void test_means_take_no_frame_with_a_low_score(void) {
    for (int f = 0; f < 5; f++) see(0.8f, 0.9f, 0.02f);
    const struct ast_guard before = guard;
    for (int f = 0; f < 3; f++) see_at(0.7f, 0.8f, 0.02f, 0.99f * cfg.score_lost);
    TEST_ASSERT_EQUAL_INT(0, guard.low); /* trusted nevertheless */
    TEST_ASSERT_EQUAL_MEMORY(&before.usual, &guard.usual, sizeof before.usual);
    TEST_ASSERT_EQUAL_MEMORY(&before.lasting, &guard.lasting, sizeof before.lasting);
    see_at(0.7f, 0.8f, 0.02f, cfg.score_lost);
    TEST_ASSERT_TRUE(guard.usual.start < before.usual.start && guard.usual.known < before.usual.known);
    TEST_ASSERT_TRUE(guard.lasting.start < before.lasting.start && guard.lasting.known < before.lasting.known);
}

/* What its score was while it was lost is forgotten then: another loss takes as long as the first. */
static void test_what_is_found_again_has_its_time(void) {
    for (int f = 0; f < 60; f++) see(0.8f, 0.9f, 0.02f);
    (void)frames_until_lost(0.0f, 100);
    for (int f = 0; f < 50; f++) see_at(0.1f, 0.2f, 0.3f, 0.0f);
    TEST_ASSERT_EQUAL_INT(1, guard.lost);
    see(0.8f, 0.9f, 0.02f);
    TEST_ASSERT_EQUAL_INT(0, guard.lost);
    TEST_ASSERT_EQUAL_INT(16, frames_until_lost(0.0f, 100));
}

/* ---- Search ---- */

static void place_cloud(void) {
    for (int i = 0; i < COUNT; i++) {
        const struct ast_state state = {200.0f + (float)(i % 5), 150.0f - (float)(i % 3), 1.0f};
        ast_cloud_set(&cloud, i, state);
    }
}

/* Largest distances of the followers from (200, 150) and of the searchers from where the object was last trusted. */
static void step_cloud(const ast_frame *frame, float object_size, float *followers, float *searchers) {
    struct ast_random random;
    ast_random_seed(&random, 3);
    place_cloud();
    ast_guard_gather(&guard, &cloud);
    ast_cloud_diffuse(&cloud, &cfg, frame, &random);
    ast_guard_widen(&guard, &cfg, frame, object_size, &cloud);
    *followers = *searchers = 0.0f;
    for (int i = 0; i < COUNT; i++) {
        const int searches = i % 2;
        const float far = searches ? hypotf(x[i] - guard.good.x, y[i] - guard.good.y) : hypotf(x[i] - 200.0f, y[i] - 150.0f);
        float *most = searches ? searchers : followers;
        if (far > *most) *most = far;
        TEST_ASSERT_TRUE(x[i] >= 0.0f && x[i] <= (float)frame->width && y[i] >= 0.0f && y[i] <= (float)frame->height);
    }
}

static void test_search_leaves_a_cloud_alone_until_lost(void) {
    const ast_frame frame = {NULL, 400, 300, 400};
    float before[2 * COUNT], after[2 * COUNT];
    place_cloud();
    memcpy(before, x, sizeof x);
    memcpy(before + COUNT, y, sizeof y);
    see(0.8f, 0.9f, 0.02f);
    ast_guard_gather(&guard, &cloud);
    ast_guard_widen(&guard, &cfg, &frame, 50.0f, &cloud);
    memcpy(after, x, sizeof x);
    memcpy(after + COUNT, y, sizeof y);
    TEST_ASSERT_EQUAL_MEMORY(before, after, sizeof before);
}

static void test_half_of_a_lost_cloud_searches_ever_wider(void) {
    const ast_frame frame = {NULL, 4000, 3000, 4000};
    float followers, searchers, last = 0.0f, first = 0.0f;
    cfg.walk_scale = 0.0f;
    for (int frames = 2; frames < 12; frames++) {
        ast_guard_clear(&guard, &start);
        get_lost(frames);
        step_cloud(&frame, 100.0f, &followers, &searchers);
        TEST_ASSERT_TRUE(followers < 5.0f * 8.0f); /* the configured walk, near the cloud */
        TEST_ASSERT_TRUE(searchers >= last);
        if (frames == 2) first = searchers;
        last = searchers;
    }
    TEST_ASSERT_TRUE(last > 4.0f * first);
    /* It grows up to the object's size and no further. */
    ast_guard_clear(&guard, &start);
    get_lost(500);
    step_cloud(&frame, 20.0f, &followers, &searchers);
    TEST_ASSERT_TRUE(searchers < 5.0f * 1.3f * 20.0f);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_likeness_is_the_cosine_about_the_origin);
    RUN_TEST(test_known_is_the_likest_of_start_and_models);
    RUN_TEST(test_only_a_frame_unlike_all_that_is_known_is_refused);
    RUN_TEST(test_usual_follows_slowly);
    RUN_TEST(test_the_lasting_mean_falls_slower_than_it_rises);
    RUN_TEST(test_what_is_covered_little_by_little_is_lost_in_the_end);
    RUN_TEST(test_only_what_is_like_the_start_takes_a_place);
    RUN_TEST(test_lost_after_refused_frames_until_both_likenesses_return);
    RUN_TEST(test_count_of_refused_frames_ends);
    RUN_TEST(test_a_score_that_stays_next_to_nothing_ends_in_a_loss);
    RUN_TEST(test_a_few_low_scores_are_no_loss);
    RUN_TEST(test_a_loss_does_not_end_with_a_low_score);
    RUN_TEST(test_means_take_no_frame_with_a_low_score);
    RUN_TEST(test_what_is_found_again_has_its_time);
    RUN_TEST(test_search_leaves_a_cloud_alone_until_lost);
    RUN_TEST(test_half_of_a_lost_cloud_searches_ever_wider);
    return UNITY_END();
}
