/* A step on several threads: the bits of one thread, in the same kind of block. */
#include "asttrack.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support_few_threads.h"
#include "support_render.h"
#include "support_tracker.h"
#include "unity.h"

void setUp(void) {
}
void tearDown(void) {
}

/* ---- A sequence, rendered beforehand ---- */

enum { FRAMES = 12, WIDTH = 96, HEIGHT = 72, MOST_THREADS = 4 };
static uint8_t film[FRAMES * WIDTH * HEIGHT];
static ast_box truth[FRAMES];

static ast_frame frame_at(int f) {
    const ast_frame frame = {film + (size_t)f * WIDTH * HEIGHT, WIDTH, HEIGHT, WIDTH};
    return frame;
}

/* The presets, then small configurations with all ways of scoring, so that the bag fills. */
enum { PRESETS = 3, CASES = PRESETS + SMALL_CONFIGS };
static ast_config case_of(int which) {
    ast_config cfg;
    if (which >= PRESETS) return small_config_of(which - PRESETS);
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&cfg, which));
    TEST_ASSERT_EQUAL_INT(1, cfg.threads);
    cfg.particles += 5; /* the last tile is not full */
    return cfg;
}

/* All that a user sees of a run: every result and every distance, and the state at its end. */
struct run {
    ast_result result[FRAMES];
    float *distance;
    size_t distances;
    struct saved saved;
};

static void run_steps(ast_tracker *t, int from, int to, struct run *run) {
    for (int f = from; f < to; f++) {
        const ast_frame frame = frame_at(f);
        ast_particles particles;
        memset(&run->result[f], 0, sizeof run->result[f]);
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(t, &frame, &run->result[f]));
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(t, &particles));
        const size_t count = (size_t)(particles.scored * particles.models);
        float *more = realloc(run->distance, (run->distances + count) * sizeof *more);
        TEST_ASSERT_NOT_NULL(more);
        memcpy(more + run->distances, particles.distance, count * sizeof *more);
        run->distance = more;
        run->distances += count;
    }
}

static struct run run_of(ast_config cfg, const struct ast_linalg *la, int threads) {
    struct run run = {.distance = NULL};
    const ast_frame first = frame_at(0);
    cfg.threads = threads;
    ast_tracker *t = tracker_new(&cfg, la);
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_start(t, &first, &truth[0]));
    run_steps(t, 1, FRAMES, &run);
    run.saved = saved_from(t);
    ast_free(t);
    return run;
}

static void close_run(struct run *run) {
    free(run->distance);
    saved_free(&run->saved);
}

static void check_same(const struct run *a, const struct run *b, const char *what) {
    TEST_ASSERT_EQUAL_UINT_MESSAGE(a->distances, b->distances, what);
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(a->result, b->result, sizeof a->result, what);
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(a->distance, b->distance, a->distances * sizeof *a->distance, what);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(a->saved.size, b->saved.size, what);
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(a->saved.bytes, b->saved.bytes, a->saved.size, what);
}

/* ---- Bits ---- */

static void test_every_number_of_threads_gives_the_bits_of_one(void) {
    char what[80];
    for (int b = 0; b < BACKENDS; b++) {
        for (int which = 0; which < CASES; which++) {
            const ast_config cfg = case_of(which);
            struct run one = run_of(cfg, backends[b], 1);
            for (int threads = 2; threads <= MOST_THREADS; threads++) {
                struct run run = run_of(cfg, backends[b], threads);
                (void)snprintf(what, sizeof what, "%s, case %d, %d threads", backends[b]->name, which, threads);
                check_same(&one, &run, what);
                close_run(&run);
            }
            close_run(&one);
        }
    }
}

/* More threads than tiles. */
static void test_the_most_threads_with_one_particle(void) {
    ast_config cfg = small_config();
    cfg.particles = 1;
    struct run one = run_of(cfg, backends[0], 1), most = run_of(cfg, backends[0], AST_MAX_THREADS);
    check_same(&one, &most, "one particle");
    close_run(&one);
    close_run(&most);
}

/* The number of threads is no part of the state. */
static void test_state_moves_between_numbers_of_threads(void) {
    enum { HALF = FRAMES / 2 };
    const ast_frame first = frame_at(0);
    for (int which = 0; which < CASES; which++) {
        ast_config one = case_of(which), three = one;
        three.threads = 3;
        struct run here = {.distance = NULL}, there = {.distance = NULL};
        ast_tracker *from = tracker_new(&one, backends[0]), *to = tracker_new(&three, backends[0]);
        TEST_ASSERT_EQUAL_UINT(ast_save_size(&one), ast_save_size(&three));
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_start(from, &first, &truth[0]));
        run_steps(from, 1, HALF, &here);
        struct saved saved = saved_from(from);
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_restore(to, saved.bytes, saved.size));
        saved_check(&saved, to, "restored");
        here.distances = 0;
        memset(here.result, 0, sizeof here.result);
        run_steps(from, HALF, FRAMES, &here);
        run_steps(to, HALF, FRAMES, &there);
        here.saved = saved_from(from);
        there.saved = saved_from(to);
        check_same(&here, &there, "moved");
        saved_free(&saved);
        close_run(&here);
        close_run(&there);
        ast_free(from);
        ast_free(to);
    }
}

/* ---- Memory and errors ---- */

/* The block says how much it needs, and nothing around it is touched. */
static void test_exact_block(void) {
    const ast_frame first = frame_at(0);
    for (int which = 0; which < CASES; which++) {
        ast_config cfg = case_of(which);
        const size_t one = ast_mem_size(&cfg);
        cfg.threads = 3;
        const size_t size = ast_mem_size(&cfg);
        struct guarded block;
        ast_tracker *t = NULL;
        TEST_ASSERT_TRUE(size > one);
        TEST_ASSERT_TRUE(size < 3 * one); /* the state and the maps are shared */
        guarded_open(&block, size, 1, 0xff);
        TEST_ASSERT_EQUAL_INT(AST_E_ARENA, ast_init(&t, &cfg, block.memory, size - 1));
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_init(&t, &cfg, block.memory, size));
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_start(t, &first, &truth[0]));
        for (int f = 1; f < FRAMES; f++) {
            const ast_frame frame = frame_at(f);
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(t, &frame, NULL));
        }
        ast_free(t);
        guarded_check(&block);
        guarded_close(&block);
    }
}

static int refuse_product(int rows, int cols, int depth, const float *a, int lda, const float *b, int ldb, float *c, int ldc) {
    (void)rows, (void)cols, (void)depth, (void)a, (void)lda, (void)b, (void)ldb, (void)c, (void)ldc;
    return -1;
}

/* Whichever thread meets it: the step fails, and the tracker is as it was. */
static void test_failing_backend_fails_the_step(void) {
    struct ast_linalg la = *backends[0];
    ast_config cfg = small_config();
    const ast_frame first = frame_at(0);
    ast_result result;
    cfg.threads = 4;
    cfg.history = cfg.basis_size = 1; /* so that the start makes a model */
    ast_tracker *t = tracker_new(&cfg, &la);
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_start(t, &first, &truth[0]));
    struct saved saved = saved_from(t);
    const ast_frame frame = frame_at(1);
    la.product = refuse_product;
    TEST_ASSERT_EQUAL_INT(AST_E_BACKEND, ast_step(t, &frame, &result));
    saved_check(&saved, t, "after a failing step");
    la.product = backends[0]->product;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(t, &frame, &result));
    saved_free(&saved);
    ast_free(t);
}

/* The system's k-th thread, lock or condition is refused: a clear error, the result untouched, nothing kept. */
static void test_init_without_enough_threads(void) {
    enum { THREADS = 4, LOCKS = 3 };
    ast_config cfg = small_config();
    ast_tracker *const mark = (ast_tracker *)(void *)&cfg;
    ast_tracker *t = mark;
    cfg.threads = THREADS;
    for (int threads = 0; threads < THREADS; threads++) {
        few_threads_left(threads);
        const int expected = threads == THREADS - 1 ? AST_OK : AST_E_THREAD;
        TEST_ASSERT_EQUAL_INT(expected, few_threads_init(&t, &cfg, NULL, 0));
        TEST_ASSERT_EQUAL_INT(expected == AST_OK ? THREADS - 1 + LOCKS : 0, few_threads_held());
        TEST_ASSERT_TRUE((t == mark) == (expected != AST_OK));
    }
    few_threads_free(t);
    TEST_ASSERT_EQUAL_INT(0, few_threads_held());
    t = mark;
    few_threads_left(THREADS);
    for (int locks = 0; locks < LOCKS; locks++) {
        few_threads_locks_left(locks);
        TEST_ASSERT_EQUAL_INT(AST_E_THREAD, few_threads_init(&t, &cfg, NULL, 0));
        TEST_ASSERT_EQUAL_INT(0, few_threads_held());
        TEST_ASSERT_TRUE(t == mark);
    }
    few_threads_locks_left(-1);
}

int main(void) {
    if (backends_prepare() != 0) return 1;
    render_film(film, truth, FRAMES, WIDTH, HEIGHT, 24, 18);
    UNITY_BEGIN();
    RUN_TEST(test_every_number_of_threads_gives_the_bits_of_one);
    RUN_TEST(test_the_most_threads_with_one_particle);
    RUN_TEST(test_state_moves_between_numbers_of_threads);
    RUN_TEST(test_exact_block);
    RUN_TEST(test_failing_backend_fails_the_step);
    RUN_TEST(test_init_without_enough_threads);
    return UNITY_END();
}
