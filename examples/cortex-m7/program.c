/* What a camera's firmware does with the library, and what it must survive: tracking on one block of memory, a reset in the middle,
 * and a sensor that fails. It runs on an emulated Cortex-M and on the host, and both must write the same lines, bit for bit; only
 * lines that begin with '#' may differ. */
#include <string.h>

#include "asttrack.h"
#include "board.h"
#include "camera.h"
#include "say.h"
#include "small_scene.h"

#ifndef FRAMES_OF_FAULT
#define FRAMES_OF_FAULT 60
#endif

enum {
    FRAMES_BEFORE_RESET = 40,
    FRAMES_AFTER_RESET = 20,
    FRAMES_TO_RECOVER = 60, /* at most */
    STUCK_AFTER = 3,        /* equal pictures in a row: a real sensor's noise never repeats */
    BUDGET = 60 * 1024,     /* bytes of the arena: it and 4 KiB of stack make 64 KiB */
    FAR = 10                /* pixels between the centres of box and truth beyond which the object is not followed */
};

static unsigned char arena[AST_MEM_SIZE_TINY];
/* On the microcontrollers that the budget is for: 32-bit addresses, single precision. */
typedef char arena_within_budget[sizeof(void *) > 4 || sizeof(AST_REAL) > sizeof(float) || sizeof arena <= BUDGET ? 1 : -1];

/* What survives a reset. */
struct record {
    uint32_t boots;
    uint32_t bits_after; /* of the results that follow the save */
    unsigned char block[BOARD_FLASH - 8];
};

static struct line line;
static int failures;

static void expect(int holds, const char *what) {
    say_text(&line, holds ? "ok " : "FAIL ");
    say_text(&line, what);
    say_end(&line);
    if (!holds) failures++;
}

static void say_code(const char *what, int code) {
    say_text(&line, what);
    say_text(&line, ": ");
    say_text(&line, ast_strerror(code));
    say_end(&line);
}

/* ---- Results ---- */

static uint32_t mix(uint32_t hash, const void *data, size_t size) {
    const unsigned char *bytes = data;
    for (size_t i = 0; i < size; i++) hash = (hash ^ bytes[i]) * 16777619u;
    return hash;
}

static uint32_t mix_word(uint32_t hash, uint32_t word) {
    for (int shift = 0; shift < 32; shift += 8) hash = (hash ^ (word >> shift & 255u)) * 16777619u;
    return hash;
}

static uint32_t bits_of(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* A hash of every bit of a result, the same for any order of bytes. */
static uint32_t mix_result(uint32_t hash, const ast_result *r) {
    const float values[] = {r->box.x, r->box.y, r->box.w, r->box.h, r->scale, r->score, r->distance, r->effective_particles};
    for (size_t v = 0; v < sizeof values / sizeof values[0]; v++) hash = mix_word(hash, bits_of(values[v]));
    hash = mix_word(hash, (uint32_t)r->status);
    hash = mix_word(hash, (uint32_t)r->best);
    return mix_word(hash, r->frame);
}

static int is_finite(const ast_result *r) {
    const float values[] = {r->box.x, r->box.y, r->box.w, r->box.h, r->scale, r->score, r->distance, r->effective_particles};
    for (size_t v = 0; v < sizeof values / sizeof values[0]; v++)
        if ((bits_of(values[v]) & 0x7f800000u) == 0x7f800000u) return 0;
    return 1;
}

static int is_near(const ast_box *box, int32_t scene_frame) {
    const ast_box truth = small_scene_box(scene_frame, CAMERA_WIDTH, CAMERA_HEIGHT);
    const float x = box->x + 0.5f * box->w - truth.x - 0.5f * truth.w, y = box->y + 0.5f * box->h - truth.y - 0.5f * truth.h;
    return x * x + y * y <= (float)(FAR * FAR);
}

static const char *status_name(int32_t status) {
    return status == AST_TRACKING ? "tracking" : status == AST_UNCERTAIN ? "uncertain" : "lost";
}

static void say_result(const ast_result *r) {
    const float values[] = {r->box.x, r->box.y, r->box.w, r->box.h, r->score};
    say_text(&line, "frame ");
    say_number(&line, (int32_t)r->frame);
    for (size_t v = 0; v < sizeof values / sizeof values[0]; v++) {
        say_text(&line, v == 4 ? " score " : v == 0 ? " box " : " ");
        say_hundredths(&line, values[v]);
    }
    say_text(&line, " ");
    say_text(&line, status_name(r->status));
    say_text(&line, " bits ");
    say_hex(&line, mix_result(2166136261u, r));
    say_end(&line);
}

/* ---- Tracking ---- */

/* Steps through the camera's next pictures and writes each result. Returns the hash of all; *far counts frames without the
 * object. */
static uint32_t follow(ast_tracker *t, int32_t first_scene_frame, int frames, int *far) {
    uint32_t hash = 2166136261u;
    for (int f = 0; f < frames; f++) {
        ast_frame frame;
        ast_result result;
        const int32_t lines = camera_take(&frame);
        const int code = ast_step(t, &frame, &result);
        if (lines != CAMERA_HEIGHT || code != AST_OK) {
            say_code("step", code);
            failures++;
            return hash;
        }
        if (!is_near(&result.box, first_scene_frame + f)) (*far)++;
        hash = mix_result(hash, &result);
        say_result(&result);
    }
    return hash;
}

/* ---- The sensor fails ---- */

/* Whether the pictures repeat. To a tracker a frozen picture is a scene at rest, which it would learn by heart; so the program
 * tells. */
struct monitor {
    uint32_t hash;
    int equal; /* pictures in a row that are the one before */
};

static int is_stuck(struct monitor *monitor, const ast_frame *frame) {
    uint32_t hash = 2166136261u;
    for (int32_t r = 0; r < frame->height; r++)
        hash = mix(hash, frame->pixels + (size_t)r * (size_t)frame->stride, (size_t)frame->width);
    monitor->equal = hash == monitor->hash ? monitor->equal + 1 : 0;
    monitor->hash = hash;
    return monitor->equal >= STUCK_AFTER;
}

/* The tracker itself must see through black and saturated pictures (monitor NULL). Pictures that a monitor says are stuck are kept
 * from it: there is no news in them, and nobody knows where the object is. */
static int step(ast_tracker *t, struct monitor *monitor, ast_result *result) {
    ast_frame frame;
    (void)camera_take(&frame);
    if (monitor != NULL && is_stuck(monitor, &frame)) {
        result->status = AST_LOST;
        return 1;
    }
    return ast_step(t, &frame, result) == AST_OK && is_finite(result);
}

static void survive(ast_tracker *t, enum camera_fault fault, const char *name, int32_t *scene_frame) {
    struct monitor frozen = {0, 0}, *monitor = fault == CAMERA_FROZEN ? &frozen : NULL;
    ast_result result = {0};
    int trusted = 0, sound = 1, back = 0;
    camera_break(fault);
    for (int f = 0; f < FRAMES_OF_FAULT; f++, (*scene_frame)++) {
        sound = step(t, monitor, &result) && sound;
        /* before, pictures from when the sensor was good are still to come, or nobody can know that they repeat */
        if (f > STUCK_AFTER + 1 && result.status == AST_TRACKING) trusted++;
    }
    say_text(&line, name);
    say_text(&line, " for ");
    say_number(&line, FRAMES_OF_FAULT);
    say_text(&line, " frames, then ");
    say_text(&line, status_name(result.status));
    camera_break(CAMERA_GOOD);
    for (int f = 0; f < FRAMES_TO_RECOVER && back < 3; f++, (*scene_frame)++) {
        sound = step(t, monitor, &result) && sound;
        back = result.status != AST_LOST && is_near(&result.box, *scene_frame) ? back + 1 : 0;
        if (back == 3) {
            say_text(&line, ", found again in frame ");
            say_number(&line, f + 1);
        }
    }
    say_end(&line);
    say_result(&result);
    expect(sound, "every result is a number");
    expect(trusted == 0, "no result of it is trusted");
    expect(back == 3, "the object is found again");
}

/* A picture whose transfer stopped is dropped; handed on with an impossible size, it is refused and nothing changes. */
static void survive_torn_frames(ast_tracker *t, int32_t *scene_frame) {
    ast_frame frame;
    ast_result before, after;
    int32_t torn = 0;
    camera_break(CAMERA_TORN);
    for (int f = 0; f < 3; f++, (*scene_frame)++) {
        if (camera_take(&frame) == CAMERA_HEIGHT) continue;
        torn++;
        ast_frame wrong = frame;
        wrong.stride = CAMERA_WIDTH - 1;
        memset(&before, 0x5a, sizeof before);
        after = before;
        int refused = ast_step(t, &wrong, &after) == AST_E_FRAME;
        wrong = frame;
        wrong.height = 0;
        refused = refused && ast_step(t, &wrong, &after) == AST_E_FRAME;
        wrong = frame;
        wrong.pixels = NULL;
        refused = refused && ast_step(t, &wrong, &after) == AST_E_NULL && memcmp(&before, &after, sizeof before) == 0;
        if (!refused) failures++;
    }
    camera_break(CAMERA_GOOD);
    say_text(&line, "torn pictures dropped: ");
    say_number(&line, torn);
    say_end(&line);
    int far = 0;
    (void)camera_take(&frame); /* torn: it was under way */
    (*scene_frame)++;
    (void)follow(t, *scene_frame, 10, &far);
    *scene_frame += 10;
    expect(torn == 2 && far == 0, "tracking goes on after torn pictures");
}

/* ---- The two lives ---- */

static ast_tracker *begin(const ast_config *cfg) {
    ast_tracker *t = NULL;
    const size_t needed = ast_mem_size(cfg);
    say_text(&line, "# arena: ");
    say_number(&line, (int32_t)needed);
    say_text(&line, " of ");
    say_number(&line, (int32_t)sizeof arena);
    say_text(&line, " bytes");
    say_end(&line);
    expect(needed > 0 && needed <= sizeof arena, "the arena suffices");
    expect(ast_init(&t, cfg, arena, needed - 1) == AST_E_ARENA && t == NULL, "an arena one byte short is refused");
    expect(ast_init(&t, cfg, NULL, 0) == AST_E_NO_HEAP && t == NULL, "there is no heap to fall back on");
    memset(arena, 0xa5, sizeof arena);
    const int code = ast_init(&t, cfg, arena, sizeof arena);
    if (code != AST_OK) say_code("init", code);
    return code == AST_OK ? t : NULL;
}

static void first_life(ast_tracker *t, struct record *record) {
    const ast_box box = small_scene_box(0, CAMERA_WIDTH, CAMERA_HEIGHT);
    ast_frame frame;
    int far = 0;
    camera_start(0);
    (void)camera_take(&frame);
    const int code = ast_start(t, &frame, &box);
    if (code != AST_OK) {
        say_code("start", code);
        failures++;
        return;
    }
    (void)follow(t, 1, FRAMES_BEFORE_RESET, &far);
    expect(far == 0, "the object is followed");

    ast_config cfg;
    const int known = ast_get_config(t, &cfg) == AST_OK;
    const size_t size = known ? ast_save_size(&cfg) : 0;
    expect(known && size <= sizeof record->block && ast_save(t, record->block, sizeof record->block) == AST_OK,
           "the state is saved");
    say_text(&line, "saved: ");
    say_number(&line, (int32_t)size);
    say_text(&line, " bytes, hash ");
    say_hex(&line, mix(2166136261u, record->block, size));
    say_end(&line);
    expect(ast_save(t, record->block, size - 1) == AST_E_BUFFER, "a buffer one byte short is refused");
    record->bits_after = follow(t, 1 + FRAMES_BEFORE_RESET, FRAMES_AFTER_RESET, &far);
}

static void second_life(ast_tracker *t, struct record *record) {
    int far = 0;
    int32_t scene_frame = 1 + FRAMES_BEFORE_RESET;
    record->block[100] ^= 1u;
    expect(ast_restore(t, record->block, sizeof record->block) != AST_OK, "a damaged state is refused");
    record->block[100] ^= 1u;
    expect(ast_restore(t, record->block, sizeof record->block) == AST_OK, "the state is restored");
    camera_start(scene_frame);
    expect(follow(t, scene_frame, FRAMES_AFTER_RESET, &far) == record->bits_after, "the restored tracker goes on bit for bit");
    expect(far == 0, "the object is followed");
    scene_frame += FRAMES_AFTER_RESET;
    survive_torn_frames(t, &scene_frame);
    survive(t, CAMERA_BLACK, "black", &scene_frame);
    survive(t, CAMERA_SATURATED, "saturated", &scene_frame);
    survive(t, CAMERA_FROZEN, "frozen", &scene_frame);
    expect(far == 0, "the object is followed");
}

int program(void) {
    struct record *record = (struct record *)(void *)board_flash();
    ast_config cfg;
    say_text(&line, "asttrack ");
    say_text(&line, ast_version());
    say_text(&line, ", life ");
    say_number(&line, (int32_t)record->boots + 1);
    say_end(&line);
    if (ast_config_preset(&cfg, AST_PRESET_TINY) != AST_OK) return 1;
    ast_tracker *t = begin(&cfg);
    if (t == NULL) return 1;
    if (record->boots == 0)
        first_life(t, record);
    else
        second_life(t, record);
    say_text(&line, "# stack: ");
    say_number(&line, (int32_t)board_stack_used());
    say_text(&line, " bytes");
    say_end(&line);
    if (failures == 0 && record->boots++ == 0) board_reset();
    say_text(&line, failures == 0 ? "all held" : "FAILED");
    say_end(&line);
    return failures != 0;
}
