/* Where and how figures came about: what makes them comparable, or not. */
#ifndef MACHINE_H
#define MACHINE_H

#include "json.h"

enum { MACHINE_TEXT = 256 };

struct machine {
    char processor[MACHINE_TEXT]; /* its name, as the system says it */
    char compiler[MACHINE_TEXT];
    char flags[4 * MACHINE_TEXT]; /* that the library was compiled with */
    char date[32];                /* UTC, ISO 8601 */
    int cores;
    double load; /* processes that wanted a core in the minute before; nan where the system does not say */
};

struct machine machine_here(void);
/* As members of the object that is open. */
void machine_write(const struct machine *m, struct json *j);

#endif
