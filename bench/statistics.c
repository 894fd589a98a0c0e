#include "statistics.h"

#include <math.h>
#include <stdlib.h>

static int compare(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

struct spread spread_of(const double *samples, int count) {
    struct spread s = {NAN, NAN, NAN, 0};
    double sorted[SPREAD_MOST];
    for (int i = 0; i < count && s.count < SPREAD_MOST; i++)
        if (!isnan(samples[i])) sorted[s.count++] = samples[i];
    if (s.count == 0) return s;
    qsort(sorted, (size_t)s.count, sizeof *sorted, compare);
    s.least = sorted[0];
    s.median = 0.5 * (sorted[(s.count - 1) / 2] + sorted[s.count / 2]);
    s.greatest = sorted[s.count - 1];
    return s;
}

struct spread spread_of_ratios(const double *above, const double *below, int count) {
    double ratio[SPREAD_MOST];
    const int used = count < SPREAD_MOST ? count : SPREAD_MOST;
    for (int i = 0; i < used; i++) ratio[i] = above[i] / below[i];
    return spread_of(ratio, used);
}

double growth_exponent(const double *size, const double *time, int count) {
    double mean_x = 0, mean_y = 0, square = 0, product = 0;
    for (int i = 0; i < count; i++) {
        if (!(size[i] > 0) || !(time[i] > 0)) return NAN;
        mean_x += log(size[i]) / count;
        mean_y += log(time[i]) / count;
    }
    for (int i = 0; i < count; i++) {
        const double x = log(size[i]) - mean_x;
        square += x * x;
        product += x * (log(time[i]) - mean_y);
    }
    return square > 1e-12 ? product / square : NAN;
}
