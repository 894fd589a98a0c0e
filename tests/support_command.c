#define _XOPEN_SOURCE 700
#include "support_command.h"

#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "unity.h"

enum { MOST_ARGUMENTS = 24 };

static char command[PATH_SIZE];   /* the program */
static char directory[PATH_SIZE]; /* for all files of the tests */

/* ---- Files ---- */

const char *at(const char *text) {
    static char paths[16][PATH_SIZE];
    static int next;
    char *path = paths[next++ % 16];
    size_t used = 0;
    for (; *text != '\0'; text++) {
        const int more = *text == '@' ? snprintf(path + used, PATH_SIZE - used, "%s/", directory)
                                      : snprintf(path + used, PATH_SIZE - used, "%c", *text);
        used += (size_t)more;
        TEST_ASSERT_TRUE(used < PATH_SIZE);
    }
    path[used] = '\0';
    return path;
}

int exists(const char *path) {
    struct stat status;
    return stat(path, &status) == 0;
}

size_t read_file(const char *path, char *text, size_t size) {
    FILE *stream = fopen(path, "rb");
    memset(text, 0, size);
    if (stream == NULL) return 0;
    const size_t count = fread(text, 1, size - 1, stream);
    (void)fclose(stream);
    return count;
}

void write_file(const char *path, const void *bytes, size_t count) {
    FILE *stream = fopen(path, "wb");
    TEST_ASSERT_NOT_NULL_MESSAGE(stream, path);
    TEST_ASSERT_EQUAL_UINT(count, fwrite(bytes, 1, count, stream));
    TEST_ASSERT_EQUAL_INT(0, fclose(stream));
}

void write_text(const char *path, const char *text) {
    write_file(path, text, strlen(text));
}

void make_directory(const char *path) {
    TEST_ASSERT_TRUE_MESSAGE(mkdir(path, 0777) == 0 || errno == EEXIST, path);
}

static int remove_entry(const char *path, const struct stat *status, int kind, struct FTW *where) {
    (void)status;
    (void)kind;
    (void)where;
    return remove(path);
}

void remove_tree(const char *path) {
    (void)nftw(path, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
}

static int counted_files;
static int count_entry(const char *path, const struct stat *status, int kind, struct FTW *where) {
    (void)path;
    (void)status;
    (void)where;
    counted_files += kind == FTW_F;
    return 0;
}

int count_files(const char *path) {
    counted_files = 0;
    (void)nftw(path, count_entry, 16, FTW_PHYS);
    return counted_files;
}

/* ---- Running the command ---- */

static const char *stream_path(const struct job *job, const char *name) {
    char text[64];
    snprintf(text, sizeof text, "@%s.%d", name, job->number);
    return at(text);
}

struct job start_job(int number, const char *line) {
    return start_prepared_job(number, command, line, NULL);
}

struct job start_prepared_job(int number, const char *program, const char *line, void (*prepare)(void)) {
    struct job job = {0, number};
    char words[PATH_SIZE], name[PATH_SIZE], *arguments[MOST_ARGUMENTS] = {name}, *rest = NULL;
    int count = 1;
    snprintf(words, sizeof words, "%s", at(line));
    snprintf(name, sizeof name, "%s", program);
    for (char *word = strtok_r(words, " ", &rest); word != NULL; word = strtok_r(NULL, " ", &rest)) {
        TEST_ASSERT_TRUE(count < MOST_ARGUMENTS - 1);
        arguments[count++] = word;
    }
    arguments[count] = NULL;
    const char *out_path = stream_path(&job, "stdout"), *err_path = stream_path(&job, "stderr");
    (void)fflush(stdout);
    job.process = fork();
    TEST_ASSERT_TRUE(job.process >= 0);
    if (job.process == 0) {
        const int null = open("/dev/null", O_RDONLY), out = open(out_path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
        const int err = open(err_path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
        if (null >= 0 && out >= 0 && err >= 0 && dup2(null, 0) >= 0 && dup2(out, 1) >= 0 && dup2(err, 2) >= 0) {
            if (prepare != NULL) prepare();
            (void)execv(program, arguments);
        }
        _exit(127);
    }
    return job;
}

void finish_job(const struct job *job, struct outcome *outcome) {
    int status = 0;
    TEST_ASSERT_EQUAL_INT(job->process, waitpid(job->process, &status, 0));
    outcome->code = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
    (void)read_file(stream_path(job, "stdout"), outcome->out, sizeof outcome->out);
    (void)read_file(stream_path(job, "stderr"), outcome->err, sizeof outcome->err);
}

const struct outcome *run(const char *line) {
    static struct outcome outcome;
    const struct job job = start_job(0, line);
    finish_job(&job, &outcome);
    return &outcome;
}

void run_well(const char *line) {
    const struct outcome *o = run(line);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, o->code, o->err[0] != '\0' ? o->err : line);
    TEST_ASSERT_EQUAL_STRING_MESSAGE("", o->err, line);
}

void run_badly(int code, const char *text, const char *line) {
    const struct outcome *o = run(line);
    char message[2 * PATH_SIZE];
    const char *end = strchr(o->err, '\n');
    snprintf(message, sizeof message, "%s: said \"%.600s\"", line, o->err);
    TEST_ASSERT_EQUAL_INT_MESSAGE(code, o->code, message);
    TEST_ASSERT_TRUE_MESSAGE(strncmp(o->err, "asttrack: ", 10) == 0, message);
    TEST_ASSERT_TRUE_MESSAGE(end != NULL && end[1] == '\0', message);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(o->err, at(text)), message);
    TEST_ASSERT_EQUAL_STRING_MESSAGE("", o->out, message);
}

/* ---- Beginning and end ---- */

const char *program_beside(const char *test, const char *name) {
    static char path[PATH_SIZE];
    const char *slash = strrchr(test, '/');
    snprintf(path, sizeof path, "%.*s%s", slash != NULL ? (int)(slash - test + 1) : 0, test, name);
    return path;
}

int command_open(const char *test) {
    const char *given = getenv("AST_COMMAND"), *temporary = getenv("TMPDIR");
    snprintf(command, sizeof command, "%s", given != NULL ? given : program_beside(test, "../asttrack"));
    snprintf(directory, sizeof directory, "%s/asttrack-test-XXXXXX", temporary != NULL ? temporary : "/tmp");
    if (access(command, X_OK) == 0 && mkdtemp(directory) != NULL) return 0;
    perror(access(command, X_OK) != 0 ? command : directory);
    return -1;
}

void command_close(void) {
    remove_tree(directory);
}
