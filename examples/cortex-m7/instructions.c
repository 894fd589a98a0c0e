/* Instructions that a frame takes, by configuration and frame size. */
#include "asttrack.h"
#include "board.h"
#include "say.h"
#include "small_scene.h"

enum { MOST_FRAMES = 100, COUNTED = 6, MOST_WIDTH = 320, MOST_HEIGHT = 240 };

static unsigned char arena[2 * 1024 * 1024];
static uint8_t pixels[MOST_HEIGHT][MOST_WIDTH];

static ast_frame render(int32_t f, int32_t width, int32_t height) {
    const ast_frame frame = {&pixels[0][0], width, height, MOST_WIDTH};
    for (int32_t y = 0; y < height; y++) small_scene_row(pixels[y], f, y, width, height);
    return frame;
}

/* Counts frames with a full bag: one that only compares, and one that makes a model too. */
static int count(const char *name, ast_config cfg, int32_t width, int32_t height) {
    struct line line = {{0}, 0};
    const ast_box box = small_scene_box(0, width, height);
    const int32_t interval = cfg.bag_interval;
    ast_frame frame = render(0, width, height);
    ast_tracker *t = NULL;
    uint32_t least = UINT32_MAX, most = 0;
    cfg.bag_interval = 2;
    if (ast_init(&t, &cfg, arena, sizeof arena) != AST_OK || ast_start(t, &frame, &box) != AST_OK) return 1;
    for (int32_t f = 1, counted = 0; counted < COUNTED; f++) {
        if (f > MOST_FRAMES) return 1;
        frame = render(f, width, height);
        (void)board_elapsed();
        if (ast_step(t, &frame, NULL) != AST_OK) return 1;
        const uint32_t taken = board_elapsed() / 1000u;
        if (ast_bag_count(t) < cfg.bag_size || counted++ == 0) continue;
        if (taken < least) least = taken;
        if (taken > most) most = taken;
    }
    say_text(&line, name);
    say_text(&line, " ");
    say_number(&line, width);
    say_text(&line, "x");
    say_number(&line, height);
    say_text(&line, ": ");
    say_number(&line, (int32_t)(least + (most - least) / (uint32_t)interval));
    say_text(&line, " thousand instructions a frame, ");
    say_number(&line, (int32_t)most);
    say_text(&line, " with a new model; arena ");
    say_number(&line, (int32_t)ast_mem_size(&cfg));
    say_end(&line);
    return 0;
}

int program(void) {
    static const int32_t sizes[][2] = {{160, 120}, {320, 240}};
    static const struct {
        const char *name;
        int preset;
    } counted[] = {{"tiny", AST_PRESET_TINY}, {"compact", AST_PRESET_COMPACT}, {"robust", AST_PRESET_ROBUST}};
    int failed = 0;
    for (int p = 0; p < 3; p++) {
        ast_config cfg;
        if (ast_config_preset(&cfg, counted[p].preset) != AST_OK) return 1;
        for (int s = 0; s < 2; s++) failed |= count(counted[p].name, cfg, sizes[s][0], sizes[s][1]);
    }
    return failed;
}
