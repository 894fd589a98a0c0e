/* Memory between two pages that cannot be touched: a read or a write beyond it ends the program. */
#ifndef SUPPORT_PAGES_H
#define SUPPORT_PAGES_H

#include <stddef.h>

struct pages {
    unsigned char *first; /* first byte after the lower forbidden page */
    unsigned char *end;   /* first byte of the upper forbidden page */
    void *mapping;
    size_t mapping_size;
};

/* Room for at least size bytes, filled with 0xdb: a block that starts at `first` or one that ends at `end` touches a forbidden
 * page. Ends the program when there is no memory. */
void pages_open(struct pages *pages, size_t size);
/* Rows of a page each, every one between forbidden pages of its own: `first` and `end` are those of the first row, the next row
 * lies pages_row_stride() bytes on. */
void pages_open_rows(struct pages *pages, int rows);
int pages_row_stride(void);
void pages_close(struct pages *pages);

#endif
