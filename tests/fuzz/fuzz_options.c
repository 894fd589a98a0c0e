/* A hostile command line: the lines of the input are the arguments. Whatever is accepted is legal. */
#include <math.h>

#include "bytes.h"
#include "config_options.h"
#include "quiet.h"

enum { OPTION_BOX, OPTION_SIZE, OPTION_FRAMES, OPTION_FLAG };

static const option table[] = {
    {"--box", "X,Y,W,H", false, OPTION_BOX, "a box"},
    {"--size", "WxH", false, OPTION_SIZE, "a size"},
    {"--frames", "N", true, OPTION_FRAMES, "a number"},
    {"--flag", NULL, false, OPTION_FLAG, "a flag"},
    CONFIG_OPTION_ROWS,
    {NULL, NULL, false, 0, NULL},
};

static void take(config_options *options, int id, const char *value) {
    ast_box box;
    int32_t width, height;
    if (id == OPTION_FLAG) REQUIRE(value == NULL);
    if (id == OPTION_BOX && option_box("--box", value, &box)) {
        REQUIRE(isfinite(box.x) && isfinite(box.y) && isfinite(box.w) && isfinite(box.h) && box.w > 0.0f && box.h > 0.0f);
    }
    if (id == OPTION_SIZE && option_size("--size", value, 32, 4096, &width, &height)) {
        REQUIRE(width >= 32 && width <= 4096 && height >= 32 && height <= 4096);
    }
    if (id == OPTION_FRAMES && option_integer("--frames", value, -5, 100000, &width)) REQUIRE(width >= -5 && width <= 100000);
    (void)config_options_take(options, id, value);
}

/* Reads all of them, then builds the configuration that they ask for. */
static void read_arguments(int argc, char **argv) {
    option_reader reader;
    config_options options;
    ast_config config;
    const char *value;
    int id;
    option_start(&reader, argc, argv, table);
    REQUIRE(config_options_start(&options, argc));
    while ((id = option_next(&reader, &value)) >= 0 || id == OPTION_POSITIONAL) {
        REQUIRE(id != OPTION_POSITIONAL || value != NULL);
        if (id >= 0) take(&options, id, value);
    }
    if (id != OPTION_ERROR && config_options_build(&options, &config)) {
        REQUIRE(ast_config_check(&config, NULL) == AST_OK);
        REQUIRE(ast_mem_size(&config) > 0 && ast_save_size(&config) > 0 && ast_feature_length(&config) > 0);
    }
    config_options_free(&options);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    enum { MOST = 64 };
    char name[] = "asttrack", *argv[MOST + 1] = {name};
    int argc = 1;
    be_quiet();
    if (size > 4096) return -1;
    char *text = exactly(size + 1);
    memcpy(text, data, size);
    text[size] = '\0';
    for (char *at = text; argc < MOST && at != NULL; argc++) {
        char *end = memchr(at, '\n', (size_t)(text + size - at));
        argv[argc] = at;
        if (end != NULL) *end = '\0';
        at = end != NULL ? end + 1 : NULL;
    }
    argv[argc] = NULL;
    read_arguments(argc, argv);
    free(text);
    return 0;
}
