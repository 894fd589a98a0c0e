/* The sub-commands, and what they return to the shell. argv[0] is the sub-command's name. */
#ifndef COMMAND_H
#define COMMAND_H

enum {
    EXIT_OK = 0,
    EXIT_DATA = 1, /* a file, a frame or an output failed */
    EXIT_USAGE = 2 /* the command line is wrong */
};

int command_track(int argc, char **argv);
int command_synth(int argc, char **argv);
int command_config(int argc, char **argv);

#endif
