/* A sensor that fails: black, saturated and frozen pictures, with the presets for microcontrollers. Every result is a number, black
 * and saturated pictures are not trusted, and the object is found again when the picture returns. Minutes of it: make
 * test-firmware. */
#include "asttrack.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support_backends.h"
#include "support_render.h"
#include "support_tracker.h"
#include "unity.h"

/* The path is 100 frames long: after FAULTY frames the object is where it was. */
enum { WIDTH = 160, HEIGHT = 120, BEFORE = 40, FAULTY = 300, TO_RECOVER = 60, IN_A_ROW = 3 };

enum fault { BLACK, SATURATED, FROZEN, FAULTS };
static const char *const fault_names[FAULTS] = {"black", "saturated", "frozen"};

static struct render scene;

void setUp(void) {
    render_open(&scene, WIDTH, HEIGHT, 11);
}
void tearDown(void) {
    render_close(&scene);
}

static ast_box truth(int f) {
    return render_path(&scene, f, 32, 26, 0.2, 1.0);
}

static ast_result step(ast_tracker *t, const ast_frame *frame) {
    ast_result r;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(t, frame, &r));
    const float numbers[] = {r.box.x, r.box.y, r.box.w, r.box.h, r.scale, r.score, r.distance, r.effective_particles};
    for (size_t n = 0; n < sizeof numbers / sizeof numbers[0]; n++) TEST_ASSERT_TRUE(isfinite(numbers[n]));
    TEST_ASSERT_TRUE(r.score >= 0.0f && r.score <= 1.0f);
    TEST_ASSERT_TRUE(r.status == AST_TRACKING || r.status == AST_UNCERTAIN || r.status == AST_LOST);
    return r;
}

static void survive(int preset, const char *name, enum fault fault) {
    static uint8_t stuck[WIDTH * HEIGHT];
    ast_config cfg;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&cfg, preset));
    ast_tracker *t = tracker_new(&cfg, backends[0]);
    ast_box box = truth(0);
    ast_frame frame = render_frame(&scene, &box);
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_start(t, &frame, &box));
    int f = 1;
    for (; f <= BEFORE; f++) {
        box = truth(f);
        frame = render_frame(&scene, &box);
        (void)step(t, &frame);
    }
    if (fault == FROZEN)
        memcpy(stuck, frame.pixels, sizeof stuck);
    else
        memset(stuck, fault == BLACK ? 0 : 255, sizeof stuck);
    const ast_frame broken = {stuck, WIDTH, HEIGHT, WIDTH};
    int trusted = 0, recovered = 0, frames = 0;
    for (int k = 0; k < FAULTY; k++, f++) trusted += step(t, &broken).status == AST_TRACKING;
    /* Found is not yet trusted: the score keeps a loss in mind for a while. */
    while (recovered < IN_A_ROW && frames++ < TO_RECOVER) {
        box = truth(f++);
        frame = render_frame(&scene, &box);
        const ast_result r = step(t, &frame);
        recovered = r.status != AST_LOST && box_distance(&r.box, &box) < 10 ? recovered + 1 : 0;
    }
    char what[120];
    snprintf(what, sizeof what, "%s, %s: %d trusted, %s after %d frames", name, fault_names[fault], trusted,
             recovered == IN_A_ROW ? "found" : "not found", frames);
    TEST_ASSERT_TRUE_MESSAGE(fault == FROZEN || trusted <= cfg.lost_after, what);
    TEST_ASSERT_TRUE_MESSAGE(recovered == IN_A_ROW, what);
    ast_free(t);
}

static void test_tiny_survives(void) {
    for (int fault = 0; fault < FAULTS; fault++) survive(AST_PRESET_TINY, "tiny", (enum fault)fault);
}

static void test_compact_survives(void) {
    for (int fault = 0; fault < FAULTS; fault++) survive(AST_PRESET_COMPACT, "compact", (enum fault)fault);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_tiny_survives);
    RUN_TEST(test_compact_survives);
    return UNITY_END();
}
