#include "track_run.h"

#include "csv.h"
#include "image_jpeg.h"
#include "image_read.h"
#include "image_write.h"
#include "interrupt.h"
#include "metrics.h"
#include "output_file.h"
#include "path.h"
#include "report.h"
#include "sheet.h"
#include "status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Annotated pictures of smaller frames are enlarged by a whole factor towards this width, so that the labels fit. */
#define ANNOTATED_WIDTH 320
#define ANNOTATED_ENLARGEMENT 8

typedef struct run {
    const track_job *job;
    ast_tracker *tracker;
    image_reader reader;
    image frame;  /* the frame being tracked */
    image canvas; /* the same, annotated */
    output_file csv;
    sheet contact;
    metrics fit;
    double step_seconds; /* inside ast_step */
    int32_t steps;       /* calls of it that did not fail */
    int32_t skipped;     /* frames without a result */
    int32_t lost;        /* frames with status AST_LOST */
} run;

static double seconds_now(void) {
    struct timespec now;
    if (clock_gettime(CLOCK_MONOTONIC, &now) != 0) return 0.0;
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* ---- Recording a frame's result ---- */

static bool write_annotated(run *r, const annotation *a) {
    char name[32];
    const int32_t fitting = ANNOTATED_WIDTH / a->frame->width;
    const int32_t factor = fitting < 1 ? 1 : fitting > ANNOTATED_ENLARGEMENT ? ANNOTATED_ENLARGEMENT : fitting;
    snprintf(name, sizeof name, "%05d.%s", (int)a->number, image_jpeg_available() ? "jpg" : "ppm");
    char *path = path_join(r->job->annotate, name);
    if (path == NULL || !annotate(&r->canvas, factor * a->frame->width, factor * a->frame->height, a)) {
        report_error("%s: frame %d: out of memory", r->job->annotate, (int)a->number);
        free(path);
        return false;
    }
    const bool good = image_write(path, &r->canvas);
    free(path);
    return good;
}

/* Counts a tracked frame; those whose box was given do not count. */
static void measure(run *r, int32_t index, const ast_result *result) {
    const ast_box *truth = truth_box(&r->job->frames->annotations, index);
    if (truth != NULL) {
        metrics_add(&r->fit, &result->box, truth);
    }
    r->lost += result->status == AST_LOST ? 1 : 0;
}

/* index: of the frame in its sequence, from 0. cloud: whether the tracker's particles belong to this frame. False after reporting
 * an output that failed, which ends the run. */
static bool record(run *r, int32_t index, const image *frame, const ast_result *result, bool cloud) {
    const track_job *job = r->job;
    const ast_box *truth = truth_box(&job->frames->annotations, index);
    if (r->csv.stream != NULL) {
        csv_write_row(&r->csv, index + 1, result);
    }
    report_progress(job->frames->name, index + 1, job->frames->count, status_name(result->status));
    if (job->annotate == NULL && job->sheet == NULL) return true;
    annotation a = {frame, job->frames->name, index + 1, result->box, result->score, result->status, {0}, truth};
    if (cloud && ast_get_particles(r->tracker, &a.particles) != AST_OK) {
        a.particles.count = 0;
    }
    if (job->annotate != NULL && !write_annotated(r, &a)) return false;
    if (job->sheet != NULL && !sheet_offer(&r->contact, index, &a)) {
        report_error("%s: out of memory", job->sheet);
        return false;
    }
    return true;
}

/* ---- The given frames ---- */

/* What a frame whose box is given gets in the CSV. */
static ast_result given_result(const ast_box *box, const ast_box *first) {
    ast_result result;
    memset(&result, 0, sizeof result);
    result.box = *box;
    result.scale = sqrtf(box->w / first->w * (box->h / first->h));
    result.score = 1.0f;
    result.status = AST_TRACKING;
    return result;
}

static bool given_box(const run *r, int32_t index, ast_box *box) {
    const sequence *s = r->job->frames;
    if (r->job->box != NULL) {
        *box = *r->job->box;
        return true;
    }
    if (r->job->init_sequence) {
        if (truth_interpolate(&s->annotations, index, box)) return true;
        report_error("%s: no boxes around frame %d, which --init-sequence needs", s->truth_path, (int)index + 1);
        return false;
    }
    const ast_box *truth = truth_box(&s->annotations, index);
    if (truth == NULL) {
        report_error("%s:1: no box for the first frame: give it with --box", s->truth_path);
        return false;
    }
    *box = *truth;
    return true;
}

static bool start_tracker(run *r, const image *images, const ast_box *boxes, int32_t count) {
    ast_frame frames[AST_MAX_HISTORY];
    for (int32_t i = 0; i < count; ++i) {
        frames[i] = image_frame(&images[i]);
    }
    const int code =
        r->job->init_sequence ? ast_start_sequence(r->tracker, frames, boxes, count) : ast_start(r->tracker, &frames[0], &boxes[0]);
    if (code != AST_OK) {
        report_error("%s: box %g,%g,%g,%g in %d x %d pixels: %s", r->job->frames->frames[0], (double)boxes[0].x, (double)boxes[0].y,
                     (double)boxes[0].w, (double)boxes[0].h, (int)images[0].width, (int)images[0].height, ast_strerror(code));
    }
    return code == AST_OK;
}

/* Reads the given frames, all of which the library wants at once, starts the tracker on them and records them. */
static bool start_on(run *r, image *images, int32_t count) {
    ast_box boxes[AST_MAX_HISTORY] = {{0}};
    for (int32_t i = 0; i < count; ++i) {
        const char *path = r->job->frames->frames[i];
        if (!given_box(r, i, &boxes[i])) return false;
        if (!image_read(&r->reader, path, &images[i])) {
            report_error("%s: %s: the frame of a given box, nothing to start from", path, r->reader.error);
            return false;
        }
    }
    if (!start_tracker(r, images, boxes, count)) return false;
    for (int32_t i = 0; i < count; ++i) {
        const ast_result result = given_result(&boxes[i], &boxes[0]);
        if (!record(r, i, &images[i], &result, i == count - 1)) return false;
    }
    return true;
}

/* *count: frames whose boxes are given. */
static bool start(run *r, int32_t *count) {
    *count = r->job->init_sequence ? r->job->config->history : 1;
    if (*count > r->job->frames->count) {
        report_error("%s: %d frames, --init-sequence needs %d", r->job->frames->name, (int)r->job->frames->count, (int)*count);
        return false;
    }
    image images[AST_MAX_HISTORY];
    memset(images, 0, sizeof images);
    const bool good = start_on(r, images, *count);
    for (int32_t i = 0; i < *count; ++i) {
        image_free(&images[i]);
    }
    return good;
}

/* ---- The rest of the sequence ---- */

/* False when the frame gave no result, which is then reported and counted. */
static bool step(run *r, const char *path, ast_result *result) {
    if (!image_read(&r->reader, path, &r->frame)) {
        report_error("%s: %s: frame skipped", path, r->reader.error);
        r->skipped += 1;
        return false;
    }
    const ast_frame frame = image_frame(&r->frame);
    const double before = seconds_now();
    const int code = ast_step(r->tracker, &frame, result);
    const double after = seconds_now();
    if (code != AST_OK) {
        report_error("%s: %s: frame skipped", path, ast_strerror(code));
        r->skipped += 1;
        return false;
    }
    r->step_seconds += after - before;
    r->steps += 1;
    return true;
}

static bool follow(run *r, int32_t first) {
    const sequence *s = r->job->frames;
    for (int32_t i = first; i < s->count; ++i) {
        ast_result result;
        if (interrupt_pending()) {
            report_error("interrupted before frame %d of %d", (int)i + 1, (int)s->count);
            return false;
        }
        if (!step(r, s->frames[i], &result)) continue;
        measure(r, i, &result);
        if (!record(r, i, &r->frame, &result, true)) return false;
    }
    return true;
}

static void print_result(const run *r) {
    const double rate = r->steps > 0 && r->step_seconds > 0.0 ? (double)r->steps / r->step_seconds : (double)NAN;
    printf("result name=%s frames=%d cle=%.1f precision20=%.3f success=%.3f fps=%.1f lost=%d", r->job->frames->name,
           (int)r->job->frames->count, metrics_centre_error(&r->fit), metrics_precision(&r->fit), metrics_success(&r->fit), rate,
           (int)r->lost);
    if (r->skipped > 0) {
        printf(" skipped=%d", (int)r->skipped);
    }
    putchar('\n');
}

/* ---- Everything ---- */

static bool open_outputs(run *r) {
    const track_job *job = r->job;
    if (job->annotate != NULL && !path_make_directory(job->annotate)) return false;
    if (job->sheet != NULL) {
        sheet_start(&r->contact, job->frames->count);
    }
    if (job->csv != NULL) {
        if (!output_open(&r->csv, job->csv)) return false;
        csv_write_header(&r->csv);
    }
    return true;
}

/* Every output is tried, so that one that fails does not cost the others. */
static bool finish(run *r) {
    bool good = true;
    if (r->csv.stream != NULL) {
        good = output_commit(&r->csv);
    }
    if (r->job->sheet != NULL) {
        good = sheet_write(&r->contact, r->job->sheet) && good;
    }
    report_progress_end();
    print_result(r);
    return good;
}

static void compare_lengths(const sequence *s) {
    const int lines = (int)s->annotations.count, frames = (int)s->count;
    if (s->truth_path != NULL && lines < frames) {
        report_error("%s: ends after %d of %d frames: the others are not evaluated", s->truth_path, lines, frames);
    } else if (s->truth_path != NULL && lines > frames) {
        report_error("%s: has %d lines, but there are %d frames: the other lines are not used", s->truth_path, lines, frames);
    }
}

bool track_run(const track_job *job) {
    run r;
    memset(&r, 0, sizeof r);
    r.job = job;
    compare_lengths(job->frames);
    int32_t given = 0;
    const int code = ast_init(&r.tracker, job->config, NULL, 0);
    if (code != AST_OK) {
        report_error("cannot make the tracker: %s", ast_strerror(code));
        return false;
    }
    const bool good = open_outputs(&r) && start(&r, &given) && follow(&r, given) && finish(&r);
    report_progress_end();
    output_discard(&r.csv);
    sheet_free(&r.contact);
    image_free(&r.frame);
    image_free(&r.canvas);
    image_reader_free(&r.reader);
    ast_free(r.tracker);
    return good;
}
