/* The threads that share a task: every part once, by one worker at a time, whatever the numbers. */
#include "workers.h"

#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>

#include "unity.h"

enum { MOST_WORKERS = 5, MOST_PARTS = 60 };

static struct ast_workers *workers;
static void *block;

static void open_workers(int count) {
    struct ast_arena counted = {NULL, 0}, arena = {NULL, 0};
    TEST_ASSERT_NULL(ast_workers_layout(count, &counted));
    block = malloc(counted.used + AST_ALIGNMENT);
    TEST_ASSERT_NOT_NULL(block);
    memset(block, 0xff, counted.used + AST_ALIGNMENT);
    arena.base = ast_align(block);
    workers = ast_workers_layout(count, &arena);
    TEST_ASSERT_EQUAL_UINT(counted.used, arena.used);
    TEST_ASSERT_EQUAL_INT(0, ast_workers_start(workers));
}

static void close_workers(void) {
    ast_workers_end(workers);
    free(block);
    block = NULL;
    workers = NULL;
}

void setUp(void) {
}
void tearDown(void) {
    close_workers();
}

/* ---- What is done ---- */

/* Written without locks: the thread sanitizer would see two at one part, or two workers with one number. */
struct tally {
    int done[MOST_PARTS], by[MOST_WORKERS];
    int fail_at; /* a part; -1: none */
};

static int count_part(void *shared, int worker, int part) {
    struct tally *tally = shared;
    tally->done[part]++;
    tally->by[worker]++;
    return part == tally->fail_at ? 100 + part : 0;
}

static int share(int (*part)(void *, int, int), void *shared, int parts) {
    const struct ast_task task = {part, shared, parts, parts % 2};
    return ast_workers_share(workers, &task);
}

static void test_every_part_is_done_once(void) {
    for (int count = 1; count <= MOST_WORKERS; count++) {
        open_workers(count);
        for (int round = 0; round < 20; round++) {
            for (int parts = 0; parts <= MOST_PARTS; parts += round % 7 + 1) {
                struct tally tally = {.fail_at = -1};
                int sum = 0;
                TEST_ASSERT_EQUAL_INT(0, share(count_part, &tally, parts));
                for (int part = 0; part < MOST_PARTS; part++) TEST_ASSERT_EQUAL_INT(part < parts, tally.done[part]);
                for (int worker = 0; worker < count; worker++) sum += tally.by[worker];
                TEST_ASSERT_EQUAL_INT(parts, sum);
            }
        }
        close_workers();
    }
}

/* Those who were woken find a task, or go back to sleep without one. */
static void test_waking_changes_nothing(void) {
    for (int count = 1; count <= MOST_WORKERS; count++) {
        open_workers(count);
        for (int round = 0; round < 50; round++) {
            struct tally tally = {.fail_at = -1};
            ast_workers_wake(workers);
            if (round % 3 == 0) ast_workers_wake(workers);
            if (round % 5 == 0) continue;
            TEST_ASSERT_EQUAL_INT(0, share(count_part, &tally, MOST_PARTS - round % 2));
            for (int part = 0; part < MOST_PARTS - round % 2; part++) TEST_ASSERT_EQUAL_INT(1, tally.done[part]);
        }
        close_workers();
    }
    ast_workers_wake(NULL);
}

static void test_one_worker_needs_no_memory(void) {
    struct ast_arena counted = {NULL, 0};
    TEST_ASSERT_NULL(ast_workers_layout(1, &counted));
    TEST_ASSERT_EQUAL_UINT(0, counted.used);
}

/* One worker does the parts in their order, and none behind the failing one. */
static void test_failure_ends_the_task_and_the_next_one_is_whole(void) {
    for (int count = 1; count <= 3; count++) {
        open_workers(count);
        for (int at = 0; at < MOST_PARTS; at += 3) {
            struct tally tally = {.fail_at = at};
            TEST_ASSERT_EQUAL_INT(100 + at, share(count_part, &tally, MOST_PARTS));
            for (int part = 0; part <= at; part++) TEST_ASSERT_EQUAL_INT(1, tally.done[part]);
            for (int part = at + 1; part < MOST_PARTS; part++) TEST_ASSERT_LESS_OR_EQUAL_INT(count > 1, tally.done[part]);
            struct tally next = {.fail_at = -1};
            TEST_ASSERT_EQUAL_INT(0, share(count_part, &next, MOST_PARTS));
            for (int part = 0; part < MOST_PARTS; part++) TEST_ASSERT_EQUAL_INT(1, next.done[part]);
        }
        close_workers();
    }
}

/* ---- That they are threads ---- */

/* As many parts as workers, of which none returns before all are there: one thread alone would wait for ever. */
struct meeting {
    pthread_barrier_t all;
    int worker[MOST_WORKERS], blocked[MOST_WORKERS];
};

static int meet(void *shared, int worker, int part) {
    struct meeting *meeting = shared;
    sigset_t mask;
    (void)pthread_barrier_wait(&meeting->all);
    (void)pthread_sigmask(SIG_SETMASK, NULL, &mask);
    meeting->worker[part] = worker;
    meeting->blocked[part] = sigismember(&mask, SIGINT) && sigismember(&mask, SIGTERM) && sigismember(&mask, SIGALRM);
    return 0;
}

static void test_parts_are_done_at_the_same_time_and_signals_are_the_callers(void) {
    for (int count = 2; count <= MOST_WORKERS; count++) {
        struct meeting meeting;
        int seen = 0;
        TEST_ASSERT_EQUAL_INT(0, pthread_barrier_init(&meeting.all, NULL, (unsigned)count));
        open_workers(count);
        for (int round = 0; round < 10; round++, seen = 0) {
            TEST_ASSERT_EQUAL_INT(0, share(meet, &meeting, count));
            for (int part = 0; part < count; part++) {
                TEST_ASSERT_EQUAL_INT(meeting.worker[part] > 0, meeting.blocked[part]);
                seen |= 1 << meeting.worker[part];
            }
            TEST_ASSERT_EQUAL_INT((1 << count) - 1, seen);
        }
        close_workers();
        TEST_ASSERT_EQUAL_INT(0, pthread_barrier_destroy(&meeting.all));
    }
}

static void test_threads_come_and_go(void) {
    for (int round = 0; round < 100; round++) {
        open_workers(2 + round % 4);
        if (round % 3 == 0) {
            struct tally tally = {.fail_at = -1};
            TEST_ASSERT_EQUAL_INT(0, share(count_part, &tally, 2));
        }
        close_workers();
    }
    ast_workers_end(NULL);
}

/* What was laid out and never started, as after an error of ast_init. */
static void test_end_without_a_start(void) {
    struct ast_arena counted = {NULL, 0}, arena = {NULL, 0};
    (void)ast_workers_layout(3, &counted);
    block = malloc(counted.used + AST_ALIGNMENT);
    TEST_ASSERT_NOT_NULL(block);
    arena.base = ast_align(block);
    workers = ast_workers_layout(3, &arena);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_every_part_is_done_once);
    RUN_TEST(test_waking_changes_nothing);
    RUN_TEST(test_one_worker_needs_no_memory);
    RUN_TEST(test_failure_ends_the_task_and_the_next_one_is_whole);
    RUN_TEST(test_parts_are_done_at_the_same_time_and_signals_are_the_callers);
    RUN_TEST(test_threads_come_and_go);
    RUN_TEST(test_end_without_a_start);
    return UNITY_END();
}
