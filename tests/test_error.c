/* The return codes: frozen values, a text for any int, and every one of them reached. */
#include "asttrack.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "backend.h"
#include "support_faulty.h"
#include "support_few_threads.h"
#include "support_heap.h"
#include "support_tracker.h"
#include "unity.h"

static ast_config cfg;
static uint8_t pixels[32 * 24];
static const ast_frame frame = {pixels, 32, 24, 32};
static const ast_box box = {10, 8, 12, 8};
static ast_tracker *fresh, *started;

void setUp(void) {
    for (size_t i = 0; i < sizeof pixels; i++) pixels[i] = (uint8_t)(i * i / 7);
    cfg = small_config();
    fresh = tracker_new(&cfg, backends[0]);
    started = tracker_new(&cfg, backends[0]);
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_start(started, &frame, &box));
}
void tearDown(void) {
    ast_free(fresh);
    ast_free(started);
}

/* ---- A call for each code ---- */

static int reach_ok(void) {
    return ast_step(started, &frame, NULL);
}

static int reach_null(void) {
    return ast_step(NULL, &frame, NULL);
}

static int reach_config(void) {
    cfg.particles = 0;
    return ast_config_check(&cfg, NULL);
}

static int reach_struct_size(void) {
    cfg.struct_size--;
    return ast_config_check(&cfg, NULL);
}

static int reach_arena(void) {
    unsigned char block[64];
    ast_tracker *t = NULL;
    return ast_init(&t, &cfg, block, sizeof block);
}

static int reach_out_of_memory(void) {
    ast_tracker *t = NULL;
    const int code = full_heap_init(&t, &cfg, NULL, 0);
    TEST_ASSERT_NULL(t);
    return code;
}

static int reach_no_heap(void) {
    ast_tracker *t = NULL;
    const int code = no_heap_init(&t, &cfg, NULL, 0);
    TEST_ASSERT_NULL(t);
    return code;
}

static int reach_thread(void) {
    ast_tracker *t = NULL;
    cfg.threads = 3;
    few_threads_left(1); /* so that the first must be ended again */
    const int code = few_threads_init(&t, &cfg, NULL, 0);
    TEST_ASSERT_NULL(t);
    return code;
}

static int reach_frame(void) {
    const ast_frame narrow = {pixels, 32, 24, 31};
    return ast_step(started, &narrow, NULL);
}

static int reach_box(void) {
    const ast_box outside = {100, 8, 12, 8};
    return ast_start(started, &frame, &outside);
}

static int reach_not_started(void) {
    return ast_step(fresh, &frame, NULL);
}

static int reach_range(void) {
    ast_subspace model;
    return ast_get_model(started, 0, &model); /* the bag has none yet */
}

static int reach_backend(void) {
    ast_tracker *t = NULL;
    cfg.history = cfg.basis_size = 1; /* so that the start makes a model */
    faulty_arm(backends[0], 1);
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_init_backend(&t, &cfg, &faulty_linalg, NULL, 0));
    const int code = ast_start(t, &frame, &box);
    ast_free(t);
    return code;
}

static int reach_buffer(void) {
    unsigned char byte;
    return ast_save(started, &byte, 1);
}

static int reach_corrupt(void) {
    static const unsigned char bytes[100] = {0};
    return ast_restore(started, bytes, sizeof bytes);
}

static int reach_mismatch(void) {
    ast_config other = cfg;
    struct saved saved = saved_from(started);
    other.seed++;
    ast_tracker *t = tracker_new(&other, backends[0]);
    const int code = ast_restore(t, saved.bytes, saved.size);
    saved_free(&saved);
    ast_free(t);
    return code;
}

#define CODE(name, value, reach)                                                                                                   \
    { #name, name, value, reach }
static const struct {
    const char *name;
    int code, frozen;
    int (*reach)(void);
} codes[] = {
    CODE(AST_OK, 0, reach_ok),
    CODE(AST_E_NULL, -1, reach_null),
    CODE(AST_E_CONFIG, -2, reach_config),
    CODE(AST_E_STRUCT_SIZE, -3, reach_struct_size),
    CODE(AST_E_ARENA, -10, reach_arena),
    CODE(AST_E_OUT_OF_MEMORY, -11, reach_out_of_memory),
    CODE(AST_E_NO_HEAP, -12, reach_no_heap),
    CODE(AST_E_THREAD, -13, reach_thread),
    CODE(AST_E_FRAME, -20, reach_frame),
    CODE(AST_E_BOX, -21, reach_box),
    CODE(AST_E_NOT_STARTED, -22, reach_not_started),
    CODE(AST_E_RANGE, -23, reach_range),
    CODE(AST_E_BACKEND, -30, reach_backend),
    CODE(AST_E_BUFFER, -40, reach_buffer),
    CODE(AST_E_CORRUPT, -41, reach_corrupt),
    CODE(AST_E_MISMATCH, -42, reach_mismatch),
};
enum { CODES = sizeof codes / sizeof codes[0] };

static int index_of(int code) {
    for (int c = 0; c < CODES; c++)
        if (codes[c].code == code) return c;
    return -1;
}

static void test_every_code_is_reached(void) {
    for (int c = 0; c < CODES; c++) {
        TEST_ASSERT_EQUAL_INT_MESSAGE(codes[c].code, codes[c].reach(), codes[c].name);
        tearDown();
        setUp();
    }
}

static void test_values_are_frozen(void) {
    for (int c = 0; c < CODES; c++) TEST_ASSERT_EQUAL_INT_MESSAGE(codes[c].frozen, codes[c].code, codes[c].name);
}

/* The table above against the header's own text: a code that is added there must be reached here. */
static void test_table_has_every_code_of_the_header(void) {
    char path[512], line[512];
    const char *slash = strrchr(__FILE__, '/');
    snprintf(path, sizeof path, "%.*s../include/asttrack.h", slash != NULL ? (int)(slash - __FILE__ + 1) : 0, __FILE__);
    FILE *header = fopen(path, "r");
    int found = 1; /* AST_OK */
    if (header == NULL) TEST_FAIL_MESSAGE(path);
    while (fgets(line, sizeof line, header) != NULL) {
        char name[64];
        int value;
        if (sscanf(line, " AST_E_%50[A-Z_] = %d", name, &value) != 2) continue;
        const int c = index_of(value);
        TEST_ASSERT_TRUE_MESSAGE(c > 0, line);
        TEST_ASSERT_EQUAL_STRING(codes[c].name + strlen("AST_E_"), name);
        found++;
    }
    (void)fclose(header);
    TEST_ASSERT_EQUAL_INT(CODES, found);
}

/* ---- Texts ---- */

static void assert_text(int code) {
    const char *text = ast_strerror(code), *unknown = ast_strerror(12345);
    TEST_ASSERT_NOT_NULL(text);
    TEST_ASSERT_TRUE(strlen(text) > 5);
    TEST_ASSERT_NULL(strchr(text, '\n'));
    if (index_of(code) < 0)
        TEST_ASSERT_EQUAL_STRING(unknown, text);
    else
        TEST_ASSERT_TRUE_MESSAGE(strcmp(unknown, text) != 0, text);
}

static void test_strerror_is_total(void) {
    for (int code = -1000; code <= 1000; code++) assert_text(code);
    assert_text(INT_MIN);
    assert_text(INT_MAX);
}

static void test_texts_differ(void) {
    for (int a = 0; a < CODES; a++)
        for (int b = 0; b < a; b++) TEST_ASSERT_TRUE(strcmp(ast_strerror(codes[a].code), ast_strerror(codes[b].code)) != 0);
}

static void test_version_is_that_of_the_header(void) {
    char expected[64];
    snprintf(expected, sizeof expected, "%d.%d.%d", AST_VERSION_MAJOR, AST_VERSION_MINOR, AST_VERSION_PATCH);
    TEST_ASSERT_EQUAL_STRING(expected, ast_version());
}

static void test_backend_is_one_of_the_two(void) {
    TEST_ASSERT_TRUE(strcmp(ast_backend(), "builtin") == 0 || strcmp(ast_backend(), "lapacke") == 0);
    TEST_ASSERT_EQUAL_STRING(ast_default_linalg()->name, ast_backend());
}

/* ---- ast_init ---- */

static void test_failed_init_leaves_its_result_alone(void) {
    ast_tracker *const mark = started;
    ast_tracker *t = mark;
    unsigned char block[64];
    ast_config bad = cfg;
    bad.history = 0;
    TEST_ASSERT_EQUAL_INT(AST_E_CONFIG, ast_init(&t, &bad, NULL, 0));
    TEST_ASSERT_EQUAL_INT(AST_E_ARENA, ast_init(&t, &cfg, block, sizeof block));
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, ast_init(&t, NULL, NULL, 0));
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, ast_init(NULL, &cfg, NULL, 0));
    TEST_ASSERT_EQUAL_INT(AST_E_OUT_OF_MEMORY, full_heap_init(&t, &cfg, NULL, 0));
    TEST_ASSERT_EQUAL_INT(AST_E_NO_HEAP, no_heap_init(&t, &cfg, NULL, 0));
    faulty_arm(backends[0], 0);
    faulty_prepare_fails(1);
    TEST_ASSERT_EQUAL_INT(AST_E_BACKEND, ast_init_backend(&t, &cfg, &faulty_linalg, NULL, 0)); /* and keeps no block */
    TEST_ASSERT_TRUE(t == mark);
}

/* Without a heap a caller's block works as ever. */
static void test_builds_without_heap_take_a_block(void) {
    const size_t size = ast_mem_size(&cfg);
    void *block = malloc(size);
    ast_tracker *t = NULL;
    TEST_ASSERT_NOT_NULL(block);
    TEST_ASSERT_EQUAL_INT(AST_E_ARENA, no_heap_init(&t, &cfg, block, size - 1));
    TEST_ASSERT_EQUAL_INT(AST_OK, no_heap_init(&t, &cfg, block, size));
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_start(t, &frame, &box));
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(t, &frame, NULL));
    no_heap_free(t);
    no_heap_free(NULL);
    TEST_ASSERT_EQUAL_INT(AST_OK, full_heap_init(&t, &cfg, block, size));
    full_heap_free(t);
    free(block);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_every_code_is_reached);
    RUN_TEST(test_values_are_frozen);
    RUN_TEST(test_table_has_every_code_of_the_header);
    RUN_TEST(test_strerror_is_total);
    RUN_TEST(test_texts_differ);
    RUN_TEST(test_version_is_that_of_the_header);
    RUN_TEST(test_backend_is_one_of_the_two);
    RUN_TEST(test_failed_init_leaves_its_result_alone);
    RUN_TEST(test_builds_without_heap_take_a_block);
    return UNITY_END();
}
