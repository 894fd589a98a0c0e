/* The options that make an ast_config: --preset, --set and --seed. Shared by the sub-commands that build a tracker. */
#ifndef CONFIG_OPTIONS_H
#define CONFIG_OPTIONS_H

#include "options.h"

/* Rows for the table of a sub-command; its own ids stay below CONFIG_OPTION_PRESET. */
enum { CONFIG_OPTION_PRESET = 1000, CONFIG_OPTION_SET, CONFIG_OPTION_SEED };
#define CONFIG_OPTION_ROWS                                                                                                         \
    {"--preset", "NAME", false, CONFIG_OPTION_PRESET, "paper, robust (the default), compact or tiny"},                             \
        {"--set", "FIELD=VALUE", true, CONFIG_OPTION_SET, "change a field of the preset; `asttrack config` lists the fields"}, {   \
        "--seed", "N", false, CONFIG_OPTION_SEED, "seed of the tracker's random generator"                                         \
    }

/* What has been read so far; config_options_start before the first. */
typedef struct config_options {
    const char *preset;
    const char *seed;
    const char **settings; /* "field=value", in order; room for every argument of the command line */
    int count;
    bool *seen; /* for each field of ast_config_fields: a setting has named it */
} config_options;

/* False when out of memory (reported). */
bool config_options_start(config_options *options, int argc);
void config_options_free(config_options *options);
/* Takes what option_next returned; false when the id is none of the above. */
bool config_options_take(config_options *options, int id, const char *value);
/* The preset, then the settings in order. False after reporting the setting that is wrong. */
bool config_options_build(const config_options *options, ast_config *config);

#endif
