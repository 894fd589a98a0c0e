#include "support_matrix.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

double *matrix_new(int rows, int cols) {
    double *x = calloc((size_t)rows * (size_t)cols + 1, sizeof *x);
    if (x == NULL) {
        fprintf(stderr, "no memory for a %d x %d matrix\n", rows, cols);
        exit(1);
    }
    return x;
}

void matrix_product(int rows, int cols, int inner, const double *a, const double *b, double *c) {
    for (int j = 0; j < cols; j++) {
        for (int i = 0; i < rows; i++) {
            double sum = 0;
            for (int k = 0; k < inner; k++)
                sum += a[(size_t)k * (size_t)rows + (size_t)i] * b[(size_t)j * (size_t)inner + (size_t)k];
            c[(size_t)j * (size_t)rows + (size_t)i] = sum;
        }
    }
}

void matrix_product_transposed(int rows, int cols, int depth, const double *a, const double *b, double *c) {
    for (int j = 0; j < cols; j++) {
        for (int i = 0; i < rows; i++) {
            double sum = 0;
            for (int d = 0; d < depth; d++)
                sum += a[(size_t)i * (size_t)depth + (size_t)d] * b[(size_t)j * (size_t)depth + (size_t)d];
            c[(size_t)j * (size_t)rows + (size_t)i] = sum;
        }
    }
}

/* Gram and Schmidt's orthogonalisation of normal vectors, each taken twice: once leaves errors where a vector nearly depends on the
 * ones before. */
void matrix_orthonormal(struct noise *noise, int rows, int cols, double *q) {
    noise_fill_normal(noise, q, (size_t)rows * (size_t)cols);
    for (int j = 0; j < cols; j++) {
        double *x = q + (size_t)j * (size_t)rows;
        for (int pass = 0; pass < 2; pass++) {
            for (int i = 0; i < j; i++) {
                const double *y = q + (size_t)i * (size_t)rows;
                double along = 0;
                for (int d = 0; d < rows; d++) along += x[d] * y[d];
                for (int d = 0; d < rows; d++) x[d] -= along * y[d];
            }
            double square = 0;
            for (int d = 0; d < rows; d++) square += x[d] * x[d];
            for (int d = 0; d < rows; d++) x[d] /= sqrt(square);
        }
    }
}

void matrix_with_singular_values(struct noise *noise, int rows, int cols, int count, const double *values, double *a) {
    double *u = matrix_new(rows, count), *v = matrix_new(cols, count), *transposed = matrix_new(count, cols);
    matrix_orthonormal(noise, rows, count, u);
    matrix_orthonormal(noise, cols, count, v);
    for (int l = 0; l < count; l++)
        for (int j = 0; j < cols; j++)
            transposed[(size_t)j * (size_t)count + (size_t)l] = values[l] * v[(size_t)l * (size_t)cols + (size_t)j];
    matrix_product(rows, cols, count, u, transposed, a);
    free(u);
    free(v);
    free(transposed);
}

double matrix_orthonormality_error(int rows, int cols, const double *x) {
    double *gram = matrix_new(cols, cols);
    matrix_product_transposed(cols, cols, rows, x, x, gram);
    for (int j = 0; j < cols; j++) gram[(size_t)j * (size_t)cols + (size_t)j] -= 1;
    const double worst = matrix_largest(gram, (size_t)cols * (size_t)cols);
    free(gram);
    return worst;
}

double matrix_largest(const double *x, size_t count) {
    double largest = 0;
    for (size_t i = 0; i < count; i++) {
        if (isnan(x[i])) return x[i];
        if (fabs(x[i]) > largest) largest = fabs(x[i]);
    }
    return largest;
}
