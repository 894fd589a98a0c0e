/* How well a track fits the ground truth: the three figures of the tracking literature. Frames without truth are not counted, nor
 * are those whose box is given: they would say nothing of the tracker, and published figures are without them
 * (docs/evaluation.md). */
#ifndef METRICS_H
#define METRICS_H

#include <asttrack.h>

/* Zero it before the first frame. */
typedef struct metrics {
    double error_sum;   /* of the centre location errors, pixels */
    double overlap_sum; /* of the overlaps */
    int32_t within;     /* frames whose centre location error is at most METRICS_RADIUS */
    int32_t count;      /* frames compared */
} metrics;

#define METRICS_RADIUS 20.0 /* pixels, inclusive */

void metrics_add(metrics *m, const ast_box *estimate, const ast_box *truth);

/* Each is nan where no frame was compared. */
double metrics_centre_error(const metrics *m); /* mean distance of the box centres, pixels */
double metrics_precision(const metrics *m);    /* share of frames within METRICS_RADIUS */
/* Area under the success curve, that is the share of frames whose overlap (intersection over union) exceeds a threshold, for
 * thresholds from 0 to 1. With all thresholds rather than a grid of them this area is exactly the mean overlap. */
double metrics_success(const metrics *m);

#endif
