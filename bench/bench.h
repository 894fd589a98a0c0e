/* What every measurement of a run shares, and the measurements: each prints its table, writes its part of the file, and returns
 * false after reporting why it could not. */
#ifndef BENCH_H
#define BENCH_H

#include "backends.h"
#include "film.h"
#include "json.h"
#include "turns.h"

enum { FILMS = 2 };

struct bench {
    const char *program; /* the name by which this program can be started again */
    bool quick;
    int rounds;
    int steps;               /* in a turn */
    struct film film[FILMS]; /* the synthetic scene first */
    int films;
    struct json json;
};

/* Literal against gram and lapacke against builtin, whole and by stage, on every film. */
bool bench_ways(struct bench *b);
/* A step's growth with the number of particles and the patch. */
bool bench_growth(struct bench *b);
/* What the machine can do at its best with a step's work, and how much longer the step takes. */
bool bench_roofline(struct bench *b);
/* One thread against two, where the library has them. */
bool bench_threads(struct bench *b);
/* Instructions of a step, counted by callgrind: the figure that repeats. */
bool bench_instructions(struct bench *b);

#endif
