/* The shortlist, against a plain sort. */
#include "shortlist.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support_noise.h"
#include "unity.h"

enum { MOST = 700, GUARD = 8 };

static float x[MOST], y[MOST], scale[MOST], promise[MOST], given[MOST];
static float room[MOST + 2 * GUARD]; /* for the heap, and a margin around it */

void setUp(void) {
}
void tearDown(void) {
}

/* Particle i is known again by its place, its scale too. */
static float scale_of(int i) {
    return 0.5f + 0.001f * (float)i;
}

/* Of equal promises the lower index comes first. */
static int before(const void *left, const void *right) {
    const int a = *(const int *)left, b = *(const int *)right;
    if (given[a] != given[b]) return given[a] > given[b] ? -1 : 1;
    return a < b ? -1 : a > b;
}

/* The particles of these promises, with room in the heap for no more than are wanted. */
static void compare(int count, int wanted) {
    struct ast_cloud cloud = {.x = x, .y = y, .scale = scale, .count = count};
    int order[MOST], listed[MOST] = {0}, seen[MOST] = {0};
    for (int i = 0; i < count; i++) {
        x[i] = (float)i;
        y[i] = 1000.0f + (float)i;
        scale[i] = scale_of(i);
        order[i] = i;
    }
    memcpy(promise, given, (size_t)count * sizeof *promise);
    for (int i = 0; i < MOST + 2 * GUARD; i++) room[i] = -7.0f;
    ast_shortlist(&cloud, promise, wanted, room + GUARD);
    qsort(order, (size_t)count, sizeof *order, before);
    for (int i = 0; i < wanted; i++) listed[order[i]] = 1;
    for (int i = 0; i < count; i++) {
        const int was = (int)x[i];
        TEST_ASSERT_TRUE(was >= 0 && was < count);
        TEST_ASSERT_EQUAL_INT_MESSAGE(i < wanted, listed[was], "another particle than the sort finds");
        TEST_ASSERT_FALSE_MESSAGE(seen[was], "a particle is there twice");
        seen[was] = 1;
        TEST_ASSERT_TRUE_MESSAGE(y[i] == 1000.0f + (float)was && scale[i] == scale_of(was) && promise[i] == given[was],
                                 "particles are mixed up");
    }
    for (int i = 0; i < MOST + 2 * GUARD; i++) {
        const int margin = i < GUARD || i >= GUARD + wanted;
        TEST_ASSERT_TRUE_MESSAGE(!margin || room[i] == -7.0f, "beside the heap");
    }
}

static void compare_all(int count) {
    for (int wanted = 1; wanted <= count; wanted++) compare(count, wanted);
}

static void test_random_promises(void) {
    static const int counts[] = {1, 2, 3, 8, 31, 90};
    struct noise noise = {1};
    for (size_t c = 0; c < sizeof counts / sizeof counts[0]; c++) {
        noise_fill(&noise, given, (size_t)counts[c], -2.0, 2.0);
        compare_all(counts[c]);
    }
    for (int trial = 0; trial < 60; trial++) {
        noise_fill(&noise, given, MOST, -1e-3, 1e-3);
        compare(MOST, noise_int(&noise, 1, MOST));
    }
}

/* Few levels, so that the threshold's level has more particles than there is room for. */
static void test_of_equal_promises_the_first_are_taken(void) {
    struct noise noise = {2};
    for (int levels = 1; levels <= 12; levels++) {
        for (int i = 0; i < 60; i++) given[i] = (float)noise_int(&noise, 1, levels) - 3.0f;
        compare_all(60);
    }
}

static void test_promises_in_order(void) {
    for (int i = 0; i < 50; i++) given[i] = (float)i;
    compare_all(50);
    for (int i = 0; i < 50; i++) given[i] = -(float)i;
    compare_all(50);
    for (int i = 0; i < 50; i++) given[i] = i < 25 ? (float)i : (float)(50 - i); /* up and down */
    compare_all(50);
}

static void test_all_promises_alike(void) {
    static const float levels[] = {0.0f, -1e30f, 4.0f, INFINITY, -INFINITY};
    for (size_t l = 0; l < sizeof levels / sizeof levels[0]; l++) {
        for (int i = 0; i < 40; i++) given[i] = levels[l];
        compare_all(40);
    }
}

static void test_promises_without_bound(void) {
    struct noise noise = {3};
    for (int trial = 0; trial < 20; trial++) {
        for (int i = 0; i < 40; i++) {
            const int kind = noise_int(&noise, 0, 3);
            given[i] = kind == 0 ? INFINITY : kind == 1 ? -INFINITY : (float)noise_uniform(&noise);
        }
        compare_all(40);
    }
}

static void test_length_is_the_shortlists_where_there_are_more_particles(void) {
    static const int lengths[][2] = {{0, 40}, {1, 1}, {39, 39}, {40, 40}, {41, 40}, {AST_MAX_PARTICLES, 40}};
    ast_config cfg;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&cfg, AST_PRESET_ROBUST));
    cfg.particles = 40;
    for (size_t l = 0; l < sizeof lengths / sizeof lengths[0]; l++) {
        cfg.shortlist = lengths[l][0];
        TEST_ASSERT_EQUAL_INT(lengths[l][1], ast_shortlist_length(&cfg));
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_random_promises);
    RUN_TEST(test_of_equal_promises_the_first_are_taken);
    RUN_TEST(test_promises_in_order);
    RUN_TEST(test_all_promises_alike);
    RUN_TEST(test_promises_without_bound);
    RUN_TEST(test_length_is_the_shortlists_where_there_are_more_particles);
    return UNITY_END();
}
