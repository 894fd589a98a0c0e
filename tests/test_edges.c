/* The edges of the memory that the library is given: frames between pages that cannot be touched, with every stride, with nothing
 * behind the last row and nothing between the rows; and frames as large as there can be. */
#define _DEFAULT_SOURCE /* MAP_ANONYMOUS, MAP_NORESERVE */
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "support_noise.h"
#include "support_pages.h"
#include "support_tracker.h"
#include "unity.h"

void setUp(void) {
}
void tearDown(void) {
}

static void fill(const ast_frame *frame, uint64_t seed) {
    struct noise noise = {seed};
    for (int y = 0; y < frame->height; y++) {
        uint8_t *row = (uint8_t *)(uintptr_t)(frame->pixels + (size_t)y * (size_t)frame->stride);
        for (int x = 0; x < frame->width; x++) row[x] = (uint8_t)noise_int(&noise, 0, 255);
    }
}

/* Boxes inside a frame, across each of its sides, around all of it, and far larger than it. */
enum { BOXES = 8 };
static ast_box box_of(int which, const ast_frame *frame) {
    const float w = (float)frame->width, h = (float)frame->height;
    const ast_box boxes[BOXES] = {{0.25f * w, 0.25f * h, 0.5f * w + 1, 0.5f * h + 1},
                                  {-0.4f * w, 0.2f * h, 0.7f * w + 1, 0.5f * h + 1},
                                  {w - 1, h - 1, 5, 7},
                                  {0.2f * w, -3, 0.5f * w + 1, 3.5f},
                                  {-0.5f, -0.5f, 1, 1},
                                  {-2, -2, w + 4, h + 4},
                                  {-30000, -30000, 65535, 65535},
                                  {w - 1.25f, 0, 1, h}};
    return boxes[which];
}

/* Starts and steps that read as much of the frame as boxes and walks can make them. */
static void track_over(ast_tracker *t, const ast_frame *frame, int which) {
    const ast_box box = box_of(which % BOXES, frame);
    const ast_frame frames[2] = {*frame, *frame};
    const ast_box boxes[2] = {box, box};
    ast_result result;
    TEST_ASSERT_EQUAL_INT(AST_OK, which & 1 ? ast_start(t, frame, &box) : ast_start_sequence(t, frames, boxes, 2));
    for (int f = 0; f < 3; f++) TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(t, frame, &result));
}

static ast_config config_of(int which) {
    ast_config cfg = small_config_of(which);
    cfg.particles = 8;
    cfg.history = cfg.basis_size = 2;
    cfg.bag_interval = 1;
    cfg.walk_x = cfg.walk_y = 20.0f;
    return cfg;
}

/* The first byte follows a page that cannot be read, then the last byte precedes one. */
static void test_every_stride(void) {
    static const int shapes[][2] = {{1, 1}, {1, 30}, {30, 1}, {3, 2}, {16, 12}, {33, 21}, {200, 3}};
    for (int which = 0; which < SMALL_CONFIGS; which++) {
        const ast_config cfg = config_of(which);
        ast_tracker *t = tracker_new(&cfg, backends[0]);
        int turn = 0;
        for (size_t s = 0; s < sizeof shapes / sizeof shapes[0]; s++) {
            for (int padding = 0; padding <= 66; padding++) {
                const int width = shapes[s][0], height = shapes[s][1], stride = width + padding;
                const size_t bytes = (size_t)(height - 1) * (size_t)stride + (size_t)width;
                struct pages pages;
                pages_open(&pages, bytes);
                for (int side = 0; side < 2; side++) {
                    const ast_frame frame = {side == 0 ? pages.first : pages.end - bytes, width, height, stride};
                    fill(&frame, (uint64_t)padding + 1);
                    track_over(t, &frame, turn++);
                }
                pages_close(&pages);
            }
        }
        ast_free(t);
    }
}

/* A page that cannot be read behind each row, then before each row: what lies between rows is not the library's either. */
static void test_nothing_between_rows_is_touched(void) {
    static const int shapes[][2] = {{1, 1}, {1, 9}, {2, 2}, {17, 13}, {64, 48}, {300, 5}, {4096, 3}};
    const int stride = pages_row_stride();
    for (int which = 0; which < SMALL_CONFIGS; which++) {
        const ast_config cfg = config_of(which);
        ast_tracker *t = tracker_new(&cfg, backends[0]);
        for (size_t s = 0; s < sizeof shapes / sizeof shapes[0]; s++) {
            const int width = shapes[s][0], height = shapes[s][1];
            struct pages pages;
            pages_open_rows(&pages, height);
            for (int turn = 0; turn < 2 * BOXES; turn++) {
                const ast_frame frame = {turn & 1 ? pages.end - width : pages.first, width, height, stride};
                fill(&frame, (uint64_t)turn + 1);
                track_over(t, &frame, turn / 2);
            }
            pages_close(&pages);
        }
        ast_free(t);
    }
}

/* The same for both sides of a conversion: neither padding nor anything around is read or written. */
static void test_conversions_keep_to_their_rows(void) {
    static int (*const conversions[])(uint8_t *, int32_t, const uint8_t *, int32_t, int32_t,
                                      int32_t) = {ast_grey_from_rgb, ast_grey_from_bgr, ast_grey_from_yuyv, ast_grey_from_rgb565};
    static const int bytes_each[] = {3, 3, 2, 2}, widths[] = {1, 2, 6, 15, 16, 31, 64, 1000}, height = 4;
    const int stride = pages_row_stride();
    struct pages from, to;
    pages_open_rows(&from, height);
    pages_open_rows(&to, height);
    for (int c = 0; c < 4; c++) {
        for (size_t w = 0; w < sizeof widths / sizeof widths[0]; w++) {
            const int width = widths[w], bytes = width * bytes_each[c];
            for (int side = 0; side < 4; side++) {
                uint8_t *dst = side & 1 ? to.end - width : to.first;
                const uint8_t *src = side & 2 ? from.end - bytes : from.first;
                TEST_ASSERT_EQUAL_INT(c == 2 && width % 2 ? AST_E_FRAME : AST_OK,
                                      conversions[c](dst, stride, src, stride, width, height));
            }
        }
    }
    pages_close(&from);
    pages_close(&to);
}

/* A frame of 65535 x 65535, whose last byte's offset needs 32 bits: tracked in each of its corners. Its pages exist where they are
 * touched only. */
static void test_largest_frame(void) {
    const int side = AST_MAX_FRAME;
    if (sizeof(size_t) < 8) {
        static const uint8_t pixel = 0;
        const ast_frame frame = {&pixel, AST_MAX_FRAME, AST_MAX_FRAME, AST_MAX_FRAME};
        const ast_box box = {0, 0, 8, 8};
        const ast_config cfg = config_of(0);
        ast_tracker *t = tracker_new(&cfg, backends[0]);
        TEST_ASSERT_EQUAL_INT(AST_E_FRAME, ast_start(t, &frame, &box)); /* there is no such memory */
        ast_free(t);
        return;
    }
    const size_t size = (size_t)side * (size_t)side, page = (size_t)sysconf(_SC_PAGESIZE), inside = (size + page - 1) / page * page;
    unsigned char *mapping = mmap(NULL, inside + page, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (mapping == MAP_FAILED || mprotect(mapping, inside, PROT_READ | PROT_WRITE) != 0)
        TEST_IGNORE_MESSAGE("no address space for a frame of 65535 x 65535");
    const ast_frame frame = {mapping + inside - size, side, side, side};
    for (int which = 0; which < SMALL_CONFIGS; which++) {
        const ast_config cfg = config_of(which);
        ast_tracker *t = tracker_new(&cfg, backends[0]);
        for (int corner = 0; corner < 4; corner++) {
            const int left = corner & 1 ? side - 40 : 10, top = corner & 2 ? side - 40 : 10;
            const ast_frame part = {frame.pixels + (size_t)top * (size_t)side + (size_t)left, 30, 30, side};
            const ast_box box = {(float)left + 5, (float)top + 5, 20, 20};
            ast_result result;
            fill(&part, 3);
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_start(t, &frame, &box));
            for (int f = 0; f < 4; f++) TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(t, &frame, &result));
        }
        ast_free(t);
    }
    (void)munmap(mapping, inside + page);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_every_stride);
    RUN_TEST(test_nothing_between_rows_is_touched);
    RUN_TEST(test_conversions_keep_to_their_rows);
    RUN_TEST(test_largest_frame);
    return UNITY_END();
}
