#include "support_tracker.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "unity.h"

ast_config small_config(void) {
    ast_config cfg;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&cfg, AST_PRESET_PAPER));
    cfg.particles = AST_TILE + 8;
    cfg.patch_width = 8;
    cfg.patch_height = 8;
    cfg.bag_size = 3;
    cfg.bag_interval = 2;
    return cfg;
}

ast_config small_robust_config(void) {
    ast_config cfg;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&cfg, AST_PRESET_ROBUST));
    cfg.particles = AST_TILE + 8;
    cfg.shortlist = AST_TILE + 1;
    cfg.view = 64;
    cfg.gradient_cells = 4;
    cfg.patch_width = 8;
    cfg.patch_height = 8;
    cfg.bag_size = 3;
    cfg.bag_interval = 2;
    cfg.background = 16;
    cfg.background_refresh = 4;
    return cfg;
}

ast_config small_config_of(int which) {
    ast_config cfg = which == 2 ? small_robust_config() : small_config();
    if (which == 1) cfg.scoring = AST_SCORING_LITERAL;
    return cfg;
}

ast_tracker *tracker_new(const ast_config *cfg, const struct ast_linalg *la) {
    ast_tracker *t = NULL;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_init_backend(&t, cfg, la, NULL, 0));
    TEST_ASSERT_NOT_NULL(t);
    return t;
}

enum { GUARD = 256, GUARD_BYTE = 0xc3 };

void guarded_open(struct guarded *block, size_t size, size_t remainder, int fill) {
    block->allocation = malloc(size + 2 * GUARD + 2 * AST_ALIGNMENT);
    TEST_ASSERT_NOT_NULL(block->allocation);
    memset(block->allocation, GUARD_BYTE, size + 2 * GUARD + 2 * AST_ALIGNMENT);
    block->size = size;
    block->memory = ast_align(block->allocation + GUARD) + remainder;
    memset(block->memory, fill, size);
}

void guarded_check(const struct guarded *block) {
    TEST_ASSERT_EACH_EQUAL_HEX8_MESSAGE(GUARD_BYTE, block->memory - GUARD, GUARD, "before the block");
    TEST_ASSERT_EACH_EQUAL_HEX8_MESSAGE(GUARD_BYTE, block->memory + block->size, GUARD, "behind the block");
}

void guarded_close(struct guarded *block) {
    free(block->allocation);
}

struct saved saved_from(const ast_tracker *t) {
    struct saved saved;
    ast_config cfg;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_get_config(t, &cfg));
    saved.size = ast_save_size(&cfg);
    saved.bytes = malloc(saved.size);
    TEST_ASSERT_NOT_NULL(saved.bytes);
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_save(t, saved.bytes, saved.size));
    return saved;
}

void saved_check(const struct saved *saved, const ast_tracker *t, const char *what) {
    struct saved now = saved_from(t);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(saved->size, now.size, what);
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(saved->bytes, now.bytes, saved->size, what);
    saved_free(&now);
}

void saved_free(struct saved *saved) {
    free(saved->bytes);
}
