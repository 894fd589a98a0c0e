#include "small_scene.h"

/* Positions are in sixteenths of a pixel. */
enum { UNIT = 16 };

struct place {
    int32_t x, y;                    /* centre */
    int32_t half_width, half_height; /* of the thing */
};

/* A random byte for a point, by the finaliser of MurmurHash3. */
static uint32_t random_byte(uint32_t kind, uint32_t x, uint32_t y) {
    uint32_t bits = x * 0x9e3779b1u ^ y * 0x85ebca77u ^ kind * 0xc2b2ae3du;
    bits ^= bits >> 16;
    bits *= 0x85ebca6bu;
    bits ^= bits >> 13;
    bits *= 0xc2b2ae35u;
    return (bits ^ bits >> 16) & 255u;
}

/* Noise on a lattice of 2^step pixels, linear between its points: 0 .. 255. */
static int32_t texture(uint32_t kind, int32_t x, int32_t y, int step) {
    const int32_t size = 1 << step, right = x & (size - 1), down = y & (size - 1);
    const uint32_t column = (uint32_t)(x >> step), row = (uint32_t)(y >> step);
    const int32_t top =
        (int32_t)random_byte(kind, column, row) * (size - right) + (int32_t)random_byte(kind, column + 1, row) * right;
    const int32_t bottom =
        (int32_t)random_byte(kind, column, row + 1) * (size - right) + (int32_t)random_byte(kind, column + 1, row + 1) * right;
    return (top * (size - down) + bottom * down) >> (2 * step);
}

/* -256 .. 256, like a sine with this period in frames, of parabolas. */
static int32_t wave(int32_t frame, int32_t period) {
    const int32_t turn = (frame % period) * 1024 / period, half = turn & 511;
    const int32_t height = half * (512 - half) / 256; /* 0 .. 256 */
    return turn < 512 ? height : -height;
}

static struct place place_of(int32_t frame, int32_t width, int32_t height) {
    const int32_t size = height * UNIT / 8, growth = 256 + wave(frame, 160) / 8;
    const struct place place = {width * UNIT / 2 + wave(frame, 120) * width * UNIT / (4 * 256),
                                height * UNIT / 2 + wave(frame, 75) * height * UNIT / (5 * 256), size * growth / 256 * 9 / 8,
                                size * growth / 256};
    return place;
}

ast_box small_scene_box(int32_t frame, int32_t width, int32_t height) {
    const struct place p = place_of(frame, width, height);
    const ast_box box = {(float)(p.x - p.half_width) / UNIT, (float)(p.y - p.half_height) / UNIT, (float)(2 * p.half_width) / UNIT,
                         (float)(2 * p.half_height) / UNIT};
    return box;
}

void small_scene_row(uint8_t *row, int32_t frame, int32_t y, int32_t width, int32_t height) {
    const struct place p = place_of(frame, width, height);
    for (int32_t x = 0; x < width; x++) {
        /* the thing's own coordinates, 64 units across; they carry its texture along */
        const int32_t u = (x * UNIT - p.x) * 64 / p.half_width + 64, v = (y * UNIT - p.y) * 64 / p.half_height + 64;
        int32_t tone;
        if (u >= 0 && u < 128 && v >= 0 && v < 128) {
            const int rim = u < 8 || u >= 120 || v < 8 || v >= 120;
            tone = rim ? 30 : (2 * texture(1, u, v, 5) + texture(2, u, v, 4)) / 3 * 5 / 4 - 20;
        } else {
            tone = 60 + (2 * texture(3, x, y, 4) + texture(4, x, y, 2)) / 6;
        }
        tone += (int32_t)random_byte(5u + (uint32_t)frame, (uint32_t)x, (uint32_t)y) / 32 - 4;
        row[x] = (uint8_t)(tone < 0 ? 0 : tone > 255 ? 255 : tone);
    }
}
