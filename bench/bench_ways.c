/* The ways to the same distances beside each other: literal and gram, lapacke and builtin, whole and by stage. */
#include "bench.h"

#include "table.h"

#include <stdlib.h>
#include <string.h>

/* What is measured, with each backend. */
static const struct way {
    const char *name;
    int preset, scoring;
    bool staged;
} ways[] = {
    {"paper, gram", AST_PRESET_PAPER, AST_SCORING_GRAM, true},
    {"paper, literal", AST_PRESET_PAPER, AST_SCORING_LITERAL, true},
    {"robust", AST_PRESET_ROBUST, AST_SCORING_GRAM, true},
    {"tiny", AST_PRESET_TINY, AST_SCORING_GRAM, false},
};
enum { WAYS = sizeof ways / sizeof ways[0], GRAM = 0, LITERAL = 1 };

/* One for a figure of the whole step, and one that is probed for its stages. */
struct field {
    struct contender whole[WAYS][BACKENDS];
    struct contender staged[WAYS][BACKENDS];
};

static bool open_one(struct contender *c, const struct film *film, int way, int backend, bool probed) {
    contender_choose(c, film, ways[way].preset, backends[backend]);
    (void)snprintf(c->label, sizeof c->label, "%s, %s", ways[way].name, backends[backend]->name);
    c->config.scoring = ways[way].scoring;
    c->probed = probed;
    return contender_open(c);
}

static bool measure(const struct bench *b, struct field *f, const struct film *film) {
    struct contender *all[2 * WAYS * BACKENDS];
    int count = 0;
    bool good = true;
    for (int w = 0; w < WAYS && good; w++) {
        for (int k = 0; k < BACKENDS && good; k++) {
            good = open_one(&f->whole[w][k], film, w, k, false);
            all[count++] = &f->whole[w][k];
            if (!good || !ways[w].staged) continue;
            good = open_one(&f->staged[w][k], film, w, k, true);
            all[count++] = &f->staged[w][k];
        }
    }
    return good && take_turns(all, count, b->rounds, b->steps, false);
}

/* ---- What is printed ---- */

static void heads(const char *title) {
    table_begin(title);
    for (int k = 0; k < BACKENDS; k++) table_cell("%s", backends[k]->name);
    if (BACKENDS > 1) table_cell("%s / %s", backends[0]->name, backends[BACKENDS - 1]->name);
    table_end();
}

static void print_whole(const struct field *f) {
    heads("step, ms");
    for (int w = 0; w < WAYS; w++) {
        table_begin(ways[w].name);
        for (int k = 0; k < BACKENDS; k++) table_spread(step_spread(&f->whole[w][k]), 1e3, 3);
        if (BACKENDS > 1) table_spread(step_ratio(&f->whole[w][0], &f->whole[w][BACKENDS - 1]), 1, 2);
        table_end();
    }
    table_begin("literal / gram");
    for (int k = 0; k < BACKENDS; k++) table_spread(step_ratio(&f->whole[LITERAL][k], &f->whole[GRAM][k]), 1, 1);
    table_end();
}

static void print_stages(const struct field *f, int way) {
    char title[64];
    (void)snprintf(title, sizeof title, "%s: stage, ms", ways[way].name);
    heads(title);
    for (int s = 0; s < STAGES; s++) {
        table_begin(stage_name((enum stage)s));
        for (int k = 0; k < BACKENDS; k++) table_spread(stage_spread(&f->staged[way][k], (enum stage)s), 1e3, 4);
        if (BACKENDS > 1) table_spread(stage_ratio(&f->staged[way][0], &f->staged[way][BACKENDS - 1], (enum stage)s), 1, 2);
        table_end();
    }
}

static void print_stage_ratios(const struct field *f) {
    table_begin("paper: literal / gram");
    for (int k = 0; k < BACKENDS; k++) table_cell("%s", backends[k]->name);
    table_end();
    for (int s = 0; s < STAGES; s++) {
        table_begin(stage_name((enum stage)s));
        for (int k = 0; k < BACKENDS; k++)
            table_spread(stage_ratio(&f->staged[LITERAL][k], &f->staged[GRAM][k], (enum stage)s), 1, 2);
        table_end();
    }
}

static void print_lost(const struct field *f) {
    for (int w = 0; w < WAYS; w++)
        for (int k = 0; k < BACKENDS; k++)
            if (f->whole[w][k].lost > 0)
                printf("%s: lost in %d of %d steps\n", f->whole[w][k].label, f->whole[w][k].lost, f->whole[w][k].steps);
}

/* ---- What is written ---- */

static void write_step(struct json *j, const struct field *f, int way, int backend) {
    const struct contender *c = &f->whole[way][backend], *staged = &f->staged[way][backend];
    const struct spread step = step_spread(c);
    json_object(j, NULL);
    json_text(j, "name", ways[way].name);
    json_text(j, "preset", preset_name(ways[way].preset));
    json_text(j, "scoring", ways[way].scoring == AST_SCORING_GRAM ? "gram" : "literal");
    json_text(j, "backend", backends[backend]->name);
    json_number(j, "particles", c->config.particles);
    json_number(j, "features", ast_feature_length(&c->config));
    json_number(j, "memory_bytes", (double)ast_mem_size_backend(&c->config, c->linalg));
    json_spread(j, "step_ms", &step, 1e3);
    json_number(j, "steps", c->steps);
    json_number(j, "lost", c->lost);
    if (ways[way].staged) {
        json_object(j, "stages_ms");
        for (int s = 0; s < STAGES; s++) {
            const struct spread stage = stage_spread(staged, (enum stage)s);
            json_spread(j, stage_name((enum stage)s), &stage, 1e3);
        }
        json_end(j);
    }
    json_end(j);
}

static void write_ratio(struct json *j, const char *above, const char *below, const char *stage, struct spread ratio) {
    json_object(j, NULL);
    json_text(j, "above", above);
    json_text(j, "below", below);
    json_text(j, "stage", stage);
    json_spread(j, "ratio", &ratio, 1);
    json_end(j);
}

static void write_ratios(struct json *j, const struct field *f) {
    char above[96], below[96];
    for (int k = 0; k < BACKENDS; k++) {
        (void)snprintf(above, sizeof above, "%s, %s", ways[LITERAL].name, backends[k]->name);
        (void)snprintf(below, sizeof below, "%s, %s", ways[GRAM].name, backends[k]->name);
        write_ratio(j, above, below, "step", step_ratio(&f->whole[LITERAL][k], &f->whole[GRAM][k]));
        for (int s = 0; s < STAGES; s++)
            write_ratio(j, above, below, stage_name((enum stage)s),
                        stage_ratio(&f->staged[LITERAL][k], &f->staged[GRAM][k], (enum stage)s));
    }
    for (int w = 0; w < WAYS && BACKENDS > 1; w++) {
        (void)snprintf(above, sizeof above, "%s, %s", ways[w].name, backends[0]->name);
        (void)snprintf(below, sizeof below, "%s, %s", ways[w].name, backends[BACKENDS - 1]->name);
        write_ratio(j, above, below, "step", step_ratio(&f->whole[w][0], &f->whole[w][BACKENDS - 1]));
        for (int s = 0; s < STAGES && ways[w].staged; s++)
            write_ratio(j, above, below, stage_name((enum stage)s),
                        stage_ratio(&f->staged[w][0], &f->staged[w][BACKENDS - 1], (enum stage)s));
    }
}

static void write_film(struct json *j, const struct field *f, const struct film *film) {
    json_object(j, NULL);
    json_text(j, "sequence", film->name);
    json_number(j, "frames", film->count);
    json_number(j, "width", film->width);
    json_number(j, "height", film->height);
    json_array(j, "steps");
    for (int w = 0; w < WAYS; w++)
        for (int k = 0; k < BACKENDS; k++) write_step(j, f, w, k);
    json_end(j);
    json_array(j, "ratios");
    write_ratios(j, f);
    json_end(j);
    json_end(j);
}

/* ---- */

static bool on_film(struct bench *b, const struct film *film) {
    struct field *f = calloc(1, sizeof *f);
    const bool good = f != NULL && measure(b, f, film);
    if (good) {
        printf("\n== %s: %d frames of %d x %d, forth and back; median (least .. greatest) of %d rounds ==\n\n", film->name,
               (int)film->count, (int)film->width, (int)film->height, b->rounds);
        print_whole(f);
        for (int w = 0; w < WAYS; w++)
            if (ways[w].staged) print_stages(f, w);
        print_stage_ratios(f);
        print_lost(f);
        write_film(&b->json, f, film);
    }
    for (int w = 0; w < WAYS && f != NULL; w++) {
        for (int k = 0; k < BACKENDS; k++) {
            contender_close(&f->whole[w][k]);
            contender_close(&f->staged[w][k]);
        }
    }
    free(f);
    return good;
}

bool bench_ways(struct bench *b) {
    bool good = true;
    json_array(&b->json, "sequences");
    for (int i = 0; i < b->films && good; i++) good = on_film(b, &b->film[i]);
    json_end(&b->json);
    return good;
}
