/* The whole interface, driven by the bytes: which configuration, which frames, strides and boxes, which calls in which order, with
 * which mistakes. A call that fails leaves the state as it was, one that does not gives numbers in their ranges, and nothing
 * outside the memory that was handed over is touched. */
#include "small.h"

enum { MOST_CALLS = 24, MOST_FRAMES = 4, MOST_MEMORY = 1 << 18, MOST_COST = 1 << 16, MOST_SAVED = 1 << 18 };

/* ---- Configurations ---- */

/* Changes a field to a legal value, near the least of its range, or to any bits. */
static void change_field(ast_config *cfg, struct bytes *b) {
    int32_t count = 0;
    const ast_config_field *fields = ast_config_fields(&count);
    const ast_config_field *field = &fields[bytes_u8(b) % count];
    unsigned char *member = (unsigned char *)cfg + field->offset;
    const unsigned how = bytes_u8(b);
    if (field->kind == AST_FIELD_SEED) {
        cfg->seed = bytes_u32(b);
    } else if (how & 1) {
        const uint32_t word = bytes_u32(b);
        memcpy(member, &word, sizeof word);
    } else if (field->kind == AST_FIELD_FLOAT) {
        const float part = (float)bytes_u8(b) / 255.0f, value = field->minimum + part * part * (field->maximum - field->minimum);
        memcpy(member, &value, sizeof value);
    } else {
        const int32_t least = (int32_t)field->minimum, range = (int32_t)field->maximum - least;
        const int32_t value = least + (range < 64 ? bytes_u8(b) % (range + 1) : bytes_u8(b) % 64);
        memcpy(member, &value, sizeof value);
    }
}

/* What a step costs, roughly: nothing is found out by a slow one that a quick one does not show. */
static size_t cost_of(const ast_config *cfg) {
    return (size_t)cfg->particles * (size_t)ast_feature_length(cfg) * (size_t)(cfg->history + cfg->bag_size) +
           (size_t)cfg->view * (size_t)cfg->view;
}

/* A legal configuration that is small enough to run. */
static ast_config choose_config(struct bytes *b) {
    const ast_config start = small_kind(bytes_u8(b) % SMALL_KINDS);
    ast_config cfg = start;
    for (int changes = bytes_u8(b) % 8; changes > 0; changes--) change_field(&cfg, b);
    const char *field = NULL;
    const int code = ast_config_check(&cfg, &field);
    const size_t memory = ast_mem_size(&cfg), saved = ast_save_size(&cfg);
    REQUIRE((code == AST_OK) == (memory > 0) && (code == AST_OK) == (saved > 0) && (code == AST_OK) == (field == NULL));
    REQUIRE((code == AST_OK) == (ast_feature_length(&cfg) > 0));
    if (code != AST_OK) {
        ast_tracker *none = NULL;
        REQUIRE(ast_init(&none, &cfg, NULL, 0) == code && none == NULL);
        return start;
    }
    return memory <= MOST_MEMORY && saved <= MOST_SAVED && cost_of(&cfg) <= MOST_COST ? cfg : start;
}

/* ---- Frames and boxes ---- */

/* A frame whose pixels lie in memory of exactly the bytes that it may be read from, so without padding after the last row; or one
 * that must be refused. */
static ast_frame make_frame(struct bytes *b, uint8_t **memory) {
    const unsigned how = bytes_u8(b);
    ast_frame frame = {NULL, 1 + bytes_u8(b) % 48, 1 + bytes_u8(b) % 40, 0};
    if ((how & 0xf0) == 0xf0) frame.width = 4000;
    frame.stride = frame.width + (how & 4 ? bytes_u8(b) % 32 : 0);
    const size_t size = (size_t)(frame.height - 1) * (size_t)frame.stride + (size_t)frame.width;
    uint8_t *pixels = exactly(size);
    uint32_t word = bytes_u32(b) | 1;
    const unsigned shift = how & 8 ? 31 : 24; /* flat, or noise */
    for (size_t i = 0; i < size; i++) {
        word = word * 1664525u + 1013904223u;
        pixels[i] = (uint8_t)(word >> shift);
    }
    *memory = pixels;
    frame.pixels = pixels;
    if ((how & 3) == 3) { /* a mistake */
        const int32_t wrong = (int32_t)bytes_u32(b);
        switch (bytes_u8(b) % 5) {
        case 0: frame.pixels = NULL; break;
        case 1: frame.width = wrong < 1 || wrong > AST_MAX_FRAME ? wrong : -wrong; break;
        case 2: frame.height = wrong < 1 || wrong > AST_MAX_FRAME ? wrong : -wrong; break;
        case 3: frame.stride = wrong < frame.width ? wrong : -wrong; break;
        default: frame.height = 0;
        }
    }
    return frame;
}

static ast_box make_box(struct bytes *b, const ast_frame *frame) {
    if (bytes_u8(b) & 1) {
        const ast_box any = {bytes_float(b), bytes_float(b), bytes_float(b), bytes_float(b)};
        return any;
    }
    const ast_box near = {(float)bytes_u8(b) / 255.0f * (float)frame->width - 2.0f,
                          (float)bytes_u8(b) / 255.0f * (float)frame->height - 2.0f, 1.0f + (float)bytes_u8(b) / 8.0f,
                          1.0f + (float)bytes_u8(b) / 8.0f};
    return near;
}

/* ---- Calls ---- */

struct session {
    ast_config cfg;
    ast_tracker *tracker;
    size_t saved_size;
    uint8_t *kept; /* a state of this tracker or of none yet */
    int has_kept;
    uint8_t *before, *after;
};

static int is_started(const struct session *s) {
    return ast_history_count(s->tracker) >= 0;
}

static void require_unchanged(struct session *s) {
    REQUIRE(ast_save(s->tracker, s->after, s->saved_size) == AST_OK);
    REQUIRE(memcmp(s->before, s->after, s->saved_size) == 0);
}

static int call_start(struct session *s, struct bytes *b) {
    uint8_t *memory[MOST_FRAMES] = {NULL};
    ast_frame frames[MOST_FRAMES];
    ast_box boxes[MOST_FRAMES];
    const unsigned how = bytes_u8(b);
    const int count = how & 1 ? 1 : (int)(how >> 1) % MOST_FRAMES + 1;
    for (int f = 0; f < count; f++) {
        frames[f] = make_frame(b, &memory[f]);
        boxes[f] = make_box(b, &frames[f]);
    }
    const int32_t told = how >= 0xf8 ? -(int32_t)(how & 7) : count;
    const int code = how & 1 ? ast_start(s->tracker, &frames[0], &boxes[0]) : ast_start_sequence(s->tracker, frames, boxes, told);
    REQUIRE(code == AST_OK || code == AST_E_NULL || code == AST_E_FRAME || code == AST_E_BOX || code == AST_E_RANGE);
    if (code == AST_OK) REQUIRE(is_started(s));
    for (int f = 0; f < count; f++) free(memory[f]);
    return code;
}

static int call_step(struct session *s, struct bytes *b) {
    uint8_t *memory;
    ast_result result;
    const ast_frame frame = make_frame(b, &memory);
    const int started = is_started(s), steps = 1 + bytes_u8(b) % 3;
    int code = AST_OK;
    for (int i = 0; i < steps; i++) {
        code = ast_step(s->tracker, &frame, i == 1 ? NULL : &result);
        REQUIRE(started ? code == AST_OK || code == AST_E_NULL || code == AST_E_FRAME : code != AST_OK);
        if (code == AST_OK && i != 1) require_sane(s->tracker, &result);
    }
    free(memory);
    return code; /* of all of them: the frame is the same */
}

static int call_save(struct session *s, struct bytes *b) {
    const size_t size = bytes_u8(b) & 1 ? s->saved_size : bytes_u16(b);
    uint8_t *buffer = exactly(size);
    const int code = ast_save(s->tracker, buffer, size);
    REQUIRE(code == (!is_started(s) ? AST_E_NOT_STARTED : size < s->saved_size ? AST_E_BUFFER : AST_OK));
    if (code == AST_OK) {
        memcpy(s->kept, buffer, s->saved_size);
        s->has_kept = 1;
    }
    free(buffer);
    return code;
}

static int call_restore(struct session *s, struct bytes *b) {
    const unsigned how = bytes_u8(b);
    if (!s->has_kept) return AST_OK;
    uint8_t *block = exactly(s->saved_size);
    memcpy(block, s->kept, s->saved_size);
    size_t size = s->saved_size;
    if (how & 1) block[bytes_u16(b) % size] ^= (uint8_t)(1u << (how >> 5));
    if (how & 2) size -= 1u + bytes_u16(b) % (unsigned)size;
    const int code = ast_restore(s->tracker, block, size);
    REQUIRE(how & 3 ? code == AST_E_CORRUPT || code == AST_E_MISMATCH : code == AST_OK);
    free(block);
    return code;
}

static int call_look_inside(struct session *s, struct bytes *b) {
    const int32_t index = (int32_t)bytes_u8(b) - 8;
    const int32_t models = ast_bag_count(s->tracker), vectors = ast_history_count(s->tracker);
    ast_subspace model;
    ast_particles particles;
    ast_config cfg;
    const float *vector = NULL;
    REQUIRE(ast_get_config(s->tracker, &cfg) == AST_OK && memcmp(&cfg, &s->cfg, sizeof cfg) == 0);
    REQUIRE((ast_get_particles(s->tracker, &particles) == AST_OK) == (vectors >= 0));
    REQUIRE((ast_get_model(s->tracker, index, &model) == AST_OK) == (index >= 0 && index < models));
    REQUIRE((ast_get_history(s->tracker, index, &vector) == AST_OK) == (index >= 0 && index < vectors));
    if (vector != NULL)
        for (int32_t d = 0; d < ast_feature_length(&cfg); d++) REQUIRE(isfinite(vector[d]));
    return AST_OK;
}

/* Any numbers in any small shape. */
static int call_geometry(struct session *s, struct bytes *b) {
    const int32_t dim = (int32_t)(bytes_u8(b) % 40) - 1, count = (int32_t)(bytes_u8(b) % 18), n = (int32_t)(bytes_u8(b) % 10);
    const int32_t stride = dim + bytes_u8(b) % 4 - 1;
    const int kind = bytes_u8(b) % 3;
    const size_t work_size = ast_subspace_work_size(dim, count > n ? count : n), off = bytes_u8(b) % 64;
    (void)s;
    if (work_size == 0 || n < 1 || stride < 1) return AST_OK;
    float *images = exactly(sizeof(float) * ((size_t)(count > 0 ? count - 1 : 0) * (size_t)stride + (size_t)dim));
    float *mean = exactly(sizeof(float) * (size_t)dim), *basis = exactly(sizeof(float) * (size_t)dim * (size_t)n);
    unsigned char *work = exactly(work_size + off);
    ast_subspace fitted;
    ast_distance distance;
    const int wild = bytes_u8(b) & 1;
    for (int32_t j = 0; j < count; j++)
        for (int32_t d = 0; d < dim; d++) {
            const size_t at = (size_t)j * (size_t)stride + (size_t)d;
            images[at] = wild ? bytes_float(b) : (float)bytes_u8(b) / 255.0f;
        }
    const int code = ast_subspace_fit(images, dim, stride, count, kind, n, mean, basis, &fitted, work + off, work_size);
    if (code == AST_OK && !wild) {
        REQUIRE(ast_subspace_distance(&fitted, &fitted, 1.0f, &distance, work + off, work_size) == AST_OK);
        REQUIRE(isfinite(distance.distance) && distance.geodesic >= 0);
    } else if (code == AST_OK) { /* numbers or none, the distance says that it could or could not */
        const int compared = ast_subspace_distance(&fitted, &fitted, bytes_float(b), &distance, work + off, work_size);
        REQUIRE(compared == AST_OK || compared == AST_E_RANGE || compared == AST_E_BACKEND);
    }
    free(images);
    free(mean);
    free(basis);
    free(work);
    return AST_OK;
}

static int call_convert(struct session *s, struct bytes *b) {
    static int (*const conversions[])(uint8_t *, int32_t, const uint8_t *, int32_t, int32_t,
                                      int32_t) = {ast_grey_from_rgb, ast_grey_from_bgr, ast_grey_from_yuyv, ast_grey_from_rgb565};
    const int which = bytes_u8(b) % 4, bytes_each = which < 2 ? 3 : 2;
    const int32_t width = bytes_u8(b) % 20, height = bytes_u8(b) % 8;
    const int32_t to = width + bytes_u8(b) % 5 - 1, from = width * bytes_each + bytes_u8(b) % 5 - 1;
    (void)s;
    if (width == 0 || height == 0 || to < 1 || from < 1) {
        uint8_t byte = 0;
        REQUIRE(conversions[which](&byte, 1, &byte, bytes_each, width, 0) == AST_E_FRAME);
        return AST_OK;
    }
    uint8_t *dst = exactly((size_t)(height - 1) * (size_t)to + (size_t)width);
    uint8_t *src = exactly((size_t)(height - 1) * (size_t)from + (size_t)(width * bytes_each));
    memset(src, bytes_u8(b), (size_t)(height - 1) * (size_t)from + (size_t)(width * bytes_each));
    const int legal = to >= width && from >= width * bytes_each && (which != 2 || width % 2 == 0);
    REQUIRE(conversions[which](dst, to, src, from, width, height) == (legal ? AST_OK : AST_E_FRAME));
    free(dst);
    free(src);
    return AST_OK;
}

/* Any call; one that fails changes nothing. */
static void call_any(struct session *s, struct bytes *b) {
    static int (*const calls[])(struct session *, struct bytes *) = {
        call_start, call_step, call_step, call_step, call_save, call_restore, call_look_inside, call_geometry, call_convert};
    const int started = is_started(s);
    if (started) REQUIRE(ast_save(s->tracker, s->before, s->saved_size) == AST_OK);
    const int code = calls[bytes_u8(b) % (sizeof calls / sizeof calls[0])](s, b);
    if (code == AST_OK) return;
    REQUIRE(is_started(s) == started);
    if (started) require_unchanged(s);
}

static void require_null_is_refused(struct session *s) {
    const int started = is_started(s);
    ast_tracker *none = NULL;
    ast_result result;
    if (started) REQUIRE(ast_save(s->tracker, s->before, s->saved_size) == AST_OK);
    REQUIRE(ast_step(s->tracker, NULL, &result) == AST_E_NULL && ast_step(NULL, NULL, NULL) == AST_E_NULL);
    REQUIRE(ast_start(s->tracker, NULL, NULL) == AST_E_NULL && ast_restore(s->tracker, NULL, 0) == AST_E_NULL);
    REQUIRE(ast_save(s->tracker, NULL, 0) == AST_E_NULL && ast_get_particles(s->tracker, NULL) == AST_E_NULL);
    REQUIRE(ast_init(NULL, &s->cfg, NULL, 0) == AST_E_NULL && ast_init(&none, NULL, NULL, 0) == AST_E_NULL);
    if (!started) return;
    require_unchanged(s);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct bytes b = {data, data + size};
    struct session s = {choose_config(&b), NULL, 0, NULL, 0, NULL, NULL};
    const size_t memory = ast_mem_size(&s.cfg), off = bytes_u8(&b) % 64;
    unsigned char *block = exactly(memory + off);
    memset(block, 0xff, memory + off);
    REQUIRE(ast_init(&s.tracker, &s.cfg, block + off, memory - 1) == AST_E_ARENA && s.tracker == NULL);
    REQUIRE(ast_init(&s.tracker, &s.cfg, block + off, memory) == AST_OK);
    s.saved_size = ast_save_size(&s.cfg);
    s.kept = exactly(s.saved_size);
    s.before = exactly(s.saved_size);
    s.after = exactly(s.saved_size);
    for (int call = 0; call < MOST_CALLS && bytes_left(&b) > 0; call++) call_any(&s, &b);
    require_null_is_refused(&s);
    ast_free(s.tracker);
    free(s.kept);
    free(s.before);
    free(s.after);
    free(block);
    return 0;
}
