/* The feature vector: its parts one after the other, each with its weight, each left out when that is zero. */
#include "feature.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support_noise.h"
#include "support_render.h"
#include "unity.h"

enum { WIDTH = 110, HEIGHT = 90, MOST = AST_MAX_PATCH * AST_MAX_PATCH + AST_MAX_CELLS * AST_MAX_CELLS * AST_DIRECTIONS };

static unsigned char *block;
static struct ast_features features;
static struct ast_features_scratch scratch;
static uint8_t pixels[WIDTH * HEIGHT];
static const ast_frame image = {pixels, WIDTH, HEIGHT, WIDTH};
static const ast_box window = {31.25f, 22.5f, 40, 34};
static float vector[MOST + 1];

/* A texture, in levels that gain and offset do not cut. */
static void paint(uint64_t seed, double gain, double offset) {
    struct render scene;
    render_open(&scene, WIDTH, HEIGHT, seed);
    for (int i = 0; i < WIDTH * HEIGHT; i++) pixels[i] = (uint8_t)(gain * floor(20 + 200 * (double)scene.ground[i]) + offset + 0.5);
    render_close(&scene);
}

void setUp(void) {
    block = NULL;
    paint(1, 1.0, 0.0);
}
void tearDown(void) {
    free(block);
}

static ast_config weighted(float patch, float gradient) {
    ast_config cfg;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&cfg, AST_PRESET_ROBUST));
    cfg.patch_weight = patch;
    cfg.gradient_weight = gradient;
    return cfg;
}

/* Bytes that the parts of a configuration take; `features` is bound. */
static size_t lay_out(const ast_config *cfg) {
    struct ast_arena counted = {NULL, 0}, arena = {NULL, 0};
    memset(&features, 0, sizeof features);
    memset(&scratch, 0, sizeof scratch);
    ast_features_layout(&features, cfg, &counted);
    ast_features_scratch_layout(&scratch, cfg, &counted);
    free(block);
    block = malloc(counted.used + AST_ALIGNMENT);
    TEST_ASSERT_NOT_NULL(block);
    memset(block, 0xff, counted.used + AST_ALIGNMENT); /* NaN */
    arena.base = ast_align(block);
    ast_features_layout(&features, cfg, &arena);
    ast_features_scratch_layout(&scratch, cfg, &arena);
    TEST_ASSERT_EQUAL_UINT(counted.used, arena.used);
    return arena.used;
}

/* The window's vector; what lies behind it must stay. */
static int describe(const ast_config *cfg) {
    const int length = ast_features_length(cfg);
    for (int i = 0; i <= MOST; i++) vector[i] = NAN;
    ast_features_prepare(&features, &image, window.w, window.h);
    ast_features_vector(&features, &scratch, &image, &window, vector);
    for (int i = 0; i < length; i++) TEST_ASSERT_FALSE(isnan(vector[i]));
    for (int i = length; i <= MOST; i++) TEST_ASSERT_TRUE(isnan(vector[i]));
    return length;
}

/* ---- Parts ---- */

static void test_length_is_that_of_the_parts(void) {
    static const int sides[] = {4, 16, AST_MAX_PATCH}, counts[] = {2, 12, AST_MAX_CELLS};
    for (int s = 0; s < 3; s++) {
        for (int c = 0; c < 3; c++) {
            ast_config cfg = weighted(1.0f, 1.4f);
            cfg.patch_width = sides[s];
            cfg.patch_height = sides[2 - s];
            cfg.gradient_cells = counts[c];
            const int grey = sides[s] * sides[2 - s], gradients = 8 * counts[c] * counts[c];
            TEST_ASSERT_EQUAL_INT(grey + gradients, ast_features_length(&cfg));
            cfg.gradient_weight = 0.0f;
            TEST_ASSERT_EQUAL_INT(grey, ast_features_length(&cfg));
            cfg.gradient_weight = 1e-3f;
            cfg.patch_weight = 0.0f;
            TEST_ASSERT_EQUAL_INT(gradients, ast_features_length(&cfg));
        }
    }
    ast_config preset;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&preset, AST_PRESET_PAPER));
    TEST_ASSERT_EQUAL_INT(32 * 32, ast_features_length(&preset));
}

/* Grey patch, then gradients, as they are made alone, times their weights. */
static void test_vector_is_the_weighted_parts(void) {
    static const float weights[][2] = {{1, 1}, {1, 1.4f}, {0.25f, 3}, {100, 1e-3f}};
    static float grey[256], gradients[1152];
    ast_config alone = weighted(1.0f, 0.0f);
    (void)lay_out(&alone);
    TEST_ASSERT_EQUAL_INT(256, describe(&alone));
    ast_sampler_patch(&scratch.patch, &image, &window, grey);
    TEST_ASSERT_EQUAL_MEMORY(grey, vector, sizeof grey);
    alone = weighted(0.0f, 1.0f);
    (void)lay_out(&alone);
    TEST_ASSERT_EQUAL_INT(1152, describe(&alone));
    ast_gradient_prepare(&features.gradient, &image, window.w, window.h);
    ast_gradient_cells(&features.gradient, &window, gradients);
    TEST_ASSERT_EQUAL_MEMORY(gradients, vector, sizeof gradients);

    for (size_t w = 0; w < sizeof weights / sizeof weights[0]; w++) {
        const ast_config cfg = weighted(weights[w][0], weights[w][1]);
        (void)lay_out(&cfg);
        TEST_ASSERT_EQUAL_INT(256 + 1152, describe(&cfg));
        for (int i = 0; i < 256; i++) TEST_ASSERT_TRUE(vector[i] == weights[w][0] * grey[i]);
        for (int i = 0; i < 1152; i++) TEST_ASSERT_TRUE(vector[256 + i] == weights[w][1] * gradients[i]);
    }
}

/* A part that is left out takes neither memory nor time: its maps are not there to be made. */
static void test_a_part_left_out_takes_no_memory(void) {
    const ast_config both = weighted(1.0f, 1.4f), grey = weighted(1.0f, 0.0f), gradients = weighted(0.0f, 1.4f);
    const size_t all = lay_out(&both), grey_bytes = lay_out(&grey);
    TEST_ASSERT_NULL(features.gradient.maps);
    const size_t gradient_bytes = lay_out(&gradients);
    TEST_ASSERT_EQUAL_UINT(all, grey_bytes + gradient_bytes);
    TEST_ASSERT_TRUE(gradient_bytes > 128 * 128 * 8); /* a byte for each direction of each of the view's pixels */
    ast_config larger = grey;
    larger.view = AST_MAX_VIEW;
    TEST_ASSERT_EQUAL_UINT(grey_bytes, lay_out(&larger));
}

/* The patch's normalisation is configured; gradients have a form of their own. */
static void test_normalisation_is_the_patchs(void) {
    static float unit[1408];
    ast_config cfg = weighted(1.0f, 1.0f);
    (void)lay_out(&cfg);
    (void)describe(&cfg);
    memcpy(unit, vector, sizeof unit);
    cfg.normalisation = AST_NORMALISE_NONE;
    (void)lay_out(&cfg);
    (void)describe(&cfg);
    for (int i = 0; i < 256; i++) TEST_ASSERT_TRUE(vector[i] > 0.05f && vector[i] < 0.95f); /* grey levels */
    TEST_ASSERT_EQUAL_MEMORY(unit + 256, vector + 256, 1152 * sizeof *unit);
}

/* ---- Properties ---- */

static double distance_from(const float *other, int first, int length) {
    double sum = 0;
    for (int i = first; i < first + length; i++)
        sum += ((double)vector[i] - (double)other[i]) * ((double)vector[i] - (double)other[i]);
    return sqrt(sum);
}

/* Gain and offset of the light move the vector of the robust preset by less than this; another texture is 40 times as far. The unit
 * grey patch moves by the rounding of levels and by the 1/255 that keeps flat patches small, the gradients by their noise floor. */
static void test_light_changes_little(void) {
    static const struct {
        double gain, offset, grey, all;
    } lights[] = {{0.7, 20, 0.008, 0.04}, {0.5, 60, 0.01, 0.05}, {1.0, 30, 2e-6, 2e-6}, {1.1, 0, 0.006, 0.03}};
    static float before[1408];
    const ast_config cfg = weighted(1.0f, 1.4f);
    (void)lay_out(&cfg);
    for (uint64_t seed = 2; seed < 8; seed++) {
        paint(seed, 1.0, 0.0);
        (void)describe(&cfg);
        memcpy(before, vector, sizeof before);
        for (size_t l = 0; l < sizeof lights / sizeof lights[0]; l++) {
            paint(seed, lights[l].gain, lights[l].offset);
            (void)describe(&cfg);
            TEST_ASSERT_TRUE(distance_from(before, 0, 256) < lights[l].grey);
            TEST_ASSERT_TRUE(distance_from(before, 0, 1408) < lights[l].all);
        }
        paint(seed + 50, 1.0, 0.0);
        (void)describe(&cfg);
        TEST_ASSERT_TRUE(distance_from(before, 0, 256) > 0.8 && distance_from(before, 0, 1408) > 1.6);
    }
}

/* A vector is a window's alone: others before it, or other windows of the same image, do not show in it. */
static void test_vectors_do_not_depend_on_those_before(void) {
    static float first[1408], other[1408];
    const ast_config cfg = weighted(1.0f, 1.4f);
    struct noise noise = {9};
    (void)lay_out(&cfg);
    (void)describe(&cfg);
    memcpy(first, vector, sizeof first);
    for (int trial = 0; trial < 50; trial++) {
        const ast_box elsewhere = {(float)(150 * noise_uniform(&noise) - 40), (float)(130 * noise_uniform(&noise) - 40),
                                   (float)(1 + 80 * noise_uniform(&noise)), (float)(1 + 80 * noise_uniform(&noise))};
        ast_features_vector(&features, &scratch, &image, &elsewhere, other);
        ast_features_vector(&features, &scratch, &image, &window, vector);
        TEST_ASSERT_EQUAL_MEMORY(first, vector, sizeof first);
    }
}

static void test_a_flat_image_has_no_vector(void) {
    const ast_config cfg = weighted(1.0f, 1.4f);
    (void)lay_out(&cfg);
    for (int level = 0; level <= 255; level += 51) {
        memset(pixels, level, sizeof pixels);
        (void)describe(&cfg);
        for (int i = 0; i < 1408; i++) TEST_ASSERT_FLOAT_WITHIN(1e-4f, 0.0f, vector[i]);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_length_is_that_of_the_parts);
    RUN_TEST(test_vector_is_the_weighted_parts);
    RUN_TEST(test_a_part_left_out_takes_no_memory);
    RUN_TEST(test_normalisation_is_the_patchs);
    RUN_TEST(test_light_changes_little);
    RUN_TEST(test_vectors_do_not_depend_on_those_before);
    RUN_TEST(test_a_flat_image_has_no_vector);
    return UNITY_END();
}
