/* The background set: where its boxes lie, and what its mean is. */
#include "background.h"

#include <math.h>
#include <string.h>

#include "support_noise.h"
#include "support_precision.h"
#include "support_statistics.h"
#include "unity.h"

void setUp(void) {
}
void tearDown(void) {
}

/* ---- Boxes ---- */

struct displacement {
    double turn;     /* of the direction, 0 .. 1 */
    double distance; /* in sides of the object */
    double growth;   /* logarithm of the size's ratio */
};

static struct displacement displacement_of(const ast_box *object, const ast_box *box) {
    const double x = ((double)box->x + 0.5 * (double)box->w - (double)object->x - 0.5 * (double)object->w) / (double)object->w;
    const double y = ((double)box->y + 0.5 * (double)box->h - (double)object->y - 0.5 * (double)object->h) / (double)object->h;
    const double turn = atan2(y, x) / 6.283185307179586;
    const struct displacement d = {turn < 0 ? turn + 1 : turn, sqrt(x * x + y * y), log((double)(box->w / object->w))};
    return d;
}

/* Directions are uniform, distances uniform in 0.4 .. 1.5 sides, sizes log-normal with 5 %, and none tells of another. */
static void test_boxes_are_displaced_all_around(void) {
    enum { COUNT = 20000, BINS = 22 };
    static const ast_box objects[] = {{300, 200, 40, 40}, {-20, 950.5f, 31, 90}, {0, 0, 1, 1}};
    for (size_t o = 0; o < sizeof objects / sizeof objects[0]; o++) {
        double observed[3][BINS] = {{0}}, expected[BINS], mixed[3] = {0};
        struct ast_random random;
        ast_random_seed(&random, 3 + o);
        for (int i = 0; i < COUNT; i++) {
            const ast_box box = ast_background_box(&objects[o], &random);
            const struct displacement d = displacement_of(&objects[o], &box);
            TEST_ASSERT_TRUE(d.distance > 0.4 - 1e-3 && d.distance < 1.5 + 1e-3);
            TEST_ASSERT_FLOAT_WITHIN(1e-5f, objects[o].w / objects[o].h, box.w / box.h); /* the same shape */
            const double place = fmin(fmax((d.distance - 0.4) / 1.1, 0), 0.999999), size = normal_probability(d.growth / 0.05);
            observed[0][(int)(BINS * fmin(d.turn, 0.999999))]++;
            observed[1][(int)(BINS * place)]++;
            observed[2][(int)(BINS * size)]++;
            mixed[0] += 12 * (d.turn - 0.5) * (place - 0.5) / COUNT;
            mixed[1] += 12 * (d.turn - 0.5) * (size - 0.5) / COUNT;
            mixed[2] += 12 * (place - 0.5) * (size - 0.5) / COUNT;
        }
        for (int b = 0; b < BINS; b++) expected[b] = (double)COUNT / BINS;
        for (int axis = 0; axis < 3; axis++) {
            TEST_ASSERT_TRUE(chi_square(observed[axis], expected, BINS) < chi_square_limit(BINS - 1));
            TEST_ASSERT_DOUBLE_WITHIN(5 / sqrt(COUNT), 0, mixed[axis]);
        }
    }
}

/* The same numbers give the same box, wherever the object is and whatever its size: three numbers a box. */
static void test_boxes_follow_the_object(void) {
    const ast_box one = {0, 0, 32, 32}, other = {640, 128, 64, 16};
    struct ast_random random, again, counted;
    ast_random_seed(&random, 4);
    again = counted = random;
    for (int i = 0; i < 100; i++) {
        const ast_box a = ast_background_box(&one, &random), b = ast_background_box(&other, &again);
        TEST_ASSERT_FLOAT_WITHIN(1e-3f, a.x / 32, (b.x - 640) / 64);
        TEST_ASSERT_FLOAT_WITHIN(1e-3f, a.y / 32, (b.y - 128) / 16);
        TEST_ASSERT_FLOAT_WITHIN(1e-5f, a.w / 32, b.w / 64);
        TEST_ASSERT_FLOAT_WITHIN(1e-5f, a.h / 32, b.h / 16);
        for (int n = 0; n < 3; n++) (void)ast_random_bits(&counted);
        TEST_ASSERT_TRUE(random.state == counted.state && again.state == counted.state);
    }
}

/* ---- The set and its mean ---- */

enum { DIM = 37, STRIDE = 48, SIZE = 19 };
static const float canary = 77.0f;
static float columns[(SIZE + 1) * STRIDE], before[(SIZE + 1) * STRIDE];

static unsigned char changed[1 + SIZE];
static struct ast_background filled(uint64_t seed) {
    const struct ast_background b = {DIM, STRIDE, SIZE, columns, columns + STRIDE, changed};
    struct noise noise = {seed};
    for (int i = 0; i < (SIZE + 1) * STRIDE; i++) columns[i] = canary;
    for (int z = 0; z < SIZE; z++) noise_fill(&noise, b.set + z * STRIDE, DIM, -1.0, 2.0);
    memcpy(before, columns, sizeof before);
    return b;
}

static void test_average_is_the_sets_mean(void) {
    struct ast_background b = filled(5);
    ast_background_average(&b);
    for (int d = 0; d < DIM; d++) {
        double mean = 0;
        for (int z = 0; z < SIZE; z++) mean += (double)b.set[z * STRIDE + d] / SIZE;
        TEST_ASSERT_DOUBLE_WITHIN(1e-7 + 2.0 * real_sum_slack(SIZE), mean, (double)b.mean[d]); /* sizes below 2 */
    }
    for (int d = DIM; d < STRIDE; d++) TEST_ASSERT_TRUE(b.mean[d] == canary);
    TEST_ASSERT_EQUAL_MEMORY(before + STRIDE, columns + STRIDE, SIZE * STRIDE * sizeof *columns);
}

/* A vector drawn anew takes its slot, no other, and pulls the mean by its share of the way. */
static void test_replacing_moves_the_mean_a_little(void) {
    struct noise noise = {6};
    float vector[DIM];
    for (int slot = 0; slot < SIZE; slot += 9) {
        struct ast_background b = filled(7);
        noise_fill(&noise, vector, DIM, -1.0, 2.0);
        ast_background_average(&b);
        for (int x = 0; x <= SIZE; x++) TEST_ASSERT_EQUAL_INT(1, changed[x]);
        memset(changed, 0, sizeof changed);
        memcpy(before, columns, sizeof before);
        ast_background_replace(&b, slot, vector);
        for (int x = 0; x <= SIZE; x++) TEST_ASSERT_EQUAL_INT(x == 0 || x == 1 + slot, changed[x]);
        for (int d = 0; d < DIM; d++)
            TEST_ASSERT_DOUBLE_WITHIN(1e-7, 0.998 * (double)before[d] + 0.002 * (double)vector[d], (double)b.mean[d]);
        for (int z = 0; z < SIZE; z++)
            TEST_ASSERT_EQUAL_MEMORY(z == slot ? vector : before + (z + 1) * STRIDE, b.set + z * STRIDE, DIM * sizeof *vector);
        for (int column = 0; column <= SIZE; column++)
            for (int d = DIM; d < STRIDE; d++) TEST_ASSERT_TRUE(columns[column * STRIDE + d] == canary);
    }
}

/* The mean runs after the vectors with a memory of 500 of them: after n alike, the past counts 0.998^n. */
static void test_mean_forgets_slowly(void) {
    struct ast_background b = filled(8);
    struct noise noise = {9};
    float vector[DIM];
    noise_fill(&noise, vector, DIM, -1.0, 2.0);
    ast_background_average(&b);
    memcpy(before, columns, sizeof before);
    for (int n = 1; n <= 1500; n++) {
        ast_background_replace(&b, n % SIZE, vector);
        if (n % 500 != 0) continue;
        const double past = pow(0.998, n);
        for (int d = 0; d < DIM; d++)
            TEST_ASSERT_DOUBLE_WITHIN(1e-4, past * (double)before[d] + (1 - past) * (double)vector[d], (double)b.mean[d]);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_boxes_are_displaced_all_around);
    RUN_TEST(test_boxes_follow_the_object);
    RUN_TEST(test_average_is_the_sets_mean);
    RUN_TEST(test_replacing_moves_the_mean_a_little);
    RUN_TEST(test_mean_forgets_slowly);
    return UNITY_END();
}
