/* Follows one object through binary PGM files: the smallest program on asttrack. Copy it, put your camera in place of read_pgm.
 *     minimal X Y WIDTH HEIGHT first.pgm second.pgm ... */
#include <asttrack.h>

#include <stdio.h>
#include <stdlib.h>

static uint8_t arena[2 * 1024 * 1024]; /* the tracker lives here; ast_mem_size tells how much of it is needed */
static uint8_t pixels[1920 * 1080];    /* one frame */

static int fail(const char *what, const char *why) {
    fprintf(stderr, "minimal: %s: %s\n", what, why);
    return 1;
}

static int read_pgm(const char *path, ast_frame *frame) {
    int width = 0, height = 0, white = 0;
    FILE *file = fopen(path, "rb");
    size_t size = 0, got = 0;
    if (file != NULL && fscanf(file, "P5 %5d %5d %5d", &width, &height, &white) == 3 && white == 255 && getc(file) != EOF &&
        width > 0 && height > 0) {
        size = (size_t)width * (size_t)height;
        got = size <= sizeof pixels ? fread(pixels, 1, size, file) : 0;
    }
    *frame = (ast_frame){pixels, width, height, width};
    return (file == NULL || fclose(file) == 0) && size > 0 && got == size;
}

static int read_box(char **words, ast_box *box) {
    float side[4];
    for (int i = 0; i < 4; ++i) {
        char *end;
        side[i] = strtof(words[i], &end);
        if (end == words[i] || *end != '\0') return 0;
    }
    *box = (ast_box){side[0], side[1], side[2], side[3]};
    return 1;
}

int main(int argc, char **argv) {
    ast_config config;
    ast_result result;
    ast_tracker *tracker = NULL;
    int code = ast_config_preset(&config, AST_PRESET_ROBUST);
    if (argc < 6 || !read_box(argv + 1, &result.box)) {
        fail("usage", "minimal X Y WIDTH HEIGHT first.pgm second.pgm ...");
        return 2;
    }
    if (code != AST_OK || (code = ast_init(&tracker, &config, arena, sizeof arena)) != AST_OK) {
        return fail("ast_init", ast_strerror(code));
    }
    for (int i = 5; i < argc; ++i) {
        ast_frame frame;
        if (!read_pgm(argv[i], &frame)) {
            return fail(argv[i], "not a binary PGM of 8 bits without comments, 1920 x 1080 at most");
        }
        code = i == 5 ? ast_start(tracker, &frame, &result.box) : ast_step(tracker, &frame, &result);
        if (code != AST_OK) {
            return fail(argv[i], ast_strerror(code));
        }
        printf("%s: %g,%g,%g,%g\n", argv[i], (double)result.box.x, (double)result.box.y, (double)result.box.w,
               (double)result.box.h);
    }
    ast_free(tracker);
    return fflush(stdout) == 0 ? 0 : fail("standard output", "cannot write");
}
