/* The samplers that the bench takes for a peak do the work that the library's do. */
#include <math.h>
#include <stdlib.h>

#include "feature.h"
#include "peak_patch.h"
#include "support_noise.h"
#include "unity.h"

enum { WIDTH = 160, HEIGHT = 120, LENGTH = PEAK_SIDE * PEAK_SIDE };

static uint8_t pixels[WIDTH * HEIGHT];

void setUp(void) {
    struct noise noise = {5};
    for (int i = 0; i < WIDTH * HEIGHT; i++) pixels[i] = (uint8_t)noise_int(&noise, 0, 255);
}
void tearDown(void) {
}

/* The library's patch of a window, in grey levels / 255. */
static void library_patch(const ast_box *window, int width, int height, float *patch) {
    ast_config cfg;
    struct ast_sampler sampler;
    struct ast_arena arena = {NULL, 0};
    const ast_frame frame = {pixels, WIDTH, HEIGHT, WIDTH};
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&cfg, AST_PRESET_PAPER));
    cfg.patch_width = width;
    cfg.patch_height = height;
    cfg.normalisation = AST_NORMALISE_NONE;
    ast_sampler_layout(&sampler, &cfg, &arena);
    void *block = malloc(arena.used + AST_ALIGNMENT);
    TEST_ASSERT_NOT_NULL(block);
    arena.base = ast_align(block);
    arena.used = 0;
    ast_sampler_layout(&sampler, &cfg, &arena);
    ast_sampler_patch(&sampler, &frame, window, patch);
    free(block);
}

static void compare(const ast_box *window, int width, int height) {
    static float expected[LENGTH], got[LENGTH], line[PEAK_LINE];
    struct peak_axis columns, rows;
    library_patch(window, width, height, expected);
    peak_aim(&columns, window->x, window->w, width, 1);
    peak_aim(&rows, window->y, window->h, height, 1);
    for (int s = 0; s < PEAK_SAMPLERS; s++) {
        peak_samplers[s]->patch(&columns, &rows, pixels, WIDTH, line, got);
        for (int i = 0; i < width * height; i++) TEST_ASSERT_FLOAT_WITHIN(2e-5f, expected[i], got[i] / 255.0f);
    }
}

static void test_patches_are_the_librarys(void) {
    const ast_box windows[] = {{40.0f, 30.0f, 32.0f, 32.0f},
                               {41.3f, 33.7f, 20.0f, 25.0f},
                               {30.25f, 20.5f, 48.0f, 40.0f},
                               {20.6f, 11.1f, 100.0f, 70.0f},
                               {10.0f, 10.0f, 130.0f, 20.0f}};
    for (size_t w = 0; w < sizeof windows / sizeof windows[0]; w++) {
        compare(&windows[w], 32, 32);
        compare(&windows[w], 16, 20);
    }
}

/* Against their definition: the library's cells are of maps that it alone makes. */
static void test_cells_are_interpolated(void) {
    enum { SIDE = 40, CELLS = 6 };
    static float got[CELLS * CELLS * PEAK_DIRECTIONS];
    struct peak_axis columns, rows;
    peak_aim(&columns, 5.2f, 20.0f, CELLS, 0);
    peak_aim(&rows, 7.9f, 25.0f, CELLS, 0);
    TEST_ASSERT_EQUAL_INT(2, columns.taps);
    for (int s = 0; s < PEAK_SAMPLERS; s++) {
        peak_samplers[s]->cells(&columns, &rows, pixels, SIDE, got);
        for (int i = 0; i < CELLS * CELLS; i++) {
            const double x = 5.2 + (i % CELLS + 0.5) * 20.0 / CELLS - 0.5, y = 7.9 + (i / CELLS + 0.5) * 25.0 / CELLS - 0.5;
            const int left = (int)floor(x), top = (int)floor(y);
            for (int k = 0; k < PEAK_DIRECTIONS; k++) {
                double sum = 0;
                for (int corner = 0; corner < 4; corner++) {
                    const int cx = left + corner % 2, cy = top + corner / 2;
                    sum += (1 - fabs(x - cx)) * (1 - fabs(y - cy)) * pixels[(cy * SIDE + cx) * PEAK_DIRECTIONS + k];
                }
                TEST_ASSERT_DOUBLE_WITHIN(1e-3, sum, (double)got[i * PEAK_DIRECTIONS + k]);
            }
        }
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_patches_are_the_librarys);
    RUN_TEST(test_cells_are_interpolated);
    return UNITY_END();
}
