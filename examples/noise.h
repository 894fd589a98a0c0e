/* Random numbers as pure functions of a seed and a place: the same on every machine, in any order of asking. */
#ifndef NOISE_H
#define NOISE_H

#include <stdint.h>

/* 64 well mixed bits of a seed and two integers. */
uint64_t noise_bits(uint64_t seed, int64_t a, int64_t b);
/* Uniform in [0, 1). */
double noise_uniform(uint64_t seed, int64_t a, int64_t b);
/* Mean 0, standard deviation 1, very nearly normal, within +-3.5. */
double noise_normal(uint64_t seed, int64_t a, int64_t b);
/* Value noise: smooth random hills of about unit size, 0 .. 1. */
double noise_value(uint64_t seed, double x, double y);
/* Octaves of it, each with half the size and gain times the height of the last; mean 1/2, 0 .. 1. */
double noise_octaves(uint64_t seed, double x, double y, int octaves, double gain);

#endif
