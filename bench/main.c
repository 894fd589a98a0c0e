/* asttrack-bench: how fast a step is, and why; `make bench` runs it. */
#include "bench.h"
#include "command.h"
#include "counting.h"
#include "image_jpeg.h"
#include "interrupt.h"
#include "machine.h"
#include "options.h"
#include "output_file.h"
#include "path.h"
#include "report.h"

#include <asttrack.h>

#include <stdlib.h>
#include <string.h>

/* A real sequence that is measured where it lies beside the checkout. */
static const char real_sequence[] = "../shared/sequences/girl";

enum { OPTION_QUICK, OPTION_ROUNDS, OPTION_FRAMES, OPTION_SEQUENCE, OPTION_OUT, OPTION_COMMIT };

static const option table[] = {
    {"--quick", NULL, false, OPTION_QUICK, "fewer values, frames and rounds: seconds instead of minutes, and rough figures"},
    {"--rounds", "N", false, OPTION_ROUNDS, "turns that every contender takes, 15 by default"},
    {"--frames", "N", false, OPTION_FRAMES, "frames that are tracked forth and back, 60 by default"},
    {"--sequence", "DIR", false, OPTION_SEQUENCE,
     "measure on it, too; by default, unless quick, on ../shared/sequences/girl where that is there"},
    {"--out", "FILE", false, OPTION_OUT, "write all figures as JSON"},
    {"--commit", "NAME", false, OPTION_COMMIT, "of the sources, for the record"},
    {NULL, NULL, false, 0, NULL},
};

static void print_help(void) {
    printf(
        "usage: asttrack-bench [options]\n"
        "Measures a step of the tracker: literal and gram scoring, linear-algebra backends, growth with the problem, the "
        "machine's\n"
        "roofline, threads, and instructions under callgrind; what is compared takes turns, and every figure is the median of the\n"
        "turns with the least and the greatest.\n\n");
    option_print(table);
    printf("\n`asttrack-bench count FILE` is what valgrind is given to count.\n");
}

struct arguments {
    bool quick;
    int32_t rounds, frames; /* 0: as quick says */
    const char *sequence, *out, *commit, *positional[2];
    int positionals;
};

/* False after reporting what is wrong with the value. */
static bool take(void *to, int id, const char *value) {
    struct arguments *a = to;
    switch (id) {
    case OPTION_QUICK: a->quick = true; return true;
    case OPTION_ROUNDS: return option_integer("--rounds", value, 1, ROUNDS_MOST, &a->rounds);
    case OPTION_FRAMES: return option_integer("--frames", value, 2, 1000, &a->frames);
    case OPTION_SEQUENCE: a->sequence = value; return true;
    case OPTION_OUT: a->out = value; return true;
    case OPTION_COMMIT: a->commit = value; return true;
    default: break; /* OPTION_POSITIONAL */
    }
    if (a->positionals == 2 || (a->positionals == 0 && strcmp(value, "count") != 0)) {
        report_error("%s: unknown argument (--help lists them)", value);
        return false;
    }
    a->positional[a->positionals++] = value;
    return true;
}

/* The synthetic scene, and a real sequence where there is one. */
static bool open_films(struct bench *b, const struct arguments *a, int32_t frames) {
    const bool given = a->sequence != NULL;
    const char *directory = given ? a->sequence : real_sequence;
    if (!film_render(&b->film[0], frames)) return false;
    b->films = 1;
    if (!given && a->quick) return true;
    if (!given && !path_is_directory(directory)) {
        printf("only the synthetic scene: there is no %s\n", directory);
        return true;
    }
    if (!given && !image_jpeg_available()) {
        printf("only the synthetic scene: %s needs JPEG, and this build has none\n", directory);
        return true;
    }
    if (!film_read(&b->film[1], directory, frames)) return false;
    b->films = 2;
    return true;
}

static void write_head(struct bench *b, const struct arguments *a, const struct machine *m, int argc, char **argv) {
    char command[1024] = "";
    for (int i = 0; i < argc; i++) {
        const size_t used = strlen(command);
        (void)snprintf(command + used, sizeof command - used, "%s%s", i > 0 ? " " : "", i > 0 ? argv[i] : path_base(argv[i]));
    }
    json_object(&b->json, "conditions");
    json_text(&b->json, "command", command);
    json_text(&b->json, "asttrack", ast_version());
    json_text(&b->json, "commit", a->commit);
    json_text(&b->json, "backend", ast_backend());
    machine_write(m, &b->json);
    json_bool(&b->json, "quick", a->quick);
    json_number(&b->json, "rounds", b->rounds);
    json_number(&b->json, "steps", b->steps);
    json_end(&b->json);
    printf("asttrack %s%s%s; %s, %d cores, load %.2f; %s, %s\n", ast_version(), a->commit != NULL ? ", commit " : "",
           a->commit != NULL ? a->commit : "", m->processor, m->cores, m->load, m->compiler, m->date);
}

static bool measure(struct bench *b) {
    for (int k = 0; k < BACKENDS; k++) {
        if (backends[k]->prepare() != 0) {
            report_error("%s: cannot be prepared", backends[k]->name);
            return false;
        }
    }
    return bench_ways(b) && bench_growth(b) && bench_roofline(b) && bench_threads(b) && bench_instructions(b);
}

/* The file is opened first: what cannot be written shows before the work is done. Without one the figures are only printed. */
static int run(const struct arguments *a, int argc, char **argv) {
    struct bench b;
    output_file out;
    FILE *nowhere = NULL;
    const struct machine m = machine_here();
    memset(&b, 0, sizeof b);
    memset(&out, 0, sizeof out);
    b.program = argv[0];
    b.quick = a->quick;
    b.rounds = a->rounds > 0 ? a->rounds : a->quick ? 3 : 15;
    b.steps = a->quick ? 2 : 4;
    if (a->out != NULL && !output_open(&out, a->out)) return EXIT_DATA;
    if (a->out == NULL) nowhere = fopen("/dev/null", "w");
    if (a->out == NULL && nowhere == NULL) {
        report_error("/dev/null: cannot write");
        return EXIT_DATA;
    }
    json_start(&b.json, a->out != NULL ? out.stream : nowhere);
    write_head(&b, a, &m, argc, argv);
    bool good = open_films(&b, a, a->frames > 0 ? a->frames : a->quick ? 20 : 60) && measure(&b);
    json_end(&b.json);
    report_progress_end();
    for (int i = 0; i < FILMS; i++) film_close(&b.film[i]);
    if (nowhere != NULL) (void)fclose(nowhere);
    if (good && a->out != NULL) good = output_commit(&out);
    output_discard(&out);
    if (good && a->out != NULL) printf("\nfigures: %s\n", a->out);
    return good ? EXIT_OK : EXIT_DATA;
}

int main(int argc, char **argv) {
    struct arguments a;
    memset(&a, 0, sizeof a);
    interrupt_install();
    (void)setvbuf(stdout, NULL, _IOLBF, BUFSIZ); /* tables appear as they are measured, in a pipe too */
    const int end = option_read(argc, argv, table, take, &a);
    int code = EXIT_OK;
    if (end == OPTION_HELP) {
        print_help();
    } else if (end == OPTION_ERROR) {
        code = EXIT_USAGE;
    } else if (a.positionals == 1) {
        report_error("count: no file given");
        code = EXIT_USAGE;
    } else if (a.positionals == 2) {
        code = counting_replay(a.positional[1]) ? EXIT_OK : EXIT_DATA;
    } else {
        code = run(&a, argc, argv);
    }
    interrupt_deliver();
    return code;
}
