/* A step in a file: a full tracker and the frames that come next, so that a new process counts instructions of the steps alone and
 * not of what leads up to them. The file is for this program on this machine. */
#ifndef COUNTING_H
#define COUNTING_H

#include "contender.h"

/* Writes the contender's tracker and the next 1 + steps frames. False after reporting why. */
bool counting_write(const struct contender *c, const char *path, int steps);
/* Reads such a file and takes the steps: the first one as it comes, for whatever the tracker keeps between frames, the others
 * inside the function counted_step, which is what callgrind counts. False after reporting why. */
bool counting_replay(const char *path);

#endif
