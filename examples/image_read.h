/* Reads PGM (P2, P5), PPM (P3, P6) and JPEG pictures as grey. The kind is told by the content, not by the name. */
#ifndef IMAGE_READ_H
#define IMAGE_READ_H

#include "image.h"

/* Zero it before the first use. Buffers grow as needed and are reused from picture to picture. */
typedef struct image_reader {
    uint8_t *file; /* the bytes of the file being read */
    size_t file_capacity;
    uint8_t *row; /* one row of RGB */
    size_t row_capacity;
    char error[256]; /* after a failure: the reason, one line, without the file's name */
} image_reader;

/* Decodes a whole file that lies in memory; any bytes are safe. On failure reader->error says why and grey is 0 x 0. */
bool image_decode(image_reader *reader, const uint8_t *data, size_t size, image *grey);
/* The same for a file. */
bool image_read(image_reader *reader, const char *path, image *grey);
void image_reader_free(image_reader *reader);

#endif
