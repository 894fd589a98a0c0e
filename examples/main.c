/* asttrack: the command. Picks the sub-command and turns its outcome into the exit code. */
#include "command.h"
#include "image_jpeg.h"
#include "interrupt.h"
#include "report.h"

#include <asttrack.h>

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const struct {
    const char *name;
    int (*run)(int argc, char **argv);
    const char *help;
} commands[] = {
    {"track", command_track, "follow an object through a sequence of pictures"},
    {"synth", command_synth, "render a sequence with known truth"},
    {"config", command_config, "show a configuration and the memory that it takes"},
};

static void print_help(FILE *stream) {
    fprintf(stream, "usage: asttrack COMMAND [arguments]\n\n");
    for (size_t i = 0; i < sizeof commands / sizeof commands[0]; ++i) {
        fprintf(stream, "  %-12s %s\n", commands[i].name, commands[i].help);
    }
    fprintf(stream, "  %-12s %s\n", "--version", "the library's version and what this build has");
    fprintf(stream, "\n`asttrack COMMAND --help` tells more. Exit code: 0 fine, 1 a file or an output failed, 2 wrong usage.\n");
}

static int run(int argc, char **argv) {
    if (argc < 2) {
        report_error("no command given (asttrack --help lists them)");
        return EXIT_USAGE;
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0 || strcmp(argv[1], "help") == 0) {
        print_help(stdout);
        return EXIT_OK;
    }
    if (strcmp(argv[1], "--version") == 0) {
        printf("asttrack %s\nlinear algebra: %s\nJPEG: %s\n", ast_version(), ast_backend(), image_jpeg_available() ? "yes" : "no");
        return EXIT_OK;
    }
    for (size_t i = 0; i < sizeof commands / sizeof commands[0]; ++i) {
        if (strcmp(argv[1], commands[i].name) == 0) return commands[i].run(argc - 1, argv + 1);
    }
    report_error("%s: unknown command (asttrack --help lists them)", argv[1]);
    return EXIT_USAGE;
}

/* Takes the place of a standard stream that the caller closed, so that no file becomes that stream by being opened next. Each is
 * open the wrong way round: to use it is still an error. Nothing is open here but the streams, so the least number free is the
 * right one. */
static void occupy_standard_streams(void) {
    for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor) {
        if (fcntl(descriptor, F_GETFD) >= 0) continue;
        if (open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY) != descriptor) return;
    }
}

/* What printf could not write shows only here. */
static int finish_stdout(int code) {
    errno = 0;
    if (fflush(stdout) == 0 && !ferror(stdout)) return code;
    report_error("standard output: %s", errno != 0 ? strerror(errno) : "cannot write");
    return code == EXIT_OK ? EXIT_DATA : code;
}

int main(int argc, char **argv) {
    occupy_standard_streams();
    interrupt_install();
    const int code = finish_stdout(run(argc, argv));
    interrupt_deliver();
    return code;
}
