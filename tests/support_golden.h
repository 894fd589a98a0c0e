/* Golden cases: pairs of image sets with their subspaces' distance, computed outside this library (golden/generate.py says how, and
 * describes the files). */
#ifndef SUPPORT_GOLDEN_H
#define SUPPORT_GOLDEN_H

#include <stdio.h>

#include "asttrack.h"

enum { GOLDEN_MOST_IMAGES = AST_MAX_HISTORY + 1, GOLDEN_MOST_VALUES = 4096 };

struct golden_set {
    float images[GOLDEN_MOST_VALUES]; /* dim x count, packed columns */
    int count;
    int rank; /* directions present, of n */
};

struct golden_case {
    char name[64];
    int basis; /* AST_BASIS_* */
    int n, dim;
    double alpha;
    struct golden_set a, b;
    double angles[AST_MAX_BASIS], geodesic, mahalanobis, distance;
};

/* The next case of a file. 1, 0 at its end, -1 where it cannot be read (golden_fault says why). */
int golden_next(FILE *file, struct golden_case *golden);
const char *golden_fault(void);

/* What single precision leaves open in a result, from the bases' rounding: an arccosine near 1 is good to the root of that. */
double golden_angle_slack(double angle);
double golden_geodesic_slack(const struct golden_case *golden);
double golden_mahalanobis_slack(const struct golden_case *golden);

#endif
