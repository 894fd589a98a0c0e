#include "config_options.h"

#include "report.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool config_options_start(config_options *options, int argc) {
    int32_t fields = 0;
    (void)ast_config_fields(&fields);
    memset(options, 0, sizeof *options);
    options->settings = malloc(((size_t)argc + 1) * sizeof *options->settings);
    options->seen = calloc((size_t)fields, sizeof *options->seen);
    if (options->settings == NULL || options->seen == NULL) {
        config_options_free(options);
        report_error("out of memory");
        return false;
    }
    return true;
}

void config_options_free(config_options *options) {
    free(options->settings);
    free(options->seen);
    memset(options, 0, sizeof *options);
}

bool config_options_take(config_options *options, int id, const char *value) {
    switch (id) {
    case CONFIG_OPTION_PRESET: options->preset = value; return true;
    case CONFIG_OPTION_SET: options->settings[options->count++] = value; return true;
    case CONFIG_OPTION_SEED: options->seed = value; return true;
    default: return false;
    }
}

static bool load_preset(const char *name, ast_config *config) {
    static const struct {
        const char *name;
        int preset;
    } presets[] = {
        {"paper", AST_PRESET_PAPER}, {"robust", AST_PRESET_ROBUST}, {"compact", AST_PRESET_COMPACT}, {"tiny", AST_PRESET_TINY}};
    for (size_t i = 0; i < sizeof presets / sizeof presets[0]; ++i) {
        if (strcmp(name, presets[i].name) == 0) {
            const int code = ast_config_preset(config, presets[i].preset);
            if (code != AST_OK) {
                report_error("--preset %s: %s", name, ast_strerror(code));
            }
            return code == AST_OK;
        }
    }
    report_error("--preset %s: not a preset (paper, robust, compact, tiny)", name);
    return false;
}

/* The row of the field whose name is the first length characters of text, or -1. */
static int32_t find_field(const ast_config_field *fields, int32_t count, const char *text, size_t length) {
    for (int32_t i = 0; i < count; ++i) {
        if (strlen(fields[i].name) == length && memcmp(fields[i].name, text, length) == 0) return i;
    }
    return -1;
}

/* One line that lists the names an enumerated field takes. */
static bool fail_choice(const char *setting, const ast_config_field *field) {
    char names[256] = "";
    size_t used = 0;
    for (int32_t i = 0; i <= (int32_t)field->maximum; ++i) {
        const int more = snprintf(names + used, sizeof names - used, "%s%s", i > 0 ? ", " : "", field->choices[i]);
        if (more < 0 || (size_t)more >= sizeof names - used) break;
        used += (size_t)more;
    }
    report_error("--set %s: %s is one of %s", setting, field->name, names);
    return false;
}

static bool set_choice(const char *setting, const ast_config_field *field, const char *value, void *member) {
    for (int32_t i = 0; i <= (int32_t)field->maximum; ++i) {
        if (strcmp(value, field->choices[i]) == 0) {
            memcpy(member, &i, sizeof i);
            return true;
        }
    }
    return fail_choice(setting, field);
}

static bool set_integer(const char *setting, const ast_config_field *field, const char *value, void *member) {
    long number;
    const bool whole = option_parse_integer(&value, &number) && *value == '\0';
    if (!whole || (double)number < (double)field->minimum || (double)number > (double)field->maximum) {
        report_error("--set %s: %s is an integer from %g to %g", setting, field->name, (double)field->minimum,
                     (double)field->maximum);
        return false;
    }
    const int32_t stored = (int32_t)number;
    memcpy(member, &stored, sizeof stored);
    return true;
}

static bool set_real(const char *setting, const ast_config_field *field, const char *value, void *member) {
    double number = 0.0;
    const bool whole = option_parse_real(&value, &number) && *value == '\0';
    const float stored = (float)number;
    if (!whole || !(stored >= field->minimum && stored <= field->maximum)) {
        report_error("--set %s: %s is a number from %g to %g", setting, field->name, (double)field->minimum,
                     (double)field->maximum);
        return false;
    }
    memcpy(member, &stored, sizeof stored);
    return true;
}

static bool set_seed(const char *option_name, const char *value, void *member) {
    uint64_t stored;
    if (!option_seed(option_name, value, &stored)) return false;
    memcpy(member, &stored, sizeof stored);
    return true;
}

/* seen has a flag for each field of the table. */
static bool apply(const char *setting, const ast_config_field *fields, int32_t count, bool *seen, ast_config *config) {
    const size_t length = strcspn(setting, "=");
    if (setting[length] != '=') {
        report_error("--set %s: not FIELD=VALUE", setting);
        return false;
    }
    const int32_t row = find_field(fields, count, setting, length);
    if (row < 0) {
        report_error("--set %s: no such field (`asttrack config` lists them)", setting);
        return false;
    }
    if (seen[row]) {
        report_error("--set %s: %s is given more than once", setting, fields[row].name);
        return false;
    }
    seen[row] = true;
    const char *value = setting + length + 1;
    void *member = (unsigned char *)config + fields[row].offset;
    switch (fields[row].kind) {
    case AST_FIELD_INT: return set_integer(setting, &fields[row], value, member);
    case AST_FIELD_FLOAT: return set_real(setting, &fields[row], value, member);
    case AST_FIELD_ENUM: return set_choice(setting, &fields[row], value, member);
    default: return set_seed("--set seed", value, member);
    }
}

/* The rules that tie fields together are the library's. */
static bool check(const ast_config *config) {
    const char *field = NULL;
    const int code = ast_config_check(config, &field);
    if (code != AST_OK) {
        report_error("configuration: %s%s%s", field != NULL ? field : "", field != NULL ? ": " : "", ast_strerror(code));
    }
    return code == AST_OK;
}

bool config_options_build(const config_options *options, ast_config *config) {
    int32_t count = 0;
    const ast_config_field *fields = ast_config_fields(&count);
    if (!load_preset(options->preset != NULL ? options->preset : "robust", config)) return false;
    memset(options->seen, 0, (size_t)count * sizeof *options->seen);
    bool good = true;
    if (options->seed != NULL) {
        const int32_t row = find_field(fields, count, "seed", 4);
        good = set_seed("--seed", options->seed, &config->seed);
        if (row >= 0) {
            options->seen[row] = true;
        }
    }
    for (int i = 0; i < options->count && good; ++i) {
        good = apply(options->settings[i], fields, count, options->seen, config);
    }
    return good && check(config);
}
