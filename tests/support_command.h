/* The command as a shell would run it, in a directory of its own. The program is ../asttrack from where the test lies, or
 * AST_COMMAND. What goes wrong here fails the running test. */
#ifndef SUPPORT_COMMAND_H
#define SUPPORT_COMMAND_H

#include <stddef.h>
#include <sys/types.h>

enum { PATH_SIZE = 1024, TEXT_SIZE = 65536 };

/* Finds the command and makes the directory; test: argv[0] of the test program. 0, or -1 after saying what is missing. */
int command_open(const char *test);
/* Removes the directory with all that is in it. */
void command_close(void);
/* The path of a program that lies beside the test's. */
const char *program_beside(const char *test, const char *name);

/* ---- Files ---- */

/* The text with every '@' replaced by the directory and a slash; a few at a time, in turn. */
const char *at(const char *text);
int exists(const char *path);
/* The whole file as text; empty when there is none. Bytes behind it are zero. */
size_t read_file(const char *path, char *text, size_t size);
void write_file(const char *path, const void *bytes, size_t count);
void write_text(const char *path, const char *text);
void make_directory(const char *path);
int count_files(const char *path);
void remove_tree(const char *path);

/* ---- Running it ---- */

struct outcome {
    int code; /* the exit status; 1000 and the signal when one ended it */
    char out[TEXT_SIZE], err[TEXT_SIZE];
};

/* A child whose streams go to files of its own. */
struct job {
    pid_t process;
    int number;
};

/* Starts it with these arguments, parted by spaces. */
struct job start_job(int number, const char *line);
/* The same for any program; prepare, where it is not NULL, is called in the child before the program begins. */
struct job start_prepared_job(int number, const char *program, const char *line, void (*prepare)(void));
void finish_job(const struct job *job, struct outcome *outcome);
const struct outcome *run(const char *line);
/* It ends with code 0 and says nothing on stderr. */
void run_well(const char *line);
/* It ends with this code and one line on stderr that begins with the program's name and holds this text; stdout is empty. */
void run_badly(int code, const char *text, const char *line);

#endif
