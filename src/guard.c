#include "guard.h"

#include <stddef.h>
#include <stdint.h>

#include "real.h"

/* Rate of the running mean: about the last 20 trusted frames. */
#define USUAL_RATE 0.05f
/* Of the lasting mean, where it falls: the last 50 frames; at first a third of all there were, so that it begins as the usual one.
 * An object is never again as like its looks at the start as in the first frames, and that says nothing. */
#define LASTING_RATE 0.02f
#define EARLY_FRAMES 3.0f
/* A cloud whose weighted deviation stays below this share of the object's size has decided: what it follows changed its looks. */
#define DECIDED_SPREAD 0.08f
/* But an object whose likeness to the start is lastingly at least FAITHFUL does not change all of a sudden: when it falls below
 * VANISHED of what is known, something is in front of it, however sure the cloud is about that. Of an object that has just been met
 * nobody can tell: it may turn, and be unlike all that one or two models know. */
#define FAITHFUL 0.5f
#define FAITHFUL_FRAMES 50
#define VANISHED 0.35f
/* Likenesses are relative to what they were, and a bag that has learned something else finds it familiar; the score is not. When
 * its mean over about the last ten frames falls below FADED, what is followed is not the object, however familiar it is. */
#define STEADY_RATE 0.1f
#define FADED 0.2f
/* Growth of the search a frame. */
#define SEARCH_GROWTH 1.3f
/* Frames over which it may grow: 1.3^40 covers any frame from a walk of a pixel. */
#define SEARCH_STEPS 40

void ast_guard_clear(struct ast_guard *guard, const struct ast_state *start) {
    guard->usual.start = guard->usual.known = 0.0f;
    guard->lasting = guard->usual;
    guard->steady = 1.0f;
    guard->trusted = 0;
    guard->low = 0;
    guard->lost = 0;
    guard->good = *start;
}

float ast_guard_likeness(const float *vector, const float *other, const float *origin, int dim) {
    ast_real cross = 0, square = 0, other_square = 0;
    for (int d = 0; d < dim; d++) {
        const ast_real at = origin == NULL ? 0 : (ast_real)origin[d];
        const ast_real v = (ast_real)vector[d] - at, o = (ast_real)other[d] - at;
        cross += v * o;
        square += v * v;
        other_square += o * o;
    }
    return square > 0 && other_square > 0 ? (float)(cross / ast_sqrt(square * other_square)) : 0.0f;
}

struct ast_resemblance ast_guard_resemblance(const float *vector, const float *anchor, const struct ast_bag *bag,
                                             const float *origin) {
    const float start = ast_guard_likeness(vector, anchor, origin, bag->dim);
    struct ast_resemblance found = {start, start};
    for (int j = 0; j < bag->count; j++) {
        const float likeness = ast_guard_likeness(vector, ast_bag_mean(bag, j), origin, bag->dim);
        if (likeness > found.known) found.known = likeness;
    }
    return found;
}

/* A running mean goes on; `falling` is the rate where it falls. */
static void average(struct ast_resemblance *mean, const struct ast_resemblance *seen, float falling) {
    mean->start += (seen->start < mean->start ? falling : USUAL_RATE) * (seen->start - mean->start);
    mean->known += (seen->known < mean->known ? falling : USUAL_RATE) * (seen->known - mean->known);
}

static float lasting_rate(int32_t frames) {
    const float early = EARLY_FRAMES / (float)frames;
    return early > USUAL_RATE ? USUAL_RATE : early < LASTING_RATE ? LASTING_RATE : early;
}

void ast_guard_see(struct ast_guard *guard, const ast_config *cfg, const struct ast_state *estimate,
                   const struct ast_resemblance *resemblance, float spread, float score) {
    if (guard->trusted == 0) guard->usual = guard->lasting = *resemblance;
    guard->steady += STEADY_RATE * (score - guard->steady);
    const float start = guard->lasting.start;
    const int likely = score >= cfg->score_lost, faded = !guard->lost && guard->steady < FADED;
    const int unknown = resemblance->known < cfg->recall * guard->usual.known;
    const int faithful = guard->trusted >= FAITHFUL_FRAMES && start > FAITHFUL;
    const int vanished = faithful && resemblance->known < VANISHED * guard->lasting.known;
    const int doubtful = guard->lost ? unknown || resemblance->start < cfg->reacquire * start || !likely
                                     : unknown && resemblance->start < cfg->guard * start && (spread > DECIDED_SPREAD || vanished);
    if (doubtful || faded) {
        if (guard->low < AST_GUARD_LONG) guard->low++;
        if (guard->low >= cfg->lost_after || faded) guard->lost = 1;
        return;
    }
    if (guard->trusted < AST_GUARD_LONG) guard->trusted++;
    if (likely) {
        average(&guard->usual, resemblance, USUAL_RATE);
        average(&guard->lasting, resemblance, lasting_rate(guard->trusted));
    }
    if (guard->lost) guard->steady = 1.0f; /* found again, it has its time to be sure of */
    guard->low = 0;
    guard->lost = 0;
    guard->good = *estimate;
}

int ast_guard_selects(const struct ast_guard *guard, const ast_config *cfg, const struct ast_resemblance *resemblance,
                      float score) {
    return score >= cfg->score_lost && resemblance->start >= cfg->selective * guard->usual.start;
}

void ast_guard_gather(const struct ast_guard *guard, struct ast_cloud *cloud) {
    for (int i = 1; guard->lost && i < cloud->count; i += 2) ast_cloud_set(cloud, i, guard->good);
}

/* The walk's growth on one axis: SEARCH_GROWTH a frame, until a deviation of `walk` pixels covers the object. */
static float growth(const struct ast_guard *guard, float walk, float object_size) {
    float factor = 1.0f;
    for (int32_t f = 0; f < guard->low && f < SEARCH_STEPS && walk * factor < object_size; f++) factor *= SEARCH_GROWTH;
    return factor;
}

void ast_guard_widen(const struct ast_guard *guard, const ast_config *cfg, const ast_frame *frame, float object_size,
                     struct ast_cloud *cloud) {
    const float wider = growth(guard, cfg->walk_x, object_size), higher = growth(guard, cfg->walk_y, object_size);
    for (int i = 1; guard->lost && i < cloud->count; i += 2) {
        const struct ast_state moved = {guard->good.x + wider * (cloud->x[i] - guard->good.x),
                                        guard->good.y + higher * (cloud->y[i] - guard->good.y), cloud->scale[i]};
        ast_cloud_set(cloud, i, ast_state_within(moved, cfg, frame));
    }
}

int32_t ast_guard_status(const struct ast_guard *guard, const ast_config *cfg, float score) {
    if (guard->lost) return AST_LOST;
    return guard->low > 0 || score < cfg->score_uncertain ? AST_UNCERTAIN : AST_TRACKING;
}
