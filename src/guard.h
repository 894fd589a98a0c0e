/* The guard: which frames the tracker may learn from, and where it searches when the object is gone.
 *
 * A bag that learns an occluder prefers it from then on, and nothing measured on the bag notices. So the likeness to the object as it
 * was given at the start, which cannot drift, is compared with what it usually is. */
#ifndef AST_GUARD_H
#define AST_GUARD_H

#include "asttrack.h"
#include "particles.h"

/* Frames in a row beyond which they are not counted. */
enum { AST_GUARD_LONG = 10000 };

struct ast_guard {
    float usual;           /* running mean of the likeness over trusted frames; 0 before the first */
    int32_t low;           /* consecutive frames that were not trusted, at most AST_GUARD_LONG */
    int32_t lost;          /* 1: searching around the last trusted estimate */
    struct ast_state good; /* the last trusted estimate */
};

/* Nothing seen yet but the start's estimate. */
void ast_guard_clear(struct ast_guard *guard, const struct ast_state *start);
/* Cosine between a vector and the anchor, both about an origin (NULL: zero); 0 where one of them is at the origin. */
float ast_guard_likeness(const float *vector, const float *anchor, const float *origin, int dim);
/* The guard after a frame whose winner has this likeness and whose cloud this spread (in object sizes). A frame is not trusted when its
 * likeness falls below cfg->guard of the usual while the cloud is undecided; lost_after such frames make the object lost, until a
 * likeness of cfg->reacquire of the usual. With cfg->guard == 0 every frame is trusted. */
struct ast_guard ast_guard_next(const struct ast_guard *guard, const ast_config *cfg, const struct ast_state *estimate,
                                float likeness, float spread);
/* The configuration's walk, or while lost one that grows with every frame up to the object's size (pixels). */
ast_config ast_guard_walk(const struct ast_guard *guard, const ast_config *cfg, float object_size);
/* AST_LOST while lost, AST_UNCERTAIN for a frame that is not trusted or scores below score_uncertain, else AST_TRACKING. */
int32_t ast_guard_status(const struct ast_guard *guard, const ast_config *cfg, float score);

#endif
