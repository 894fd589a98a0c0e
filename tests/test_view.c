/* The view: the reachable part of a frame, never finer than the frame, at most so many pixels, the same for a frame of any size. */
#include "view.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support_noise.h"
#include "support_pages.h"
#include "unity.h"

enum { SIDE = 128, OBJECT = 36, GUARD = 64, GUARD_BYTE = 0xa5 };

static unsigned char *block;
static size_t block_size;
static struct ast_view view;

static void lay_out(int side, int object) {
    ast_config cfg;
    struct ast_arena counted = {NULL, 0}, arena;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&cfg, AST_PRESET_ROBUST));
    cfg.view = side;
    cfg.view_object = object;
    ast_view_layout(&view, &cfg, &counted);
    free(block);
    block = malloc(counted.used + AST_ALIGNMENT + GUARD);
    TEST_ASSERT_NOT_NULL(block);
    memset(block, GUARD_BYTE, counted.used + AST_ALIGNMENT + GUARD);
    arena.base = ast_align(block);
    arena.used = 0;
    memset(arena.base, 0xff, counted.used); /* NaN */
    ast_view_layout(&view, &cfg, &arena);
    TEST_ASSERT_EQUAL_UINT(counted.used, arena.used);
    block_size = arena.used;
}

void setUp(void) {
    lay_out(SIDE, OBJECT);
}
void tearDown(void) {
    for (int i = 0; i < GUARD; i++) TEST_ASSERT_EQUAL_HEX8(GUARD_BYTE, ast_align(block)[block_size + (size_t)i]);
    free(block);
    block = NULL;
}

static uint8_t *noise_pixels(size_t count, uint64_t seed) {
    struct noise noise = {seed};
    uint8_t *pixels = malloc(count);
    TEST_ASSERT_NOT_NULL(pixels);
    for (size_t i = 0; i < count; i++) pixels[i] = (uint8_t)noise_bits(&noise);
    return pixels;
}

static int is_own(void) {
    return view.image.pixels == view.pixels;
}

static const uint8_t *row(const ast_frame *frame, int y) {
    return frame->pixels + (size_t)y * (size_t)frame->stride;
}

/* A random region about a frame: inside, across its edges or beyond them, of sides from least to most. */
static ast_box random_region(struct noise *noise, const ast_frame *frame, double least, double most) {
    const double w = least * pow(most / least, noise_uniform(noise)), h = least * pow(most / least, noise_uniform(noise));
    const double x = noise_uniform(noise) * (frame->width + 2 * w) - 1.5 * w,
                 y = noise_uniform(noise) * (frame->height + 2 * h) - 1.5 * h;
    const ast_box region = {(float)x, (float)y, (float)w, (float)h};
    return region;
}

/* ---- What is shown ---- */

static void test_without_a_view_the_frame_is_shown(void) {
    uint8_t *pixels = noise_pixels(300 * 200, 1);
    const ast_frame frame = {pixels, 290, 200, 300};
    const ast_box region = {40, 30, 500, 400}, object = {0, 0, 200, 200}, box = {17.5f, -3.25f, 90, 41};
    lay_out(0, OBJECT);
    TEST_ASSERT_EQUAL_UINT(0, block_size);
    ast_view_show(&view, &frame, &region, &object);
    TEST_ASSERT_EQUAL_PTR(frame.pixels, view.image.pixels);
    TEST_ASSERT_EQUAL_INT(frame.width, view.image.width);
    TEST_ASSERT_EQUAL_INT(frame.height, view.image.height);
    TEST_ASSERT_EQUAL_INT(frame.stride, view.image.stride);
    const ast_box same = ast_view_box(&view, &box);
    TEST_ASSERT_EQUAL_MEMORY(&box, &same, sizeof box);
    free(pixels);
}

/* Small objects are shown as they are, by the frame's own memory: what the view holds is not touched. */
static void test_a_small_object_is_shown_by_the_frame_itself(void) {
    uint8_t *pixels = noise_pixels(320 * 240, 2);
    const ast_frame frame = {pixels, 311, 240, 320};
    const ast_box region = {50.7f, 20.2f, 110.1f, 90.9f}, object = {0, 0, 30, 40};
    ast_view_show(&view, &frame, &region, &object);
    TEST_ASSERT_TRUE(view.pixel == 1.0f && view.origin_x == 50.0f && view.origin_y == 20.0f);
    TEST_ASSERT_EQUAL_PTR(pixels + 20 * 320 + 50, view.image.pixels);
    TEST_ASSERT_EQUAL_INT(111, view.image.width); /* 50 .. 161, outwards */
    TEST_ASSERT_EQUAL_INT(92, view.image.height); /* 20 .. 112 */
    TEST_ASSERT_EQUAL_INT(320, view.image.stride);
    for (int i = 0; i < SIDE * SIDE; i++) TEST_ASSERT_EQUAL_HEX8(0xff, view.pixels[i]);
    free(pixels);
}

/* The geometric mean of an object's sides takes so many pixels at most, its surroundings as many as fit. */
static void test_resolution_is_the_objects(void) {
    uint8_t *pixels = noise_pixels(1500 * 1000, 3);
    const ast_frame frame = {pixels, 1500, 1000, 1500};
    for (float size = 10; size < 900; size *= 1.13f) {
        for (float aspect = 0.25f; aspect <= 4; aspect *= 2) {
            const ast_box object = {0, 0, size * aspect, size / aspect}, near = {400, 300, 2.5f * size, 2 * size};
            ast_view_show(&view, &frame, &near, &object);
            TEST_ASSERT_FLOAT_WITHIN(1e-4f * size, fmaxf(1, size / OBJECT), view.pixel);
        }
        const ast_box object = {0, 0, 20, 15}, wide = {300, 200, size, 0.5f * size}; /* a small object and a large reach */
        ast_view_show(&view, &frame, &wide, &object);
        TEST_ASSERT_FLOAT_WITHIN(1e-4f * size, fmaxf(1, size / (SIDE - 2)), view.pixel);
    }
    free(pixels);
}

/* What of a region lies beyond the frame takes none of the pixels: it is shown as its part inside would be. */
static void test_resolution_is_that_of_the_part_inside(void) {
    uint8_t *pixels = noise_pixels(400 * 300, 14);
    const ast_frame frame = {pixels, 400, 300, 400};
    static const ast_box beyond[] = {{-1000, -500, 1100, 700},
                                     {300, 250, 900, 3000},
                                     {-2000, 100, 5000, 60},
                                     {50, -700, 300, 2000}},
                         inside[] = {{0, 0, 100, 200}, {300, 250, 100, 50}, {0, 100, 400, 60}, {50, 0, 300, 300}};
    static const float longest[] = {200, 100, 400, 300};
    const ast_box object = {0, 0, 20, 15};
    for (int r = 0; r < 4; r++) {
        ast_view_show(&view, &frame, &inside[r], &object);
        const float pixel = view.pixel;
        const ast_frame image = view.image;
        ast_view_show(&view, &frame, &beyond[r], &object);
        TEST_ASSERT_FLOAT_WITHIN(1e-5f, fmaxf(1, longest[r] / (SIDE - 2)), view.pixel);
        TEST_ASSERT_TRUE(view.pixel == pixel);
        TEST_ASSERT_TRUE(view.origin_x == inside[r].x && view.origin_y == inside[r].y);
        TEST_ASSERT_TRUE(view.image.width == image.width && view.image.height == image.height);
    }
    free(pixels);
}

/* Any region: never a pixel finer than the frame's, never more pixels than the view's sides, and all of the region that is in the
 * frame (of one beyond it, the nearest pixel). */
static void test_any_region_is_covered_and_fits(void) {
    static const int settings[][2] = {{32, 8}, {32, AST_MAX_VIEW}, {SIDE, OBJECT}, {AST_MAX_VIEW, 8}, {AST_MAX_VIEW, AST_MAX_VIEW}};
    static const int shapes[][2] = {{1, 1}, {200, 1}, {3, 500}, {640, 480}, {129, 127}};
    struct noise noise = {4};
    uint8_t *pixels = noise_pixels(640 * 480, 5);
    for (size_t s = 0; s < sizeof settings / sizeof settings[0]; s++) {
        lay_out(settings[s][0], settings[s][1]);
        for (int trial = 0; trial < 250; trial++) {
            const int *shape = shapes[trial % 5];
            const ast_frame frame = {pixels, shape[0], shape[1], shape[0]};
            const ast_box region = random_region(&noise, &frame, 0.5, 3000), object = random_region(&noise, &frame, 0.5, 1500);
            ast_view_show(&view, &frame, &region, &object);
            TEST_ASSERT_TRUE(view.pixel >= 1.0f);
            TEST_ASSERT_TRUE(view.image.width >= 1 && view.image.width <= settings[s][0]);
            TEST_ASSERT_TRUE(view.image.height >= 1 && view.image.height <= settings[s][0]);
            const double left = fmax(0, fmin((double)region.x, shape[0] - 1)), top = fmax(0, fmin((double)region.y, shape[1] - 1));
            const double right = fmin((double)region.x + (double)region.w, shape[0]),
                         bottom = fmin((double)region.y + (double)region.h, shape[1]);
            TEST_ASSERT_TRUE((double)view.origin_x == floor(left) && (double)view.origin_y == floor(top));
            TEST_ASSERT_TRUE((double)view.origin_x + view.image.width * (double)view.pixel > right - 0.01);
            TEST_ASSERT_TRUE((double)view.origin_y + view.image.height * (double)view.pixel > bottom - 0.01);
            TEST_ASSERT_TRUE((double)view.origin_x + (view.image.width - 1) * (double)view.pixel < fmax(right, left) + 1.01);
            TEST_ASSERT_TRUE((double)view.origin_y + (view.image.height - 1) * (double)view.pixel < fmax(bottom, top) + 1.01);
            if (!is_own()) { /* a part of the frame, not a byte more */
                TEST_ASSERT_TRUE(view.pixel == 1.0f);
                TEST_ASSERT_TRUE((int)view.origin_x + view.image.width <= shape[0] &&
                                 (int)view.origin_y + view.image.height <= shape[1]);
                TEST_ASSERT_EQUAL_PTR(pixels + (size_t)view.origin_y * (size_t)shape[0] + (size_t)view.origin_x, view.image.pixels);
            }
        }
    }
    free(pixels);
}

/* A point at p view pixels from the view's corner is at origin + p pixel in the frame. */
static void test_boxes_go_there_and_back(void) {
    struct noise noise = {6};
    uint8_t *pixels = noise_pixels(640 * 480, 7);
    const ast_frame frame = {pixels, 640, 480, 640};
    for (int trial = 0; trial < 300; trial++) {
        const ast_box region = random_region(&noise, &frame, 20, 900), object = random_region(&noise, &frame, 10, 300);
        const ast_box box = random_region(&noise, &frame, 1, 900);
        ast_view_show(&view, &frame, &region, &object);
        const ast_box inside = ast_view_box(&view, &box);
        const double pixel = (double)view.pixel;
        TEST_ASSERT_DOUBLE_WITHIN(1e-3, (double)box.x, (double)view.origin_x + (double)inside.x * pixel);
        TEST_ASSERT_DOUBLE_WITHIN(1e-3, (double)box.y, (double)view.origin_y + (double)inside.y * pixel);
        TEST_ASSERT_DOUBLE_WITHIN(1e-3, (double)box.w, (double)inside.w * pixel);
        TEST_ASSERT_DOUBLE_WITHIN(1e-3, (double)box.h, (double)inside.h * pixel);
        const ast_box whole = {view.origin_x, view.origin_y, (float)view.image.width * view.pixel,
                               (float)view.image.height * view.pixel};
        const ast_box all = ast_view_box(&view, &whole);
        TEST_ASSERT_TRUE(all.x == 0.0f && all.y == 0.0f);
        TEST_ASSERT_FLOAT_WITHIN(1e-3f, (float)view.image.width, all.w);
        TEST_ASSERT_FLOAT_WITHIN(1e-3f, (float)view.image.height, all.h);
    }
    free(pixels);
}

/* ---- Its pixels ---- */

/* The resampling of the window that the view shows, rounded to bytes. */
static void test_pixels_are_the_resampled_window(void) {
    struct noise noise = {8};
    uint8_t *pixels = noise_pixels(400 * 300, 9);
    const ast_frame frame = {pixels, 400, 300, 400};
    struct ast_resampler resampler;
    struct ast_arena counted = {NULL, 0}, arena = {NULL, 0};
    float line[SIDE];
    ast_resampler_layout(&resampler, SIDE, &counted);
    unsigned char *memory = malloc(counted.used + AST_ALIGNMENT);
    TEST_ASSERT_NOT_NULL(memory);
    arena.base = ast_align(memory);
    ast_resampler_layout(&resampler, SIDE, &arena);
    int resampled = 0;
    for (int trial = 0; trial < 40; trial++) {
        const ast_box region = random_region(&noise, &frame, 30, 500), object = random_region(&noise, &frame, 10, 200);
        ast_view_show(&view, &frame, &region, &object);
        if (!is_own()) continue;
        resampled++;
        TEST_ASSERT_EQUAL_INT(SIDE, view.image.stride);
        const ast_box window = {view.origin_x, view.origin_y, (float)view.image.width * view.pixel,
                                (float)view.image.height * view.pixel};
        ast_resampler_aim(&resampler, &frame, &window, view.image.width, view.image.height);
        for (int y = 0; y < view.image.height; y++) {
            ast_resampler_rows(&resampler, &frame, y, 1, line, 0);
            for (int x = 0; x < view.image.width; x++)
                TEST_ASSERT_DOUBLE_WITHIN(0.5 + 1e-5, (double)line[x], row(&view.image, y)[x]);
        }
    }
    TEST_ASSERT_TRUE(resampled > 15);
    free(memory);
    free(pixels);
}

/* A ramp keeps its level at every place: the middle of view pixel p lies at origin + (p + 1/2) pixel, pixel centres at whole
 * numbers. */
static void test_pixels_lie_where_the_mapping_says(void) {
    uint8_t *pixels = noise_pixels(255 * 255, 10);
    const ast_frame frame = {pixels, 255, 255, 255};
    for (int down = 0; down < 2; down++) {
        for (int i = 0; i < 255 * 255; i++) pixels[i] = (uint8_t)(down ? i / 255 : i % 255);
        for (float size = 40; size < 200; size *= 1.2f) {
            const ast_box region = {12.3f, 15, 230, 225}, object = {0, 0, size, size};
            ast_view_show(&view, &frame, &region, &object);
            TEST_ASSERT_TRUE(is_own());
            for (int y = 0; y < view.image.height; y++)
                for (int x = 0; x < view.image.width; x++) {
                    const double corner = (double)(down ? view.origin_y : view.origin_x);
                    const double place = corner + ((down ? y : x) + 0.5) * (double)view.pixel - 0.5;
                    TEST_ASSERT_DOUBLE_WITHIN(0.51, place, row(&view.image, y)[x]);
                }
        }
    }
    free(pixels);
}

/* Detail finer than a view pixel turns grey instead of into another pattern. */
static void test_fine_detail_is_averaged(void) {
    uint8_t *pixels = noise_pixels(700 * 700, 11);
    const ast_frame frame = {pixels, 700, 700, 700};
    for (int i = 0; i < 700 * 700; i++) pixels[i] = (i % 700 + i / 700) % 2 ? 255 : 0;
    for (float pixel = 2.2f; pixel < 6; pixel *= 1.13f) {
        const ast_box region = {100, 100, 100 * pixel, 100 * pixel}, object = {0, 0, OBJECT * pixel, OBJECT * pixel};
        ast_view_show(&view, &frame, &region, &object);
        TEST_ASSERT_TRUE(is_own());
        for (int y = 1; y < view.image.height - 1; y++)
            for (int x = 1; x < view.image.width - 1; x++) TEST_ASSERT_INT_WITHIN(30, 128, row(&view.image, y)[x]);
    }
    free(pixels);
}

/* ---- Frames of any size ---- */

/* The same scene in a frame of 4K and cut out of it: the same view, from the same memory. What the region and the resampling's
 * support leave out is not looked at. */
static void test_a_large_frame_shows_what_a_cropped_one_does(void) {
    enum { WIDTH = 3840, HEIGHT = 2160, X = 1700, Y = 900, W = 520, H = 430, MARGIN = AST_TAPS };
    uint8_t *large = noise_pixels((size_t)WIDTH * HEIGHT, 12), *small = malloc((size_t)W * H), shown[SIDE * SIDE];
    TEST_ASSERT_NOT_NULL(small);
    for (int y = 0; y < H; y++) memcpy(small + y * W, large + (size_t)(Y + y) * WIDTH + X, W);
    const ast_frame whole = {large, WIDTH, HEIGHT, WIDTH}, cropped = {small, W, H, W};
    static const float sizes[] = {30, 100, 180};
    for (int s = 0; s < 3; s++) {
        const ast_box object = {0, 0, sizes[s], sizes[s]};
        const ast_box region = {X + MARGIN + 0.5f, Y + MARGIN + 3.25f, fminf(2.5f * sizes[s], 440), fminf(2 * sizes[s], 350)};
        const ast_box moved = {region.x - X, region.y - Y, region.w, region.h};
        ast_view_show(&view, &cropped, &moved, &object);
        const ast_frame first = view.image;
        const float pixel = view.pixel;
        for (int y = 0; y < first.height; y++) memcpy(shown + y * SIDE, row(&first, y), (size_t)first.width);
        for (int changed = 0; changed < 2; changed++) {
            if (changed)
                for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
                    const int x = (int)(i % WIDTH) - X, y = (int)(i / WIDTH) - Y;
                    if (x < 0 || x >= W || y < 0 || y >= H) large[i] = (uint8_t)(255 - large[i]);
                }
            ast_view_show(&view, &whole, &region, &object);
            TEST_ASSERT_TRUE(view.pixel == pixel);
            TEST_ASSERT_EQUAL_INT(first.width, view.image.width);
            TEST_ASSERT_EQUAL_INT(first.height, view.image.height);
            for (int y = 0; y < first.height; y++)
                for (int x = 0; x < first.width; x++)
                    TEST_ASSERT_INT_WITHIN((UNITY_UINT)is_own(), shown[y * SIDE + x], row(&view.image, y)[x]);
        }
    }
    free(large);
    free(small);
}

/* Memory is a matter of the view's side alone. */
static void test_memory_is_the_sides(void) {
    const size_t line = (AST_RESAMPLER_PIXELS + 2 * AST_RESAMPLER_CHUNK) * AST_RESAMPLER_ROWS * sizeof(float);
    size_t before = 0;
    for (int side = 32; side <= AST_MAX_VIEW; side *= 2) {
        lay_out(side, 8);
        const size_t used = block_size, pixels = (size_t)side * (size_t)side;
        lay_out(side, AST_MAX_VIEW);
        TEST_ASSERT_EQUAL_UINT(used, block_size);
        TEST_ASSERT_TRUE(used > before && used > pixels && used < pixels + line + (size_t)side * 512);
        before = used;
    }
}

/* Frames between pages that cannot be read, their rows padded or not. */
static void test_no_byte_outside_the_frame_is_read(void) {
    static const int shapes[][3] = {{1, 1, 1}, {1, 300, 1}, {300, 1, 300}, {150, 170, 150}, {150, 170, 400}, {4000, 3, 4096}};
    struct noise noise = {13};
    for (size_t s = 0; s < sizeof shapes / sizeof shapes[0]; s++) {
        const int width = shapes[s][0], height = shapes[s][1], stride = shapes[s][2];
        const size_t bytes = (size_t)(height - 1) * (size_t)stride + (size_t)width;
        struct pages pages;
        pages_open(&pages, bytes);
        for (int trial = 0; trial < 100; trial++) {
            const ast_frame frame = {trial % 2 ? pages.end - bytes : pages.first, width, height, stride};
            const ast_box region = random_region(&noise, &frame, 1, 2000), object = random_region(&noise, &frame, 1, 900);
            ast_view_show(&view, &frame, &region, &object);
            for (int y = 0; y < view.image.height; y++)
                for (int x = 0; x < view.image.width; x++)
                    TEST_ASSERT_EQUAL_HEX8(0xdb, row(&view.image, y)[x]); /* what the pages hold */
        }
        pages_close(&pages);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_without_a_view_the_frame_is_shown);
    RUN_TEST(test_a_small_object_is_shown_by_the_frame_itself);
    RUN_TEST(test_resolution_is_the_objects);
    RUN_TEST(test_resolution_is_that_of_the_part_inside);
    RUN_TEST(test_any_region_is_covered_and_fits);
    RUN_TEST(test_boxes_go_there_and_back);
    RUN_TEST(test_pixels_are_the_resampled_window);
    RUN_TEST(test_pixels_lie_where_the_mapping_says);
    RUN_TEST(test_fine_detail_is_averaged);
    RUN_TEST(test_a_large_frame_shows_what_a_cropped_one_does);
    RUN_TEST(test_memory_is_the_sides);
    RUN_TEST(test_no_byte_outside_the_frame_is_read);
    return UNITY_END();
}
