#include "support_statistics.h"

#include <math.h>

double chi_square(const double *observed, const double *expected, int count) {
    double sum = 0;
    for (int i = 0; i < count; i++) sum += (observed[i] - expected[i]) * (observed[i] - expected[i]) / expected[i];
    return sum;
}

double chi_square_limit(int freedom) {
    const double z = 4.753424; /* exceeded by a standard normal once in a million */
    const double spread = 2.0 / (9.0 * freedom), root = 1.0 - spread + z * sqrt(spread);
    return freedom * root * root * root;
}

double normal_probability(double x) {
    return 0.5 * erfc(-x / 1.4142135623730951);
}

/* The lower tail only: there erfc keeps its relative accuracy. */
double normal_inverse(double p) {
    if (p > 0.5) return -normal_inverse(1.0 - p);
    double low = -40, high = 0;
    for (int i = 0; i < 200; i++) {
        const double middle = 0.5 * (low + high);
        if (normal_probability(middle) < p)
            low = middle;
        else
            high = middle;
    }
    return 0.5 * (low + high);
}
