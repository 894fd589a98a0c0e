/* One thread against two, in time that passes. */
#include "bench.h"

#include "report.h"
#include "table.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { CASES = 2, THREADS = 2 };
static const int presets[CASES] = {AST_PRESET_PAPER, AST_PRESET_ROBUST};
static const char field_name[] = "threads";

/* The field is looked for by name, because a library built without threads need not have it. */
static const ast_config_field *threads_field(void) {
    int32_t count = 0;
    const ast_config_field *fields = ast_config_fields(&count);
    for (int32_t f = 0; f < count; f++)
        if (strcmp(fields[f].name, field_name) == 0) return &fields[f];
    return NULL;
}

static void set_threads(ast_config *config, const ast_config_field *field, int32_t threads) {
    memcpy((unsigned char *)config + field->offset, &threads, sizeof threads);
}

/* Why there is nothing to measure; NULL when there is. */
static const char *obstacle(const ast_config_field *field) {
    ast_config config;
    if (field == NULL) return "this library has no threads: its configuration has no field `threads`";
    if (field->maximum < (float)THREADS || ast_config_preset(&config, presets[0]) != AST_OK)
        return "this library is built without threads: the field `threads` does not go up to 2";
    set_threads(&config, field, THREADS);
    ast_tracker *t = NULL;
    if (ast_init(&t, &config, NULL, 0) != AST_OK) return "this library is built without threads: it refuses `threads` = 2";
    ast_free(t);
    if (sysconf(_SC_NPROCESSORS_ONLN) < THREADS) return "this machine has one core";
    return NULL;
}

static bool measure(struct bench *b, const ast_config_field *field, struct contender (*c)[CASES][BACKENDS]) {
    struct contender *all[THREADS * CASES * BACKENDS];
    int count = 0;
    for (int p = 0; p < CASES; p++) {
        for (int k = 0; k < BACKENDS; k++) {
            for (int t = 0; t < THREADS; t++) {
                contender_choose(&c[t][p][k], &b->film[0], presets[p], backends[k]);
                set_threads(&c[t][p][k].config, field, t + 1);
                all[count++] = &c[t][p][k];
                if (!contender_open(&c[t][p][k])) return false;
            }
        }
    }
    return take_turns(all, count, b->rounds, b->steps, true);
}

static void show(struct bench *b, struct contender (*c)[CASES][BACKENDS]) {
    table_begin("wall clock of a step, ms");
    table_cell("1 thread");
    table_cell("2 threads");
    table_cell("1 thread / 2 threads");
    table_end();
    for (int p = 0; p < CASES; p++) {
        for (int k = 0; k < BACKENDS; k++) {
            const struct contender *one = &c[0][p][k], *two = &c[1][p][k];
            const struct spread single = step_spread(one), both = step_spread(two), ratio = step_ratio(one, two);
            table_begin(one->label);
            table_spread(single, 1e3, 3);
            table_spread(both, 1e3, 3);
            table_spread(ratio, 1, 2);
            table_end();
            json_object(&b->json, NULL);
            json_text(&b->json, "preset", preset_name(presets[p]));
            json_text(&b->json, "backend", backends[k]->name);
            json_spread(&b->json, "one_ms", &single, 1e3);
            json_spread(&b->json, "two_ms", &both, 1e3);
            json_spread(&b->json, "ratio", &ratio, 1);
            json_end(&b->json);
        }
    }
}

bool bench_threads(struct bench *b) {
    const ast_config_field *field = threads_field();
    const char *why = obstacle(field);
    printf("\n== threads, on %s ==\n\n", b->film[0].name);
    json_object(&b->json, "threads");
    json_text(&b->json, "absent", why);
    json_array(&b->json, "steps");
    bool good = true;
    if (why != NULL) {
        printf("not measured: %s\n", why);
    } else {
        struct contender(*c)[CASES][BACKENDS] = calloc(THREADS, sizeof *c);
        if (c == NULL) report_error("bench: out of memory");
        good = c != NULL && measure(b, field, c);
        if (good) show(b, c);
        for (int t = 0; t < THREADS && c != NULL; t++)
            for (int p = 0; p < CASES; p++)
                for (int k = 0; k < BACKENDS; k++) contender_close(&c[t][p][k]);
        free(c);
    }
    json_end(&b->json);
    json_end(&b->json);
    return good;
}
