#include "contender.h"

#include "report.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *preset_name(int preset) {
    return preset == AST_PRESET_PAPER     ? "paper"
           : preset == AST_PRESET_ROBUST  ? "robust"
           : preset == AST_PRESET_COMPACT ? "compact"
                                          : "tiny";
}

void contender_choose(struct contender *c, const struct film *film, int preset, const struct ast_linalg *linalg) {
    memset(c, 0, sizeof *c);
    c->film = film;
    c->linalg = linalg;
    c->preset = preset;
    if (ast_config_preset(&c->config, preset) != AST_OK) memset(&c->config, 0, sizeof c->config); /* contender_open will say so */
    (void)snprintf(c->label, sizeof c->label, "%s, %s", preset_name(preset), linalg->name);
}

static bool refuse(const struct contender *c, int error) {
    report_error("%s: %s", c->label, ast_strerror(error));
    return false;
}

/* Tracks with a model each frame until the bag is full. An AST_* code; *full says whether it is. */
static int fill(ast_tracker *t, struct contender *c, bool *full) {
    enum { PATIENCE = 20 }; /* a tracker that trusts few frames gets this many times as many */
    const int frames = PATIENCE * (c->config.history + c->config.bag_size);
    const ast_frame first = film_frame(c->film, 0);
    int error = ast_start(t, &first, &c->film->start);
    for (int i = 0; i < frames && error == AST_OK && ast_bag_count(t) < c->config.bag_size; i++) {
        const ast_frame frame = film_frame(c->film, ++c->place);
        error = ast_step(t, &frame, NULL);
    }
    *full = error != AST_OK || ast_bag_count(t) == c->config.bag_size;
    return error;
}

/* A full tracker's state: of the fast scoring, which has the same numbers, and taking models faster than configured. NULL after
 * reporting why. */
static void *full_state(struct contender *c, size_t size) {
    ast_config filling = c->config;
    ast_tracker *t = NULL;
    bool full = true;
    void *state = malloc(size);
    filling.scoring = AST_SCORING_GRAM;
    filling.bag_interval = 1;
    int error = state != NULL ? ast_init_backend(&t, &filling, c->linalg, NULL, 0) : AST_E_OUT_OF_MEMORY;
    if (error == AST_OK) error = fill(t, c, &full);
    if (error == AST_OK && full) {
        t->cfg.bag_interval = c->config.bag_interval; /* the state is of the configuration from here on */
        error = ast_save(t, state, size);
    }
    ast_free(t);
    if (error == AST_OK && full) return state;
    if (error != AST_OK)
        (void)refuse(c, error);
    else
        report_error("%s: the bag does not fill on %s", c->label, c->film->name);
    free(state);
    return NULL;
}

bool contender_open(struct contender *c) {
    const size_t size = ast_save_size(&c->config);
    if (size == 0) return refuse(c, AST_E_CONFIG);
    void *state = full_state(c, size);
    if (state == NULL) return false;
    const struct ast_linalg *linalg = c->probed ? probe_linalg(&c->probe, c->linalg) : c->linalg;
    int error = ast_init_backend(&c->tracker, &c->config, linalg, NULL, 0);
    if (error == AST_OK) error = ast_restore(c->tracker, state, size);
    free(state);
    if (error != AST_OK) return refuse(c, error);
    if (c->probed) probe_scoring(&c->probe, c->tracker);
    return true;
}

void contender_close(struct contender *c) {
    ast_free(c->tracker);
    c->tracker = NULL;
}

bool contender_step(struct contender *c) {
    ast_result result;
    const ast_frame frame = film_frame(c->film, ++c->place);
    const int error = c->probed ? probe_step(&c->probe, c->tracker, &frame, &result) : ast_step(c->tracker, &frame, &result);
    if (error != AST_OK) return refuse(c, error);
    c->steps++;
    c->lost += result.status == AST_LOST;
    return true;
}
