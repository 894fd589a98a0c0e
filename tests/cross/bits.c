/* Tracks the small scene with two presets and prints a hash of every bit of every result and of the saved states: two builds that
 * print the same compute the same. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "asttrack.h"
#include "small_scene.h"

enum { WIDTH = 160, HEIGHT = 120, FRAMES = 24 };

static uint64_t mix(uint64_t hash, uint32_t word) {
    for (int shift = 0; shift < 32; shift += 8) hash = (hash ^ (word >> shift & 255u)) * UINT64_C(1099511628211);
    return hash;
}

static uint64_t mix_float(uint64_t hash, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return mix(hash, bits);
}

static void give_up(const char *what, int code) {
    fprintf(stderr, "%s: %s\n", what, ast_strerror(code));
    exit(EXIT_FAILURE);
}

static ast_frame render(int32_t f) {
    static uint8_t pixels[HEIGHT][WIDTH];
    const ast_frame frame = {&pixels[0][0], WIDTH, HEIGHT, WIDTH};
    for (int32_t y = 0; y < HEIGHT; y++) small_scene_row(pixels[y], f, y, WIDTH, HEIGHT);
    return frame;
}

static void track(const ast_config *cfg, const char *name) {
    const ast_box box = small_scene_box(0, WIDTH, HEIGHT);
    ast_frame frame = render(0);
    ast_tracker *t = NULL;
    uint64_t hash = UINT64_C(14695981039346656037);
    int code = ast_init(&t, cfg, NULL, 0);
    if (code == AST_OK) code = ast_start(t, &frame, &box);
    if (code != AST_OK) give_up(name, code);
    for (int32_t f = 1; f <= FRAMES; f++) {
        ast_result r;
        frame = render(f);
        code = ast_step(t, &frame, &r);
        if (code != AST_OK) give_up(name, code);
        const float values[] = {r.box.x, r.box.y, r.box.w, r.box.h, r.scale, r.score, r.distance, r.effective_particles};
        for (size_t v = 0; v < sizeof values / sizeof values[0]; v++) hash = mix_float(hash, values[v]);
        hash = mix(mix(hash, (uint32_t)r.status), (uint32_t)r.best);
    }
    ast_particles p;
    code = ast_get_particles(t, &p);
    if (code != AST_OK) give_up(name, code);
    for (int32_t i = 0; i < p.scored * p.models; i++) hash = mix_float(hash, p.distance[i]);

    const size_t size = ast_save_size(cfg);
    unsigned char *block = malloc(size);
    if (block == NULL) give_up(name, AST_E_OUT_OF_MEMORY);
    code = ast_save(t, block, size);
    if (code != AST_OK) give_up(name, code);
    uint64_t saved = UINT64_C(14695981039346656037);
    for (size_t b = 0; b < size; b++) saved = (saved ^ block[b]) * UINT64_C(1099511628211);
    printf("%s %08lx%08lx %08lx%08lx\n", name, (unsigned long)(hash >> 32), (unsigned long)(hash & 0xffffffffu),
           (unsigned long)(saved >> 32), (unsigned long)(saved & 0xffffffffu));
    free(block);
    ast_free(t);
}

int main(void) {
    static const struct {
        const char *name;
        int preset, particles;
    } runs[] = {{"tiny", AST_PRESET_TINY, 100}, {"robust", AST_PRESET_ROBUST, 60}, {"literal", AST_PRESET_PAPER, 20}};
    for (size_t i = 0; i < sizeof runs / sizeof runs[0]; i++) {
        ast_config cfg;
        const int code = ast_config_preset(&cfg, runs[i].preset);
        if (code != AST_OK) give_up(runs[i].name, code);
        cfg.particles = runs[i].particles;
        if (i == 2) cfg.scoring = AST_SCORING_LITERAL;
        track(&cfg, runs[i].name);
    }
    return 0;
}
