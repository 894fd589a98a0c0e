/* Grey patches: the resampled window in 0 .. 1, and its normalisations. The resampling itself is tested with resample.c. */
#include "patch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support_noise.h"
#include "unity.h"

enum { WIDTH = 8, HEIGHT = 6, LENGTH = WIDTH * HEIGHT };

static unsigned char *block;
static struct ast_sampler sampler;
static float patch[LENGTH + 1];

static void lay_out(int normalisation) {
    ast_config cfg;
    struct ast_arena counted = {NULL, 0}, arena;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&cfg, AST_PRESET_PAPER));
    cfg.patch_width = WIDTH;
    cfg.patch_height = HEIGHT;
    cfg.normalisation = normalisation;
    ast_sampler_layout(&sampler, &cfg, &counted);
    free(block);
    block = malloc(counted.used + AST_ALIGNMENT);
    TEST_ASSERT_NOT_NULL(block);
    memset(block, 0xff, counted.used + AST_ALIGNMENT); /* NaN */
    arena.base = ast_align(block);
    arena.used = 0;
    ast_sampler_layout(&sampler, &cfg, &arena);
    TEST_ASSERT_EQUAL_UINT(counted.used, arena.used);
}

void setUp(void) {
    patch[LENGTH] = 42.0f;
}
void tearDown(void) {
    TEST_ASSERT_TRUE(patch[LENGTH] == 42.0f); /* not a float more */
    free(block);
    block = NULL;
}

/* A frame of white noise. */
static ast_frame noise_frame(uint8_t *pixels, int width, int height, int stride, uint64_t seed) {
    struct noise noise = {seed};
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) pixels[(size_t)y * (size_t)stride + (size_t)x] = (uint8_t)noise_bits(&noise);
    const ast_frame frame = {pixels, width, height, stride};
    return frame;
}

static void sample_normalised(const ast_frame *frame, int normalisation) {
    const ast_box window = {7.3f, 5.9f, 14, 9};
    lay_out(normalisation);
    ast_sampler_patch(&sampler, frame, &window, patch);
}

/* The patch is what the resampler gives, row after row, black at 0 and white at 1. */
static void test_patch_is_the_window_in_0_to_1(void) {
    uint8_t pixels[30 * 24];
    const ast_frame frame = noise_frame(pixels, 30, 24, 30, 1);
    const ast_box whole = {5, 4, WIDTH, HEIGHT};
    lay_out(AST_NORMALISE_NONE);
    ast_sampler_patch(&sampler, &frame, &whole, patch);
    for (int r = 0; r < HEIGHT; r++)
        for (int c = 0; c < WIDTH; c++)
            TEST_ASSERT_FLOAT_WITHIN(1e-6f, (float)pixels[(r + 4) * 30 + c + 5] / 255.0f, patch[r * WIDTH + c]);

    const ast_box window = {7.3f, 5.9f, 14, 9};
    float row[WIDTH];
    ast_sampler_patch(&sampler, &frame, &window, patch);
    ast_resampler_aim(&sampler.resampler, &frame, &window, WIDTH, HEIGHT);
    for (int r = 0; r < HEIGHT; r++) {
        ast_resampler_rows(&sampler.resampler, &frame, r, 1, row, 0);
        for (int c = 0; c < WIDTH; c++) TEST_ASSERT_FLOAT_WITHIN(1e-6f, row[c] / 255.0f, patch[r * WIDTH + c]);
    }
}

static void test_normalisations(void) {
    uint8_t pixels[30 * 24];
    const ast_frame frame = noise_frame(pixels, 30, 24, 30, 13);
    double raw[LENGTH], mean = 0, square = 0;
    sample_normalised(&frame, AST_NORMALISE_NONE);
    for (int i = 0; i < LENGTH; i++) {
        raw[i] = (double)patch[i];
        mean += raw[i] / LENGTH;
    }
    for (int i = 0; i < LENGTH; i++) square += (raw[i] - mean) * (raw[i] - mean);

    sample_normalised(&frame, AST_NORMALISE_MEAN);
    for (int i = 0; i < LENGTH; i++) TEST_ASSERT_DOUBLE_WITHIN(2e-7, raw[i] - mean, (double)patch[i]);
    sample_normalised(&frame, AST_NORMALISE_UNIT);
    for (int i = 0; i < LENGTH; i++)
        TEST_ASSERT_DOUBLE_WITHIN(2e-7, (raw[i] - mean) / (sqrt(square) + 1.0 / 255), (double)patch[i]);
}

static void test_normalisation_is_blind_to_the_light(void) {
    uint8_t dim[30 * 24], bright[30 * 24];
    const ast_frame dim_frame = noise_frame(dim, 30, 24, 30, 14), bright_frame = {bright, 30, 24, 30};
    float before[LENGTH];
    for (int i = 0; i < 30 * 24; i++) dim[i] /= 3, bright[i] = (uint8_t)(dim[i] + 100);
    sample_normalised(&dim_frame, AST_NORMALISE_MEAN);
    memcpy(before, patch, sizeof before);
    sample_normalised(&bright_frame, AST_NORMALISE_MEAN);
    for (int i = 0; i < LENGTH; i++) TEST_ASSERT_FLOAT_WITHIN(1e-6f, before[i], patch[i]);

    for (int i = 0; i < 30 * 24; i++) bright[i] = (uint8_t)(3 * dim[i]);
    sample_normalised(&dim_frame, AST_NORMALISE_UNIT);
    memcpy(before, patch, sizeof before);
    sample_normalised(&bright_frame, AST_NORMALISE_UNIT);
    for (int i = 0; i < LENGTH; i++) TEST_ASSERT_FLOAT_WITHIN(3e-3f, before[i], patch[i]); /* the 1/255 is what differs */
}

static void test_flat_patches_stay_small(void) {
    uint8_t pixels[30 * 24];
    const ast_frame frame = {pixels, 30, 24, 30};
    static const uint8_t levels[] = {0, 1, 128, 255};
    for (size_t l = 0; l < sizeof levels; l++) {
        memset(pixels, levels[l], sizeof pixels);
        for (int kind = AST_NORMALISE_MEAN; kind <= AST_NORMALISE_UNIT; kind++) {
            sample_normalised(&frame, kind);
            for (int i = 0; i < LENGTH; i++) TEST_ASSERT_FLOAT_WITHIN(1e-4f, 0.0f, patch[i]);
        }
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_patch_is_the_window_in_0_to_1);
    RUN_TEST(test_normalisations);
    RUN_TEST(test_normalisation_is_blind_to_the_light);
    RUN_TEST(test_flat_patches_stay_small);
    return UNITY_END();
}
