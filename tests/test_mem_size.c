/* AST_MEM_SIZE: never below what ast_init needs, and not far above it. */
#include "asttrack.h"
#include "support_noise.h"
#include "tracker.h"
#include "unity.h"

void setUp(void) {
}
void tearDown(void) {
}

/* What it may be too large by: its bounds of the library's structs. */
enum { MOST_ABOVE_A_THREAD = 768 };

static size_t bound_of(const ast_config *c) {
    const int patch = c->patch_weight > 0.0f;
    return AST_MEM_SIZE(c->particles, c->shortlist, c->view, patch ? c->patch_width : 0, patch ? c->patch_height : 0,
                        c->gradient_weight > 0.0f ? c->gradient_cells : 0, c->history, c->basis_size, c->bag_size, c->background,
                        c->threads);
}

static void check(const ast_config *cfg, size_t bound) {
    const size_t needed = ast_mem_size_backend(cfg, &ast_linalg_builtin);
    TEST_ASSERT_GREATER_THAN_UINT(0, needed);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT(needed, bound);
    TEST_ASSERT_LESS_OR_EQUAL_UINT(needed + MOST_ABOVE_A_THREAD * (size_t)cfg->threads, bound);
}

/* As a program has them: an array's length is a constant expression, or this file does not compile. */
static unsigned char paper[AST_MEM_SIZE_PAPER], robust[AST_MEM_SIZE_ROBUST], tiny[AST_MEM_SIZE_TINY], compact[AST_MEM_SIZE_COMPACT];
enum { TINY_TWICE = 2 * AST_MEM_SIZE_TINY };

static void test_presets_fit_in_their_constants(void) {
    static const struct {
        int preset;
        unsigned char *block;
        size_t size;
    } presets[] = {{AST_PRESET_PAPER, paper, sizeof paper},
                   {AST_PRESET_ROBUST, robust, sizeof robust},
                   {AST_PRESET_TINY, tiny, sizeof tiny},
                   {AST_PRESET_COMPACT, compact, sizeof compact}};
    TEST_ASSERT_EQUAL_UINT(2 * sizeof tiny, TINY_TWICE);
    for (size_t p = 0; p < sizeof presets / sizeof presets[0]; p++) {
        ast_config cfg;
        ast_tracker *t = NULL;
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&cfg, presets[p].preset));
        TEST_ASSERT_EQUAL_UINT(bound_of(&cfg), presets[p].size);
        check(&cfg, presets[p].size);
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_init_backend(&t, &cfg, &ast_linalg_builtin, presets[p].block, presets[p].size));
        ast_free(t);
    }
}

static int32_t number(struct noise *noise, int least, int most) {
    return (int32_t)noise_int(noise, least, most);
}

/* Every field that memory depends on, anywhere in its range; half of them at a small value, as programs have. */
static ast_config random_config(struct noise *noise) {
    const int small = number(noise, 0, 1);
    ast_config cfg;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&cfg, AST_PRESET_PAPER));
    cfg.particles = number(noise, 1, small ? 200 : AST_MAX_PARTICLES);
    cfg.patch_width = number(noise, 4, small ? 16 : AST_MAX_PATCH);
    cfg.patch_height = number(noise, 4, small ? 16 : AST_MAX_PATCH);
    cfg.history = number(noise, 1, small ? 4 : AST_MAX_HISTORY);
    cfg.basis_size = number(noise, 1, cfg.history + 1 < AST_MAX_BASIS ? cfg.history + 1 : AST_MAX_BASIS);
    cfg.bag_size = number(noise, 1, small ? 6 : AST_MAX_BAG);
    cfg.view = number(noise, 0, 3) == 0 ? 0 : number(noise, 32, small ? 64 : AST_MAX_VIEW);
    cfg.gradient_cells = number(noise, 2, AST_MAX_CELLS);
    cfg.gradient_weight = cfg.view > 0 && number(noise, 0, 1) ? 1.0f : 0.0f;
    cfg.patch_weight = cfg.gradient_weight > 0.0f && number(noise, 0, 1) ? 0.0f : 1.0f;
    cfg.background = number(noise, 0, 1) ? 0 : number(noise, 8, small ? 24 : AST_MAX_BACKGROUND);
    cfg.background_refresh = 0;
    cfg.shortlist = cfg.background > 0 && number(noise, 0, 1)
                        ? number(noise, 1, 2 * cfg.particles < AST_MAX_PARTICLES ? 2 * cfg.particles : AST_MAX_PARTICLES)
                        : 0;
#ifndef AST_NO_THREADS
    cfg.threads = number(noise, 0, 3) ? 1 : number(noise, 1, AST_MAX_THREADS);
#endif
    return cfg;
}

static void test_any_configuration_fits(void) {
    struct noise noise = {71};
    for (int i = 0; i < 4000; i++) {
        const ast_config cfg = random_config(&noise);
        TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_check(&cfg, NULL));
        check(&cfg, bound_of(&cfg));
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_presets_fit_in_their_constants);
    RUN_TEST(test_any_configuration_fits);
    return UNITY_END();
}
