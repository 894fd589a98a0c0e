/* The CSV of a track: frame,x,y,w,h,scale,score,status. */
#ifndef CSV_H
#define CSV_H

#include "output_file.h"

#include <asttrack.h>

void csv_write_header(output_file *output);
/* number: of the frame in its sequence, from 1. */
void csv_write_row(output_file *output, int32_t number, const ast_result *result);

#endif
