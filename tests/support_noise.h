/* Seeded noise for tests: the same numbers on every machine, and none of the library's own. */
#ifndef SUPPORT_NOISE_H
#define SUPPORT_NOISE_H

#include <stddef.h>
#include <stdint.h>

struct noise {
    uint64_t state; /* any value is a seed */
};

uint64_t noise_bits(struct noise *noise);
/* Uniform in (0, 1). */
double noise_uniform(struct noise *noise);
/* Standard normal. */
double noise_normal(struct noise *noise);
/* Uniform integer, least .. most. */
int noise_int(struct noise *noise, int least, int most);
/* count values, each uniform in low .. high. */
void noise_fill(struct noise *noise, float *values, size_t count, double low, double high);
/* count standard normal values. */
void noise_fill_normal(struct noise *noise, double *values, size_t count);

#endif
