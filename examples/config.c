/* The sub-command `config`: every field of a configuration with its value and its legal range, and the memory that it takes. */
#include "command.h"
#include "config_options.h"
#include "report.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static const option table[] = {CONFIG_OPTION_ROWS, {NULL, NULL, false, 0, NULL}};

static void print_help(void) {
    printf("usage: asttrack config [options]\n"
           "Prints every field of the configuration, its value and its range, and the bytes of memory that it takes.\n\n");
    option_print(table);
}

static void print_field(const ast_config_field *field, const ast_config *config) {
    const unsigned char *member = (const unsigned char *)config + field->offset;
    char value[40], range[200] = "";
    if (field->kind == AST_FIELD_FLOAT) {
        float stored;
        memcpy(&stored, member, sizeof stored);
        snprintf(value, sizeof value, "%g", (double)stored);
    } else if (field->kind == AST_FIELD_SEED) {
        uint64_t stored;
        memcpy(&stored, member, sizeof stored);
        snprintf(value, sizeof value, "%" PRIu64, stored);
        snprintf(range, sizeof range, "any");
    } else {
        int32_t stored;
        memcpy(&stored, member, sizeof stored);
        if (field->kind == AST_FIELD_ENUM) {
            size_t used = 0;
            snprintf(value, sizeof value, "%s", field->choices[stored]);
            for (int32_t i = 0; i <= (int32_t)field->maximum && used < sizeof range; ++i) {
                const int more = snprintf(range + used, sizeof range - used, "%s%s", i > 0 ? " | " : "", field->choices[i]);
                used += more > 0 ? (size_t)more : 0;
            }
        } else {
            snprintf(value, sizeof value, "%" PRId32, stored);
        }
    }
    if (range[0] == '\0') {
        snprintf(range, sizeof range, "%g .. %g", (double)field->minimum, (double)field->maximum);
    }
    printf("%-16s %-10s %s\n", field->name, value, range);
}

static void print_config(const ast_config *config) {
    int32_t count = 0;
    const ast_config_field *fields = ast_config_fields(&count);
    printf("%-16s %-10s %s\n", "field", "value", "range");
    for (int32_t i = 0; i < count; ++i) {
        print_field(&fields[i], config);
    }
    printf("\n%-16s %zu bytes, all of it, for any frame\n", "tracker", ast_mem_size(config));
    printf("%-16s %zu bytes\n", "saved state", ast_save_size(config));
}

static int run(option_reader *reader, config_options *options) {
    const char *value;
    for (;;) {
        const int id = option_next(reader, &value);
        if (id == OPTION_END) break;
        if (id == OPTION_HELP) {
            print_help();
            return EXIT_OK;
        }
        if (id == OPTION_ERROR) return EXIT_USAGE;
        if (!config_options_take(options, id, value)) {
            report_error("config %s: takes no arguments but options", value);
            return EXIT_USAGE;
        }
    }
    ast_config config;
    if (!config_options_build(options, &config)) return EXIT_USAGE;
    print_config(&config);
    return EXIT_OK;
}

int command_config(int argc, char **argv) {
    option_reader reader;
    config_options options;
    option_start(&reader, argc, argv, table);
    if (!config_options_start(&options, argc)) return EXIT_DATA;
    const int code = run(&reader, &options);
    config_options_free(&options);
    return code;
}
