/* The configuration: presets, the table of fields, the check. */
#include "asttrack.h"

#include <float.h>
#include <string.h>

#include "workers.h"

#ifdef AST_NO_THREADS
enum { THREADS_MOST = 1 };
#else
enum { THREADS_MOST = AST_MAX_THREADS };
#endif

static const char *const normalisation_names[] = {"none", "mean", "unit", NULL};
static const char *const basis_names[] = {"centred", "raw", NULL};
static const char *const model_names[] = {"affine", "linear", NULL};
static const char *const draws_names[] = {"random", "quasi", NULL};
static const char *const likelihood_names[] = {"fixed", "scaled", NULL};
static const char *const vote_names[] = {"equal", "contrast", NULL};
static const char *const switch_names[] = {"no", "yes", NULL};
static const char *const scoring_names[] = {"gram", "literal", NULL};

#define OFFSET(name) (uint32_t) offsetof(ast_config, name)
#define INT(name, minimum, maximum)                                                                                                \
    { #name, NULL, OFFSET(name), AST_FIELD_INT, (float)(minimum), (float)(maximum) }
#define REAL(name, minimum, maximum)                                                                                               \
    { #name, NULL, OFFSET(name), AST_FIELD_FLOAT, minimum, maximum }
#define CHOICE(name, names)                                                                                                        \
    { #name, (names), OFFSET(name), AST_FIELD_ENUM, 0.0f, (float)(int)(sizeof(names) / sizeof((names)[0]) - 2) }

/* One row a field, in declaration order: the check, the saved state, the command's --set and the bindings all read this table. */
static const ast_config_field fields[] = {
    INT(particles, 1, AST_MAX_PARTICLES),
    INT(shortlist, 0, AST_MAX_PARTICLES),
    REAL(walk_x, 0.0f, 1000.0f),
    REAL(walk_y, 0.0f, 1000.0f),
    REAL(walk_scale, 0.0f, 1.0f),
    CHOICE(draws, draws_names),
    REAL(velocity, 0.0f, 1.0f),
    CHOICE(incumbent, switch_names),
    REAL(prior, 0.0f, 100.0f),
    REAL(scale_min, 0.01f, 1.0f),
    REAL(scale_max, 1.0f, 100.0f),
    INT(view, 0, AST_MAX_VIEW),
    INT(view_object, 8, AST_MAX_VIEW),
    REAL(patch_weight, 0.0f, 100.0f),
    REAL(gradient_weight, 0.0f, 100.0f),
    INT(gradient_cells, 2, AST_MAX_CELLS),
    INT(patch_width, 4, AST_MAX_PATCH),
    INT(patch_height, 4, AST_MAX_PATCH),
    CHOICE(normalisation, normalisation_names),
    INT(history, 1, AST_MAX_HISTORY),
    INT(basis_size, 1, AST_MAX_BASIS),
    CHOICE(basis, basis_names),
    CHOICE(model, model_names),
    INT(bag_size, 1, AST_MAX_BAG),
    INT(bag_interval, 1, 10000),
    CHOICE(keep_first, switch_names),
    INT(background, 0, AST_MAX_BACKGROUND),
    INT(background_refresh, 0, AST_MAX_BACKGROUND),
    REAL(ridge, 1e-4f, 1e6f),
    REAL(background_ratio, 0.0f, 10.0f),
    REAL(alpha, 0.0f, 1e6f),
    REAL(sigma, 1e-6f, 1e6f),
    CHOICE(likelihood, likelihood_names),
    CHOICE(vote, vote_names),
    CHOICE(scoring, scoring_names),
    REAL(guard, 0.0f, 1.0f),
    REAL(recall, 0.0f, 1.0f),
    REAL(reacquire, 0.0f, 1.0f),
    REAL(selective, 0.0f, 1.0f),
    REAL(score_uncertain, 0.0f, 1.0f),
    REAL(score_lost, 0.0f, 1.0f),
    INT(lost_after, 1, 10000),
    INT(threads, 1, THREADS_MOST),
    {"seed", NULL, OFFSET(seed), AST_FIELD_SEED, 0.0f, FLT_MAX},
};
enum { FIELD_COUNT = sizeof fields / sizeof fields[0] };

const ast_config_field *ast_config_fields(int32_t *count) {
    if (count == NULL) return NULL;
    *count = FIELD_COUNT;
    return fields;
}

/* The publication. N1, N2, n, k and W are published; the rest is the best faithful set found by search. */
static const ast_config paper = {
    .struct_size = sizeof(ast_config),
    .particles = 600,
    .shortlist = 0,
    .walk_x = 8.0f,
    .walk_y = 5.0f,
    .walk_scale = 0.01f,
    .draws = AST_DRAWS_RANDOM,
    .velocity = 0.0f,
    .incumbent = AST_NO,
    .prior = 0.0f,
    .scale_min = 0.3f,
    .scale_max = 4.0f,
    .view = 0,
    .view_object = 36,
    .patch_weight = 1.0f,
    .gradient_weight = 0.0f,
    .gradient_cells = 12,
    .patch_width = 32,
    .patch_height = 32,
    .normalisation = AST_NORMALISE_UNIT,
    .history = 3,
    .basis_size = 3,
    .basis = AST_BASIS_CENTRED,
    .model = AST_MODEL_AFFINE,
    .bag_size = 10,
    .bag_interval = 5,
    .keep_first = AST_NO,
    .background = 0,
    .background_refresh = 0,
    .ridge = 0.1f,
    .background_ratio = 0.0f,
    .alpha = 0.64f,
    .sigma = 0.01f,
    .likelihood = AST_LIKELIHOOD_FIXED,
    .vote = AST_VOTE_EQUAL,
    .scoring = AST_SCORING_GRAM,
    .guard = 0.0f,
    .recall = 0.75f,
    .reacquire = 0.65f,
    .selective = 0.0f,
    .score_uncertain = 0.5f,
    .score_lost = 0.3f,
    .lost_after = 3,
    .threads = 1,
    .seed = 1,
};

/* The paper's parts with richer ones in the places that it leaves open: oriented gradients beside the grey patch, a metric and a
 * likelihood ratio learned from the background, an even walk, and a longer memory. */
static const ast_config robust = {
    .struct_size = sizeof(ast_config),
    .particles = 350,
    .shortlist = 160,
    .walk_x = 8.0f,
    .walk_y = 8.0f,
    .walk_scale = 0.01f,
    .draws = AST_DRAWS_QUASI,
    .velocity = 0.5f,
    .incumbent = AST_YES,
    .prior = 0.5f,
    .scale_min = 0.3f,
    .scale_max = 4.0f,
    .view = 128,
    .view_object = 36,
    .patch_weight = 1.0f,
    .gradient_weight = 1.4f,
    .gradient_cells = 12,
    .patch_width = 16,
    .patch_height = 16,
    .normalisation = AST_NORMALISE_UNIT,
    .history = 3,
    .basis_size = 2,
    .basis = AST_BASIS_RAW,
    .model = AST_MODEL_AFFINE,
    .bag_size = 18,
    .bag_interval = 10,
    .keep_first = AST_YES,
    .background = 40,
    .background_refresh = 8,
    .ridge = 0.1f,
    .background_ratio = 1.0f,
    .alpha = 10.0f,
    .sigma = 0.13f,
    .likelihood = AST_LIKELIHOOD_SCALED,
    .vote = AST_VOTE_CONTRAST,
    .scoring = AST_SCORING_GRAM,
    .guard = 0.6f,
    .recall = 0.75f,
    .reacquire = 0.65f,
    .selective = 0.85f,
    .score_uncertain = 0.5f,
    .score_lost = 0.3f,
    .lost_after = 2,
    .threads = 1,
    .seed = 1,
};

int ast_config_preset(ast_config *cfg, int preset) {
    if (cfg == NULL) return AST_E_NULL;
    switch (preset) {
    /* Copied byte for byte: an assignment may leave the padding as it was. */
    case AST_PRESET_PAPER: memcpy(cfg, &paper, sizeof *cfg); return AST_OK;
    case AST_PRESET_ROBUST: memcpy(cfg, &robust, sizeof *cfg); return AST_OK;
    case AST_PRESET_TINY: /* grey patches alone, with the robust one's decisions: docs/firmware.md */
        memcpy(cfg, &robust, sizeof *cfg);
        cfg->particles = 92;
        cfg->shortlist = 0;
        cfg->walk_y = 3.0f;
        cfg->view = 48; /* patches from the whole frame would take most of the time */
        cfg->view_object = 16;
        cfg->gradient_weight = 0.0f;
        cfg->history = 2;
        cfg->basis_size = 1;
        cfg->bag_size = 5;
        cfg->background = 8;
        cfg->background_refresh = 2;
        cfg->ridge = 0.03f;
        cfg->sigma = 0.05f;
        cfg->recall = 0.85f;
        return AST_OK;
    case AST_PRESET_COMPACT: /* chosen by memory, time and accuracy: docs/firmware.md */
        memcpy(cfg, &robust, sizeof *cfg);
        cfg->particles = 200;
        cfg->shortlist = 48;
        cfg->sigma = 0.15f;
        cfg->view = 96;
        cfg->patch_width = 12;
        cfg->patch_height = 12;
        cfg->gradient_cells = 8;
        cfg->bag_size = 10;
        cfg->background = 32;
        cfg->background_refresh = 4;
        return AST_OK;
    default: return AST_E_RANGE;
    }
}

static int field_is_legal(const ast_config *cfg, const ast_config_field *field) {
    const unsigned char *member = (const unsigned char *)cfg + field->offset;
    if (field->kind == AST_FIELD_SEED) return 1;
    if (field->kind == AST_FIELD_FLOAT) {
        float value;
        memcpy(&value, member, sizeof value);
        return value >= field->minimum && value <= field->maximum; /* false for NaN */
    }
    int32_t value;
    memcpy(&value, member, sizeof value);
    return value >= (int32_t)field->minimum && value <= (int32_t)field->maximum;
}

int ast_config_check(const ast_config *cfg, const char **field) {
    const char *offender = NULL;
    if (field != NULL) *field = NULL;
    if (cfg == NULL) return AST_E_NULL;
    if (cfg->struct_size != sizeof(ast_config)) {
        if (field != NULL) *field = "struct_size";
        return AST_E_STRUCT_SIZE;
    }
    for (int f = 0; f < FIELD_COUNT && offender == NULL; f++)
        if (!field_is_legal(cfg, &fields[f])) offender = fields[f].name;
    if (offender == NULL && cfg->basis_size > cfg->history + 1) offender = "basis_size";
    if (offender == NULL && cfg->model == AST_MODEL_LINEAR && cfg->basis != AST_BASIS_RAW) offender = "basis";
    if (offender == NULL && cfg->view != 0 && cfg->view < 32) offender = "view";
    if (offender == NULL && !(cfg->patch_weight > 0.0f) && !(cfg->gradient_weight > 0.0f)) offender = "patch_weight";
    if (offender == NULL && cfg->gradient_weight > 0.0f && cfg->view == 0) offender = "view";
    if (offender == NULL && cfg->background != 0 && cfg->background < 8) offender = "background";
    if (offender == NULL && cfg->background_refresh > cfg->background) offender = "background_refresh";
    if (offender == NULL && cfg->background > 0 && cfg->model == AST_MODEL_LINEAR) offender = "model";
    if (offender == NULL && cfg->background > 0 && cfg->scoring != AST_SCORING_GRAM) offender = "scoring";
#ifdef AST_NO_GRADIENT
    if (offender == NULL && cfg->gradient_weight > 0.0f) offender = "gradient_weight";
#endif
#ifdef AST_NO_LITERAL
    if (offender == NULL && cfg->scoring == AST_SCORING_LITERAL) offender = "scoring";
#endif
    if (offender == NULL && cfg->shortlist > 0 && cfg->background == 0) offender = "shortlist";
    if (offender == NULL && cfg->score_lost > cfg->score_uncertain) offender = "score_lost";
    if (offender == NULL) return AST_OK;
    if (field != NULL) *field = offender;
    return AST_E_CONFIG;
}
