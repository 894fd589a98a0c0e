#include "guard.h"

#include <stddef.h>
#include <stdint.h>

#include "real.h"

/* Rate of the running mean: about the last 20 trusted frames. */
#define USUAL_RATE 0.05f
/* A cloud whose weighted deviation stays below this share of the object's size has decided: what it follows changed its looks. */
#define DECIDED_SPREAD 0.08f
/* Growth of the search a frame. */
#define SEARCH_GROWTH 1.3f
/* Frames over which it may grow: 1.3^40 covers any frame from a walk of a pixel. */
#define SEARCH_STEPS 40

void ast_guard_clear(struct ast_guard *guard, const struct ast_state *start) {
    guard->usual = 0.0f;
    guard->low = 0;
    guard->lost = 0;
    guard->good = *start;
}

float ast_guard_likeness(const float *vector, const float *anchor, const float *origin, int dim) {
    ast_real cross = 0, square = 0, anchor_square = 0;
    for (int d = 0; d < dim; d++) {
        const ast_real at = origin == NULL ? 0 : (ast_real)origin[d];
        const ast_real v = (ast_real)vector[d] - at, a = (ast_real)anchor[d] - at;
        cross += v * a;
        square += v * v;
        anchor_square += a * a;
    }
    return square > 0 && anchor_square > 0 ? (float)(cross / ast_sqrt(square * anchor_square)) : 0.0f;
}

struct ast_guard ast_guard_next(const struct ast_guard *guard, const ast_config *cfg, const struct ast_state *estimate,
                                float likeness, float spread) {
    struct ast_guard next = *guard;
    const float usual = guard->usual > 0.0f ? guard->usual : likeness;
    const int doubtful = guard->lost ? likeness < cfg->reacquire * usual : likeness < cfg->guard * usual && spread > DECIDED_SPREAD;
    if (cfg->guard > 0.0f && doubtful) {
        if (next.low < AST_GUARD_LONG) next.low++;
        next.lost = guard->lost || next.low >= cfg->lost_after;
        return next;
    }
    next.usual = usual + USUAL_RATE * (likeness - usual);
    next.low = 0;
    next.lost = 0;
    next.good = *estimate;
    return next;
}

ast_config ast_guard_walk(const struct ast_guard *guard, const ast_config *cfg, float object_size) {
    ast_config walk = *cfg;
    if (!guard->lost) return walk;
    for (int32_t f = 0; f < guard->low && f < SEARCH_STEPS; f++) {
        if (walk.walk_x < object_size) walk.walk_x *= SEARCH_GROWTH;
        if (walk.walk_y < object_size) walk.walk_y *= SEARCH_GROWTH;
    }
    return walk;
}

int32_t ast_guard_status(const struct ast_guard *guard, const ast_config *cfg, float score) {
    if (guard->lost) return AST_LOST;
    return guard->low > 0 || score < cfg->score_uncertain ? AST_UNCERTAIN : AST_TRACKING;
}
