/* The command when the machine fails it: memory, files, pipes, disks, and a kill in the middle. It says what failed and ends with a
 * code, and under the name of an output there is the whole file or what was there before. */
#define _GNU_SOURCE /* unshare */
#include <errno.h>
#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "support_command.h"
#include "support_noise.h"
#include "unity.h"

static char faulty[PATH_SIZE]; /* the command with faults on demand */
static int has_jpeg;

void setUp(void) {
}
void tearDown(void) {
}

/* The last job's error lines are the command's own, at least one. */
static void assert_explained(const struct outcome *o, const char *what) {
    char message[2 * PATH_SIZE];
    snprintf(message, sizeof message, "%s: code %d, said \"%.600s\"", what, o->code, o->err);
    TEST_ASSERT_EQUAL_INT_MESSAGE(1, o->code, message);
    TEST_ASSERT_TRUE_MESSAGE(o->err[0] != '\0', message);
    for (const char *line = o->err; *line != '\0'; line = strchr(line, '\n') + 1) {
        TEST_ASSERT_NOT_NULL_MESSAGE(strchr(line, '\n'), message);
        TEST_ASSERT_TRUE_MESSAGE(strncmp(line, "asttrack: ", 10) == 0, message);
    }
}

/* Both exist and hold the same bytes. */
static int same_files(const char *a, const char *b) {
    FILE *first = fopen(a, "rb"), *second = fopen(b, "rb");
    int same = first != NULL && second != NULL, c = 0;
    while (same && c != EOF) {
        c = getc(first);
        same = c == getc(second);
    }
    if (first != NULL) (void)fclose(first);
    if (second != NULL) (void)fclose(second);
    return same;
}

/* ---- Faults on demand ---- */

static char fault_text[64];
static void arm_fault(void) {
    (void)setenv("AST_FAULT", fault_text, 1);
    (void)setenv("AST_FAULT_REPORT", at("@calls"), 1);
}

static const struct outcome *run_with_fault(const char *kind, long number, const char *line) {
    static struct outcome outcome;
    snprintf(fault_text, sizeof fault_text, "%s:%ld", kind, number);
    const struct job job = start_prepared_job(0, faulty, line, arm_fault);
    finish_job(&job, &outcome);
    return &outcome;
}

/* Calls of a kind that the last such run made. */
static long calls_of(const char *kind) {
    char text[512], name[64];
    (void)read_file(at("@calls"), text, sizeof text);
    snprintf(name, sizeof name, "%s=", kind);
    const char *found = strstr(text, name);
    TEST_ASSERT_NOT_NULL_MESSAGE(found, text);
    return strtol(found + strlen(name), NULL, 10);
}

/* Outputs of a run, each as an earlier run without a fault left it under another name, or nothing. */
struct outputs {
    const char *directory, *expected;
    const char *names[12];
};

static void assert_whole_or_absent(const struct outputs *outputs, int all, const char *what) {
    int present = 0;
    for (int n = 0; n < 12 && outputs->names[n] != NULL; n++) {
        char path[PATH_SIZE], expected[PATH_SIZE], message[2 * PATH_SIZE];
        snprintf(path, sizeof path, "%s/%s", at(outputs->directory), outputs->names[n]);
        snprintf(expected, sizeof expected, "%s/%s", at(outputs->expected), outputs->names[n]);
        snprintf(message, sizeof message, "%s: %s", what, outputs->names[n]);
        TEST_ASSERT_TRUE_MESSAGE(!all || exists(path), message);
        if (!exists(path)) continue;
        TEST_ASSERT_TRUE_MESSAGE(same_files(path, expected), message);
        present++;
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(present, count_files(at(outputs->directory)), what); /* and nothing beside them */
}

/* Every call of the kind fails once. line: writes into outputs->directory, which is made anew each time. */
static void fail_every_call(const char *kind, const struct outputs *outputs, const char *line) {
    int failed = 0;
    remove_tree(at(outputs->directory));
    make_directory(at(outputs->directory));
    TEST_ASSERT_EQUAL_INT(0, run_with_fault(kind, 0, line)->code);
    const long calls = calls_of(kind);
    for (long number = 1; number <= calls; number++) {
        char what[PATH_SIZE];
        snprintf(what, sizeof what, "%s %ld of \"%s\"", kind, number, line);
        remove_tree(at(outputs->directory));
        make_directory(at(outputs->directory));
        const struct outcome *o = run_with_fault(kind, number, line);
        /* a frame that could not be read is skipped, and memory that only makes a stream faster is not missed */
        const int skipped = strstr(o->err, "frame skipped") != NULL;
        if (o->code != 0 || skipped) {
            failed++;
            if (!skipped) assert_explained(o, what);
        }
        if (!skipped) assert_whole_or_absent(outputs, o->code == 0, what);
    }
    char figures[PATH_SIZE];
    snprintf(figures, sizeof figures, "%s: %d of %ld calls failed the run: %s", kind, failed, calls, line);
    puts(figures);
    TEST_ASSERT_TRUE_MESSAGE(failed > 0, figures);
}

static const char *const kinds[] = {"allocation", "open", "write", "close", "rename"};
enum { FAULT_KINDS = sizeof kinds / sizeof kinds[0] };

static void test_track_survives_every_fault(void) {
    const char *line =
        "track @three --preset tiny --csv @out/track.csv --sheet @out/sheet.ppm --annotate @out/drawn --set particles=20";
    static const char *const jpegs[] = {"drawn/00001.jpg", "drawn/00002.jpg", "drawn/00003.jpg"};
    static const char *const ppms[] = {"drawn/00001.ppm", "drawn/00002.ppm", "drawn/00003.ppm"};
    struct outputs outputs = {"@out", "@expected", {"track.csv", "sheet.ppm"}};
    for (int f = 0; f < 3; f++) outputs.names[2 + f] = has_jpeg ? jpegs[f] : ppms[f];
    make_directory(at("@out"));
    TEST_ASSERT_EQUAL_INT(0, run_with_fault("allocation", 0, line)->code);
    TEST_ASSERT_EQUAL_INT(5, count_files(at("@out")));
    TEST_ASSERT_EQUAL_INT(0, rename(at("@out"), at("@expected")));
    for (int k = 0; k < FAULT_KINDS; k++) fail_every_call(kinds[k], &outputs, line);
    fail_every_call("read", &outputs, line);
}

static void test_synth_survives_every_fault(void) {
    static const struct outputs outputs = {
        "@made/scene", "@three", {"groundtruth.txt", "absence.label", "img/00001.pgm", "img/00002.pgm", "img/00003.pgm"}};
    make_directory(at("@made"));
    for (int k = 0; k < FAULT_KINDS; k++) fail_every_call(kinds[k], &outputs, "synth @made/scene --frames 3 --size 80x64");
}

/* What a shell shows of a configuration goes through one buffer; its arguments do not. */
static void test_config_survives_every_fault(void) {
    const char *line = "config --set particles=20 --set sigma=2";
    long failed = 0;
    TEST_ASSERT_EQUAL_INT(0, run_with_fault("allocation", 0, line)->code);
    const long calls = calls_of("allocation");
    for (long number = 1; number <= calls; number++) {
        const struct outcome *o = run_with_fault("allocation", number, line);
        if (o->code != 0) assert_explained(o, "config");
        failed += o->code != 0;
    }
    TEST_ASSERT_TRUE(failed > 0);
}

/* Reads and writes that move a part of what was asked for, as those of pipes and signals do. */
static void test_short_reads_and_writes(void) {
    run_well("track @three --preset tiny --csv @long.csv --sheet @long.ppm");
    const struct outcome *o = run_with_fault("short", 1, "track @three --preset tiny --csv @short.csv --sheet @short.ppm");
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, o->code, o->err);
    TEST_ASSERT_TRUE(calls_of("write") > 10);
    TEST_ASSERT_TRUE(same_files(at("@long.csv"), at("@short.csv")));
    TEST_ASSERT_TRUE(same_files(at("@long.ppm"), at("@short.ppm")));
}

/* Frames that come through pipes in drops; a pipe for each, as the end of one is only seen when no writer has opened it again. */
static void test_frames_from_pipes(void) {
    static const char *const pipes[] = {"@first.pgm", "@second.pgm"};
    static char bytes[TEXT_SIZE];
    static struct outcome outcome;
    const size_t size = read_file(at("@three/img/00001.pgm"), bytes, sizeof bytes);
    run_well("track @three/img/00001.pgm @three/img/00001.pgm --box 20,15,16,14 --preset tiny --csv @plain.csv");
    for (int frame = 0; frame < 2; frame++) TEST_ASSERT_EQUAL_INT(0, mkfifo(at(pipes[frame]), 0600));
    const struct job job = start_job(0, "track @first.pgm @second.pgm --box 20,15,16,14 --preset tiny --csv @piped.csv");
    for (int frame = 0; frame < 2; frame++) {
        const int pipe = open(at(pipes[frame]), O_WRONLY);
        TEST_ASSERT_TRUE(pipe >= 0);
        for (size_t i = 0; i < size; i += 97) {
            const size_t count = size - i < 97 ? size - i : 97;
            TEST_ASSERT_EQUAL_INT((int)count, (int)write(pipe, bytes + i, count));
        }
        TEST_ASSERT_EQUAL_INT(0, close(pipe));
    }
    finish_job(&job, &outcome);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, outcome.code, outcome.err);
    TEST_ASSERT_TRUE(same_files(at("@plain.csv"), at("@piped.csv")));
}

/* ---- Streams ---- */

static void break_stdout(void) {
    int ends[2];
    if (pipe(ends) != 0 || dup2(ends[1], STDOUT_FILENO) < 0) _exit(127);
    (void)close(ends[0]);
    (void)close(ends[1]);
}

static void fill_stdout(void) {
    const int full = open("/dev/full", O_WRONLY);
    if (full < 0 || dup2(full, STDOUT_FILENO) < 0) _exit(127);
}

static void close_stdout(void) {
    (void)close(STDOUT_FILENO);
}

static void close_stderr(void) {
    (void)close(STDERR_FILENO);
}

static void close_all(void) {
    for (int file = 0; file <= STDERR_FILENO; file++) (void)close(file);
}

static const struct outcome *run_prepared(const char *line, void (*prepare)(void)) {
    static struct outcome outcome;
    const struct job job = start_prepared_job(0, program_beside(faulty, "../asttrack"), line, prepare);
    finish_job(&job, &outcome);
    return &outcome;
}

static void test_stdout_that_takes_nothing(void) {
    static void (*const ways[])(void) = {break_stdout, fill_stdout, close_stdout};
    static const char *const lines[] = {"track @three --preset tiny", "config", "--help", "--version",
                                        "track @three --preset tiny --csv /dev/stdout"};
    for (size_t w = 0; w < sizeof ways / sizeof ways[0]; w++) {
        for (size_t l = 0; l < (ways[w] == close_stdout ? 4 : sizeof lines / sizeof lines[0]); l++) {
            const struct outcome *o = run_prepared(lines[l], ways[w]);
            assert_explained(o, lines[l]);
            TEST_ASSERT_NOT_NULL_MESSAGE(strstr(o->err, l < 4 ? "standard output: " : "/dev/stdout: "), o->err);
        }
    }
}

/* A file that is opened while a standard stream is closed must not become that stream. */
static void test_closed_streams_do_not_get_into_files(void) {
    static void (*const ways[])(void) = {close_stdout, close_stderr, close_all};
    run_well("track @three --preset tiny --csv @whole.csv");
    TEST_ASSERT_EQUAL_INT(0, run("track @torn --preset tiny --csv @torn.csv")->code); /* which has something to say on stderr */
    for (size_t w = 0; w < sizeof ways / sizeof ways[0]; w++) {
        (void)run_prepared("track @three --preset tiny --csv @closed.csv", ways[w]);
        TEST_ASSERT_TRUE(same_files(at("@whole.csv"), at("@closed.csv")));
        (void)run_prepared("track @torn --preset tiny --csv @closed.csv", ways[w]);
        TEST_ASSERT_TRUE(same_files(at("@torn.csv"), at("@closed.csv")));
    }
}

/* A link to nothing, as /dev/stdout is one when that stream is closed, stays a link. */
static void test_link_to_nothing_stays(void) {
    struct stat status;
    TEST_ASSERT_EQUAL_INT(0, symlink("nothing", at("@link.csv")));
    assert_explained(run("track @three --preset tiny --csv @link.csv"), "a link to nothing");
    TEST_ASSERT_EQUAL_INT(0, lstat(at("@link.csv"), &status));
    TEST_ASSERT_TRUE(S_ISLNK(status.st_mode));
    TEST_ASSERT_FALSE(exists(at("@nothing")));
}

/* ---- Disks ---- */

static void limit_files(void) {
    const struct rlimit limit = {100, 100};
    if (setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(127);
}

static void expect_nothing_written(const char *directory, const char *line, void (*prepare)(void), const char *reason) {
    const struct outcome *o = run_prepared(line, prepare);
    assert_explained(o, line);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(o->err, reason), o->err);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, count_files(at(directory)), line);
}

static void test_limit_on_file_sizes(void) {
    make_directory(at("@limited"));
    expect_nothing_written("@limited", "track @three --preset tiny --csv @limited/track.csv", limit_files, strerror(EFBIG));
    expect_nothing_written("@limited", "track @three --preset tiny --annotate @limited/drawn", limit_files, strerror(EFBIG));
    expect_nothing_written("@limited", "synth @limited/scene --frames 3 --size 80x64", limit_files, strerror(EFBIG));
}

static int write_line(const char *path, const char *line) {
    const int file = open(path, O_WRONLY);
    const int written = file >= 0 && write(file, line, strlen(line)) == (ssize_t)strlen(line);
    if (file >= 0) (void)close(file);
    return written;
}

/* A view of the file systems that this process alone has. Who is not the superuser becomes so for it, under the same number,
 * without which no file could be made in what is mounted. */
static int own_mounts(void) {
    const unsigned user = (unsigned)geteuid(), group = (unsigned)getegid();
    char users[64], groups[64];
    if (unshare(CLONE_NEWNS) == 0) return 1;
    snprintf(users, sizeof users, "%u %u 1", user, user);
    snprintf(groups, sizeof groups, "%u %u 1", group, group);
    return unshare(CLONE_NEWUSER | CLONE_NEWNS) == 0 && write_line("/proc/self/setgroups", "deny") &&
           write_line("/proc/self/uid_map", users) && write_line("/proc/self/gid_map", groups);
}

/* A disk of 16 KiB; it is gone with the process, so this test comes last. */
static void test_full_disk(void) {
    make_directory(at("@disk"));
    if (!own_mounts())
        TEST_IGNORE_MESSAGE("no mount namespace may be made here: the full disk is left to /dev/full and the limit on file sizes");
    (void)mount("none", "/", "none", MS_REC | MS_PRIVATE, NULL);
    if (mount("tmpfs", at("@disk"), "tmpfs", 0, "size=16k,nr_inodes=32") != 0)
        TEST_IGNORE_MESSAGE("no tmpfs may be mounted here: the full disk is left to /dev/full and the limit on file sizes");
    expect_nothing_written("@disk", "track @three --preset tiny --sheet @disk/sheet.ppm", NULL, strerror(ENOSPC));
    assert_explained(run("synth @disk/scene --frames 12 --size 96x72"), "synth");
    TEST_ASSERT_FALSE(exists(at("@disk/scene/groundtruth.txt")));
    TEST_ASSERT_TRUE(count_files(at("@disk/scene")) < 3); /* the frames that fitted, no part of another */
    for (int f = 1; f <= 12; f++) {
        char name[64];
        struct stat status;
        snprintf(name, sizeof name, "@disk/scene/img/%05d.pgm", f);
        if (stat(at(name), &status) == 0) TEST_ASSERT_EQUAL_INT(13 + 96 * 72, status.st_size);
    }
    remove_tree(at("@disk/scene"));
    run_well("track @three --preset tiny --csv @disk/track.csv"); /* it fits once there is room */
    (void)umount(at("@disk"));
}

/* ---- Kills ---- */

/* Whether a picture of the given size, a JPEG, or a text ends as it should. */
static void assert_whole_file(const char *path) {
    static char bytes[4 * TEXT_SIZE];
    const size_t size = read_file(path, bytes, sizeof bytes);
    int width = 0, height = 0, used = 0;
    if (strstr(path, ".jpg") != NULL) {
        TEST_ASSERT_TRUE_MESSAGE(size > 100 && memcmp(bytes + size - 2, "\xff\xd9", 2) == 0, path);
    } else if (sscanf(bytes, "P%*c\n%d %d\n255\n%n", &width, &height, &used) == 2) {
        TEST_ASSERT_EQUAL_UINT_MESSAGE((size_t)used + (size_t)width * (size_t)height * (bytes[1] == '6' ? 3 : 1), size, path);
    } else {
        int lines = 0;
        for (size_t i = 0; i < size; i++) lines += bytes[i] == '\n';
        TEST_ASSERT_TRUE_MESSAGE(lines == (strstr(path, ".csv") != NULL ? 61 : 60) && bytes[size - 1] == '\n', path);
    }
}

static int assert_whole_outputs(const char *pattern, int count) {
    int present = 0;
    for (int f = 1; f <= count; f++) {
        char name[64];
        snprintf(name, sizeof name, pattern, f);
        if (!exists(at(name))) continue;
        assert_whole_file(at(name));
        present++;
    }
    return present;
}

static void test_kill_leaves_no_half_files(void) {
    enum { ROUNDS = 12, FRAMES = 60 };
    struct noise noise = {(uint64_t)getpid()};
    int cut = 0;
    for (int round = 0; round < ROUNDS; round++) {
        static struct outcome outcome;
        const int synth = round % 2;
        remove_tree(at("@killed"));
        make_directory(at("@killed"));
        const struct job job = start_job(0, synth ? "synth @killed/scene --frames 60 --size 160x120"
                                                  : "track @sixty --preset tiny --csv @killed/track.csv --annotate @killed/drawn");
        const struct timespec moment = {0, (long)(noise_uniform(&noise) * (round < 2 ? 20e6 : 150e6))};
        (void)nanosleep(&moment, NULL);
        (void)kill(job.process, SIGKILL);
        finish_job(&job, &outcome);
        TEST_ASSERT_TRUE(outcome.code == 1000 + SIGKILL || outcome.code == 0);
        const char *pattern = synth ? "@killed/scene/img/%05d.pgm" : has_jpeg ? "@killed/drawn/%05d.jpg" : "@killed/drawn/%05d.ppm";
        const int frames = assert_whole_outputs(pattern, FRAMES);
        const int whole = assert_whole_outputs(synth ? "@killed/scene/groundtruth.txt" : "@killed/track.csv", 1);
        TEST_ASSERT_TRUE(!synth || !whole || frames == FRAMES); /* the ground truth comes last */
        cut += frames > 0 && frames < FRAMES;
    }
    printf("killed %d times, %d of them in the middle of %d frames\n", ROUNDS, cut, FRAMES);
    /* what a kill leaves behind is in nobody's way */
    run_well("synth @killed/scene --frames 60 --size 160x120");
    TEST_ASSERT_EQUAL_INT(FRAMES, assert_whole_outputs("@killed/scene/img/%05d.pgm", FRAMES));
}

/* ---- Set-up ---- */

static void make_inputs(void) {
    static char bytes[TEXT_SIZE];
    run_well("synth @three --frames 3 --size 80x64");
    run_well("synth @torn --frames 3 --size 80x64");
    run_well("synth @sixty --frames 60 --size 160x120");
    const size_t size = read_file(at("@torn/img/00002.pgm"), bytes, sizeof bytes);
    write_file(at("@torn/img/00002.pgm"), bytes, size / 2);
    has_jpeg = strstr(run("--version")->out, "JPEG: yes") != NULL;
}

int main(int argc, char **argv) {
    (void)argc;
    if (command_open(argv[0]) != 0) return 1;
    snprintf(faulty, sizeof faulty, "%s", program_beside(argv[0], "asttrack-faulty"));
    if (access(faulty, X_OK) != 0) {
        perror(faulty);
        return 1;
    }
    UNITY_BEGIN();
    RUN_TEST(make_inputs);
    RUN_TEST(test_track_survives_every_fault);
    RUN_TEST(test_synth_survives_every_fault);
    RUN_TEST(test_config_survives_every_fault);
    RUN_TEST(test_short_reads_and_writes);
    RUN_TEST(test_frames_from_pipes);
    RUN_TEST(test_stdout_that_takes_nothing);
    RUN_TEST(test_closed_streams_do_not_get_into_files);
    RUN_TEST(test_link_to_nothing_stays);
    RUN_TEST(test_limit_on_file_sizes);
    RUN_TEST(test_kill_leaves_no_half_files);
    RUN_TEST(test_full_disk);
    command_close();
    return UNITY_END();
}
