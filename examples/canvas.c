#include "canvas.h"

#include "font.h"

#include <math.h>
#include <string.h>

static uint8_t *pixel_at(image *canvas, int32_t x, int32_t y) {
    return canvas->pixels + 3 * ((size_t)y * (size_t)canvas->width + (size_t)x);
}

static void blend(uint8_t *pixel, colour c, float opacity) {
    const uint8_t wanted[3] = {c.red, c.green, c.blue};
    for (int i = 0; i < 3; ++i) {
        const float mixed = (float)pixel[i] + opacity * ((float)wanted[i] - (float)pixel[i]);
        pixel[i] = (uint8_t)(mixed + 0.5f);
    }
}

bool canvas_fill(image *canvas, int32_t width, int32_t height, colour c) {
    if (!image_reserve(canvas, width, height, 3)) return false;
    canvas_rectangle(canvas, 0.0f, 0.0f, (float)width, (float)height, c, 1.0f);
    return true;
}

/* The grey value at a point of the image, averaged with a tent of the given half-widths. */
static uint8_t tent(const image *grey, float x, float y, float reach_x, float reach_y) {
    float sum = 0.0f, weight_sum = 0.0f;
    for (int32_t j = (int32_t)ceilf(y - reach_y); (float)j <= y + reach_y; ++j) {
        const int32_t row = j < 0 ? 0 : j >= grey->height ? grey->height - 1 : j;
        const uint8_t *pixels = grey->pixels + (size_t)row * (size_t)grey->width;
        const float weight_y = 1.0f - fabsf((float)j - y) / reach_y;
        for (int32_t i = (int32_t)ceilf(x - reach_x); (float)i <= x + reach_x; ++i) {
            const int32_t column = i < 0 ? 0 : i >= grey->width ? grey->width - 1 : i;
            const float weight = weight_y * (1.0f - fabsf((float)i - x) / reach_x);
            sum += weight * (float)pixels[column];
            weight_sum += weight;
        }
    }
    return (uint8_t)(sum / weight_sum + 0.5f);
}

bool canvas_from_grey(image *canvas, int32_t width, int32_t height, const image *grey) {
    if (!image_reserve(canvas, width, height, 3)) return false;
    const bool same_size = width == grey->width && height == grey->height;
    const float step_x = (float)grey->width / (float)width, step_y = (float)grey->height / (float)height;
    const float reach_x = fmaxf(1.0f, step_x), reach_y = fmaxf(1.0f, step_y);
    const uint8_t *source = grey->pixels;
    uint8_t *out = canvas->pixels;
    for (int32_t y = 0; y < height; ++y) {
        const float source_y = ((float)y + 0.5f) * step_y - 0.5f;
        for (int32_t x = 0; x < width; ++x) {
            const float source_x = ((float)x + 0.5f) * step_x - 0.5f;
            const uint8_t value = same_size ? *source++ : tent(grey, source_x, source_y, reach_x, reach_y);
            memset(out, value, 3);
            out += 3;
        }
    }
    return true;
}

void canvas_place(image *canvas, int32_t x, int32_t y, const image *picture) {
    const size_t row_bytes = 3 * (size_t)picture->width;
    for (int32_t row = 0; row < picture->height; ++row) {
        memcpy(pixel_at(canvas, x, y + row), picture->pixels + (size_t)row * row_bytes, row_bytes);
    }
}

/* Clamped before the conversion, so that any number, nan too, is safe. */
static int32_t clamp_index(float value, int32_t limit) {
    return value > 0.0f ? (value < (float)limit ? (int32_t)value : limit) : 0;
}

/* The share of the pixel [i, i + 1) that lies in [from, to). */
static float coverage(int32_t i, float from, float to) {
    return fmaxf(0.0f, fminf(to, (float)i + 1.0f) - fmaxf(from, (float)i));
}

void canvas_rectangle(image *canvas, float x0, float y0, float x1, float y1, colour c, float opacity) {
    const int32_t left = clamp_index(floorf(x0), canvas->width), right = clamp_index(ceilf(x1), canvas->width);
    const int32_t top = clamp_index(floorf(y0), canvas->height), bottom = clamp_index(ceilf(y1), canvas->height);
    for (int32_t y = top; y < bottom; ++y) {
        const float row_opacity = opacity * coverage(y, y0, y1);
        for (int32_t x = left; x < right; ++x) {
            blend(pixel_at(canvas, x, y), c, row_opacity * coverage(x, x0, x1));
        }
    }
}

void canvas_outline(image *canvas, float x0, float y0, float x1, float y1, float line, colour c, float opacity) {
    const float half = 0.5f * line;
    canvas_rectangle(canvas, x0 - half, y0 - half, x1 + half, y0 + half, c, opacity);
    canvas_rectangle(canvas, x0 - half, y1 - half, x1 + half, y1 + half, c, opacity);
    canvas_rectangle(canvas, x0 - half, y0 + half, x0 + half, y1 - half, c, opacity);
    canvas_rectangle(canvas, x1 - half, y0 + half, x1 + half, y1 - half, c, opacity);
}

void canvas_text(image *canvas, float x, float y, float dot, const char *text, colour c) {
    for (; *text != '\0'; ++text) {
        const char *const *rows = font_glyph(*text);
        for (int row = 0; row < FONT_HEIGHT; ++row) {
            for (int column = 0; column < FONT_WIDTH; ++column) {
                if (rows[row][column] != ' ') {
                    const float left = x + dot * (float)column, top = y + dot * (float)row;
                    canvas_rectangle(canvas, left, top, left + dot, top + dot, c, 1.0f);
                }
            }
        }
        x += dot * (float)(FONT_WIDTH + 1);
    }
}

float canvas_text_width(float dot, const char *text) {
    const size_t length = strlen(text);
    return length == 0 ? 0.0f : dot * (float)(length * (FONT_WIDTH + 1) - 1);
}
