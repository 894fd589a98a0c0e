/* The sub-command `track`: reads its options and checks them before any work is done. */
#include "command.h"
#include "config_options.h"
#include "image_write.h"
#include "path.h"
#include "report.h"
#include "track_run.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { OPTION_BOX, OPTION_INIT_SEQUENCE, OPTION_CSV, OPTION_ANNOTATE, OPTION_SHEET };

static const option table[] = {
    {"--box", "X,Y,W,H", false, OPTION_BOX, "the object in the first frame, pixels, 0-based top-left"},
    {"--init-sequence", NULL, false, OPTION_INIT_SEQUENCE,
     "start on the ground truth of the first `history` frames, gaps interpolated"},
    CONFIG_OPTION_ROWS,
    {"--csv", "FILE", false, OPTION_CSV, "write the track: frame,x,y,w,h,scale,score,status"},
    {"--annotate", "OUTDIR", false, OPTION_ANNOTATE, "write each frame with box, particles and status drawn in"},
    {"--sheet", "FILE", false, OPTION_SHEET, "write a contact sheet (.ppm, .jpg) of 12 frames"},
    {NULL, NULL, false, 0, NULL},
};

static void print_help(void) {
    printf(
        "usage: asttrack track DIR|FILES... [options]\n"
        "Follows one object through DIR's numbered .pgm, .ppm, .jpg frames (or those of DIR/img) in natural order, 9.pgm before\n"
        "10.pgm, or through FILES in the order given. With groundtruth.txt or groundtruth_rect.txt in DIR, its first line is the\n"
        "default box and the track is compared with it. Ends with one line on stdout:\n"
        "  result name=NAME frames=N cle=PIXELS precision20=SHARE success=OVERLAP fps=RATE lost=N [skipped=N]\n"
        "cle: mean centre location error; precision20: share of frames with at most 20 pixels of it; success: mean overlap, the\n"
        "area under the success curve; fps: of the tracker's steps alone; skipped: frames that could not be read.\n\n");
    option_print(table);
}

typedef struct arguments {
    config_options config;
    const char *box; /* as given */
    bool init_sequence;
    const char *csv, *annotate, *sheet;
    char **inputs; /* the positional arguments */
    int input_count;
} arguments;

/* OPTION_END when all is read; OPTION_HELP or OPTION_ERROR otherwise. */
static int read_arguments(arguments *a, int argc, char **argv) {
    option_reader reader;
    option_start(&reader, argc, argv, table);
    for (;;) {
        const char *value;
        const int id = option_next(&reader, &value);
        switch (id) {
        case OPTION_END:
        case OPTION_HELP:
        case OPTION_ERROR: return id;
        case OPTION_POSITIONAL: a->inputs[a->input_count++] = argv[reader.next - 1]; break;
        case OPTION_BOX: a->box = value; break;
        case OPTION_INIT_SEQUENCE: a->init_sequence = true; break;
        case OPTION_CSV: a->csv = value; break;
        case OPTION_ANNOTATE: a->annotate = value; break;
        case OPTION_SHEET: a->sheet = value; break;
        default: (void)config_options_take(&a->config, id, value);
        }
    }
}

/* Whether an output would overwrite a file of the sequence. */
static bool spares_inputs(const char *name, const char *path, const sequence *s) {
    bool clash = path != NULL && s->truth_path != NULL && path_same(path, s->truth_path);
    for (int32_t i = 0; path != NULL && i < s->count && !clash; ++i) {
        clash = path_same(path, s->frames[i]);
    }
    if (clash) {
        report_error("%s %s: would overwrite a file of the sequence", name, path);
    }
    return !clash;
}

/* Pictures among the frames would overwrite them, or be taken for frames the next time: EXIT_OK where they would not. */
static int check_annotate_directory(const char *annotate_directory, const arguments *a, const sequence *s) {
    if (annotate_directory == NULL) return EXIT_OK;
    bool clash = path_same(annotate_directory, a->inputs[0]);
    for (int32_t i = 0; i < s->count && !clash; ++i) {
        char *directory = path_directory(s->frames[i]);
        if (directory == NULL) {
            report_error("out of memory");
            return EXIT_DATA;
        }
        clash = path_same(annotate_directory, directory);
        free(directory);
    }
    if (clash) {
        report_error("--annotate %s: is a directory of the sequence", annotate_directory);
    }
    return clash ? EXIT_USAGE : EXIT_OK;
}

static int run_on(const sequence *s, const arguments *a, const ast_config *config, const ast_box *box) {
    if (!spares_inputs("--csv", a->csv, s) || !spares_inputs("--sheet", a->sheet, s)) return EXIT_USAGE;
    const int code = check_annotate_directory(a->annotate, a, s);
    if (code != EXIT_OK) return code;
    if (s->truth_path == NULL && box == NULL) {
        report_error("%s: no groundtruth.txt: %s", a->inputs[0],
                     a->init_sequence ? "--init-sequence needs it" : "give the first box with --box x,y,w,h");
        return EXIT_USAGE;
    }
    const track_job job = {s, config, box, a->init_sequence, a->csv, a->annotate, a->sheet};
    return track_run(&job) ? EXIT_OK : EXIT_DATA;
}

static int run(arguments *a, int argc, char **argv) {
    ast_config config;
    ast_box box;
    const int end = read_arguments(a, argc, argv);
    if (end == OPTION_HELP) {
        print_help();
        return EXIT_OK;
    }
    if (end == OPTION_ERROR || !config_options_build(&a->config, &config) ||
        (a->box != NULL && !option_box("--box", a->box, &box)) || (a->sheet != NULL && !image_write_supports(a->sheet, 3))) {
        return EXIT_USAGE;
    }
    if (a->init_sequence && a->box != NULL) {
        report_error("--init-sequence: takes its boxes from the ground truth, not from --box");
        return EXIT_USAGE;
    }
    if (a->input_count == 0) {
        report_error("track: no directory or files given");
        return EXIT_USAGE;
    }
    sequence s;
    if (!sequence_open(&s, a->inputs, a->input_count)) return EXIT_DATA;
    const int code = run_on(&s, a, &config, a->box != NULL ? &box : NULL);
    sequence_close(&s);
    return code;
}

int command_track(int argc, char **argv) {
    arguments a;
    int code = EXIT_DATA;
    memset(&a, 0, sizeof a);
    a.inputs = malloc(((size_t)argc + 1) * sizeof *a.inputs);
    if (a.inputs == NULL) {
        report_error("out of memory");
    } else if (config_options_start(&a.config, argc)) {
        code = run(&a, argc, argv);
    }
    config_options_free(&a.config);
    free(a.inputs);
    return code;
}
