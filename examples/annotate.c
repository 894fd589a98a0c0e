#include "annotate.h"

#include "canvas.h"
#include "status.h"

#include <math.h>
#include <stdio.h>

/* Shades of the particle cloud, drawn from the lightest weight to the heaviest, so that those that matter lie on top. */
#define SHADES 8

/* From frame coordinates (pixel centres at integers) to the canvas (pixel edges at integers). */
typedef struct view {
    float scale_x, scale_y;
} view;

static float view_x(const view *v, float x) {
    return (x + 0.5f) * v->scale_x;
}
static float view_y(const view *v, float y) {
    return (y + 0.5f) * v->scale_y;
}

static colour status_colour(int32_t status) {
    static const colour tracking = {80, 230, 100}, uncertain = {255, 180, 40}, lost = {255, 70, 60};
    return status == AST_TRACKING ? tracking : status == AST_UNCERTAIN ? uncertain : lost;
}

/* From a dull blue by red to yellow. part 0..1. */
static colour weight_colour(float part) {
    static const float stops[3][3] = {{60.0f, 110.0f, 255.0f}, {255.0f, 60.0f, 150.0f}, {255.0f, 235.0f, 60.0f}};
    const int stop = part < 0.5f ? 0 : 1;
    const float along = 2.0f * part - (float)stop;
    uint8_t mixed[3];
    for (int i = 0; i < 3; ++i) {
        mixed[i] = (uint8_t)(stops[stop][i] + along * (stops[stop + 1][i] - stops[stop][i]) + 0.5f);
    }
    const colour c = {mixed[0], mixed[1], mixed[2]};
    return c;
}

/* The shade of a particle: by its weight relative to the heaviest, on a square-root scale, since most weights are small. */
static int shade_of(float weight, float heaviest) {
    const float part = heaviest > 0.0f ? sqrtf(weight / heaviest) : 0.0f;
    return part > 0.0f ? (int)(part * (float)(SHADES - 1) + 0.5f) : 0;
}

static void draw_particles(image *canvas, const view *v, float line, const ast_particles *p) {
    float heaviest = 0.0f;
    for (int32_t i = 0; i < p->count; ++i) {
        heaviest = fmaxf(heaviest, p->weight[i]);
    }
    for (int shade = 0; shade < SHADES; ++shade) {
        const float part = (float)shade / (float)(SHADES - 1);
        const float half = (0.6f + 0.4f * part) * line;
        for (int32_t i = 0; i < p->count; ++i) {
            if (shade_of(p->weight[i], heaviest) == shade) {
                const float x = view_x(v, p->x[i]), y = view_y(v, p->y[i]);
                canvas_rectangle(canvas, x - half, y - half, x + half, y + half, weight_colour(part), 0.45f + 0.5f * part);
            }
        }
    }
}

/* A box covers x - 1/2 .. x + w - 1/2. */
static void draw_box(image *canvas, const view *v, const ast_box *box, float line, colour c) {
    canvas_outline(canvas, view_x(v, box->x - 0.5f), view_y(v, box->y - 0.5f), view_x(v, box->x + box->w - 0.5f),
                   view_y(v, box->y + box->h - 0.5f), line, c, 0.95f);
}

static void draw_label(image *canvas, float dot, const annotation *a) {
    static const colour black = {0, 0, 0}, white = {235, 235, 235};
    char left[64], right[32];
    const float width = (float)canvas->width, margin = 3.0f * dot, strip = 13.0f * dot;
    snprintf(left, sizeof left, "%.24s %d", a->name, (int)a->number);
    snprintf(right, sizeof right, "%s %.2f", status_name(a->status), (double)a->score);
    canvas_rectangle(canvas, 0.0f, 0.0f, width, strip, black, 0.6f);
    canvas_text(canvas, margin, margin, dot, left, white);
    canvas_text(canvas, width - margin - canvas_text_width(dot, right), margin, dot, right, status_colour(a->status));
}

bool annotate(image *canvas, int32_t width, int32_t height, const annotation *a) {
    static const colour white = {255, 255, 255};
    if (!canvas_from_grey(canvas, width, height, a->frame)) return false;
    const view v = {(float)width / (float)a->frame->width, (float)height / (float)a->frame->height};
    /* lines and letters keep their size relative to the picture, and stay sharp on whole pixels */
    const float unit = fmaxf(1.0f, floorf((float)width / 320.0f));
    draw_particles(canvas, &v, unit, &a->particles);
    draw_box(canvas, &v, &a->box, 2.0f * unit, status_colour(a->status));
    if (a->truth != NULL) {
        draw_box(canvas, &v, a->truth, unit, white);
    }
    draw_label(canvas, unit, a);
    return true;
}
