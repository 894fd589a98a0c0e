/* SIGXFSZ belongs to the X/Open part of POSIX */
#define _XOPEN_SOURCE 700

#include "interrupt.h"

#include <signal.h>
#include <string.h>

static volatile sig_atomic_t noted;

static void note(int number) {
    noted = number;
}

void interrupt_install(void) {
    static const int signals[] = {SIGINT, SIGTERM, SIGHUP};
    struct sigaction action;
    memset(&action, 0, sizeof action);
    sigemptyset(&action.sa_mask);
    for (size_t i = 0; i < sizeof signals / sizeof signals[0]; ++i) {
        struct sigaction present;
        /* what a parent (nohup, a background shell) had us ignore stays ignored */
        if (sigaction(signals[i], NULL, &present) != 0 || present.sa_handler == SIG_IGN) continue;
        action.sa_handler = note;
        action.sa_flags = (int)((unsigned)SA_RESTART | (unsigned)SA_RESETHAND);
        (void)sigaction(signals[i], &action, NULL);
    }
    action.sa_handler = SIG_IGN;
    action.sa_flags = 0;
    (void)sigaction(SIGPIPE, &action, NULL);
    (void)sigaction(SIGXFSZ, &action, NULL);
}

bool interrupt_pending(void) {
    return noted != 0;
}

void interrupt_deliver(void) {
    if (noted != 0) {
        (void)signal((int)noted, SIG_DFL);
        (void)raise((int)noted);
    }
}
