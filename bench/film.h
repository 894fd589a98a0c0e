/* The frames that are tracked, in memory before any clock runs. They are shown forth and back without end, so that the object never
 * jumps however many steps a measurement takes. */
#ifndef FILM_H
#define FILM_H

#include <asttrack.h>

#include <stdbool.h>
#include <stdint.h>

struct film {
    char name[64];
    int32_t count, width, height;
    uint8_t *pixels; /* count frames, one after the other, rows without padding */
    ast_box start;   /* the object's box in the first frame */
};

/* The beginning of the scene that `asttrack synth` renders. False after reporting why. */
bool film_render(struct film *f, int32_t frames);
/* The beginning of a sequence on disk, grey; its frames must all have the first one's size. False after reporting why. */
bool film_read(struct film *f, const char *directory, int32_t frames);
/* Ends a film, also one that was only zeroed. */
void film_close(struct film *f);
/* The frame shown at a place, 0 and on: 0, 1, .. count - 1, count - 2, .. 0, 1, .. */
ast_frame film_frame(const struct film *f, int64_t place);

#endif
