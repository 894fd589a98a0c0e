/* Real frames: literal and Gram scoring, and the two backends, give the same distances and the same winner. Prints the largest
 * differences. Needs a directory of sequences (AST_SEQUENCES, or ../shared/sequences beside the checkout). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "image_read.h"
#include "sequence.h"
#include "support_backends.h"
#include "support_watched.h"
#include "tracker.h"
#include "unity.h"

/* What watches for wrong accesses sees all there is to see in the first frames with a model. */
enum { FRAMES = WATCHED ? 10 : 40, PARTICLES = 150 };

void setUp(void) {
}
void tearDown(void) {
}

/* Two trackers that see the same: the second takes the first's state before each frame. */
struct pair {
    ast_tracker *first, *second;
    void *state;
    size_t state_size;
    double largest;
    int frames;
};

static void open_pair(struct pair *p, const ast_config *cfg, int other_scoring, const struct ast_linalg *first,
                      const struct ast_linalg *second) {
    ast_config other = *cfg;
    other.scoring = other_scoring;
    memset(p, 0, sizeof *p);
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_init_backend(&p->first, cfg, first, NULL, 0));
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_init_backend(&p->second, &other, second, NULL, 0));
    p->state_size = ast_save_size(cfg);
    p->state = malloc(p->state_size);
    TEST_ASSERT_NOT_NULL(p->state);
}

static void close_pair(struct pair *p) {
    ast_free(p->first);
    ast_free(p->second);
    free(p->state);
}

static void compare(struct pair *p, const ast_frame *frame) {
    ast_result a, b;
    ast_particles x, y;
    double here = 0;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_save(p->first, p->state, p->state_size));
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_restore(p->second, p->state, p->state_size));
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(p->first, frame, &a));
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(p->second, frame, &b));
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(p->first, &x));
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(p->second, &y));
    TEST_ASSERT_EQUAL_INT(x.models, y.models);
    for (int i = 0; i < x.scored * x.models; i++) {
        const double difference = fabs((double)x.distance[i] - (double)y.distance[i]);
        TEST_ASSERT_TRUE(difference >= 0); /* false for NaN */
        if (difference > here) here = difference;
    }
    /* The same winner, unless the two winners tie within what the distances differ by. */
    if (a.best != b.best) {
        double gap = 0;
        for (int j = 0; j < x.models; j++)
            gap = fmax(gap, fabs((double)x.distance[a.best * x.models + j] - (double)x.distance[b.best * x.models + j]));
        TEST_ASSERT_TRUE(gap <= 2 * here);
    }
    if (here > p->largest) p->largest = here;
    p->frames++;
}

/* Runs both trackers of the pair over the sequence's first frames. */
static void run(struct pair *p, const char *name) {
    const char *given = getenv("AST_SEQUENCES");
    char path[4096], message[4300];
    char *inputs[] = {path};
    struct stat there;
    sequence s;
    image grey = {0};
    image_reader reader = {0};
    snprintf(path, sizeof path, "%s/%s", given != NULL ? given : "../shared/sequences", name);
    if (stat(path, &there) != 0) {
        TEST_ASSERT_NULL_MESSAGE(given, "AST_SEQUENCES does not hold the sequence");
        snprintf(message, sizeof message, "%s is not there: not compared (AST_SEQUENCES names the directory)", path);
        TEST_IGNORE_MESSAGE(message);
    }
#ifndef AST_WITH_JPEG
    TEST_IGNORE_MESSAGE("built without JPEG: not compared");
#endif
    TEST_ASSERT_TRUE(sequence_open(&s, inputs, 1));
    for (int f = 0; f <= FRAMES && f < s.count; f++) {
        TEST_ASSERT_TRUE(image_read(&reader, s.frames[f], &grey));
        const ast_frame frame = image_frame(&grey);
        if (f == 0)
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_start(p->first, &frame, &s.annotations.boxes[0]));
        else
            compare(p, &frame);
    }
    sequence_close(&s);
    image_reader_free(&reader);
    image_free(&grey);
}

static ast_config paper(int basis, int history) {
    ast_config cfg;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&cfg, AST_PRESET_PAPER));
    cfg.particles = PARTICLES;
    cfg.basis = basis;
    cfg.history = history;
    return cfg;
}

static void expect_agreement(const char *name, const char *what, const ast_config *cfg, int other_scoring,
                             const struct ast_linalg *first, const struct ast_linalg *second) {
    struct pair p;
    open_pair(&p, cfg, other_scoring, first, second);
    run(&p, name);
    printf("%s, %s: largest difference %.2g over %d frames of %d particles\n", name, what, p.largest, p.frames, (int)PARTICLES);
    TEST_ASSERT_TRUE(p.frames > 0 && p.largest <= 1e-3);
    close_pair(&p);
}

static void scorings_agree(const char *name) {
    const struct { int basis, history; } kinds[] = {{AST_BASIS_CENTRED, 3}, {AST_BASIS_CENTRED, 5}, {AST_BASIS_RAW, 3}};
    for (int b = 0; b < BACKENDS; b++) {
        for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
            const ast_config cfg = paper(kinds[k].basis, kinds[k].history);
            char what[100];
            snprintf(what, sizeof what, "gram against literal, %s, %s basis, P %d", backends[b]->name,
                     kinds[k].basis == AST_BASIS_CENTRED ? "centred" : "raw", kinds[k].history);
            expect_agreement(name, what, &cfg, AST_SCORING_LITERAL, backends[b], backends[b]);
        }
    }
}

static void test_scorings_agree_on_girl(void) {
    scorings_agree("girl");
}

static void test_scorings_agree_on_occluded_face2(void) {
    scorings_agree("occluded_face2");
}

static void test_backends_agree(void) {
    const ast_config cfg = paper(AST_BASIS_CENTRED, 3);
    if (BACKENDS < 2) TEST_IGNORE_MESSAGE("built without lapacke: nothing to compare builtin with");
    expect_agreement("girl", "lapacke against builtin, gram", &cfg, AST_SCORING_GRAM, backends[BACKENDS - 1], backends[0]);
    expect_agreement("occluded_face2", "lapacke against builtin, gram", &cfg, AST_SCORING_GRAM, backends[BACKENDS - 1],
                     backends[0]);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_scorings_agree_on_girl);
    RUN_TEST(test_scorings_agree_on_occluded_face2);
    RUN_TEST(test_backends_agree);
    return UNITY_END();
}
