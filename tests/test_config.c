/* The configuration: the presets, the table of fields, and the check that names what is wrong. */
#include "asttrack.h"

#include <limits.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "unity.h"

static ast_config cfg;

void setUp(void) {
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&cfg, AST_PRESET_PAPER));
}
void tearDown(void) {
}

/* ---- Access to a field through its row ---- */

static const ast_config_field *row_of(const char *name) {
    int32_t count = 0;
    const ast_config_field *fields = ast_config_fields(&count);
    for (int32_t f = 0; f < count; f++)
        if (strcmp(fields[f].name, name) == 0) return &fields[f];
    TEST_FAIL_MESSAGE(name);
    return NULL;
}

static void set_int(ast_config *c, const ast_config_field *row, int32_t value) {
    memcpy((unsigned char *)c + row->offset, &value, sizeof value);
}

static void set_float(ast_config *c, const ast_config_field *row, float value) {
    memcpy((unsigned char *)c + row->offset, &value, sizeof value);
}

/* Values of the other fields with which a field may go to both its ends: some are tied to others by rules of their own. */
static void free_of_cross_rules(ast_config *c, const char *field) {
    const int alone = strcmp(field, "model") == 0 || strcmp(field, "scoring") == 0 || strcmp(field, "background") == 0;
    c->history = AST_MAX_HISTORY;
    c->basis_size = 1;
    c->basis = AST_BASIS_RAW;
    c->view = AST_MAX_VIEW;
    c->gradient_weight = strcmp(field, "view") == 0 ? 0.0f : 1.0f;
    c->background = alone ? 0 : AST_MAX_BACKGROUND;
    c->shortlist = 0;
    c->background_refresh = 0;
    c->score_uncertain = 1.0f;
    c->score_lost = 0.0f;
}

static void assert_accepted(const ast_config *c, const char *what) {
    const char *field = "untouched";
    TEST_ASSERT_EQUAL_INT_MESSAGE(AST_OK, ast_config_check(c, &field), what);
    TEST_ASSERT_NULL_MESSAGE(field, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(AST_OK, ast_config_check(c, NULL), what);
    TEST_ASSERT_TRUE_MESSAGE(ast_mem_size(c) > 0, what);
    TEST_ASSERT_TRUE_MESSAGE(ast_save_size(c) > 0, what);
}

static void assert_refused(const ast_config *c, const char *name) {
    const char *field = NULL;
    ast_tracker *t = NULL;
    TEST_ASSERT_EQUAL_INT_MESSAGE(AST_E_CONFIG, ast_config_check(c, &field), name);
    TEST_ASSERT_EQUAL_STRING(name, field);
    TEST_ASSERT_EQUAL_INT_MESSAGE(AST_E_CONFIG, ast_config_check(c, NULL), name);
    TEST_ASSERT_TRUE_MESSAGE(ast_mem_size(c) == 0, name);
    TEST_ASSERT_TRUE_MESSAGE(ast_save_size(c) == 0, name);
    TEST_ASSERT_EQUAL_INT_MESSAGE(AST_E_CONFIG, ast_init(&t, c, NULL, 0), name);
    TEST_ASSERT_NULL_MESSAGE(t, name);
}

/* ---- Presets ---- */

static void test_presets_are_valid_and_differ(void) {
    static const int presets[] = {AST_PRESET_PAPER, AST_PRESET_ROBUST, AST_PRESET_TINY, AST_PRESET_COMPACT};
    ast_config made[4];
    for (size_t p = 0; p < 4; p++) {
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&made[p], presets[p]));
        TEST_ASSERT_EQUAL_UINT32(sizeof(ast_config), made[p].struct_size);
        assert_accepted(&made[p], "preset");
    }
    TEST_ASSERT_TRUE(memcmp(&made[0], &made[1], sizeof made[0]) != 0);
    TEST_ASSERT_TRUE(memcmp(&made[0], &made[2], sizeof made[0]) != 0);
    TEST_ASSERT_TRUE(memcmp(&made[1], &made[3], sizeof made[0]) != 0);
    TEST_ASSERT_TRUE(ast_mem_size(&made[2]) < ast_mem_size(&made[0]) / 2);
    TEST_ASSERT_TRUE(ast_mem_size(&made[3]) < ast_mem_size(&made[1]) / 2);
}

static void test_paper_preset_has_the_published_values(void) {
    TEST_ASSERT_EQUAL_INT(32, cfg.patch_width);
    TEST_ASSERT_EQUAL_INT(32, cfg.patch_height);
    TEST_ASSERT_EQUAL_INT(3, cfg.basis_size);
    TEST_ASSERT_EQUAL_INT(10, cfg.bag_size);
    TEST_ASSERT_EQUAL_INT(5, cfg.bag_interval);
    TEST_ASSERT_EQUAL_INT(600, cfg.particles);
    TEST_ASSERT_EQUAL_INT(AST_MODEL_AFFINE, cfg.model);
}

/* Whatever was there: two fills of one preset agree in every field. */
static void test_preset_fills_everything(void) {
    static const int presets[] = {AST_PRESET_PAPER, AST_PRESET_ROBUST, AST_PRESET_TINY, AST_PRESET_COMPACT};
    for (size_t p = 0; p < 4; p++) {
        int32_t count = 0;
        const ast_config_field *fields = ast_config_fields(&count);
        ast_config zeros, sentinel;
        memset(&zeros, 0, sizeof zeros);
        memset(&sentinel, 0xa5, sizeof sentinel);
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&zeros, presets[p]));
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&sentinel, presets[p]));
        TEST_ASSERT_EQUAL_UINT32(zeros.struct_size, sentinel.struct_size);
        for (int32_t f = 0; f < count; f++)
            TEST_ASSERT_EQUAL_MEMORY_MESSAGE((char *)&zeros + fields[f].offset, (char *)&sentinel + fields[f].offset,
                                             fields[f].kind == AST_FIELD_SEED ? 8 : 4, fields[f].name);
    }
}

static void test_unknown_presets_are_refused(void) {
    static const int unknown[] = {-1, 4, 99, INT_MIN, INT_MAX};
    const ast_config before = cfg;
    for (size_t p = 0; p < sizeof unknown / sizeof unknown[0]; p++) {
        TEST_ASSERT_EQUAL_INT(AST_E_RANGE, ast_config_preset(&cfg, unknown[p]));
        TEST_ASSERT_EQUAL_MEMORY(&before, &cfg, sizeof cfg);
    }
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, ast_config_preset(NULL, AST_PRESET_PAPER));
}

/* ---- The table ---- */

/* Where a 64-bit number must lie: not on every machine where its size divides the address. */
struct aligned_seed {
    char before;
    uint64_t seed;
};

static void test_table_covers_the_struct_without_gaps(void) {
    int32_t count = 0;
    const ast_config_field *fields = ast_config_fields(&count);
    size_t end = sizeof cfg.struct_size;
    TEST_ASSERT_EQUAL_UINT32(0, offsetof(ast_config, struct_size));
    for (int32_t f = 0; f < count; f++) {
        const size_t size = fields[f].kind == AST_FIELD_SEED ? sizeof(uint64_t) : sizeof(int32_t);
        const size_t step = fields[f].kind == AST_FIELD_SEED ? offsetof(struct aligned_seed, seed) : size;
        const size_t aligned = (end + step - 1) / step * step;
        TEST_ASSERT_EQUAL_UINT_MESSAGE(aligned, fields[f].offset, fields[f].name);
        end = fields[f].offset + size;
    }
    TEST_ASSERT_EQUAL_UINT(sizeof(ast_config), end);
}

/* Each name with the offset of the member it names: a row cannot write into its neighbour. */
static void test_table_names_its_members(void) {
#define MEMBER(name, kind)                                                                                                         \
    { #name, offsetof(ast_config, name), kind }
    static const struct {
        const char *name;
        size_t offset;
        int kind;
    } members[] = {
        MEMBER(particles, AST_FIELD_INT),
        MEMBER(shortlist, AST_FIELD_INT),
        MEMBER(walk_x, AST_FIELD_FLOAT),
        MEMBER(walk_y, AST_FIELD_FLOAT),
        MEMBER(walk_scale, AST_FIELD_FLOAT),
        MEMBER(draws, AST_FIELD_ENUM),
        MEMBER(velocity, AST_FIELD_FLOAT),
        MEMBER(incumbent, AST_FIELD_ENUM),
        MEMBER(prior, AST_FIELD_FLOAT),
        MEMBER(scale_min, AST_FIELD_FLOAT),
        MEMBER(scale_max, AST_FIELD_FLOAT),
        MEMBER(view, AST_FIELD_INT),
        MEMBER(view_object, AST_FIELD_INT),
        MEMBER(patch_weight, AST_FIELD_FLOAT),
        MEMBER(gradient_weight, AST_FIELD_FLOAT),
        MEMBER(gradient_cells, AST_FIELD_INT),
        MEMBER(patch_width, AST_FIELD_INT),
        MEMBER(patch_height, AST_FIELD_INT),
        MEMBER(normalisation, AST_FIELD_ENUM),
        MEMBER(history, AST_FIELD_INT),
        MEMBER(basis_size, AST_FIELD_INT),
        MEMBER(basis, AST_FIELD_ENUM),
        MEMBER(model, AST_FIELD_ENUM),
        MEMBER(bag_size, AST_FIELD_INT),
        MEMBER(bag_interval, AST_FIELD_INT),
        MEMBER(keep_first, AST_FIELD_ENUM),
        MEMBER(background, AST_FIELD_INT),
        MEMBER(background_refresh, AST_FIELD_INT),
        MEMBER(ridge, AST_FIELD_FLOAT),
        MEMBER(background_ratio, AST_FIELD_FLOAT),
        MEMBER(alpha, AST_FIELD_FLOAT),
        MEMBER(sigma, AST_FIELD_FLOAT),
        MEMBER(likelihood, AST_FIELD_ENUM),
        MEMBER(vote, AST_FIELD_ENUM),
        MEMBER(scoring, AST_FIELD_ENUM),
        MEMBER(guard, AST_FIELD_FLOAT),
        MEMBER(recall, AST_FIELD_FLOAT),
        MEMBER(reacquire, AST_FIELD_FLOAT),
        MEMBER(selective, AST_FIELD_FLOAT),
        MEMBER(score_uncertain, AST_FIELD_FLOAT),
        MEMBER(score_lost, AST_FIELD_FLOAT),
        MEMBER(lost_after, AST_FIELD_INT),
        MEMBER(threads, AST_FIELD_INT),
        MEMBER(seed, AST_FIELD_SEED),
    };
#undef MEMBER
    int32_t count = 0;
    const ast_config_field *fields = ast_config_fields(&count);
    TEST_ASSERT_EQUAL_INT(sizeof members / sizeof members[0], count);
    for (int32_t f = 0; f < count; f++) {
        TEST_ASSERT_EQUAL_STRING(members[f].name, fields[f].name);
        TEST_ASSERT_EQUAL_UINT(members[f].offset, fields[f].offset);
        TEST_ASSERT_EQUAL_INT_MESSAGE(members[f].kind, fields[f].kind, fields[f].name);
    }
    TEST_ASSERT_NULL(ast_config_fields(NULL));
}

/* The names of an enumeration's values are those of its constants, in the order of their numbers. */
static void test_enumerations_have_a_name_for_each_value(void) {
    static const struct {
        const char *field, *name;
        int value;
    } values[] = {
        {"draws", "random", AST_DRAWS_RANDOM},
        {"draws", "quasi", AST_DRAWS_QUASI},
        {"incumbent", "no", AST_NO},
        {"incumbent", "yes", AST_YES},
        {"normalisation", "none", AST_NORMALISE_NONE},
        {"normalisation", "mean", AST_NORMALISE_MEAN},
        {"normalisation", "unit", AST_NORMALISE_UNIT},
        {"basis", "centred", AST_BASIS_CENTRED},
        {"basis", "raw", AST_BASIS_RAW},
        {"model", "affine", AST_MODEL_AFFINE},
        {"model", "linear", AST_MODEL_LINEAR},
        {"keep_first", "no", AST_NO},
        {"keep_first", "yes", AST_YES},
        {"likelihood", "fixed", AST_LIKELIHOOD_FIXED},
        {"likelihood", "scaled", AST_LIKELIHOOD_SCALED},
        {"vote", "equal", AST_VOTE_EQUAL},
        {"vote", "contrast", AST_VOTE_CONTRAST},
        {"scoring", "gram", AST_SCORING_GRAM},
        {"scoring", "literal", AST_SCORING_LITERAL},
    };
    int32_t count = 0;
    int named = 0;
    const ast_config_field *fields = ast_config_fields(&count);
    for (size_t v = 0; v < sizeof values / sizeof values[0]; v++) {
        const ast_config_field *row = row_of(values[v].field);
        TEST_ASSERT_EQUAL_STRING(values[v].name, row->choices[values[v].value]);
    }
    for (int32_t f = 0; f < count; f++) {
        TEST_ASSERT_TRUE_MESSAGE((fields[f].choices != NULL) == (fields[f].kind == AST_FIELD_ENUM), fields[f].name);
        if (fields[f].kind != AST_FIELD_ENUM) continue;
        TEST_ASSERT_TRUE_MESSAGE(fields[f].minimum == 0.0f, fields[f].name);
        for (int32_t v = 0; v <= (int32_t)fields[f].maximum; v++, named++) TEST_ASSERT_NOT_NULL(fields[f].choices[v]);
    }
    TEST_ASSERT_EQUAL_INT(sizeof values / sizeof values[0], named);
}

/* The limits that the header promises. */
static void test_limits_are_those_of_the_header(void) {
    static const struct {
        const char *name;
        float minimum, maximum;
    } limits[] = {
        {"particles", 1, AST_MAX_PARTICLES},
        {"shortlist", 0, AST_MAX_PARTICLES},
        {"walk_x", 0, 1000},
        {"walk_y", 0, 1000},
        {"walk_scale", 0, 1},
        {"velocity", 0, 1},
        {"prior", 0, 100},
        {"scale_min", 0.01f, 1},
        {"scale_max", 1, 100},
        {"view", 0, AST_MAX_VIEW},
        {"view_object", 8, AST_MAX_VIEW},
        {"patch_weight", 0, 100},
        {"gradient_weight", 0, 100},
        {"gradient_cells", 2, AST_MAX_CELLS},
        {"patch_width", 4, AST_MAX_PATCH},
        {"patch_height", 4, AST_MAX_PATCH},
        {"history", 1, AST_MAX_HISTORY},
        {"basis_size", 1, AST_MAX_BASIS},
        {"bag_size", 1, AST_MAX_BAG},
        {"bag_interval", 1, 10000},
        {"background", 0, AST_MAX_BACKGROUND},
        {"background_refresh", 0, AST_MAX_BACKGROUND},
        {"ridge", 1e-4f, 1e6f},
        {"background_ratio", 0, 10},
        {"alpha", 0, 1e6f},
        {"sigma", 1e-6f, 1e6f},
        {"guard", 0, 1},
        {"recall", 0, 1},
        {"reacquire", 0, 1},
        {"selective", 0, 1},
        {"score_uncertain", 0, 1},
        {"score_lost", 0, 1},
        {"lost_after", 1, 10000},
        {"threads", 1, AST_MAX_THREADS},
    };
    int32_t count = 0, ranged = 0;
    const ast_config_field *fields = ast_config_fields(&count);
    for (int32_t f = 0; f < count; f++) ranged += fields[f].kind == AST_FIELD_INT || fields[f].kind == AST_FIELD_FLOAT;
    TEST_ASSERT_EQUAL_INT(sizeof limits / sizeof limits[0], ranged);
    for (size_t l = 0; l < sizeof limits / sizeof limits[0]; l++) {
        const ast_config_field *row = row_of(limits[l].name);
        TEST_ASSERT_TRUE_MESSAGE(row->minimum == limits[l].minimum, limits[l].name);
        TEST_ASSERT_TRUE_MESSAGE(row->maximum == limits[l].maximum, limits[l].name);
    }
}

/* ---- The check ---- */

static void test_every_integer_at_and_beyond_its_limits(void) {
    int32_t count = 0;
    int tried = 0;
    const ast_config_field *fields = ast_config_fields(&count);
    for (int32_t f = 0; f < count; f++) {
        const ast_config_field *row = &fields[f];
        if (row->kind != AST_FIELD_INT && row->kind != AST_FIELD_ENUM) continue;
        const int32_t low = (int32_t)row->minimum, high = (int32_t)row->maximum;
        const int32_t refused[] = {low - 1, high + 1, -1, INT32_MIN, INT32_MAX};
        ast_config wide = cfg;
        free_of_cross_rules(&wide, row->name);
        for (size_t r = 0; r < sizeof refused / sizeof refused[0]; r++) {
            ast_config c = wide;
            set_int(&c, row, refused[r]);
            assert_refused(&c, row->name);
        }
        set_int(&wide, row, low);
        assert_accepted(&wide, row->name);
        set_int(&wide, row, high);
        assert_accepted(&wide, row->name);
        tried++;
    }
    TEST_ASSERT_TRUE(tried > 10);
}

static void test_every_float_at_and_beyond_its_limits(void) {
    int32_t count = 0;
    int tried = 0;
    const ast_config_field *fields = ast_config_fields(&count);
    for (int32_t f = 0; f < count; f++) {
        const ast_config_field *row = &fields[f];
        if (row->kind != AST_FIELD_FLOAT) continue;
        const float refused[] = {
            nextafterf(row->minimum, -INFINITY), nextafterf(row->maximum, INFINITY), NAN, -NAN, INFINITY, -INFINITY};
        ast_config wide = cfg;
        free_of_cross_rules(&wide, row->name);
        for (size_t r = 0; r < sizeof refused / sizeof refused[0]; r++) {
            ast_config c = wide;
            set_float(&c, row, refused[r]);
            assert_refused(&c, row->name);
        }
        set_float(&wide, row, row->minimum);
        assert_accepted(&wide, row->name);
        set_float(&wide, row, row->maximum);
        assert_accepted(&wide, row->name);
        tried++;
    }
    TEST_ASSERT_TRUE(tried > 8);
}

static void test_seed_may_be_anything(void) {
    static const uint64_t seeds[] = {0, 1, UINT64_C(0x7ff8000000000000), UINT64_MAX};
    for (size_t s = 0; s < sizeof seeds / sizeof seeds[0]; s++) {
        cfg.seed = seeds[s];
        assert_accepted(&cfg, "seed");
    }
}

static void test_first_offending_field_is_named(void) {
    cfg.lost_after = 0;
    assert_refused(&cfg, "lost_after");
    cfg.sigma = 0.0f;
    assert_refused(&cfg, "sigma");
    cfg.particles = 0;
    assert_refused(&cfg, "particles");
}

static void test_basis_needs_as_many_images(void) {
    for (int32_t history = 1; history <= AST_MAX_HISTORY; history++) {
        for (int32_t basis = 1; basis <= AST_MAX_BASIS; basis++) {
            cfg.history = history;
            cfg.basis_size = basis;
            if (basis <= history + 1)
                assert_accepted(&cfg, "basis_size");
            else
                assert_refused(&cfg, "basis_size");
        }
    }
}

static void test_linear_model_takes_the_raw_basis_only(void) {
    cfg.model = AST_MODEL_LINEAR;
    cfg.basis = AST_BASIS_CENTRED;
    assert_refused(&cfg, "basis");
    cfg.basis = AST_BASIS_RAW;
    assert_accepted(&cfg, "linear raw");
    cfg.model = AST_MODEL_AFFINE;
    assert_accepted(&cfg, "affine raw");
}

static void test_view_is_off_or_large_enough(void) {
    cfg.view = 0;
    assert_accepted(&cfg, "no view");
    for (int32_t side = 1; side < 32; side++) {
        cfg.view = side;
        assert_refused(&cfg, "view");
    }
    cfg.view = 32;
    assert_accepted(&cfg, "least view");
}

static void test_some_feature_is_needed(void) {
    cfg.view = 64;
    cfg.patch_weight = 0.0f;
    cfg.gradient_weight = 0.0f;
    assert_refused(&cfg, "patch_weight");
    cfg.gradient_weight = 1e-30f;
    assert_accepted(&cfg, "gradients alone");
    cfg.patch_weight = 1e-30f;
    cfg.gradient_weight = 0.0f;
    assert_accepted(&cfg, "patch alone");
}

static void test_gradients_need_a_view(void) {
    cfg.view = 0;
    cfg.gradient_weight = 1.0f;
    assert_refused(&cfg, "view");
    cfg.view = 64;
    assert_accepted(&cfg, "with a view");
}

static void test_background_is_off_or_large_enough(void) {
    for (int32_t vectors = 1; vectors < 8; vectors++) {
        cfg.background = vectors;
        assert_refused(&cfg, "background");
    }
    cfg.background = 8;
    assert_accepted(&cfg, "least background");
    cfg.background_refresh = 8;
    assert_accepted(&cfg, "all of it");
    cfg.background_refresh = 9;
    assert_refused(&cfg, "background_refresh");
    cfg.background = 0;
    cfg.background_refresh = 1;
    assert_refused(&cfg, "background_refresh");
}

static void test_background_goes_with_means_and_gram_scoring(void) {
    cfg.background = 16;
    cfg.basis = AST_BASIS_RAW;
    cfg.model = AST_MODEL_LINEAR;
    assert_refused(&cfg, "model");
    cfg.model = AST_MODEL_AFFINE;
    cfg.scoring = AST_SCORING_LITERAL;
    assert_refused(&cfg, "scoring");
    cfg.scoring = AST_SCORING_GRAM;
    assert_accepted(&cfg, "affine, gram");
}

/* What it goes by is the likelihood ratio against the background. */
static void test_a_shortlist_needs_a_background(void) {
    TEST_ASSERT_EQUAL_INT(0, cfg.background);
    cfg.shortlist = 1;
    assert_refused(&cfg, "shortlist");
    cfg.shortlist = cfg.particles; /* one that leaves nobody out, too: nothing hangs on the number of particles */
    assert_refused(&cfg, "shortlist");
    cfg.background = 8;
    assert_accepted(&cfg, "with a background");
    cfg.shortlist = AST_MAX_PARTICLES;
    assert_accepted(&cfg, "longer than the cloud");
    cfg.background = 0;
    cfg.shortlist = 0;
    assert_accepted(&cfg, "neither");
}

static void test_lost_is_not_above_uncertain(void) {
    cfg.score_uncertain = 0.25f;
    cfg.score_lost = 0.25f;
    assert_accepted(&cfg, "equal");
    cfg.score_lost = nextafterf(0.25f, 1.0f);
    assert_refused(&cfg, "score_lost");
}

static void test_struct_size_is_checked_first(void) {
    static const uint32_t sizes[] = {0, 4, sizeof(ast_config) - 8, sizeof(ast_config) - 1, sizeof(ast_config) + 1, UINT32_MAX};
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) {
        const char *field = NULL;
        ast_tracker *t = NULL;
        cfg.struct_size = sizes[s];
        cfg.particles = -5; /* of a struct of unknown layout no field may be judged */
        TEST_ASSERT_EQUAL_INT(AST_E_STRUCT_SIZE, ast_config_check(&cfg, &field));
        TEST_ASSERT_EQUAL_STRING("struct_size", field);
        TEST_ASSERT_EQUAL_INT(AST_E_STRUCT_SIZE, ast_config_check(&cfg, NULL));
        TEST_ASSERT_EQUAL_INT(AST_E_STRUCT_SIZE, ast_init(&t, &cfg, NULL, 0));
        TEST_ASSERT_NULL(t);
        TEST_ASSERT_TRUE(ast_mem_size(&cfg) == 0);
        TEST_ASSERT_TRUE(ast_save_size(&cfg) == 0);
    }
}

static void test_null_is_refused(void) {
    const char *field = "untouched";
    ast_tracker *t = NULL;
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, ast_config_check(NULL, &field));
    TEST_ASSERT_NULL(field);
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, ast_config_check(NULL, NULL));
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, ast_init(&t, NULL, NULL, 0));
    TEST_ASSERT_EQUAL_INT(AST_E_NULL, ast_init(NULL, &cfg, NULL, 0));
    TEST_ASSERT_TRUE(ast_mem_size(NULL) == 0);
    TEST_ASSERT_TRUE(ast_save_size(NULL) == 0);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_presets_are_valid_and_differ);
    RUN_TEST(test_paper_preset_has_the_published_values);
    RUN_TEST(test_preset_fills_everything);
    RUN_TEST(test_unknown_presets_are_refused);
    RUN_TEST(test_table_covers_the_struct_without_gaps);
    RUN_TEST(test_table_names_its_members);
    RUN_TEST(test_enumerations_have_a_name_for_each_value);
    RUN_TEST(test_limits_are_those_of_the_header);
    RUN_TEST(test_every_integer_at_and_beyond_its_limits);
    RUN_TEST(test_every_float_at_and_beyond_its_limits);
    RUN_TEST(test_seed_may_be_anything);
    RUN_TEST(test_first_offending_field_is_named);
    RUN_TEST(test_basis_needs_as_many_images);
    RUN_TEST(test_linear_model_takes_the_raw_basis_only);
    RUN_TEST(test_view_is_off_or_large_enough);
    RUN_TEST(test_some_feature_is_needed);
    RUN_TEST(test_gradients_need_a_view);
    RUN_TEST(test_background_is_off_or_large_enough);
    RUN_TEST(test_background_goes_with_means_and_gram_scoring);
    RUN_TEST(test_a_shortlist_needs_a_background);
    RUN_TEST(test_lost_is_not_above_uncertain);
    RUN_TEST(test_struct_size_is_checked_first);
    RUN_TEST(test_null_is_refused);
    return UNITY_END();
}
