#include "turns.h"

#include "clock.h"
#include "interrupt.h"
#include "report.h"

/* One turn; the samples of a round. */
static bool turn(struct contender *c, int round, int steps, bool wall) {
    double spent[STEPS_MOST], stage[STAGES][STEPS_MOST];
    if (!contender_step(c)) return false;
    for (int i = 0; i < steps; i++) {
        const double before = wall ? clock_wall() : clock_processor();
        if (!contender_step(c)) return false;
        spent[i] = (wall ? clock_wall() : clock_processor()) - before;
        for (int s = 0; s < STAGES; s++) stage[s][i] = c->probe.seconds[s];
    }
    c->sample[round] = spread_of(spent, steps).median;
    for (int s = 0; s < STAGES; s++) c->stage_sample[s][round] = spread_of(stage[s], steps).median;
    return true;
}

bool take_turns(struct contender *const *contenders, int count, int rounds, int steps, bool wall) {
    if (rounds > ROUNDS_MOST) rounds = ROUNDS_MOST;
    if (steps > STEPS_MOST) steps = STEPS_MOST;
    for (int r = 0; r < rounds; r++) {
        for (int i = 0; i < count; i++) {
            report_progress("bench", r * count + i + 1, rounds * count, contenders[i]->label);
            if (!turn(contenders[i], r, steps, wall)) return false;
            if (interrupt_pending()) {
                report_progress_end();
                report_error("interrupted: no figures are written");
                return false;
            }
            contenders[i]->rounds = r + 1;
        }
    }
    report_progress_end();
    return true;
}

static int both(const struct contender *a, const struct contender *b) {
    return a->rounds < b->rounds ? a->rounds : b->rounds;
}

struct spread step_spread(const struct contender *c) {
    return spread_of(c->sample, c->rounds);
}

struct spread stage_spread(const struct contender *c, enum stage stage) {
    return spread_of(c->stage_sample[stage], c->rounds);
}

struct spread step_ratio(const struct contender *above, const struct contender *below) {
    return spread_of_ratios(above->sample, below->sample, both(above, below));
}

struct spread stage_ratio(const struct contender *above, const struct contender *below, enum stage stage) {
    return spread_of_ratios(above->stage_sample[stage], below->stage_sample[stage], both(above, below));
}
