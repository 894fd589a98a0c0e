#include "arena.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "unity.h"

void setUp(void) {
}
void tearDown(void) {
}

/* Counts and element sizes of a layout, odd ones among them. */
static const struct {
    size_t count, size;
} takes[] = {{1, 1}, {3, 4}, {16, 4}, {17, 4}, {0, 8}, {64, 1}, {65, 1}, {1000, 8}, {1, 200}, {7, 3}};
enum { TAKES = sizeof takes / sizeof takes[0] };

static void test_counting_gives_no_addresses(void) {
    struct ast_arena arena = {NULL, 0};
    for (int i = 0; i < TAKES; i++) TEST_ASSERT_NULL(ast_arena_take(&arena, takes[i].count, takes[i].size));
    TEST_ASSERT_GREATER_THAN_UINT(0, arena.used);
}

static void test_counting_and_binding_use_the_same_bytes(void) {
    struct ast_arena counted = {NULL, 0};
    for (int i = 0; i < TAKES; i++) (void)ast_arena_take(&counted, takes[i].count, takes[i].size);
    unsigned char *block = malloc(counted.used + AST_ALIGNMENT);
    TEST_ASSERT_NOT_NULL(block);
    struct ast_arena bound = {ast_align(block), 0};
    for (int i = 0; i < TAKES; i++) {
        const size_t before = bound.used;
        unsigned char *place = ast_arena_take(&bound, takes[i].count, takes[i].size);
        TEST_ASSERT_EQUAL_PTR(bound.base + before, place);
        memset(place, 0x5a, takes[i].count * takes[i].size); /* the address sanitizer watches the block's end */
    }
    TEST_ASSERT_EQUAL_UINT(counted.used, bound.used);
    free(block);
}

static void test_places_are_aligned_and_do_not_overlap(void) {
    enum { SIZE = 16384 };
    unsigned char *block = malloc(SIZE);
    TEST_ASSERT_NOT_NULL(block);
    struct ast_arena arena = {ast_align(block), 0};
    unsigned char *place[TAKES];
    for (int i = 0; i < TAKES; i++) {
        place[i] = ast_arena_take(&arena, takes[i].count, takes[i].size);
        TEST_ASSERT_EQUAL_UINT(0, (uintptr_t)place[i] % AST_ALIGNMENT);
        memset(place[i], i + 1, takes[i].count * takes[i].size);
    }
    TEST_ASSERT_LESS_THAN_UINT((size_t)SIZE - AST_ALIGNMENT, arena.used);
    for (int i = 0; i < TAKES; i++)
        for (size_t b = 0; b < takes[i].count * takes[i].size; b++) TEST_ASSERT_EQUAL_UINT8(i + 1, place[i][b]);
    free(block);
}

static void test_little_is_lost_to_alignment(void) {
    struct ast_arena arena = {NULL, 0};
    for (size_t bytes = 0; bytes <= 3 * AST_ALIGNMENT; bytes++) {
        const size_t before = arena.used;
        (void)ast_arena_take(&arena, bytes, 1);
        const size_t taken = arena.used - before;
        TEST_ASSERT_GREATER_OR_EQUAL_UINT(bytes, taken);
        TEST_ASSERT_LESS_THAN_UINT(bytes + AST_ALIGNMENT, taken);
    }
}

static void test_align_finds_the_first_aligned_address(void) {
    unsigned char block[4 * AST_ALIGNMENT];
    for (size_t offset = 0; offset < 2 * AST_ALIGNMENT; offset++) {
        unsigned char *aligned = ast_align(block + offset);
        TEST_ASSERT_EQUAL_UINT(0, (uintptr_t)aligned % AST_ALIGNMENT);
        TEST_ASSERT_TRUE(aligned >= block + offset);
        TEST_ASSERT_TRUE(aligned < block + offset + AST_ALIGNMENT);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_counting_gives_no_addresses);
    RUN_TEST(test_counting_and_binding_use_the_same_bytes);
    RUN_TEST(test_places_are_aligned_and_do_not_overlap);
    RUN_TEST(test_little_is_lost_to_alignment);
    RUN_TEST(test_align_finds_the_first_aligned_address);
    return UNITY_END();
}
