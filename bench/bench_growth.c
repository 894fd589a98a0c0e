/* How a step's time grows with the number of particles and with the patch: the exponent of the power law that fits. */
#include "bench.h"

#include "report.h"
#include "table.h"

#include <math.h>
#include <stdlib.h>

enum { VALUES = 7 };

/* What is varied. Sizes are the number that the exponent belongs to: N, or the D of a patch of so many pixels a side. */
static const struct sweep {
    const char *name, *size;
    int preset;
    bool patch; /* the sides of the patch take the values, not the particles */
    int values[VALUES], quick[VALUES];
    int large; /* sizes from here on are fitted on their own, too: there, nothing fixed hides the growth */
} sweeps[] = {
    {"particles, paper", "N", AST_PRESET_PAPER, false, {100, 200, 500, 1000, 2000, 5000, 10000}, {100, 300, 1000}, 1000},
    {"particles, robust", "N", AST_PRESET_ROBUST, false, {100, 200, 500, 1000, 2000, 5000, 10000}, {100, 300, 1000}, 1000},
    {"patch, paper", "D", AST_PRESET_PAPER, true, {16, 24, 32, 48, 64}, {16, 32, 64}, 1024},
};
enum { SWEEPS = sizeof sweeps / sizeof sweeps[0] };

struct curve {
    struct contender point[VALUES];
    double size[VALUES];
    int count;
    double exponent, exponent_large;
};

static bool measure(struct bench *b, const struct sweep *sweep, struct curve *curves) {
    struct contender *all[VALUES * BACKENDS];
    const int *values = b->quick ? sweep->quick : sweep->values;
    int count = 0;
    for (int k = 0; k < BACKENDS; k++) {
        struct curve *curve = &curves[k];
        for (int v = 0; v < VALUES && values[v] > 0; v++) {
            struct contender *c = &curve->point[v];
            contender_choose(c, &b->film[0], sweep->preset, backends[k]);
            if (sweep->patch)
                c->config.patch_width = c->config.patch_height = values[v];
            else
                c->config.particles = values[v];
            curve->size[v] = sweep->patch ? (double)ast_feature_length(&c->config) : (double)values[v];
            curve->count = v + 1;
            all[count++] = c;
            if (!contender_open(c)) return false;
        }
    }
    const int rounds = b->rounds < 5 ? b->rounds : 5, steps = b->steps < 3 ? b->steps : 3;
    return take_turns(all, count, rounds, steps, false);
}

static void fit(const struct sweep *sweep, struct curve *curve) {
    double median[VALUES];
    int large = 0;
    for (int v = 0; v < curve->count; v++) {
        median[v] = step_spread(&curve->point[v]).median;
        if (curve->size[v] < sweep->large) large = v + 1;
    }
    curve->exponent = growth_exponent(curve->size, median, curve->count);
    curve->exponent_large = growth_exponent(curve->size + large, median + large, curve->count - large);
}

static void print(const struct sweep *sweep, const struct curve *curves) {
    char title[64];
    (void)snprintf(title, sizeof title, "%s: %s", sweep->name, sweep->size);
    table_begin(title);
    for (int k = 0; k < BACKENDS; k++) table_cell("%s, ms", backends[k]->name);
    table_end();
    for (int v = 0; v < curves[0].count; v++) {
        (void)snprintf(title, sizeof title, "  %.0f", curves[0].size[v]);
        table_begin(title);
        for (int k = 0; k < BACKENDS; k++) table_spread(step_spread(&curves[k].point[v]), 1e3, 3);
        table_end();
    }
    (void)snprintf(title, sizeof title, "exponent in %s", sweep->size);
    table_begin(title);
    for (int k = 0; k < BACKENDS; k++) table_cell("%.3f", curves[k].exponent);
    table_end();
    (void)snprintf(title, sizeof title, "  from %d on", sweep->large);
    table_begin(title);
    for (int k = 0; k < BACKENDS; k++) {
        if (isnan(curves[k].exponent_large))
            table_cell("-");
        else
            table_cell("%.3f", curves[k].exponent_large);
    }
    table_end();
}

static void write(struct json *j, const struct sweep *sweep, const struct curve *curve, int backend) {
    json_object(j, NULL);
    json_text(j, "name", sweep->name);
    json_text(j, "size", sweep->size);
    json_text(j, "preset", preset_name(sweep->preset));
    json_text(j, "backend", backends[backend]->name);
    json_number(j, "exponent", curve->exponent);
    json_number(j, "large_from", sweep->large);
    json_number(j, "exponent_large", curve->exponent_large);
    json_array(j, "points");
    for (int v = 0; v < curve->count; v++) {
        const struct spread step = step_spread(&curve->point[v]);
        json_object(j, NULL);
        json_number(j, "size", curve->size[v]);
        json_spread(j, "step_ms", &step, 1e3);
        json_end(j);
    }
    json_end(j);
    json_end(j);
}

static bool one_sweep(struct bench *b, const struct sweep *sweep) {
    struct curve *curves = calloc(BACKENDS, sizeof *curves);
    if (curves == NULL) report_error("bench: out of memory");
    const bool good = curves != NULL && measure(b, sweep, curves);
    for (int k = 0; k < BACKENDS && good; k++) fit(sweep, &curves[k]);
    if (good) print(sweep, curves);
    for (int k = 0; k < BACKENDS && good; k++) write(&b->json, sweep, &curves[k], k);
    for (int k = 0; k < BACKENDS && curves != NULL; k++)
        for (int v = 0; v < VALUES; v++) contender_close(&curves[k].point[v]);
    free(curves);
    return good;
}

bool bench_growth(struct bench *b) {
    bool good = true;
    printf("\n== growth, on %s ==\n\n", b->film[0].name);
    json_array(&b->json, "growth");
    for (int s = 0; s < SWEEPS && good; s++) good = one_sweep(b, &sweeps[s]);
    json_end(&b->json);
    return good;
}
