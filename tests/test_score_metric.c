/* Scoring in the metric of a background, on a tracker's own vectors: every distance against its definition, in double, with M
 * formed as a dense matrix. In M's inner product, a candidate's basis is that of its set's n dominant directions, a model's basis
 * is made orthonormal, angles and lengths are M's, and the background's ratio is taken off. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "eigen.h"
#include "metric.h"
#include "subspace.h"
#include "support_matrix.h"
#include "support_precision.h"
#include "support_render.h"
#include "support_tracker.h"
#include "unity.h"

enum { MOST_IMAGES = AST_MAX_HISTORY + 1, MOST_MODELS = 20 };

static char label[200];

void setUp(void) {
    TEST_ASSERT_EQUAL_INT(0, backends_prepare());
}
void tearDown(void) {
}

/* ---- The definition ---- */

/* Everything that a frame's candidates are compared with, copied from a tracker before a step. */
struct known {
    ast_config cfg;
    int dim, images, models; /* of the history, of the bag */
    int slot[MOST_MODELS];   /* where each model stands among the distances */
    int rank[MOST_MODELS];
    double *history; /* columns of dim */
    double *mean;    /* of each model */
    double *basis;   /* n columns of each */
    double *origin;  /* the background's mean */
    double *metric;  /* M: dim x dim */
};

static void widen(double *to, const float *from, int count) {
    for (int i = 0; i < count; i++) to[i] = (double)from[i];
}

/* The inverse of a symmetric positive definite n x n matrix, in place, by Gauss and Jordan. */
static void invert(double *a, int n) {
    for (int k = 0; k < n; k++) {
        const double pivot = a[k * n + k];
        a[k * n + k] = 1;
        for (int j = 0; j < n; j++) a[j * n + k] /= pivot;
        for (int i = 0; i < n; i++) {
            if (i == k) continue;
            const double factor = a[k * n + i];
            a[k * n + i] = 0;
            for (int j = 0; j < n; j++) a[j * n + i] -= factor * a[j * n + k];
        }
    }
}

/* M = I - Zc' (Zc Zc' + ridge tr(Zc Zc') I)^-1 Zc. */
static void form_metric(struct known *known, const struct ast_background *background) {
    const int dim = known->dim, size = background->size;
    double *centred = matrix_new(dim, size), *square = matrix_new(size, size), *rows = matrix_new(dim, size), trace = 0;
    for (int z = 0; z < size; z++)
        for (int d = 0; d < dim; d++)
            centred[z * dim + d] = (double)background->set[z * background->stride + d] - (double)background->mean[d];
    matrix_product_transposed(size, size, dim, centred, centred, square);
    for (int z = 0; z < size; z++) trace += square[z * size + z];
    for (int z = 0; z < size; z++) square[z * size + z] += (double)known->cfg.ridge * trace;
    for (int d = 0; d < dim; d++) known->metric[d * dim + d] = 1;
    if (trace > 0) {
        invert(square, size);
        matrix_product(dim, size, size, centred, square, rows);
        for (int j = 0; j < dim; j++)
            for (int z = 0; z < size; z++)
                for (int i = 0; i < dim; i++) known->metric[j * dim + i] -= rows[z * dim + i] * centred[z * dim + j];
    }
    free(centred);
    free(square);
    free(rows);
}

static struct known known_from(const ast_tracker *t) {
    struct known known = {.cfg = t->cfg, .dim = t->dim, .images = t->history.count, .models = t->bag.count};
    const int dim = t->dim, n = t->cfg.basis_size;
    known.history = matrix_new(dim, known.images);
    known.mean = matrix_new(dim, known.models);
    known.basis = matrix_new(dim, known.models * n);
    known.origin = matrix_new(dim, 1);
    known.metric = matrix_new(dim, dim);
    for (int j = 0; j < known.images; j++) widen(known.history + j * dim, ast_history_patch(&t->history, j), dim);
    for (int m = 0; m < known.models; m++) {
        ast_subspace model;
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_model(t, m, &model));
        known.slot[m] = ast_bag_slot(&t->bag, m);
        known.rank[m] = model.rank;
        widen(known.mean + m * dim, model.mean, dim);
        for (int l = 0; l < n; l++) widen(known.basis + (m * n + l) * dim, model.basis + l * model.stride, dim);
    }
    widen(known.origin, t->background.mean, dim);
    form_metric(&known, &t->background);
    return known;
}

static void known_free(struct known *known) {
    free(known->history);
    free(known->mean);
    free(known->basis);
    free(known->origin);
    free(known->metric);
}

/* An orthonormal basis in M of the columns' span, dominant directions first; as many columns as exceed the tolerance. in_m: the
 * columns times M; out, out_m: the basis, and it times M. */
static int orthonormal(const double *columns, const double *in_m, int dim, int count, double tolerance, double *out,
                       double *out_m) {
    ast_real gram[MOST_IMAGES * MOST_IMAGES], vectors[MOST_IMAGES * MOST_IMAGES], values[MOST_IMAGES];
    double products[MOST_IMAGES * MOST_IMAGES];
    int rank = 0;
    matrix_product_transposed(count, count, dim, columns, in_m, products);
    for (int i = 0; i < count * count; i++) gram[i] = (ast_real)products[i];
    ast_eigen_symmetric(count, gram, values, vectors);
    while (rank < count && values[rank] > 0 && sqrt((double)values[rank]) > tolerance) {
        for (int j = 0; j < count; j++) products[rank * count + j] = (double)vectors[rank * count + j] / sqrt((double)values[rank]);
        rank++;
    }
    matrix_product(dim, rank, count, columns, products, out);
    matrix_product(dim, rank, count, in_m, products, out_m);
    return rank;
}

static double dot(const double *x, const double *y, int dim) {
    double sum = 0;
    for (int d = 0; d < dim; d++) sum += x[d] * y[d];
    return sum;
}

/* Distances of a candidate to all models, by model. */
static void distances(const struct known *known, const float *vector, double *distance) {
    const int dim = known->dim, count = known->images + 1, n = known->cfg.basis_size;
    double *set = matrix_new(dim, count), *set_m = matrix_new(dim, count), *own = matrix_new(dim, count),
           *own_m = matrix_new(dim, count);
    double *other = matrix_new(dim, n), *other_m = matrix_new(dim, n), *model_m = matrix_new(dim, n);
    double *mean = matrix_new(dim, 1), *gap = matrix_new(dim, 1), *gap_m = matrix_new(dim, 1), norm = 0;
    memcpy(set, known->history, (size_t)(dim * known->images) * sizeof *set);
    widen(set + known->images * dim, vector, dim);
    for (int i = 0; i < dim * count; i++) norm += set[i] * set[i];
    for (int d = 0; d < dim; d++) {
        for (int j = 0; j < count; j++) mean[d] += set[j * dim + d] / count;
        const double origin = known->cfg.basis == AST_BASIS_CENTRED ? mean[d] : known->origin[d];
        for (int j = 0; j < count; j++) set[j * dim + d] -= origin;
    }
    matrix_product(dim, count, dim, known->metric, set, set_m);
    const int found = orthonormal(set, set_m, dim, count, (double)AST_RANK_TOLERANCE * sqrt(norm), own, own_m);
    const int rank = found < n ? found : n;

    for (int m = 0; m < known->models; m++) {
        const double *basis = known->basis + m * n * dim;
        const int model_rank = known->rank[m], least = rank < model_rank ? rank : model_rank;
        double cross[MOST_IMAGES * MOST_IMAGES], square[MOST_IMAGES * MOST_IMAGES];
        ast_real gram[MOST_IMAGES * MOST_IMAGES], cosines[MOST_IMAGES];
        matrix_product(dim, model_rank, dim, known->metric, basis, model_m);
        TEST_ASSERT_EQUAL_INT(model_rank, orthonormal(basis, model_m, dim, model_rank, 0, other, other_m));

        /* Principal angles: arccosines of the singular values of U_i'M U_j; directions absent from one alone are at right
         * angles. */
        matrix_product_transposed(rank, model_rank, dim, own, other_m, cross);
        matrix_product_transposed(model_rank, model_rank, rank, cross, cross, square);
        for (int i = 0; i < model_rank * model_rank; i++) gram[i] = (ast_real)square[i];
        ast_eigen_symmetric(model_rank, gram, cosines, NULL);
        double geodesic = (rank + model_rank - 2 * least) * 2.4674011002723395;
        for (int l = 0; l < least; l++) {
            const double cosine = cosines[l] > 0 ? fmin(sqrt((double)cosines[l]), 1) : 0;
            geodesic += acos(cosine) * acos(cosine);
        }

        for (int d = 0; d < dim; d++) gap[d] = mean[d] - known->mean[m * dim + d];
        matrix_product(dim, 1, dim, known->metric, gap, gap_m);
        double term = 2 * dot(gap, gap_m, dim);
        for (int l = 0; l < rank; l++) term -= pow(dot(own_m + l * dim, gap, dim), 2);
        for (int l = 0; l < model_rank; l++) term -= pow(dot(other_m + l * dim, gap, dim), 2);
        for (int d = 0; d < dim; d++) gap[d] = mean[d] - known->origin[d];
        matrix_product(dim, 1, dim, known->metric, gap, gap_m);
        term -= 2 * (double)known->cfg.background_ratio * dot(gap, gap_m, dim);
        distance[m] = sqrt(geodesic) + (double)known->cfg.alpha * term;
    }
    free(set), free(set_m), free(own), free(own_m), free(other), free(other_m), free(model_m), free(mean), free(gap), free(gap_m);
}

/* ---- On a tracker's way ---- */

static ast_box truth(const struct render *scene, int frame) {
    return render_path(scene, frame, 30, 24, 0.2, 1.1);
}

/* The vector of a particle, in the view that the last step had. */
static void describe(ast_tracker *t, const ast_particles *p, int i, float *vector) {
    const float w = p->reference.w * p->scale[i], h = p->reference.h * p->scale[i];
    const ast_box box = {p->x[i] - 0.5f * w, p->y[i] - 0.5f * h, w, h}, window = ast_view_box(&t->view, &box);
    ast_features_vector(&t->features, &t->desk->features, &t->view.image, &window, vector);
}

/* The direction in which a patch comes nearer to the models: M times the sum of mu_j - m_b, each with its say and a little more; of
 * its first floats. Returns the length of the difference, relative to the direction's own. */
static double direction_difference(const struct known *known, const float *say, int length, const float *found) {
    const int dim = known->dim;
    double *sum = matrix_new(dim, 1), *expected = matrix_new(dim, 1), square = 0, difference = 0;
    for (int m = 0; m < known->models; m++)
        for (int d = 0; d < dim; d++)
            sum[d] += ((double)say[known->slot[m]] + 1e-3) * (known->mean[m * dim + d] - known->origin[d]);
    matrix_product(dim, 1, dim, known->metric, sum, expected);
    for (int d = 0; d < length; d++) {
        square += expected[d] * expected[d];
        difference += pow((double)found[d] - expected[d], 2);
    }
    free(sum);
    free(expected);
    return sqrt(difference / square);
}

/* Follows the target for some frames and compares every `every`-th particle's distances. Returns the largest difference relative to
 * 1 + |distance|. */
static double largest_difference(const ast_config *cfg, const struct ast_linalg *la, int frames, int every) {
    struct render scene;
    double worst = 0, expected[MOST_MODELS];
    float say[MOST_MODELS];
    int compared = 0;
    ast_tracker *t = tracker_new(cfg, la);
    float *vector = malloc((size_t)t->dim * sizeof *vector);
    TEST_ASSERT_NOT_NULL(vector);
    render_open(&scene, 150, 110, 3);
    const ast_box first = truth(&scene, 0);
    const ast_frame start = render_frame(&scene, &first);
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_start(t, &start, &first));
    for (int f = 1; f <= frames; f++) {
        const ast_box box = truth(&scene, f);
        const ast_frame frame = render_frame(&scene, &box);
        ast_particles p;
        const int compare = t->bag.count > 0;
        struct known known = {0};
        if (compare) known = known_from(t);
        memcpy(say, t->bag.say, (size_t)t->bag.count * sizeof *say);
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(t, &frame, NULL));
        if (compare) worst = fmax(worst, direction_difference(&known, say, ast_features_glance_length(cfg), t->direction));
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(t, &p));
        for (int i = f % every; i < p.scored && compare; i += every) {
            describe(t, &p, i, vector);
            distances(&known, vector, expected);
            for (int m = 0; m < known.models; m++) {
                const double found = (double)p.distance[i * p.models + known.slot[m]];
                TEST_ASSERT_FALSE_MESSAGE(isnan(found), label);
                worst = fmax(worst, fabs(found - expected[m]) / (1 + fabs(expected[m])));
                compared++;
            }
        }
        if (compare) known_free(&known);
    }
    TEST_ASSERT_TRUE(compared >= 16);
    render_close(&scene);
    ast_free(t);
    free(vector);
    return worst;
}

static void assert_agrees(const ast_config *cfg, const struct ast_linalg *la, int frames, int every, double limit) {
    const double worst = largest_difference(cfg, la, frames, every);
    char message[300];
    snprintf(message, sizeof message, "%s: differs by %g", label, worst);
    if (getenv("AST_TEST_VERBOSE")) puts(message);
    TEST_ASSERT_TRUE_MESSAGE(worst < limit, message);
}

/* Both bases, with and without the ratio, histories and bases of all kinds, ridges from the least to a large one. */
static void test_distances_are_the_dense_ones(void) {
    /* P, n. The sixth direction of seven vectors that follow each other is all but absent: in single precision rounding decides. */
    const int shapes[][2] = {{1, 1}, {1, 2}, {3, 3}, {4, 2}, {6, AST_REAL_IS_DOUBLE ? 7 : 4}};
    static const float ridges[] = {1e-4f, 0.01f, 0.1f, 100.0f};
    for (int b = 0; b < BACKENDS; b++)
        for (int which = 0; which < 20; which++) {
            ast_config cfg = small_robust_config();
            cfg.guard = 0.0f;
            cfg.history = shapes[which % 5][0];
            cfg.basis_size = shapes[which % 5][1];
            cfg.basis = which & 1 ? AST_BASIS_CENTRED : AST_BASIS_RAW;
            cfg.background_ratio = which & 2 ? 0.0f : 1.0f;
            cfg.ridge = ridges[which / 5];
            if (which % 4 == 3) cfg.gradient_weight = 0.0f;
            snprintf(label, sizeof label, "%s, P %d, n %d, %s, ratio %g, ridge %g", backends[b]->name, cfg.history, cfg.basis_size,
                     cfg.basis == AST_BASIS_RAW ? "raw" : "centred", (double)cfg.background_ratio, (double)cfg.ridge);
            assert_agrees(&cfg, backends[b], cfg.history + 4, 5, by_real(1e-4, 3e-4));
        }
}

/* The preset itself: 1408 numbers a vector, 40 background vectors, a full history. */
static void test_distances_of_the_robust_preset(void) {
    ast_config cfg;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&cfg, AST_PRESET_ROBUST));
    snprintf(label, sizeof label, "robust preset");
    assert_agrees(&cfg, backends[0], 4, 7, 1e-4);
}

/* ---- Scenes that are hard to take apart ---- */

/* A tracker that has seen some frames, as a bench: its history and background are overwritten, its models stay. */
static ast_tracker *bench_new(const ast_config *cfg, const struct ast_linalg *la) {
    struct render scene;
    ast_tracker *t = tracker_new(cfg, la);
    render_open(&scene, 150, 110, 4);
    for (int f = 0; f < cfg->history + 4; f++) {
        const ast_box box = truth(&scene, f);
        const ast_frame frame = render_frame(&scene, &box);
        if (f == 0)
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_start(t, &frame, &box));
        else
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(t, &frame, NULL));
    }
    TEST_ASSERT_TRUE(t->bag.count > 1 && t->history.count == cfg->history);
    render_close(&scene);
    return t;
}

static float *history_of(ast_tracker *t, int j) {
    return t->history.patches + j * t->stride;
}

/* Distances of count vectors (t->stride apart) to all slots of the bag. */
static void score(ast_tracker *t, const float *vectors, int count, float *distance) {
    const struct ast_scene scene = {.cfg = &t->cfg,
                                    .la = t->la,
                                    .kernels = ast_kernels(),
                                    .history = &t->history,
                                    .bag = &t->bag,
                                    .background = t->background.size,
                                    .spare = t->desk->tile,
                                    .work = t->desk->work,
                                    .work_count = t->work_count};
    TEST_ASSERT_LESS_OR_EQUAL_INT(AST_TILE, count);
    ast_bag_mark(&t->bag); /* the tests write where they like */
    TEST_ASSERT_EQUAL_INT(0, t->scoring->prepare(&t->scoring_scratch, &t->desk->scoring, &scene));
    memcpy(t->desk->tile, vectors, (size_t)(count * t->stride) * sizeof *vectors);
    TEST_ASSERT_EQUAL_INT(0, t->scoring->tile(&t->scoring_scratch, &t->desk->scoring, &scene, t->desk->tile, count, distance));
}

/* Largest difference from the definition, relative to 1 + |distance|. */
static double difference(ast_tracker *t, const float *vectors, int count) {
    struct known known = known_from(t);
    float found[AST_TILE * MOST_MODELS];
    double expected[MOST_MODELS], worst = 0;
    score(t, vectors, count, found);
    for (int i = 0; i < count; i++) {
        distances(&known, vectors + i * t->stride, expected);
        for (int m = 0; m < known.models; m++) {
            const double value = (double)found[i * known.models + known.slot[m]];
            TEST_ASSERT_TRUE_MESSAGE(isfinite(value), label);
            worst = fmax(worst, fabs(value - expected[m]) / (1 + fabs(expected[m])));
        }
    }
    known_free(&known);
    return worst;
}

static ast_config bench_config(int which) {
    ast_config cfg = small_robust_config();
    cfg.guard = 0.0f; /* every frame is learned from */
    cfg.basis = which & 1 ? AST_BASIS_CENTRED : AST_BASIS_RAW;
    return cfg;
}

/* Histories whose vectors differ by less and less, and candidates that differ from them as little: what decides lies in
 * differences. */
static void test_histories_that_are_nearly_frozen(void) {
    struct noise noise = {5};
    for (int b = 0; b < BACKENDS; b++)
        for (int which = 0; which < 2; which++) {
            const ast_config cfg = bench_config(which);
            ast_tracker *t = bench_new(&cfg, backends[b]);
            float *base = malloc((size_t)(7 * t->stride) * sizeof *base), *vectors = base + t->stride;
            TEST_ASSERT_NOT_NULL(base);
            memcpy(base, history_of(t, 0), (size_t)t->dim * sizeof *base);
            /* A second direction that lies so far beside the first is known to FLT_EPSILON / apart: 1.2e-3 for
             * 1e-4. Nearer, it is absent. */
            for (double apart = 0.1; apart > 1e-5; apart *= 0.1) {
                for (int j = 0; j < cfg.history + 6; j++) {
                    float *to = j < cfg.history ? history_of(t, j) : vectors + (j - cfg.history) * t->stride;
                    for (int d = 0; d < t->dim; d++) to[d] = base[d] + (float)(apart * noise_normal(&noise) / sqrt(t->dim));
                }
                snprintf(label, sizeof label, "%s, %s, %g apart", backends[b]->name, which ? "centred" : "raw", apart);
                const double worst = difference(t, vectors, 6);
                if (getenv("AST_TEST_VERBOSE")) printf("%s: %g\n", label, worst);
                TEST_ASSERT_TRUE_MESSAGE(
                    worst < (apart > 5e-4 ? 1e-4 : 2 * (double)FLT_EPSILON / 1e-4) + fmin(real_basis_slack(1 / apart), 0.1), label);
            }
            free(base);
            ast_free(t);
        }
}

/* Candidates at special places: in the history, between its vectors, at the background's mean and among its vectors, at nothing. */
static void test_candidates_at_special_places(void) {
    enum { COUNT = 7 };
    for (int b = 0; b < BACKENDS; b++)
        for (int which = 0; which < 2; which++) {
            const ast_config cfg = bench_config(which);
            ast_tracker *t = bench_new(&cfg, backends[b]);
            float *vectors = calloc((size_t)(COUNT * t->stride), sizeof *vectors);
            TEST_ASSERT_NOT_NULL(vectors);
            for (int d = 0; d < t->dim; d++) {
                const float places[COUNT] = {history_of(t, 1)[d],
                                             0.5f * (history_of(t, 0)[d] + history_of(t, 2)[d]),
                                             t->background.mean[d],
                                             t->background.set[3 * t->stride + d],
                                             0.0f,
                                             ast_bag_mean(&t->bag, 0)[d],
                                             2.0f * history_of(t, 0)[d] - history_of(t, 1)[d]};
                for (int i = 0; i < COUNT; i++) vectors[i * t->stride + d] = places[i];
            }
            for (int i = 0; i < COUNT; i++) {
                snprintf(label, sizeof label, "%s, %s, place %d", backends[b]->name, which ? "centred" : "raw", i);
                const double worst = difference(t, vectors + i * t->stride, 1);
                if (getenv("AST_TEST_VERBOSE")) printf("%s: %g\n", label, worst);
                TEST_ASSERT_TRUE_MESSAGE(worst < 1e-4, label);
            }
            free(vectors);
            ast_free(t);
        }
}

/* Candidates that leave the history's span by less and less, in a metric that shrinks the span because the background varies as the
 * object does. What they leave it by is a direction of their own down to a two-hundredth of the way from the history's mean; what
 * is a thousandth of that is none. Where the metric has shrunk the way itself, rounding must not pass for one either. */
static void test_candidates_that_hardly_leave_the_history(void) {
    static const double outside[] = {1, 0.1, 0.01, 0.005, 3e-6, 0};
    static const float ridges[] = {0.1f, 1e-3f, 1e-4f};
    enum { LENGTHS = sizeof outside / sizeof outside[0] };
    struct noise noise = {7};
    for (int b = 0; b < BACKENDS; b++)
        for (int which = 0; which < 12; which++) {
            ast_config cfg = bench_config(which);
            cfg.ridge = ridges[which / 2 % 3];
            /* A centred set of four has three directions; in single precision rounding may pass for a fourth. */
            cfg.basis_size = which < 6 || !AST_REAL_IS_DOUBLE ? 3 : 4;
            ast_tracker *t = bench_new(&cfg, backends[b]);
            float *vectors = calloc((size_t)(LENGTHS * t->stride), sizeof *vectors);
            double *mean = matrix_new(t->dim, 1), *way = matrix_new(t->dim, 1), *off = matrix_new(t->dim, 1);
            TEST_ASSERT_NOT_NULL(vectors);
            noise_fill_normal(&noise, off, (size_t)t->dim);
            const double along[] = {noise_normal(&noise), noise_normal(&noise)};
            for (int d = 0; d < t->dim; d++) {
                for (int j = 0; j < 3; j++) mean[d] += (double)history_of(t, j)[d] / 3;
                for (int j = 0; j < 2; j++) way[d] += along[j] * ((double)history_of(t, j)[d] - mean[d]);
            }
            const double scale = sqrt(dot(way, way, t->dim) / dot(off, off, t->dim));
            for (int i = 0; i < LENGTHS; i++)
                for (int d = 0; d < t->dim; d++)
                    vectors[i * t->stride + d] = (float)(mean[d] + way[d] + outside[i] * scale * off[d]);
            for (int z = 0; z < t->background.size; z++)
                for (int d = 0; d < t->dim; d++)
                    t->background.set[z * t->stride + d] =
                        history_of(t, z % 3)[d] + (float)(0.003 * (double)(z % 5) * noise_normal(&noise) / sqrt(t->dim));
            ast_background_average(&t->background);
            for (int i = 0; i < LENGTHS; i++) {
                snprintf(label, sizeof label, "%s, %s, n %d, ridge %g, %g outside", backends[b]->name,
                         which & 1 ? "centred" : "raw", cfg.basis_size, (double)cfg.ridge, outside[i]);
                const double worst = difference(t, vectors + i * t->stride, 1);
                if (getenv("AST_TEST_VERBOSE")) printf("%s: %g\n", label, worst);
                TEST_ASSERT_TRUE_MESSAGE(worst < by_real(1e-3, 5e-2),
                                         label); /* in single precision its rounding is near the least */
            }
            free(vectors), free(mean), free(way), free(off);
            ast_free(t);
        }
}

/* Backgrounds that look like the object, that do not vary, that are nothing; histories that are frozen or nothing. */
static void test_scenes_without_variation(void) {
    enum { LIKE_OBJECT, FLAT, NOTHING, FROZEN, BLACK, ALL_ALIKE, SCENES };
    for (int b = 0; b < BACKENDS; b++)
        for (int which = 0; which < 2 * SCENES; which++) {
            const ast_config cfg = bench_config(which);
            ast_tracker *t = bench_new(&cfg, backends[b]);
            const size_t bytes = (size_t)t->dim * sizeof(float);
            float *vectors = malloc((size_t)(3 * t->stride) * sizeof *vectors), *flat = malloc(bytes);
            TEST_ASSERT_TRUE(vectors != NULL && flat != NULL);
            const int scene = which / 2;
            for (int j = 0; j < 3; j++) memcpy(vectors + j * t->stride, j < 2 ? history_of(t, j) : t->background.set, bytes);
            memcpy(flat, scene == ALL_ALIKE ? history_of(t, 0) : t->background.mean, bytes);
            if (scene == NOTHING) memset(flat, 0, bytes);
            for (int z = 0; z < t->background.size; z++) {
                float *to = t->background.set + z * t->stride;
                if (scene == LIKE_OBJECT) memcpy(to, history_of(t, z % cfg.history), bytes);
                if (scene == FLAT || scene == NOTHING || scene == ALL_ALIKE) memcpy(to, flat, bytes);
            }
            if (scene != FROZEN && scene != BLACK) ast_background_average(&t->background);
            if (scene == FLAT || scene == NOTHING || scene == ALL_ALIKE) memcpy(t->background.mean, flat, bytes);
            for (int j = 0; j < cfg.history; j++) {
                if (scene == FROZEN || scene == ALL_ALIKE) memcpy(history_of(t, j), vectors, bytes);
                if (scene == BLACK) memset(history_of(t, j), 0, bytes);
            }
            snprintf(label, sizeof label, "%s, %s, scene %d", backends[b]->name, which & 1 ? "centred" : "raw", scene);
            const double worst = difference(t, vectors, 3);
            if (getenv("AST_TEST_VERBOSE")) printf("%s: %g\n", label, worst);
            TEST_ASSERT_TRUE_MESSAGE(worst < 1e-4, label);
            free(vectors);
            free(flat);
            ast_free(t);
        }
}

/* A candidate's distances are its own: whatever else is in the tile, wherever it stands there. */
static void test_tiles_of_any_size_give_the_same_distances(void) {
    for (int b = 0; b < BACKENDS; b++) {
        const ast_config cfg = bench_config(0);
        ast_tracker *t = bench_new(&cfg, backends[b]);
        float whole[AST_TILE * MOST_MODELS], alone[MOST_MODELS];
        float *vectors = malloc((size_t)(AST_TILE * t->stride) * sizeof *vectors);
        struct noise noise = {6};
        TEST_ASSERT_NOT_NULL(vectors);
        for (int i = 0; i < AST_TILE; i++)
            for (int d = 0; d < t->dim; d++)
                vectors[i * t->stride + d] = history_of(t, i % 3)[d] + (float)(0.3 * noise_normal(&noise) / sqrt(t->dim));
        score(t, vectors, AST_TILE, whole);
        for (int i = 0; i < AST_TILE; i++) {
            score(t, vectors + i * t->stride, 1, alone);
            for (int j = 0; j < t->bag.count; j++)
                TEST_ASSERT_DOUBLE_WITHIN(1e-5 * (1 + fabs((double)alone[j])), (double)alone[j],
                                          (double)whole[i * t->bag.count + j]);
        }
        free(vectors);
        ast_free(t);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_distances_are_the_dense_ones);
    RUN_TEST(test_distances_of_the_robust_preset);
    RUN_TEST(test_histories_that_are_nearly_frozen);
    RUN_TEST(test_candidates_at_special_places);
    RUN_TEST(test_candidates_that_hardly_leave_the_history);
    RUN_TEST(test_scenes_without_variation);
    RUN_TEST(test_tiles_of_any_size_give_the_same_distances);
    return UNITY_END();
}
