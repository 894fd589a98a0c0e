/* A rendered sequence with known truth: one textured target before a textured, slowly panning background. It drifts and darts,
 * grows and shrinks, is hidden by two boards that pass (one in part, one fully), goes through a change of light and meets a
 * look-alike (unless it is alone); the camera has noise. Every frame is a pure function of the options, so frames can be rendered
 * in any order. */
#ifndef SCENE_H
#define SCENE_H

#include "image.h"

#define SCENE_MIN_SIDE 64
#define SCENE_MAX_SIDE 4096
#define SCENE_MAX_FRAMES 99999

typedef struct scene_options {
    int32_t width, height; /* SCENE_MIN_SIDE .. SCENE_MAX_SIDE; the target is 48 x 40 at 320 x 240, in proportion otherwise */
    int32_t frames;        /* 1 .. SCENE_MAX_FRAMES; with fewer than 200 the sequence is the beginning of the longer one */
    int32_t occlusion;     /* frames of full occlusion, in the middle */
    int32_t leave;         /* frames wholly out of view */
    int32_t cut;           /* frames of another scene */
    bool alone;            /* without the look-alike */
    uint64_t seed;
} scene_options;

typedef struct scene scene;

/* Frames until the last of the three events is over; with fewer, it is cut off or does not come at all. */
int32_t scene_frames_needed(const scene_options *options);

/* NULL when out of memory. */
scene *scene_create(const scene_options *options);
void scene_free(scene *s);
/* What there is of the target: in view, at least in part; wholly behind a board; out of the frame, or another scene is shown. */
typedef enum scene_presence { SCENE_IN_VIEW, SCENE_HIDDEN, SCENE_AWAY } scene_presence;

/* Renders a frame (from 0). *box tells where the target is, hidden or not; away it means nothing. False when out of memory. */
bool scene_render(const scene *s, int32_t frame, image *grey, ast_box *box, scene_presence *presence);

#endif
