/* Resampling and the random walk, by their statistics. */
#include "particles.h"

#include <math.h>
#include <string.h>

#include "support_noise.h"
#include "support_statistics.h"
#include "unity.h"

void setUp(void) {
}
void tearDown(void) {
}

enum { MOST = 20000 };

static float storage[2][4][MOST];

static struct ast_cloud cloud_of(int which, int count) {
    const struct ast_cloud cloud = {storage[which][0], storage[which][1], storage[which][2], storage[which][3], count};
    return cloud;
}

/* Particle i carries its index, so that a copy tells where it is from. */
static void number(struct ast_cloud *cloud) {
    for (int i = 0; i < cloud->count; i++) {
        cloud->x[i] = (float)i;
        cloud->y[i] = (float)(2 * i + 1);
        cloud->scale[i] = 1.0f + (float)i / 65536.0f;
    }
}

/* Weights between 0 and 1 with a few zeros among them, their sum 1. */
static void draw_weights(struct ast_cloud *cloud, struct noise *noise) {
    double sum = 0;
    for (int i = 0; i < cloud->count; i++) {
        const double u = noise_uniform(noise);
        cloud->weight[i] = u < 0.2 ? 0.0f : (float)(u * u * u);
        sum += (double)cloud->weight[i];
    }
    for (int i = 0; i < cloud->count; i++) cloud->weight[i] = (float)((double)cloud->weight[i] / sum);
}

/* Resamples and counts the copies of each particle. */
static void count_copies(const struct ast_cloud *from, struct ast_cloud *to, struct ast_random *random, int *copies) {
    memset(copies, 0, (size_t)from->count * sizeof *copies);
    ast_cloud_resample(from, to, random);
    for (int i = 0; i < to->count; i++) {
        const int source = (int)to->x[i];
        TEST_ASSERT_TRUE(source >= 0 && source < from->count);
        TEST_ASSERT_TRUE(to->y[i] == from->y[source] && to->scale[i] == from->scale[source]);
        copies[source]++;
    }
}

static void test_gather(void) {
    struct ast_cloud cloud = cloud_of(0, 7);
    const struct ast_state state = {3.5f, -2.0f, 1.25f};
    ast_cloud_gather(&cloud, &state);
    for (int i = 0; i < cloud.count; i++) {
        TEST_ASSERT_TRUE(cloud.x[i] == 3.5f && cloud.y[i] == -2.0f && cloud.scale[i] == 1.25f);
        TEST_ASSERT_TRUE(cloud.weight[i] == 1.0f / 7.0f);
    }
}

static void test_set_moves_one_particle(void) {
    struct ast_cloud cloud = cloud_of(0, 9);
    const struct ast_state state = {3.5f, -2.0f, 1.25f};
    number(&cloud);
    cloud.weight[4] = 0.25f;
    ast_cloud_set(&cloud, 4, state);
    for (int i = 0; i < 9; i++) {
        TEST_ASSERT_TRUE(cloud.x[i] == (i == 4 ? 3.5f : (float)i));
        TEST_ASSERT_TRUE(cloud.y[i] == (i == 4 ? -2.0f : (float)(2 * i + 1)));
        TEST_ASSERT_TRUE(cloud.scale[i] == (i == 4 ? 1.25f : 1.0f + (float)i / 65536.0f));
    }
    TEST_ASSERT_TRUE(cloud.weight[4] == 0.25f);
}

/* ---- Resampling ---- */

/* What makes it systematic: N w copies, rounded down or up, and none of a particle without weight. */
static void test_copies_are_n_w_rounded_down_or_up(void) {
    enum { COUNT = 60, DRAWS = 500 };
    struct noise noise = {1};
    struct ast_random random;
    int copies[COUNT];
    ast_random_seed(&random, 1);
    for (int draw = 0; draw < DRAWS; draw++) {
        struct ast_cloud from = cloud_of(0, COUNT), to = cloud_of(1, draw % 2 == 0 ? COUNT : 17);
        number(&from);
        draw_weights(&from, &noise);
        count_copies(&from, &to, &random, copies);
        for (int i = 0; i < COUNT; i++) {
            const double expected = to.count * (double)from.weight[i];
            TEST_ASSERT_TRUE(copies[i] >= floor(expected - 1e-5) && copies[i] <= ceil(expected + 1e-5));
            if (from.weight[i] == 0.0f) TEST_ASSERT_EQUAL_INT(0, copies[i]);
        }
    }
}

/* Which way it rounds is a coin whose odds are the fraction. Over the draws the coins of one particle are independent, so each sum
 * of them, standardised, is nearly a standard normal; those of different particles are not independent of each other, hence the
 * wide limit on the mean of their squares. */
static void test_rounding_has_the_odds_of_the_fraction(void) {
    enum { COUNT = 40, DRAWS = 20000 };
    struct noise noise = {2};
    struct ast_cloud from = cloud_of(0, COUNT), to = cloud_of(1, COUNT);
    struct ast_random random;
    double total[COUNT] = {0}, squares = 0;
    int copies[COUNT], coins = 0;
    number(&from);
    draw_weights(&from, &noise);
    ast_random_seed(&random, 2);
    for (int draw = 0; draw < DRAWS; draw++) {
        count_copies(&from, &to, &random, copies);
        for (int i = 0; i < COUNT; i++) total[i] += copies[i];
    }
    for (int i = 0; i < COUNT; i++) {
        const double expected = COUNT * (double)from.weight[i], fraction = expected - floor(expected);
        const double deviation = sqrt(DRAWS * fraction * (1 - fraction));
        if (deviation < 5) continue;
        const double z = (total[i] - DRAWS * expected) / deviation;
        TEST_ASSERT_TRUE(fabs(z) < 5);
        squares += z * z;
        coins++;
    }
    TEST_ASSERT_TRUE(coins > 25);
    TEST_ASSERT_TRUE(squares / coins > 0.3 && squares / coins < 3);
}

/* One particle drawn at a time is an independent choice with probability its weight: a plain chi-square test. */
static void test_single_draws_have_the_weights_as_odds(void) {
    enum { COUNT = 50, DRAWS = 100000 };
    struct noise noise = {3};
    struct ast_cloud from = cloud_of(0, COUNT), to = cloud_of(1, 1);
    struct ast_random random;
    double observed[COUNT] = {0}, expected[COUNT];
    int used = 0;
    number(&from);
    draw_weights(&from, &noise);
    ast_random_seed(&random, 3);
    for (int draw = 0; draw < DRAWS; draw++) {
        ast_cloud_resample(&from, &to, &random);
        observed[(int)to.x[0]]++;
    }
    for (int i = 0; i < COUNT; i++) {
        if (from.weight[i] == 0.0f) {
            TEST_ASSERT_TRUE(observed[i] == 0);
            continue;
        }
        observed[used] = observed[i];
        expected[used++] = DRAWS * (double)from.weight[i];
    }
    TEST_ASSERT_TRUE(used > 30 && used < COUNT);
    TEST_ASSERT_TRUE(chi_square(observed, expected, used) < chi_square_limit(used - 1));
}

static void test_resampling_takes_one_uniform_number(void) {
    struct ast_cloud from = cloud_of(0, 33), to = cloud_of(1, 33);
    struct ast_random random, other;
    const struct ast_state state = {1, 2, 1};
    ast_cloud_gather(&from, &state);
    ast_random_seed(&random, 4);
    other = random;
    ast_cloud_resample(&from, &to, &random);
    (void)ast_random_uniform(&other);
    TEST_ASSERT_EQUAL_HEX64(other.state, random.state);
}

static void test_resampling_ignores_the_weights_total(void) {
    enum { COUNT = 64 };
    struct noise noise = {5};
    struct ast_cloud from = cloud_of(0, COUNT), to = cloud_of(1, COUNT);
    struct ast_random random;
    int copies[COUNT], again[COUNT];
    number(&from);
    draw_weights(&from, &noise);
    ast_random_seed(&random, 5);
    count_copies(&from, &to, &random, copies);
    for (int i = 0; i < COUNT; i++) from.weight[i] *= 8.0f; /* exact */
    ast_random_seed(&random, 5);
    count_copies(&from, &to, &random, again);
    TEST_ASSERT_EQUAL_INT_ARRAY(copies, again, COUNT);
}

static void test_resampling_leaves_weights_alone(void) {
    struct ast_cloud from = cloud_of(0, 3), to = cloud_of(1, 3);
    struct ast_random random;
    number(&from);
    from.weight[0] = 0.0f, from.weight[1] = 1.0f, from.weight[2] = 0.0f;
    to.weight[0] = 0.1f, to.weight[1] = 0.2f, to.weight[2] = 0.7f;
    ast_random_seed(&random, 6);
    ast_cloud_resample(&from, &to, &random);
    TEST_ASSERT_TRUE(from.weight[0] == 0.0f && from.weight[1] == 1.0f && from.weight[2] == 0.0f);
    TEST_ASSERT_TRUE(to.weight[0] == 0.1f && to.weight[1] == 0.2f && to.weight[2] == 0.7f);
    for (int i = 0; i < 3; i++) TEST_ASSERT_TRUE(to.x[i] == 1.0f);
}

/* All the weight on one particle, wherever it is, also when the uniform number is the least or the greatest. */
static void test_one_heavy_particle_takes_all(void) {
    enum { COUNT = 100 };
    static const uint64_t states[] = {0, UINT64_C(0x07fffe00078001e0)};
    struct ast_random least = {states[0]}, greatest = {states[1]};
    TEST_ASSERT_TRUE(ast_random_uniform(&least) == 0x1p-24f && ast_random_uniform(&greatest) == 1.0f - 0x1p-24f);
    for (size_t s = 0; s < sizeof states / sizeof states[0]; s++) {
        for (int heavy = 0; heavy < COUNT; heavy++) {
            struct ast_cloud from = cloud_of(0, COUNT), to = cloud_of(1, COUNT);
            struct ast_random random = {states[s]};
            number(&from);
            for (int i = 0; i < COUNT; i++) from.weight[i] = i == heavy ? 1.0f : 0.0f;
            ast_cloud_resample(&from, &to, &random);
            for (int i = 0; i < COUNT; i++) TEST_ASSERT_TRUE(to.x[i] == (float)heavy);
        }
    }
}

/* ---- The walk ---- */

static const ast_frame frame = {NULL, 4000, 3000, 4000}; /* only its size counts here */

static ast_config walk_config(float x, float y, float scale) {
    ast_config cfg;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&cfg, AST_PRESET_PAPER));
    cfg.walk_x = x;
    cfg.walk_y = y;
    cfg.walk_scale = scale;
    return cfg;
}

/* Standardised values against a standard normal: mean, variance, and 20 bins of equal probability. */
static void assert_normal(const double *z, int count) {
    enum { BINS = 20 };
    double observed[BINS] = {0}, expected[BINS], sum = 0, square = 0;
    for (int i = 0; i < count; i++) {
        sum += z[i];
        square += z[i] * z[i];
        observed[(int)(BINS * normal_probability(z[i]))]++;
    }
    for (int b = 0; b < BINS; b++) expected[b] = (double)count / BINS;
    TEST_ASSERT_DOUBLE_WITHIN(5 / sqrt(count), 0, sum / count);
    TEST_ASSERT_DOUBLE_WITHIN(5 * sqrt(2.0 / count), 1, square / count);
    TEST_ASSERT_TRUE(chi_square(observed, expected, BINS) < chi_square_limit(BINS - 1));
}

static double correlation(const double *a, const double *b, int count) {
    double sum = 0;
    for (int i = 0; i < count; i++) sum += a[i] * b[i];
    return sum / count;
}

static void test_walk_is_gaussian(void) {
    static double z[3][MOST];
    const ast_config cfg = walk_config(8.0f, 5.0f, 0.05f);
    const struct ast_state state = {2000, 1500, 1.5f};
    struct ast_cloud cloud = cloud_of(0, MOST);
    struct ast_random random;
    ast_cloud_gather(&cloud, &state);
    ast_random_seed(&random, 7);
    ast_cloud_diffuse(&cloud, &cfg, &frame, &random);
    for (int i = 0; i < MOST; i++) {
        z[0][i] = ((double)cloud.x[i] - 2000) / 8;
        z[1][i] = ((double)cloud.y[i] - 1500) / 5;
        z[2][i] = log((double)cloud.scale[i] / 1.5) / (double)cfg.walk_scale;
    }
    for (int axis = 0; axis < 3; axis++) assert_normal(z[axis], MOST);
    TEST_ASSERT_DOUBLE_WITHIN(5 / sqrt(MOST), 0, correlation(z[0], z[1], MOST));
    TEST_ASSERT_DOUBLE_WITHIN(5 / sqrt(MOST), 0, correlation(z[0], z[2], MOST));
    TEST_ASSERT_DOUBLE_WITHIN(5 / sqrt(MOST), 0, correlation(z[1], z[2], MOST));
    TEST_ASSERT_DOUBLE_WITHIN(5 / sqrt(MOST), 0, correlation(z[0], z[0] + 1, MOST - 1)); /* of neighbours */
}

/* Quasi-random steps: each axis advances by a fixed part of a turn, 1 / g, 1 / g^2, 1 / g^3 with g^4 = g + 1, from a random
 * start. */
static void test_quasi_random_walk_is_an_additive_sequence(void) {
    enum { COUNT = 2000 };
    ast_config cfg = walk_config(8.0f, 5.0f, 0.05f);
    const struct ast_state state = {2000, 1500, 1.5f};
    struct ast_cloud cloud = cloud_of(0, COUNT);
    struct ast_random random;
    double g = 1.2, first[3] = {0, 0, 0};
    for (int i = 0; i < 60; i++) g = sqrt(sqrt(g + 1));
    cfg.draws = AST_DRAWS_QUASI;
    ast_cloud_gather(&cloud, &state);
    ast_random_seed(&random, 11);
    ast_cloud_diffuse(&cloud, &cfg, &frame, &random);
    for (int i = 0; i < COUNT; i++) {
        const double z[3] = {((double)cloud.x[i] - 2000) / 8, ((double)cloud.y[i] - 1500) / 5,
                             log((double)cloud.scale[i] / 1.5) / (double)cfg.walk_scale};
        for (int a = 0; a < 3; a++) {
            const double turn = normal_probability(z[a]);
            if (i == 0) first[a] = turn;
            const double error = turn - first[a] - i * pow(g, -(a + 1));
            TEST_ASSERT_DOUBLE_WITHIN(1e-4, 0, error - floor(error + 0.5));
        }
    }
}

/* What they are for: every bin of equal probability gets its share almost exactly, where independent draws scatter by the root. */
static void test_quasi_random_walk_covers_evenly(void) {
    enum { COUNT = 350, BINS = 14 };
    ast_config cfg = walk_config(8.0f, 5.0f, 0.05f);
    const struct ast_state state = {2000, 1500, 1.5f};
    struct ast_cloud cloud = cloud_of(0, COUNT);
    struct ast_random random;
    cfg.draws = AST_DRAWS_QUASI;
    ast_random_seed(&random, 12);
    for (int frames = 0; frames < 50; frames++) {
        int bins[3][BINS] = {{0}}, quarters[4][4] = {{0}};
        ast_cloud_gather(&cloud, &state);
        ast_cloud_diffuse(&cloud, &cfg, &frame, &random);
        for (int i = 0; i < COUNT; i++) {
            const double x = normal_probability(((double)cloud.x[i] - 2000) / 8),
                         y = normal_probability(((double)cloud.y[i] - 1500) / 5);
            bins[0][(int)(BINS * x)]++;
            bins[1][(int)(BINS * y)]++;
            bins[2][(int)(BINS * normal_probability(log((double)cloud.scale[i] / 1.5) / (double)cfg.walk_scale))]++;
            quarters[(int)(4 * x)][(int)(4 * y)]++;
        }
        for (int b = 0; b < BINS; b++)
            for (int a = 0; a < 3; a++) TEST_ASSERT_INT_WITHIN(6, COUNT / BINS, bins[a][b]);
        for (int q = 0; q < 16; q++) TEST_ASSERT_INT_WITHIN(6, COUNT / 16, quarters[q / 4][q % 4]);
    }
}

static void test_quasi_random_walk_starts_anew_each_time(void) {
    ast_config cfg = walk_config(8.0f, 5.0f, 0.05f);
    const struct ast_state state = {2000, 1500, 1.5f};
    struct ast_cloud first = cloud_of(0, 40), second = cloud_of(1, 40);
    struct ast_random random, again;
    cfg.draws = AST_DRAWS_QUASI;
    ast_random_seed(&random, 13);
    again = random;
    ast_cloud_gather(&first, &state);
    ast_cloud_gather(&second, &state);
    ast_cloud_diffuse(&first, &cfg, &frame, &random);
    ast_cloud_diffuse(&second, &cfg, &frame, &random);
    for (int i = 0; i < 40; i++) TEST_ASSERT_TRUE(first.x[i] != second.x[i] && first.y[i] != second.y[i]);
    ast_cloud_gather(&second, &state);
    ast_cloud_diffuse(&second, &cfg, &frame, &again);
    TEST_ASSERT_EQUAL_MEMORY(first.x, second.x, 40 * sizeof *first.x);
    TEST_ASSERT_EQUAL_MEMORY(first.scale, second.scale, 40 * sizeof *first.scale);
}

static void test_shift(void) {
    struct ast_cloud cloud = cloud_of(0, 500);
    number(&cloud);
    ast_cloud_shift(&cloud, 2.5f, -0.25f);
    for (int i = 0; i < cloud.count; i++) {
        TEST_ASSERT_TRUE(cloud.x[i] == (float)i + 2.5f && cloud.y[i] == (float)(2 * i + 1) - 0.25f);
        TEST_ASSERT_TRUE(cloud.scale[i] == 1.0f + (float)i / 65536.0f);
    }
}

static void test_walk_moves_from_where_a_particle_is(void) {
    const ast_config cfg = walk_config(0.0f, 0.0f, 0.0f);
    struct ast_cloud cloud = cloud_of(0, 500);
    struct ast_random random;
    number(&cloud);
    ast_random_seed(&random, 8);
    ast_cloud_diffuse(&cloud, &cfg, &frame, &random);
    for (int i = 0; i < cloud.count; i++)
        TEST_ASSERT_TRUE(cloud.x[i] == (float)i && cloud.y[i] == (float)(2 * i + 1) &&
                         cloud.scale[i] == 1.0f + (float)i / 65536.0f);
}

static void test_walk_is_clamped(void) {
    static const ast_frame small = {NULL, 30, 20, 30};
    ast_config cfg = walk_config(100.0f, 100.0f, 1.0f);
    const struct ast_state state = {15, 10, 1.0f};
    struct ast_cloud cloud = cloud_of(0, 2000);
    struct ast_random random;
    int at[6] = {0};
    cfg.scale_min = 0.5f;
    cfg.scale_max = 2.0f;
    ast_cloud_gather(&cloud, &state);
    ast_random_seed(&random, 9);
    ast_cloud_diffuse(&cloud, &cfg, &small, &random);
    for (int i = 0; i < cloud.count; i++) {
        TEST_ASSERT_TRUE(cloud.x[i] >= 0.0f && cloud.x[i] <= 30.0f);
        TEST_ASSERT_TRUE(cloud.y[i] >= 0.0f && cloud.y[i] <= 20.0f);
        TEST_ASSERT_TRUE(cloud.scale[i] >= 0.5f && cloud.scale[i] <= 2.0f);
        at[0] += cloud.x[i] == 0.0f, at[1] += cloud.x[i] == 30.0f;
        at[2] += cloud.y[i] == 0.0f, at[3] += cloud.y[i] == 20.0f;
        at[4] += cloud.scale[i] == 0.5f, at[5] += cloud.scale[i] == 2.0f;
    }
    for (int side = 0; side < 6; side++) TEST_ASSERT_TRUE(at[side] > 300); /* walks this wide end at every limit */
}

/* A cloud outside a frame that has become smaller is brought in. */
static void test_walk_brings_particles_into_the_frame(void) {
    static const ast_frame dot = {NULL, 1, 1, 1};
    const ast_config cfg = walk_config(0.0f, 0.0f, 0.0f);
    struct ast_cloud cloud = cloud_of(0, 50);
    struct ast_random random;
    number(&cloud);
    ast_random_seed(&random, 10);
    ast_cloud_diffuse(&cloud, &cfg, &dot, &random);
    for (int i = 1; i < cloud.count; i++) TEST_ASSERT_TRUE(cloud.x[i] == 1.0f && cloud.y[i] == 1.0f);
}

static void test_nearest_state_within_the_frame(void) {
    static const ast_frame small = {NULL, 30, 20, 30};
    static const float x[][2] = {{-1e6f, 0}, {-0.5f, 0}, {0, 0}, {15, 15}, {30, 30}, {30.5f, 30}, {1e6f, 30}};
    static const float y[][2] = {{-1e6f, 0}, {0, 0}, {7, 7}, {20, 20}, {21, 20}};
    static const float scale[][2] = {{0.01f, 0.5f}, {0.5f, 0.5f}, {1, 1}, {2, 2}, {50, 2}};
    ast_config cfg = walk_config(1.0f, 1.0f, 1.0f);
    cfg.scale_min = 0.5f;
    cfg.scale_max = 2.0f;
    for (size_t a = 0; a < sizeof x / sizeof x[0]; a++) {
        for (size_t b = 0; b < sizeof y / sizeof y[0]; b++) {
            for (size_t c = 0; c < sizeof scale / sizeof scale[0]; c++) {
                const struct ast_state given = {x[a][0], y[b][0], scale[c][0]}, within = ast_state_within(given, &cfg, &small);
                TEST_ASSERT_TRUE(within.x == x[a][1] && within.y == y[b][1] && within.scale == scale[c][1]);
            }
        }
    }
}

/* Root of the weighted variance about the weighted mean, both axes together; far from the origin as near it. */
static void test_spread(void) {
    static const float places[] = {0.0f, 60000.0f};
    for (size_t p = 0; p < sizeof places / sizeof places[0]; p++) {
        struct ast_cloud cloud = cloud_of(0, 4);
        const float at = places[p], x[] = {at - 3, at + 3, at, at}, y[] = {at, at, at - 4, at + 4};
        for (int i = 0; i < 4; i++) cloud.x[i] = x[i], cloud.y[i] = y[i], cloud.weight[i] = 0.25f;
        TEST_ASSERT_FLOAT_WITHIN(1e-3f, sqrtf(12.5f), ast_cloud_spread(&cloud)); /* 9/2 in x, 16/2 in y */
        cloud.weight[0] = cloud.weight[1] = 0.5f, cloud.weight[2] = cloud.weight[3] = 0.0f;
        TEST_ASSERT_FLOAT_WITHIN(1e-3f, 3.0f, ast_cloud_spread(&cloud));
        cloud.weight[0] = 1.0f, cloud.weight[1] = 0.0f;
        TEST_ASSERT_FLOAT_WITHIN(1e-3f, 0.0f, ast_cloud_spread(&cloud));
    }
}

static void test_effective_particles(void) {
    struct ast_cloud cloud = cloud_of(0, 8);
    const struct ast_state state = {0, 0, 1};
    ast_cloud_gather(&cloud, &state);
    TEST_ASSERT_FLOAT_WITHIN(1e-5f, 8.0f, ast_cloud_effective(&cloud));
    for (int i = 0; i < 8; i++) cloud.weight[i] = i == 5 ? 1.0f : 0.0f;
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, 1.0f, ast_cloud_effective(&cloud));
    cloud.weight[0] = cloud.weight[5] = 0.5f;
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, 2.0f, ast_cloud_effective(&cloud));
    cloud.weight[0] = 0.75f, cloud.weight[5] = 0.25f;
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, 1.6f, ast_cloud_effective(&cloud));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_gather);
    RUN_TEST(test_set_moves_one_particle);
    RUN_TEST(test_copies_are_n_w_rounded_down_or_up);
    RUN_TEST(test_rounding_has_the_odds_of_the_fraction);
    RUN_TEST(test_single_draws_have_the_weights_as_odds);
    RUN_TEST(test_resampling_takes_one_uniform_number);
    RUN_TEST(test_resampling_ignores_the_weights_total);
    RUN_TEST(test_resampling_leaves_weights_alone);
    RUN_TEST(test_one_heavy_particle_takes_all);
    RUN_TEST(test_walk_is_gaussian);
    RUN_TEST(test_quasi_random_walk_is_an_additive_sequence);
    RUN_TEST(test_quasi_random_walk_covers_evenly);
    RUN_TEST(test_quasi_random_walk_starts_anew_each_time);
    RUN_TEST(test_shift);
    RUN_TEST(test_walk_moves_from_where_a_particle_is);
    RUN_TEST(test_walk_is_clamped);
    RUN_TEST(test_walk_brings_particles_into_the_frame);
    RUN_TEST(test_nearest_state_within_the_frame);
    RUN_TEST(test_spread);
    RUN_TEST(test_effective_particles);
    return UNITY_END();
}
