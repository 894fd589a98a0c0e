/* What the library promises about memory: one block whose size the configuration alone decides, nothing else ever. */
#define _GNU_SOURCE
#include "support_allocation.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#ifdef AST_TEST_LAPACKE
#include <lapacke.h>
#endif

#include "support_faulty.h"
#include "support_render.h"
#include "support_tracker.h"
#include "unity.h"

void setUp(void) {
}
void tearDown(void) {
}

/* ---- A sequence, rendered beforehand ---- */

enum { FRAMES = 50, WIDTH = 64, HEIGHT = 48 };
static uint8_t film[FRAMES * WIDTH * HEIGHT];
static ast_box truth[FRAMES];

static ast_frame frame_at(int f) {
    const ast_frame frame = {film + (size_t)(f % FRAMES) * WIDTH * HEIGHT, WIDTH, HEIGHT, WIDTH};
    return frame;
}

static int start_and_step(ast_tracker *t, int steps, ast_result *results) {
    const ast_frame first = frame_at(0);
    int code = ast_start(t, &first, &truth[0]);
    for (int f = 1; f <= steps && code == AST_OK; f++) {
        const ast_frame frame = frame_at(f);
        code = ast_step(t, &frame, results != NULL ? &results[f - 1] : NULL);
    }
    return code;
}

/* Configurations with every array at another size: the least, two with all parts, a long history; then the small ones. */
enum { CONFIGS = 3 + SMALL_CONFIGS };
static ast_config config_of(int which) {
    ast_config cfg = which < 3 ? small_config() : small_config_of(which - 3);
    if (which == 0) {
        cfg.particles = cfg.history = cfg.basis_size = cfg.bag_size = cfg.bag_interval = 1;
        cfg.patch_width = cfg.patch_height = 4;
    } else if (which < 3) {
        cfg.scoring = which == 1 ? AST_SCORING_GRAM : AST_SCORING_LITERAL;
        cfg.particles = AST_TILE + 1;
        cfg.patch_width = 13;
        cfg.patch_height = 11;
        cfg.history = AST_MAX_HISTORY;
        cfg.basis_size = AST_MAX_BASIS;
        cfg.bag_size = 5;
    }
    return cfg;
}

/* ---- Allocations ---- */

static void test_counter_sees_allocations(void) {
    long before = allocations();
    void *volatile block = malloc(100);
    TEST_ASSERT_EQUAL_INT(before + 1, allocations());
    free(block);
    TEST_ASSERT_EQUAL_INT(before + 2, allocations());
    before = allocations();
    FILE *volatile stream = fopen("/dev/null", "r"); /* inside the C library */
    TEST_ASSERT_NOT_NULL(stream);
    TEST_ASSERT_TRUE(allocations() > before);
    (void)fclose(stream);
#ifdef AST_TEST_LAPACKE
    double a[4] = {1, 2, 3, 4}, values[2], unused[1], superb[2];
    before = allocations();
    TEST_ASSERT_EQUAL_INT(0, LAPACKE_dgesvd(LAPACK_ROW_MAJOR, 'N', 'N', 2, 2, a, 2, values, unused, 2, unused, 2, superb));
    TEST_ASSERT_TRUE(allocations() > before); /* LAPACKE's comfortable calls do */
#endif
}

/* Everything that a program does after ast_init, a thousand steps of it; a hundred when watched, as each tells the same. */
static void use_fully(ast_tracker *t, unsigned char *buffer, size_t size) {
    const ast_frame first[] = {frame_at(0), frame_at(1), frame_at(2)};
    ast_particles particles;
    ast_subspace model;
    const float *patch;
    TEST_ASSERT_EQUAL_INT(AST_OK, start_and_step(t, WATCHED ? 100 : 1000, NULL));
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_save(t, buffer, size));
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_start_sequence(t, first, truth, 3));
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_restore(t, buffer, size));
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(t, &particles));
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_model(t, 0, &model));
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_history(t, 0, &patch));
    TEST_ASSERT_EQUAL_INT(AST_E_RANGE, ast_get_history(t, 99, &patch));
}

static void test_nothing_is_allocated_after_init(void) {
    for (int b = 0; b < BACKENDS; b++) {
        for (int which = 0; which < SMALL_CONFIGS; which++) {
            ast_config cfg = small_config_of(which);
            cfg.patch_width = cfg.patch_height = 16;
            ast_tracker *t = tracker_new(&cfg, backends[b]);
            const size_t size = ast_save_size(&cfg);
            unsigned char *buffer = malloc(size);
            TEST_ASSERT_NOT_NULL(buffer);
            const long before = allocations();
            use_fully(t, buffer, size);
            TEST_ASSERT_EQUAL_INT_MESSAGE(before, allocations(), backends[b]->name);
            free(buffer);
            ast_free(t);
        }
    }
}

/* The presets' sizes: long vectors and wide products, for which a BLAS has other ways. */
static void test_nothing_is_allocated_at_the_presets_sizes(void) {
    static const int presets[] = {AST_PRESET_PAPER, AST_PRESET_PAPER, AST_PRESET_ROBUST, AST_PRESET_COMPACT, AST_PRESET_TINY};
    for (int b = 0; b < BACKENDS; b++) {
        for (int which = 0; which < 5; which++) {
            ast_config cfg;
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&cfg, presets[which]));
            if (which == 0) {
                cfg.scoring = AST_SCORING_LITERAL;
                cfg.particles = AST_TILE;
            }
            ast_tracker *t = tracker_new(&cfg, backends[b]);
            const long before = allocations();
            TEST_ASSERT_EQUAL_INT(AST_OK, start_and_step(t, 13, NULL));
            TEST_ASSERT_EQUAL_INT_MESSAGE(before, allocations(), backends[b]->name);
            ast_free(t);
        }
    }
}

static int meet(void *barrier, int worker, int part) {
    (void)worker, (void)part;
    (void)pthread_barrier_wait(barrier);
    return 0;
}

/* Until a tracker's threads have begun, which under a sanitizer takes memory: none does a part before all have one. */
static void wait_for_threads(ast_tracker *t, int threads) {
    pthread_barrier_t all;
    const struct ast_task meeting = {meet, &all, threads, 0};
    TEST_ASSERT_EQUAL_INT(0, pthread_barrier_init(&all, NULL, (unsigned)threads));
    TEST_ASSERT_EQUAL_INT(0, ast_workers_share(t->workers, &meeting));
    TEST_ASSERT_EQUAL_INT(0, pthread_barrier_destroy(&all));
}

/* A step on several threads: the builtin backend never, OpenBLAS once more a thread, as below. */
static void test_threaded_steps_allocate_nothing(void) {
    for (int b = 0; b < BACKENDS; b++) {
        long total = 0;
        enum { SHARING = 3 };
        for (int which = 0; which < SMALL_CONFIGS; which++) {
            ast_config cfg = small_config_of(which);
            cfg.patch_width = cfg.patch_height = 24;
            cfg.threads = SHARING;
            ast_tracker *t = tracker_new(&cfg, backends[b]);
            wait_for_threads(t, SHARING);
            const long before = allocations();
            TEST_ASSERT_EQUAL_INT(AST_OK, start_and_step(t, 200, NULL));
            total += allocations() - before;
            ast_free(t);
        }
        TEST_ASSERT_TRUE_MESSAGE(total <= (backends[b] == &ast_linalg_builtin ? 0 : SHARING - 1), backends[b]->name);
    }
}

static void test_geometry_allocates_nothing(void) {
    enum { DIM = 64, COUNT = 4, N = 3 };
    static float images[DIM * COUNT], mean[2][DIM], basis[2][DIM * N];
    ast_subspace a, b;
    ast_distance distance;
    const size_t size = ast_subspace_work_size(DIM, COUNT);
    void *work = malloc(size);
    TEST_ASSERT_NOT_NULL(work);
    for (int i = 0; i < DIM * COUNT; i++) images[i] = (float)film[7 * i];
    const long before = allocations();
    TEST_ASSERT_EQUAL_INT(AST_OK,
                          ast_subspace_fit(images, DIM, DIM, COUNT, AST_BASIS_CENTRED, N, mean[0], basis[0], &a, work, size));
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_subspace_fit(images, DIM, DIM, COUNT, AST_BASIS_RAW, N, mean[1], basis[1], &b, work, size));
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_subspace_distance(&a, &b, 1.0f, &distance, work, size));
    TEST_ASSERT_EQUAL_INT(before, allocations());
    free(work);
}

static void test_own_block_is_one_allocation(void) {
    const ast_config cfg = small_config();
    for (int b = 0; b < BACKENDS; b++) {
        ast_tracker *t = NULL;
        ast_free(tracker_new(&cfg, backends[b])); /* what the backend itself takes once */
        long before = allocations();
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_init_backend(&t, &cfg, backends[b], NULL, 0));
        TEST_ASSERT_EQUAL_INT(before + 1, allocations());
        before = allocations();
        ast_free(t);
        TEST_ASSERT_EQUAL_INT(before + 1, allocations());
    }
}

/* One allocation and its release, also when the backend is what fails. */
static void test_failed_init_keeps_no_block(void) {
    const ast_config cfg = small_config();
    ast_tracker *t = NULL;
    faulty_arm(&ast_linalg_builtin, 0);
    faulty_prepare_fails(1);
    const long before = allocations();
    TEST_ASSERT_EQUAL_INT(AST_E_BACKEND, ast_init_backend(&t, &cfg, &faulty_linalg, NULL, 0));
    TEST_ASSERT_EQUAL_INT(before + 2, allocations());
    TEST_ASSERT_NULL(t);
}

static void test_callers_block_is_not_freed(void) {
    const ast_config cfg = small_config();
    const size_t size = ast_mem_size(&cfg);
    unsigned char *block = malloc(size);
    ast_tracker *t = NULL;
    TEST_ASSERT_NOT_NULL(block);
    const long before = allocations();
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_init(&t, &cfg, block, size));
    TEST_ASSERT_EQUAL_INT(AST_OK, start_and_step(t, 3, NULL));
    ast_free(t);
    TEST_ASSERT_EQUAL_INT(before, allocations());
    free(block);
    ast_free(NULL);
}

/* ---- The block ---- */

static void test_exact_size_passes_at_every_alignment(void) {
    for (int b = 0; b < BACKENDS; b++) {
        for (size_t remainder = 0; remainder < AST_ALIGNMENT; remainder++) {
            const ast_config cfg = config_of((int)(remainder + (size_t)b) % CONFIGS);
            const size_t size = ast_mem_size_backend(&cfg, backends[b]), state = ast_save_size(&cfg);
            struct guarded block, buffer;
            ast_tracker *t = NULL;
            guarded_open(&block, size, remainder, 0xff);
            guarded_open(&buffer, state, AST_ALIGNMENT - 1 - remainder, 0);

            TEST_ASSERT_EQUAL_INT(AST_E_ARENA, ast_init_backend(&t, &cfg, backends[b], block.memory, size - 1));
            TEST_ASSERT_EQUAL_INT(AST_E_ARENA, ast_init_backend(&t, &cfg, backends[b], block.memory, 0));
            TEST_ASSERT_NULL(t);
            TEST_ASSERT_EACH_EQUAL_HEX8(0xff, block.memory, size);
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_init_backend(&t, &cfg, backends[b], block.memory, size));
            TEST_ASSERT_TRUE((unsigned char *)t >= block.memory && (unsigned char *)t < block.memory + size);
            guarded_check(&block);
            TEST_ASSERT_EQUAL_INT(AST_OK, start_and_step(t, 0, NULL));
            guarded_check(&block);
            TEST_ASSERT_EQUAL_INT(AST_OK, start_and_step(t, 18, NULL)); /* the bag of the large one gets models too */
            guarded_check(&block);
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_save(t, buffer.memory, state));
            guarded_check(&buffer);
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_restore(t, buffer.memory, state));
            guarded_check(&block);
            ast_free(t);
            guarded_check(&block);
            guarded_close(&block);
            guarded_close(&buffer);
        }
    }
}

/* Nothing relies on zeroed memory: whatever the block held, the results are the same bits. */
static void test_what_the_block_held_does_not_matter(void) {
    enum { STEPS = 25 };
    static const int fills[] = {0x00, 0xaa, 0xff};
    for (int b = 0; b < BACKENDS; b++) {
        for (int which = 0; which < CONFIGS; which++) {
            const ast_config cfg = config_of(which);
            ast_result results[3][STEPS];
            struct saved saved = {NULL, 0};
            for (int f = 0; f < 3; f++) {
                struct guarded block;
                ast_tracker *t = NULL;
                guarded_open(&block, ast_mem_size_backend(&cfg, backends[b]), 0, fills[f]);
                TEST_ASSERT_EQUAL_INT(AST_OK, ast_init_backend(&t, &cfg, backends[b], block.memory, block.size));
                TEST_ASSERT_EQUAL_INT(AST_OK, start_and_step(t, STEPS, results[f]));
                TEST_ASSERT_EQUAL_MEMORY(results[0], results[f], sizeof results[f]);
                if (f == 0)
                    saved = saved_from(t);
                else
                    saved_check(&saved, t, "another fill");
                ast_free(t);
                guarded_close(&block);
            }
            saved_free(&saved);
        }
    }
}

/* Frames of any size in the same block. */
static void test_frame_size_needs_no_memory(void) {
    static const int sizes[][2] = {{1, 1}, {AST_MAX_FRAME, 1}, {1, AST_MAX_FRAME}, {2000, 1500}, {WIDTH, HEIGHT}};
    uint8_t *pixels = malloc((size_t)2000 * 1500);
    TEST_ASSERT_NOT_NULL(pixels);
    for (size_t i = 0; i < (size_t)2000 * 1500; i++) pixels[i] = (uint8_t)(i * 7 + i / 2000);
    for (int which = 0; which < CONFIGS; which++) {
        const ast_config cfg = config_of(which);
        struct guarded block;
        ast_tracker *t = NULL;
        guarded_open(&block, ast_mem_size(&cfg), 5, 0xff);
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_init(&t, &cfg, block.memory, block.size));
        const long before = allocations();
        for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) {
            const ast_frame frame = {pixels, sizes[s][0], sizes[s][1], sizes[s][0]};
            const ast_box box = {0, 0, (float)sizes[s][0], (float)sizes[s][1]};
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_start(t, &frame, &box));
            for (int step = 0; step < 8; step++) TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(t, &frame, NULL));
        }
        TEST_ASSERT_EQUAL_INT(before, allocations());
        guarded_check(&block);
        ast_free(t);
        guarded_close(&block);
    }
    free(pixels);
}

static void test_presets_keep_to_their_budgets(void) {
    static const struct {
        int preset;
        size_t bytes;
    } budgets[] = {{AST_PRESET_PAPER, 512 * 1024},
                   {AST_PRESET_ROBUST, 1216 * 1024},
                   {AST_PRESET_COMPACT, 512 * 1024},
                   {AST_PRESET_TINY, 128 * 1024}};
    for (int b = 0; b < BACKENDS; b++) {
        for (size_t p = 0; p < sizeof budgets / sizeof budgets[0]; p++) {
            ast_config cfg;
            char what[96];
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&cfg, budgets[p].preset));
            const size_t bytes = ast_mem_size_backend(&cfg, backends[b]);
            snprintf(what, sizeof what, "preset %d with %s: %u bytes", budgets[p].preset, backends[b]->name, (unsigned)bytes);
            TEST_ASSERT_TRUE_MESSAGE(bytes > 0 && bytes <= budgets[p].bytes, what);
        }
    }
}

/* Tiles: doubling the particles adds their states, weights and distances, not their patches. */
static void test_memory_does_not_grow_with_particles_times_patch(void) {
    ast_config cfg;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&cfg, AST_PRESET_PAPER));
    const size_t one = ast_mem_size(&cfg);
    cfg.particles += 1024;
    const size_t more = ast_mem_size(&cfg) - one, each = (8 + (size_t)cfg.bag_size) * sizeof(float);
    TEST_ASSERT_TRUE(more >= 1024 * each && more <= 1024 * each + 16 * AST_ALIGNMENT);
}

/* The largest configuration is counted without overflow, and its parts are in the count. */
static void test_largest_configuration_is_counted(void) {
    ast_config cfg = small_config();
    cfg.particles = AST_MAX_PARTICLES;
    cfg.patch_width = cfg.patch_height = AST_MAX_PATCH;
    cfg.history = AST_MAX_HISTORY;
    cfg.basis_size = AST_MAX_BASIS;
    cfg.bag_size = AST_MAX_BAG;
    cfg.view = AST_MAX_VIEW;
    cfg.gradient_weight = 1.0f;
    cfg.gradient_cells = AST_MAX_CELLS;
    cfg.background = AST_MAX_BACKGROUND;
    const size_t dim = (size_t)AST_MAX_PATCH * AST_MAX_PATCH + (size_t)AST_MAX_CELLS * AST_MAX_CELLS * 8;
    const size_t vectors = AST_MAX_HISTORY + (AST_MAX_BASIS + 1) * AST_MAX_BAG + AST_MAX_BACKGROUND;
    const size_t least = 4 * (dim * vectors + (size_t)AST_MAX_PARTICLES * (8 + AST_MAX_BAG));
    TEST_ASSERT_TRUE(ast_mem_size(&cfg) > least);
    TEST_ASSERT_TRUE(ast_mem_size(&cfg) < 2 * least);
    TEST_ASSERT_TRUE(ast_save_size(&cfg) > 4 * (dim * vectors + (size_t)AST_MAX_PARTICLES * 4));
}

/* ---- Threads ---- */

enum { THREADS = 2, THREAD_STEPS = 40 };

struct worker {
    ast_tracker *tracker;
    ast_result results[THREAD_STEPS];
    int code;
    pthread_barrier_t *barrier; /* passed when it runs, to begin, when it is done, and to end; NULL: at once */
};

static void wait_at(pthread_barrier_t *barrier) {
    if (barrier != NULL) (void)pthread_barrier_wait(barrier);
}

static void *work(void *argument) {
    struct worker *worker = argument;
    wait_at(worker->barrier);
    wait_at(worker->barrier);
    worker->code = start_and_step(worker->tracker, THREAD_STEPS, worker->results);
    wait_at(worker->barrier);
    wait_at(worker->barrier);
    return NULL;
}

static ast_config thread_config(int thread, int which) {
    ast_config cfg = small_config_of(which);
    cfg.seed = (uint64_t)thread + 1;
    cfg.patch_width = cfg.patch_height = 16 - 4 * thread;
    return cfg;
}

/* Trackers in threads of their own, at once, give the bits that they give one after the other. */
static void test_threads_do_not_meet(void) {
    static struct worker alone[THREADS], together[THREADS];
    for (int b = 0; b < BACKENDS; b++) {
        for (int which = 0; which < SMALL_CONFIGS; which++) {
            pthread_t threads[THREADS];
            for (int w = 0; w < THREADS; w++) {
                const ast_config cfg = thread_config(w, which);
                alone[w].tracker = tracker_new(&cfg, backends[b]);
                together[w].tracker = tracker_new(&cfg, backends[b]);
                (void)work(&alone[w]);
            }
            for (int w = 0; w < THREADS; w++) TEST_ASSERT_EQUAL_INT(0, pthread_create(&threads[w], NULL, work, &together[w]));
            for (int w = 0; w < THREADS; w++) TEST_ASSERT_EQUAL_INT(0, pthread_join(threads[w], NULL));
            for (int w = 0; w < THREADS; w++) {
                struct saved saved = saved_from(alone[w].tracker);
                TEST_ASSERT_EQUAL_INT(AST_OK, alone[w].code);
                TEST_ASSERT_EQUAL_INT(AST_OK, together[w].code);
                TEST_ASSERT_EQUAL_MEMORY(alone[w].results, together[w].results, sizeof alone[w].results);
                saved_check(&saved, together[w].tracker, "together");
                saved_free(&saved);
                ast_free(alone[w].tracker);
                ast_free(together[w].tracker);
            }
            TEST_ASSERT_TRUE(memcmp(alone[0].results, alone[1].results, sizeof alone[0].results) != 0);
        }
    }
}

/* Allocations of the steps of trackers in threads of their own, at once. */
static long allocations_of_threads(const ast_config *cfg, const struct ast_linalg *la) {
    static struct worker workers[THREADS];
    pthread_barrier_t barrier;
    pthread_t threads[THREADS];
    TEST_ASSERT_EQUAL_INT(0, pthread_barrier_init(&barrier, NULL, THREADS + 1));
    for (int w = 0; w < THREADS; w++) {
        workers[w].tracker = tracker_new(cfg, la);
        workers[w].barrier = &barrier;
        TEST_ASSERT_EQUAL_INT(0, pthread_create(&threads[w], NULL, work, &workers[w]));
    }
    wait_at(&barrier); /* a thread's own beginnings and ends are not counted */
    const long before = allocations();
    wait_at(&barrier);
    wait_at(&barrier);
    const long after = allocations();
    wait_at(&barrier);
    for (int w = 0; w < THREADS; w++) {
        TEST_ASSERT_EQUAL_INT(0, pthread_join(threads[w], NULL));
        TEST_ASSERT_EQUAL_INT(AST_OK, workers[w].code);
        ast_free(workers[w].tracker);
    }
    TEST_ASSERT_EQUAL_INT(0, pthread_barrier_destroy(&barrier));
    return after - before;
}

/* The builtin backend never; OpenBLAS maps one more buffer, once, for each thread that is inside it at the same time as another. */
static void test_threads_allocate_nothing(void) {
    for (int b = 0; b < BACKENDS; b++) {
        long total = 0;
        for (int round = 0; round < 2; round++) {
            for (int which = 0; which < SMALL_CONFIGS; which++) {
                ast_config cfg = small_config_of(which);
                cfg.patch_width = cfg.patch_height = 24;
                total += allocations_of_threads(&cfg, backends[b]);
            }
        }
        TEST_ASSERT_TRUE_MESSAGE(total <= (backends[b] == &ast_linalg_builtin ? 0 : THREADS - 1), backends[b]->name);
    }
}

/* A threaded BLAS starts its threads when it is loaded, and these take memory in their own time, which could not be told from what
 * the library does: it is loaded again without them. */
static void without_threads_of_blas(char **argv) {
    const char *name = "OPENBLAS_NUM_THREADS", *threads = getenv(name);
    if (BACKENDS == 1 || (threads != NULL && strcmp(threads, "1") == 0)) return;
    if (setenv(name, "1", 1) == 0) (void)execv("/proc/self/exe", argv);
    perror(name);
    exit(1);
}

int main(int argc, char **argv) {
    (void)argc;
    without_threads_of_blas(argv);
    allocations_watch();
    render_film(film, truth, FRAMES, WIDTH, HEIGHT, 16, 12);
    UNITY_BEGIN();
    /* first, before a backend has been used for anything else */
    RUN_TEST(test_nothing_is_allocated_after_init);
    RUN_TEST(test_nothing_is_allocated_at_the_presets_sizes);
    RUN_TEST(test_threads_allocate_nothing);
    RUN_TEST(test_threaded_steps_allocate_nothing);
    RUN_TEST(test_counter_sees_allocations);
    RUN_TEST(test_geometry_allocates_nothing);
    RUN_TEST(test_own_block_is_one_allocation);
    RUN_TEST(test_failed_init_keeps_no_block);
    RUN_TEST(test_callers_block_is_not_freed);
    RUN_TEST(test_exact_size_passes_at_every_alignment);
    RUN_TEST(test_what_the_block_held_does_not_matter);
    RUN_TEST(test_frame_size_needs_no_memory);
    RUN_TEST(test_presets_keep_to_their_budgets);
    RUN_TEST(test_memory_does_not_grow_with_particles_times_patch);
    RUN_TEST(test_largest_configuration_is_counted);
    RUN_TEST(test_threads_do_not_meet);
    return UNITY_END();
}
