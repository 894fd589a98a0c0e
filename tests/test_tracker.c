/* The tracker as a whole: it follows, it repeats, it survives what no tracker can follow, and a call that fails changes nothing. */
#include "tracker.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support_noise.h"
#include "support_precision.h"
#include "support_render.h"
#include "support_tracker.h"
#include "support_watched.h"
#include "unity.h"

enum { WIDTH = 160, HEIGHT = 120 };

static struct render scene;

void setUp(void) {
    render_open(&scene, WIDTH, HEIGHT, 5);
}
void tearDown(void) {
    render_close(&scene);
}

static ast_box truth(int frame) {
    return render_path(&scene, frame, 32, 26, 0.2, 1.0);
}

static void start(ast_tracker *t) {
    const ast_box box = truth(0);
    const ast_frame frame = render_frame(&scene, &box);
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_start(t, &frame, &box));
}

static ast_result step(ast_tracker *t, int frame_number) {
    const ast_box box = truth(frame_number);
    const ast_frame frame = render_frame(&scene, &box);
    ast_result result;
    memset(&result, 0x5a, sizeof result);
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(t, &frame, &result));
    return result;
}

static ast_config preset(int which) {
    ast_config cfg;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&cfg, which));
    return cfg;
}

/* Configurations that combine the parts in different ways. */
enum { VARIANTS = 17 };
static ast_config variant(int which) {
    ast_config cfg = which < 12 ? small_config() : small_robust_config();
    if (which < 12) {
        cfg.scoring = which & 1 ? AST_SCORING_LITERAL : AST_SCORING_GRAM;
        cfg.basis = which & 2 ? AST_BASIS_RAW : AST_BASIS_CENTRED;
        cfg.model = which & 4 && which & 2 ? AST_MODEL_LINEAR : AST_MODEL_AFFINE;
        cfg.normalisation = which % 3;
    }
    if (which == 13) cfg.basis = AST_BASIS_CENTRED;
    if (which == 14) cfg.patch_weight = 0.0f;
    if (which == 15) cfg.background = cfg.background_refresh = cfg.shortlist = 0;
    if (which == 16) cfg.gradient_weight = 0.0f, cfg.ridge = 1e-4f, cfg.background_ratio = 10.0f;
    return cfg;
}

/* Of the particles those that are scored come first, and only they weigh anything. */
static void assert_only_the_scored_weigh(const ast_particles *p, const ast_result *r) {
    TEST_ASSERT_TRUE(p->scored >= 1 && p->scored <= p->count);
    TEST_ASSERT_TRUE(r->best >= 0 && r->best < p->scored);
    for (int i = p->scored; i < p->count; i++) TEST_ASSERT_TRUE_MESSAGE(p->weight[i] == 0.0f, "weight without a score");
}

/* Whatever the frame shows: numbers, and in their ranges. */
static void assert_sane(const ast_tracker *t, const ast_result *r, const ast_frame *frame) {
    ast_particles p;
    ast_config cfg;
    double sum = 0;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_config(t, &cfg));
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(t, &p));
    TEST_ASSERT_TRUE(isfinite(r->box.x) && isfinite(r->box.y) && isfinite(r->distance));
    TEST_ASSERT_TRUE(r->box.w > 0 && r->box.h > 0);
    TEST_ASSERT_TRUE(r->distance >= 0 || cfg.background > 0); /* a likelihood ratio against the background may be negative */
    TEST_ASSERT_TRUE(r->score >= 0 && r->score <= 1);
    TEST_ASSERT_TRUE(r->scale >= cfg.scale_min && r->scale <= cfg.scale_max);
    TEST_ASSERT_TRUE(r->effective_particles >= 0.999f && r->effective_particles <= 1.001f * (float)cfg.particles);
    TEST_ASSERT_TRUE(r->status >= AST_TRACKING && r->status <= AST_LOST);
    assert_only_the_scored_weigh(&p, r);
    for (int i = 0; i < p.count; i++) {
        TEST_ASSERT_TRUE_MESSAGE(p.x[i] >= 0 && p.x[i] <= (float)frame->width, "a particle beside the frame");
        TEST_ASSERT_TRUE_MESSAGE(p.y[i] >= 0 && p.y[i] <= (float)frame->height, "a particle above or below the frame");
        TEST_ASSERT_TRUE(p.scale[i] >= cfg.scale_min && p.scale[i] <= cfg.scale_max);
        TEST_ASSERT_TRUE(p.weight[i] >= 0 && p.weight[i] <= 1);
        sum += (double)p.weight[i];
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, 1.0, sum);
    for (int i = 0; i < p.scored * p.models; i++) TEST_ASSERT_TRUE(isfinite(p.distance[i]));
    for (int32_t m = 0; m < ast_bag_count(t); m++) {
        ast_subspace s;
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_model(t, m, &s));
        for (int d = 0; d < s.dim; d++) TEST_ASSERT_TRUE(isfinite(s.mean[d]));
        for (int l = 0; l < s.n; l++)
            for (int d = 0; d < s.dim; d++) TEST_ASSERT_TRUE(isfinite(s.basis[l * s.stride + d]));
    }
}

/* ---- Following ---- */

struct fit {
    double mean;       /* centre error, pixels */
    double near;       /* part of the frames with an error of at most 8 pixels */
    double mean_scale; /* |log(scale / truth)| */
};

/* Tracks one round of the path. given: frames whose boxes are told. */
static struct fit follow(const ast_config *cfg, const struct ast_linalg *la, int given, double swell, int frames) {
    ast_tracker *t = tracker_new(cfg, la);
    struct fit fit = {0, 0, 0};
    ast_box boxes[AST_MAX_HISTORY + 5];
    struct ast_frame first[AST_MAX_HISTORY + 5];
    struct render takes[AST_MAX_HISTORY + 5];
    for (int f = 0; f < given; f++) {
        takes[f] = scene;
        takes[f].pixels = malloc((size_t)WIDTH * HEIGHT);
        TEST_ASSERT_NOT_NULL(takes[f].pixels);
        boxes[f] = render_path(&scene, f, 32, 26, 0.2, swell);
        first[f] = render_frame(&takes[f], &boxes[f]);
    }
    if (given == 1)
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_start(t, first, boxes));
    else
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_start_sequence(t, first, boxes, given));
    for (int f = 0; f < given; f++) free(takes[f].pixels);
    for (int f = given; f < frames; f++) {
        const ast_box box = render_path(&scene, f, 32, 26, 0.2, swell);
        const ast_frame frame = render_frame(&scene, &box);
        ast_result r;
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(t, &frame, &r));
        assert_sane(t, &r, &frame);
        fit.mean += box_distance(&r.box, &box) / (frames - given);
        fit.near += (box_distance(&r.box, &box) <= 8) / (double)(frames - given);
        fit.mean_scale += fabs(log((double)(r.box.w / box.w))) / (frames - given);
    }
    ast_free(t);
    return fit;
}

/* A mean error of at most so many pixels, for a target of 32 x 26. The distances live on fine differences, so a frame with a wrong
 * winner is no fault as long as the next ones are right. */
static void assert_follows(const struct fit *fit, double mean, const char *what) {
    char text[160];
    snprintf(text, sizeof text, "%s: mean error %.2f px, %.0f %% within 8 px, scale %.3f", what, fit->mean, 100 * fit->near,
             fit->mean_scale);
    if (getenv("AST_TEST_VERBOSE") != NULL) puts(text);
    TEST_ASSERT_TRUE_MESSAGE(fit->mean <= mean && fit->near >= 0.95, text);
}

static void test_every_preset_follows(void) {
    static const int presets[] = {AST_PRESET_PAPER, AST_PRESET_ROBUST, AST_PRESET_COMPACT, AST_PRESET_TINY};
    static const char *const names[] = {"paper", "robust", "compact", "tiny"};
    for (int p = 0; p < 4; p++) {
        for (int b = 0; b < BACKENDS; b++) {
            const ast_config cfg = preset(presets[p]);
            const struct fit fit = follow(&cfg, backends[b], 1, 1.0, WATCHED ? 20 : 60);
            assert_follows(&fit, 3.0, names[p]);
        }
    }
}

/* The paper's way in small sizes, with a guard: no background, so that every scoring, basis and model goes with it. */
static ast_config small_paper(void) {
    ast_config cfg = preset(AST_PRESET_PAPER);
    cfg.particles = 84;
    cfg.view = 48;
    cfg.view_object = 16;
    cfg.patch_width = 16;
    cfg.patch_height = 16;
    cfg.bag_size = 5;
    cfg.bag_interval = 10;
    cfg.alpha = 2.0f;
    cfg.keep_first = AST_YES;
    cfg.guard = 0.6f;
    cfg.lost_after = 2;
    return cfg;
}

static void test_literal_scoring_follows(void) {
    ast_config cfg = small_paper();
    cfg.scoring = AST_SCORING_LITERAL;
    for (int b = 0; b < BACKENDS; b++) {
        const struct fit fit = follow(&cfg, backends[b], 1, 1.0, 60);
        assert_follows(&fit, 3.0, "literal");
    }
}

static void test_both_initialisations_follow(void) {
    static const int given[] = {1, 2, 3, 4, 10};
    ast_config cfg = preset(AST_PRESET_TINY);
    cfg.particles = 300;
    for (size_t g = 0; g < sizeof given / sizeof given[0]; g++) {
        const struct fit fit = follow(&cfg, backends[0], given[g], 1.0, 70);
        assert_follows(&fit, 3.0, "boxes given");
    }
}

static void test_variants_follow(void) {
    ast_config cfg = small_paper();
    cfg.basis = AST_BASIS_RAW;
    struct fit fit = follow(&cfg, backends[0], 1, 1.0, 100);
    assert_follows(&fit, 3.0, "raw basis");
    cfg.model = AST_MODEL_LINEAR;
    fit = follow(&cfg, backends[0], 1, 1.0, 100);
    assert_follows(&fit, 4.0, "linear ablation");
    cfg = small_paper();
    cfg.normalisation = AST_NORMALISE_MEAN;
    fit = follow(&cfg, backends[0], 1, 1.0, 100);
    assert_follows(&fit, 3.0, "mean normalised");
    cfg.normalisation = AST_NORMALISE_NONE;
    fit = follow(&cfg, backends[0], 1, 1.0, 100);
    assert_follows(&fit, 3.0, "not normalised");
    cfg = small_paper();
    cfg.keep_first = AST_NO; /* a bag of one would never learn */
    cfg.history = 1;
    cfg.basis_size = 1;
    cfg.bag_size = 1;
    cfg.bag_interval = 1;
    fit = follow(&cfg, backends[0], 1, 1.0, 100);
    TEST_ASSERT_TRUE(fit.mean <= 6.0 && fit.near >= 0.9);
}

static void test_scale_is_followed(void) {
    ast_config cfg = preset(AST_PRESET_PAPER);
    cfg.walk_scale = 0.03f;
    const struct fit fit = follow(&cfg, backends[0], 1, 1.3, 100);
    assert_follows(&fit, 2.5, "growing and shrinking");
    TEST_ASSERT_TRUE(fit.mean_scale < 0.06);
}

/* The light fades by half and grows back; unit patches do not see it. */
static void test_light_does_not_matter(void) {
    const ast_config cfg = preset(AST_PRESET_TINY);
    ast_tracker *t = tracker_new(&cfg, backends[0]);
    double mean = 0;
    start(t);
    for (int f = 1; f < 100; f++) {
        scene.gain = 1.0 - 0.5 * sin(3.14159 * f / 100);
        scene.offset = 0.1 * sin(3.14159 * f / 50);
        const ast_result r = step(t, f);
        const ast_box box = truth(f);
        mean += box_distance(&r.box, &box) / 99;
    }
    TEST_ASSERT_TRUE(mean < 3.0);
    ast_free(t);
}

/* A score near one while the object is there, near nothing when it is not; the status follows with its hysteresis, and tracking
 * comes back with the object. */
static void test_status_tells_when_the_object_is_gone(void) {
    ast_config cfg = preset(AST_PRESET_PAPER); /* without a guard, which has its own ways: test_guard */
    cfg.walk_x = cfg.walk_y = 2.0f;
    cfg.particles = 200;
    ast_tracker *t = tracker_new(&cfg, backends[0]);
    const ast_box still = truth(0);
    ast_result r;
    start(t);
    for (int f = 1; f < 20; f++) {
        const ast_frame frame = render_frame(&scene, &still);
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(t, &frame, &r));
        TEST_ASSERT_EQUAL_INT(AST_TRACKING, r.status);
        TEST_ASSERT_TRUE(r.score > 0.8f);
    }
    memset(scene.pixels, 90, (size_t)WIDTH * HEIGHT);
    const ast_frame blank = {scene.pixels, WIDTH, HEIGHT, WIDTH};
    for (int f = 1; f <= cfg.lost_after + 1; f++) {
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(t, &blank, &r));
        TEST_ASSERT_TRUE(r.score < cfg.score_lost);
        TEST_ASSERT_EQUAL_INT(f < cfg.lost_after ? AST_UNCERTAIN : AST_LOST, r.status);
    }
    int back = 0;
    for (int f = 0; f < 15 && !back; f++) {
        const ast_frame frame = render_frame(&scene, &still);
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(t, &frame, &r));
        back = r.score >= cfg.score_uncertain;
        TEST_ASSERT_EQUAL_INT(back ? AST_TRACKING : AST_LOST, r.status);
    }
    TEST_ASSERT_TRUE(back);
    ast_free(t);
}

/* A full bag keeps what it knows of the object against a frame that is not like it, though the guard trusts the frame; one with
 * room left takes all that is trusted. */
static void test_a_full_bag_is_selective(void) {
    enum { BEFORE = 12, AFTER = 9 };
    static const float selective[] = {0.0f, 0.85f};
    const ast_box still = truth(0);
    for (int room = 0; room <= 1; room++) {
        for (int s = 0; s < 2; s++) {
            ast_config cfg = small_robust_config();
            cfg.guard = 0.6f;
            cfg.recall = 0.0f; /* nothing is refused */
            cfg.selective = selective[s];
            cfg.score_lost = 0.0f; /* whatever its score */
            if (room) cfg.bag_size = 30;
            ast_tracker *t = tracker_new(&cfg, backends[0]);
            start(t);
            for (int f = 1; f < BEFORE; f++) {
                const ast_frame frame = render_frame(&scene, &still);
                TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(t, &frame, NULL));
            }
            TEST_ASSERT_EQUAL_INT(!room, t->bag.count == t->bag.capacity);
            const size_t bytes = (size_t)t->bag.capacity * ((size_t)t->bag.n + 1) * (size_t)t->bag.stride * sizeof(float);
            const int32_t count = t->bag.count;
            float *known = malloc(bytes);
            TEST_ASSERT_NOT_NULL(known);
            memcpy(known, ast_bag_basis(&t->bag, 0), bytes);
            struct render other;
            render_open(&other, WIDTH, HEIGHT, 77);
            for (int f = 0; f < AFTER; f++) {
                ast_result r;
                const ast_frame frame = render_frame(&other, &still);
                TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(t, &frame, &r));
                TEST_ASSERT_TRUE(t->guard.low == 0); /* trusted */
            }
            const int kept = memcmp(known, ast_bag_basis(&t->bag, 0), bytes) == 0 && t->bag.count == count;
            TEST_ASSERT_EQUAL_INT(!room && s == 1, kept);
            render_close(&other);
            free(known);
            ast_free(t);
        }
    }
}

/* ---- The shortlist ---- */

/* The length of the shortlist where the bag had a model when the frame came, else all. */
static void test_the_shortlist_is_scored_once_there_is_a_bag(void) {
    static const int lengths[] = {0, 1, 7, AST_TILE, AST_TILE + 8, AST_MAX_PARTICLES};
    for (size_t l = 0; l < sizeof lengths / sizeof lengths[0]; l++) {
        ast_config cfg = small_robust_config();
        cfg.shortlist = lengths[l];
        ast_tracker *t = tracker_new(&cfg, backends[0]);
        int without = 0;
        start(t);
        for (int f = 1; f < 9; f++) {
            const int models = ast_bag_count(t), whole = models == 0 || lengths[l] == 0 || lengths[l] > cfg.particles;
            ast_particles p;
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(t, &p));
            TEST_ASSERT_TRUE(f > 1 || (p.scored == 0 && p.distance == NULL));
            const ast_result r = step(t, f);
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(t, &p));
            TEST_ASSERT_EQUAL_INT(cfg.particles, p.count);
            TEST_ASSERT_EQUAL_INT(whole ? cfg.particles : lengths[l], p.scored);
            assert_only_the_scored_weigh(&p, &r);
            without += models == 0;
        }
        TEST_ASSERT_TRUE(without > 0 && without < 8);
        ast_free(t);
    }
}

/* The shortlist holds the particles that go farthest along the direction, by an inner product with the head of each one's own
 * vector: its grey patch, or its gradients where it has none. */
static void test_the_shortlist_goes_by_each_particles_vector(void) {
    for (int patch = 0; patch <= 1; patch++) {
        ast_config cfg = small_robust_config();
        cfg.shortlist = 9;
        cfg.patch_weight = (float)patch;
        const int length = ast_features_glance_length(&cfg);
        ast_tracker *t = tracker_new(&cfg, backends[0]);
        float *vector = malloc((size_t)t->dim * sizeof *vector);
        TEST_ASSERT_NOT_NULL(vector);
        TEST_ASSERT_TRUE(patch ? length == cfg.patch_width * cfg.patch_height : length == t->dim);
        start(t);
        for (int f = 1; f < 12; f++) {
            const int models = ast_bag_count(t);
            ast_particles p;
            double last = INFINITY, first = -INFINITY, size = 0;
            (void)step(t, f);
            if (models == 0) continue;
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(t, &p));
            for (int d = 0; d < length; d++) size += (double)t->direction[d] * (double)t->direction[d];
            const double slack = 1e-5 * sqrt(size); /* vectors are about of length 1 */
            for (int i = 0; i < p.count; i++) {
                const float w = t->box_width * p.scale[i], h = t->box_height * p.scale[i];
                const ast_box box = {p.x[i] - 0.5f * w, p.y[i] - 0.5f * h, w, h}, window = ast_view_box(&t->view, &box);
                double along = 0;
                ast_features_vector(&t->features, &t->desk->features, &t->view.image, &window, vector);
                for (int d = 0; d < length; d++) along += (double)t->direction[d] * (double)vector[d];
                TEST_ASSERT_DOUBLE_WITHIN(slack, along, (double)t->promise[i]);
                if (i < p.scored)
                    last = fmin(last, along);
                else
                    first = fmax(first, along);
            }
            TEST_ASSERT_TRUE(last >= first - 2 * slack);
        }
        free(vector);
        ast_free(t);
    }
}

/* What the next shortlist goes by: each model's part in the winner's weight, from the distances of the step. */
static void test_each_model_has_its_say_in_the_winner(void) {
    ast_config cfg = small_robust_config();
    cfg.bag_size = 12; /* none is replaced */
    TEST_ASSERT_TRUE(cfg.likelihood == AST_LIKELIHOOD_SCALED && cfg.vote == AST_VOTE_CONTRAST);
    ast_tracker *t = tracker_new(&cfg, backends[0]);
    int most = 0;
    start(t);
    for (int f = 1; f < 16; f++) {
        const int models = ast_bag_count(t);
        const ast_result r = step(t, f);
        ast_particles p;
        double part[12], total = 0;
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(t, &p));
        for (int j = 0; j < models; j++) {
            double least = INFINITY, mean = 0, sum = 0;
            for (int i = 0; i < p.scored; i++) least = fmin(least, (double)p.distance[i * models + j]);
            for (int i = 0; i < p.scored; i++) mean += ((double)p.distance[i * models + j] - least) / p.scored;
            const double sigma = (double)cfg.sigma * mean;
            for (int i = 0; i < p.scored; i++) sum += exp((least - (double)p.distance[i * models + j]) / sigma);
            part[j] = mean * exp((least - (double)p.distance[r.best * models + j]) / sigma) / sum;
            total += part[j];
        }
        for (int j = 0; j < models; j++)
            TEST_ASSERT_DOUBLE_WITHIN(by_real(1e-5, 1e-3), part[j] / total, (double)t->bag.say[ast_bag_slot(&t->bag, j)]);
        for (int j = models; j < ast_bag_count(t); j++) TEST_ASSERT_TRUE(t->bag.say[ast_bag_slot(&t->bag, j)] == 0.0f);
        if (models > most) most = models;
    }
    TEST_ASSERT_TRUE(most > 3);
    ast_free(t);
}

/* With as many places as particles, or more, it is as if there were none. */
static void test_a_shortlist_of_all_changes_nothing(void) {
    for (int more = 0; more <= 5; more += 5) {
        ast_config cfg = small_robust_config();
        cfg.shortlist = 0;
        ast_tracker *plain = tracker_new(&cfg, backends[0]);
        cfg.shortlist = cfg.particles + more;
        ast_tracker *listed = tracker_new(&cfg, backends[0]);
        start(plain);
        start(listed);
        for (int f = 1; f < 14; f++) {
            const ast_result a = step(plain, f), b = step(listed, f);
            ast_particles p, q;
            TEST_ASSERT_EQUAL_MEMORY(&a, &b, sizeof a);
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(plain, &p));
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(listed, &q));
            TEST_ASSERT_TRUE(p.models == q.models && p.scored == q.scored);
            TEST_ASSERT_EQUAL_MEMORY(p.distance, q.distance, (size_t)(p.scored * p.models) * sizeof(float));
            TEST_ASSERT_EQUAL_MEMORY(p.weight, q.weight, (size_t)p.count * sizeof(float));
            TEST_ASSERT_EQUAL_MEMORY(p.x, q.x, (size_t)p.count * sizeof(float));
        }
        ast_free(plain);
        ast_free(listed);
    }
}

/* ---- The stages, from what may be looked at ---- */

/* The patch of a particle or a box, by a sampler that is not the tracker's. */
static void sample(const ast_config *cfg, const ast_frame *frame, const ast_box *box, float *patch) {
    static unsigned char block[65536];
    struct ast_sampler sampler;
    struct ast_arena arena = {ast_align(block), 0};
    ast_sampler_layout(&sampler, cfg, &arena);
    TEST_ASSERT_TRUE(arena.used + AST_ALIGNMENT <= sizeof block);
    ast_sampler_patch(&sampler, frame, box, patch);
}

static ast_box particle_box(const ast_particles *p, int i) {
    const float w = p->reference.w * p->scale[i], h = p->reference.h * p->scale[i];
    const ast_box box = {p->x[i] - 0.5f * w, p->y[i] - 0.5f * h, w, h};
    return box;
}

/* Before the bag has a model: alpha times the squared distance to the mean of the patches so far (1 instead of alpha without
 * means). */
static void test_distances_before_the_first_model(void) {
    for (int model = AST_MODEL_AFFINE; model <= AST_MODEL_LINEAR; model++) {
        ast_config cfg = small_config();
        float patch[64];
        cfg.model = model;
        cfg.basis = AST_BASIS_RAW;
        cfg.history = 6;
        ast_tracker *t = tracker_new(&cfg, backends[0]);
        start(t);
        for (int f = 1; f < 5; f++) {
            double mean[64] = {0};
            const int32_t count = ast_history_count(t);
            const float *known;
            TEST_ASSERT_EQUAL_INT(0, ast_bag_count(t));
            TEST_ASSERT_EQUAL_INT(f, count);
            for (int32_t j = 0; j < count; j++) {
                TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_history(t, j, &known));
                for (int d = 0; d < 64; d++) mean[d] += (double)known[d] / count;
            }
            (void)step(t, f);
            const ast_box box = truth(f);
            const ast_frame frame = render_frame(&scene, &box);
            ast_particles p;
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(t, &p));
            TEST_ASSERT_EQUAL_INT(1, p.models);
            for (int i = 0; i < p.count; i++) {
                const ast_box window = particle_box(&p, i);
                double square = 0;
                sample(&cfg, &frame, &window, patch);
                for (int d = 0; d < 64; d++) square += ((double)patch[d] - mean[d]) * ((double)patch[d] - mean[d]);
                const double expected = (model == AST_MODEL_AFFINE ? (double)cfg.alpha : 1) * square;
                TEST_ASSERT_DOUBLE_WITHIN(1e-4 * (1 + expected), expected, (double)p.distance[i]);
            }
        }
        ast_free(t);
    }
}

/* With models: every particle's distance to each of them, by the functions of the public geometry. */
static void assert_distances(const ast_config *cfg, const struct ast_linalg *la) {
    enum { DIM = 64, MOST = 8 };
    static float images[DIM * MOST], mean[MOST][DIM], basis[MOST][DIM * MOST], candidate_mean[DIM], candidate_basis[DIM * MOST];
    static unsigned char work[65536];
    ast_tracker *t = tracker_new(cfg, la);
    start(t);
    for (int f = 1; f <= 9; f++) {
        ast_subspace models[MOST], candidate;
        const int32_t count = ast_bag_count(t), patches = ast_history_count(t);
        const float *patch;
        for (int32_t m = 0; m < count; m++) {
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_model(t, m, &models[m]));
            memcpy(mean[m], models[m].mean, sizeof mean[m]);
            for (int l = 0; l < models[m].n; l++)
                memcpy(basis[m] + l * DIM, models[m].basis + l * models[m].stride, DIM * sizeof(float));
            models[m].mean = mean[m];
            models[m].basis = basis[m];
            models[m].stride = DIM;
        }
        for (int32_t j = 0; j < patches; j++) {
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_history(t, j, &patch));
            memcpy(images + j * DIM, patch, DIM * sizeof(float));
        }
        /* The columns of distance are the bag's slots: once it is full, the oldest model is at slot (added - k) mod k. */
        ast_bag_count(t);
        const int oldest = t->bag.oldest;
        (void)step(t, f);
        if (count == 0) continue;
        const ast_box box = truth(f);
        const ast_frame frame = render_frame(&scene, &box);
        ast_particles p;
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(t, &p));
        for (int i = 0; i < p.count; i++) {
            const ast_box window = particle_box(&p, i);
            ast_distance d;
            sample(cfg, &frame, &window, images + patches * DIM);
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_subspace_fit(images, DIM, DIM, patches + 1, cfg->basis, cfg->basis_size,
                                                           candidate_mean, candidate_basis, &candidate, work, sizeof work));
            for (int32_t m = 0; m < count; m++) {
                const int column = (oldest + m) % count;
                TEST_ASSERT_EQUAL_INT(AST_OK, ast_subspace_distance(&candidate, &models[m], cfg->alpha, &d, work, sizeof work));
                const float expected = cfg->model == AST_MODEL_AFFINE ? d.distance : d.geodesic;
                TEST_ASSERT_FLOAT_WITHIN(1e-3f, expected, p.distance[i * p.models + column]);
            }
        }
    }
    ast_free(t);
}

static void test_distances_are_those_of_the_geometry(void) {
    for (int b = 0; b < BACKENDS; b++) {
        for (int scoring = AST_SCORING_GRAM; scoring <= AST_SCORING_LITERAL; scoring++) {
            ast_config cfg = small_config();
            cfg.scoring = scoring;
            assert_distances(&cfg, backends[b]);
            cfg.basis = AST_BASIS_RAW;
            assert_distances(&cfg, backends[b]);
            cfg.model = AST_MODEL_LINEAR;
            assert_distances(&cfg, backends[b]);
        }
    }
}

/* The history: a ring of the last P winners' patches, oldest first. */
static void test_history_holds_the_last_winners(void) {
    ast_config cfg = small_config();
    float expected[64][64];
    const float *patch;
    cfg.history = 4;
    ast_tracker *t = tracker_new(&cfg, backends[0]);
    ast_box box = truth(0);
    ast_frame frame = render_frame(&scene, &box);
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_start(t, &frame, &box));
    sample(&cfg, &frame, &box, expected[0]);
    for (int f = 1; f < 12; f++) {
        const ast_result r = step(t, f);
        box = truth(f);
        frame = render_frame(&scene, &box);
        sample(&cfg, &frame, &r.box, expected[f]);
        const int count = f + 1 < cfg.history ? f + 1 : cfg.history;
        TEST_ASSERT_EQUAL_INT(count, ast_history_count(t));
        for (int j = 0; j < count; j++) {
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_history(t, j, &patch));
            for (int d = 0; d < 64; d++) TEST_ASSERT_FLOAT_WITHIN(1e-5f, expected[f + 1 - count + j][d], patch[d]);
        }
    }
    ast_free(t);
}

/* The bag: empty until P patches are known, then a model every W frames, the oldest replaced when it is full. A model's mean is
 * that of the winner's image set: the history before the step, and the winner. */
static void test_bag_takes_a_model_every_w_frames(void) {
    static const int intervals[] = {1, 2, 3, 5};
    for (size_t w = 0; w < sizeof intervals / sizeof intervals[0]; w++) {
        ast_config cfg = small_config();
        cfg.bag_interval = intervals[w];
        ast_tracker *t = tracker_new(&cfg, backends[0]);
        int expected = 0, last_model = 0;
        start(t);
        for (int f = 1; f <= 24; f++) {
            double mean[64] = {0};
            float before[8][64];
            const int32_t known = ast_history_count(t), held = ast_bag_count(t);
            const float *patch;
            ast_subspace s;
            for (int32_t j = 0; j < known; j++) {
                TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_history(t, j, &patch));
                for (int d = 0; d < 64; d++) mean[d] += (double)patch[d] / (known + 1);
            }
            for (int32_t m = 0; m < held; m++) {
                TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_model(t, m, &s));
                memcpy(before[m], s.mean, sizeof before[m]);
            }
            (void)step(t, f);
            /* the first model when the start and f steps make P patches, then every W frames */
            const int due = f == cfg.history - 1 || (last_model > 0 && f == last_model + cfg.bag_interval);
            if (due) {
                last_model = f;
                expected = expected < cfg.bag_size ? expected + 1 : expected;
            }
            TEST_ASSERT_EQUAL_INT(expected, ast_bag_count(t));
            const int dropped = due && held == cfg.bag_size;
            for (int m = 0; m < held - dropped; m++) {
                TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_model(t, m, &s));
                TEST_ASSERT_EQUAL_MEMORY(before[m + dropped], s.mean, sizeof before[m]);
            }
            if (!due) continue;
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_history(t, ast_history_count(t) - 1, &patch));
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_model(t, expected - 1, &s));
            for (int d = 0; d < 64; d++)
                TEST_ASSERT_FLOAT_WITHIN(1e-5f, (float)(mean[d] + (double)patch[d] / (known + 1)), s.mean[d]);
        }
        TEST_ASSERT_EQUAL_INT(24, (int)t->frame);
        ast_free(t);
    }
}

/* With keep_first the bag's first model stays, and the oldest of the others goes. */
static void test_first_model_can_be_kept(void) {
    ast_config cfg = small_config();
    cfg.keep_first = AST_YES;
    cfg.bag_interval = 1;
    ast_tracker *t = tracker_new(&cfg, backends[0]);
    float first[64], before[3][64];
    ast_subspace s;
    start(t);
    for (int f = 1; f < 20; f++) {
        const int32_t held = ast_bag_count(t);
        int kept = 0, same = 0;
        for (int32_t m = 0; m < held; m++) {
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_model(t, m, &s));
            memcpy(before[m], s.mean, sizeof before[m]);
        }
        if (held == 1) memcpy(first, before[0], sizeof first);
        (void)step(t, f);
        if (held == 0) continue;
        for (int32_t m = 0; m < ast_bag_count(t); m++) {
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_model(t, m, &s));
            kept += memcmp(first, s.mean, sizeof first) == 0;
            for (int32_t o = 0; o < held; o++) same += memcmp(before[o], s.mean, sizeof before[o]) == 0;
        }
        TEST_ASSERT_EQUAL_INT(1, kept);
        TEST_ASSERT_EQUAL_INT(held < cfg.bag_size ? held : held - 1, same);
    }
    ast_free(t);
}

/* The incumbent: one particle at the last estimate, unmoved. */
static void test_incumbent_stays(void) {
    ast_config cfg = small_config();
    for (int incumbent = AST_NO; incumbent <= AST_YES; incumbent++) {
        cfg.incumbent = incumbent;
        ast_tracker *t = tracker_new(&cfg, backends[0]);
        int seen = 0;
        start(t);
        for (int f = 1; f < 10; f++) {
            ast_particles p;
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(t, &p));
            const ast_box last = p.reference;
            (void)step(t, f);
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(t, &p));
            for (int i = 0; i < p.count; i++) seen += p.x[i] == last.x && p.y[i] == last.y;
        }
        TEST_ASSERT_EQUAL_INT(incumbent ? 9 : 0, seen);
        ast_free(t);
    }
}

/* Without a walk, particles move by the velocity's share of the smoothed motion of the estimate: v <- (v + step) / 2. */
static void test_velocity_moves_the_cloud(void) {
    ast_config cfg = small_config();
    cfg.velocity = 0.5f;
    ast_tracker *t = tracker_new(&cfg, backends[0]);
    ast_particles p;
    float x = 0, y = 0; /* velocity */
    start(t);
    for (int f = 1; f < 12; f++) {
        ast_random_seed(&t->random, (uint64_t)f); /* so that the control below draws the same */
        struct saved saved = saved_from(t);
        ast_tracker *control = tracker_new(&cfg, backends[0]);
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_restore(control, saved.bytes, saved.size));
        control->cfg.velocity = 0.0f;
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(t, &p));
        const ast_box last = p.reference;
        (void)step(t, f);
        (void)step(control, f);
        for (int i = 0; i < cfg.particles; i++) {
            TEST_ASSERT_FLOAT_WITHIN(1e-3f, control->cloud.x[i] + 0.5f * x, t->cloud.x[i]);
            TEST_ASSERT_FLOAT_WITHIN(1e-3f, control->cloud.y[i] + 0.5f * y, t->cloud.y[i]);
        }
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(t, &p));
        x = 0.5f * (x + p.reference.x - last.x);
        y = 0.5f * (y + p.reference.y - last.y);
        saved_free(&saved);
        ast_free(control);
    }
    ast_free(t);
}

/* ---- Starting ---- */

static void test_start_sequence_takes_the_last_boxes(void) {
    enum { GIVEN = 5 };
    ast_config cfg = small_config();
    struct render takes[GIVEN];
    ast_frame frames[GIVEN];
    ast_box boxes[GIVEN];
    float expected[64];
    const float *patch;
    for (int f = 0; f < GIVEN; f++) {
        render_open(&takes[f], 100 - f, 80 + f, (uint64_t)f);
        boxes[f].x = 30.0f + (float)f;
        boxes[f].y = 20.0f;
        boxes[f].w = 20.0f * (1.0f + 0.1f * (float)f);
        boxes[f].h = 16.0f * (1.0f + 0.05f * (float)f);
        frames[f] = render_frame(&takes[f], &boxes[f]);
    }
    ast_tracker *t = tracker_new(&cfg, backends[0]);
    for (int given = 1; given <= GIVEN; given++) {
        const int used = given < cfg.history ? given : cfg.history;
        const ast_box *last = &boxes[given - 1];
        ast_particles p;
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_start_sequence(t, frames, boxes, given));
        TEST_ASSERT_EQUAL_INT(used, ast_history_count(t));
        TEST_ASSERT_EQUAL_INT(used == cfg.history, ast_bag_count(t));
        for (int j = 0; j < used; j++) {
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_history(t, j, &patch));
            sample(&cfg, &frames[given - used + j], &boxes[given - used + j], expected);
            TEST_ASSERT_EQUAL_MEMORY(expected, patch, sizeof expected);
        }
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(t, &p));
        TEST_ASSERT_TRUE(p.reference.w == 20.0f && p.reference.h == 16.0f);
        TEST_ASSERT_FLOAT_WITHIN(1e-4f, last->x + 0.5f * last->w, p.reference.x);
        TEST_ASSERT_FLOAT_WITHIN(1e-4f, last->y + 0.5f * last->h, p.reference.y);
        TEST_ASSERT_FLOAT_WITHIN(1e-4f, sqrtf(last->w * last->h / (20.0f * 16.0f)), p.scale[0]);
    }
    ast_free(t);
    for (int f = 0; f < GIVEN; f++) render_close(&takes[f]);
}

/* The scale that the last box asks for is brought within its limits. */
static void test_start_sequence_clamps_the_scale(void) {
    ast_config cfg = small_config();
    cfg.scale_min = 0.5f;
    cfg.scale_max = 2.0f;
    ast_tracker *t = tracker_new(&cfg, backends[0]);
    const ast_frame frame = render_frame(&scene, NULL), frames[2] = {frame, frame};
    ast_particles p;
    ast_box boxes[2] = {{50, 50, 10, 10}, {20, 20, 90, 90}};
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_start_sequence(t, frames, boxes, 2));
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(t, &p));
    TEST_ASSERT_TRUE(p.scale[0] == 2.0f);
    boxes[0].w = boxes[0].h = 90.0f;
    boxes[1].w = boxes[1].h = 10.0f;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_start_sequence(t, frames, boxes, 2));
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(t, &p));
    TEST_ASSERT_TRUE(p.scale[0] == 0.5f);
    ast_free(t);
}

/* ---- Repeating ---- */

/* Starts with as many boxes as the history wants, so that a model is made and the backend is needed; larger: pixels by which the
 * boxes are larger than the object. */
static int start_with_model(ast_tracker *t, int history, float larger) {
    const ast_box box = truth(0);
    const ast_frame frame = render_frame(&scene, &box);
    ast_frame frames[AST_MAX_HISTORY];
    ast_box boxes[AST_MAX_HISTORY];
    for (int j = 0; j < history; j++) {
        frames[j] = frame;
        boxes[j] = box;
        boxes[j].x += 0.5f * (float)(history - 1 - j);
        boxes[j].w += larger;
        boxes[j].h += larger;
    }
    return ast_start_sequence(t, frames, boxes, history);
}

/* A start in the middle of a bad run is as good as the first: the same state to the last bit. */
static void test_start_forgets_everything(void) {
    for (int which = 0; which < VARIANTS; which++) {
        const ast_config cfg = variant(which);
        for (int boxes = 1; boxes <= cfg.history; boxes += cfg.history - 1) {
            ast_tracker *t = tracker_new(&cfg, backends[0]), *fresh = tracker_new(&cfg, backends[0]);
            start(t);
            for (int f = 1; f < 20; f++) {
                const ast_box box = truth(f);
                const ast_frame frame = render_frame(&scene, f < 12 ? &box : NULL);
                if (f % 2 == 0 && f >= 12) memset(scene.pixels, 40, (size_t)WIDTH * HEIGHT);
                TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(t, &frame, NULL));
            }
            TEST_ASSERT_EQUAL_INT(AST_OK, start_with_model(t, boxes, 0.0f));
            TEST_ASSERT_EQUAL_INT(AST_OK, start_with_model(fresh, boxes, 0.0f));
            struct saved saved = saved_from(fresh);
            saved_check(&saved, t, "started again");
            saved_free(&saved);
            ast_free(t);
            ast_free(fresh);
        }
    }
}

static void run(ast_tracker *t, int steps, ast_result *results) {
    start(t);
    for (int f = 1; f <= steps; f++) results[f - 1] = step(t, f);
}

static void test_same_seed_same_bits(void) {
    enum { STEPS = 15 };
    ast_result first[STEPS], second[STEPS];
    for (int b = 0; b < BACKENDS; b++) {
        for (int which = 0; which < VARIANTS; which++) {
            const ast_config cfg = variant(which);
            ast_tracker *t = tracker_new(&cfg, backends[b]), *other = tracker_new(&cfg, backends[b]);
            run(t, STEPS, first);
            run(other, STEPS, second);
            TEST_ASSERT_EQUAL_MEMORY(first, second, sizeof first);
            struct saved saved = saved_from(t);
            saved_check(&saved, other, "another tracker");
            run(t, STEPS, second); /* a new start forgets what was */
            TEST_ASSERT_EQUAL_MEMORY(first, second, sizeof first);
            saved_check(&saved, t, "another start");
            saved_free(&saved);
            ast_free(t);
            ast_free(other);
        }
    }
}

static void test_other_seeds_other_clouds(void) {
    static const uint64_t seeds[] = {0, 1, 2, UINT64_C(1) << 32, UINT64_C(1) << 63, UINT64_MAX};
    enum { SEEDS = sizeof seeds / sizeof seeds[0] };
    ast_result results[SEEDS];
    for (int s = 0; s < SEEDS; s++) {
        ast_config cfg = small_config_of(s % SMALL_CONFIGS);
        cfg.seed = seeds[s];
        cfg.incumbent = AST_NO;
        ast_tracker *t = tracker_new(&cfg, backends[0]);
        run(t, 1, &results[s]);
        for (int earlier = 0; earlier < s; earlier++) TEST_ASSERT_TRUE(results[earlier].box.x != results[s].box.x);
        ast_free(t);
    }
}

static void test_result_is_optional(void) {
    const ast_config cfg = small_config();
    ast_tracker *t = tracker_new(&cfg, backends[0]), *other = tracker_new(&cfg, backends[0]);
    start(t);
    start(other);
    for (int f = 1; f < 6; f++) {
        const ast_box box = truth(f);
        const ast_frame frame = render_frame(&scene, &box);
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(t, &frame, NULL));
        (void)step(other, f);
    }
    struct saved saved = saved_from(t);
    saved_check(&saved, other, "with a result");
    saved_free(&saved);
    ast_free(t);
    ast_free(other);
}

/* The padding of the rows is nothing to the tracker. */
static void test_stride_does_not_matter(void) {
    enum { STRIDE = WIDTH + 29 };
    const ast_config cfg = small_config();
    ast_tracker *t = tracker_new(&cfg, backends[0]), *other = tracker_new(&cfg, backends[0]);
    uint8_t *padded = malloc((size_t)STRIDE * HEIGHT);
    TEST_ASSERT_NOT_NULL(padded);
    for (int f = 0; f < 8; f++) {
        const ast_box box = truth(f);
        const ast_frame frame = render_frame(&scene, &box), wide = {padded, WIDTH, HEIGHT, STRIDE};
        memset(padded, 37 * f, (size_t)STRIDE * HEIGHT);
        for (int y = 0; y < HEIGHT; y++) memcpy(padded + (size_t)y * STRIDE, frame.pixels + (size_t)y * WIDTH, WIDTH);
        if (f == 0) {
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_start(t, &frame, &box));
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_start(other, &wide, &box));
        } else {
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(t, &frame, NULL));
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(other, &wide, NULL));
        }
    }
    struct saved saved = saved_from(t);
    saved_check(&saved, other, "padded rows");
    saved_free(&saved);
    free(padded);
    ast_free(t);
    ast_free(other);
}

/* ---- What no tracker can follow ---- */

static void test_flat_and_frozen_frames(void) {
    static const int fills[] = {0, 255, 128, -1}; /* -1: one textured picture again and again */
    for (int b = 0; b < BACKENDS; b++) {
        for (int which = 0; which < VARIANTS; which++) {
            const ast_config cfg = variant(which);
            ast_tracker *t = tracker_new(&cfg, backends[b]);
            for (size_t k = 0; k < sizeof fills / sizeof fills[0]; k++) {
                const ast_box box = truth(0);
                const ast_frame frame = render_frame(&scene, &box);
                if (fills[k] >= 0) memset(scene.pixels, fills[k], (size_t)WIDTH * HEIGHT);
                TEST_ASSERT_EQUAL_INT(AST_OK, ast_start(t, &frame, &box));
                for (int f = 0; f < 10; f++) {
                    ast_result r;
                    TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(t, &frame, &r));
                    assert_sane(t, &r, &frame);
                }
            }
            ast_free(t);
        }
    }
}

/* From one picture to another without warning: textures, black, white and noise in turn. */
static void test_frames_that_change_at_once(void) {
    struct noise noise = {6};
    for (int which = 0; which < VARIANTS; which++) {
        const ast_config cfg = variant(which);
        ast_tracker *t = tracker_new(&cfg, backends[0]);
        start(t);
        for (int f = 1; f < 24; f++) {
            const ast_box box = truth(f);
            const ast_frame frame = render_frame(&scene, f % 2 == 0 ? &box : NULL);
            ast_result r;
            if (f % 4 == 1) memset(scene.pixels, f % 8 == 1 ? 0 : 255, (size_t)WIDTH * HEIGHT);
            if (f % 4 == 3)
                for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) scene.pixels[i] = (uint8_t)noise_bits(&noise);
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(t, &frame, &r));
            assert_sane(t, &r, &frame);
        }
        ast_free(t);
    }
}

static void test_frame_of_one_pixel(void) {
    static const uint8_t grey[1] = {200};
    const ast_frame dot = {grey, 1, 1, 1};
    const ast_box box = {0, 0, 1, 1};
    for (int which = 0; which < VARIANTS; which++) {
        const ast_config cfg = variant(which);
        ast_tracker *t = tracker_new(&cfg, backends[0]);
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_start(t, &dot, &box));
        for (int f = 0; f < 8; f++) {
            ast_result r;
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(t, &dot, &r));
            assert_sane(t, &r, &dot);
        }
        ast_free(t);
    }
}

/* The frame becomes smaller and larger on the way: the state stays in pixels, the object is followed wherever it is in view, and
 * the cloud is inside the frame of the moment. */
static void change_frame_size(const ast_config *cfg) {
    ast_tracker *t = tracker_new(cfg, backends[0]);
    ast_result r;
    start(t);
    for (int f = 1; f < 30; f++) {
        const ast_box box = truth(f);
        ast_frame frame = render_frame(&scene, &box);
        if (f % 3 == 1) frame.width = WIDTH - 20, frame.height = HEIGHT - 10; /* cut off on the right and below */
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(t, &frame, &r));
        assert_sane(t, &r, &frame);
        TEST_ASSERT_TRUE(box_distance(&r.box, &box) < 8);
    }
    /* a frame in which the object is not: the cloud is brought in, and found again where the object is */
    ast_frame corner = {scene.pixels, 20, 15, WIDTH};
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(t, &corner, &r));
    assert_sane(t, &r, &corner);
    TEST_ASSERT_TRUE(r.box.x + 0.5f * r.box.w <= 20.0f && r.box.y + 0.5f * r.box.h <= 15.0f);
    const ast_frame dot = {scene.pixels, 1, 1, 1};
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(t, &dot, &r));
    assert_sane(t, &r, &dot);
    ast_free(t);
}

static void test_frame_size_may_change(void) {
    static const int presets[] = {AST_PRESET_TINY, AST_PRESET_ROBUST};
    for (size_t p = 0; p < sizeof presets / sizeof presets[0]; p++) {
        const ast_config cfg = preset(presets[p]);
        change_frame_size(&cfg);
    }
}

static void test_scale_stays_within_its_limits(void) {
    ast_config cfg = small_config();
    int at_least = 0, at_most = 0;
    cfg.walk_scale = 1.0f;
    cfg.scale_min = 0.8f;
    cfg.scale_max = 1.1f;
    ast_tracker *t = tracker_new(&cfg, backends[0]);
    start(t);
    for (int f = 1; f < 30; f++) {
        ast_particles p;
        const ast_result r = step(t, f);
        TEST_ASSERT_TRUE(r.scale >= 0.8f && r.scale <= 1.1f);
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(t, &p));
        for (int i = 0; i < p.count; i++) at_least += p.scale[i] == 0.8f, at_most += p.scale[i] == 1.1f;
    }
    TEST_ASSERT_TRUE(at_least > 100 && at_most > 100);
    ast_free(t);

    cfg.scale_min = cfg.scale_max = 1.0f;
    t = tracker_new(&cfg, backends[0]);
    start(t);
    for (int f = 1; f < 10; f++) TEST_ASSERT_TRUE(step(t, f).scale == 1.0f);
    ast_free(t);
}

/* Boxes that reach beyond the frame, up to the largest, and the largest walks. */
static void test_extreme_boxes_and_walks(void) {
    static const ast_box boxes[] = {
        {-31, -25, 32, 26}, {159, 119, 32, 26}, {80, 60, 1, 1}, {-40000, -50000, 65535, 65535}, {0, 60, 65535, 1}};
    for (int which = 0; which < VARIANTS; which++) {
        ast_config cfg = variant(which);
        cfg.walk_x = cfg.walk_y = 1000.0f;
        cfg.walk_scale = 1.0f;
        cfg.scale_min = 0.01f;
        cfg.scale_max = 100.0f;
        cfg.alpha = 1e6f;
        cfg.sigma = which % 2 ? 1e-6f : 1e6f;
        ast_tracker *t = tracker_new(&cfg, backends[0]);
        for (size_t k = 0; k < sizeof boxes / sizeof boxes[0]; k++) {
            const ast_frame frame = render_frame(&scene, NULL);
            TEST_ASSERT_EQUAL_INT(AST_OK, ast_start(t, &frame, &boxes[k]));
            for (int f = 0; f < 8; f++) {
                ast_result r;
                TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(t, &frame, &r));
                assert_sane(t, &r, &frame);
            }
        }
        ast_free(t);
    }
}

/* ---- Failing ---- */

/* The calls that fail, one after the other on one tracker, with what each returns. */
static void test_failed_calls_change_nothing(void) {
    const ast_config cfg = small_config();
    ast_config longer = cfg;
    longer.history++;
    longer.bag_size = 7;
    ast_tracker *t = tracker_new(&cfg, backends[0]), *control = tracker_new(&cfg, backends[0]);
    ast_tracker *foreign = tracker_new(&longer, backends[0]);
    start(t);
    start(control);
    start(foreign);
    for (int f = 1; f < 6; f++) {
        (void)step(t, f);
        (void)step(control, f);
    }
    const ast_box box = truth(6);
    const ast_frame good = render_frame(&scene, &box);
    const ast_frame none = {NULL, WIDTH, HEIGHT, WIDTH}, empty = {good.pixels, 0, HEIGHT, WIDTH},
                    narrow = {good.pixels, WIDTH, HEIGHT, WIDTH - 1};
    const ast_box outside = {200, 10, 20, 20}, thin = {10, 10, 0.5f, 20}, nowhere = {NAN, 10, 20, 20},
                  endless = {10, 10, INFINITY, 20};
    const ast_frame second_bad[2] = {good, narrow}, both_good[2] = {good, good};
    const ast_box second_outside[2] = {box, outside}, both[2] = {box, box};
    struct saved before = saved_from(t), other = saved_from(foreign);
    struct saved damaged = saved_from(t);
    damaged.bytes[damaged.size / 3] ^= 4;
    ast_result result, mark;
    ast_subspace model;
    const float *patch;
    unsigned char small[16];
    memset(&mark, 0x5a, sizeof mark);
    result = mark;

#define FAILS(code, call)                                                                                                          \
    do {                                                                                                                           \
        TEST_ASSERT_EQUAL_INT_MESSAGE(code, call, #call);                                                                          \
        saved_check(&before, t, #call);                                                                                            \
        TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&mark, &result, sizeof mark, #call);                                                      \
    } while (0)
    FAILS(AST_E_NULL, ast_step(NULL, &good, &result));
    FAILS(AST_E_NULL, ast_step(t, NULL, &result));
    FAILS(AST_E_NULL, ast_step(t, &none, &result));
    FAILS(AST_E_FRAME, ast_step(t, &empty, &result));
    FAILS(AST_E_FRAME, ast_step(t, &narrow, &result));
    FAILS(AST_E_NULL, ast_start(NULL, &good, &box));
    FAILS(AST_E_NULL, ast_start(t, NULL, &box));
    FAILS(AST_E_NULL, ast_start(t, &good, NULL));
    FAILS(AST_E_NULL, ast_start(t, &none, &box));
    FAILS(AST_E_FRAME, ast_start(t, &empty, &box));
    FAILS(AST_E_FRAME, ast_start(t, &narrow, &box));
    FAILS(AST_E_BOX, ast_start(t, &good, &outside));
    FAILS(AST_E_BOX, ast_start(t, &good, &thin));
    FAILS(AST_E_BOX, ast_start(t, &good, &nowhere));
    FAILS(AST_E_BOX, ast_start(t, &good, &endless));
    FAILS(AST_E_NULL, ast_start_sequence(NULL, both_good, both, 2));
    FAILS(AST_E_NULL, ast_start_sequence(t, NULL, both, 2));
    FAILS(AST_E_NULL, ast_start_sequence(t, both_good, NULL, 2));
    FAILS(AST_E_RANGE, ast_start_sequence(t, both_good, both, 0));
    FAILS(AST_E_RANGE, ast_start_sequence(t, both_good, both, -1));
    FAILS(AST_E_FRAME, ast_start_sequence(t, second_bad, both, 2));
    FAILS(AST_E_BOX, ast_start_sequence(t, both_good, second_outside, 2));
    FAILS(AST_E_BUFFER, ast_save(t, small, sizeof small));
    FAILS(AST_E_NULL, ast_save(t, NULL, before.size));
    FAILS(AST_E_NULL, ast_restore(t, NULL, before.size));
    FAILS(AST_E_CORRUPT, ast_restore(t, damaged.bytes, damaged.size));
    FAILS(AST_E_CORRUPT, ast_restore(t, before.bytes, before.size - 1));
    FAILS(AST_E_MISMATCH, ast_restore(t, other.bytes, other.size));
    FAILS(AST_E_RANGE, ast_get_model(t, 99, &model));
    FAILS(AST_E_RANGE, ast_get_history(t, -1, &patch));
    FAILS(AST_E_NULL, ast_get_particles(t, NULL));
#undef FAILS

    for (int f = 6; f < 12; f++) {
        const ast_result a = step(t, f), b = step(control, f);
        TEST_ASSERT_EQUAL_MEMORY(&b, &a, sizeof a);
    }
    saved_free(&before);
    saved_free(&other);
    saved_free(&damaged);
    ast_free(t);
    ast_free(control);
    ast_free(foreign);
}

static void test_step_before_start(void) {
    const ast_config cfg = small_config();
    ast_tracker *t = tracker_new(&cfg, backends[0]);
    const ast_frame frame = render_frame(&scene, NULL);
    const ast_box outside = {500, 500, 10, 10};
    ast_result result, mark;
    memset(&mark, 0x5a, sizeof mark);
    result = mark;
    TEST_ASSERT_EQUAL_INT(AST_E_NOT_STARTED, ast_step(t, &frame, &result));
    TEST_ASSERT_EQUAL_INT(AST_E_BOX, ast_start(t, &frame, &outside));
    TEST_ASSERT_EQUAL_INT(AST_E_NOT_STARTED, ast_step(t, &frame, &result)); /* a failed start is none */
    TEST_ASSERT_EQUAL_MEMORY(&mark, &result, sizeof mark);
    ast_free(t);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_every_preset_follows);
    RUN_TEST(test_literal_scoring_follows);
    RUN_TEST(test_both_initialisations_follow);
    RUN_TEST(test_variants_follow);
    RUN_TEST(test_scale_is_followed);
    RUN_TEST(test_light_does_not_matter);
    RUN_TEST(test_status_tells_when_the_object_is_gone);
    RUN_TEST(test_a_full_bag_is_selective);
    RUN_TEST(test_the_shortlist_is_scored_once_there_is_a_bag);
    RUN_TEST(test_the_shortlist_goes_by_each_particles_vector);
    RUN_TEST(test_each_model_has_its_say_in_the_winner);
    RUN_TEST(test_a_shortlist_of_all_changes_nothing);
    RUN_TEST(test_distances_before_the_first_model);
    RUN_TEST(test_distances_are_those_of_the_geometry);
    RUN_TEST(test_history_holds_the_last_winners);
    RUN_TEST(test_bag_takes_a_model_every_w_frames);
    RUN_TEST(test_first_model_can_be_kept);
    RUN_TEST(test_incumbent_stays);
    RUN_TEST(test_velocity_moves_the_cloud);
    RUN_TEST(test_start_sequence_takes_the_last_boxes);
    RUN_TEST(test_start_sequence_clamps_the_scale);
    RUN_TEST(test_start_forgets_everything);
    RUN_TEST(test_same_seed_same_bits);
    RUN_TEST(test_other_seeds_other_clouds);
    RUN_TEST(test_result_is_optional);
    RUN_TEST(test_stride_does_not_matter);
    RUN_TEST(test_flat_and_frozen_frames);
    RUN_TEST(test_frames_that_change_at_once);
    RUN_TEST(test_frame_of_one_pixel);
    RUN_TEST(test_frame_size_may_change);
    RUN_TEST(test_scale_stays_within_its_limits);
    RUN_TEST(test_extreme_boxes_and_walks);
    RUN_TEST(test_failed_calls_change_nothing);
    RUN_TEST(test_step_before_start);
    return UNITY_END();
}
