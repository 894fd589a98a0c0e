#include "clock.h"

#include "statistics.h"

#include <time.h>

static double read_clock(clockid_t clock) {
    struct timespec now = {0, 0};
    (void)clock_gettime(clock, &now); /* both clocks exist wherever POSIX threads do */
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double clock_processor(void) {
    return read_clock(CLOCK_THREAD_CPUTIME_ID);
}

double clock_processor_cost(void) {
    enum { READINGS = 999 };
    double cost[READINGS];
    for (int i = 0; i < READINGS; i++) {
        const double before = clock_processor();
        cost[i] = clock_processor() - before;
    }
    return spread_of(cost, READINGS).median;
}

double clock_wall(void) {
    return read_clock(CLOCK_MONOTONIC);
}
