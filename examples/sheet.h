/* A contact sheet: evenly spaced frames of a sequence, annotated, in one picture. */
#ifndef SHEET_H
#define SHEET_H

#include "annotate.h"

#define SHEET_TILES 12 /* frames on a sheet, where the sequence has as many */

/* Zero it before sheet_start. */
typedef struct sheet {
    image picture;        /* the sheet */
    image tile;           /* the frame being drawn */
    int32_t frames;       /* of the sequence */
    int32_t tiles, drawn; /* places on the sheet, and how many of them are filled */
    int32_t tile_width, tile_height;
} sheet;

/* frames: of the sequence, >= 1. */
void sheet_start(sheet *s, int32_t frames);
/* Offers a frame (index from 0); draws it where one is due: those that fall on the sheet are evenly spaced, first and last
 * included, and where one is missing (unreadable) the next takes its place. False when out of memory. */
bool sheet_offer(sheet *s, int32_t frame, const annotation *a);
/* Writes the picture. False after reporting why. */
bool sheet_write(const sheet *s, const char *path);
void sheet_free(sheet *s);

#endif
