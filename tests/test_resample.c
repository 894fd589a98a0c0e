/* Resampling against its definition, integrated numerically in double: a pixel of the grid is the frame, interpolated linearly and
 * extended by its edges, averaged over a box around the sampling position whose side is sqrt(step^2 - 1) pixels, none for steps up
 * to one pixel. */
#include "resample.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support_noise.h"
#include "support_pages.h"
#include "unity.h"

enum { MOST_GRID = AST_MAX_PATCH * AST_MAX_PATCH };

static unsigned char *block;
static struct ast_resampler resampler;
static int grid_width, grid_height;
static float grid[MOST_GRID];
static double expected[MOST_GRID];

/* A resampler for grids of this size; extra: how much larger a grid it has room for. */
static void lay_out(int width, int height, int extra) {
    struct ast_arena counted = {NULL, 0}, arena;
    ast_resampler_layout(&resampler, width + extra, &counted);
    free(block);
    block = malloc(counted.used + AST_ALIGNMENT);
    TEST_ASSERT_NOT_NULL(block);
    memset(block, 0xff, counted.used + AST_ALIGNMENT); /* NaN */
    arena.base = ast_align(block);
    arena.used = 0;
    ast_resampler_layout(&resampler, width + extra, &arena);
    TEST_ASSERT_EQUAL_UINT(counted.used, arena.used);
    grid_width = width;
    grid_height = height;
}

void setUp(void) {
    lay_out(8, 6, 0);
}
void tearDown(void) {
    free(block);
    block = NULL;
}

/* Fills `out` with the window, levels from 0 to 1. */
static void resample(const ast_frame *frame, const ast_box *window, float *out) {
    ast_resampler_aim(&resampler, frame, window, grid_width, grid_height);
    for (int r = 0; r < grid_height; r += AST_RESAMPLER_ROWS) {
        const int rows = grid_height - r < AST_RESAMPLER_ROWS ? grid_height - r : AST_RESAMPLER_ROWS;
        ast_resampler_rows(&resampler, frame, r, rows, out + r * grid_width, (size_t)grid_width);
    }
    for (int i = 0; i < grid_width * grid_height; i++) out[i] /= 255.0f;
}

/* ---- The definition ---- */

/* Weight of every source pixel in one grid pixel of an axis: the box is cut into slices, and each slice's middle is
 * interpolated. */
static void axis_reference(double *weight, int length, double start, double extent, int grid_length, int index) {
    enum { SLICES = 1500 };
    const double step = extent / grid_length, at = start + (index + 0.5) * step - 0.5;
    const double box = step > 1 ? fmin(sqrt(step * step - 1), AST_TAPS - 3) : 0;
    const int slices = box > 0 ? SLICES : 1;
    for (int i = 0; i < length; i++) weight[i] = 0;
    for (int s = 0; s < slices; s++) {
        const double x = fmin(fmax(at + box * ((s + 0.5) / slices - 0.5), 0), length - 1);
        const int left = (int)x < length - 1 ? (int)x : length - 1, right = left < length - 1 ? left + 1 : left;
        weight[left] += (1 - (x - left)) / slices;
        weight[right] += (x - left) / slices;
    }
}

/* Fills `expected` with the window, levels from 0 to 1. */
static void reference(const ast_frame *frame, const ast_box *window) {
    const int width = grid_width, height = grid_height, columns = frame->width, rows = frame->height;
    double *column_weight = malloc((size_t)width * (size_t)columns * sizeof *column_weight);
    double *row_weight = malloc((size_t)rows * sizeof *row_weight), *line = malloc((size_t)columns * sizeof *line);
    TEST_ASSERT_TRUE(column_weight != NULL && row_weight != NULL && line != NULL);
    for (int c = 0; c < width; c++)
        axis_reference(column_weight + (size_t)c * (size_t)columns, columns, (double)window->x, (double)window->w, width, c);
    for (int r = 0; r < height; r++) {
        axis_reference(row_weight, rows, (double)window->y, (double)window->h, height, r);
        for (int x = 0; x < columns; x++) line[x] = 0;
        for (int y = 0; y < rows; y++) {
            if (row_weight[y] == 0) continue;
            const uint8_t *pixels = frame->pixels + (size_t)y * (size_t)frame->stride;
            for (int x = 0; x < columns; x++) line[x] += row_weight[y] * pixels[x] / 255;
        }
        for (int c = 0; c < width; c++) {
            double sum = 0;
            for (int x = 0; x < columns; x++) sum += column_weight[(size_t)c * (size_t)columns + (size_t)x] * line[x];
            expected[r * width + c] = sum;
        }
    }
    free(column_weight);
    free(row_weight);
    free(line);
}

/* Samples the window and returns the largest difference from the definition. */
static double difference(const ast_frame *frame, const ast_box *window) {
    double worst = 0;
    for (int i = 0; i < MOST_GRID; i++) grid[i] = NAN;
    resample(frame, window, grid);
    reference(frame, window);
    for (int i = 0; i < grid_width * grid_height; i++) {
        TEST_ASSERT_FALSE(isnan(grid[i]));
        worst = fmax(worst, fabs((double)grid[i] - expected[i]));
    }
    for (int i = grid_width * grid_height; i < MOST_GRID; i++) TEST_ASSERT_TRUE(isnan(grid[i])); /* not a float more */
    return worst;
}

static void assert_window(const ast_frame *frame, float x, float y, float w, float h) {
    const ast_box window = {x, y, w, h};
    TEST_ASSERT_DOUBLE_WITHIN(5e-5, 0.0, difference(frame, &window));
}

/* A frame of white noise: every pixel that is weighed wrongly shows. */
static ast_frame noise_frame(uint8_t *pixels, int width, int height, int stride, uint64_t seed) {
    struct noise noise = {seed};
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) pixels[(size_t)y * (size_t)stride + (size_t)x] = (uint8_t)noise_bits(&noise);
    const ast_frame frame = {pixels, width, height, stride};
    return frame;
}

/* ---- Against the definition ---- */

static void test_whole_pixels_are_copied(void) {
    uint8_t pixels[20 * 15];
    const ast_frame frame = noise_frame(pixels, 20, 15, 20, 1);
    const ast_box window = {5, 4, 8, 6};
    resample(&frame, &window, grid);
    for (int r = 0; r < 6; r++)
        for (int c = 0; c < 8; c++) TEST_ASSERT_FLOAT_WITHIN(1e-6f, (float)pixels[(r + 4) * 20 + c + 5] / 255.0f, grid[r * 8 + c]);
}

static void test_sub_pixel_shifts(void) {
    static const float shifts[] = {0.0f, 0.01f, 0.25f, 1.0f / 3.0f, 0.5f, 0.75f, 0.999f};
    uint8_t pixels[30 * 24];
    const ast_frame frame = noise_frame(pixels, 30, 24, 30, 2);
    for (size_t a = 0; a < sizeof shifts / sizeof shifts[0]; a++)
        for (size_t b = 0; b < sizeof shifts / sizeof shifts[0]; b++) {
            assert_window(&frame, 9 + shifts[a], 7 + shifts[b], 8, 6);
            assert_window(&frame, 3 + shifts[a], 2 + shifts[b], 19.7f, 17.3f);
            assert_window(&frame, 11 + shifts[a], 8 + shifts[b], 5.1f, 3.9f);
        }
}

static void test_scales_from_a_fifth_to_five(void) {
    uint8_t pixels[90 * 70];
    const ast_frame frame = noise_frame(pixels, 90, 70, 90, 3);
    for (float scale = 0.2f; scale <= 5.0f; scale *= 1.07f) {
        assert_window(&frame, 45.3f - 4 * scale, 35.6f - 3 * scale, 8 * scale, 6 * scale);
        assert_window(&frame, 40.1f - 4 * scale, 31.2f - 3 / scale, 8 * scale, 6 / scale); /* one side grows, the other shrinks */
    }
}

static void test_borders_and_windows_outside(void) {
    uint8_t pixels[17 * 13];
    const ast_frame frame = noise_frame(pixels, 17, 13, 17, 4);
    static const float places[] = {-60, -20, -8.3f, -3.5f, -0.5f, 0, 9.2f, 12.9f, 16, 16.5f, 25, 70};
    static const float sizes[] = {1, 5.5f, 8, 13, 40};
    for (size_t x = 0; x < sizeof places / sizeof places[0]; x++)
        for (size_t y = 0; y < sizeof places / sizeof places[0]; y++)
            for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++)
                assert_window(&frame, places[x], places[y], sizes[s], sizes[s]);
}

static void test_grids_of_all_shapes(void) {
    static const int sides[] = {4, 5, 16, 31, AST_MAX_PATCH};
    uint8_t pixels[80 * 60];
    const ast_frame frame = noise_frame(pixels, 80, 60, 80, 5);
    for (size_t w = 0; w < sizeof sides / sizeof sides[0]; w++)
        for (size_t h = 0; h < sizeof sides / sizeof sides[0]; h++) {
            lay_out(sides[w], sides[h], 0);
            assert_window(&frame, 21.4f, 13.7f, 36.2f, 29.1f);
        }
}

/* One resampler serves grids up to its size, which may change from one window to the next. */
static void test_grids_smaller_than_the_resampler(void) {
    uint8_t pixels[80 * 60];
    const ast_frame frame = noise_frame(pixels, 80, 60, 80, 20);
    lay_out(20, 20, 13);
    for (int side = 33; side >= 1; side -= 4) {
        grid_width = side;
        grid_height = 34 - side;
        assert_window(&frame, 21.4f, 13.7f, 36.2f, 29.1f);
    }
}

/* A grid made a few columns at a time, its rows in any order, is the grid made at once, bit for bit. */
static void test_grid_made_in_parts(void) {
    uint8_t pixels[80 * 60];
    static float whole[48 * 40], parts[48 * 40];
    const ast_frame frame = noise_frame(pixels, 80, 60, 80, 21);
    const ast_box window = {-3.3f, 4.1f, 77.7f, 61.9f};
    lay_out(48, 40, 0);
    resample(&frame, &window, whole);
    lay_out(7, 40, 0);
    for (int begin = 0; begin < 48; begin += 7) {
        const int count = 48 - begin < 7 ? 48 - begin : 7;
        ast_resampler_aim_columns(&resampler, &frame, &window, 48, 40, begin, count);
        for (int r = 39; r >= 0; r -= 3) ast_resampler_rows(&resampler, &frame, r, r < 39 ? 2 : 1, parts + r * 48 + begin, 48);
        for (int r = 37; r >= 0; r -= 3) ast_resampler_rows(&resampler, &frame, r, 2, parts + r * 48 + begin, 48);
    }
    for (int i = 0; i < 48 * 40; i++) parts[i] /= 255.0f;
    TEST_ASSERT_EQUAL_MEMORY(whole, parts, sizeof whole);
}

static void test_frame_of_one_pixel(void) {
    static const uint8_t grey[1] = {51};
    const ast_frame frame = {grey, 1, 1, 1};
    static const ast_box windows[] = {{0, 0, 1, 1}, {-20, -10, 40, 20}, {0.7f, 0.2f, 65535, 65535}, {-3, 50, 1.5f, 7}};
    for (size_t w = 0; w < sizeof windows / sizeof windows[0]; w++) {
        resample(&frame, &windows[w], grid);
        for (int i = 0; i < 48; i++) TEST_ASSERT_FLOAT_WITHIN(1e-6f, 0.2f, grid[i]);
    }
}

/* The widest frame, its ends and middle, up to a window over all of it. Places that a float holds exactly: far from zero a float
 * has no finer ones. */
static void test_frame_of_one_long_row(void) {
    uint8_t *pixels = malloc(AST_MAX_FRAME);
    TEST_ASSERT_NOT_NULL(pixels);
    const ast_frame frame = noise_frame(pixels, AST_MAX_FRAME, 1, AST_MAX_FRAME, 6);
    lay_out(8, 4, 0);
    assert_window(&frame, 0, 0, 8, 1);
    assert_window(&frame, 40000.25f, -3, 16, 4);
    assert_window(&frame, 65527.5f, -10, 16, 20);
    assert_window(&frame, 65500, 0, 32, 1);
    assert_window(&frame, 0, 0, 65536, 1);
    assert_window(&frame, -32768, 0, 65536, 1);
    free(pixels);
}

static void test_frame_of_one_long_column(void) {
    uint8_t *pixels = malloc(3 * (size_t)AST_MAX_FRAME);
    TEST_ASSERT_NOT_NULL(pixels);
    const ast_frame frame = noise_frame(pixels, 3, AST_MAX_FRAME, 3, 7);
    lay_out(4, 8, 0);
    assert_window(&frame, 0.5f, 40000.25f, 2, 16);
    assert_window(&frame, -1, 65527.5f, 5, 16);
    assert_window(&frame, 0, 0, 3, 65536);
    free(pixels);
}

/* Windows up to about 30 times the grid are averaged whole; of larger ones, 29 pixels around each sample. */
static void test_averaging_stops_at_the_most_taps(void) {
    enum { SIDE = 400 };
    uint8_t *pixels = malloc((size_t)SIDE * SIDE);
    TEST_ASSERT_NOT_NULL(pixels);
    const ast_frame frame = noise_frame(pixels, SIDE, SIDE, SIDE, 8);
    lay_out(4, 4, 0);
    for (float step = 20.0f; step < 100.0f; step *= 1.11f)
        assert_window(&frame, 200.3f - 2 * step, 199.8f - 2 * step, 4 * step, 4 * step);
    assert_window(&frame, 10, 10, 4 * 29, 4 * 29);
    assert_window(&frame, -500, -600, 1400, 1500); /* samples on both edges, gaps between */
    lay_out(9, 9, 0);
    assert_window(&frame, -200, -100, 800, 700);
    lay_out(4, 4, 0);
    assert_window(&frame, 10.5f, 10.5f, 4 * 29.0172f, 4 * 29.0172f); /* the box reaches its limit here */
    assert_window(&frame, 10.25f, 10.25f, 4 * 30, 4 * 31);
    free(pixels);
}

/* ---- Properties ---- */

static void test_constant_frame_stays_constant(void) {
    uint8_t pixels[40 * 30];
    const ast_frame frame = {pixels, 40, 30, 40};
    struct noise noise = {9};
    memset(pixels, 102, sizeof pixels);
    for (int trial = 0; trial < 2000; trial++) {
        const ast_box window = {(float)(80 * noise_uniform(&noise) - 40), (float)(60 * noise_uniform(&noise) - 30),
                                (float)exp(8 * noise_uniform(&noise) - 2), (float)exp(8 * noise_uniform(&noise) - 2)};
        resample(&frame, &window, grid);
        for (int i = 0; i < 48; i++) TEST_ASSERT_FLOAT_WITHIN(2e-6f, 0.4f, grid[i]);
    }
}

/* Interpolation and averaging both keep a straight line. */
static void test_ramp_is_reproduced(void) {
    uint8_t pixels[120 * 100];
    const ast_frame frame = {pixels, 120, 100, 120};
    for (int y = 0; y < 100; y++)
        for (int x = 0; x < 120; x++) pixels[y * 120 + x] = (uint8_t)(x + y + 10);
    for (float scale = 0.3f; scale < 8.0f; scale *= 1.13f) {
        const ast_box window = {60.37f - 4 * scale, 50.81f - 3 * scale, 8 * scale, 6 * scale};
        resample(&frame, &window, grid);
        for (int r = 0; r < 6; r++)
            for (int c = 0; c < 8; c++) {
                const double x = (double)window.x + (c + 0.5) * (double)scale - 0.5,
                             y = (double)window.y + (r + 0.5) * (double)scale - 0.5;
                TEST_ASSERT_DOUBLE_WITHIN(2e-6, (x + y + 10) / 255, (double)grid[r * 8 + c]);
            }
    }
}

/* Where the averaging sets in it may be left out as long as it is below half a percent of a pixel's weight. */
static void test_definition_holds_where_averaging_sets_in(void) {
    uint8_t pixels[40 * 30];
    const ast_frame frame = noise_frame(pixels, 40, 30, 40, 19);
    for (float above = 1e-7f; above < 0.02f; above *= 1.5f) {
        const float scale = 1.0f + above;
        const ast_box window = {20.0f - 4 * scale, 15.0f - 3 * scale, 8 * scale, 6 * scale};
        TEST_ASSERT_DOUBLE_WITHIN(above < 1e-4f ? 5e-3 : 1e-4, 0.0, difference(&frame, &window));
    }
}

/* Where the averaging sets in, the grid does not jump: between neighbouring scales it changes by less than a grey level. */
static void test_grid_is_continuous_in_scale(void) {
    uint8_t pixels[40 * 30];
    const ast_frame frame = noise_frame(pixels, 40, 30, 40, 10);
    float last[48];
    double worst = 0;
    for (int k = -2000; k <= 2000; k++) {
        const float scale = 1.0f + (float)k * 1e-6f;
        const ast_box window = {20.0f - 4 * scale, 15.0f - 3 * scale, 8 * scale, 6 * scale};
        resample(&frame, &window, grid);
        for (int i = 0; i < 48 && k > -2000; i++) worst = fmax(worst, fabs((double)grid[i] - (double)last[i]));
        memcpy(last, grid, sizeof last);
    }
    TEST_ASSERT_TRUE(worst < 1.0 / 255);
}

/* Equal in every size: nothing of an earlier window stays. */
static void test_resampler_forgets_the_last_window(void) {
    uint8_t pixels[90 * 70];
    const ast_frame frame = noise_frame(pixels, 90, 70, 90, 11);
    const ast_box window = {20.2f, 17.7f, 21, 33};
    struct noise noise = {12};
    float first[48];
    resample(&frame, &window, first);
    for (int trial = 0; trial < 300; trial++) {
        const ast_box other = {(float)(90 * noise_uniform(&noise)), (float)(70 * noise_uniform(&noise)),
                               (float)exp(7 * noise_uniform(&noise)), (float)exp(7 * noise_uniform(&noise))};
        resample(&frame, &other, grid);
        resample(&frame, &window, grid);
        TEST_ASSERT_EQUAL_MEMORY(first, grid, sizeof first);
    }
}

/* ---- What is read ---- */

/* Windows of all kinds, chosen by a seed. */
static void sample_many(const ast_frame *frame, uint64_t seed) {
    struct noise noise = {seed};
    for (int trial = 0; trial < 400; trial++) {
        const double w = exp(9 * noise_uniform(&noise) - 2), h = exp(9 * noise_uniform(&noise) - 2);
        const double x = noise_uniform(&noise) * (frame->width + 2 * w) - 1.5 * w,
                     y = noise_uniform(&noise) * (frame->height + 2 * h) - 1.5 * h;
        const ast_box window = {(float)x, (float)y, (float)w, (float)h};
        resample(frame, &window, grid);
        for (int i = 0; i < 48; i++) TEST_ASSERT_TRUE(grid[i] >= -1e-6f && grid[i] <= 1.0f + 1e-6f);
    }
}

static void test_padding_is_never_seen(void) {
    enum { WIDTH = 20, HEIGHT = 15, STRIDE = 37 };
    uint8_t packed[WIDTH * HEIGHT], padded[STRIDE * HEIGHT];
    const ast_frame plain = noise_frame(packed, WIDTH, HEIGHT, WIDTH, 15);
    struct noise noise = {16};
    for (int poison = 0; poison <= 255; poison += 85) {
        memset(padded, poison, sizeof padded);
        for (int y = 0; y < HEIGHT; y++) memcpy(padded + y * STRIDE, packed + y * WIDTH, WIDTH);
        const ast_frame frame = {padded, WIDTH, HEIGHT, STRIDE};
        for (int trial = 0; trial < 300; trial++) {
            const ast_box window = {(float)(40 * noise_uniform(&noise) - 20), (float)(30 * noise_uniform(&noise) - 15),
                                    (float)exp(5 * noise_uniform(&noise) - 1), (float)exp(5 * noise_uniform(&noise) - 1)};
            float unpadded[48];
            resample(&plain, &window, unpadded);
            resample(&frame, &window, grid);
            TEST_ASSERT_EQUAL_MEMORY(unpadded, grid, sizeof unpadded);
        }
    }
}

/* The frame's first byte follows a page that cannot be read, then its last byte precedes one. With a stride above the width the
 * last row has no padding behind it. */
static void test_no_byte_outside_the_frame_is_read(void) {
    static const struct {
        int width, height, stride;
    } shapes[] = {{1, 1, 1}, {1, 1, 4096}, {1, 40, 1}, {40, 1, 40}, {23, 17, 23}, {23, 17, 61}, {4000, 3, 4096}};
    for (size_t s = 0; s < sizeof shapes / sizeof shapes[0]; s++) {
        const size_t bytes = (size_t)(shapes[s].height - 1) * (size_t)shapes[s].stride + (size_t)shapes[s].width;
        struct pages pages;
        pages_open(&pages, bytes);
        for (int side = 0; side < 2; side++) {
            unsigned char *pixels = side == 0 ? pages.first : pages.end - bytes;
            const ast_frame frame = noise_frame(pixels, shapes[s].width, shapes[s].height, shapes[s].stride, 17);
            sample_many(&frame, 18 + s);
        }
        pages_close(&pages);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_whole_pixels_are_copied);
    RUN_TEST(test_sub_pixel_shifts);
    RUN_TEST(test_scales_from_a_fifth_to_five);
    RUN_TEST(test_borders_and_windows_outside);
    RUN_TEST(test_grids_of_all_shapes);
    RUN_TEST(test_grids_smaller_than_the_resampler);
    RUN_TEST(test_grid_made_in_parts);
    RUN_TEST(test_frame_of_one_pixel);
    RUN_TEST(test_frame_of_one_long_row);
    RUN_TEST(test_frame_of_one_long_column);
    RUN_TEST(test_averaging_stops_at_the_most_taps);
    RUN_TEST(test_constant_frame_stays_constant);
    RUN_TEST(test_ramp_is_reproduced);
    RUN_TEST(test_definition_holds_where_averaging_sets_in);
    RUN_TEST(test_grid_is_continuous_in_scale);
    RUN_TEST(test_resampler_forgets_the_last_window);
    RUN_TEST(test_padding_is_never_seen);
    RUN_TEST(test_no_byte_outside_the_frame_is_read);
    return UNITY_END();
}
