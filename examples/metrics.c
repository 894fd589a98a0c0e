#include "metrics.h"

#include <math.h>

/* Length of the part that two intervals share. */
static double shared_length(double start_a, double length_a, double start_b, double length_b) {
    const double start = fmax(start_a, start_b);
    const double end = fmin(start_a + length_a, start_b + length_b);
    return fmax(0.0, end - start);
}

static double overlap(const ast_box *a, const ast_box *b) {
    const double wa = (double)a->w, ha = (double)a->h, wb = (double)b->w, hb = (double)b->h;
    const double both = shared_length((double)a->x, wa, (double)b->x, wb) * shared_length((double)a->y, ha, (double)b->y, hb);
    return both / (wa * ha + wb * hb - both);
}

/* The centre of a box is x + (w - 1) / 2; the half pixel cancels in a difference. */
static double centre_distance(const ast_box *a, const ast_box *b) {
    const double dx = ((double)a->x + 0.5 * (double)a->w) - ((double)b->x + 0.5 * (double)b->w);
    const double dy = ((double)a->y + 0.5 * (double)a->h) - ((double)b->y + 0.5 * (double)b->h);
    return hypot(dx, dy);
}

void metrics_add(metrics *m, const ast_box *estimate, const ast_box *truth) {
    const double error = centre_distance(estimate, truth);
    m->error_sum += error;
    m->overlap_sum += overlap(estimate, truth);
    m->within += error <= METRICS_RADIUS ? 1 : 0;
    m->count += 1;
}

static double mean(double sum, int32_t count) {
    return count > 0 ? sum / (double)count : (double)NAN;
}

double metrics_centre_error(const metrics *m) {
    return mean(m->error_sum, m->count);
}

double metrics_precision(const metrics *m) {
    return mean((double)m->within, m->count);
}

double metrics_success(const metrics *m) {
    return mean(m->overlap_sum, m->count);
}
