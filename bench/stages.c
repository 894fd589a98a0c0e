#include "stages.h"

#include <string.h>

#include "clock.h"

/* The tables' functions get no pointer of ours: this is the probe of the step that is running, NULL outside probe_step. */
static struct probe *current;

const char *stage_name(enum stage stage) {
    static const char *const names[STAGES] = {"cloud and view", "history", "patches", "product", "small problems", "decision"};
    return names[stage];
}

/* Ends a stage and begins the next. */
static void mark(enum stage ended) {
    const double now = current->clock();
    current->seconds[ended] += now - current->mark - current->cost;
    current->mark = now;
}

static int probed_product(int rows, int cols, int depth, const float *a, int lda, const float *b, int ldb, float *c, int ldc) {
    mark(STAGE_SMALL);
    const int failed = current->linalg->product(rows, cols, depth, a, lda, b, ldb, c, ldc);
    mark(STAGE_PRODUCT);
    return failed;
}

static int probed_product_real(int rows, int cols, int depth, const ast_real *a, int lda, const ast_real *b, int ldb, ast_real *c,
                               int ldc) {
    mark(STAGE_SMALL);
    const int failed = current->linalg->product_real(rows, cols, depth, a, lda, b, ldb, c, ldc);
    mark(STAGE_PRODUCT);
    return failed;
}

static int probed_prepare(union ast_scratch *scratch, union ast_tile_scratch *own, const struct ast_scene *scene) {
    mark(STAGE_VIEW);
    const int failed = current->scoring->prepare(scratch, own, scene);
    mark(STAGE_HISTORY);
    return failed;
}

/* Products are the candidates' inside a tile only: outside, the table is as it was. */
static int probed_tile(const union ast_scratch *scratch, union ast_tile_scratch *own, const struct ast_scene *scene, float *patches,
                       int count, float *distance) {
    struct probe *p = current;
    mark(STAGE_PATCHES);
    p->probed_linalg.product = probed_product;
    p->probed_linalg.product_real = probed_product_real;
    const int failed = p->scoring->tile(scratch, own, scene, patches, count, distance);
    p->probed_linalg = *p->linalg;
    mark(STAGE_SMALL);
    return failed;
}

const struct ast_linalg *probe_linalg(struct probe *p, const struct ast_linalg *linalg) {
    p->linalg = linalg;
    p->clock = clock_processor;
    p->cost = clock_processor_cost();
    p->probed_linalg = *linalg;
    return &p->probed_linalg;
}

void probe_scoring(struct probe *p, struct ast_tracker *t) {
    p->scoring = t->scoring;
    p->probed_scoring = *t->scoring;
    p->probed_scoring.prepare = probed_prepare;
    p->probed_scoring.tile = probed_tile;
    t->scoring = &p->probed_scoring;
}

int probe_step(struct probe *p, struct ast_tracker *t, const ast_frame *frame, ast_result *result) {
    memset(p->seconds, 0, sizeof p->seconds);
    current = p;
    p->mark = p->clock();
    const int error = ast_step(t, frame, result);
    mark(STAGE_DECISION);
    current = NULL;
    return error;
}
