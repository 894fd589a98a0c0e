/* Runs a harness over files instead of a fuzzer's inventions: those named on the command line, or its corpus. Linked with a harness
 * by any compiler; prints a summary as the other test programs do, a file a test. A crash ends the program and names the file. */
#define _POSIX_C_SOURCE 200809L
#include <dirent.h>
#include <errno.h>
#include <sys/stat.h>

#include "bytes.h"

enum { PATH_SIZE = 1024 };

static int files;

static void replay_file(const char *path) {
    FILE *stream = fopen(path, "rb");
    struct stat status;
    if (stream == NULL || fstat(fileno(stream), &status) != 0) {
        perror(path);
        exit(1);
    }
    const size_t size = (size_t)status.st_size;
    uint8_t *data = exactly(size);
    if (fread(data, 1, size, stream) != size) {
        perror(path);
        exit(1);
    }
    (void)fclose(stream);
    printf("%s\n", path);
    (void)fflush(stdout); /* the last line of a program that crashes */
    (void)LLVMFuzzerTestOneInput(data, size);
    free(data);
    files++;
}

static void replay_directory(const char *directory) {
    struct dirent **entries = NULL;
    const int count = scandir(directory, &entries, NULL, alphasort);
    if (count < 0) {
        perror(directory);
        exit(1);
    }
    for (int i = 0; i < count; i++) {
        char path[PATH_SIZE];
        if (entries[i]->d_name[0] != '.') {
            const int length = snprintf(path, sizeof path, "%s/%s", directory, entries[i]->d_name);
            REQUIRE(length > 0 && length < PATH_SIZE);
            replay_file(path);
        }
        free(entries[i]);
    }
    free(entries);
}

/* Beside this source: corpus/NAME for a program called fuzz_NAME. */
static void replay_corpus(const char *program) {
    char directory[PATH_SIZE];
    const char *slash = strrchr(__FILE__, '/'), *base = strrchr(program, '/'), *name = strchr(base != NULL ? base : program, '_');
    REQUIRE(name != NULL);
    const int length =
        snprintf(directory, sizeof directory, "%.*scorpus/%s", slash != NULL ? (int)(slash - __FILE__ + 1) : 0, __FILE__, name + 1);
    REQUIRE(length > 0 && length < PATH_SIZE);
    replay_directory(directory);
}

int main(int argc, char **argv) {
    if (argc < 2) replay_corpus(argv[0]);
    for (int i = 1; i < argc; i++) {
        struct stat status;
        if (stat(argv[i], &status) == 0 && S_ISDIR(status.st_mode))
            replay_directory(argv[i]);
        else
            replay_file(argv[i]);
    }
    printf("%d Tests 0 Failures 0 Ignored\n", files);
    return files > 0 ? 0 : 1;
}
