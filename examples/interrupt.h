/* Ctrl-C and its kin: long loops stop between two frames, so that temporary files are removed before the process ends. */
#ifndef INTERRUPT_H
#define INTERRUPT_H

#include <stdbool.h>

/* Notes SIGINT, SIGTERM and SIGHUP from here on (a second one ends the process at once), and ignores SIGPIPE and SIGXFSZ: a closed
 * pipe or a limit on the size of files becomes an error of the write, which is reported like any other. */
void interrupt_install(void);
/* True once such a signal has come. */
bool interrupt_pending(void);
/* Ends the process by the noted signal, as if it had never been caught, so that a calling shell sees the right cause. Returns
 * where none is noted. */
void interrupt_deliver(void);

#endif
