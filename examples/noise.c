#include "noise.h"

#include <math.h>

/* A bijection of 64 bits that spreads every input bit over all the output's: multiplications by odd constants between shifts. */
static uint64_t mix(uint64_t bits) {
    bits ^= bits >> 32;
    bits *= UINT64_C(0xd6e8feb86659fd93);
    bits ^= bits >> 32;
    bits *= UINT64_C(0xd6e8feb86659fd93);
    bits ^= bits >> 32;
    return bits;
}

uint64_t noise_bits(uint64_t seed, int64_t a, int64_t b) {
    const uint64_t step = UINT64_C(0x9e3779b97f4a7c15); /* 2^64 / golden ratio: neighbours land far apart */
    return mix(mix(mix(seed + step) + (uint64_t)a * step) + (uint64_t)b * step + 1);
}

double noise_uniform(uint64_t seed, int64_t a, int64_t b) {
    return (double)(noise_bits(seed, a, b) >> 11) * 0x1p-53;
}

double noise_normal(uint64_t seed, int64_t a, int64_t b) {
    /* the sum of four uniform numbers of 16 bits: variance 4 / 12 */
    const uint64_t bits = noise_bits(seed, a, b);
    const uint64_t sum = (bits & 0xffff) + (bits >> 16 & 0xffff) + (bits >> 32 & 0xffff) + (bits >> 48);
    return ((double)sum / 65536.0 - 2.0) * 1.7320508075688772;
}

/* Smooth step with two continuous derivatives, so that the lattice does not show. */
static double ease(double t) {
    return t * t * t * (t * (6.0 * t - 15.0) + 10.0);
}

double noise_value(uint64_t seed, double x, double y) {
    const double left = floor(x), top = floor(y);
    const int64_t i = (int64_t)left, j = (int64_t)top;
    const double u = ease(x - left), v = ease(y - top);
    const double upper = noise_uniform(seed, i, j) * (1.0 - u) + noise_uniform(seed, i + 1, j) * u;
    const double lower = noise_uniform(seed, i, j + 1) * (1.0 - u) + noise_uniform(seed, i + 1, j + 1) * u;
    return upper * (1.0 - v) + lower * v;
}

double noise_octaves(uint64_t seed, double x, double y, int octaves, double gain) {
    double sum = 0.0, height = 1.0, heights = 0.0;
    for (int k = 0; k < octaves; ++k) {
        sum += height * noise_value(seed + (uint64_t)k, x, y);
        heights += height;
        height *= gain;
        x *= 2.0;
        y *= 2.0;
    }
    return sum / heights;
}
