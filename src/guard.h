/* The guard: which frames the tracker may learn from, and where it searches when the object is gone.
 *
 * A bag that learns an occluder prefers it from then on, and nothing measured on the bag alone notices. So two resemblances of the
 * winner are compared with what they usually are: that to the object as it was given at the start, which cannot drift, and that to
 * the likest model of the bag, which knows the object's looks since. An object that turns keeps the second, one that comes back
 * keeps the first; a frame in which both fall is not learned from. */
#ifndef AST_GUARD_H
#define AST_GUARD_H

#include "asttrack.h"
#include "bag.h"
#include "particles.h"

/* Frames in a row beyond which they are not counted. */
enum { AST_GUARD_LONG = 10000 };

/* Cosines about the background's mean (about zero without a background), -1 .. 1. */
struct ast_resemblance {
    float start; /* to the object's looks at the start */
    float known; /* to the likest of these and of the bag's means */
};

struct ast_guard {
    struct ast_resemblance usual;   /* running means over trusted frames; start 0 before the first */
    struct ast_resemblance lasting; /* the same, but slow to fall: what covers the object little by little does not become usual */
    float steady;                   /* running mean of the scores, 0 .. 1 */
    int32_t trusted;                /* frames that these are means of, at most AST_GUARD_LONG */
    int32_t low;                    /* consecutive frames that were not trusted, at most AST_GUARD_LONG */
    int32_t lost;                   /* 1: following and searching, without learning */
    struct ast_state good;          /* the last trusted estimate */
};

/* Nothing seen yet but the start's estimate. */
void ast_guard_clear(struct ast_guard *guard, const struct ast_state *start);
/* Cosine between a vector and another, both about an origin (NULL: zero); 0 where one of them is at the origin. */
float ast_guard_likeness(const float *vector, const float *other, const float *origin, int dim);
/* A winner's vector beside the start's (anchor) and the models' means, all about the origin. */
struct ast_resemblance ast_guard_resemblance(const float *vector, const float *anchor, const struct ast_bag *bag,
                                             const float *origin);
/* A frame whose winner resembles so, whose cloud has this spread (object sizes), and which scores so. It is not trusted when its
 * likeness to the start falls below cfg->guard of the lasting and that to what is known below cfg->recall of the usual, while the
 * cloud is undecided or nothing like the object is left. cfg->lost_after such frames make the object lost, or scores that stay next
 * to nothing, until likenesses of cfg->reacquire of the lasting and cfg->recall of the usual, and a score of cfg->score_lost. The
 * means are those of trusted frames with such a score. */
void ast_guard_see(struct ast_guard *guard, const ast_config *cfg, const struct ast_state *estimate,
                   const struct ast_resemblance *resemblance, float spread, float score);
/* Whether a frame's model may take another's place in a full bag: one more like the start than cfg->selective of the usual, and
 * with a score of cfg->score_lost at least. What slowly covers an object, or what stands where it was, would else replace all that
 * is known of it, one frame hardly unlike the last. */
int ast_guard_selects(const struct ast_guard *guard, const ast_config *cfg, const struct ast_resemblance *resemblance, float score);
/* While lost, half of the particles go on following what was likeliest, since it may still be the object in a new guise; the other
 * half searches around the last trusted estimate. This gives the searchers their place, before the walk; */
void ast_guard_gather(const struct ast_guard *guard, struct ast_cloud *cloud);
/* and this, after it, widens their walk, with every frame up to the object's size (pixels). */
void ast_guard_widen(const struct ast_guard *guard, const ast_config *cfg, const ast_frame *frame, float object_size,
                     struct ast_cloud *cloud);
/* AST_LOST while lost, AST_UNCERTAIN for a frame that is not trusted or scores below score_uncertain, else AST_TRACKING. */
int32_t ast_guard_status(const struct ast_guard *guard, const ast_config *cfg, float score);

#endif
