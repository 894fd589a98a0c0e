#include "history.h"

#include <math.h>
#include <stdlib.h>

#include "unity.h"

enum { DIM = 5, STRIDE = 16 };

static struct ast_history history;
static unsigned char *block;

static void open_history(int capacity) {
    struct ast_arena counted = {NULL, 0};
    ast_history_layout(&history, DIM, STRIDE, capacity, &counted);
    TEST_ASSERT_NULL(history.patches);
    block = malloc(counted.used + AST_ALIGNMENT - 1);
    TEST_ASSERT_NOT_NULL(block);
    struct ast_arena bound = {ast_align(block), 0};
    ast_history_layout(&history, DIM, STRIDE, capacity, &bound);
    TEST_ASSERT_EQUAL_UINT(counted.used, bound.used);
    TEST_ASSERT_EQUAL_UINT((size_t)capacity * STRIDE * sizeof(float), bound.used);
    for (int i = 0; i < capacity * STRIDE; i++) history.patches[i] = NAN;
}

static void push(int number) {
    float patch[DIM];
    for (int d = 0; d < DIM; d++) patch[d] = (float)(10 * number + d);
    ast_history_push(&history, patch);
    for (int d = 0; d < DIM; d++) patch[d] = NAN; /* the history holds a copy */
}

static void expect(int index, int number) {
    const float *patch = ast_history_patch(&history, index);
    for (int d = 0; d < DIM; d++) TEST_ASSERT_EQUAL_FLOAT((float)(10 * number + d), patch[d]);
}

void setUp(void) {
    block = NULL;
}
void tearDown(void) {
    free(block);
}

static void test_starts_empty(void) {
    open_history(3);
    TEST_ASSERT_EQUAL_INT(0, history.count);
    TEST_ASSERT_EQUAL_INT(3, history.capacity);
}

static void test_holds_the_last_patches_oldest_first(void) {
    for (int capacity = 1; capacity <= AST_MAX_HISTORY; capacity += 2) {
        open_history(capacity);
        for (int number = 1; number <= 3 * capacity + 1; number++) {
            push(number);
            const int held = number < capacity ? number : capacity;
            TEST_ASSERT_EQUAL_INT(held, history.count);
            for (int index = 0; index < held; index++) expect(index, number - held + 1 + index);
        }
        free(block);
        block = NULL;
    }
}

/* State is saved slot by slot: where a patch lies while the ring fills is part of its meaning. */
static void test_fills_its_slots_in_order(void) {
    open_history(4);
    for (int number = 0; number < 4; number++) {
        push(number);
        TEST_ASSERT_EQUAL_INT(0, history.oldest);
        TEST_ASSERT_EQUAL_PTR(history.patches + number * STRIDE, ast_history_patch(&history, number));
    }
    push(4);
    TEST_ASSERT_EQUAL_INT(1, history.oldest);
    TEST_ASSERT_EQUAL_PTR(history.patches, ast_history_patch(&history, 3));
}

static void test_leaves_the_padding_alone(void) {
    open_history(2);
    for (int number = 0; number < 5; number++) push(number);
    for (int slot = 0; slot < 2; slot++)
        for (int d = DIM; d < STRIDE; d++) TEST_ASSERT_FLOAT_IS_NAN(history.patches[slot * STRIDE + d]);
}

static void test_clear_forgets_all(void) {
    open_history(3);
    for (int number = 0; number < 5; number++) push(number);
    ast_history_clear(&history);
    TEST_ASSERT_EQUAL_INT(0, history.count);
    push(9);
    TEST_ASSERT_EQUAL_INT(1, history.count);
    expect(0, 9);
    TEST_ASSERT_EQUAL_PTR(history.patches, ast_history_patch(&history, 0));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_starts_empty);
    RUN_TEST(test_holds_the_last_patches_oldest_first);
    RUN_TEST(test_fills_its_slots_in_order);
    RUN_TEST(test_leaves_the_padding_alone);
    RUN_TEST(test_clear_forgets_all);
    return UNITY_END();
}
