/* Chi-square tests. With seeded numbers a test either always passes or always fails; the levels say how unlucky a correct program
 * would have to be. */
#ifndef SUPPORT_STATISTICS_H
#define SUPPORT_STATISTICS_H

/* Sum of (observed - expected)^2 / expected. */
double chi_square(const double *observed, const double *expected, int count);
/* The value that chi-square with so many degrees of freedom exceeds once in a million, by Wilson and Hilferty's approximation. */
double chi_square_limit(int freedom);
/* The standard normal distribution function, and its inverse by bisection. */
double normal_probability(double x);
double normal_inverse(double p);

#endif
