#include "bag.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support_noise.h"
#include "unity.h"

enum { DIM = 21, STRIDE = 32, N = 3 };

static struct ast_bag bag;
static unsigned char *block;

static void open_bag(int lead, int capacity, int keep_first) {
    struct ast_arena counted = {NULL, 0};
    ast_bag_layout(&bag, DIM, STRIDE, lead, N, capacity, keep_first, &counted);
    TEST_ASSERT_NULL(bag.columns);
    block = malloc(counted.used + AST_ALIGNMENT - 1);
    TEST_ASSERT_NOT_NULL(block);
    struct ast_arena bound = {ast_align(block), 0};
    ast_bag_layout(&bag, DIM, STRIDE, lead, N, capacity, keep_first, &bound);
    TEST_ASSERT_EQUAL_UINT(counted.used, bound.used);
    for (int i = 0; i < (lead + capacity * (N + 1)) * STRIDE; i++) bag.columns[i] = NAN;
}

/* Model number: the basis and mean that its number seeds. */
struct model {
    float mean[DIM], basis[N * STRIDE];
    int rank;
};

static struct model model_of(int number) {
    struct noise noise = {(uint64_t)number};
    struct model model;
    noise_fill(&noise, model.mean, DIM, -1, 1);
    for (int i = 0; i < N * STRIDE; i++) model.basis[i] = NAN;
    for (int l = 0; l < N; l++) noise_fill(&noise, model.basis + l * STRIDE, DIM, -1, 1);
    model.rank = number % (N + 1);
    return model;
}

static void add(int number) {
    const struct model model = model_of(number);
    ast_bag_add(&bag, model.mean, model.basis, model.rank);
}

static void expect(int index, int number) {
    const struct model model = model_of(number);
    const int slot = ast_bag_slot(&bag, index);
    TEST_ASSERT_EQUAL_MEMORY(model.mean, ast_bag_mean(&bag, slot), sizeof model.mean);
    TEST_ASSERT_EQUAL_INT(model.rank, bag.rank[slot]);
    for (int l = 0; l < N; l++) {
        TEST_ASSERT_EQUAL_MEMORY(model.basis + l * STRIDE, ast_bag_basis(&bag, slot) + l * STRIDE, DIM * sizeof(float));
        double along = 0;
        for (int d = 0; d < DIM; d++) along += (double)model.basis[l * STRIDE + d] * (double)model.mean[d];
        TEST_ASSERT_DOUBLE_WITHIN(1e-14 + 100 * ast_real_epsilon(), along, bag.basis_mean[slot * N + l]);
    }
}

void setUp(void) {
    block = NULL;
}
void tearDown(void) {
    free(block);
}

static void test_starts_empty_with_its_lead_only(void) {
    open_bag(4, 5, 0);
    TEST_ASSERT_EQUAL_INT(0, bag.count);
    TEST_ASSERT_EQUAL_INT(4, ast_bag_columns(&bag));
    TEST_ASSERT_EQUAL_INT(0, ast_bag_next(&bag));
}

static void test_holds_the_last_models_oldest_first(void) {
    for (int capacity = 1; capacity <= 10; capacity += 3) {
        for (int lead = 0; lead <= 4; lead += 4) {
            open_bag(lead, capacity, 0);
            for (int number = 1; number <= 3 * capacity + 1; number++) {
                const int next = ast_bag_next(&bag);
                add(number);
                const int held = number < capacity ? number : capacity;
                TEST_ASSERT_EQUAL_INT(held, bag.count);
                TEST_ASSERT_EQUAL_INT(lead + held * (N + 1), ast_bag_columns(&bag));
                TEST_ASSERT_EQUAL_INT(next, ast_bag_slot(&bag, held - 1)); /* the newest went where ast_bag_next said */
                for (int index = 0; index < held; index++) expect(index, number - held + 1 + index);
            }
            free(block);
            block = NULL;
        }
    }
}

/* The first model is the object as the caller gave it: then only the others take turns. */
static void test_keeps_the_first_model_where_asked_to(void) {
    for (int capacity = 2; capacity <= 8; capacity += 3) {
        open_bag(1, capacity, 1);
        for (int number = 1; number <= 3 * capacity + 1; number++) {
            const int next = ast_bag_next(&bag);
            add(number);
            const int held = number < capacity ? number : capacity;
            TEST_ASSERT_EQUAL_INT(held, bag.count);
            TEST_ASSERT_EQUAL_INT(next, ast_bag_slot(&bag, held - 1));
            expect(0, 1);
            TEST_ASSERT_EQUAL_INT(0, ast_bag_slot(&bag, 0));
            for (int index = 1; index < held; index++) expect(index, number - held + 1 + index);
        }
        ast_bag_clear(&bag);
        add(50);
        add(51);
        expect(0, 50);
        expect(1, 51);
        free(block);
        block = NULL;
    }
}

/* There is no other to replace: a bag of one always holds the newest. */
static void test_a_bag_of_one_cannot_keep_the_first(void) {
    open_bag(1, 1, 1);
    for (int number = 1; number < 4; number++) {
        add(number);
        TEST_ASSERT_EQUAL_INT(1, bag.count);
        expect(0, number);
    }
}

/* One matrix: the lead, then n basis vectors and the mean of each slot. The product that scores candidates counts on it. */
static void test_vectors_are_columns_of_one_matrix(void) {
    open_bag(4, 3, 0);
    for (int slot = 0; slot < 3; slot++) {
        TEST_ASSERT_EQUAL_PTR(bag.columns + (4 + slot * (N + 1)) * STRIDE, ast_bag_basis(&bag, slot));
        TEST_ASSERT_EQUAL_PTR(bag.columns + (4 + slot * (N + 1) + N) * STRIDE, ast_bag_mean(&bag, slot));
    }
}

static void test_leaves_the_lead_and_the_padding_alone(void) {
    open_bag(2, 3, 0);
    for (int i = 0; i < 2 * STRIDE; i++) bag.columns[i] = 5.0f;
    for (int number = 0; number < 7; number++) add(number);
    for (int i = 0; i < 2 * STRIDE; i++) TEST_ASSERT_EQUAL_FLOAT(5.0f, bag.columns[i]);
    for (int column = 2; column < ast_bag_columns(&bag); column++)
        for (int d = DIM; d < STRIDE; d++) TEST_ASSERT_FLOAT_IS_NAN(bag.columns[column * STRIDE + d]);
}

static void test_derive_follows_the_vectors(void) {
    open_bag(1, 2, 0);
    add(1);
    add(2);
    const struct model other = model_of(3);
    memcpy(ast_bag_mean(&bag, 1), other.mean, sizeof other.mean);
    for (int l = 0; l < N; l++) memcpy(ast_bag_basis(&bag, 1) + l * STRIDE, other.basis + l * STRIDE, DIM * sizeof(float));
    bag.rank[1] = other.rank;
    ast_bag_derive(&bag, 1);
    expect(0, 1);
    expect(1, 3);
}

/* A new model had no part in the last winner; what the others had is theirs still. */
static void test_a_new_model_has_had_no_say(void) {
    open_bag(1, 3, 1);
    for (int slot = 0; slot < 3; slot++) bag.say[slot] = NAN; /* what was there counts for nothing */
    for (int number = 1; number <= 8; number++) {
        const int next = ast_bag_next(&bag);
        add(number);
        TEST_ASSERT_TRUE(bag.say[next] == 0.0f);
        for (int slot = 0; slot < bag.count; slot++) {
            TEST_ASSERT_TRUE(slot == next || bag.say[slot] == 0.1f * (float)(slot + 1));
            bag.say[slot] = 0.1f * (float)(slot + 1);
        }
    }
}

static void test_clear_forgets_all(void) {
    open_bag(0, 2, 0);
    for (int number = 0; number < 3; number++) add(number);
    ast_bag_clear(&bag);
    TEST_ASSERT_EQUAL_INT(0, bag.count);
    TEST_ASSERT_EQUAL_INT(0, ast_bag_columns(&bag));
    add(8);
    TEST_ASSERT_EQUAL_INT(1, bag.count);
    TEST_ASSERT_EQUAL_INT(0, ast_bag_slot(&bag, 0));
    expect(0, 8);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_starts_empty_with_its_lead_only);
    RUN_TEST(test_holds_the_last_models_oldest_first);
    RUN_TEST(test_keeps_the_first_model_where_asked_to);
    RUN_TEST(test_a_bag_of_one_cannot_keep_the_first);
    RUN_TEST(test_vectors_are_columns_of_one_matrix);
    RUN_TEST(test_leaves_the_lead_and_the_padding_alone);
    RUN_TEST(test_derive_follows_the_vectors);
    RUN_TEST(test_a_new_model_has_had_no_say);
    RUN_TEST(test_clear_forgets_all);
    return UNITY_END();
}
