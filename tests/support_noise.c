#include "support_noise.h"

#include <math.h>

/* SplitMix64: a counter and a mixing function, so that every seed gives an independent sequence. */
uint64_t noise_bits(struct noise *noise) {
    uint64_t z = noise->state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

double noise_uniform(struct noise *noise) {
    return ((double)(noise_bits(noise) >> 12) + 0.5) / 4503599627370496.0; /* 2^52 */
}

/* Box and Muller's, one of the two. */
double noise_normal(struct noise *noise) {
    const double radius = sqrt(-2 * log(noise_uniform(noise)));
    return radius * cos(6.283185307179586 * noise_uniform(noise));
}

int noise_int(struct noise *noise, int least, int most) {
    return least + (int)(noise_uniform(noise) * (most - least + 1));
}

void noise_fill(struct noise *noise, float *values, size_t count, double low, double high) {
    for (size_t i = 0; i < count; i++) values[i] = (float)(low + (high - low) * noise_uniform(noise));
}

void noise_fill_normal(struct noise *noise, double *values, size_t count) {
    for (size_t i = 0; i < count; i++) values[i] = noise_normal(noise);
}
