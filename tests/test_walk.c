/* The quasi-random walk as a whole: each particle by itself is Gaussian, all together lie more evenly than chance would have
 * them. */
#include "particles.h"

#include <math.h>

#include "support_noise.h"
#include "support_statistics.h"
#include "unity.h"

enum { MOST = 1000 };

static const ast_frame frame = {NULL, 4000, 3000, 4000};
static const struct ast_state middle = {2000, 1500, 1.5f};
static float memory[4][MOST];
static double steps[MOST][3]; /* of each particle, in x, y and scale, in standard deviations */
static double turn[MOST][3];  /* their places in the distribution, 0 .. 1 */

void setUp(void) {
}
void tearDown(void) {
}

static ast_config configured(int draws) {
    ast_config cfg;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&cfg, AST_PRESET_ROBUST));
    cfg.draws = draws;
    cfg.walk_x = 8.0f;
    cfg.walk_y = 5.0f;
    cfg.walk_scale = 0.05f;
    return cfg;
}

static void walk(int draws, int count, struct ast_random *random) {
    const ast_config cfg = configured(draws);
    struct ast_cloud cloud = {memory[0], memory[1], memory[2], memory[3], count};
    ast_cloud_gather(&cloud, &middle);
    ast_cloud_diffuse(&cloud, &cfg, &frame, random);
    for (int i = 0; i < count; i++) {
        steps[i][0] = ((double)cloud.x[i] - 2000) / 8;
        steps[i][1] = ((double)cloud.y[i] - 1500) / 5;
        steps[i][2] = log((double)cloud.scale[i] / 1.5) / 0.05;
        for (int a = 0; a < 3; a++) turn[i][a] = normal_probability(steps[i][a]);
    }
}

/* The start is random, so a single particle has the walk's own distribution, in its axes together: over many frames it fills a grid
 * of 5 x 5 x 5 cells of equal probability as independent draws do. */
static void test_each_particle_is_gaussian(void) {
    enum { FRAMES = 20000, COUNT = 40, CELLS = 5 };
    static const int watched[] = {0, 1, 17, COUNT - 1};
    static double observed[4][CELLS * CELLS * CELLS], expected[CELLS * CELLS * CELLS];
    struct ast_random random;
    ast_random_seed(&random, 3);
    for (int i = 0; i < CELLS * CELLS * CELLS; i++) expected[i] = (double)FRAMES / (CELLS * CELLS * CELLS);
    for (int f = 0; f < FRAMES; f++) {
        walk(AST_DRAWS_QUASI, COUNT, &random);
        for (int w = 0; w < 4; w++) {
            const double *at = turn[watched[w]];
            observed[w][((int)(CELLS * at[0]) * CELLS + (int)(CELLS * at[1])) * CELLS + (int)(CELLS * at[2])]++;
        }
    }
    for (int w = 0; w < 4; w++)
        TEST_ASSERT_TRUE(chi_square(observed[w], expected, CELLS * CELLS * CELLS) < chi_square_limit(CELLS * CELLS * CELLS - 1));
}

/* Root mean square, over many frames of 350 particles, of what the mean and the variance of an axis' steps miss of 0 and 1. */
static void moments(int draws, double *mean, double *variance) {
    enum { FRAMES = 300, COUNT = 350 };
    struct ast_random random;
    ast_random_seed(&random, 4);
    *mean = *variance = 0;
    for (int f = 0; f < FRAMES; f++) {
        walk(draws, COUNT, &random);
        for (int a = 0; a < 3; a++) {
            double sum = 0, square = 0;
            for (int i = 0; i < COUNT; i++) {
                const double z = steps[i][a];
                sum += z / COUNT;
                square += z * z / COUNT;
            }
            *mean += sum * sum / (3 * FRAMES);
            *variance += (square - 1) * (square - 1) / (3 * FRAMES);
        }
    }
    *mean = sqrt(*mean);
    *variance = sqrt(*variance);
}

static void test_a_frames_moments_are_the_walks(void) {
    double mean, variance;
    moments(AST_DRAWS_RANDOM, &mean, &variance);
    TEST_ASSERT_DOUBLE_WITHIN(0.005, sqrt(1.0 / 350), mean);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, sqrt(2.0 / 350), variance);
    moments(AST_DRAWS_QUASI, &mean, &variance);
    TEST_ASSERT_TRUE(mean < 0.4 * sqrt(1.0 / 350) && variance < 0.4 * sqrt(2.0 / 350));
}

/* Mean square, over random boxes from a corner, of the difference between the share of particles inside and the box's volume. */
static double discrepancy(int draws, int count, struct ast_random *random, struct noise *noise) {
    enum { BOXES = 400 };
    double sum = 0;
    walk(draws, count, random);
    for (int b = 0; b < BOXES; b++) {
        const double u = noise_uniform(noise), v = noise_uniform(noise), w = noise_uniform(noise);
        int inside = 0;
        for (int i = 0; i < count; i++) inside += turn[i][0] < u && turn[i][1] < v && turn[i][2] < w;
        sum += pow((double)inside / count - u * v * w, 2) / BOXES;
    }
    return sum;
}

/* Low discrepancy in all three axes together: less than half of what independent draws have, and the less the larger the cloud. */
static void test_a_cloud_is_more_even_than_chance(void) {
    static const int counts[] = {100, 350, MOST};
    static const double most[] = {0.5, 0.45, 0.4};
    for (int c = 0; c < 3; c++) {
        struct noise noise = {5};
        struct ast_random random;
        double quasi = 0, chance = 0;
        ast_random_seed(&random, 6);
        for (int f = 0; f < 20; f++) {
            quasi += discrepancy(AST_DRAWS_QUASI, counts[c], &random, &noise);
            chance += discrepancy(AST_DRAWS_RANDOM, counts[c], &random, &noise);
        }
        TEST_ASSERT_TRUE(sqrt(quasi) < most[c] * sqrt(chance));
    }
}

/* Three random numbers start a frame's sequence, however many particles there are. */
static void test_a_walk_takes_three_numbers(void) {
    for (int count = 1; count <= MOST; count += 333) {
        struct ast_random random, counted;
        ast_random_seed(&random, 7);
        counted = random;
        walk(AST_DRAWS_QUASI, count, &random);
        for (int i = 0; i < 3; i++) (void)ast_random_bits(&counted);
        TEST_ASSERT_TRUE(random.state == counted.state);
        walk(AST_DRAWS_RANDOM, count, &random);
        for (int i = 0; i < 3 * count; i++) (void)ast_random_bits(&counted);
        TEST_ASSERT_TRUE(random.state == counted.state);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_each_particle_is_gaussian);
    RUN_TEST(test_a_frames_moments_are_the_walks);
    RUN_TEST(test_a_cloud_is_more_even_than_chance);
    RUN_TEST(test_a_walk_takes_three_numbers);
    return UNITY_END();
}
