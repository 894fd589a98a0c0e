/* What may be a frame and a box, and the conversions to grey. */
#include "frame.h"

#include <limits.h>
#include <math.h>
#include <string.h>

#include "support_noise.h"
#include "unity.h"

void setUp(void) {
}
void tearDown(void) {
}

static const uint8_t pixel[1] = {0};

static int check(int32_t width, int32_t height, int32_t stride) {
    const ast_frame frame = {pixel, width, height, stride}; /* the check reads no pixel */
    return ast_frame_check(&frame);
}

static void test_frame_sides(void) {
    static const int32_t bad[] = {0, -1, INT32_MIN, AST_MAX_FRAME + 1, INT32_MAX};
    TEST_ASSERT_EQUAL_INT(AST_OK, check(1, 1, 1));
    for (size_t b = 0; b < sizeof bad / sizeof bad[0]; b++) {
        TEST_ASSERT_EQUAL_INT(AST_E_FRAME, check(bad[b], 10, INT32_MAX));
        TEST_ASSERT_EQUAL_INT(AST_E_FRAME, check(10, bad[b], 10));
    }
}

static void test_frame_stride(void) {
    TEST_ASSERT_EQUAL_INT(AST_OK, check(10, 5, 10));
    TEST_ASSERT_EQUAL_INT(AST_OK, check(10, 1, INT32_MAX));
    TEST_ASSERT_EQUAL_INT(AST_E_FRAME, check(10, 5, 9));
    TEST_ASSERT_EQUAL_INT(AST_E_FRAME, check(10, 5, 0));
    TEST_ASSERT_EQUAL_INT(AST_E_FRAME, check(10, 5, -10));
    TEST_ASSERT_EQUAL_INT(AST_E_FRAME, check(10, 5, INT32_MIN));
}

/* Frames that are no more than addresses allow: with 32 bits the largest are not, with 64 all are. */
static void test_frame_fits_memory(void) {
    const int code = sizeof(size_t) < 8 ? AST_E_FRAME : AST_OK;
    const uint8_t white[6] = {255, 255, 255, 255, 255, 255};
    uint8_t grey[1] = {0};
    TEST_ASSERT_EQUAL_INT(code, check(AST_MAX_FRAME, AST_MAX_FRAME, AST_MAX_FRAME));
    TEST_ASSERT_EQUAL_INT(code, check(10, 2, INT32_MAX));
    TEST_ASSERT_EQUAL_INT(AST_OK, check(AST_MAX_FRAME, 30000, AST_MAX_FRAME));
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_grey_from_rgb(grey, INT32_MAX, white, INT32_MAX, 1, 1));
    TEST_ASSERT_EQUAL_HEX8(255, grey[0]);
    if (code == AST_OK) return;
    TEST_ASSERT_EQUAL_INT(code, ast_grey_from_rgb(grey, INT32_MAX, white, 3, 1, 2));
    TEST_ASSERT_EQUAL_INT(code, ast_grey_from_rgb565(grey, 1, white, INT32_MAX, 1, 2));
}

static void test_frame_null(void) {
    const ast_frame none = {NULL, 10, 10, 10};
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, ast_frame_check(NULL));
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, ast_frame_check(&none));
}

static int box_check(float x, float y, float w, float h) {
    const ast_frame frame = {pixel, 100, 50, 100};
    const ast_box box = {x, y, w, h};
    return ast_box_check(&box, &frame);
}

static void test_box_sides(void) {
    static const float bad[] = {0.0f, 0.999f, -1.0f, -INFINITY, INFINITY, NAN, 65536.0f, 3e38f};
    TEST_ASSERT_EQUAL_INT(AST_OK, box_check(0, 0, 1, 1));
    TEST_ASSERT_EQUAL_INT(AST_OK, box_check(-10, -10, AST_MAX_FRAME, AST_MAX_FRAME));
    for (size_t b = 0; b < sizeof bad / sizeof bad[0]; b++) {
        TEST_ASSERT_EQUAL_INT(AST_E_BOX, box_check(10, 10, bad[b], 5));
        TEST_ASSERT_EQUAL_INT(AST_E_BOX, box_check(10, 10, 5, bad[b]));
    }
}

static void test_box_position(void) {
    static const float bad[] = {-INFINITY, INFINITY, NAN, -3e38f, 3e38f};
    for (size_t b = 0; b < sizeof bad / sizeof bad[0]; b++) {
        TEST_ASSERT_EQUAL_INT(AST_E_BOX, box_check(bad[b], 10, 5, 5));
        TEST_ASSERT_EQUAL_INT(AST_E_BOX, box_check(10, bad[b], 5, 5));
    }
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, ast_box_check(NULL, &(ast_frame){pixel, 1, 1, 1}));
}

/* A box that shares any area with the frame is legal; one that only touches its edge is outside. */
static void test_box_overlaps_the_frame(void) {
    TEST_ASSERT_EQUAL_INT(AST_OK, box_check(99.9f, 20, 10, 10));
    TEST_ASSERT_EQUAL_INT(AST_E_BOX, box_check(100.0f, 20, 10, 10));
    TEST_ASSERT_EQUAL_INT(AST_OK, box_check(-9.9f, 20, 10, 10));
    TEST_ASSERT_EQUAL_INT(AST_E_BOX, box_check(-10.0f, 20, 10, 10));
    TEST_ASSERT_EQUAL_INT(AST_OK, box_check(20, 49.9f, 10, 10));
    TEST_ASSERT_EQUAL_INT(AST_E_BOX, box_check(20, 50.0f, 10, 10));
    TEST_ASSERT_EQUAL_INT(AST_OK, box_check(20, -9.9f, 10, 10));
    TEST_ASSERT_EQUAL_INT(AST_E_BOX, box_check(20, -10.0f, 10, 10));
}

/* ---- Conversions ---- */

typedef int (*converter)(uint8_t *dst, int32_t dst_stride, const uint8_t *src, int32_t src_stride, int32_t width, int32_t height);

/* ITU-R BT.601 in double; a result whose fraction is very near one half may go either way. */
static void assert_luma(double red, double green, double blue, uint8_t grey) {
    const double exact = 0.299 * red + 0.587 * green + 0.114 * blue;
    TEST_ASSERT_TRUE(fabs(exact - grey) <= 0.502);
}

static void test_rgb_and_bgr_over_the_colour_cube(void) {
    for (int r = 0; r < 256; r += 5) {
        for (int g = 0; g < 256; g += 3) {
            uint8_t rgb[3 * 52], bgr[3 * 52], from_rgb[52], from_bgr[52];
            for (int i = 0; i < 52; i++) {
                rgb[3 * i] = bgr[3 * i + 2] = (uint8_t)r;
                rgb[3 * i + 1] = bgr[3 * i + 1] = (uint8_t)g;
                rgb[3 * i + 2] = bgr[3 * i] = (uint8_t)(5 * i);
            }
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_grey_from_rgb(from_rgb, 52, rgb, 156, 52, 1));
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_grey_from_bgr(from_bgr, 52, bgr, 156, 52, 1));
            for (int i = 0; i < 52; i++) assert_luma(r, g, 5 * i, from_rgb[i]);
            TEST_ASSERT_EQUAL_MEMORY(from_rgb, from_bgr, 52);
        }
    }
}

static void test_grey_stays_grey(void) {
    for (int v = 0; v < 256; v++) {
        const uint8_t rgb[3] = {(uint8_t)v, (uint8_t)v, (uint8_t)v};
        uint8_t grey = 77;
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_grey_from_rgb(&grey, 1, rgb, 3, 1, 1));
        TEST_ASSERT_EQUAL_UINT8(v, grey);
    }
}

static void test_rgb565_over_all_its_words(void) {
    for (unsigned word = 0; word < 65536; word++) {
        const uint8_t bytes[2] = {(uint8_t)(word & 255), (uint8_t)(word >> 8)};
        uint8_t grey = 77;
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_grey_from_rgb565(&grey, 1, bytes, 2, 1, 1));
        /* full scale of each channel is 255; widening by repeated bits is within 0.75 of that, rounding adds a half */
        const double red = (word >> 11) * 255.0 / 31, green = (word >> 5 & 63) * 255.0 / 63, blue = (word & 31) * 255.0 / 31;
        TEST_ASSERT_TRUE(fabs(0.299 * red + 0.587 * green + 0.114 * blue - grey) <= 1.25);
        if (word == 0) TEST_ASSERT_EQUAL_UINT8(0, grey);
        if (word == 65535) TEST_ASSERT_EQUAL_UINT8(255, grey);
    }
}

static void test_yuyv_keeps_its_luma(void) {
    static const uint8_t yuyv[2][8] = {{10, 1, 20, 2, 30, 3, 40, 4}, {50, 5, 60, 6, 70, 7, 80, 8}};
    static const uint8_t expected[2][4] = {{10, 20, 30, 40}, {50, 60, 70, 80}};
    uint8_t grey[2][4];
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_grey_from_yuyv(&grey[0][0], 4, &yuyv[0][0], 8, 4, 2));
    TEST_ASSERT_EQUAL_MEMORY(expected, grey, sizeof grey);
    memset(grey, 9, sizeof grey);
    TEST_ASSERT_EQUAL_INT(AST_E_FRAME, ast_grey_from_yuyv(&grey[0][0], 4, &yuyv[0][0], 8, 3, 2));
    TEST_ASSERT_EQUAL_UINT8(9, grey[0][0]);
}

/* With padding on both sides: rows land where the strides say, and nothing between them is touched. */
static void test_conversions_keep_to_their_strides(void) {
    static const struct {
        converter convert;
        int bytes;
    } kinds[] = {{ast_grey_from_rgb, 3}, {ast_grey_from_bgr, 3}, {ast_grey_from_yuyv, 2}, {ast_grey_from_rgb565, 2}};
    enum { WIDTH = 6, HEIGHT = 4, IN = 25, OUT = 11 };
    struct noise noise = {3};
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
        uint8_t in[HEIGHT][IN], out[HEIGHT][OUT], packed[HEIGHT][3 * WIDTH], expected[HEIGHT][WIDTH];
        const int row = kinds[k].bytes * WIDTH;
        for (int r = 0; r < HEIGHT; r++)
            for (int c = 0; c < IN; c++) in[r][c] = (uint8_t)noise_bits(&noise);
        memset(out, 0xee, sizeof out);
        TEST_ASSERT_EQUAL_INT(AST_OK, kinds[k].convert(&out[0][0], OUT, &in[0][0], IN, WIDTH, HEIGHT));
        for (int r = 0; r < HEIGHT; r++) {
            memcpy(packed[r], in[r], (size_t)row);
            TEST_ASSERT_EQUAL_INT(AST_OK, kinds[k].convert(expected[r], WIDTH, packed[r], row, WIDTH, 1));
            TEST_ASSERT_EQUAL_MEMORY(expected[r], out[r], WIDTH);
            for (int c = WIDTH; c < OUT; c++) TEST_ASSERT_EQUAL_HEX8(0xee, out[r][c]);
        }
    }
}

static void test_conversions_refuse_what_cannot_be(void) {
    static const struct {
        converter convert;
        int bytes;
    } kinds[] = {{ast_grey_from_rgb, 3}, {ast_grey_from_bgr, 3}, {ast_grey_from_yuyv, 2}, {ast_grey_from_rgb565, 2}};
    static const int32_t bad[] = {0, -2, INT32_MIN, AST_MAX_FRAME + 1, INT32_MAX - 1};
    const uint8_t in[24] = {0};
    uint8_t out[8] = {0};
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
        const converter convert = kinds[k].convert;
        const int row = 4 * kinds[k].bytes;
        TEST_ASSERT_EQUAL_INT(AST_OK, convert(out, 4, in, row, 4, 2));
        TEST_ASSERT_EQUAL_INT(AST_E_NULL, convert(NULL, 4, in, row, 4, 2));
        TEST_ASSERT_EQUAL_INT(AST_E_NULL, convert(out, 4, NULL, row, 4, 2));
        TEST_ASSERT_EQUAL_INT(AST_E_FRAME, convert(out, 3, in, row, 4, 2));
        TEST_ASSERT_EQUAL_INT(AST_E_FRAME, convert(out, -4, in, row, 4, 2));
        TEST_ASSERT_EQUAL_INT(AST_E_FRAME, convert(out, 4, in, row - 1, 4, 2));
        TEST_ASSERT_EQUAL_INT(AST_E_FRAME, convert(out, 4, in, -row, 4, 2));
        for (size_t b = 0; b < sizeof bad / sizeof bad[0]; b++) {
            TEST_ASSERT_EQUAL_INT(AST_E_FRAME, convert(out, INT32_MAX, in, INT32_MAX, bad[b], 2));
            TEST_ASSERT_EQUAL_INT(AST_E_FRAME, convert(out, 4, in, row, 4, bad[b]));
        }
    }
}

/* Of a box of 10 x 20 pixels in a frame of 40 x 30. */
static void test_share_of_a_box_inside_the_frame(void) {
    static const struct {
        float x, y, share;
    } places[] = {{5, 5, 1},     {0, 0, 1},           {30, 10, 1},     {-5, 5, 0.5f},  {-10, 5, 0},      {-50, 5, 0},
                  {35, 5, 0.5f}, {37.5f, 20, 0.125f}, {5, -15, 0.25f}, {5, 25, 0.25f}, {-5, -10, 0.25f}, {40, 30, 0}};
    const uint8_t black = 0;
    const ast_frame frame = {&black, 40, 30, 40};
    const ast_box larger = {-40, -15, 80, 60};
    for (size_t p = 0; p < sizeof places / sizeof places[0]; p++) {
        const ast_box box = {places[p].x, places[p].y, 10, 20};
        TEST_ASSERT_EQUAL_FLOAT(places[p].share, ast_frame_share(&frame, &box));
    }
    TEST_ASSERT_EQUAL_FLOAT(0.25f, ast_frame_share(&frame, &larger));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_share_of_a_box_inside_the_frame);
    RUN_TEST(test_frame_sides);
    RUN_TEST(test_frame_stride);
    RUN_TEST(test_frame_fits_memory);
    RUN_TEST(test_frame_null);
    RUN_TEST(test_box_sides);
    RUN_TEST(test_box_position);
    RUN_TEST(test_box_overlaps_the_frame);
    RUN_TEST(test_rgb_and_bgr_over_the_colour_cube);
    RUN_TEST(test_grey_stays_grey);
    RUN_TEST(test_rgb565_over_all_its_words);
    RUN_TEST(test_yuyv_keeps_its_luma);
    RUN_TEST(test_conversions_keep_to_their_strides);
    RUN_TEST(test_conversions_refuse_what_cannot_be);
    return UNITY_END();
}
