/* Two clocks: what a thread has computed for, and what has passed. */
#ifndef CLOCK_H
#define CLOCK_H

/* Processor time of the calling thread, seconds: other programs on the machine do not add to it. */
double clock_processor(void);
/* Seconds that reading the former takes: what lies between two readings is measured that much too long. */
double clock_processor_cost(void);
/* Time passed, seconds, from any fixed moment: the one that threads can shorten. */
double clock_wall(void);

#endif
