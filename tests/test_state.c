/* Save and restore: bit for bit in the middle of a sequence, and nothing but a whole, unaltered block of the same configuration. */
#include "tracker.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support_noise.h"
#include "support_pages.h"
#include "support_render.h"
#include "support_tracker.h"
#include "unity.h"

static struct render scene;

void setUp(void) {
    render_open(&scene, 64, 48, 1);
}
void tearDown(void) {
    render_close(&scene);
}

/* ---- A sequence ---- */

static ast_box truth(int frame) {
    return render_path(&scene, frame, 16, 12, 0.15, 1.1);
}

static void start(ast_tracker *t) {
    const ast_box box = truth(0);
    const ast_frame frame = render_frame(&scene, &box);
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_start(t, &frame, &box));
}

/* Steps over frames first .. last. */
static ast_result walk(ast_tracker *t, int first, int last) {
    ast_result result;
    memset(&result, 0, sizeof result);
    for (int f = first; f <= last; f++) {
        const ast_box box = truth(f);
        const ast_frame frame = render_frame(&scene, &box);
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_step(t, &frame, &result));
    }
    return result;
}

static ast_tracker *tracker_after(const ast_config *cfg, int steps) {
    ast_tracker *t = tracker_new(cfg, backends[0]);
    start(t);
    (void)walk(t, 1, steps);
    return t;
}

/* The smallest tracker there is, whose block can be altered in every bit. */
static ast_config smallest_config(void) {
    ast_config cfg = small_config();
    cfg.particles = 2;
    cfg.patch_width = cfg.patch_height = 4;
    cfg.history = 2;
    cfg.basis_size = 1;
    cfg.bag_size = 2;
    return cfg;
}

/* ---- The block as its format is documented: magic, version, configuration, state, checksum ---- */

enum { VERSION_AT = 8, CONFIG_AT = 12, CHECKSUM_BYTES = 8 };

/* Whether the configuration's field says how distances are computed, which is no part of the state. */
static int is_apart(const ast_config_field *field) {
    return field->offset == offsetof(ast_config, scoring) || field->offset == offsetof(ast_config, threads);
}

static size_t state_at(void) {
    int32_t count = 0;
    size_t at = CONFIG_AT;
    const ast_config_field *fields = ast_config_fields(&count);
    for (int32_t f = 0; f < count; f++) {
        if (is_apart(&fields[f])) continue;
        at += fields[f].kind == AST_FIELD_SEED ? 8 : 4;
    }
    return at;
}

/* Words of the state before the particles, from what is behind them. cfg without a background. */
static size_t cloud_word(const ast_config *cfg) {
    const size_t dim = (size_t)cfg->patch_width * (size_t)cfg->patch_height;
    const size_t model = 2 + dim * ((size_t)cfg->basis_size + 1);
    const size_t behind = 4 * (size_t)cfg->particles + 2 + (size_t)cfg->history * dim + 2 + (size_t)cfg->bag_size * model + dim;
    return (ast_save_size(cfg) - CHECKSUM_BYTES - state_at()) / 4 - behind;
}

static void put_word(unsigned char *at, uint32_t word) {
    for (int b = 0; b < 4; b++) at[b] = (unsigned char)(word >> (8 * b) & 255);
}

static uint32_t get_word(const unsigned char *at) {
    return (uint32_t)at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

static void put_float(unsigned char *at, float value) {
    uint32_t word;
    memcpy(&word, &value, sizeof word);
    put_word(at, word);
}

/* Makes an altered block look unaltered: FNV-1a with 64 bits of all before it. */
static void sign(struct saved *saved) {
    uint64_t hash = UINT64_C(0xcbf29ce484222325);
    unsigned char *end = saved->bytes + saved->size - CHECKSUM_BYTES;
    for (const unsigned char *byte = saved->bytes; byte < end; byte++) {
        hash ^= *byte;
        hash *= UINT64_C(0x100000001b3);
    }
    put_word(end, (uint32_t)(hash & 0xffffffffu));
    put_word(end + 4, (uint32_t)(hash >> 32));
}

static void assert_rejected(ast_tracker *t, const struct saved *block, const struct saved *before, const char *what) {
    const int code = ast_restore(t, block->bytes, block->size);
    TEST_ASSERT_TRUE_MESSAGE(code == AST_E_CORRUPT || code == AST_E_MISMATCH, what);
    saved_check(before, t, what);
}

static void test_format_is_as_documented(void) {
    const ast_config cfg = smallest_config();
    ast_tracker *t = tracker_after(&cfg, 3);
    struct saved saved = saved_from(t), copy = saved_from(t);
    TEST_ASSERT_EQUAL_MEMORY("ASTSTATE", saved.bytes, 8);
    TEST_ASSERT_EQUAL_UINT32(4, get_word(saved.bytes + VERSION_AT));
    TEST_ASSERT_EQUAL_UINT32(cfg.particles, get_word(saved.bytes + CONFIG_AT)); /* the first field */
    TEST_ASSERT_EQUAL_UINT32(3, get_word(saved.bytes + state_at()));            /* frames since the start */
    sign(&copy);
    TEST_ASSERT_EQUAL_MEMORY(saved.bytes, copy.bytes, saved.size);
    saved_free(&saved);
    saved_free(&copy);
    ast_free(t);
}

/* ---- Going on ---- */

/* Saved after every step of a sequence, restored into a new tracker elsewhere whose memory held something else: both go on
 * alike. */
static void test_restored_tracker_continues_bit_for_bit(void) {
    for (int which = 0; which < SMALL_CONFIGS; which++) {
        for (int b = 0; b < BACKENDS; b++) {
            const ast_config cfg = small_config_of(which);
            ast_tracker *original = tracker_new(&cfg, backends[b]);
            start(original);
            for (int at = 0; at < 14; at++) {
                struct saved saved = saved_from(original);
                struct guarded block;
                ast_tracker *t = NULL;
                guarded_open(&block, ast_mem_size_backend(&cfg, backends[b]), (size_t)(at * 5 % 64), at % 2 == 0 ? 0xff : 0x41);
                TEST_ASSERT_EQUAL_INT(AST_OK, ast_init_backend(&t, &cfg, backends[b], block.memory, block.size));
                TEST_ASSERT_EQUAL_INT(AST_OK, ast_restore(t, saved.bytes, saved.size));
                saved_check(&saved, t, "restored");

                ast_tracker *control = tracker_new(&cfg, backends[b]);
                start(control);
                (void)walk(control, 1, at);
                const ast_result expected = walk(control, at + 1, at + 6), got = walk(t, at + 1, at + 6);
                TEST_ASSERT_EQUAL_MEMORY(&expected, &got, sizeof got);
                struct saved end = saved_from(control);
                saved_check(&end, t, "after six steps more");
                guarded_check(&block);
                saved_free(&end);
                saved_free(&saved);
                ast_free(control);
                ast_free(t);
                guarded_close(&block);
                (void)walk(original, at + 1, at + 1);
            }
            ast_free(original);
        }
    }
}

/* A tracker in use is replaced wholly, whatever it was doing. */
static void test_restore_replaces_everything(void) {
    for (int used = 0; used < 12; used += 2) {
        const ast_config cfg = small_config_of(used % SMALL_CONFIGS);
        ast_tracker *early = tracker_after(&cfg, 1), *late = tracker_after(&cfg, 11);
        struct saved saved_early = saved_from(early), saved_late = saved_from(late);
        (void)walk(early, 20, 20 + used);
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_restore(early, saved_late.bytes, saved_late.size));
        saved_check(&saved_late, early, "late into early");
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_restore(late, saved_early.bytes, saved_early.size));
        saved_check(&saved_early, late, "early into late");
        const ast_result a = walk(early, 12, 15);
        ast_tracker *control = tracker_after(&cfg, 11);
        const ast_result b = walk(control, 12, 15);
        TEST_ASSERT_EQUAL_MEMORY(&b, &a, sizeof a);
        saved_free(&saved_early);
        saved_free(&saved_late);
        ast_free(early);
        ast_free(late);
        ast_free(control);
    }
}

/* Whatever a tracker saves it takes back: among others a cloud in which one particle has all the weight, in shares of every
 * model. */
static void test_every_saved_state_is_accepted(void) {
    static const int bags[] = {1, 3, 7, 10, 26, AST_MAX_BAG};
    for (size_t b = 0; b < sizeof bags / sizeof bags[0]; b++) {
        for (int particles = 1; particles <= 4; particles += 3) {
            ast_config cfg = smallest_config();
            cfg.particles = particles;
            cfg.bag_size = bags[b];
            cfg.bag_interval = 1;
            cfg.sigma = 1e-6f;
            ast_tracker *t = tracker_new(&cfg, backends[0]);
            start(t);
            for (int f = 1; f < bags[b] + 5; f++) {
                (void)walk(t, f, f);
                struct saved saved = saved_from(t);
                TEST_ASSERT_EQUAL_INT(AST_OK, ast_restore(t, saved.bytes, saved.size));
                saved_free(&saved);
            }
            ast_free(t);
        }
    }
}

static void test_distances_are_gone_after_restore(void) {
    const ast_config cfg = small_config();
    ast_tracker *t = tracker_after(&cfg, 5);
    struct saved saved = saved_from(t);
    ast_particles particles;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(t, &particles));
    TEST_ASSERT_NOT_NULL(particles.distance);
    TEST_ASSERT_EQUAL_INT(cfg.particles, particles.scored);
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_restore(t, saved.bytes, saved.size));
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(t, &particles));
    TEST_ASSERT_NULL(particles.distance);
    TEST_ASSERT_EQUAL_INT(0, particles.scored);
    saved_free(&saved);
    ast_free(t);
}

/* The way distances are computed is no part of the state. */
static void test_state_moves_between_scorings(void) {
    ast_config gram = small_config(), literal = small_config();
    literal.scoring = AST_SCORING_LITERAL;
    TEST_ASSERT_EQUAL_UINT(ast_save_size(&gram), ast_save_size(&literal));
    ast_tracker *from = tracker_after(&gram, 9), *to = tracker_new(&literal, backends[0]);
    struct saved saved = saved_from(from);
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_restore(to, saved.bytes, saved.size));
    saved_check(&saved, to, "literal");
    (void)walk(from, 10, 10);
    (void)walk(to, 10, 10);
    ast_particles a, b;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(from, &a));
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(to, &b));
    TEST_ASSERT_EQUAL_INT(a.models, b.models);
    for (int i = 0; i < a.scored * a.models; i++) TEST_ASSERT_FLOAT_WITHIN(1e-3f, a.distance[i], b.distance[i]);
    TEST_ASSERT_EQUAL_MEMORY(a.x, b.x, (size_t)a.count * sizeof *a.x);
    saved_free(&saved);
    ast_free(from);
    ast_free(to);
}

/* Equal states are equal bytes: the address, the memory's past and what was tracked before do not show. */
static void test_block_tells_the_state_only(void) {
    struct saved first = {NULL, 0};
    for (int run = 0; run < 4 * SMALL_CONFIGS; run++) {
        const int trial = run % 4;
        const ast_config cfg = small_config_of(run / 4);
        struct guarded block;
        ast_tracker *t = NULL;
        guarded_open(&block, ast_mem_size(&cfg), (size_t)(trial * 17), trial * 85);
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_init(&t, &cfg, block.memory, block.size));
        if (trial > 1) {
            start(t);
            (void)walk(t, 30, 30 + 5 * trial);
        }
        start(t);
        (void)walk(t, 1, 2); /* so that most slots of the rings are free */
        if (trial == 0)
            first = saved_from(t);
        else
            saved_check(&first, t, "another address, another past");
        if (trial == 3) saved_free(&first);
        ast_free(t);
        guarded_close(&block);
    }
}

/* ---- Sizes ---- */

static void test_save_writes_its_size_exactly(void) {
    const ast_config cfg = small_config();
    ast_tracker *t = tracker_after(&cfg, 6);
    const size_t size = ast_save_size(&cfg);
    struct guarded buffer;
    guarded_open(&buffer, size, 3, 0x77);
    TEST_ASSERT_EQUAL_INT(AST_E_BUFFER, ast_save(t, buffer.memory, size - 1));
    TEST_ASSERT_EQUAL_INT(AST_E_BUFFER, ast_save(t, buffer.memory, 0));
    for (size_t i = 0; i < size; i++) TEST_ASSERT_EQUAL_HEX8(0x77, buffer.memory[i]);
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_save(t, buffer.memory, size));
    guarded_check(&buffer);
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_restore(t, buffer.memory, size));

    struct saved saved = saved_from(t), larger = {malloc(size + 100), size + 100};
    memset(larger.bytes, 0x77, larger.size);
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_save(t, larger.bytes, larger.size));
    TEST_ASSERT_EQUAL_MEMORY(saved.bytes, larger.bytes, size);
    for (size_t i = size; i < larger.size; i++) TEST_ASSERT_EQUAL_HEX8(0x77, larger.bytes[i]);
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_restore(t, larger.bytes, larger.size));
    saved_free(&saved);
    saved_free(&larger);
    guarded_close(&buffer);
    ast_free(t);
}

static void test_save_changes_nothing(void) {
    const ast_config cfg = small_config();
    ast_tracker *t = tracker_after(&cfg, 6), *control = tracker_after(&cfg, 6);
    for (int i = 0; i < 3; i++) {
        struct saved saved = saved_from(t);
        saved_free(&saved);
    }
    const ast_result a = walk(t, 7, 9), b = walk(control, 7, 9);
    TEST_ASSERT_EQUAL_MEMORY(&b, &a, sizeof a);
    ast_free(t);
    ast_free(control);
}

static void test_save_and_restore_want_their_pointers(void) {
    const ast_config cfg = small_config();
    ast_tracker *t = tracker_new(&cfg, backends[0]);
    unsigned char bytes[64] = {0};
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, ast_save(NULL, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, ast_save(t, NULL, 1 << 20));
    TEST_ASSERT_EQUAL_INT(AST_E_NOT_STARTED, ast_save(t, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, ast_restore(NULL, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, ast_restore(t, NULL, sizeof bytes));
    TEST_ASSERT_EQUAL_INT(AST_E_CORRUPT, ast_restore(t, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_INT(AST_E_CORRUPT, ast_restore(t, bytes, 0));
    ast_free(t);
}

/* ---- Damage ---- */

static void test_every_flipped_bit_is_rejected(void) {
    const ast_config cfg = smallest_config();
    ast_tracker *t = tracker_after(&cfg, 6), *source = tracker_after(&cfg, 4);
    struct saved before = saved_from(t), block = saved_from(source);
    TEST_ASSERT_TRUE(ast_bag_count(source) == 2);
    for (size_t i = 0; i < block.size; i++) {
        for (int bit = 0; bit < 8; bit++) {
            block.bytes[i] = (unsigned char)(block.bytes[i] ^ 1u << bit);
            assert_rejected(t, &block, &before, "a flipped bit");
            block.bytes[i] = (unsigned char)(block.bytes[i] ^ 1u << bit);
        }
    }
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_restore(t, block.bytes, block.size)); /* the block was good */
    saved_free(&before);
    saved_free(&block);
    ast_free(t);
    ast_free(source);
}

static void test_altered_bytes_of_a_large_block_are_rejected(void) {
    const ast_config cfg = small_robust_config();
    struct noise noise = {2};
    ast_tracker *t = tracker_after(&cfg, 6), *source = tracker_after(&cfg, 4);
    struct saved before = saved_from(t), block = saved_from(source);
    for (int trial = 0; trial < 200; trial++) {
        unsigned char *byte = block.bytes + (size_t)(noise_uniform(&noise) * (double)block.size);
        const unsigned char keep = *byte;
        *byte = (unsigned char)(keep + noise_int(&noise, 1, 255));
        assert_rejected(t, &block, &before, "an altered byte");
        *byte = keep;
    }
    saved_free(&before);
    saved_free(&block);
    ast_free(t);
    ast_free(source);
}

/* Each block cut short ends where reading on would end the program. */
static void test_every_truncation_is_rejected(void) {
    const ast_config cfg = smallest_config();
    ast_tracker *t = tracker_after(&cfg, 6), *source = tracker_after(&cfg, 4);
    struct saved before = saved_from(t), block = saved_from(source);
    struct pages pages;
    pages_open(&pages, block.size);
    for (size_t size = 0; size < block.size; size++) {
        memcpy(pages.end - size, block.bytes, size);
        TEST_ASSERT_EQUAL_INT(AST_E_CORRUPT, ast_restore(t, pages.end - size, size));
    }
    saved_check(&before, t, "truncated");
    pages_close(&pages);
    saved_free(&before);
    saved_free(&block);
    ast_free(t);
    ast_free(source);
}

/* A rejected block does not start a tracker either. */
static void test_rejected_block_does_not_start(void) {
    const ast_config cfg = smallest_config();
    ast_tracker *t = tracker_new(&cfg, backends[0]), *source = tracker_after(&cfg, 4);
    struct saved block = saved_from(source);
    block.bytes[block.size / 2] ^= 1;
    TEST_ASSERT_EQUAL_INT(AST_E_CORRUPT, ast_restore(t, block.bytes, block.size));
    TEST_ASSERT_EQUAL_INT(AST_E_NOT_STARTED, ast_bag_count(t));
    saved_free(&block);
    ast_free(t);
    ast_free(source);
}

/* ---- Lies with a good checksum ---- */

/* The word of the state where the generator's 64 bits begin. */
static size_t random_word(const ast_tracker *t, const struct saved *block) {
    size_t word = 0;
    const unsigned char *at = block->bytes + state_at();
    while (get_word(at + 4 * word) != (uint32_t)(t->random.state & 0xffffffffu) ||
           get_word(at + 4 * word + 4) != (uint32_t)(t->random.state >> 32))
        TEST_ASSERT_TRUE(++word < 100);
    return word;
}

/* every: all lies in every word, otherwise they take turns. */
static void assert_lies_are_rejected(const ast_config *cfg, int every) {
    /* NaN, infinities, minus one: as a float or as a count, none is legal anywhere else */
    static const uint32_t lies[] = {0x7fc00000u, 0x7f800001u, 0x7f800000u, 0xff800000u, 0xffffffffu};
    enum { LIES = sizeof lies / sizeof lies[0] };
    ast_tracker *t = tracker_after(cfg, 6), *source = tracker_after(cfg, 4);
    struct saved before = saved_from(t), block = saved_from(source);
    const size_t from = state_at(), words = (block.size - CHECKSUM_BYTES - from) / 4, random = random_word(source, &block);
    for (size_t word = 2; word < words; word++) { /* the two frame counts before that may be anything */
        unsigned char *at = block.bytes + from + 4 * word;
        const uint32_t keep = get_word(at);
        if (word == random || word == random + 1) continue; /* and so may these */
        for (size_t lie = 0; lie < LIES; lie++) {
            char what[64];
            if (!every && lie != word % LIES) continue;
            snprintf(what, sizeof what, "word %u is %08x", (unsigned)word, (unsigned)lies[lie]);
            put_word(at, lies[lie]);
            sign(&block);
            TEST_ASSERT_EQUAL_INT_MESSAGE(AST_E_CORRUPT, ast_restore(t, block.bytes, block.size), what);
            if (every || word % 16 == 0) saved_check(&before, t, what);
        }
        put_word(at, keep);
    }
    saved_check(&before, t, "after all lies");
    sign(&block);
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_restore(t, block.bytes, block.size));
    saved_free(&before);
    saved_free(&block);
    ast_free(t);
    ast_free(source);
}

static void test_impossible_values_are_rejected(void) {
    const ast_config least = smallest_config(), all_parts = small_robust_config();
    assert_lies_are_rejected(&least, 1);
    assert_lies_are_rejected(&all_parts, 0);
}

/* Places by the order in which the state is documented to be written. */
static void test_values_out_of_range_are_rejected(void) {
    const ast_config cfg = smallest_config();
    ast_tracker *t = tracker_after(&cfg, 6), *source = tracker_after(&cfg, 4);
    const uint32_t n = (uint32_t)cfg.particles, dim = 16, p = (uint32_t)cfg.history, k = (uint32_t)cfg.bag_size;
    const uint32_t cloud = (uint32_t)cloud_word(&cfg), history = cloud + 4 * n, bag = history + 2 + p * dim;
    const uint32_t model = 2 + dim * ((uint32_t)cfg.basis_size + 1);
    struct saved sample = saved_from(source);
    const uint32_t confidence = (uint32_t)random_word(source, &sample) + 2;
    const struct {
        const char *what;
        uint32_t word;
        int is_float;
        double legal, lie;
    } lies[] = {
        {"box width 0", 2, 1, 20, 0},
        {"box width beyond any frame", 2, 1, 65535, 65536},
        {"box height below one pixel", 3, 1, 1, 0.999},
        {"estimate far away", 4, 1, 30, 1e30},
        {"scale below its limit", 6, 1, (double)cfg.scale_min, 0.99 * (double)cfg.scale_min},
        {"scale above its limit", 6, 1, (double)cfg.scale_max, 1.01 * (double)cfg.scale_max},
        {"velocity beyond any frame", 7, 1, -3, -1e30},
        {"unknown status", confidence, 0, 2, 3},
        {"too many low frames", confidence + 1, 0, cfg.lost_after, cfg.lost_after + 1},
        {"usual likeness to the start above 1", confidence + 2, 1, 1, 1.1},
        {"usual likeness to what is known above 1", confidence + 3, 1, 1, 1.1},
        {"lasting likeness to the start below -1", confidence + 4, 1, -1, -1.1},
        {"lasting likeness to what is known above 1", confidence + 5, 1, 1, 1.1},
        {"steady score above 1", confidence + 6, 1, 1, 1.1},
        {"steady score below 0", confidence + 6, 1, 0, -0.1},
        {"negative count of trusted frames", confidence + 7, 0, 10000, -1},
        {"more trusted frames than are counted", confidence + 7, 0, 0, 10001},
        {"negative count of refused frames", confidence + 8, 0, 5, -1},
        {"neither lost nor not", confidence + 9, 0, 1, 2},
        {"last good place far away", confidence + 10, 1, 30, -1e30},
        {"last good scale 0", confidence + 12, 1, 1, 0},
        {"particle's scale 0", cloud + 2 * n, 1, 1, 0},
        {"negative weight", cloud + 3 * n, 1, 0.5, -0.01},
        {"weight above 1", cloud + 3 * n, 1, 0.5, 1.01},
        {"history without a patch", history, 0, 2, 0},
        {"history too full", history, 0, p, p + 1},
        {"oldest patch beyond the ring", history + 1, 0, 0, p},
        {"bag too full", bag, 0, k, k + 1},
        {"oldest model beyond the bag", bag + 1, 0, 0, k},
        {"rank above n", bag + 2, 0, 1, cfg.basis_size + 1},
        {"a model's share below 0", bag + 3, 1, 0.5, -0.1},
        {"a model's share above 1", bag + 3, 1, 1, 1.1},
        {"rank of the second model above n", bag + 2 + model, 0, 1, cfg.basis_size + 1},
    };
    for (size_t l = 0; l < sizeof lies / sizeof lies[0]; l++) {
        struct saved before = saved_from(t), block = saved_from(source);
        unsigned char *at = block.bytes + state_at() + 4 * (size_t)lies[l].word;
        for (int lie = 1; lie >= 0; lie--) {
            const double value = lie ? lies[l].lie : lies[l].legal;
            if (lies[l].is_float)
                put_float(at, (float)value);
            else
                put_word(at, (uint32_t)(int32_t)value);
            sign(&block);
            const int code = ast_restore(t, block.bytes, block.size);
            TEST_ASSERT_EQUAL_INT_MESSAGE(lie ? AST_E_CORRUPT : AST_OK, code, lies[l].what);
            if (lie) saved_check(&before, t, lies[l].what);
        }
        saved_free(&before);
        saved_free(&block);
    }
    saved_free(&sample);
    ast_free(t);
    ast_free(source);
}

/* Steps on after a restore: numbers come out, and the weights are weights. */
static void assert_tracks_on(ast_tracker *t, int first, int last) {
    for (int f = first; f <= last; f++) {
        const ast_result r = walk(t, f, f);
        ast_particles particles;
        double sum = 0;
        TEST_ASSERT_TRUE(isfinite(r.box.x) && isfinite(r.box.y) && isfinite(r.box.w) && isfinite(r.box.h));
        TEST_ASSERT_TRUE(r.box.w > 0 && r.box.h > 0 && r.score >= 0.0f && r.score <= 1.0f);
        TEST_ASSERT_FALSE(isnan(r.distance));
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_particles(t, &particles));
        TEST_ASSERT_TRUE(r.best >= 0 && r.best < particles.count);
        for (int i = 0; i < particles.count; i++) sum += (double)particles.weight[i];
        TEST_ASSERT_DOUBLE_WITHIN(1e-5, 1.0, sum);
    }
}

/* Whatever passes the checks can be tracked with: no NaN comes out, nothing is touched outside the block. */
static void test_accepted_lies_do_no_harm(void) {
    static const float values[] = {0.0f, -0.0f, 1.0f, 3e9f, -1e17f, 1e18f, 1e-38f, 999999.0f};
    ast_config cfg = smallest_config();
    struct noise noise = {4};
    ast_tracker *source = tracker_after(&cfg, 4);
    int accepted = 0;
    for (int trial = 0; trial < 3000; trial++) {
        struct guarded memory;
        ast_tracker *t = NULL;
        struct saved block = saved_from(source);
        const size_t from = state_at(), words = (block.size - CHECKSUM_BYTES - from) / 4;
        const int changes = trial % 3 == 0 ? noise_int(&noise, 1, (int)words) : noise_int(&noise, 1, 4);
        for (int change = 0; change < changes; change++)
            put_float(block.bytes + from + 4 * (size_t)noise_int(&noise, 0, (int)words - 1), values[noise_int(&noise, 0, 7)]);
        sign(&block);
        guarded_open(&memory, ast_mem_size(&cfg), 1, 0xff);
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_init(&t, &cfg, memory.memory, memory.size));
        if (ast_restore(t, block.bytes, block.size) == AST_OK) {
            accepted++;
            assert_tracks_on(t, 5, 8);
            guarded_check(&memory);
        }
        ast_free(t);
        guarded_close(&memory);
        saved_free(&block);
    }
    TEST_ASSERT_TRUE(accepted > 100);
    ast_free(source);
}

static void fill(unsigned char *at, size_t count, float value, size_t period) {
    for (size_t i = 0; i < count; i++) put_float(at + 4 * i, i % period == 0 ? -value : value);
}

/* The largest value of a patch that the checks let pass. */
static float largest_accepted(ast_tracker *t, struct saved *block, unsigned char *at) {
    const uint32_t keep = get_word(at);
    float value = 1e20f;
    for (;; value *= 0.8f) {
        TEST_ASSERT_TRUE(value > 1e-3f);
        put_float(at, value);
        sign(block);
        if (ast_restore(t, block->bytes, block->size) == AST_OK) break;
    }
    put_word(at, keep);
    return value;
}

/* The largest vectors that are accepted, in the history, the models' bases, their means and the anchor, alone and together. */
static void test_largest_accepted_vectors_do_no_harm(void) {
    enum { HISTORY = 1, BASES = 2, MEANS = 4, ANCHOR = 8, ALL = 15 };
    for (int where = 1; where <= 2 * ALL + 1; where++) {
        ast_config cfg = small_config();
        cfg.scoring = where & 1 ? AST_SCORING_LITERAL : AST_SCORING_GRAM;
        cfg.patch_width = cfg.patch_height = 32;
        ast_tracker *t = tracker_new(&cfg, backends[0]), *source = tracker_after(&cfg, 6);
        struct saved block = saved_from(source);
        const size_t dim = 1024, basis = dim * (size_t)cfg.basis_size;
        unsigned char *history = block.bytes + state_at() + 4 * (cloud_word(&cfg) + 4 * (size_t)cfg.particles + 2);
        unsigned char *model = history + 4 * ((size_t)cfg.history * dim + 2);
        const float largest = largest_accepted(t, &block, history);
        if (where / 2 & HISTORY) fill(history, (size_t)cfg.history * dim, largest, 7);
        for (int32_t m = 0; m < cfg.bag_size; m++, model += 4 * (2 + basis + dim)) {
            if (where / 2 & BASES) fill(model + 8, basis, where / 2 & ANCHOR ? largest : 1.0f, basis + 1);
            if (where / 2 & MEANS) fill(model + 4 * (2 + basis), dim, largest, 3);
        }
        if (where / 2 & ANCHOR) fill(model, dim, largest, 5);
        sign(&block);
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_restore(t, block.bytes, block.size));
        assert_tracks_on(t, 7, 12);
        saved_free(&block);
        ast_free(t);
        ast_free(source);
    }
}

/* ---- Another configuration, another version ---- */

/* Changes one field to another value; 0 when the rules allow none that is near. */
static int change_field(ast_config *cfg, const ast_config_field *field) {
    unsigned char *member = (unsigned char *)cfg + field->offset;
    if (field->kind == AST_FIELD_FLOAT) {
        float value;
        memcpy(&value, member, sizeof value);
        value = nextafterf(value, value > field->minimum ? field->minimum : field->maximum);
        memcpy(member, &value, sizeof value);
    } else if (field->kind == AST_FIELD_SEED) {
        cfg->seed ^= UINT64_C(1) << 40;
    } else {
        int32_t value;
        memcpy(&value, member, sizeof value);
        value = value < (int32_t)field->maximum ? value + 1 : value - 1;
        memcpy(member, &value, sizeof value);
    }
    return ast_config_check(cfg, NULL) == AST_OK;
}

/* Each field by itself, starting from a configuration without a background and from one with: not every change goes with both. */
static void test_every_other_configuration_is_a_mismatch(void) {
    enum { MOST_FIELDS = 64 };
    int32_t count = 0, tried[MOST_FIELDS] = {0};
    const ast_config_field *fields = ast_config_fields(&count);
    TEST_ASSERT_TRUE(count <= MOST_FIELDS);
    for (int with_background = 0; with_background <= 1; with_background++) {
        ast_config cfg = small_config();
        cfg.basis = AST_BASIS_RAW; /* so that either model is legal */
        cfg.view = 64;
        cfg.background = with_background ? 16 : 0;
        ast_tracker *source = tracker_after(&cfg, 5);
        struct saved block = saved_from(source);
        for (int32_t f = 0; f < count; f++) {
            ast_config other = cfg;
            if (is_apart(&fields[f]) || !change_field(&other, &fields[f])) continue;
            ast_tracker *t = tracker_after(&other, 3);
            struct saved before = saved_from(t);
            TEST_ASSERT_EQUAL_INT_MESSAGE(AST_E_MISMATCH, ast_restore(t, block.bytes, block.size), fields[f].name);
            saved_check(&before, t, fields[f].name);
            saved_free(&before);
            ast_free(t);
            tried[f]++;
        }
        saved_free(&block);
        ast_free(source);
    }
    for (int32_t f = 0; f < count; f++) TEST_ASSERT_TRUE_MESSAGE(tried[f] > 0 || is_apart(&fields[f]), fields[f].name);
}

static void test_unknown_version_is_a_mismatch(void) {
    static const uint32_t versions[] = {0, 1, 2, 3, 5, 0x01000000u, 0xffffffffu};
    const ast_config cfg = smallest_config();
    ast_tracker *t = tracker_after(&cfg, 4);
    struct saved before = saved_from(t), block = saved_from(t);
    for (size_t v = 0; v < sizeof versions / sizeof versions[0]; v++) {
        put_word(block.bytes + VERSION_AT, versions[v]);
        sign(&block);
        TEST_ASSERT_EQUAL_INT(AST_E_MISMATCH, ast_restore(t, block.bytes, block.size));
        saved_check(&before, t, "unknown version");
    }
    saved_free(&before);
    saved_free(&block);
    ast_free(t);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_format_is_as_documented);
    RUN_TEST(test_restored_tracker_continues_bit_for_bit);
    RUN_TEST(test_restore_replaces_everything);
    RUN_TEST(test_every_saved_state_is_accepted);
    RUN_TEST(test_distances_are_gone_after_restore);
    RUN_TEST(test_state_moves_between_scorings);
    RUN_TEST(test_block_tells_the_state_only);
    RUN_TEST(test_save_writes_its_size_exactly);
    RUN_TEST(test_save_changes_nothing);
    RUN_TEST(test_save_and_restore_want_their_pointers);
    RUN_TEST(test_every_flipped_bit_is_rejected);
    RUN_TEST(test_altered_bytes_of_a_large_block_are_rejected);
    RUN_TEST(test_every_truncation_is_rejected);
    RUN_TEST(test_rejected_block_does_not_start);
    RUN_TEST(test_impossible_values_are_rejected);
    RUN_TEST(test_values_out_of_range_are_rejected);
    RUN_TEST(test_accepted_lies_do_no_harm);
    RUN_TEST(test_largest_accepted_vectors_do_no_harm);
    RUN_TEST(test_every_other_configuration_is_a_mismatch);
    RUN_TEST(test_unknown_version_is_a_mismatch);
    return UNITY_END();
}
