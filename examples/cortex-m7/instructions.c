/* Instructions that a frame takes, by configuration and frame size. */
#include "asttrack.h"
#include "board.h"
#include "say.h"
#include "small_scene.h"

enum { FRAMES = 16, MOST_WIDTH = 320, MOST_HEIGHT = 240 };

static unsigned char arena[2 * 1024 * 1024];
static uint8_t pixels[MOST_HEIGHT][MOST_WIDTH];

static ast_frame render(int32_t f, int32_t width, int32_t height) {
    const ast_frame frame = {&pixels[0][0], width, height, MOST_WIDTH};
    for (int32_t y = 0; y < height; y++) small_scene_row(pixels[y], f, y, width, height);
    return frame;
}

static int count(const ast_config *cfg, const char *name, int32_t width, int32_t height) {
    struct line line = {{0}, 0};
    const ast_box box = small_scene_box(0, width, height);
    ast_frame frame = render(0, width, height);
    ast_tracker *t = NULL;
    uint32_t most = 0, sum = 0;
    if (ast_init(&t, cfg, arena, sizeof arena) != AST_OK || ast_start(t, &frame, &box) != AST_OK) return 1;
    for (int32_t f = 1; f <= FRAMES; f++) {
        frame = render(f, width, height);
        (void)board_elapsed();
        if (ast_step(t, &frame, NULL) != AST_OK) return 1;
        const uint32_t taken = board_elapsed() / 1000u;
        sum += taken;
        if (taken > most) most = taken;
    }
    say_text(&line, name);
    say_text(&line, " ");
    say_number(&line, width);
    say_text(&line, "x");
    say_number(&line, height);
    say_text(&line, ": ");
    say_number(&line, (int32_t)(sum / FRAMES));
    say_text(&line, " thousand instructions a frame, at most ");
    say_number(&line, (int32_t)most);
    say_text(&line, "; arena ");
    say_number(&line, (int32_t)ast_mem_size(cfg));
    say_end(&line);
    return 0;
}

int program(void) {
    static const int32_t sizes[][2] = {{160, 120}, {320, 240}};
    ast_config tiny, robust, compact;
    if (ast_config_preset(&tiny, AST_PRESET_TINY) != AST_OK || ast_config_preset(&robust, AST_PRESET_ROBUST) != AST_OK) return 1;
    /* The robust preset in half a megabyte: the largest piece of RAM that an STM32H743 has. */
    compact = robust;
    compact.particles = 150;
    compact.view = 96;
    compact.view_object = 28;
    compact.patch_width = compact.patch_height = 12;
    compact.gradient_cells = 8;
    compact.bag_size = 10;
    compact.background = 32;
    compact.background_refresh = 4;
    int failed = 0;
    for (int s = 0; s < 2; s++) {
        failed |= count(&tiny, "tiny", sizes[s][0], sizes[s][1]);
        failed |= count(&compact, "robust, reduced", sizes[s][0], sizes[s][1]);
        failed |= count(&robust, "robust", sizes[s][0], sizes[s][1]);
    }
    return failed;
}
