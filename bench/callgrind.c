#include "callgrind.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

enum { LINE = 4096, NAMES_MOST = 65536 };

/* Runs a command without output; its exit code, or -1. */
static int run(char *const *arguments) {
    int status = 0;
    const pid_t child = fork();
    if (child < 0) return -1;
    if (child == 0) {
        const int nowhere = open("/dev/null", O_RDWR);
        if (nowhere < 0 || dup2(nowhere, STDOUT_FILENO) < 0 || dup2(nowhere, STDERR_FILENO) < 0) _exit(126);
        (void)execvp(arguments[0], arguments);
        _exit(127);
    }
    if (waitpid(child, &status, 0) != child) return -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

bool callgrind_available(void) {
    char *const arguments[] = {"valgrind", "--version", NULL};
    return run(arguments) == 0;
}

bool callgrind_run(const char *program, const char *verb, const char *argument, const char *within, const char *profile) {
    char out[LINE], toggle[LINE];
    (void)snprintf(out, sizeof out, "--callgrind-out-file=%s", profile);
    (void)snprintf(toggle, sizeof toggle, "--toggle-collect=%s", within);
    char *const arguments[] = {"valgrind",      "--tool=callgrind", "--collect-atstart=no", toggle, out,
                               (char *)program, (char *)verb,       (char *)argument,       NULL};
    return run(arguments) == 0;
}

/* A name in a profile is "(12) name" where it comes first and "(12)" from then on. What a number stands for is remembered for the
 * functions asked for only: 1 + their index, 0 for all others. */
static void remember(int *meaning, const char *text, const struct callgrind_count *counts, int count, int *number) {
    char *end;
    *number = 0;
    if (text[0] != '(') return;
    const long value = strtol(text + 1, &end, 10);
    if (*end != ')' || value < 1 || value >= NAMES_MOST) return;
    *number = (int)value;
    if (end[1] != ' ') return;
    meaning[value] = 0;
    for (int i = 0; i < count; i++)
        if (strcmp(end + 2, counts[i].function) == 0) meaning[value] = 1 + i;
}

bool callgrind_read(FILE *profile, struct callgrind_count *counts, int count) {
    char line[LINE];
    bool events = false, call = false;
    int called = 0, number = 0;
    int *meaning = calloc(NAMES_MOST, sizeof *meaning);
    for (int i = 0; i < count; i++) counts[i].instructions = 0;
    while (meaning != NULL && fgets(line, sizeof line, profile) != NULL) {
        line[strcspn(line, "\n")] = '\0';
        if (strncmp(line, "events: Ir", 10) == 0) {
            events = true;
        } else if (strncmp(line, "fn=", 3) == 0) {
            remember(meaning, line + 3, counts, count, &number);
        } else if (strncmp(line, "cfn=", 4) == 0) {
            remember(meaning, line + 4, counts, count, &called);
        } else if (strncmp(line, "calls=", 6) == 0) {
            call = true; /* the next line is the caller's position and what the calls cost, callees included */
        } else if (call) {
            const char *cost = strchr(line, ' ');
            if (cost != NULL && meaning[called] > 0) counts[meaning[called] - 1].instructions += strtoull(cost + 1, NULL, 10);
            call = false;
        }
    }
    free(meaning);
    return events;
}
