/* The roofline of a step: what the machine does at its best with the two things that a step cannot do without, the candidates'
 * samples and their product with the columns of the bag.
 *
 *     least time = operations of the products / measured peak of such products + N x measured peak time of a patch
 *
 * Where a shortlist is drawn up, all N particles need their glance (the first part of their samples, one inner product) and the
 * shortlist the rest.
 *
 * The peaks are the best of this run: of both backends, in the shapes that a step has; of a sampler stripped of all but the samples
 * (peak_patch.h) or the library's own, whichever is faster. Everything else that a step does, such as moving the cloud, the view
 * and its gradients, eigen-problems, distances and decision, counts as avoidable; the two parts share one core's units, so they add
 * up. */
#include "bench.h"

#include "clock.h"
#include "peak_patch.h"
#include "report.h"
#include "shortlist.h"
#include "table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SHAPES = 2, CASES = 2, TILE_PATCHES = 32 };
static const int presets[CASES] = {AST_PRESET_PAPER, AST_PRESET_ROBUST};
static const double LEAST_SPENT = 0.01; /* seconds of repeating that make one sample */

/* A product c = a' b as the seam has it. */
struct shape {
    const char *name;
    int rows, cols, depth;
};

struct peak {
    double patch, cells;            /* seconds for one candidate; 0 where it has none */
    struct shape shape[SHAPES];     /* a tile of candidates, all of them */
    double speed[SHAPES][BACKENDS]; /* operations a second, the best of the rounds */
    double operations;              /* of a step's products */
    double products, patches;       /* least seconds of a step's parts */
    double product;                 /* of the first without the metric's: what the stage of that name does */
    int columns;                    /* that every candidate is multiplied with */
};

static double greater(double a, double b) {
    return a > b ? a : b;
}

/* ---- Products ---- */

/* Columns of the Gram scoring's product: the reference, the history's basis, the background and its mean, the models. */
static int product_columns(const ast_config *cfg) {
    return 1 + cfg->history + (cfg->background > 0 ? 1 + cfg->background : 0) + cfg->bag_size * (cfg->basis_size + 1);
}

/* Multiplications and additions of the candidates' product with them. */
static double bag_operations(const ast_config *cfg) {
    return 2.0 * ast_shortlist_length(cfg) * ast_feature_length(cfg) * product_columns(cfg);
}

/* Of all candidates' glances, where there is a shortlist. */
static double glance_operations(const ast_config *cfg) {
    return ast_shortlist_length(cfg) < cfg->particles ? 2.0 * cfg->particles * ast_features_glance_length(cfg) : 0;
}

/* Of a background's metric: it solves a triangular system for each candidate and multiplies once more. */
static double metric_operations(const ast_config *cfg) {
    const double b = cfg->background;
    return ast_shortlist_length(cfg) * (b * b + 2 * b * product_columns(cfg));
}

/* Operations a second of one sample; 0 when the backend fails. */
static double product_speed(const struct ast_linalg *la, const struct shape *s, const float *a, const float *b, float *c) {
    int calls = 0;
    double spent = 0;
    const double before = clock_processor();
    while (spent < LEAST_SPENT) {
        if (la->product(s->rows, s->cols, s->depth, a, s->depth, b, s->depth, c, s->rows) != 0) return 0;
        calls++;
        spent = clock_processor() - before;
    }
    return 2.0 * calls * s->rows * s->cols * s->depth / spent;
}

/* The best of the rounds, of each shape with each backend. */
static bool product_peaks(const struct bench *b, const struct shape *shape, int count, double (*speed)[BACKENDS]) {
    size_t most_a = 0, most_b = 0, most_c = 0;
    for (int s = 0; s < count; s++) {
        const size_t rows = (size_t)shape[s].rows, cols = (size_t)shape[s].cols, depth = (size_t)shape[s].depth;
        most_a = rows * depth > most_a ? rows * depth : most_a;
        most_b = cols * depth > most_b ? cols * depth : most_b;
        most_c = rows * cols > most_c ? rows * cols : most_c;
    }
    float *a = malloc(most_a * sizeof *a), *other = malloc(most_b * sizeof *other), *c = malloc(most_c * sizeof *c);
    const bool good = a != NULL && other != NULL && c != NULL;
    if (!good) report_error("bench: out of memory");
    for (size_t i = 0; i < most_a && good; i++) a[i] = (float)(i % 7) - 3.0f;
    for (size_t i = 0; i < most_b && good; i++) other[i] = (float)(i % 5) - 2.0f;
    for (int r = 0; r <= b->rounds && good; r++) {
        for (int s = 0; s < count; s++) {
            for (int k = 0; k < BACKENDS; k++) {
                const double sample = product_speed(backends[k], &shape[s], a, other, c);
                if (r > 0) speed[s][k] = greater(speed[s][k], sample); /* the first round warms up */
            }
        }
    }
    free(a);
    free(other);
    free(c);
    return good;
}

/* ---- Patches ---- */

struct samples {
    struct peak_axis columns, rows;
    const uint8_t *pixels;
    int stride, width, height; /* of the image */
    bool cells;
};

/* Seconds of a patch, the best of rounds and samplers. The window stands in the middle and wanders whole pixels around it, as
 * candidates do. */
static double patch_peak(const struct bench *b, const struct samples *s) {
    enum { WANDER = 4, ROOM = PEAK_SIDE * PEAK_SIDE * PEAK_DIRECTIONS };
    float *line = malloc(PEAK_LINE * sizeof *line), *out = malloc(ROOM * sizeof *out);
    double best = HUGE_VAL, sink = 0;
    for (int r = 0; r <= b->rounds * PEAK_SAMPLERS && line != NULL && out != NULL; r++) {
        const struct peak_sampler *sampler = peak_samplers[r % PEAK_SAMPLERS];
        int patches = 0;
        double spent = 0;
        const double before = clock_processor();
        while (spent < LEAST_SPENT) {
            for (int i = 0; i < TILE_PATCHES; i++) {
                const int at = ((i * 5) % WANDER) * s->stride + (i * 3) % WANDER;
                if (s->cells)
                    sampler->cells(&s->columns, &s->rows, s->pixels + (size_t)at * PEAK_DIRECTIONS, s->stride, out);
                else
                    sampler->patch(&s->columns, &s->rows, s->pixels + at, s->stride, line, out);
                sink += (double)out[0];
            }
            patches += TILE_PATCHES;
            spent = clock_processor() - before;
        }
        if (r > 0 && spent / patches < best) best = spent / patches;
    }
    if (line == NULL || out == NULL) report_error("bench: out of memory");
    free(line);
    free(out);
    return isfinite(best) && isfinite(sink) ? best : NAN;
}

/* Where a window of this size stands in the middle of a side. */
static float centred(int side, float size) {
    return 0.5f * ((float)side - size) - 2.0f;
}

/* The peaks of a contender's candidates, in windows of the size that they have in its view. */
static bool patch_peaks(const struct bench *b, const struct contender *c, struct peak *p) {
    const struct film *film = c->film;
    const struct ast_tracker *t = c->tracker;
    const float scale = t->estimate.scale / t->view.pixel, w = t->box_width * scale, h = t->box_height * scale;
    struct samples s = {.pixels = film->pixels, .stride = film->width, .width = film->width, .height = film->height};
    p->patch = p->cells = 0;
    if (c->config.patch_weight > 0.0f) {
        peak_aim(&s.columns, centred(s.width, w), w, c->config.patch_width, 1);
        peak_aim(&s.rows, centred(s.height, h), h, c->config.patch_height, 1);
        p->patch = patch_peak(b, &s);
    }
    if (c->config.gradient_weight > 0.0f) {
        /* Any bytes will do: the film's, taken as maps of a view. */
        const int side = c->config.view, cells = c->config.gradient_cells;
        uint8_t *maps = malloc((size_t)side * (size_t)side * PEAK_DIRECTIONS);
        if (maps == NULL) {
            report_error("bench: out of memory");
            return false;
        }
        for (int i = 0; i < side * side * PEAK_DIRECTIONS; i++) maps[i] = film->pixels[i % (film->width * film->height)];
        s.pixels = maps;
        s.stride = s.width = s.height = side;
        s.cells = true;
        peak_aim(&s.columns, centred(side, w), w, cells, 0);
        peak_aim(&s.rows, centred(side, h), h, cells, 0);
        p->cells = patch_peak(b, &s);
        free(maps);
    }
    return !isnan(p->patch) && !isnan(p->cells);
}

/* ---- A step against them ---- */

static double best_speed(const struct peak *p) {
    double best = 0;
    for (int s = 0; s < SHAPES; s++)
        for (int k = 0; k < BACKENDS; k++) best = greater(best, p->speed[s][k]);
    return best;
}

static bool find_peaks(const struct bench *b, const struct contender *c, struct peak *p) {
    const ast_config *cfg = &c[0].config;
    p->columns = product_columns(cfg);
    const int scored = ast_shortlist_length(cfg);
    p->operations = bag_operations(cfg) + glance_operations(cfg) + metric_operations(cfg);
    for (int s = 0; s < SHAPES; s++) {
        p->shape[s].name = s == 0 ? "a tile" : "all that are scored";
        p->shape[s].rows = s == 0 ? AST_TILE : p->columns; /* as the library calls it, and as suits a product best */
        p->shape[s].cols = s == 0 ? p->columns : scored;
        p->shape[s].depth = ast_feature_length(cfg);
    }
    if (!product_peaks(b, p->shape, SHAPES, p->speed) || !patch_peaks(b, &c[0], p)) return false;
    p->products = p->operations / best_speed(p);
    p->product = bag_operations(cfg) / best_speed(p);
    p->patches = cfg->particles * p->patch + scored * p->cells;
    for (int k = 0; k < BACKENDS; k++) {
        const double own = stage_spread(&c[k], STAGE_PATCHES).least;
        if (own < p->patches) p->patches = own; /* false for nan */
    }
    return true;
}

static double least_time(const struct peak *p) {
    return p->products + p->patches;
}

/* ---- What is printed and written ---- */

static void print_peaks(const struct peak *p, const struct contender *c) {
    char title[64];
    printf("%s: N = %d, D = %d, %d columns, %.1f million operations in products\n", preset_name(c->preset),
           (int)c->config.particles, (int)ast_feature_length(&c->config), p->columns, 1e-6 * p->operations);
    table_begin("  product, Gflop/s");
    for (int k = 0; k < BACKENDS; k++) table_cell("%s", backends[k]->name);
    table_end();
    for (int s = 0; s < SHAPES; s++) {
        (void)snprintf(title, sizeof title, "  %s: %d x %d x %d", p->shape[s].name, p->shape[s].rows, p->shape[s].cols,
                       p->shape[s].depth);
        table_begin(title);
        for (int k = 0; k < BACKENDS; k++) table_cell("%.1f", 1e-9 * p->speed[s][k]);
        table_end();
    }
    printf("  peak of a candidate's samples: grey patch %.3f us, gradient cells %.3f us\n", 1e6 * p->patch, 1e6 * p->cells);
    printf("  least time of a step: products %.3f ms + patches %.3f ms = %.3f ms\n", 1e3 * p->products, 1e3 * p->patches,
           1e3 * least_time(p));
}

static void print_steps(const struct peak *p, const struct contender *c) {
    table_begin("  against that");
    for (int k = 0; k < BACKENDS; k++) table_cell("%s", backends[k]->name);
    table_end();
    table_begin("  step, ms");
    for (int k = 0; k < BACKENDS; k++) table_spread(step_spread(&c[k]), 1e3, 3);
    table_end();
    table_begin("  step, times the least");
    for (int k = 0; k < BACKENDS; k++) table_spread(step_spread(&c[k]), 1 / least_time(p), 2);
    table_end();
    table_begin("  product, times its least");
    for (int k = 0; k < BACKENDS; k++) table_spread(stage_spread(&c[k], STAGE_PRODUCT), 1 / p->product, 2);
    table_end();
    table_begin("  patches, times their least");
    for (int k = 0; k < BACKENDS; k++) table_spread(stage_spread(&c[k], STAGE_PATCHES), 1 / p->patches, 2);
    table_end();
}

static void write(struct json *j, const struct peak *p, const struct contender *c) {
    json_object(j, NULL);
    json_text(j, "preset", preset_name(c->preset));
    json_number(j, "particles", c->config.particles);
    json_number(j, "features", ast_feature_length(&c->config));
    json_number(j, "columns", p->columns);
    json_number(j, "operations", p->operations);
    json_array(j, "products");
    for (int s = 0; s < SHAPES; s++) {
        for (int k = 0; k < BACKENDS; k++) {
            json_object(j, NULL);
            json_text(j, "shape", p->shape[s].name);
            json_number(j, "rows", p->shape[s].rows);
            json_number(j, "columns", p->shape[s].cols);
            json_number(j, "depth", p->shape[s].depth);
            json_text(j, "backend", backends[k]->name);
            json_number(j, "gflops", 1e-9 * p->speed[s][k]);
            json_end(j);
        }
    }
    json_end(j);
    json_number(j, "patch_us", 1e6 * p->patch);
    json_number(j, "cells_us", 1e6 * p->cells);
    json_number(j, "least_products_ms", 1e3 * p->products);
    json_number(j, "least_patches_ms", 1e3 * p->patches);
    json_number(j, "least_ms", 1e3 * least_time(p));
    json_array(j, "steps");
    for (int k = 0; k < BACKENDS; k++) {
        const struct spread step = step_spread(&c[k]);
        json_object(j, NULL);
        json_text(j, "backend", backends[k]->name);
        json_spread(j, "step_ms", &step, 1e3);
        json_spread(j, "times_least", &step, 1 / least_time(p));
        json_end(j);
    }
    json_end(j);
    json_end(j);
}

static bool one_preset(struct bench *b, int preset) {
    struct contender *c = calloc(BACKENDS, sizeof *c), *all[BACKENDS];
    struct peak p;
    memset(&p, 0, sizeof p);
    bool good = c != NULL;
    if (!good) report_error("bench: out of memory");
    for (int k = 0; k < BACKENDS && good; k++) {
        all[k] = &c[k];
        contender_choose(&c[k], &b->film[0], preset, backends[k]);
        c[k].probed = true;
        good = contender_open(&c[k]);
    }
    good = good && take_turns(all, BACKENDS, b->rounds, 2 * b->steps, false) && find_peaks(b, c, &p);
    if (good) {
        print_peaks(&p, c);
        print_steps(&p, c);
        write(&b->json, &p, c);
    }
    for (int k = 0; k < BACKENDS && c != NULL; k++) contender_close(&c[k]);
    free(c);
    return good;
}

bool bench_roofline(struct bench *b) {
    bool good = true;
    printf("\n== roofline, on %s ==\n\n", b->film[0].name);
    json_array(&b->json, "roofline");
    for (int p = 0; p < CASES && good; p++) good = one_preset(b, presets[p]);
    json_end(&b->json);
    return good;
}
