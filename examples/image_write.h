/* Writes PGM, PPM and, where built in, JPEG pictures, the kind told by the name's extension. */
#ifndef IMAGE_WRITE_H
#define IMAGE_WRITE_H

#include "image.h"

/* Whether the extension names a kind that this build writes and that holds so many channels (a .pgm is grey); false after
 * reporting otherwise. Lets a command refuse a bad name before it has worked for minutes. */
bool image_write_supports(const char *path, int32_t channels);
/* Writes the picture, whole or not at all. False after reporting why. */
bool image_write(const char *path, const image *picture);

#endif
