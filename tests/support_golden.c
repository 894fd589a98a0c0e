#include "support_golden.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "eigen.h"
#include "support_precision.h"

static const char *fault = "";

static int wrong(const char *what) {
    fault = what;
    return -1;
}

const char *golden_fault(void) {
    return fault;
}

static int read_images(FILE *file, struct golden_set *set, int dim) {
    if (set->count < 1 || set->count > GOLDEN_MOST_IMAGES || set->count * dim > GOLDEN_MOST_VALUES) return wrong("too many images");
    for (int i = 0; i < set->count * dim; i++)
        if (fscanf(file, "%f", &set->images[i]) != 1) return wrong("an image's value is missing");
    return 0;
}

int golden_next(FILE *file, struct golden_case *golden) {
    char word[16], kind[16];
    for (;;) {
        if (fscanf(file, "%15s", word) != 1) return feof(file) ? 0 : wrong("the file cannot be read");
        if (word[0] != '#') break;
        int c;
        do c = fgetc(file);
        while (c != '\n' && c != EOF);
    }
    if (strcmp(word, "case") != 0 || fscanf(file, " %63s", golden->name) != 1) return wrong("no case where one should begin");
    if (fscanf(file, " basis %15s n %d alpha %lf D %d m %d %d", kind, &golden->n, &golden->alpha, &golden->dim, &golden->a.count,
               &golden->b.count) != 6)
        return wrong("a case's second line");
    if (golden->n < 1 || golden->n > AST_MAX_BASIS || golden->dim < 1) return wrong("n or D out of range");
    if (strcmp(kind, "centred") != 0 && strcmp(kind, "raw") != 0) return wrong("an unknown basis");
    golden->basis = strcmp(kind, "raw") == 0 ? AST_BASIS_RAW : AST_BASIS_CENTRED;
    if (read_images(file, &golden->a, golden->dim) != 0 || read_images(file, &golden->b, golden->dim) != 0) return -1;

    if (fscanf(file, " ranks %d %d angles", &golden->a.rank, &golden->b.rank) != 2) return wrong("a case's ranks");
    for (int l = 0; l < golden->n; l++)
        if (fscanf(file, "%lf", &golden->angles[l]) != 1) return wrong("a case's angles");
    if (fscanf(file, " geodesic %lf mahalanobis %lf distance %lf %15s", &golden->geodesic, &golden->mahalanobis, &golden->distance,
               word) != 4 ||
        strcmp(word, "end") != 0)
        return wrong("a case's last lines");
    return 1;
}

double golden_angle_slack(double angle) {
    const double cosine = real_cosine_slack(), far = cosine / (sin(angle) + 1e-300), near = sqrt(2 * cosine);
    return cosine + (far < near ? far : near);
}

double golden_geodesic_slack(const struct golden_case *golden) {
    double sum = 0;
    for (int l = 0; l < golden->n; l++) sum += golden_angle_slack(golden->angles[l]) * golden_angle_slack(golden->angles[l]);
    return sqrt(sum);
}

static double mean_at(const struct golden_set *set, int dim, int d) {
    double sum = 0;
    for (int j = 0; j < set->count; j++) sum += (double)set->images[j * dim + d];
    return sum / set->count;
}

/* Whether the n-th singular value of a set equals the next: then any of many bases is dominant, and the term depends on which.
 * *condition is raised to the set's: its norm over the least singular value that counts. */
static int is_ambiguous(const struct golden_set *set, const struct golden_case *golden, double *condition) {
    const int count = set->count, dim = golden->dim, n = golden->n;
    double norm = 0;
    ast_real scatter[GOLDEN_MOST_IMAGES * GOLDEN_MOST_IMAGES], squares[GOLDEN_MOST_IMAGES];
    for (int i = 0; i < count * count; i++) {
        const float *x = set->images + i / count * dim, *y = set->images + i % count * dim;
        scatter[i] = 0;
        for (int d = 0; d < dim; d++) {
            const double origin = golden->basis == AST_BASIS_CENTRED ? mean_at(set, dim, d) : 0;
            scatter[i] += (ast_real)(((double)x[d] - origin) * ((double)y[d] - origin));
        }
    }
    for (int j = 0; j < count; j++) norm += (double)scatter[j * count + j];
    ast_eigen_symmetric(count, scatter, squares, NULL);
    if (set->rank > 0) *condition = fmax(*condition, sqrt(norm / fmax((double)squares[set->rank - 1], 1e-10 * norm)));
    return set->rank == n && n < count && squares[n - 1] - squares[n] < (ast_real)1e-5 * squares[n - 1];
}

/* The term is a difference of squares of d, and the means that d comes from are rounded too. */
double golden_mahalanobis_slack(const struct golden_case *golden) {
    double size = 0, length = 0;
    for (int d = 0; d < golden->dim; d++) {
        const double a = mean_at(&golden->a, golden->dim, d), b = mean_at(&golden->b, golden->dim, d);
        length += (a - b) * (a - b);
        size += a * a + b * b;
    }
    double condition = 1;
    if (is_ambiguous(&golden->a, golden, &condition) || is_ambiguous(&golden->b, golden, &condition)) return 2 * length;
    const double of_means = (double)FLT_EPSILON * sqrt(size), of_difference = (double)FLT_EPSILON * sqrt(length);
    return real_cosine_slack() / (double)FLT_EPSILON * (of_means + of_difference) * (sqrt(length) + of_means) +
           real_basis_slack(condition) * length;
}
