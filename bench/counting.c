#include "counting.h"

#include "backends.h"
#include "report.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Everything of the file that has a fixed size. */
struct head {
    ast_config config;
    size_t state; /* bytes that ast_save wrote */
    int32_t backend;
    int32_t frames, width, height;
};

static bool out_of_memory(const char *path) {
    report_error("%s: out of memory", path);
    return false;
}

static int backend_index(const struct ast_linalg *linalg) {
    int index = 0;
    while (index < BACKENDS && backends[index] != linalg) index++;
    return index;
}

static bool put(FILE *file, const void *bytes, size_t size) {
    return fwrite(bytes, 1, size, file) == size;
}

static bool get(FILE *file, void *bytes, size_t size) {
    return fread(bytes, 1, size, file) == size;
}

bool counting_write(const struct contender *c, const char *path, int steps) {
    struct head head;
    memset(&head, 0, sizeof head);
    head.config = c->config;
    head.state = ast_save_size(&c->config);
    head.backend = backend_index(c->linalg);
    head.frames = 1 + steps;
    head.width = c->film->width;
    head.height = c->film->height;
    void *state = malloc(head.state);
    if (state == NULL) return out_of_memory(path);
    const int error = ast_save(c->tracker, state, head.state);
    FILE *file = error == AST_OK ? fopen(path, "wb") : NULL;
    bool good = file != NULL && put(file, &head, sizeof head) && put(file, state, head.state);
    for (int i = 1; i <= head.frames && good; i++) {
        const ast_frame frame = film_frame(c->film, c->place + i);
        good = put(file, frame.pixels, (size_t)frame.width * (size_t)frame.height);
    }
    if (file != NULL && fclose(file) != 0) good = false;
    if (!good) report_error("%s: %s", path, error != AST_OK ? ast_strerror(error) : strerror(errno));
    free(state);
    return good;
}

/* Known by its name to whoever counts, so it must stay a function of its own: it is called through a pointer. */
static int counted_step(struct probe *p, ast_tracker *t, const ast_frame *frame) {
    return probe_step(p, t, frame, NULL);
}
static int (*volatile const counted)(struct probe *, ast_tracker *, const ast_frame *) = counted_step;

/* The tracker of the file, restored and probed. An AST_* code. */
static int restore(const struct head *head, const void *state, struct probe *probe, ast_tracker **t) {
    int error = ast_init_backend(t, &head->config, probe_linalg(probe, backends[head->backend]), NULL, 0);
    if (error == AST_OK) error = ast_restore(*t, state, head->state);
    if (error == AST_OK) probe_scoring(probe, *t);
    return error;
}

bool counting_replay(const char *path) {
    struct head head;
    struct probe probe;
    ast_tracker *t = NULL;
    uint8_t *state = NULL, *pixels = NULL;
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        report_error("%s: %s", path, strerror(errno));
        return false;
    }
    memset(&probe, 0, sizeof probe);
    bool good = get(file, &head, sizeof head) && head.backend >= 0 && head.backend < BACKENDS && head.width > 0 &&
                head.height > 0 && head.state == ast_save_size(&head.config);
    if (good) {
        state = malloc(head.state);
        pixels = malloc((size_t)head.width * (size_t)head.height);
        good = state != NULL && pixels != NULL && get(file, state, head.state);
    }
    if (!good) report_error("%s: not a file that this program wrote for counting, or out of memory", path);
    int error = good ? restore(&head, state, &probe, &t) : AST_OK;
    for (int i = 0; i < head.frames && good && error == AST_OK; i++) {
        const ast_frame frame = {pixels, head.width, head.height, head.width};
        good = get(file, pixels, (size_t)head.width * (size_t)head.height);
        if (!good) report_error("%s: ends before its frames do", path);
        if (good) error = i == 0 ? probe_step(&probe, t, &frame, NULL) : counted(&probe, t, &frame);
    }
    if (error != AST_OK) report_error("%s: %s", path, ast_strerror(error));
    ast_free(t);
    free(state);
    free(pixels);
    (void)fclose(file);
    return good && error == AST_OK;
}
