#include "support_render.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support_noise.h"

enum { LATTICE = 9 }; /* tones along each side of the target */

static float *random_lattice(struct noise *noise, size_t count) {
    float *tones = malloc(count * sizeof *tones);
    if (tones == NULL) {
        fprintf(stderr, "no memory for a texture\n");
        exit(1);
    }
    noise_fill(noise, tones, count, 0.0, 1.0);
    return tones;
}

static double ease(double t) {
    return t * t * (3.0 - 2.0 * t);
}

/* Smooth interpolation of a lattice of side x side tones; x, y within 0 .. side - 1. */
static double lattice_tone(const float *lattice, int side, double x, double y) {
    const int i = x < side - 1 ? (int)x : side - 2, j = y < side - 1 ? (int)y : side - 2;
    const double u = ease(x - i), v = ease(y - j);
    const float *upper = lattice + (size_t)j * (size_t)side + (size_t)i, *lower = upper + side;
    return (1 - v) * ((1 - u) * (double)upper[0] + u * (double)upper[1]) + v * ((1 - u) * (double)lower[0] + u * (double)lower[1]);
}

void render_open(struct render *r, int width, int height, uint64_t seed) {
    enum { COARSE = 14, FINE = 41 };
    struct noise noise = {seed};
    float *coarse = random_lattice(&noise, (size_t)COARSE * COARSE), *fine = random_lattice(&noise, (size_t)FINE * FINE);
    r->width = width;
    r->height = height;
    r->gain = 1.0;
    r->offset = 0.0;
    r->target = random_lattice(&noise, (size_t)LATTICE * LATTICE);
    r->ground = random_lattice(&noise, (size_t)width * (size_t)height);
    r->pixels = malloc((size_t)width * (size_t)height);
    if (r->pixels == NULL) {
        fprintf(stderr, "no memory for a frame\n");
        exit(1);
    }
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            const double u = (x + 0.5) / width, v = (y + 0.5) / height;
            const double tone = 0.65 * lattice_tone(coarse, COARSE, u * (COARSE - 1), v * (COARSE - 1)) +
                                0.35 * lattice_tone(fine, FINE, u * (FINE - 1), v * (FINE - 1));
            float *ground = r->ground + (size_t)y * (size_t)width + (size_t)x;
            *ground = (float)(0.9 * tone + 0.1 * (double)*ground); /* a little of the white noise stays */
        }
    }
    free(coarse);
    free(fine);
}

void render_close(struct render *r) {
    free(r->ground);
    free(r->target);
    free(r->pixels);
}

ast_frame render_frame(struct render *r, const ast_box *box) {
    for (int y = 0; y < r->height; y++) {
        for (int x = 0; x < r->width; x++) {
            double tone = (double)r->ground[(size_t)y * (size_t)r->width + (size_t)x];
            if (box != NULL) {
                const double u = (x + 0.5 - (double)box->x) / (double)box->w, v = (y + 0.5 - (double)box->y) / (double)box->h;
                if (u >= 0 && u <= 1 && v >= 0 && v <= 1)
                    tone = lattice_tone(r->target, LATTICE, u * (LATTICE - 1), v * (LATTICE - 1));
            }
            const double level = 255.0 * (r->gain * tone + r->offset) + 0.5;
            r->pixels[(size_t)y * (size_t)r->width + (size_t)x] = (uint8_t)(level < 0 ? 0 : level > 255 ? 255 : level);
        }
    }
    const ast_frame frame = {r->pixels, r->width, r->height, r->width};
    return frame;
}

ast_box render_path(const struct render *r, int frame, double w, double h, double reach, double swell) {
    const double turn = 6.283185307179586 * frame / 100.0;
    const double scale = pow(swell, sin(turn));
    const double x = r->width * (0.5 + reach * sin(turn)), y = r->height * (0.5 + reach * sin(2 * turn));
    const ast_box box = {(float)(x - 0.5 * w * scale), (float)(y - 0.5 * h * scale), (float)(w * scale), (float)(h * scale)};
    return box;
}

void render_film(uint8_t *film, ast_box *truth, int frames, int width, int height, double w, double h) {
    struct render r;
    const size_t size = (size_t)width * (size_t)height;
    render_open(&r, width, height, 1);
    for (int f = 0; f < frames; f++) {
        truth[f] = render_path(&r, 2 * f, w, h, 0.15, 1.1);
        const ast_frame frame = render_frame(&r, &truth[f]);
        memcpy(film + (size_t)f * size, frame.pixels, size);
    }
    render_close(&r);
}

double box_distance(const ast_box *a, const ast_box *b) {
    const double dx = (double)a->x + 0.5 * (double)a->w - (double)b->x - 0.5 * (double)b->w;
    const double dy = (double)a->y + 0.5 * (double)a->h - (double)b->y - 0.5 * (double)b->h;
    return sqrt(dx * dx + dy * dy);
}
