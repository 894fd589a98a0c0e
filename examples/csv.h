/* The CSV of a track: frame,x,y,w,h,scale,score,status. */
#ifndef CSV_H
#define CSV_H

#include <asttrack.h>

#include <stdio.h>

void csv_write_header(FILE *stream);
/* number: of the frame in its sequence, from 1. */
void csv_write_row(FILE *stream, int32_t number, const ast_result *result);

#endif
