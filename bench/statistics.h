/* What the bench makes of its samples. */
#ifndef STATISTICS_H
#define STATISTICS_H

/* nan in all three where there is no sample. */
struct spread {
    double least, median, greatest;
    int count;
};

enum { SPREAD_MOST = 1024 }; /* samples that are looked at */
/* Samples that are nan are left out. */
struct spread spread_of(const double *samples, int count);
/* The quotients above[i] / below[i] of samples taken side by side: what slows both down cancels. */
struct spread spread_of_ratios(const double *above, const double *below, int count);
/* The exponent e of the power law time = factor size^e that fits best: least squares between the logarithms. nan for fewer than two
 * different sizes, or anything not above zero. */
double growth_exponent(const double *size, const double *time, int count);

#endif
