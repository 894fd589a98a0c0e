/* The likelihoods' exponentials, side by side. */
#include "maths_lanes.h"

static void exponentials(ast_real *x, int n) {
    for (int i = 0; i < n; i++) x[i] = ast_exp_lane(x[i]);
}
