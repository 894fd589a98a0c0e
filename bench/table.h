/* Tables on stdout: a line has a title and cells of one width. */
#ifndef TABLE_H
#define TABLE_H

#include "statistics.h"

#if defined(__GNUC__)
#define TABLE_FORMAT __attribute__((format(printf, 1, 2)))
#else
#define TABLE_FORMAT
#endif

void table_begin(const char *title);
void table_cell(const char *format, ...) TABLE_FORMAT;
/* "median (least .. greatest)", each times unit, with so many digits behind the point; "-" where there is no sample. */
void table_spread(struct spread s, double unit, int digits);
void table_end(void);

#endif
