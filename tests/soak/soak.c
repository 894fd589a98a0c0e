/* A tracker that runs for ever, and two hundred that come and go: memory flat to the byte, numbers that stay numbers, and a table
 * in which a drift in processor time would show.
 * usage: soak FRAMES */
#define _GNU_SOURCE
#include "support_allocation.h"

#include <asttrack.h>
#include <malloc.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <time.h>
#include <unistd.h>

#include "support_noise.h"
#include "support_render.h"

/* A loop of the target's path, in which it is gone for a while. */
enum { LOOP = 100, GONE_FROM = 70, GONE_TO = 82, WIDTH = 64, HEIGHT = 48 };
static uint8_t film[LOOP][WIDTH * HEIGHT];
static ast_box truth[LOOP];

/* Ends the program where a promise is broken. */
static void require(int holds, const char *promise, long frame) {
    if (holds) return;
    printf("broken after %ld frames: %s\n", frame, promise);
    exit(1);
}

static void render_loop(void) {
    struct render scene;
    render_open(&scene, WIDTH, HEIGHT, 3);
    for (int f = 0; f < LOOP; f++) {
        truth[f] = render_path(&scene, f, 16, 12, 0.15, 1.1);
        const ast_frame frame = render_frame(&scene, f >= GONE_FROM && f < GONE_TO ? NULL : &truth[f]);
        memcpy(film[f], frame.pixels, sizeof film[f]);
    }
    render_close(&scene);
}

static ast_frame frame_at(long f) {
    const ast_frame frame = {film[f % LOOP], WIDTH, HEIGHT, WIDTH};
    return frame;
}

/* All parts of a preset at a small size. */
static ast_config small(int preset) {
    ast_config cfg;
    require(ast_config_preset(&cfg, preset) == AST_OK, "a preset", 0);
    cfg.particles = 32;
    cfg.patch_width = cfg.patch_height = 8;
    cfg.bag_size = 4;
    cfg.bag_interval = 3;
    if (preset == AST_PRESET_ROBUST) {
        cfg.view = 48;
        cfg.view_object = 12;
        cfg.gradient_cells = 4;
        cfg.background = 16;
        cfg.background_refresh = 2;
    }
    require(ast_config_check(&cfg, NULL) == AST_OK, "a small configuration is legal", 0);
    return cfg;
}

static long resident_kib(void) {
    long size = 0, resident = 0;
    FILE *stream = fopen("/proc/self/statm", "r");
    if (stream == NULL || fscanf(stream, "%ld %ld", &size, &resident) != 2) resident = 0;
    if (stream != NULL) (void)fclose(stream);
    return resident * (sysconf(_SC_PAGESIZE) / 1024);
}

/* Of the processor that this process took: what else the machine does must not look like a drift. */
static double seconds_now(void) {
    struct timespec now;
    (void)clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* ---- One tracker ---- */

struct block {
    double seconds, worst_sum; /* largest distance of the weights' sum from 1 */
    long lost, allocations;
};

static void check_result(const ast_tracker *t, const ast_result *r, struct block *block, long frame) {
    ast_particles p;
    double sum = 0;
    require(isfinite(r->box.x) && isfinite(r->box.y) && isfinite(r->box.w) && isfinite(r->box.h), "a box of numbers", frame);
    require(isfinite(r->distance) && isfinite(r->scale), "a distance that is a number", frame);
    require(r->score >= 0 && r->score <= 1, "a score between 0 and 1", frame);
    require(ast_get_particles(t, &p) == AST_OK, "a look at the particles", frame);
    for (int32_t i = 0; i < p.count; i++) {
        require(p.weight[i] >= 0 && p.weight[i] <= 1.0001f, "weights between 0 and 1", frame);
        sum += (double)p.weight[i];
    }
    block->worst_sum = fmax(block->worst_sum, fabs(sum - 1));
    require(fabs(sum - 1) < 1e-4, "weights whose sum is 1", frame);
    block->lost += r->status == AST_LOST;
}

/* Steps from frame `first`; every so often it is started anew, saved and restored. */
static void run_block(ast_tracker *t, long first, long frames, unsigned char *state, size_t size, struct block *block) {
    enum { START_EVERY = 499, SAVE_EVERY = 997 };
    const long before = allocations();
    const double begun = seconds_now();
    for (long f = first; f < first + frames; f++) {
        const ast_frame frame = frame_at(f);
        ast_result result;
        if (f % START_EVERY == 0) require(ast_start(t, &frame, &truth[f % LOOP]) == AST_OK, "a start", f);
        if (f % SAVE_EVERY == 0) {
            require(ast_save(t, state, size) == AST_OK, "a save", f);
            require(ast_restore(t, state, size) == AST_OK, "a restore", f);
        }
        require(ast_step(t, &frame, &result) == AST_OK, "a step", f);
        check_result(t, &result, block, f);
    }
    block->seconds = seconds_now() - begun;
    block->allocations = allocations() - before;
}

static void soak(const char *name, int preset, long frames) {
    enum { BLOCKS = 10 };
    const ast_config cfg = small(preset);
    const size_t size = ast_save_size(&cfg);
    unsigned char *state = malloc(size);
    ast_tracker *t = NULL;
    long resident[BLOCKS], total = 0;
    struct block blocks[BLOCKS];
    memset(blocks, 0, sizeof blocks);
    require(state != NULL && ast_init(&t, &cfg, NULL, 0) == AST_OK, "a tracker", 0);
    printf("%s at %d x %d pixels, %d particles, %zu bytes, backend %s\n", name, WIDTH, HEIGHT, (int)cfg.particles,
           ast_mem_size(&cfg), ast_backend());
    printf("%10s %14s %12s %14s %14s %10s\n", "frames", "us per frame", "allocations", "resident, KiB", "worst sum - 1", "lost");
    for (int b = 0; b < BLOCKS; b++) {
        run_block(t, b * (frames / BLOCKS), frames / BLOCKS, state, size, &blocks[b]);
        total += frames / BLOCKS;
        resident[b] = resident_kib();
        printf("%10ld %14.2f %12ld %14ld %14.1e %10ld\n", total, 1e6 * blocks[b].seconds / (double)(frames / BLOCKS),
               blocks[b].allocations, resident[b], blocks[b].worst_sum, blocks[b].lost);
        (void)fflush(stdout);
        require(blocks[b].allocations == 0, "nothing is allocated", total);
    }
    printf("time of the last block / of the first: %.3f\n\n", blocks[BLOCKS - 1].seconds / blocks[0].seconds);
    /* the kernel counts pages in batches */
    require(resident[BLOCKS - 1] - resident[1] <= 512, "resident memory is flat", total);
    ast_free(t);
    free(state);
}

/* ---- Two hundred ---- */

enum { CROWD = 200 };

struct member {
    ast_tracker *tracker;
    ast_config cfg;
    long started, stopped; /* frames of the video */
};

static void begin(struct member *m, int number, long frame_number) {
    const ast_frame frame = frame_at(frame_number);
    m->cfg = small(number % 2 ? AST_PRESET_ROBUST : AST_PRESET_PAPER);
    m->cfg.seed = (uint64_t)frame_number * CROWD + (uint64_t)number;
    m->started = frame_number;
    require(ast_init(&m->tracker, &m->cfg, NULL, 0) == AST_OK, "a tracker in the crowd", frame_number);
    require(ast_start(m->tracker, &frame, &truth[frame_number % LOOP]) == AST_OK, "a start in the crowd", frame_number);
}

/* Ends it; now and then its state is compared with that of a tracker that saw the same frames alone. */
static void end(struct member *m, long frame_number, int compare) {
    if (compare) {
        const size_t size = ast_save_size(&m->cfg);
        unsigned char *together = malloc(size), *alone = malloc(size);
        const ast_frame first = frame_at(m->started);
        ast_tracker *t = NULL;
        require(together != NULL && alone != NULL && ast_init(&t, &m->cfg, NULL, 0) == AST_OK, "a tracker alone", frame_number);
        require(ast_start(t, &first, &truth[m->started % LOOP]) == AST_OK, "a start alone", frame_number);
        for (long f = m->started + 1; f < frame_number; f++) {
            const ast_frame frame = frame_at(f);
            require(ast_step(t, &frame, NULL) == AST_OK, "a step alone", f);
        }
        require(ast_save(m->tracker, together, size) == AST_OK && ast_save(t, alone, size) == AST_OK, "two states", frame_number);
        require(memcmp(together, alone, size) == 0, "a tracker in a crowd does what it does alone", frame_number);
        ast_free(t);
        free(together);
        free(alone);
    }
    ast_free(m->tracker);
    m->tracker = NULL;
}

/* frames: of the video. Each of them, some members come and some go; the others step. */
static void crowd(long frames) {
    static struct member members[CROWD];
    struct noise noise = {5};
    long steps = 0, starts = 0, compared = 0, most = 0;
    const size_t before = mallinfo2().uordblks;
    const double begun = seconds_now();
    for (long f = 0; f < frames; f++) {
        const ast_frame frame = frame_at(f);
        long present = 0;
        for (int m = 0; m < CROWD; m++) {
            const int turn = noise_int(&noise, 0, 99);
            if (members[m].tracker == NULL && turn < 20) {
                begin(&members[m], m, f);
                starts++;
            } else if (members[m].tracker != NULL && turn < 2) {
                end(&members[m], f, starts % 4 == 0);
                compared += starts % 4 == 0;
            } else if (members[m].tracker != NULL) {
                require(ast_step(members[m].tracker, &frame, NULL) == AST_OK, "a step in the crowd", f);
                steps++;
            }
            present += members[m].tracker != NULL;
        }
        if (present > most) most = present;
    }
    for (int m = 0; m < CROWD; m++)
        if (members[m].tracker != NULL) end(&members[m], frames, 0);
    const size_t after = mallinfo2().uordblks;
    printf(
        "crowd of %d: %ld frames, %ld trackers started and stopped, at most %ld at once, %ld steps, %ld compared with one alone\n",
        CROWD, frames, starts, most, steps, compared);
    printf("heap before %zu bytes, after %zu bytes; resident %ld KiB; %.2f us a step\n", before, after, resident_kib(),
           1e6 * (seconds_now() - begun) / (double)(steps + 1));
    require(after == before || !ALLOCATION_SEES_MAPPINGS, "all memory comes back, to the byte", frames);
    require(starts > CROWD && most > CROWD / 2, "a crowd", frames);
}

int main(int argc, char **argv) {
    const long frames = argc == 2 ? strtol(argv[1], NULL, 10) : 0;
    if (frames < 1000) {
        fprintf(stderr, "usage: soak FRAMES (at least 1000)\n");
        return 2;
    }
    /* a page that the kernel makes huge in its own time looks like memory that grows */
    (void)prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0);
    allocations_watch();
    render_loop();
    soak("paper preset's parts", AST_PRESET_PAPER, frames);
    soak("robust preset's parts", AST_PRESET_ROBUST, frames);
    crowd(frames / 200 < 100 ? 100 : frames / 200 > 1000 ? 1000 : frames / 200);
    return 0;
}
