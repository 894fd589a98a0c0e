/* The life of a tracker, and the order of the stages: particles, patches, subspaces, distance, decision, history and bag. */
#include "tracker.h"

#include <string.h>
#ifndef AST_NO_HEAP
#include <stdlib.h>
#endif

#include "backend.h"
#include "frame.h"
#include "product.h"
#include "shortlist.h"
#include "subspace.h"

/* ---- Memory ---- */

/* What AST_MEM_SIZE counts on. */
typedef char ast_tracker_within_bound[sizeof(struct ast_tracker) <= AST_MEM_TRACKER_ ? 1 : -1];
typedef char ast_desk_within_bound[sizeof(struct ast_desk) <= AST_MEM_DESK_ ? 1 : -1];

static void cloud_layout(struct ast_cloud *cloud, int count, struct ast_arena *arena) {
    cloud->count = count;
    cloud->x = ast_arena_take(arena, (size_t)count, sizeof *cloud->x);
    cloud->y = ast_arena_take(arena, (size_t)count, sizeof *cloud->y);
    cloud->scale = ast_arena_take(arena, (size_t)count, sizeof *cloud->scale);
    cloud->weight = ast_arena_take(arena, (size_t)count, sizeof *cloud->weight);
}

/* tile: vectors. While the arena counts there is no desk, and what is handed out goes nowhere. */
static void desk_layout(struct ast_desk *desk, const struct ast_tracker *t, size_t tile, struct ast_arena *arena) {
    struct ast_desk counted;
    struct ast_desk *d = desk != NULL ? desk : &counted;
    memset(d, 0, sizeof *d);
    ast_features_scratch_layout(&d->features, &t->cfg, arena);
    t->scoring->tile_layout(&d->scoring, &t->cfg, t->la, t->dim, arena);
    d->tile = ast_arena_take(arena, (size_t)t->stride * tile, sizeof *d->tile);
    d->work = ast_arena_take(arena, t->work_count, sizeof *d->work);
}

/* Floats from one vector to the next. Vectors a power of two apart would meet in the same few lines of a cache when a product reads
 * many of them side by side: a line more, and they do not. */
static int stride_of(int dim) {
    enum { LINE = AST_ALIGNMENT / sizeof(float), CROWDED = 512 };
    const int stride = (dim + LINE - 1) / LINE * LINE;
    return stride % CROWDED == 0 ? stride + LINE : stride;
}

/* Fills *t and hands out the arena; the caller has taken the tracker itself. Runs once to count and once to bind. */
static void layout(struct ast_tracker *t, const ast_config *cfg, const struct ast_linalg *la, struct ast_arena *arena) {
    memset(t, 0, sizeof *t);
    memcpy(&t->cfg, cfg, sizeof t->cfg); /* with its padding */
    t->la = la;
    t->kernels = ast_kernels();
    t->scoring = ast_scoring_of(cfg);
    t->dim = ast_features_length(cfg);
    t->stride = stride_of(t->dim);

    const size_t stride = (size_t)t->stride;
    cloud_layout(&t->cloud, cfg->particles, arena);
    ast_history_layout(&t->history, t->dim, t->stride, cfg->history, arena);
    ast_bag_layout(&t->bag, t->dim, t->stride, t->scoring->lead(cfg), cfg->basis_size, cfg->bag_size, cfg->keep_first, arena);
    t->background.size = cfg->background;
    t->background.dim = t->dim;
    t->background.stride = t->stride;
    if (cfg->background > 0 && t->bag.columns != NULL) {
        t->background.set = ast_bag_basis(&t->bag, 0) - stride * (size_t)cfg->background; /* the lead's last columns */
        t->background.mean = t->background.set - stride;
        t->background.changed = t->bag.changed + t->bag.lead - cfg->background - 1;
    }
    t->anchor = ast_arena_take(arena, stride, sizeof *t->anchor);

    cloud_layout(&t->proposal, cfg->particles, arena);
    ast_view_layout(&t->view, cfg, arena);
    ast_features_layout(&t->features, cfg, arena);
    t->scoring->layout(&t->scoring_scratch, cfg, t->dim, arena);
    t->work_count = ast_subspace_work(la, t->dim, cfg->history + 1);
    const size_t given = (size_t)cfg->history + 1; /* a start keeps the patches there, and the background's mean behind them */
    t->desk = ast_arena_take(arena, (size_t)cfg->threads, sizeof *t->desk);
    for (int w = 0; w < cfg->threads; w++)
        desk_layout(t->desk != NULL ? &t->desk[w] : NULL, t, w == 0 && given > AST_TILE ? given : (size_t)AST_TILE, arena);
    t->workers = ast_workers_layout(cfg->threads, arena);
    const size_t particles = (size_t)cfg->particles, scored = (size_t)ast_shortlist_length(cfg);
    const size_t distances = scored * (size_t)cfg->bag_size; /* until there is a bag all particles have one each */
    t->distance = ast_arena_take(arena, distances > particles ? distances : particles, sizeof *t->distance);
    t->voice = ast_arena_take(arena, (size_t)cfg->bag_size, sizeof *t->voice);
    if (scored < particles) {
        t->direction = ast_arena_take(arena, (size_t)ast_features_glance_length(cfg), sizeof *t->direction);
        t->promise = ast_arena_take(arena, particles, sizeof *t->promise);
        t->heap = ast_arena_take(arena, scored, sizeof *t->heap);
    }
    t->mean = ast_arena_take(arena, stride, sizeof *t->mean);
    t->basis = ast_arena_take(arena, stride * (size_t)cfg->basis_size, sizeof *t->basis);
}

size_t ast_mem_size_backend(const ast_config *cfg, const struct ast_linalg *la) {
    struct ast_tracker counted;
    struct ast_arena arena = {NULL, 0};
    if (ast_config_check(cfg, NULL) != AST_OK) return 0;
    (void)ast_arena_take(&arena, 1, sizeof counted);
    layout(&counted, cfg, la, &arena);
    return arena.used + AST_ALIGNMENT - 1; /* so that a block at any address will do */
}

size_t ast_mem_size(const ast_config *cfg) {
    return ast_mem_size_backend(cfg, ast_default_linalg());
}

int ast_init_backend(ast_tracker **out, const ast_config *cfg, const struct ast_linalg *la, void *mem, size_t mem_size) {
    if (out == NULL) return AST_E_NULL;
    const int error = ast_config_check(cfg, NULL);
    if (error != AST_OK) return error;
    const size_t needed = ast_mem_size_backend(cfg, la);
    void *owned = NULL;
    if (mem == NULL) {
#ifdef AST_NO_HEAP
        return AST_E_NO_HEAP;
#else
        owned = malloc(needed);
        if (owned == NULL) return AST_E_OUT_OF_MEMORY;
#endif
    } else if (mem_size < needed) {
        return AST_E_ARENA;
    }
    struct ast_arena arena = {ast_align(owned != NULL ? owned : mem), 0};
    struct ast_tracker *t = ast_arena_take(&arena, 1, sizeof *t);
    layout(t, cfg, la, &arena);
    t->owned = owned;
    if (la->prepare() != 0) {
        ast_free(t);
        return AST_E_BACKEND;
    }
    if (ast_workers_start(t->workers) != 0) {
        ast_free(t);
        return AST_E_THREAD;
    }
    *out = t;
    return AST_OK;
}

int ast_init(ast_tracker **out, const ast_config *cfg, void *mem, size_t mem_size) {
    return ast_init_backend(out, cfg, ast_default_linalg(), mem, mem_size);
}

void ast_free(ast_tracker *t) {
    if (t == NULL) return;
    ast_workers_end(t->workers);
#ifndef AST_NO_HEAP
    free(t->owned);
#endif
}

/* ---- Models ---- */

static ast_box window_of(const struct ast_tracker *t, const struct ast_state *state) {
    const float w = t->box_width * state->scale, h = t->box_height * state->scale;
    const ast_box window = {state->x - 0.5f * w, state->y - 0.5f * h, w, h};
    return window;
}

/* Shows the part of a frame around centres between (left, top) and (right, bottom), with room for the object's box at this scale
 * and for its surroundings, and prepares the features there. */
static void look(struct ast_tracker *t, const ast_frame *frame, float left, float top, float right, float bottom, float scale) {
    /* Boxes around a centre: half for the object, the rest for larger candidates and for background. */
    const float reach = t->cfg.background > 0 ? 1.25f : 0.75f;
    const float w = t->box_width * scale, h = t->box_height * scale;
    const ast_box object = {0.0f, 0.0f, w, h};
    const ast_box region = {left - reach * w, top - reach * h, right - left + 2.0f * reach * w, bottom - top + 2.0f * reach * h};
    ast_view_show(&t->view, frame, &region, &object);
    ast_features_prepare(&t->features, &t->view.image, w / t->view.pixel, h / t->view.pixel);
}

/* The feature vector of a box, in the frame that was looked at. */
static void describe_at(struct ast_desk *desk, const struct ast_tracker *t, const ast_box *box, float *vector) {
    const ast_box window = ast_view_box(&t->view, box);
    ast_features_vector(&t->features, &desk->features, &t->view.image, &window, vector);
}

static void describe(struct ast_tracker *t, const ast_box *box, float *vector) {
    describe_at(t->desk, t, box, vector);
}

/* The mean that draw_background will give after a start: the same draws, without keeping them. mean, vector: dim. */
static void foresee_background_mean(struct ast_tracker *t, const ast_box *object, float *mean, float *vector) {
    struct ast_random random;
    ast_random_seed(&random, t->cfg.seed);
    memset(mean, 0, (size_t)t->dim * sizeof *mean);
    for (int z = 0; z < t->background.size; z++) {
        const ast_box box = ast_background_box(object, &random);
        describe(t, &box, vector);
        for (int d = 0; d < t->dim; d++) mean[d] += vector[d] / (float)t->background.size;
    }
}

/* Draws all background vectors around the object's box into the set. */
static void draw_background(struct ast_tracker *t, const ast_box *object) {
    for (int z = 0; z < t->background.size; z++) {
        const ast_box box = ast_background_box(object, &t->random);
        describe(t, &box, t->background.set + (size_t)z * (size_t)t->stride);
    }
    if (t->background.size > 0) ast_background_average(&t->background);
}

/* Draws a frame's share of them anew. */
static void refresh_background(struct ast_tracker *t, const ast_box *object) {
    for (int i = 0; i < t->cfg.background_refresh; i++) {
        const int slot = (int)(ast_random_bits(&t->random) % (uint32_t)t->background.size);
        const ast_box box = ast_background_box(object, &t->random);
        describe(t, &box, t->desk->tile);
        ast_background_replace(&t->background, slot, t->desk->tile);
    }
}

/* Fits the subspace of a set into t->mean and t->basis. A raw basis starts from the background's mean where there is a
 * background. */
static int fit_images(struct ast_tracker *t, const struct ast_images *images, const float *background_mean, int *rank) {
    const int failed =
        ast_subspace_of(t->la, images, t->cfg.basis == AST_BASIS_CENTRED, t->background.size > 0 ? background_mean : NULL,
                        t->cfg.basis_size, t->mean, t->basis, t->stride, rank, t->desk->work, t->work_count);
    return failed ? AST_E_BACKEND : AST_OK;
}

/* The same for the history and one vector more. */
static int fit_winner(struct ast_tracker *t, const float *patch, int *rank) {
    const float *column[AST_MAX_HISTORY + 1];
    struct ast_images images = {column, t->history.count, t->dim};
    for (int j = 0; j < t->history.count; j++) column[j] = ast_history_patch(&t->history, j);
    column[images.count++] = patch;
    return fit_images(t, &images, t->background.mean, rank);
}

/* Puts what was fitted into the bag. */
static void add_model(struct ast_tracker *t, int rank) {
    if (t->cfg.model == AST_MODEL_LINEAR) memset(t->mean, 0, (size_t)t->dim * sizeof *t->mean);
    ast_bag_add(&t->bag, t->mean, t->basis, rank);
}

/* ---- Start ---- */

int ast_start(ast_tracker *t, const ast_frame *frame, const ast_box *box) {
    return ast_start_sequence(t, frame, box, 1);
}

/* The state of a box whose object had the first box at scale 1; areas decide where the sides disagree. */
static struct ast_state state_of(const ast_config *cfg, const ast_box *box, const ast_box *first) {
    const float scale = ast_sqrtf((box->w / first->w) * (box->h / first->h));
    struct ast_state state = {box->x + 0.5f * box->w, box->y + 0.5f * box->h, scale};
    if (state.scale < cfg->scale_min) state.scale = cfg->scale_min;
    if (state.scale > cfg->scale_max) state.scale = cfg->scale_max;
    return state;
}

int ast_start_sequence(ast_tracker *t, const ast_frame *frames, const ast_box *boxes, int32_t count) {
    if (t == NULL || frames == NULL || boxes == NULL) return AST_E_NULL;
    if (count < 1) return AST_E_RANGE;
    for (int32_t f = 0; f < count; f++) {
        int error = ast_frame_check(&frames[f]);
        if (error == AST_OK) error = ast_box_check(&boxes[f], &frames[f]);
        if (error != AST_OK) return error;
    }
    /* What can fail comes first, and works on scratch: the patches given go to the tile, the first model's subspace to the fit. */
    const float width_before = t->box_width, height_before = t->box_height; /* making patches needs the object's size */
    const int32_t used = count < t->cfg.history ? count : t->cfg.history;
    const struct ast_state last = state_of(&t->cfg, &boxes[count - 1], &boxes[0]);
    const float *column[AST_MAX_HISTORY];
    const struct ast_images images = {column, used, t->dim};
    int rank = 0;
    t->box_width = boxes[0].w;
    t->box_height = boxes[0].h;
    for (int32_t j = 0; j < used; j++) {
        const ast_box *box = &boxes[count - used + j];
        const struct ast_state state = state_of(&t->cfg, box, &boxes[0]);
        float *patch = t->desk->tile + (size_t)j * (size_t)t->stride;
        look(t, &frames[count - used + j], state.x, state.y, state.x, state.y, state.scale);
        describe(t, box, patch);
        column[j] = patch;
    }
    ast_images_mean(&images, t->mean);
    float *background_mean =
        t->desk->tile + (size_t)used * (size_t)t->stride; /* behind the patches, of which a tile holds one more */
    if (used == t->cfg.history) foresee_background_mean(t, &boxes[count - 1], background_mean, t->basis);
    if (used == t->cfg.history && fit_images(t, &images, background_mean, &rank) != AST_OK) {
        t->box_width = width_before;
        t->box_height = height_before;
        return AST_E_BACKEND;
    }

    t->started = 1;
    t->frame = 0;
    t->since_model = 0;
    t->models = 0;
    t->estimate = last;
    t->velocity_x = t->velocity_y = 0.0f;
    t->confidence.status = AST_TRACKING;
    t->confidence.low = 0;
    ast_guard_clear(&t->guard, &last);
    ast_random_seed(&t->random, t->cfg.seed);
    ast_cloud_gather(&t->cloud, &t->estimate);
    ast_history_clear(&t->history);
    for (int32_t j = 0; j < used; j++) ast_history_push(&t->history, column[j]);
    draw_background(t, &boxes[count - 1]);
    memcpy(t->anchor, t->mean, (size_t)t->dim * sizeof *t->anchor);
    ast_bag_clear(&t->bag);
    if (used == t->cfg.history) add_model(t, rank);
    return AST_OK;
}

/* ---- Step ---- */

/* Until P patches are known there is no model, and a candidate's set would hold little but itself: candidates are compared with the
 * mean of the patches so far, by the squared distance that takes the Mahalanobis term's place. */
static void distances_to_mean(struct ast_tracker *t, const float *mean, const float *patches, int count, float *distance) {
    const ast_real weight = t->cfg.model == AST_MODEL_AFFINE ? (ast_real)t->cfg.alpha : 1;
    for (int i = 0; i < count; i++) {
        const float *patch = patches + (size_t)i * (size_t)t->stride;
        ast_real sum = 0;
        for (int d = 0; d < t->dim; d++) {
            const ast_real difference = (ast_real)patch[d] - (ast_real)mean[d];
            sum += difference * difference;
        }
        distance[i] = (float)(weight * sum);
    }
}

static int parts_of(int particles) {
    return (particles + AST_TILE - 1) / AST_TILE;
}

/* What the parts of scoring a frame's candidates share. */
struct round {
    struct ast_tracker *t;
    const ast_frame *frame;
    struct ast_scene scene; /* but for the work, which is at each desk */
    int models;
};

static ast_box window_of_particle(const struct ast_tracker *t, int i) {
    const struct ast_state state = {t->proposal.x[i], t->proposal.y[i], t->proposal.scale[i]};
    return window_of(t, &state);
}

/* How many of `all` there are in a part. */
static int in_part(int part, int all) {
    const int rest = all - part * AST_TILE;
    return rest < AST_TILE ? rest : AST_TILE;
}

/* What a glance at the particles promises. */
static int glance_part(void *shared, int worker, int part) {
    const struct round *round = (const struct round *)shared;
    const struct ast_tracker *t = round->t;
    struct ast_desk *desk = &t->desk[worker];
    const int first = part * AST_TILE, count = in_part(part, t->proposal.count);
    for (int i = 0; i < count; i++) {
        const ast_box box = window_of_particle(t, first + i), window = ast_view_box(&t->view, &box);
        ast_features_glance(&t->features, &desk->features, &t->view.image, &window, desk->tile + (size_t)i * (size_t)t->stride);
    }
    ast_product(count, 1, ast_features_glance_length(&t->cfg), desk->tile, t->stride, t->direction, t->stride, t->promise + first,
                AST_LANES);
    return 0;
}

static int score_part(void *shared, int worker, int part) {
    const struct round *round = (const struct round *)shared;
    struct ast_tracker *t = round->t;
    struct ast_desk *desk = &t->desk[worker];
    const int first = part * AST_TILE, count = in_part(part, t->scored);
    float *distance = t->distance + (size_t)first * (size_t)round->models;
    struct ast_scene scene = round->scene;
    scene.work = desk->work;
    for (int i = 0; i < count; i++) {
        const ast_box window = window_of_particle(t, first + i);
        describe_at(desk, t, &window, desk->tile + (size_t)i * (size_t)t->stride);
    }
    if (t->bag.count > 0) return t->scoring->tile(&t->scoring_scratch, &desk->scoring, &scene, desk->tile, count, distance);
    distances_to_mean(t, t->mean, desk->tile, count, distance);
    return 0;
}

/* Looks at all that the proposed particles can show. */
static void look_at_cloud(struct ast_tracker *t, const ast_frame *frame) {
    const struct ast_cloud *cloud = &t->proposal;
    float left = cloud->x[0], right = left, top = cloud->y[0], bottom = top;
    for (int i = 1; i < cloud->count; i++) {
        if (cloud->x[i] < left) left = cloud->x[i];
        if (cloud->x[i] > right) right = cloud->x[i];
        if (cloud->y[i] < top) top = cloud->y[i];
        if (cloud->y[i] > bottom) bottom = cloud->y[i];
    }
    look(t, frame, left, top, right, bottom, t->estimate.scale);
}

/* What all candidates share: the first part is the frame that they show, the second what is known without it. */
static int prepare_part(void *shared, int worker, int part) {
    const struct round *round = (const struct round *)shared;
    struct ast_tracker *t = round->t;
    (void)worker; /* the second part alone needs a desk, and takes the first */
    if (part == 0) {
        look_at_cloud(t, round->frame);
    } else if (t->bag.count > 0) {
        return t->scoring->prepare(&t->scoring_scratch, &t->desk->scoring, &round->scene);
    } else {
        const float *column[AST_MAX_HISTORY];
        const struct ast_images images = {column, t->history.count, t->dim};
        for (int j = 0; j < images.count; j++) column[j] = ast_history_patch(&t->history, j);
        ast_images_mean(&images, t->mean);
    }
    return 0;
}

/* Brings the particles that are worth to be scored in full to the front of the proposal. Until there is a bag, all are. */
static void shortlist(struct ast_tracker *t, struct round *round) {
    const struct ast_task glances = {glance_part, round, parts_of(t->proposal.count), 1};
    const int wanted = ast_shortlist_length(&t->cfg);
    t->scored = t->bag.count > 0 ? wanted : t->proposal.count;
    if (t->scored == t->proposal.count) return;
    t->scoring->aim(&t->scoring_scratch, &round->scene, t->bag.say, ast_features_glance_length(&t->cfg), t->direction);
    (void)ast_workers_share(t->workers, &glances); /* nothing in it can fail */
    ast_shortlist(&t->proposal, t->promise, wanted, t->heap);
}

/* Distances of the proposed particles to all models, tile by tile. */
static int score_particles(struct ast_tracker *t, const ast_frame *frame, int models) {
    struct round round = {
        t,
        frame,
        {&t->cfg, t->la, t->kernels, &t->history, &t->bag, t->background.size, t->desk->tile, t->desk->work, t->work_count},
        models};
    const struct ast_task preparation = {prepare_part, &round, 2, 1};
    if (ast_workers_share(t->workers, &preparation) != 0) return AST_E_BACKEND;
    shortlist(t, &round);
    const struct ast_task tiles = {score_part, &round, parts_of(t->scored), 0};
    return ast_workers_share(t->workers, &tiles) != 0 ? AST_E_BACKEND : AST_OK;
}

/* The frame's candidates: the last cloud's, moved on; while the object is lost, half of them search where it was last seen. */
static void propose(struct ast_tracker *t, const ast_frame *frame, struct ast_random *random) {
    const float size = ast_sqrtf(t->box_width * t->box_height) * t->guard.good.scale;
    ast_cloud_resample(&t->cloud, &t->proposal, random);
    ast_cloud_shift(&t->proposal, t->cfg.velocity * t->velocity_x, t->cfg.velocity * t->velocity_y);
    ast_guard_gather(&t->guard, &t->proposal);
    ast_cloud_diffuse(&t->proposal, &t->cfg, frame, random);
    ast_guard_widen(&t->guard, &t->cfg, frame, size, &t->proposal);
    if (t->cfg.incumbent) ast_cloud_set(&t->proposal, 0, ast_state_within(t->estimate, &t->cfg, frame));
}

/* Where the winner is expected: about where the last one moves to. An object that is lost may be anywhere. */
static struct ast_expectation expectation(const struct ast_tracker *t) {
    const float size = ast_sqrtf(t->box_width * t->box_height) * t->estimate.scale;
    const struct ast_expectation expected = {t->estimate.x + t->cfg.velocity * t->velocity_x,
                                             t->estimate.y + t->cfg.velocity * t->velocity_y,
                                             t->guard.lost ? 0.0f : t->cfg.prior * size};
    return expected;
}

static void copy_cloud(struct ast_cloud *to, const struct ast_cloud *from) {
    const size_t bytes = (size_t)from->count * sizeof(float);
    memcpy(to->x, from->x, bytes);
    memcpy(to->y, from->y, bytes);
    memcpy(to->scale, from->scale, bytes);
    memcpy(to->weight, from->weight, bytes);
}

int ast_step(ast_tracker *t, const ast_frame *frame, ast_result *result) {
    if (t == NULL) return AST_E_NULL;
    int error = ast_frame_check(frame);
    if (error != AST_OK) return error;
    if (!t->started) return AST_E_NOT_STARTED;

    /* Everything below until the commit works on scratch. */
    struct ast_random random = t->random;
    ast_workers_wake(t->workers);
    propose(t, frame, &random);

    const int models = t->bag.count > 0 ? t->bag.count : 1;
    t->models = 0; /* until the distances are whole again */
    error = score_particles(t, frame, models);
    if (error != AST_OK) return error;
    const struct ast_expectation expected = expectation(t);
    ast_weigh(t->distance, t->scored, models, &t->cfg, t->proposal.weight, t->voice);
    for (int i = t->scored; i < t->proposal.count; i++) t->proposal.weight[i] = 0.0f;
    const int best = ast_winner(&t->proposal, t->scored, &expected);
    const struct ast_state found = {t->proposal.x[best], t->proposal.y[best], t->proposal.scale[best]};
    const ast_box found_box = window_of(t, &found);
    float nearest = t->distance[(size_t)best * (size_t)models];
    for (int j = 1; j < models; j++) {
        const float distance = t->distance[(size_t)best * (size_t)models + (size_t)j];
        if (distance < nearest) nearest = distance;
    }

    /* The winner's vector again (the tile has been reused), what it is worth, and its subspace when a model is due. */
    float *vector = t->desk->tile;
    describe(t, &found_box, vector);
    struct ast_guard guard = t->guard;
    struct ast_confidence confidence;
    float score;
    int selected = 1; /* fit to take an older model's place */
    if (t->cfg.guard > 0.0f) {
        const struct ast_resemblance resemblance =
            ast_guard_resemblance(vector, t->anchor, &t->bag, t->background.size > 0 ? t->background.mean : NULL);
        const float spread = ast_cloud_spread(&t->proposal) / ast_sqrtf(found_box.w * found_box.h);
        const struct ast_evidence evidence = {resemblance.start, spread, ast_frame_share(frame, &found_box)};
        score = ast_confidence_probability(&evidence);
        ast_guard_see(&guard, &t->cfg, &found, &resemblance, spread, score);
        selected = t->bag.count < t->bag.capacity || ast_guard_selects(&t->guard, &t->cfg, &resemblance, score);
        confidence = t->confidence;
        confidence.status = ast_guard_status(&guard, &t->cfg, score);
    } else {
        score = ast_confidence_score(vector, t->anchor, &t->bag);
        confidence = ast_confidence_next(t->confidence, &t->cfg, score);
    }
    const int trusted = guard.low == 0;
    const int first_model = t->bag.count == 0 && t->history.count + 1 == t->cfg.history;
    const int model_due =
        trusted && selected && (first_model || (t->bag.count > 0 && t->since_model + 1 >= (uint32_t)t->cfg.bag_interval));
    int rank = 0;
    if (model_due) error = fit_winner(t, vector, &rank);
    if (error != AST_OK) return error;

    const int was_lost = t->guard.lost;
    t->random = random;
    t->frame++;
    t->velocity_x = trusted && !was_lost ? 0.5f * (t->velocity_x + found.x - t->estimate.x) : 0.0f;
    t->velocity_y = trusted && !was_lost ? 0.5f * (t->velocity_y + found.y - t->estimate.y) : 0.0f;
    t->estimate = found;
    t->confidence = confidence;
    t->guard = guard;
    t->models = models;
    copy_cloud(&t->cloud, &t->proposal);
    if (t->scored < t->cloud.count) /* the next shortlist asks */
        ast_attribute(t->distance + (size_t)best * (size_t)models, t->voice, models, t->bag.say);
    t->since_model = model_due ? 0 : t->since_model + 1;
    if (trusted) {
        ast_history_push(&t->history, vector);
        if (model_due) add_model(t, rank);
        refresh_background(t, &found_box);
    }

    if (result != NULL) {
        result->box = found_box;
        result->scale = found.scale;
        result->score = score;
        result->distance = nearest;
        result->effective_particles = ast_cloud_effective(&t->cloud);
        result->status = t->confidence.status;
        result->best = best;
        result->frame = t->frame;
    }
    return AST_OK;
}
