/* Instructions of a step, counted by callgrind: they repeat to the last digit where times do not. The processor that valgrind shows
 * to a program has AVX2 at most: where a library chooses its kernels by the processor, those are the ones counted. */
#include "bench.h"

#include "callgrind.h"
#include "counting.h"
#include "report.h"
#include "table.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const struct counted {
    const char *name;
    int preset, scoring;
    bool quick; /* counted in a quick run, too */
} cases[] = {
    {"tiny", AST_PRESET_TINY, AST_SCORING_GRAM, true},
    {"paper, gram", AST_PRESET_PAPER, AST_SCORING_GRAM, false},
    {"paper, literal", AST_PRESET_PAPER, AST_SCORING_LITERAL, false},
    {"robust", AST_PRESET_ROBUST, AST_SCORING_GRAM, false},
};
enum { CASES = sizeof cases / sizeof cases[0] };

/* The functions whose calls are added up. */
enum { STEP, PREPARE, TILE, PRODUCT, PRODUCT_REAL, FEATURES, COUNTS };
static const char *const functions[COUNTS] = {"counted_step",   "probed_prepare",      "probed_tile",
                                              "probed_product", "probed_product_real", "ast_features_vector"};

/* Steps that are counted: as many as there are from one model to the next, so that one of them learns. The literal scoring takes
 * minutes under valgrind and never differs much. */
static int steps_of(const struct counted *one, const ast_config *config) {
    return one->scoring == AST_SCORING_LITERAL ? 1 : config->bag_interval;
}

/* What is told of a step: the stages that are functions, and the rest. */
enum { PART_STEP, PART_HISTORY, PART_PATCHES, PART_PRODUCT, PART_SMALL, PART_REST, PARTS };
static const char *const part_names[PARTS] = {"step", "history", "patches", "product", "small problems", "all else"};

static void parts_of(const struct callgrind_count *n, int steps, double *part) {
    const double tiles = (double)n[TILE].instructions / steps;
    part[PART_STEP] = (double)n[STEP].instructions / steps;
    part[PART_HISTORY] = (double)n[PREPARE].instructions / steps;
    part[PART_PATCHES] = (double)n[FEATURES].instructions / steps;
    part[PART_PRODUCT] = (double)(n[PRODUCT].instructions + n[PRODUCT_REAL].instructions) / steps;
    part[PART_SMALL] = tiles - part[PART_PRODUCT];
    part[PART_REST] = part[PART_STEP] - tiles - part[PART_HISTORY] - part[PART_PATCHES];
}

/* False after reporting why. */
static bool count_one(const struct bench *b, const struct counted *one, int backend, const char *directory, double *part) {
    struct contender c;
    struct callgrind_count counts[COUNTS];
    char state[256], profile[256];
    (void)snprintf(state, sizeof state, "%s/state", directory);
    (void)snprintf(profile, sizeof profile, "%s/profile", directory);
    contender_choose(&c, &b->film[0], one->preset, backends[backend]);
    c.config.scoring = one->scoring;
    const int steps = steps_of(one, &c.config);
    bool good = contender_open(&c) && counting_write(&c, state, steps);
    contender_close(&c);
    if (!good) return false;
    for (int i = 0; i < COUNTS; i++) counts[i].function = functions[i];
    good = callgrind_run(b->program, "count", state, functions[STEP], profile);
    FILE *file = good ? fopen(profile, "r") : NULL;
    good = file != NULL && callgrind_read(file, counts, COUNTS) && counts[STEP].instructions > 0;
    if (file != NULL) (void)fclose(file);
    (void)unlink(state);
    (void)unlink(profile);
    if (!good) {
        report_error("%s, %s: valgrind --tool=callgrind failed on `%s count`", one->name, backends[backend]->name, b->program);
        return false;
    }
    parts_of(counts, steps, part);
    return true;
}

static bool count_all(struct bench *b, const char *directory) {
    for (int i = 0; i < CASES; i++) {
        double part[BACKENDS][PARTS];
        if (b->quick && !cases[i].quick) continue;
        for (int k = 0; k < BACKENDS; k++) {
            if (!count_one(b, &cases[i], k, directory, part[k])) return false;
            json_object(&b->json, NULL);
            json_text(&b->json, "name", cases[i].name);
            json_text(&b->json, "preset", preset_name(cases[i].preset));
            json_text(&b->json, "backend", backends[k]->name);
            for (int p = 0; p < PARTS; p++) json_number(&b->json, part_names[p], part[k][p]);
            json_end(&b->json);
        }
        table_begin(cases[i].name);
        for (int k = 0; k < BACKENDS; k++) table_cell("%s, million", backends[k]->name);
        table_end();
        for (int p = 0; p < PARTS; p++) {
            table_begin(part_names[p]);
            for (int k = 0; k < BACKENDS; k++) table_cell("%.3f", 1e-6 * part[k][p]);
            table_end();
        }
    }
    return true;
}

bool bench_instructions(struct bench *b) {
    const char *absent = NULL;
    bool good = true;
    printf("\n== instructions of a step, on %s ==\n\n", b->film[0].name);
    if (!callgrind_available()) absent = "there is no valgrind: on Debian, apt-get install valgrind";
    json_object(&b->json, "instructions");
    json_text(&b->json, "absent", absent);
    json_array(&b->json, "steps");
    if (absent != NULL) {
        printf("not counted: %s\n", absent);
    } else {
        const char *root = getenv("TMPDIR");
        char directory[200];
        (void)snprintf(directory, sizeof directory, "%s/asttrack-bench-XXXXXX", root != NULL && strlen(root) < 100 ? root : "/tmp");
        good = mkdtemp(directory) != NULL;
        if (!good) report_error("%s: cannot make a directory", directory);
        good = good && count_all(b, directory);
        (void)rmdir(directory);
    }
    json_end(&b->json);
    json_end(&b->json);
    return good;
}
