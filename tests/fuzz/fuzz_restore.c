/* Hostile saved states: bytes as they come, or edits of a good block with or without a checksum that fits. A block that is refused
 * leaves the tracker as it was; one that is accepted tracks on with numbers. */
#include "small.h"

enum { WIDTH = 24, HEIGHT = 20, CHECKSUM_BYTES = 8, MOST_BLOCK = 1 << 14 };

struct subject {
    ast_tracker *tracker;
    size_t size;
    uint8_t good[MOST_BLOCK]; /* a state with a full history and a full bag */
    uint8_t before[MOST_BLOCK], after[MOST_BLOCK];
};

static uint8_t pixels[WIDTH * HEIGHT];
static const ast_frame frame = {pixels, WIDTH, HEIGHT, WIDTH};

static struct subject *subject_of(int kind) {
    static struct subject subjects[SMALL_KINDS];
    struct subject *s = &subjects[kind];
    const ast_config cfg = small_kind(kind);
    const ast_box box = {8, 7, 9, 8};
    if (s->tracker != NULL) return s;
    for (int i = 0; i < WIDTH * HEIGHT; i++) pixels[i] = (uint8_t)(i * i / 5 + 3 * i);
    s->size = ast_save_size(&cfg);
    REQUIRE(s->size <= sizeof s->good);
    REQUIRE(ast_init(&s->tracker, &cfg, NULL, 0) == AST_OK && ast_start(s->tracker, &frame, &box) == AST_OK);
    for (int f = 0; f < 6; f++) REQUIRE(ast_step(s->tracker, &frame, NULL) == AST_OK);
    REQUIRE(ast_bag_count(s->tracker) == cfg.bag_size);
    REQUIRE(ast_save(s->tracker, s->good, s->size) == AST_OK);
    return s;
}

/* The documented one: 64-bit FNV-1a of all that precedes it, little-endian. */
static void sign(uint8_t *block, size_t size) {
    uint64_t hash = UINT64_C(14695981039346656037);
    if (size < CHECKSUM_BYTES) return;
    for (size_t i = 0; i < size - CHECKSUM_BYTES; i++) hash = (hash ^ block[i]) * UINT64_C(1099511628211);
    for (int i = 0; i < CHECKSUM_BYTES; i++) block[size - CHECKSUM_BYTES + (size_t)i] = (uint8_t)(hash >> (8 * i));
}

/* The block that the bytes describe, in memory of exactly its size. */
static uint8_t *block_of(const struct subject *s, struct bytes *b, unsigned how, size_t *size) {
    if ((how & 1) == 0) {
        *size = bytes_left(b);
        uint8_t *raw = exactly(*size);
        memcpy(raw, b->at, *size);
        return raw;
    }
    *size = s->size;
    if (how & 2) *size = bytes_u16(b) % (s->size + 1);
    uint8_t *block = exactly(*size);
    memcpy(block, s->good, *size);
    while (bytes_left(b) >= 6 && *size >= 4) { /* a word of the block is replaced */
        const size_t at = bytes_u16(b) % (*size - 3);
        const uint32_t word = bytes_u32(b);
        for (int i = 0; i < 4; i++) block[at + (size_t)i] = (uint8_t)(word >> (8 * i));
    }
    if (how & 4) sign(block, *size);
    return block;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct bytes b = {data, data + size};
    const unsigned how = bytes_u8(&b);
    struct subject *s = subject_of((int)(how >> 4) % SMALL_KINDS);
    size_t block_size;
    uint8_t *block = block_of(s, &b, how, &block_size);
    REQUIRE(ast_save(s->tracker, s->before, s->size) == AST_OK);
    const int code = ast_restore(s->tracker, block, block_size);
    REQUIRE(ast_save(s->tracker, s->after, s->size) == AST_OK);
    if (code == AST_OK) {
        ast_result result;
        REQUIRE(block_size >= s->size);
        for (int f = 0; f < 3; f++) {
            REQUIRE(ast_step(s->tracker, &frame, &result) == AST_OK);
            require_sane(s->tracker, &result);
        }
        REQUIRE(ast_restore(s->tracker, s->good, s->size) == AST_OK);
    } else {
        REQUIRE(code == AST_E_CORRUPT || code == AST_E_MISMATCH);
        REQUIRE(memcmp(s->before, s->after, s->size) == 0);
    }
    free(block);
    return 0;
}
