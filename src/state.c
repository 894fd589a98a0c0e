/* Save and restore: the tracker's state as a block of bytes that is the same on every machine.
 *
 * One routine visits the state; a codec counts, writes, checks or reads what it visits, so the four cannot disagree. The block
 * holds a magic, the format's version, the configuration, the state with every slot of the rings, and a 64-bit FNV-1a of all that.
 * A block is checked completely, each value against its legal range, before the first byte of the tracker changes. */
#include "tracker.h"

#include <string.h>

#define FORMAT_VERSION 4u
#define SHARE_LIMIT 1.0001f /* of a weight or a likeness: 1 and its rounding */
#define POSITION_LIMIT 1e6f /* pixels: beyond any centre that a legal start or step can give */
#define VALUE_LIMIT 1e6f    /* beyond any element of a vector or a basis, which weights keep below 100; distances stay finite */

enum codec_mode { CODEC_COUNT, CODEC_WRITE, CODEC_CHECK, CODEC_READ };

struct codec {
    enum codec_mode mode;
    unsigned char *out;
    const unsigned char *in;
    size_t at;
    int bad; /* a value was out of range */
};

static void code_bytes(struct codec *c, uint64_t *value, int bytes) {
    if (c->mode == CODEC_WRITE) {
        for (int b = 0; b < bytes; b++) c->out[c->at + (size_t)b] = (unsigned char)(*value >> (8 * b));
    } else if (c->mode != CODEC_COUNT) {
        *value = 0;
        for (int b = 0; b < bytes; b++) *value |= (uint64_t)c->in[c->at + (size_t)b] << (8 * b);
    }
    c->at += (size_t)bytes;
}

static void code_u64(struct codec *c, uint64_t *value) {
    uint64_t bits = *value;
    code_bytes(c, &bits, 8);
    if (c->mode == CODEC_READ) *value = bits;
}

static void code_u32(struct codec *c, uint32_t *value) {
    uint64_t bits = *value;
    code_bytes(c, &bits, 4);
    if (c->mode == CODEC_READ) *value = (uint32_t)bits;
}

static void code_int(struct codec *c, int *value, int least, int most) {
    uint64_t bits = (uint64_t)*value;
    code_bytes(c, &bits, 4);
    if (c->mode == CODEC_CHECK && (bits > (uint64_t)most || (int)bits < least)) c->bad = 1;
    if (c->mode == CODEC_READ) *value = (int)bits;
}

/* The same for a type that is no int everywhere. */
static void code_int32(struct codec *c, int32_t *value, int32_t least, int32_t most) {
    int wide = (int)*value;
    code_int(c, &wide, (int)least, (int)most);
    *value = wide;
}

static void code_float(struct codec *c, float *value, float least, float most) {
    uint32_t word;
    memcpy(&word, value, sizeof word);
    uint64_t bits = word;
    code_bytes(c, &bits, 4);
    if (c->mode != CODEC_CHECK && c->mode != CODEC_READ) return;
    float decoded;
    word = (uint32_t)bits;
    memcpy(&decoded, &word, sizeof decoded);
    if (c->mode == CODEC_READ)
        *value = decoded;
    else if (!(decoded >= least && decoded <= most))
        c->bad = 1;
}

/* count floats; written as zeros when the slot is not in use, so that equal states give equal bytes. */
static void code_floats(struct codec *c, float *values, size_t count, float least, float most, int in_use) {
    for (size_t i = 0; i < count; i++) {
        float zero = 0.0f;
        code_float(c, c->mode == CODEC_WRITE && !in_use ? &zero : values + i, least, most);
    }
}

static void visit_state(struct codec *c, struct ast_tracker *t) {
    const size_t particles = (size_t)t->cloud.count, dim = (size_t)t->dim;
    const float limit = POSITION_LIMIT, value = VALUE_LIMIT;

    code_u32(c, &t->frame);
    code_u32(c, &t->since_model);
    code_float(c, &t->box_width, 1.0f, (float)AST_MAX_FRAME);
    code_float(c, &t->box_height, 1.0f, (float)AST_MAX_FRAME);
    code_float(c, &t->estimate.x, -limit, limit);
    code_float(c, &t->estimate.y, -limit, limit);
    code_float(c, &t->estimate.scale, t->cfg.scale_min, t->cfg.scale_max);
    code_float(c, &t->velocity_x, -limit, limit);
    code_float(c, &t->velocity_y, -limit, limit);
    code_u64(c, &t->random.state);
    code_int32(c, &t->confidence.status, AST_TRACKING, AST_LOST);
    code_int32(c, &t->confidence.low, 0, t->cfg.lost_after);

    code_float(c, &t->guard.usual.start, -SHARE_LIMIT, SHARE_LIMIT);
    code_float(c, &t->guard.usual.known, -SHARE_LIMIT, SHARE_LIMIT);
    code_float(c, &t->guard.lasting.start, -SHARE_LIMIT, SHARE_LIMIT);
    code_float(c, &t->guard.lasting.known, -SHARE_LIMIT, SHARE_LIMIT);
    code_float(c, &t->guard.steady, 0.0f, SHARE_LIMIT);
    code_int32(c, &t->guard.trusted, 0, AST_GUARD_LONG);
    code_int32(c, &t->guard.low, 0, AST_GUARD_LONG);
    code_int32(c, &t->guard.lost, 0, 1);
    code_float(c, &t->guard.good.x, -limit, limit);
    code_float(c, &t->guard.good.y, -limit, limit);
    code_float(c, &t->guard.good.scale, t->cfg.scale_min, t->cfg.scale_max);

    code_floats(c, t->cloud.x, particles, -limit, limit, 1);
    code_floats(c, t->cloud.y, particles, -limit, limit, 1);
    code_floats(c, t->cloud.scale, particles, t->cfg.scale_min, t->cfg.scale_max, 1);
    code_floats(c, t->cloud.weight, particles, 0.0f, SHARE_LIMIT, 1);

    code_int(c, &t->history.count, 1, t->history.capacity);
    code_int(c, &t->history.oldest, 0, t->history.capacity - 1);
    for (int slot = 0; slot < t->history.capacity; slot++)
        code_floats(c, t->history.patches + (size_t)slot * (size_t)t->history.stride, dim, -value, value, slot < t->history.count);

    code_int(c, &t->bag.count, 0, t->bag.capacity);
    code_int(c, &t->bag.oldest, t->bag.keep_first, t->bag.capacity - 1);
    for (int slot = 0; slot < t->bag.capacity; slot++) {
        const int in_use = slot < t->bag.count;
        int rank = in_use ? t->bag.rank[slot] : 0;
        code_int(c, &rank, 0, t->bag.n);
        if (c->mode == CODEC_READ) t->bag.rank[slot] = rank;
        code_floats(c, &t->bag.say[slot], 1, 0.0f, SHARE_LIMIT, in_use);
        for (int l = 0; l < t->bag.n; l++)
            code_floats(c, ast_bag_basis(&t->bag, slot) + (size_t)l * (size_t)t->stride, dim, -value, value, in_use);
        code_floats(c, ast_bag_mean(&t->bag, slot), dim, -value, value, in_use);
        if (c->mode == CODEC_READ) ast_bag_derive(&t->bag, slot);
    }
    code_floats(c, t->anchor, dim, -value, value, 1);
    for (int z = 0; z < t->background.size; z++)
        code_floats(c, t->background.set + (size_t)z * (size_t)t->stride, dim, -value, value, 1);
    if (t->background.size > 0) code_floats(c, t->background.mean, dim, -value, value, 1);
}

static const char magic[8] = {'A', 'S', 'T', 'S', 'T', 'A', 'T', 'E'};
enum { HEADER = 8 + 4, CHECKSUM = 8 };

/* The configuration, field by field: counted, written, or compared with the one saved (a difference is bad). How distances are
 * computed, and by how many threads, is no part of the state: their numbers are the same, so a block may move between them. */
static void visit_config(struct codec *c, const ast_config *cfg) {
    int32_t count;
    const ast_config_field *field = ast_config_fields(&count);
    for (int32_t f = 0; f < count; f++) {
        const unsigned char *member = (const unsigned char *)cfg + field[f].offset;
        uint64_t own = 0;
        uint32_t narrow = 0;
        const int bytes = field[f].kind == AST_FIELD_SEED ? 8 : 4;
        if (field[f].offset == offsetof(ast_config, scoring) || field[f].offset == offsetof(ast_config, threads)) continue;
        if (bytes == 8)
            memcpy(&own, member, sizeof own);
        else
            memcpy(&narrow, member, sizeof narrow);
        own |= narrow;
        uint64_t saved = own;
        code_bytes(c, &saved, bytes);
        if (saved != own) c->bad = 1;
    }
}

static uint64_t checksum(const unsigned char *bytes, size_t count) {
    uint64_t hash = UINT64_C(14695981039346656037);
    for (size_t i = 0; i < count; i++) hash = (hash ^ bytes[i]) * UINT64_C(1099511628211);
    return hash;
}

size_t ast_save_size(const ast_config *cfg) {
    if (ast_config_check(cfg, NULL) != AST_OK) return 0;
    const size_t dim = (size_t)ast_features_length(cfg), k = (size_t)cfg->bag_size;
    const size_t background = cfg->background > 0 ? (size_t)cfg->background + 1 : 0;
    const size_t scalars = 4 * 9 + 8 + 4 * 2 + 4 * 11 + 4 * 4 + 8 * k; /* what visit_state codes one by one */
    const size_t vectors = (size_t)cfg->history + k * ((size_t)cfg->basis_size + 1) + 1 + background;
    struct codec c = {.mode = CODEC_COUNT, .at = HEADER};
    visit_config(&c, cfg);
    return c.at + scalars + 4 * (4 * (size_t)cfg->particles + dim * vectors) + CHECKSUM;
}

int ast_save(const ast_tracker *t, void *buffer, size_t size) {
    if (t == NULL || buffer == NULL) return AST_E_NULL;
    if (!t->started) return AST_E_NOT_STARTED;
    const size_t total = ast_save_size(&t->cfg);
    if (size < total) return AST_E_BUFFER;

    struct ast_tracker view = *t; /* the visit takes a mutable tracker; writing changes nothing in it */
    struct codec c = {.mode = CODEC_WRITE, .out = (unsigned char *)buffer};
    uint32_t version = FORMAT_VERSION;
    memcpy(c.out, magic, sizeof magic);
    c.at = sizeof magic;
    code_u32(&c, &version);
    visit_config(&c, &t->cfg);
    visit_state(&c, &view);
    uint64_t hash = checksum(c.out, c.at);
    code_u64(&c, &hash);
    return AST_OK;
}

int ast_restore(ast_tracker *t, const void *buffer, size_t size) {
    if (t == NULL || buffer == NULL) return AST_E_NULL;
    const unsigned char *bytes = (const unsigned char *)buffer;
    if (size < HEADER + CHECKSUM || memcmp(bytes, magic, sizeof magic) != 0) return AST_E_CORRUPT;

    /* The configuration before the checksum: a block of another one has another length, so its checksum is somewhere else. */
    struct codec c = {.mode = CODEC_READ, .in = bytes, .at = sizeof magic};
    const size_t total = ast_save_size(&t->cfg);
    uint32_t version = 0;
    code_u32(&c, &version);
    if (version != FORMAT_VERSION) return AST_E_MISMATCH;
    struct codec count = {.mode = CODEC_COUNT, .at = HEADER};
    visit_config(&count, &t->cfg);
    if (size < count.at) return AST_E_CORRUPT;
    visit_config(&c, &t->cfg);
    if (c.bad) return AST_E_MISMATCH;
    if (size < total) return AST_E_CORRUPT;

    struct codec tail = {.mode = CODEC_READ, .in = bytes, .at = total - CHECKSUM};
    uint64_t hash = 0;
    code_u64(&tail, &hash);
    if (hash != checksum(bytes, total - CHECKSUM)) return AST_E_CORRUPT;

    struct codec check = c;
    check.mode = CODEC_CHECK;
    visit_state(&check, t);
    if (check.bad || check.at != total - CHECKSUM) return AST_E_CORRUPT;
    visit_state(&c, t);
    ast_bag_mark(&t->bag);
    t->started = 1;
    t->models = 0;
    return AST_OK;
}
