#include "scene.h"

#include "noise.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TURN 6.283185307179586 /* a full turn, radians */

/* Samples a pixel along each side of moving things: their edges and textures are smooth as in a real picture. */
#define SAMPLES 4
/* How far the camera pans, as a part of the frame's side. */
#define PAN 0.25
/* Standard deviation of the sensor's noise, grey levels. */
#define SENSOR_NOISE 2.0
/* Frames over which the target leaves and comes back. */
#define LEAVE_FRAMES 30.0
/* Frames after the full occlusion until the target is in full view again, about. */
#define OCCLUSION_AFTERMATH 8.0
/* Length of the script, at least. */
#define SCRIPT_FRAMES 200.0

/* The parts of a scene, each with random numbers of its own. */
enum {
    SEED_BACKGROUND,
    SEED_OTHER_SCENE,
    SEED_TARGET,
    SEED_LOOKALIKE,
    SEED_PARTIAL_BOARD,
    SEED_FULL_BOARD,
    SEED_PATH,
    SEED_SENSOR
};

static uint64_t part_seed(const scene_options *options, int64_t part) {
    return noise_bits(options->seed, part, 0);
}

/* A board that passes in front: it moves at a constant speed, and its edges are such that it covers what it must. Screen position
 * of its left edge at time t: left + speed t. */
typedef struct board {
    double speed;
    double left, right, top, bottom;
} board;

/* The look-alike moves on a straight line. */
typedef struct lookalike {
    double speed, x, y; /* at time 0 */
    double scale;
} lookalike;

struct scene {
    scene_options options;
    double unit;             /* pixels here for one pixel at 320 x 240 */
    double leave_at, cut_at; /* first frame of each event */
    double occlusion_at;
    double phase[4]; /* of the path */
    board partial, full;
    lookalike other;
    int32_t ground_width, ground_height;
    float *ground;      /* the background, wider and higher than a frame */
    float *other_scene; /* the same, shown during the cut; NULL without one */
};

/* ---- The script: what happens when ----
 *
 * Two clocks. Motion runs with the frames. The script's events sit at fixed parts of a second clock, which stands still during the
 * full occlusion, the absence and the cut, so that these do not swallow other events however long they are. */

static double smooth_step(double t) {
    const double clamped = fmin(1.0, fmax(0.0, t));
    return clamped * clamped * (3.0 - 2.0 * clamped);
}

/* The script's frames: all but the inserted ones. A shorter sequence is the beginning of the script rather than a hurried one. */
static double script_length(const scene_options *o) {
    return fmax(SCRIPT_FRAMES, (double)o->frames - o->occlusion - o->leave - o->cut);
}

/* Inserted events in order, each with its part of the script. */
#define CUT_PART 0.38
#define OCCLUSION_PART 0.5
#define LEAVE_PART 0.64

/* The frame at which a part of the script (0..1) is reached. */
static double frame_of(const scene_options *o, double part) {
    double frame = part * script_length(o);
    frame += part > CUT_PART ? o->cut : 0;
    frame += part > OCCLUSION_PART ? o->occlusion : 0;
    frame += part > LEAVE_PART ? o->leave : 0;
    return floor(frame);
}

int32_t scene_frames_needed(const scene_options *options) {
    const double leave_end = frame_of(options, LEAVE_PART) + options->leave + LEAVE_FRAMES;
    const double occlusion_end = frame_of(options, OCCLUSION_PART) + options->occlusion + OCCLUSION_AFTERMATH;
    const double cut_end = frame_of(options, CUT_PART) + options->cut + 1.0;
    return (int32_t)(options->leave > 0 ? leave_end : options->occlusion > 0 ? occlusion_end : options->cut > 0 ? cut_end : 1.0);
}

/* 0 before a change that starts at a part of the script and takes so many frames, 1 after it. */
static double change(const scene *s, double t, double part, double frames) {
    return smooth_step((t - frame_of(&s->options, part)) / frames);
}

/* ---- The target's path ---- */

static double half_width(const scene *s) {
    return 24.0 * s->unit;
}
static double half_height(const scene *s) {
    return 20.0 * s->unit;
}

/* Grows to 1.3, then shrinks to 0.85; as long as a third of the script each. */
static double target_scale(const scene *s, double t) {
    const double duration = 0.2 * script_length(&s->options) + 1.0;
    return 1.0 + 0.3 * change(s, t, 0.25, duration) - 0.45 * change(s, t, 0.75, duration);
}

/* Where the target would be if it never left: slow waves, and three darts of a few frames. */
static void drift(const scene *s, double t, double *x, double *y) {
    const double width = (double)s->options.width, height = (double)s->options.height;
    const double dart = change(s, t, 0.14, 3.0) - 2.0 * change(s, t, 0.61, 4.0) + change(s, t, 0.9, 3.0);
    *x = 0.5 * width + 0.18 * width * sin(TURN * (t / 190.0 + s->phase[0])) + 0.04 * width * sin(TURN * (t / 61.0 + s->phase[1])) +
         0.06 * width * dart;
    *y = 0.5 * height + 0.13 * height * sin(TURN * (t / 140.0 + s->phase[2])) +
         0.025 * height * sin(TURN * (t / 43.0 + s->phase[3])) - 0.03 * height * dart;
}

/* Centre of the target, pixel centres at integers. */
static void target_centre(const scene *s, double t, double *x, double *y) {
    drift(s, t, x, y);
    if (s->options.leave > 0) {
        const double last = s->leave_at + (double)s->options.leave - 1.0;
        const double away =
            smooth_step((t - s->leave_at + LEAVE_FRAMES) / LEAVE_FRAMES) * smooth_step((last + LEAVE_FRAMES - t) / LEAVE_FRAMES);
        /* just past the edge, so that it is wholly outside in exactly the frames asked for */
        const double outside = (double)s->options.width - 0.49 + half_width(s) * target_scale(s, t);
        *x += away * (outside - *x);
    }
}

/* ---- What meets the target ---- */

/* Makes a board that moves at this speed and, from frame first on, spans the target's whole width for so many frames. */
static board board_over(const scene *s, double speed, double first, int32_t frames, double margin) {
    board b = {speed, HUGE_VAL, -HUGE_VAL, HUGE_VAL, -HUGE_VAL};
    for (int32_t i = 0; i < frames; ++i) {
        double x, y;
        const double t = first + (double)i, scale = target_scale(s, t);
        target_centre(s, t, &x, &y);
        b.left = fmin(b.left, x - speed * t - scale * half_width(s) - margin);
        b.right = fmax(b.right, x - speed * t + scale * half_width(s) + margin);
        b.top = fmin(b.top, y - scale * half_height(s) - margin);
        b.bottom = fmax(b.bottom, y + scale * half_height(s) + margin);
    }
    return b;
}

/* A low board: for ten frames it hides about the lower half. */
static board partial_board(const scene *s) {
    board b = board_over(s, 5.0 * s->unit, frame_of(&s->options, 0.27), 10, 0.0);
    b.top = 0.5 * (b.top + b.bottom) + 1.0 * s->unit;
    b.bottom = (double)s->options.height + 1.0;
    return b;
}

/* A board that reaches from above the target to the ground. */
static board full_board(const scene *s) {
    board b = board_over(s, -14.0 * s->unit, s->occlusion_at, s->options.occlusion, 2.0);
    b.bottom = (double)s->options.height + 1.0;
    return b;
}

/* The look-alike crosses near the target, above it or below it, whichever has more room, and never touches it. */
static lookalike passing_lookalike(const scene *s) {
    const double middle = frame_of(&s->options, 0.74), scale = target_scale(s, middle);
    double x, y, highest = HUGE_VAL, lowest = -HUGE_VAL;
    for (int i = -30; i <= 30; ++i) {
        target_centre(s, middle + i, &x, &y);
        highest = fmin(highest, y);
        lowest = fmax(lowest, y);
    }
    target_centre(s, middle, &x, &y);
    const double apart = 2.05 * scale * half_height(s);
    lookalike l;
    l.speed = -3.5 * s->unit;
    l.x = x - l.speed * middle;
    l.y = highest > (double)s->options.height - lowest ? highest - apart : lowest + apart;
    l.scale = scale;
    return l;
}

/* ---- Textures: tones from 0 (black) to 1 (white) ---- */

/* A soft edge: 0 below, 1 above, over a width of 2 * soft. */
static double edge(double distance, double soft) {
    return smooth_step(0.5 + 0.5 * distance / soft);
}

/* The target's face; u, v run from -1 to 1 over its box. */
static double target_tone(uint64_t seed, double u, double v) {
    double tone = 0.15 + 0.75 * noise_octaves(seed, 3.0 * u + 7.0, 2.5 * v + 3.0, 4, 0.6);
    const double bright = 0.34 - hypot(1.2 * (u + 0.38), v + 0.28), dark = 0.30 - hypot(1.2 * (u - 0.40), v + 0.18);
    const double stripe = 0.13 - fabs(v - 0.5 - 0.22 * sin(3.0 * u));
    tone += edge(bright, 0.06) * (0.95 - tone);
    tone += edge(dark, 0.06) * (0.06 - tone);
    tone += edge(stripe, 0.05) * (0.85 - tone);
    tone += edge(fmax(fabs(u), fabs(v)) - 0.9, 0.04) * 0.85 * (0.12 - tone); /* a dark rim */
    return tone;
}

/* Inside the rounded rectangle of the box. */
static bool target_covers(double u, double v) {
    const double u4 = u * u * u * u, v4 = v * v * v * v;
    return u4 * u4 + v4 * v4 <= 1.0;
}

/* Boards are planked; a darker line parts the planks. x, y from the board's corner, in units. */
static double board_tone(uint64_t seed, double x, double y) {
    const double plank = y / 14.0, within = plank - floor(plank);
    const double grain = noise_octaves(seed, x / 50.0, y / 4.0, 4, 0.55);
    return 0.18 + 0.42 * grain - (within < 0.1 ? 0.1 : 0.0) + 0.06 * noise_uniform(seed, (int64_t)floor(plank), 1);
}

/* Hills of noise with a crowd of soft-edged blocks among them. */
static float *paint_ground(uint64_t seed, int32_t width, int32_t height, double unit) {
    float *ground = malloc((size_t)width * (size_t)height * sizeof *ground);
    if (ground == NULL) return NULL;
    for (int32_t y = 0; y < height; ++y) {
        for (int32_t x = 0; x < width; ++x) {
            const double noise = noise_octaves(seed, (double)x / (64.0 * unit), (double)y / (64.0 * unit), 6, 0.72);
            ground[(size_t)y * (size_t)width + (size_t)x] = (float)fmin(0.95, fmax(0.05, 0.45 + 1.9 * (noise - 0.5)));
        }
    }
    for (int64_t i = 0; i < 60; ++i) {
        const double cx = noise_uniform(seed, i, 1001) * width, cy = noise_uniform(seed, i, 1002) * height;
        const double half_w = unit * (6.0 + 22.0 * noise_uniform(seed, i, 1003)),
                     half_h = unit * (6.0 + 30.0 * noise_uniform(seed, i, 1004));
        const double tone = 0.15 + 0.65 * noise_uniform(seed, i, 1005), strength = 0.35 + 0.4 * noise_uniform(seed, i, 1006);
        const int32_t x0 = (int32_t)fmax(0.0, cx - half_w - 3.0), x1 = (int32_t)fmin(width, cx + half_w + 3.0);
        const int32_t y0 = (int32_t)fmax(0.0, cy - half_h - 3.0), y1 = (int32_t)fmin(height, cy + half_h + 3.0);
        for (int32_t y = y0; y < y1; ++y) {
            for (int32_t x = x0; x < x1; ++x) {
                const double inside = fmin(half_w - fabs((double)x - cx), half_h - fabs((double)y - cy));
                float *pixel = &ground[(size_t)y * (size_t)width + (size_t)x];
                *pixel += (float)(strength * edge(inside, 1.0)) * ((float)tone - *pixel);
            }
        }
    }
    return ground;
}

/* ---- Making and freeing ---- */

scene *scene_create(const scene_options *options) {
    scene *s = calloc(1, sizeof *s);
    if (s == NULL) return NULL;
    s->options = *options;
    s->unit = fmin((double)options->width / 320.0, (double)options->height / 240.0);
    for (int k = 0; k < 4; ++k) {
        s->phase[k] = noise_uniform(part_seed(options, SEED_PATH), k, 0);
    }
    s->cut_at = frame_of(options, CUT_PART);
    s->occlusion_at = frame_of(options, OCCLUSION_PART);
    s->leave_at = frame_of(options, LEAVE_PART);
    s->partial = partial_board(s);
    s->full = full_board(s);
    s->other = passing_lookalike(s);
    s->ground_width = (int32_t)ceil((1.0 + PAN) * options->width) + 2;
    s->ground_height = (int32_t)ceil((1.0 + PAN) * options->height) + 2;
    s->ground = paint_ground(part_seed(options, SEED_BACKGROUND), s->ground_width, s->ground_height, s->unit);
    if (options->cut > 0) {
        s->other_scene = paint_ground(part_seed(options, SEED_OTHER_SCENE), s->ground_width, s->ground_height, 0.5 * s->unit);
    }
    if (s->ground == NULL || (options->cut > 0 && s->other_scene == NULL)) {
        scene_free(s);
        return NULL;
    }
    return s;
}

void scene_free(scene *s) {
    if (s != NULL) {
        free(s->ground);
        free(s->other_scene);
        free(s);
    }
}

/* ---- Rendering ---- */

/* The tones of a frame before light and sensor. */
typedef struct film {
    float *tones;
    int32_t width, height;
} film;

/* A moving thing: whether it covers a point of the screen, and with which tone. */
typedef struct actor actor;
struct actor {
    bool (*sample)(const actor *a, double x, double y, double *tone);
    uint64_t seed;
    double x, y;                    /* centre, or top-left corner of a board */
    double half_width, half_height; /* of a board: of its whole extent */
    double unit;
};

static bool sample_target(const actor *a, double x, double y, double *tone) {
    const double u = (x - a->x) / a->half_width, v = (y - a->y) / a->half_height;
    if (!target_covers(u, v)) return false;
    *tone = target_tone(a->seed, u, v);
    return true;
}

static bool sample_board(const actor *a, double x, double y, double *tone) {
    const double from_left = x - (a->x - a->half_width), from_top = y - (a->y - a->half_height);
    if (from_left < 0.0 || from_top < 0.0 || from_left > 2.0 * a->half_width || from_top > 2.0 * a->half_height) {
        return false;
    }
    *tone = board_tone(a->seed, from_left / a->unit, from_top / a->unit);
    return true;
}

/* First and last pixel, clipped, of what reaches half to either side of the centre. */
static int32_t first_pixel(double centre, double half) {
    return (int32_t)fmax(0.0, floor(centre - half));
}
static int32_t last_pixel(double centre, double half, int32_t size) {
    return (int32_t)fmin((double)size - 1.0, ceil(centre + half));
}

static void draw(film *f, const actor *a) {
    const int32_t left = first_pixel(a->x, a->half_width), right = last_pixel(a->x, a->half_width, f->width);
    const int32_t top = first_pixel(a->y, a->half_height), bottom = last_pixel(a->y, a->half_height, f->height);
    for (int32_t y = top; y <= bottom; ++y) {
        for (int32_t x = left; x <= right; ++x) {
            double sum = 0.0;
            int covered = 0;
            for (int k = 0; k < SAMPLES * SAMPLES; ++k) {
                const int column = k % SAMPLES, row = k / SAMPLES;
                const double dx = (column + 0.5) / SAMPLES - 0.5, dy = (row + 0.5) / SAMPLES - 0.5;
                double tone;
                if (a->sample(a, x + dx, y + dy, &tone)) {
                    sum += tone;
                    ++covered;
                }
            }
            float *pixel = &f->tones[(size_t)y * (size_t)f->width + (size_t)x];
            const double count = SAMPLES * SAMPLES;
            *pixel = (float)((double)*pixel * (1.0 - (double)covered / count) + sum / count);
        }
    }
}

static void draw_ground(film *f, const scene *s, const float *ground, double t) {
    const double pan_x = PAN * (double)f->width * (0.5 + 0.5 * sin(TURN * t / 300.0));
    const double pan_y = PAN * (double)f->height * (0.5 + 0.5 * sin(TURN * t / 410.0));
    const int32_t column = (int32_t)pan_x, row = (int32_t)pan_y;
    const float u = (float)(pan_x - column), v = (float)(pan_y - row);
    const size_t stride = (size_t)s->ground_width;
    for (int32_t y = 0; y < f->height; ++y) {
        const float *upper = ground + (size_t)(y + row) * stride + (size_t)column, *lower = upper + stride;
        float *out = f->tones + (size_t)y * (size_t)f->width;
        for (int32_t x = 0; x < f->width; ++x) {
            const float above = upper[x] + u * (upper[x + 1] - upper[x]), below = lower[x] + u * (lower[x + 1] - lower[x]);
            out[x] = above + v * (below - above);
        }
    }
}

static void draw_board(film *f, const scene *s, const board *b, double t, int64_t part) {
    const double half_w = 0.5 * (b->right - b->left), half_h = 0.5 * (b->bottom - b->top);
    if (half_w > 0.0 && half_h > 0.0) {
        const actor a = {
            sample_board, part_seed(&s->options, part), b->left + b->speed * t + half_w, b->top + half_h, half_w, half_h, s->unit};
        draw(f, &a);
    }
}

static void draw_target(film *f, const scene *s, double x, double y, double scale, int64_t part) {
    const actor a = {sample_target, part_seed(&s->options, part), x, y, scale * half_width(s), scale * half_height(s), s->unit};
    draw(f, &a);
}

/* The light goes down by a third in the second half, and comes back brighter than it was. */
static double light(const scene *s, double t) {
    return 1.0 - 0.35 * change(s, t, 0.56, 18.0) + 0.45 * change(s, t, 0.8, 24.0);
}

/* Tones to grey levels through light and sensor. */
static void expose(const film *f, const scene *s, double t, image *grey) {
    const double gain = 255.0 * light(s, t);
    const size_t pixels = (size_t)f->width * (size_t)f->height;
    const uint64_t seed = part_seed(&s->options, SEED_SENSOR);
    for (size_t i = 0; i < pixels; ++i) {
        const double level = gain * (double)f->tones[i] + SENSOR_NOISE * noise_normal(seed, (int64_t)t, (int64_t)i);
        grey->pixels[i] = (uint8_t)fmin(255.0, fmax(0.0, level + 0.5));
    }
}

static bool is_cut(const scene *s, double t) {
    return t >= s->cut_at && t < s->cut_at + (double)s->options.cut;
}

static bool is_hidden(const scene *s, double t) {
    return t >= s->occlusion_at && t < s->occlusion_at + (double)s->options.occlusion;
}

bool scene_render(const scene *s, int32_t frame, image *grey, ast_box *box, scene_presence *presence) {
    const double t = (double)frame, scale = target_scale(s, t);
    const int32_t width = s->options.width, height = s->options.height;
    film f = {calloc((size_t)width * (size_t)height, sizeof(float)), width, height};
    if (f.tones == NULL || !image_reserve(grey, width, height, 1)) {
        free(f.tones);
        return false;
    }
    double x, y;
    target_centre(s, t, &x, &y);
    const double half_w = scale * half_width(s), half_h = scale * half_height(s);
    if (is_cut(s, t)) {
        draw_ground(&f, s, s->other_scene, t);
        *presence = SCENE_AWAY;
    } else {
        draw_ground(&f, s, s->ground, t);
        if (!s->options.alone) draw_target(&f, s, s->other.x + s->other.speed * t, s->other.y, s->other.scale, SEED_LOOKALIKE);
        draw_target(&f, s, x, y, scale, SEED_TARGET);
        draw_board(&f, s, &s->partial, t, SEED_PARTIAL_BOARD);
        draw_board(&f, s, &s->full, t, SEED_FULL_BOARD);
        *presence = x - half_w >= (double)width - 0.5 ? SCENE_AWAY : is_hidden(s, t) ? SCENE_HIDDEN : SCENE_IN_VIEW;
    }
    expose(&f, s, t, grey);
    free(f.tones);
    /* the box covers x - 1/2 .. x + w - 1/2, pixel centres at integers */
    box->w = (float)(2.0 * half_w);
    box->h = (float)(2.0 * half_h);
    box->x = (float)(x - half_w + 0.5);
    box->y = (float)(y - half_h + 0.5);
    return true;
}
