#include "sheet.h"

#include "canvas.h"
#include "image_write.h"

#include <string.h>

#define COLUMNS 4
#define TILE_SIDE 320 /* the longer side of a tile, pixels */
#define GAP 4         /* between tiles and around them, pixels */

static const colour background = {24, 24, 28};

void sheet_start(sheet *s, int32_t frames) {
    s->frames = frames;
    s->tiles = frames < SHEET_TILES ? frames : SHEET_TILES;
    s->drawn = 0;
}

/* The frame that belongs in a place. */
static int32_t frame_due(const sheet *s, int32_t place) {
    return s->tiles == 1 ? 0 : (int32_t)((int64_t)place * (s->frames - 1) / (s->tiles - 1));
}

/* The largest size of a frame's shape inside a tile. */
static void fit(const image *frame, int32_t limit_width, int32_t limit_height, int32_t *width, int32_t *height) {
    const float scale_x = (float)limit_width / (float)frame->width, scale_y = (float)limit_height / (float)frame->height;
    const float scale = scale_x < scale_y ? scale_x : scale_y;
    const int32_t w = (int32_t)((float)frame->width * scale + 0.5f), h = (int32_t)((float)frame->height * scale + 0.5f);
    *width = w < 1 ? 1 : w > limit_width ? limit_width : w;
    *height = h < 1 ? 1 : h > limit_height ? limit_height : h;
}

/* The first frame gives the tiles their shape. */
static bool lay_out(sheet *s, const image *frame) {
    fit(frame, TILE_SIDE, TILE_SIDE, &s->tile_width, &s->tile_height);
    const int32_t columns = s->tiles < COLUMNS ? s->tiles : COLUMNS;
    const int32_t rows = (s->tiles + COLUMNS - 1) / COLUMNS;
    return canvas_fill(&s->picture, GAP + columns * (s->tile_width + GAP), GAP + rows * (s->tile_height + GAP), background);
}

bool sheet_offer(sheet *s, int32_t frame, const annotation *a) {
    if (s->drawn == s->tiles || frame < frame_due(s, s->drawn)) return true;
    if (s->drawn == 0 && !lay_out(s, a->frame)) return false;
    int32_t width, height;
    fit(a->frame, s->tile_width, s->tile_height, &width, &height);
    if (!annotate(&s->tile, width, height, a)) return false;
    const int32_t column = s->drawn % COLUMNS, row = s->drawn / COLUMNS;
    canvas_place(&s->picture, GAP + column * (s->tile_width + GAP) + (s->tile_width - width) / 2,
                 GAP + row * (s->tile_height + GAP) + (s->tile_height - height) / 2, &s->tile);
    s->drawn += 1;
    return true;
}

bool sheet_write(const sheet *s, const char *path) {
    return image_write(path, &s->picture);
}

void sheet_free(sheet *s) {
    image_free(&s->picture);
    image_free(&s->tile);
    memset(s, 0, sizeof *s);
}
