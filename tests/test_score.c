/* Distances of candidates to the bag: the two ways of scoring against each other, against the geometry functions and against golden
 * vectors, on rendered patches and on constructed ones; with every backend that is linked here. */
#include "score.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "decision.h"
#include "eigen.h"
#include "patch.h"
#include "subspace.h"
#include "support_backends.h"
#include "support_golden.h"
#include "support_matrix.h"
#include "support_precision.h"
#include "support_render.h"
#include "tracker.h"
#include "unity.h"

enum { GRAM, LITERAL, WAYS };
static const struct ast_scoring *const scorings[WAYS] = {&ast_scoring_gram, &ast_scoring_literal};

enum { CENTRED, RAW, LINEAR, KINDS };
static const char *const kind_names[KINDS] = {"centred", "raw", "linear"};

static char label[240];

void setUp(void) {
    TEST_ASSERT_EQUAL_INT(0, backends_prepare());
}
void tearDown(void) {
}

/* ---- A scene: history, models, and the scratch of both ways ---- */

enum { MOST_CANDIDATES = AST_TILE, MOST_MODELS = 12 };

struct bench {
    ast_config cfg;
    const struct ast_linalg *la;
    int dim, stride;
    struct ast_history history;
    struct ast_bag bag[WAYS]; /* the same models behind different leads */
    union ast_scratch scratch[WAYS];
    union ast_tile_scratch tile_scratch[WAYS];
    ast_real *work;
    size_t work_count;
    float *tile, *candidates; /* candidates: as given; tile: what scoring destroys */
    unsigned char *block;
    int count; /* candidates */
    float distance[WAYS][MOST_CANDIDATES * MOST_MODELS];
};

static void bench_layout(struct bench *b, struct ast_arena *arena) {
    ast_history_layout(&b->history, b->dim, b->stride, b->cfg.history, arena);
    for (int w = 0; w < WAYS; w++) {
        ast_bag_layout(&b->bag[w], b->dim, b->stride, scorings[w]->lead(&b->cfg), b->cfg.basis_size, b->cfg.bag_size,
                       b->cfg.keep_first, arena);
        scorings[w]->layout(&b->scratch[w], &b->cfg, b->dim, arena);
        scorings[w]->tile_layout(&b->tile_scratch[w], &b->cfg, b->la, b->dim, arena);
    }
    b->work_count = ast_subspace_work(b->la, b->dim, b->cfg.history + 1);
    b->work = ast_arena_take(arena, b->work_count, sizeof *b->work);
    b->tile = ast_arena_take(arena, (size_t)b->stride * MOST_CANDIDATES, sizeof *b->tile);
    b->candidates = ast_arena_take(arena, (size_t)b->stride * MOST_CANDIDATES, sizeof *b->candidates);
}

/* A scene for patches of dim floats. Memory starts as NaN: nothing may depend on what was there. */
static void bench_open_as(struct bench *b, const struct ast_linalg *la, const ast_config *cfg, int dim) {
    struct ast_arena counted = {NULL, 0};
    memset(b, 0, sizeof *b);
    b->cfg = *cfg;
    b->la = la;
    b->dim = dim;
    b->stride = (dim + 15) / 16 * 16;
    TEST_ASSERT_LESS_OR_EQUAL_INT(MOST_MODELS, cfg->bag_size);
    bench_layout(b, &counted);
    b->block = malloc(counted.used + AST_ALIGNMENT - 1);
    TEST_ASSERT_NOT_NULL(b->block);
    memset(b->block, 0xff, counted.used + AST_ALIGNMENT - 1);
    struct ast_arena bound = {ast_align(b->block), 0};
    bench_layout(b, &bound);
    TEST_ASSERT_EQUAL_UINT(counted.used, bound.used);
}

/* The paper's configuration, of these sizes. */
static ast_config config_of(int kind, int history, int n, int models) {
    ast_config cfg;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&cfg, AST_PRESET_PAPER));
    cfg.history = history;
    cfg.basis_size = n;
    cfg.bag_size = models;
    cfg.basis = kind == CENTRED ? AST_BASIS_CENTRED : AST_BASIS_RAW;
    cfg.model = kind == LINEAR ? AST_MODEL_LINEAR : AST_MODEL_AFFINE;
    return cfg;
}

static void bench_open(struct bench *b, const struct ast_linalg *la, int kind, int dim, int history, int n, int models) {
    const ast_config cfg = config_of(kind, history, n, models);
    bench_open_as(b, la, &cfg, dim);
}

static void bench_close(struct bench *b) {
    free(b->block);
}

/* Adds the model of a set of images to both bags. */
static void add_model(struct bench *b, const float *const *column, int count) {
    const struct ast_images images = {column, count, b->dim};
    const size_t work_count = ast_subspace_work(b->la, b->dim, count), area = (size_t)b->stride * (size_t)b->cfg.basis_size;
    ast_real *work = malloc(work_count * sizeof *work);
    float *mean = malloc((size_t)b->dim * sizeof *mean), *basis = malloc(area * sizeof *basis);
    int rank;
    TEST_ASSERT_TRUE(work != NULL && mean != NULL && basis != NULL);
    TEST_ASSERT_EQUAL_INT(0, ast_subspace_of(b->la, &images, b->cfg.basis == AST_BASIS_CENTRED, NULL, b->cfg.basis_size, mean,
                                             basis, b->stride, &rank, work, work_count));
    if (b->cfg.model == AST_MODEL_LINEAR) memset(mean, 0, (size_t)b->dim * sizeof *mean);
    for (int w = 0; w < WAYS; w++) ast_bag_add(&b->bag[w], mean, basis, rank);
    free(work);
    free(mean);
    free(basis);
}

static void add_candidate(struct bench *b, const float *patch) {
    TEST_ASSERT_LESS_THAN_INT(MOST_CANDIDATES, b->count);
    memcpy(b->candidates + (size_t)b->count * (size_t)b->stride, patch, (size_t)b->dim * sizeof *patch);
    b->count++;
}

/* Distances of all candidates, scored some at a time. */
static void score_in_tiles(struct bench *b, int way, int tile, float *distance) {
    const struct ast_scene scene = {.cfg = &b->cfg,
                                    .la = b->la,
                                    .kernels = ast_kernels(),
                                    .history = &b->history,
                                    .bag = &b->bag[way],
                                    .background = b->cfg.background,
                                    .spare = b->tile,
                                    .work = b->work,
                                    .work_count = b->work_count};
    const size_t column = (size_t)b->stride, models = (size_t)b->bag[way].count;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, scorings[way]->prepare(&b->scratch[way], &b->tile_scratch[way], &scene), label);
    for (int first = 0; first < b->count; first += tile) {
        const int count = b->count - first < tile ? b->count - first : tile;
        memcpy(b->tile, b->candidates + (size_t)first * column, (size_t)count * column * sizeof *b->tile);
        TEST_ASSERT_EQUAL_INT_MESSAGE(
            0,
            scorings[way]->tile(&b->scratch[way], &b->tile_scratch[way], &scene, b->tile, count, distance + (size_t)first * models),
            label);
    }
}

static void score(struct bench *b) {
    for (int w = 0; w < WAYS; w++) score_in_tiles(b, w, MOST_CANDIDATES, b->distance[w]);
}

/* ---- What may differ ---- */

/* The images of a candidate's set. */
static struct ast_images set_of(const struct bench *b, int candidate, const float *column[AST_MAX_HISTORY + 1]) {
    for (int j = 0; j < b->history.count; j++) column[j] = ast_history_patch(&b->history, j);
    column[b->history.count] = b->candidates + (size_t)candidate * (size_t)b->stride;
    const struct ast_images images = {column, b->history.count + 1, b->dim};
    return images;
}

/* How far the basis of a candidate's set is from being a matter of choice: the relative gap between its last singular value's
 * square and the next; 1 where nothing is left out. *condition: the set's norm over the least singular value that counts. */
static double basis_gap(const struct bench *b, int candidate, double *condition) {
    const float *column[AST_MAX_HISTORY + 1];
    const struct ast_images images = set_of(b, candidate, column);
    const int count = images.count, n = b->cfg.basis_size;
    ast_real scatter[(AST_MAX_HISTORY + 1) * (AST_MAX_HISTORY + 1)], square[AST_MAX_HISTORY + 1];
    double *about = matrix_new(b->dim, count), *gram = matrix_new(count, count);
    for (int d = 0; d < b->dim; d++) {
        double origin = 0;
        for (int j = 0; j < count && b->cfg.basis == AST_BASIS_CENTRED; j++) origin += (double)column[j][d] / count;
        for (int j = 0; j < count; j++) about[j * b->dim + d] = (double)column[j][d] - origin;
    }
    matrix_product_transposed(count, count, b->dim, about, about, gram);
    for (int i = 0; i < count * count; i++) scatter[i] = (ast_real)gram[i];
    ast_eigen_symmetric(count, scatter, square, NULL);
    free(about);
    free(gram);
    const double least = (double)AST_RANK_TOLERANCE * (double)AST_RANK_TOLERANCE;
    double norm = 0;
    for (int i = 0; i < count; i++) norm += (double)square[i];
    *condition = 1;
    for (int l = 0; l < n && l < count && (double)square[l] > least * norm; l++) *condition = sqrt(norm / (double)square[l]);
    return n < count && square[n - 1] > 0 ? (double)((square[n - 1] - square[n]) / square[n - 1]) : 1;
}

/* The promise is 1e-4, in single precision throughout 5e-4. Beyond it: the numbers are in single precision, arccosines near 1 are
 * good to the square root of that only, and a basis that is nearly a matter of choice turns with every rounding. */
static double slack_of(const struct bench *b, int candidate, double distance) {
    double condition;
    const double gap = basis_gap(b, candidate, &condition);
    return (by_real(1e-4, 5e-4) + fmin(real_basis_slack(condition / gap), 0.05)) * (1 + distance) +
           2 * golden_angle_slack(distance < 1.5 ? distance : 1.5) + (gap < 0.01 ? 4 * (double)FLT_EPSILON / gap : 0);
}

/* Both ways on all candidates and models; *worst, unless NULL, is raised to the largest difference. */
static void expect_agreement(struct bench *b, double *worst) {
    const int models = b->bag[GRAM].count;
    char message[400];
    score(b);
    for (int i = 0; i < b->count; i++) {
        for (int j = 0; j < models; j++) {
            const double literal = (double)b->distance[LITERAL][i * models + j], gram = (double)b->distance[GRAM][i * models + j];
            snprintf(message, sizeof message, "%s: candidate %d, model %d", label, i, j);
            TEST_ASSERT_TRUE_MESSAGE(literal >= 0, message); /* false for NaN */
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(slack_of(b, i, literal), literal, gram, message);
            if (worst != NULL && fabs(literal - gram) > *worst) *worst = fabs(literal - gram);
        }
    }
    /* The same winner, unless two tie within what the distances may differ by. */
    float weight[WAYS][MOST_CANDIDATES];
    int best[WAYS];
    double most = 0;
    for (int w = 0; w < WAYS; w++) {
        struct ast_voice voice[AST_MAX_BAG];
        ast_weigh(b->distance[w], b->count, models, &b->cfg, weight[w], voice);
        best[w] = 0;
        for (int i = 1; i < b->count; i++)
            if (weight[w][i] > weight[w][best[w]]) best[w] = i;
    }
    for (int j = 0; j < models; j++) {
        const double one = slack_of(b, best[GRAM], (double)b->distance[LITERAL][best[GRAM] * models + j]);
        const double other = slack_of(b, best[LITERAL], (double)b->distance[LITERAL][best[LITERAL] * models + j]);
        if (one + other > most) most = one + other;
    }
    TEST_ASSERT_TRUE_MESSAGE(
        (double)weight[LITERAL][best[GRAM]] >= (double)weight[LITERAL][best[LITERAL]] * exp(-most / (double)b->cfg.sigma), label);
}

/* ---- Rendered patches ---- */

/* A video of the target, and the patches of its true boxes, frame by frame. */
enum { FILM_FRAMES = 64 };
struct film {
    struct render render;
    struct ast_sampler sampler;
    unsigned char *block;
    float *patch[FILM_FRAMES];
    int dim, frames;
};

static void film_open(struct film *film, int width, int height, int normalisation, int frames) {
    ast_config cfg;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&cfg, AST_PRESET_PAPER));
    cfg.patch_width = width;
    cfg.patch_height = height;
    cfg.normalisation = normalisation;
    struct ast_arena counted = {NULL, 0};
    ast_sampler_layout(&film->sampler, &cfg, &counted);
    film->block = malloc(counted.used + AST_ALIGNMENT - 1);
    TEST_ASSERT_NOT_NULL(film->block);
    struct ast_arena bound = {ast_align(film->block), 0};
    ast_sampler_layout(&film->sampler, &cfg, &bound);
    render_open(&film->render, 80, 60, 4);
    film->dim = width * height;
    film->frames = frames;
    for (int f = 0; f < frames; f++) {
        const ast_box box = render_path(&film->render, f, 24, 20, 0.2, 1.3);
        const ast_frame frame = render_frame(&film->render, &box);
        film->patch[f] = malloc((size_t)film->dim * sizeof(float));
        TEST_ASSERT_NOT_NULL(film->patch[f]);
        ast_sampler_patch(&film->sampler, &frame, &box, film->patch[f]);
    }
}

static void film_close(struct film *film) {
    for (int f = 0; f < film->frames; f++) free(film->patch[f]);
    render_close(&film->render);
    free(film->block);
}

/* The scene of a tracker at a frame: history the patches before it, models of earlier ones, candidates about the true box of the
 * frame: near, far, and, if there is room, one beyond the frame. */
static void bench_film(struct bench *b, struct film *film, int frame, int candidates) {
    struct noise noise = {(uint64_t)frame};
    const int held = b->cfg.history < frame ? b->cfg.history : frame;
    for (int m = 0; m < b->cfg.bag_size; m++) {
        const int last = frame - held + 1 - m * held / 2, first = last - held > 0 ? last - held : 0;
        add_model(b, (const float *const *)film->patch + first, held + 1);
    }
    for (int f = frame - held; f < frame; f++) ast_history_push(&b->history, film->patch[f]);
    const ast_box truth = render_path(&film->render, frame, 24, 20, 0.2, 1.3);
    const ast_frame picture = render_frame(&film->render, &truth);
    float *patch = malloc((size_t)film->dim * sizeof *patch);
    TEST_ASSERT_NOT_NULL(patch);
    for (int i = 0; i < candidates; i++) {
        const double reach = i < candidates / 2 ? 1 : i < candidates - 1 ? 6 : 60;
        ast_box box = truth;
        box.x += (float)(reach * noise_normal(&noise));
        box.y += (float)(reach * noise_normal(&noise));
        ast_sampler_patch(&film->sampler, &picture, &box, patch);
        add_candidate(b, patch);
    }
    free(patch);
}

/* Every kind of basis, sizes of history and basis up to the largest, patches of every normalisation. */
static void test_gram_agrees_with_literal_on_rendered_frames(void) {
    static const int shapes[][2] = {{4, 4}, {9, 7}, {16, 16}, {32, 32}}, histories[] = {1, 2, 3, 5, 15};
    static struct bench b;
    double worst[AST_NORMALISE_UNIT + 1] = {0};
    for (int s = 0; s < 4; s++) {
        for (int normalisation = AST_NORMALISE_NONE; normalisation <= AST_NORMALISE_UNIT; normalisation++) {
            struct film film;
            film_open(&film, shapes[s][0], shapes[s][1], normalisation, 40);
            for (int backend = 0; backend < BACKENDS; backend++) {
                for (int h = 0; h < 5; h++) {
                    for (int kind = 0; kind < KINDS; kind++) {
                        const int history = histories[h], most = history + 1 < AST_MAX_BASIS ? history + 1 : AST_MAX_BASIS;
                        const int n = (h + kind + s) % 2 ? most : (most + 1) / 2;
                        bench_open(&b, backends[backend], kind, film.dim, history, n, 1 + (h + s) % 3 * 2);
                        bench_film(&b, &film, 38, s < 3 ? 9 : 4);
                        snprintf(label, sizeof label, "%s, %s, %d x %d, normalisation %d, P %d, n %d, k %d", b.la->name,
                                 kind_names[kind], shapes[s][0], shapes[s][1], normalisation, history, n, b.cfg.bag_size);
                        expect_agreement(&b, &worst[normalisation]);
                        bench_close(&b);
                    }
                }
            }
            film_close(&film);
        }
    }
    /* Where patches are of unit length, as in all presets, the promise is kept with a margin. */
    snprintf(label, sizeof label, "largest difference %g", worst[AST_NORMALISE_UNIT]);
    TEST_ASSERT_TRUE_MESSAGE(worst[AST_NORMALISE_UNIT] < by_real(5e-5, 2e-4), label);
}

/* The largest patch, of raw pixels: the terms are thousands of times those of unit patches, and so is their rounding. */
static void test_gram_agrees_with_literal_on_the_largest_patch(void) {
    static struct bench b;
    struct film film;
    film_open(&film, AST_MAX_PATCH, AST_MAX_PATCH, AST_NORMALISE_NONE, 12);
    for (int backend = 0; backend < BACKENDS; backend++) {
        for (int kind = 0; kind < KINDS; kind++) {
            bench_open(&b, backends[backend], kind, film.dim, 3, 3, 2);
            bench_film(&b, &film, 10, 6);
            score(&b);
            for (int i = 0; i < b.count * 2; i++) {
                const double literal = (double)b.distance[LITERAL][i], gram = (double)b.distance[GRAM][i];
                snprintf(label, sizeof label, "%s, %s, distance %d", b.la->name, kind_names[kind], i);
                TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-3 * (1 + literal), literal, gram, label);
            }
            bench_close(&b);
        }
    }
    film_close(&film);
}

/* What both ways must give: the candidate's subspace, fitted and compared by the functions of the public header. */
static void test_both_ways_give_the_distance_of_the_geometry_functions(void) {
    enum { DIM = 16 * 16, P = 4, N = 3, MODELS = 3 };
    static struct bench b;
    static float images[DIM * (P + 1)], mean[DIM], basis[DIM * N];
    struct film film;
    film_open(&film, 16, 16, AST_NORMALISE_UNIT, 20);
    for (int backend = 0; backend < BACKENDS; backend++) {
        for (int kind = CENTRED; kind <= RAW; kind++) {
            bench_open(&b, backends[backend], kind, DIM, P, N, MODELS);
            bench_film(&b, &film, 18, 10);
            score(&b);
            for (int i = 0; i < b.count; i++) {
                const float *column[AST_MAX_HISTORY + 1];
                const struct ast_images set = set_of(&b, i, column);
                for (int j = 0; j < set.count; j++) memcpy(images + j * DIM, column[j], DIM * sizeof(float));
                ast_subspace candidate;
                const size_t size = ast_subspace_work_size(DIM, P + 1);
                void *work = malloc(size);
                TEST_ASSERT_NOT_NULL(work);
                TEST_ASSERT_EQUAL_INT(
                    AST_OK, ast_subspace_fit(images, DIM, DIM, P + 1, b.cfg.basis, N, mean, basis, &candidate, work, size));
                for (int j = 0; j < MODELS; j++) {
                    const ast_subspace model = {ast_bag_mean(&b.bag[LITERAL], j),
                                                ast_bag_basis(&b.bag[LITERAL], j),
                                                DIM,
                                                b.stride,
                                                N,
                                                b.bag[LITERAL].rank[j]};
                    ast_distance expected;
                    TEST_ASSERT_EQUAL_INT(AST_OK, ast_subspace_distance(&candidate, &model, b.cfg.alpha, &expected, work, size));
                    for (int w = 0; w < WAYS; w++) {
                        snprintf(label, sizeof label, "%s, %s, way %d: candidate %d, model %d", b.la->name, kind_names[kind], w, i,
                                 j);
                        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(slack_of(&b, i, (double)expected.distance), (double)expected.distance,
                                                          (double)b.distance[w][i * MODELS + j], label);
                    }
                }
                free(work);
            }
            bench_close(&b);
        }
    }
    film_close(&film);
}

/* The ablation knows no means: where they are and how much they weigh changes nothing. */
static void test_the_linear_model_has_no_mean_term(void) {
    static struct bench b;
    struct film film;
    float plain[WAYS][MOST_CANDIDATES * MOST_MODELS];
    film_open(&film, 8, 8, AST_NORMALISE_NONE, 12);
    bench_open(&b, backends[0], LINEAR, film.dim, 3, 3, 2);
    bench_film(&b, &film, 10, 8);
    score(&b);
    memcpy(plain, b.distance, sizeof plain);
    b.cfg.alpha = 1000.0f;
    score(&b);
    TEST_ASSERT_EQUAL_MEMORY(plain, b.distance, sizeof plain);
    for (int w = 0; w < WAYS; w++)
        for (int i = 0; i < b.count * 2; i++) TEST_ASSERT_TRUE(b.distance[w][i] > 0.0f && b.distance[w][i] < 3.0f);
    bench_close(&b);
    film_close(&film);
}

static void test_alpha_weighs_the_mean_term(void) {
    static struct bench b;
    static const float alphas[] = {0.0f, 0.5f, 1.0f, 10.0f};
    struct film film;
    float at[4][WAYS][MOST_CANDIDATES * MOST_MODELS];
    film_open(&film, 8, 8, AST_NORMALISE_UNIT, 12);
    for (int kind = CENTRED; kind <= RAW; kind++) {
        bench_open(&b, backends[0], kind, film.dim, 3, 3, 2);
        bench_film(&b, &film, 10, 8);
        for (int a = 0; a < 4; a++) {
            b.cfg.alpha = alphas[a];
            snprintf(label, sizeof label, "%s, alpha %g", kind_names[kind], (double)alphas[a]);
            expect_agreement(&b, NULL);
            memcpy(at[a], b.distance, sizeof at[a]);
        }
        for (int w = 0; w < WAYS; w++) {
            for (int i = 0; i < b.count * 2; i++) {
                const double angle = (double)at[0][w][i], term = (double)at[2][w][i] - angle;
                TEST_ASSERT_TRUE(term > 1e-4);
                TEST_ASSERT_DOUBLE_WITHIN(1e-5, angle + 0.5 * term, (double)at[1][w][i]);
                TEST_ASSERT_DOUBLE_WITHIN(1e-5, angle + 10 * term, (double)at[3][w][i]);
            }
        }
        bench_close(&b);
    }
    film_close(&film);
}

/* ---- Golden vectors ---- */

/* A case as a scene: the first set is history and candidate, the second is the model. */
static int check_golden_file(const char *path) {
    static struct golden_case golden;
    static struct bench b;
    FILE *file = fopen(path, "r");
    int cases = 0, more;
    TEST_ASSERT_NOT_NULL_MESSAGE(file, path);
    while ((more = golden_next(file, &golden)) > 0) {
        if (golden.a.count < 2) continue; /* no history */
        const int p = golden.a.count - 1, history = p < golden.n - 1 ? golden.n - 1 : p;
        for (int backend = 0; backend < BACKENDS; backend++) {
            const float *column[GOLDEN_MOST_IMAGES];
            bench_open(&b, backends[backend], golden.basis == AST_BASIS_RAW ? RAW : CENTRED, golden.dim, history, golden.n, 1);
            b.cfg.alpha = (float)golden.alpha;
            for (int j = 0; j < golden.b.count; j++) column[j] = golden.b.images + j * golden.dim;
            add_model(&b, column, golden.b.count);
            for (int j = 0; j < p; j++) ast_history_push(&b.history, golden.a.images + j * golden.dim);
            add_candidate(&b, golden.a.images + p * golden.dim);
            snprintf(label, sizeof label, "%s, case %s", b.la->name, golden.name);
            score(&b);
            const double slack = 1e-4 + golden_geodesic_slack(&golden) + real_basis_slack(4) * golden.distance +
                                 golden.alpha * (golden_mahalanobis_slack(&golden) + 2e-6 * golden.mahalanobis);
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(slack, golden.distance, (double)b.distance[LITERAL][0], label);
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(slack, golden.distance, (double)b.distance[GRAM][0], label);
            bench_close(&b);
        }
        cases++;
    }
    fclose(file);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, more, golden_fault());
    return cases;
}

static void test_golden_cases_of_our_own(void) {
    TEST_ASSERT_GREATER_THAN_INT(55, check_golden_file("tests/golden/subspaces.txt"));
}

static void test_golden_cases_shared_with_others(void) {
    const char *given = getenv("AST_GOLDEN"), *path = given != NULL ? given : "../shared/golden/subspaces.txt";
    FILE *file = fopen(path, "r");
    if (file == NULL && given == NULL) TEST_IGNORE_MESSAGE("golden cases of others not scored: no ../shared/golden/subspaces.txt");
    TEST_ASSERT_NOT_NULL_MESSAGE(file, path);
    fclose(file);
    TEST_ASSERT_GREATER_THAN_INT(0, check_golden_file(path));
}

/* ---- Histories that are short, frozen, black, or all but that ---- */

enum { D = 200, PATCHES = 24 };

/* Patches as a still camera gives them: one texture, each with a little of its own. */
static void make_patches(struct noise *noise, float patch[PATCHES][D], double own) {
    float texture[D];
    noise_fill(noise, texture, D, 0, 1);
    for (int j = 0; j < PATCHES; j++)
        for (int d = 0; d < D; d++) patch[j][d] = (float)((double)texture[d] + own * noise_normal(noise));
}

static void open_constructed(struct bench *b, int backend, int kind, int history, int n, float patch[PATCHES][D]) {
    const float *column[4] = {patch[20], patch[21], patch[22], patch[23]};
    bench_open(b, backends[backend], kind, D, history, n, 3);
    add_model(b, column, 4);
    add_model(b, column, 2); /* fewer directions than n where n > 2 */
    snprintf(label, sizeof label, "%s, %s, P %d, n %d", b->la->name, kind_names[kind], history, n);
}

#define FOR_EACH_KIND(backend, kind)                                                                                               \
    for (int backend = 0; backend < BACKENDS; backend++)                                                                           \
        for (int kind = 0; kind < KINDS; kind++)

static void test_a_history_that_is_not_full(void) {
    static struct bench b;
    float patch[PATCHES][D];
    struct noise noise = {1};
    make_patches(&noise, patch, 0.1);
    FOR_EACH_KIND(backend, kind) {
        open_constructed(&b, backend, kind, 6, 4, patch);
        for (int held = 1; held <= 6; held++) {
            ast_history_push(&b.history, patch[held]);
            b.count = 0;
            for (int i = 8; i < 14; i++) add_candidate(&b, patch[i]);
            expect_agreement(&b, NULL);
        }
        bench_close(&b);
    }
}

/* The ring's slots are in another order than its patches, and order means nothing to a set. */
static void test_a_history_that_has_gone_round(void) {
    static struct bench round, straight;
    float patch[PATCHES][D];
    struct noise noise = {2};
    make_patches(&noise, patch, 0.1);
    FOR_EACH_KIND(backend, kind) {
        open_constructed(&round, backend, kind, 4, 3, patch);
        open_constructed(&straight, backend, kind, 4, 3, patch);
        for (int j = 0; j < 11; j++) ast_history_push(&round.history, patch[j]);
        for (int j = 10; j > 6; j--) ast_history_push(&straight.history, patch[j]);
        for (int i = 12; i < 18; i++) {
            add_candidate(&round, patch[i]);
            add_candidate(&straight, patch[i]);
        }
        expect_agreement(&round, NULL);
        expect_agreement(&straight, NULL);
        for (int w = 0; w < WAYS; w++)
            for (int i = 0; i < 6 * 2; i++)
                TEST_ASSERT_FLOAT_WITHIN((float)by_real(2e-5, 1e-3 * (1 + (double)straight.distance[w][i])),
                                         straight.distance[w][i], round.distance[w][i]);
        bench_close(&round);
        bench_close(&straight);
    }
}

/* Candidates that add nothing or next to nothing to the history: each of its patches, their mean, other points of its affine hull,
 * and for raw bases of its linear hull. */
static void test_candidates_in_the_span_of_the_history(void) {
    static struct bench b;
    float patch[PATCHES][D], inside[D];
    struct noise noise = {3};
    make_patches(&noise, patch, 0.1);
    FOR_EACH_KIND(backend, kind) {
        for (int history = 1; history <= 5; history += 2) {
            open_constructed(&b, backend, kind, history, history < 3 ? 2 : 4, patch);
            for (int j = 0; j < history; j++) ast_history_push(&b.history, patch[j]);
            for (int j = 0; j < history; j++) add_candidate(&b, patch[j]);
            for (int i = 0; i < 10; i++) {
                double weight[5] = {1}, total = 0;
                for (int j = 0; j < history; j++) total += weight[j] = i == 0 ? 1 : noise_normal(&noise);
                if (kind == CENTRED || i < 3) { /* a point of the affine hull: weights sum to one */
                    weight[0] += 1 - total;
                    if (i == 0)
                        for (int j = 0; j < history; j++) weight[j] = 1.0 / history;
                }
                for (int d = 0; d < D; d++) {
                    double sum = 0;
                    for (int j = 0; j < history; j++) sum += weight[j] * (double)patch[j][d];
                    inside[d] = (float)sum;
                }
                add_candidate(&b, inside);
            }
            expect_agreement(&b, NULL);
            bench_close(&b);
        }
    }
}

/* Candidates whose part outside the history's span shrinks from all of it to rounding. That part is a direction of the subspace
 * until it falls below the rank tolerance, however small it is against the candidate. The inner products of the fast path lose it
 * long before: it must come from its definition, orthogonal to the history as exactly as that needs. One model is that of the
 * candidate's own set, one of a set that has the same direction. */
static void test_residuals_of_every_length(void) {
    enum { P = 3, N = 3 };
    static struct bench b;
    float patch[PATCHES][D];
    struct noise noise = {4};
    make_patches(&noise, patch, 0.1);
    FOR_EACH_KIND(backend, kind) {
        int least_outside = 0;
        for (int step = 0; step < 40; step++) {
            const double length = pow(10, -0.2 * step); /* 1 .. 1e-8 */
            double q[D * (P + 1)], direction[D] = {0}, outside = 0, whole = 0;
            float candidate[D], cousin[D];
            /* A direction orthogonal to the history about its mean, and to the mean. */
            for (int j = 0; j <= P; j++) {
                double *x = q + j * D, size = 0;
                for (int d = 0; d < D; d++) x[d] = j < P ? (double)patch[j][d] : noise_normal(&noise);
                for (int pass = 0; pass < 2; pass++) {
                    for (int i = 0; i < j; i++) {
                        double along = 0;
                        for (int d = 0; d < D; d++) along += x[d] * q[i * D + d];
                        for (int d = 0; d < D; d++) x[d] -= along * q[i * D + d];
                    }
                }
                for (int d = 0; d < D; d++) size += x[d] * x[d];
                for (int d = 0; d < D; d++) x[d] /= sqrt(size);
                if (j == P) memcpy(direction, x, sizeof direction);
            }
            for (int d = 0; d < D; d++) {
                const double inside = 0.7 * (double)patch[0][d] + 0.5 * (double)patch[1][d] - 0.2 * (double)patch[2][d];
                candidate[d] = (float)(inside + length * direction[d]);
                cousin[d] = (float)(inside + 0.01 * (double)(patch[0][d] - patch[1][d]) + 3 * length * direction[d]);
                const double away = (double)candidate[d] - ((double)patch[0][d] + (double)patch[1][d] + (double)patch[2][d]) / 3;
                outside += away * direction[d];
                whole += away * away;
            }
            least_outside += outside * outside < 1e-4 * whole;

            bench_open(&b, backends[backend], kind, D, P, N, 4);
            const float *own[P + 1] = {patch[0], patch[1], patch[2], candidate},
                                 *near[P + 1] = {patch[0], patch[1], patch[2], cousin},
                                 *other[4] = {patch[20], patch[21], patch[22], patch[23]};
            add_model(&b, own, P + 1);
            add_model(&b, near, P + 1);
            add_model(&b, other, 4);
            for (int j = 0; j < P; j++) ast_history_push(&b.history, patch[j]);
            add_candidate(&b, candidate);
            add_candidate(&b, cousin);
            snprintf(label, sizeof label, "%s, %s, residual %g", b.la->name, kind_names[kind], length);
            expect_agreement(&b, NULL);
            bench_close(&b);
        }
        /* The sweep has gone where inner products in single precision no longer hold the residual. */
        TEST_ASSERT_GREATER_THAN_INT(20, least_outside);
    }
}

/* Black, white and frozen histories, with the same and with other candidates: every pair has a defined distance in both ways. */
static void test_degenerate_scenes(void) {
    enum { SCENES = 6 };
    static struct bench b;
    float patch[PATCHES][D], black[D] = {0}, white[D], grey[D];
    struct noise noise = {5};
    make_patches(&noise, patch, 0.1);
    for (int d = 0; d < D; d++) {
        white[d] = 1.0f;
        grey[d] = 0.1f; /* no mean of copies of it is exact */
    }
    const float *const histories[SCENES][3] = {{black, black, black},          {white, white, white},    {grey, grey, grey},
                                               {patch[0], patch[0], patch[0]}, {black, patch[0], black}, {black, white, grey}};
    const float *const candidates[] = {black, white, grey, patch[0], patch[1], patch[20]};
    FOR_EACH_KIND(backend, kind) {
        for (int held = 1; held <= 3; held++) {
            for (int s = 0; s < SCENES; s++) {
                const float *const ordinary[] = {patch[20], patch[21], patch[22], patch[23]};
                bench_open(&b, backends[backend], kind, D, 3, 3, SCENES + 2);
                for (int m = 0; m < SCENES; m++) add_model(&b, histories[m], 3);
                add_model(&b, ordinary, 4);
                for (int j = 0; j < held; j++) ast_history_push(&b.history, histories[s][j]);
                for (int i = 0; i < 6; i++) add_candidate(&b, candidates[i]);
                snprintf(label, sizeof label, "%s, %s, scene %d, %d patches", b.la->name, kind_names[kind], s, held);
                expect_agreement(&b, NULL);
                bench_close(&b);
            }
        }
    }
}

/* A set and its own model are at distance zero, whatever their rank: also where nothing moves. */
static void test_a_frozen_scene_is_at_distance_zero_from_its_model(void) {
    static struct bench b;
    float patch[PATCHES][D], black[D] = {0}, grey[D];
    struct noise noise = {6};
    make_patches(&noise, patch, 0.1);
    for (int d = 0; d < D; d++) grey[d] = 0.1f;
    FOR_EACH_KIND(backend, kind) {
        for (int s = 0; s < 3; s++) {
            const float *still = s == 0 ? black : s == 1 ? grey : patch[0], *const column[] = {still, still, still, still};
            bench_open(&b, backends[backend], kind, D, 3, 3, 1);
            add_model(&b, column, 4);
            for (int j = 0; j < 3; j++) ast_history_push(&b.history, still);
            add_candidate(&b, still);
            score(&b);
            for (int w = 0; w < WAYS; w++) TEST_ASSERT_DOUBLE_WITHIN(golden_angle_slack(0), 0, (double)b.distance[w][0]);
            bench_close(&b);
        }
    }
}

/* Histories whose patches differ by less and less, down to below the tolerance: directions vanish at the same place in both ways.
 * Lengths at the tolerance itself are left out: there rounding decides. */
static void test_histories_that_are_nearly_frozen(void) {
    static const double owns[] = {1e-2, 1e-3, 3e-4, 1e-4, 4e-6, 1e-6, 1e-7};
    static struct bench b;
    FOR_EACH_KIND(backend, kind) {
        for (int o = 0; o < 7; o++) {
            float patch[PATCHES][D], other[PATCHES][D];
            struct noise noise = {7};
            make_patches(&noise, patch, owns[o]);
            noise.state = 7; /* the same texture */
            make_patches(&noise, other, 0.1);
            for (int history = 2; history <= 4; history += 2) {
                open_constructed(&b, backend, kind, history, 3, other);
                const float *const own[] = {patch[0], patch[1], patch[2], patch[3], patch[4]};
                add_model(&b, own, history + 1);
                for (int j = 0; j < history; j++) ast_history_push(&b.history, patch[j]);
                for (int i = history; i < 8; i++) add_candidate(&b, patch[i]);
                for (int i = 8; i < 12; i++) add_candidate(&b, other[i]);
                snprintf(label, sizeof label, "%s, %s, P %d, patches %g apart", b.la->name, kind_names[kind], history, owns[o]);
                expect_agreement(&b, NULL);
                bench_close(&b);
            }
        }
    }
}

/* ---- The background's metric ---- */

enum { MD = 40, BACKGROUND = 16 }; /* dimension of the space, vectors of the background */

/* The metric as a map: with M = I - Zc'(Zc Zc' + ridge tr(Zc Zc') I)^-1 Zc = S'S, the ordinary geometry of S x is M's of x. In the
 * eigenvectors V of Zc'Zc with eigenvalues l, M = V diag(r / (l + r)) V', r = ridge tr(Zc Zc'). */
static void make_map(const double *zc, double ridge, double *map) {
    ast_real *scatter = malloc(3 * MD * MD * sizeof *scatter), *vectors = scatter + MD * MD, *values = vectors + MD * MD;
    double trace = 0;
    TEST_ASSERT_NOT_NULL(scatter);
    for (int j = 0; j < MD; j++) {
        for (int i = 0; i < MD; i++) {
            scatter[j * MD + i] = 0;
            for (int z = 0; z < BACKGROUND; z++) scatter[j * MD + i] += (ast_real)(zc[z * MD + i] * zc[z * MD + j]);
        }
        trace += (double)scatter[j * MD + j];
    }
    ast_eigen_symmetric(MD, scatter, values, vectors);
    for (int l = 0; l < MD; l++) {
        const double eigenvalue = values[l] > 0 ? (double)values[l] : 0,
                     shrink = sqrt(ridge * trace / (eigenvalue + ridge * trace));
        for (int d = 0; d < MD; d++) map[d * MD + l] = shrink * (double)vectors[l * MD + d];
    }
    free(scatter);
}

/* Left singular vectors of a MD x count matrix, in place. */
static void orthonormalise(double *columns, int count) {
    ast_real work[AST_MAX_HISTORY + 1], values[AST_MAX_HISTORY + 1], a[MD * (AST_MAX_HISTORY + 1)];
    for (int i = 0; i < MD * count; i++) a[i] = (ast_real)columns[i];
    TEST_ASSERT_EQUAL_INT(0, ast_linalg_builtin.svd(MD, count, a, 1, values, work, AST_MAX_HISTORY + 1));
    for (int i = 0; i < MD * count; i++) columns[i] = (double)a[i];
}

/* The distance in the metric, from its definition: everything mapped, then as without a metric. */
static double distance_in_metric(const struct bench *b, int candidate, int model, const double *map, const float *background_mean) {
    const float *column[AST_MAX_HISTORY + 1];
    const struct ast_images set = set_of(b, candidate, column);
    const struct ast_bag *bag = &b->bag[GRAM];
    const int count = set.count, n = bag->n, rank = bag->rank[model];
    double about[MD * (AST_MAX_HISTORY + 1)], own[MD * (AST_MAX_HISTORY + 1)], basis[MD * AST_MAX_BASIS], other[MD * AST_MAX_BASIS];
    double mean[MD], difference[MD], away[MD], mapped[MD], mapped_away[MD], cross[AST_MAX_BASIS * AST_MAX_BASIS];
    for (int d = 0; d < MD; d++) {
        mean[d] = 0;
        for (int j = 0; j < count; j++) mean[d] += (double)column[j][d] / count;
        const double origin = b->cfg.basis == AST_BASIS_CENTRED ? mean[d] : (double)background_mean[d];
        for (int j = 0; j < count; j++) about[j * MD + d] = (double)column[j][d] - origin;
        for (int l = 0; l < rank; l++) basis[l * MD + d] = (double)ast_bag_basis(bag, model)[l * bag->stride + d];
        difference[d] = mean[d] - (double)ast_bag_mean(bag, model)[d];
        away[d] = mean[d] - (double)background_mean[d];
    }
    matrix_product(MD, count, MD, map, about, own);
    matrix_product(MD, rank, MD, map, basis, other);
    orthonormalise(own, count);
    orthonormalise(other, rank);

    const int most = count - (b->cfg.basis == AST_BASIS_CENTRED), own_rank = most < n ? most : n;
    matrix_product_transposed(own_rank, rank, MD, own, other, cross);
    ast_real small[AST_MAX_BASIS * AST_MAX_BASIS], values[AST_MAX_BASIS], work[AST_MAX_BASIS];
    for (int i = 0; i < own_rank * rank; i++) small[i] = (ast_real)cross[i];
    TEST_ASSERT_EQUAL_INT(0, ast_linalg_builtin.svd(own_rank, rank, small, 0, values, work, AST_MAX_BASIS));
    const int least = own_rank < rank ? own_rank : rank;
    double square = (own_rank + rank - 2 * least) * 2.4674011002723395; /* (pi / 2)^2 for each direction absent from one alone */
    for (int l = 0; l < least; l++) square += values[l] < 1 ? pow(acos((double)values[l]), 2) : 0;
    if (b->cfg.model == AST_MODEL_LINEAR) return sqrt(square);

    double term = 0, from_background = 0;
    matrix_product(MD, 1, MD, map, difference, mapped);
    matrix_product(MD, 1, MD, map, away, mapped_away);
    for (int d = 0; d < MD; d++) {
        term += 2 * mapped[d] * mapped[d];
        from_background += mapped_away[d] * mapped_away[d];
    }
    for (int l = 0; l < own_rank + rank; l++) {
        const double *u = l < own_rank ? own + l * MD : other + (l - own_rank) * MD;
        double along = 0;
        for (int d = 0; d < MD; d++) along += u[d] * mapped[d];
        term -= along * along;
    }
    return sqrt(square) + (double)b->cfg.alpha * (term - 2 * (double)b->cfg.background_ratio * from_background);
}

static void test_gram_in_the_metric_of_a_background(void) {
    static const float ridges[] = {0.001f, 0.1f, 1000.0f}, ratios[] = {0.0f, 1.0f};
    static struct bench b;
    static double zc[MD * BACKGROUND], map[MD * MD];
    struct noise noise = {11};
    FOR_EACH_KIND(backend, kind) {
        for (int variant = 0; variant < 12; variant++) {
            const int history = variant % 2 ? 5 : 2, n = variant % 3 + 1;
            ast_config cfg = config_of(kind, history, n, 3);
            cfg.background = BACKGROUND;
            cfg.ridge = ridges[variant % 3];
            cfg.background_ratio = ratios[variant / 6];
            bench_open_as(&b, backends[backend], &cfg, MD);

            /* The object's vectors share a texture; those of the background share another, and vary along a few directions. */
            float object[MD], ground[MD], direction[3][MD], images[20][MD];
            const float *column[20];
            noise_fill(&noise, object, MD, -0.2, 0.2);
            noise_fill(&noise, ground, MD, -0.2, 0.2);
            for (int l = 0; l < 3; l++) noise_fill(&noise, direction[l], MD, -0.3, 0.3);
            for (int j = 0; j < 20; j++) {
                column[j] = images[j];
                for (int d = 0; d < MD; d++) images[j][d] = (float)((double)object[d] + 0.05 * noise_normal(&noise));
            }
            float *set = ast_bag_basis(&b.bag[GRAM], 0) - BACKGROUND * b.stride, *background_mean = set - b.stride;
            for (int d = 0; d < MD; d++) background_mean[d] = ground[d];
            for (int z = 0; z < BACKGROUND; z++) {
                const double along[] = {noise_normal(&noise), noise_normal(&noise), noise_normal(&noise)};
                for (int d = 0; d < MD; d++) {
                    double value = (double)ground[d] + 0.02 * noise_normal(&noise);
                    for (int l = 0; l < 3; l++) value += along[l] * (double)direction[l][d];
                    set[z * b.stride + d] = (float)value;
                    zc[z * MD + d] = (double)set[z * b.stride + d] - (double)background_mean[d];
                }
            }
            make_map(zc, (double)cfg.ridge, map);
            for (int m = 0; m < 3; m++) add_model(&b, column + 4 * m, history + 1);
            for (int j = 10; j < 10 + history; j++) ast_history_push(&b.history, images[j]);
            for (int i = 16; i < 20; i++) add_candidate(&b, images[i]);
            for (int d = 0; d < MD; d++) images[0][d] = set[d];
            add_candidate(&b, images[0]); /* background, seen as an object */

            snprintf(label, sizeof label, "%s, %s, P %d, n %d, ridge %g, ratio %g", b.la->name, kind_names[kind], history, n,
                     (double)cfg.ridge, (double)cfg.background_ratio);
            score_in_tiles(&b, GRAM, MOST_CANDIDATES, b.distance[GRAM]);
            for (int i = 0; i < b.count; i++) {
                for (int j = 0; j < 3; j++) {
                    const double expected = distance_in_metric(&b, i, j, map, background_mean);
                    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(2e-4 * (1 + fabs(expected)), expected, (double)b.distance[GRAM][i * 3 + j],
                                                      label);
                }
            }
            bench_close(&b);
        }
    }
}

/* ---- How candidates are handed over ---- */

static void test_tiles_of_any_size_give_the_same_distances(void) {
    static struct bench b;
    static float whole[MOST_CANDIDATES * MOST_MODELS], parts[MOST_CANDIDATES * MOST_MODELS];
    float patch[PATCHES][D];
    struct noise noise = {8};
    make_patches(&noise, patch, 0.1);
    FOR_EACH_KIND(backend, kind) {
        open_constructed(&b, backend, kind, 3, 3, patch);
        for (int j = 0; j < 3; j++) ast_history_push(&b.history, patch[j]);
        for (int i = 0; i < MOST_CANDIDATES; i++) add_candidate(&b, patch[3 + i % 17]);
        for (int w = 0; w < WAYS; w++) {
            score_in_tiles(&b, w, MOST_CANDIDATES, whole);
            for (int tile = 1; tile < MOST_CANDIDATES; tile = tile * 3 + 1) {
                score_in_tiles(&b, w, tile, parts);
                for (int i = 0; i < MOST_CANDIDATES * 2; i++) TEST_ASSERT_FLOAT_WITHIN_MESSAGE(2e-6f, whole[i], parts[i], label);
            }
        }
        bench_close(&b);
    }
}

static void test_scoring_writes_its_lead_and_nothing_else_of_the_scene(void) {
    static struct bench b;
    float patch[PATCHES][D];
    struct noise noise = {9};
    make_patches(&noise, patch, 0.1);
    FOR_EACH_KIND(backend, kind) {
        open_constructed(&b, backend, kind, 3, 3, patch);
        for (int j = 0; j < 3; j++) ast_history_push(&b.history, patch[j]);
        for (int i = 5; i < 15; i++) add_candidate(&b, patch[i]);
        for (int w = 0; w < WAYS; w++) {
            const struct ast_bag *bag = &b.bag[w];
            const size_t models = (size_t)b.stride * 3 * 4, held = (size_t)b.stride * 3;
            float *first_model = bag->columns + (size_t)bag->lead * (size_t)b.stride;
            float *models_before = malloc(models * sizeof(float)), *history_before = malloc(held * sizeof(float));
            TEST_ASSERT_TRUE(models_before != NULL && history_before != NULL);
            memcpy(models_before, first_model, models * sizeof(float));
            memcpy(history_before, b.history.patches, held * sizeof(float));
            score_in_tiles(&b, w, MOST_CANDIDATES, b.distance[w]);
            TEST_ASSERT_EQUAL_MEMORY(models_before, first_model, models * sizeof(float));
            TEST_ASSERT_EQUAL_MEMORY(history_before, b.history.patches, held * sizeof(float));
            TEST_ASSERT_EQUAL_INT(2, bag->count);
            free(models_before);
            free(history_before);
        }
        bench_close(&b);
    }
}

/* A frame's distances depend on that frame's scene: nothing of an earlier one is left in the scratch. */
static void test_scenes_one_after_another_are_independent(void) {
    static struct bench used, fresh;
    float patch[PATCHES][D];
    struct noise noise = {10};
    make_patches(&noise, patch, 0.1);
    FOR_EACH_KIND(backend, kind) {
        open_constructed(&used, backend, kind, 4, 3, patch);
        open_constructed(&fresh, backend, kind, 4, 3, patch);
        for (int j = 0; j < 4; j++) ast_history_push(&used.history, patch[19]); /* another scene, of another rank */
        for (int i = 5; i < 11; i++) add_candidate(&used, patch[i]);
        score(&used);
        for (int j = 0; j < 4; j++) {
            ast_history_push(&used.history, patch[j]);
            ast_history_push(&fresh.history, patch[j]);
        }
        for (int i = 5; i < 11; i++) add_candidate(&fresh, patch[i]);
        score(&used);
        score(&fresh);
        for (int w = 0; w < WAYS; w++) TEST_ASSERT_EQUAL_MEMORY(fresh.distance[w], used.distance[w], 6 * 2 * sizeof(float));
        bench_close(&used);
        bench_close(&fresh);
    }
}

static void test_the_configuration_chooses_the_way(void) {
    ast_config cfg;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&cfg, AST_PRESET_PAPER));
    cfg.scoring = AST_SCORING_GRAM;
    TEST_ASSERT_EQUAL_PTR(&ast_scoring_gram, ast_scoring_of(&cfg));
    cfg.scoring = AST_SCORING_LITERAL;
    TEST_ASSERT_EQUAL_PTR(&ast_scoring_literal, ast_scoring_of(&cfg));
}

/* ---- Through the public header ---- */

enum { TRACKERS = WAYS * BACKENDS };

/* One tracker leads; at each frame its state goes to one of each way and backend, all step on the same frame, and all distances and
 * the winners are compared. */
static void track_with_all(int kind, int normalisation, int frames) {
    ast_config cfg;
    ast_tracker *tracker[TRACKERS];
    struct render render;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&cfg, AST_PRESET_PAPER));
    cfg.view = 48;
    cfg.view_object = 16;
    cfg.patch_width = 16;
    cfg.patch_height = 16;
    cfg.bag_size = 5;
    cfg.alpha = 2.0f;
    cfg.particles = 50; /* a tile, and a part of one */
    cfg.basis = kind == CENTRED ? AST_BASIS_CENTRED : AST_BASIS_RAW;
    cfg.model = kind == LINEAR ? AST_MODEL_LINEAR : AST_MODEL_AFFINE;
    cfg.normalisation = normalisation;
    cfg.bag_interval = 2;
    cfg.guard = 0.0f; /* which would keep some frames from the bag */
    for (int i = 0; i < TRACKERS; i++) {
        ast_config own = cfg;
        own.scoring = i % WAYS == GRAM ? AST_SCORING_GRAM : AST_SCORING_LITERAL;
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_init_backend(&tracker[i], &own, backends[i / WAYS], NULL, 0));
    }
    const size_t size = ast_save_size(&cfg);
    unsigned char *state = malloc(size);
    TEST_ASSERT_NOT_NULL(state);
    render_open(&render, 80, 60, 6);
    const ast_box box = render_path(&render, 0, 24, 20, 0.2, 1.3);
    ast_frame frame = render_frame(&render, &box);
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_start(tracker[0], &frame, &box));

    const double slack = 1e-4 + real_basis_slack(300); /* patches that follow each other are alike to a hundredth or so */
    int most_models = 0;
    for (int f = 1; f <= frames; f++) {
        const ast_box truth = render_path(&render, f, 24, 20, 0.2, 1.3);
        frame = render_frame(&render, &truth);
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_save(tracker[0], state, size));
        ast_particles particles[TRACKERS];
        ast_result result[TRACKERS];
        for (int i = 0; i < TRACKERS; i++) {
            if (i > 0) TEST_ASSERT_EQUAL_INT(AST_OK, ast_restore(tracker[i], state, size));
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(tracker[i], &frame, &result[i]));
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(tracker[i], &particles[i]));
            TEST_ASSERT_EQUAL_INT(particles[0].models, particles[i].models);
        }
        const int models = particles[0].models;
        if (models > most_models) most_models = models;
        for (int i = 1; i < TRACKERS; i++) {
            snprintf(label, sizeof label, "%s, normalisation %d, frame %d, tracker %d", kind_names[kind], normalisation, f, i);
            for (int d = 0; d < cfg.particles * models; d++) {
                const double one = (double)particles[0].distance[d], other = (double)particles[i].distance[d];
                TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(slack * (1 + one), one, other, label);
            }
            /* The same winner, unless two tie within what the distances may differ by. */
            const double tie = exp(-4 * slack * (1 + (double)result[0].distance) / (double)cfg.sigma);
            const double won = (double)particles[0].weight[result[0].best], other = (double)particles[0].weight[result[i].best];
            TEST_ASSERT_TRUE_MESSAGE(other >= won * tie, label);
        }
    }
    TEST_ASSERT_EQUAL_INT(cfg.bag_size, most_models); /* the bag has been full */
    for (int i = 0; i < TRACKERS; i++) ast_free(tracker[i]);
    free(state);
    render_close(&render);
}

static void test_a_state_moves_between_ways_and_backends(void) {
    track_with_all(CENTRED, AST_NORMALISE_UNIT, 13);
    track_with_all(RAW, AST_NORMALISE_UNIT, 13);
    track_with_all(LINEAR, AST_NORMALISE_NONE, 13);
    track_with_all(CENTRED, AST_NORMALISE_MEAN, 13);
}

static void test_lapacke_and_builtin_give_the_same_distances(void) {
#ifdef AST_TEST_LAPACKE
    static struct bench one, other;
    struct film film;
    film_open(&film, 16, 16, AST_NORMALISE_UNIT, 20);
    for (int kind = 0; kind < KINDS; kind++) {
        for (int history = 1; history <= 5; history += 2) {
            bench_open(&one, &ast_linalg_builtin, kind, film.dim, history, history < 3 ? 2 : 3, 3);
            bench_open(&other, &ast_linalg_lapacke, kind, film.dim, history, history < 3 ? 2 : 3, 3);
            bench_film(&one, &film, 18, 12);
            bench_film(&other, &film, 18, 12);
            score(&one);
            score(&other);
            for (int w = 0; w < WAYS; w++) {
                for (int i = 0; i < one.count * 3; i++) {
                    snprintf(label, sizeof label, "%s, P %d, way %d, distance %d", kind_names[kind], history, w, i);
                    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(slack_of(&one, i / 3, (double)one.distance[w][i]), (double)one.distance[w][i],
                                                      (double)other.distance[w][i], label);
                }
            }
            bench_close(&one);
            bench_close(&other);
        }
    }
    film_close(&film);
#else
    TEST_IGNORE_MESSAGE("distances of lapacke not compared with builtin's: this build is without OpenBLAS and LAPACKE");
#endif
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_gram_agrees_with_literal_on_rendered_frames);
    RUN_TEST(test_gram_agrees_with_literal_on_the_largest_patch);
    RUN_TEST(test_both_ways_give_the_distance_of_the_geometry_functions);
    RUN_TEST(test_the_linear_model_has_no_mean_term);
    RUN_TEST(test_alpha_weighs_the_mean_term);
    RUN_TEST(test_golden_cases_of_our_own);
    RUN_TEST(test_golden_cases_shared_with_others);
    RUN_TEST(test_a_history_that_is_not_full);
    RUN_TEST(test_a_history_that_has_gone_round);
    RUN_TEST(test_candidates_in_the_span_of_the_history);
    RUN_TEST(test_residuals_of_every_length);
    RUN_TEST(test_degenerate_scenes);
    RUN_TEST(test_a_frozen_scene_is_at_distance_zero_from_its_model);
    RUN_TEST(test_histories_that_are_nearly_frozen);
    RUN_TEST(test_gram_in_the_metric_of_a_background);
    RUN_TEST(test_tiles_of_any_size_give_the_same_distances);
    RUN_TEST(test_scoring_writes_its_lead_and_nothing_else_of_the_scene);
    RUN_TEST(test_scenes_one_after_another_are_independent);
    RUN_TEST(test_the_configuration_chooses_the_way);
    RUN_TEST(test_a_state_moves_between_ways_and_backends);
    RUN_TEST(test_lapacke_and_builtin_give_the_same_distances);
    return UNITY_END();
}
