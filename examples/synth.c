/* The sub-command `synth`: writes a rendered scene as a sequence that `track` reads. */
#include "command.h"
#include "image_write.h"
#include "interrupt.h"
#include "options.h"
#include "output_file.h"
#include "path.h"
#include "report.h"
#include "scene.h"
#include "sequence.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { OPTION_FRAMES, OPTION_SIZE, OPTION_SEED, OPTION_OCCLUSION, OPTION_LEAVE, OPTION_CUT, OPTION_ALONE };

static const option table[] = {
    {"--frames", "N", false, OPTION_FRAMES, "frames to render, 200 by default"},
    {"--size", "WxH", false, OPTION_SIZE, "of the frames, 320x240 by default; everything scales with it"},
    {"--seed", "S", false, OPTION_SEED, "another scene, 1 by default"},
    {"--occlusion", "FRAMES", false, OPTION_OCCLUSION, "how long the target is fully hidden, 3 by default (truth goes on)"},
    {"--leave", "FRAMES", false, OPTION_LEAVE, "how long the target is out of view, 0 by default (truth nan)"},
    {"--cut", "FRAMES", false, OPTION_CUT, "how long another scene is shown, 0 by default (truth nan)"},
    {"--alone", NULL, false, OPTION_ALONE, "without the look-alike"},
    {NULL, NULL, false, 0, NULL},
};

static void print_help(void) {
    printf("usage: asttrack synth OUTDIR [options]\n"
           "Renders a sequence with known truth: OUTDIR/img/00001.pgm and on, OUTDIR/groundtruth.txt, and OUTDIR/absence.label\n"
           "with a line a frame: 1 where nothing of the target is in view, 0 elsewhere. The target drifts and darts, grows and\n"
           "shrinks, is hidden in part and fully, goes through a change of light and meets a look-alike.\n"
           "The same options give the same frames; fewer than 200 of them are the beginning of the same sequence.\n\n");
    option_print(table);
}

typedef struct arguments {
    scene_options scene;
    bool events; /* one of --occlusion, --leave, --cut is given */
    const char *directory;
} arguments;

/* False after reporting what is wrong with the value. */
static bool take(void *to, int id, const char *value) {
    arguments *a = to;
    scene_options *o = &a->scene;
    a->events = a->events || id == OPTION_OCCLUSION || id == OPTION_LEAVE || id == OPTION_CUT;
    switch (id) {
    case OPTION_FRAMES: return option_integer("--frames", value, 1, SCENE_MAX_FRAMES, &o->frames);
    case OPTION_SIZE: return option_size("--size", value, SCENE_MIN_SIDE, SCENE_MAX_SIDE, &o->width, &o->height);
    case OPTION_SEED: return option_seed("--seed", value, &o->seed);
    case OPTION_OCCLUSION: return option_integer("--occlusion", value, 0, SCENE_MAX_FRAMES, &o->occlusion);
    case OPTION_LEAVE: return option_integer("--leave", value, 0, SCENE_MAX_FRAMES, &o->leave);
    case OPTION_ALONE: o->alone = true; return true;
    case OPTION_CUT: return option_integer("--cut", value, 0, SCENE_MAX_FRAMES, &o->cut);
    default: break; /* OPTION_POSITIONAL */
    }
    if (a->directory != NULL) {
        report_error("%s: synth takes one directory", value);
        return false;
    }
    a->directory = value;
    return true;
}

static bool check_arguments(const arguments *a) {
    if (a->directory == NULL) {
        report_error("synth: no directory given");
        return false;
    }
    const int32_t needed = scene_frames_needed(&a->scene);
    if (a->events && a->scene.frames < needed) {
        report_error("--frames %d: the events asked for are over at frame %d only", (int)a->scene.frames, (int)needed);
        return false;
    }
    return true;
}

#define NAME_SIZE 16
static void frame_name(char name[NAME_SIZE], int32_t number) {
    snprintf(name, NAME_SIZE, "%05d.pgm", (int)number);
}

/* Frames of an earlier, longer scene would become part of this one: they are not ours to remove, so they are an error. */
static bool has_no_strangers(const char *directory, int32_t frames) {
    char **names;
    int32_t count;
    if (!sequence_list(directory, &names, &count)) return false;
    bool good = true;
    for (int32_t i = 0; i < count && good; ++i) {
        char name[NAME_SIZE];
        const long number = strtol(names[i], NULL, 10);
        good = number >= 1 && number <= frames;
        if (good) {
            frame_name(name, (int32_t)number);
            good = strcmp(name, names[i]) == 0;
        }
        if (!good) {
            report_error("%s: holds %s, which is no frame of this scene: remove it or choose another directory", directory,
                         names[i]);
        }
    }
    sequence_free_names(names, count);
    return good;
}

static bool render_one(const scene *s, int32_t index, const char *directory, image *grey, output_file *truth,
                       output_file *absence) {
    ast_box box;
    scene_presence presence;
    char name[NAME_SIZE];
    frame_name(name, index + 1);
    char *path = path_join(directory, name);
    bool good = path != NULL && scene_render(s, index, grey, &box, &presence);
    if (!good) {
        report_error("%s: out of memory", directory);
    } else {
        good = image_write(path, grey);
        truth_write_line(truth, presence == SCENE_AWAY ? NULL : &box);
        output_print(absence, "%d\n", presence == SCENE_IN_VIEW ? 0 : 1);
    }
    free(path);
    return good;
}

static bool render_all(const scene *s, int32_t frames, const char *directory, output_file *truth, output_file *absence) {
    image grey;
    bool good = true;
    memset(&grey, 0, sizeof grey);
    for (int32_t i = 0; i < frames && good; ++i) {
        if (interrupt_pending()) {
            report_error("interrupted before frame %d of %d", (int)i + 1, (int)frames);
            good = false;
        } else {
            good = render_one(s, i, directory, &grey, truth, absence);
            report_progress("synth", i + 1, frames, "");
        }
    }
    report_progress_end();
    image_free(&grey);
    return good;
}

/* The ground truth appears last: a directory that has it is complete. */
static bool write_sequence(const scene *s, int32_t frames, const char *image_directory, const char *truth_path,
                           const char *absence_path) {
    output_file truth, absence;
    if (!output_open(&truth, truth_path)) return false;
    if (!output_open(&absence, absence_path)) {
        output_discard(&truth);
        return false;
    }
    if (!render_all(s, frames, image_directory, &truth, &absence) || !output_commit(&absence)) {
        output_discard(&absence);
        output_discard(&truth);
        return false;
    }
    return output_commit(&truth);
}

static bool synthesise(const scene_options *o, const char *directory) {
    char *image_directory = path_join(directory, "img"), *truth_path = path_join(directory, "groundtruth.txt");
    char *absence_path = path_join(directory, "absence.label");
    scene *s = scene_create(o);
    bool good = image_directory != NULL && truth_path != NULL && absence_path != NULL && s != NULL;
    if (!good) {
        report_error("%s: out of memory", directory);
    }
    good = good && path_make_directory(directory) && path_make_directory(image_directory) &&
           has_no_strangers(image_directory, o->frames) && write_sequence(s, o->frames, image_directory, truth_path, absence_path);
    scene_free(s);
    free(image_directory);
    free(truth_path);
    free(absence_path);
    return good;
}

int command_synth(int argc, char **argv) {
    arguments a = {{320, 240, 200, 3, 0, 0, false, 1}, false, NULL};
    const int end = option_read(argc, argv, table, take, &a);
    if (end == OPTION_HELP) {
        print_help();
        return EXIT_OK;
    }
    if (end == OPTION_ERROR || !check_arguments(&a)) return EXIT_USAGE;
    return synthesise(&a.scene, a.directory) ? EXIT_OK : EXIT_DATA;
}
