/* What the command makes of a directory: the order of its frames. The lists in tests/sequences are the Python
 * package's, too. */
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "sequence.h"
#include "support_command.h"
#include "unity.h"

enum { MOST_NAMES = 100, NAME_SIZE = 256 };

void setUp(void) {
}
void tearDown(void) {
}

/* The next line of a list that is neither empty nor a comment, without its end; false where there is none. */
static bool next_line(FILE *list, char *line, int size) {
    while (fgets(line, size, list) != NULL) {
        TEST_ASSERT_NOT_NULL_MESSAGE(strchr(line, '\n'), line);
        line[strcspn(line, "\n")] = '\0';
        if (line[0] != '\0' && line[0] != '#') return true;
    }
    return false;
}

static FILE *open_list(const char *path) {
    FILE *list = fopen(path, "rb");
    TEST_ASSERT_NOT_NULL_MESSAGE(list, path);
    return list;
}

/* An empty file in the directory. */
static void touch(const char *directory, const char *name) {
    char path[PATH_SIZE + NAME_SIZE];
    snprintf(path, sizeof path, "%s/%s", directory, name);
    write_text(path, "");
}

/* ---- Frames ---- */

static void test_frames_come_in_natural_order(void) {
    static char names[MOST_NAMES][NAME_SIZE];
    static const char *const others[] = {"notes.txt", "cover.pgm", ".1.pgm", "1", "1.pgm.part", "\xd9\xa3.pgm"};
    const char *directory = at("@order");
    char **found;
    int32_t count = 0, expected = 0;
    FILE *list = open_list("tests/sequences/frame_names.txt");
    while (next_line(list, names[expected], NAME_SIZE)) {
        expected++;
        TEST_ASSERT_TRUE(expected < MOST_NAMES);
    }
    (void)fclose(list);
    TEST_ASSERT_TRUE(expected > 40);
    make_directory(directory);
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) touch(directory, others[i]);
    for (int32_t i = 0; i < expected; i++) touch(directory, names[i]);

    TEST_ASSERT_TRUE(sequence_list(directory, &found, &count));
    for (int32_t i = 0; i < count && i < expected; i++) TEST_ASSERT_EQUAL_STRING(names[i], found[i]);
    TEST_ASSERT_EQUAL_INT32(expected, count);
    sequence_free_names(found, count);
}

static void test_the_same_frame_twice_is_refused(void) {
    char line[2 * NAME_SIZE], text[PATH_SIZE], first[NAME_SIZE], second[NAME_SIZE];
    int pairs = 0;
    FILE *list = open_list("tests/sequences/same_frames.txt");
    for (; next_line(list, line, sizeof line); pairs++) {
        TEST_ASSERT_EQUAL_INT_MESSAGE(2, sscanf(line, "%255s %255s", first, second), line);
        const char *directory = at("@twice");
        remove_tree(directory);
        make_directory(directory);
        touch(directory, second);
        touch(directory, first);
        snprintf(text, sizeof text, "asttrack: %s: %s and %s have the same number\n", directory, first, second);
        run_badly(1, text, "track @twice --box 1,1,8,8");
    }
    (void)fclose(list);
    TEST_ASSERT_TRUE(pairs > 4);
}

/* Frames without padding are tracked as those with it. */
static void test_unpadded_frames_are_tracked_in_order(void) {
    static char picture[TEXT_SIZE], padded[TEXT_SIZE], unpadded[TEXT_SIZE];
    run_well("synth @padded --frames 12 --size 96x72");
    make_directory(at("@unpadded"));
    (void)read_file(at("@padded/groundtruth.txt"), padded, sizeof padded);
    write_text(at("@unpadded/groundtruth.txt"), padded);
    for (int i = 1; i <= 12; i++) {
        char name[64];
        snprintf(name, sizeof name, "@padded/img/%05d.pgm", i);
        const size_t size = read_file(at(name), picture, sizeof picture);
        snprintf(name, sizeof name, "@unpadded/%d.pgm", i);
        write_file(at(name), picture, size);
    }
    run_well("track @padded --preset tiny --csv @padded.csv");
    run_well("track @unpadded --preset tiny --csv @unpadded.csv");
    TEST_ASSERT_TRUE(read_file(at("@padded.csv"), padded, sizeof padded) > 400);
    (void)read_file(at("@unpadded.csv"), unpadded, sizeof unpadded);
    TEST_ASSERT_EQUAL_STRING(padded, unpadded);
}

int main(int argc, char **argv) {
    (void)argc;
    if (command_open(argv[0]) != 0) return 1;
    UNITY_BEGIN();
    RUN_TEST(test_frames_come_in_natural_order);
    RUN_TEST(test_the_same_frame_twice_is_refused);
    RUN_TEST(test_unpadded_frames_are_tracked_in_order);
    command_close();
    return UNITY_END();
}
