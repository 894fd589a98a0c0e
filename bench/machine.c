#include "machine.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>
#include <time.h>
#include <unistd.h>

#ifndef BENCH_FLAGS
#define BENCH_FLAGS "unknown"
#endif
#if defined(__clang__)
#define COMPILER "clang " __clang_version__
#elif defined(__GNUC__)
#define COMPILER "gcc " __VERSION__
#else
#define COMPILER "unknown"
#endif

/* The text behind the first line of /proc/cpuinfo that starts with one of these; false where there is none. */
static bool processor_line(char *name, size_t size) {
    static const char *const keys[] = {"model name", "Model", "Processor", "cpu model"};
    FILE *file = fopen("/proc/cpuinfo", "r");
    char line[MACHINE_TEXT];
    bool found = false;
    if (file == NULL) return false;
    while (!found && fgets(line, sizeof line, file) != NULL) {
        const char *colon = strchr(line, ':');
        for (size_t k = 0; k < sizeof keys / sizeof keys[0] && colon != NULL && !found; k++) {
            found = strncmp(line, keys[k], strlen(keys[k])) == 0;
            if (found) (void)snprintf(name, size, "%s", colon + 1 + strspn(colon + 1, " \t"));
        }
    }
    (void)fclose(file);
    name[strcspn(name, "\n")] = '\0';
    return found;
}

static double load_average(void) {
    FILE *file = fopen("/proc/loadavg", "r");
    char line[MACHINE_TEXT] = "", *end = line;
    if (file == NULL) return NAN;
    const bool read = fgets(line, sizeof line, file) != NULL;
    const double load = strtod(line, &end);
    (void)fclose(file);
    return read && end != line ? load : NAN;
}

struct machine machine_here(void) {
    struct machine m;
    struct utsname system;
    const time_t now = time(NULL);
    const struct tm *utc = gmtime(&now);
    memset(&m, 0, sizeof m);
    if (!processor_line(m.processor, sizeof m.processor))
        (void)snprintf(m.processor, sizeof m.processor, "%s", uname(&system) >= 0 ? system.machine : "unknown");
    (void)snprintf(m.compiler, sizeof m.compiler, "%s", COMPILER);
    (void)snprintf(m.flags, sizeof m.flags, "%s", BENCH_FLAGS);
    if (utc != NULL) (void)strftime(m.date, sizeof m.date, "%Y-%m-%dT%H:%M:%SZ", utc);
    m.cores = (int)sysconf(_SC_NPROCESSORS_ONLN);
    m.load = load_average();
    return m;
}

void machine_write(const struct machine *m, struct json *j) {
    json_text(j, "processor", m->processor);
    json_number(j, "cores", m->cores);
    json_number(j, "load", m->load);
    json_text(j, "compiler", m->compiler);
    json_text(j, "flags", m->flags);
    json_text(j, "date", m->date);
}
