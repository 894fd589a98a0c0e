/* Contenders measured side by side: in each round every one of them takes its turn, so that what slows the machine down for a while
 * slows all of them down, and the quotient of two samples of one round is what can be trusted. */
#ifndef TURNS_H
#define TURNS_H

#include "contender.h"
#include "statistics.h"

enum { STEPS_MOST = 64 }; /* steps in a turn */

/* In a turn a contender takes one step that is not measured, since the others have had the caches, then `steps` that are; their
 * median is its sample of the round. Processor time, or with wall != 0 the time that passes, which threads can shorten. False after
 * reporting why a step failed. */
bool take_turns(struct contender *const *contenders, int count, int rounds, int steps, bool wall);

/* Of a contender's samples, seconds. */
struct spread step_spread(const struct contender *c);
struct spread stage_spread(const struct contender *c, enum stage stage);
/* How many times longer one's step takes than the other's, round by round. */
struct spread step_ratio(const struct contender *above, const struct contender *below);
struct spread stage_ratio(const struct contender *above, const struct contender *below, enum stage stage);

#endif
