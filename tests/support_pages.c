#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */
#include "support_pages.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

void pages_open(struct pages *pages, size_t size) {
    const size_t page = (size_t)sysconf(_SC_PAGESIZE), inside = (size + page - 1) / page * page;
    pages->mapping_size = inside + 2 * page;
    pages->mapping = mmap(NULL, pages->mapping_size, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (pages->mapping == MAP_FAILED || mprotect((unsigned char *)pages->mapping + page, inside, PROT_READ | PROT_WRITE) != 0) {
        perror("guarded pages");
        exit(1);
    }
    pages->first = (unsigned char *)pages->mapping + page;
    pages->end = pages->first + inside;
    memset(pages->first, 0xdb, inside);
}

void pages_open_rows(struct pages *pages, int rows) {
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    pages->mapping_size = (2 * (size_t)rows + 1) * page;
    pages->mapping = mmap(NULL, pages->mapping_size, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (pages->mapping == MAP_FAILED) {
        perror("guarded rows");
        exit(1);
    }
    pages->first = (unsigned char *)pages->mapping + page;
    pages->end = pages->first + page;
    for (int r = 0; r < rows; r++) {
        if (mprotect(pages->first + (size_t)r * 2 * page, page, PROT_READ | PROT_WRITE) != 0) {
            perror("guarded rows");
            exit(1);
        }
    }
}

int pages_row_stride(void) {
    return 2 * (int)sysconf(_SC_PAGESIZE);
}

void pages_close(struct pages *pages) {
    (void)munmap(pages->mapping, pages->mapping_size);
}
