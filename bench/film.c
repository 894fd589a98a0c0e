#include "film.h"

#include "image_read.h"
#include "report.h"
#include "scene.h"
#include "sequence.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Makes room for frames like this one and puts it there. */
static bool keep(struct film *f, const image *grey, int32_t index, int32_t frames) {
    const size_t size = (size_t)grey->width * (size_t)grey->height;
    if (index == 0) {
        f->width = grey->width;
        f->height = grey->height;
        f->pixels = malloc(size * (size_t)frames);
    }
    if (f->pixels == NULL) {
        report_error("%s: out of memory", f->name);
        return false;
    }
    if (grey->width != f->width || grey->height != f->height) {
        report_error("%s: frame %d is %d x %d, the first one is %d x %d", f->name, (int)index + 1, (int)grey->width,
                     (int)grey->height, (int)f->width, (int)f->height);
        return false;
    }
    memcpy(f->pixels + size * (size_t)index, grey->pixels, size);
    f->count = index + 1;
    return true;
}

bool film_render(struct film *f, int32_t frames) {
    const scene_options options = {320, 240, 200, 3, 0, 0, false, 1}; /* what `asttrack synth` renders unless told otherwise */
    image grey;
    memset(f, 0, sizeof *f);
    memset(&grey, 0, sizeof grey);
    (void)snprintf(f->name, sizeof f->name, "synth");
    scene *s = scene_create(&options);
    bool good = s != NULL;
    for (int32_t i = 0; i < frames && good; i++) {
        ast_box box;
        scene_presence presence;
        good = scene_render(s, i, &grey, &box, &presence);
        if (good && i == 0) f->start = box;
        if (good && !keep(f, &grey, i, frames)) break;
    }
    if (!good) report_error("%s: out of memory", f->name);
    scene_free(s);
    image_free(&grey);
    if (f->count == frames) return true;
    film_close(f);
    return false;
}

bool film_read(struct film *f, const char *directory, int32_t frames) {
    sequence s;
    image grey;
    image_reader reader;
    memset(f, 0, sizeof *f);
    memset(&grey, 0, sizeof grey);
    memset(&reader, 0, sizeof reader);
    char *inputs[] = {(char *)directory};
    if (!sequence_open(&s, inputs, 1)) return false;
    (void)snprintf(f->name, sizeof f->name, "%s", s.name);
    const int32_t wanted = frames < s.count ? frames : s.count;
    const ast_box *box = truth_box(&s.annotations, 0);
    if (wanted < 2)
        report_error("%s: fewer than two frames", directory);
    else if (box == NULL)
        report_error("%s: no box for its first frame", directory);
    for (int32_t i = 0; i < wanted && wanted > 1 && box != NULL; i++) {
        if (!image_read(&reader, s.frames[i], &grey)) {
            report_error("%s: %s", s.frames[i], reader.error);
            break;
        }
        if (!keep(f, &grey, i, wanted)) break;
    }
    if (box != NULL) f->start = *box;
    const bool good = f->count == wanted && wanted > 1 && box != NULL;
    image_reader_free(&reader);
    image_free(&grey);
    sequence_close(&s);
    if (!good) film_close(f);
    return good;
}

void film_close(struct film *f) {
    free(f->pixels);
    f->pixels = NULL;
    f->count = 0;
}

ast_frame film_frame(const struct film *f, int64_t place) {
    const int64_t turn = f->count > 1 ? 2 * ((int64_t)f->count - 1) : 1, there = place % turn;
    const int64_t index = there < f->count ? there : turn - there;
    const ast_frame frame = {f->pixels + (size_t)index * (size_t)f->width * (size_t)f->height, f->width, f->height, f->width};
    return frame;
}
