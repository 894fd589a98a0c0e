/* What the command makes of a directory: the order of its frames and the boxes of its ground truth. The lists in tests/sequences
 * are the Python package's, too. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
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

/* ---- Ground truth ---- */

static char truth_path[PATH_SIZE];

/* Replaces \n, \t, \r and \xNN by what they stand for; the length. */
static size_t unescape(char *text) {
    static const char letters[] = "ntr", meanings[] = "\n\t\r";
    size_t length = 0;
    for (const char *from = text; *from != '\0'; from++) {
        char c = *from;
        if (c == '\\' && *++from == 'x') {
            const char digits[3] = {from[1], from[2], '\0'};
            c = (char)(unsigned char)strtoul(digits, NULL, 16);
            from += 2;
        } else if (c == '\\') {
            const char *letter = strchr(letters, *from);
            TEST_ASSERT_TRUE(*from != '\0' && letter != NULL);
            c = meanings[letter - letters];
        }
        text[length++] = c;
    }
    return length;
}

/* As the list has them: parted by spaces. */
static void assert_boxes(const char *expected) {
    char read[1024] = "";
    size_t used = 0;
    ground_truth truth;
    TEST_ASSERT_TRUE_MESSAGE(truth_read(&truth, truth_path), expected);
    for (int32_t i = 0; i < truth.count; i++) {
        const ast_box *box = truth_box(&truth, i);
        used += (size_t)(box == NULL ? snprintf(read + used, sizeof read - used, " -")
                                     : snprintf(read + used, sizeof read - used, " %g,%g,%g,%g", (double)box->x, (double)box->y,
                                                (double)box->w, (double)box->h));
        TEST_ASSERT_TRUE(used < sizeof read);
    }
    truth_free(&truth);
    TEST_ASSERT_EQUAL_STRING(expected, read + 1);
}

static void assert_refused(const char *reason) {
    char text[2 * PATH_SIZE];
    snprintf(text, sizeof text, "asttrack: %s%s\n", truth_path, reason);
    run_badly(1, text, "track @truth");
}

static void make_truth_directory(void) {
    make_directory(at("@truth"));
    touch(at("@truth"), "1.pgm");
    snprintf(truth_path, sizeof truth_path, "%s", at("@truth/groundtruth.txt"));
}

static void test_ground_truth_is_read_or_refused_by_its_line(void) {
    char line[1024];
    int good = 0, bad = 0;
    FILE *list = open_list("tests/sequences/ground_truth.txt");
    while (next_line(list, line, sizeof line)) {
        char *bar = strstr(line, " | ");
        TEST_ASSERT_NOT_NULL_MESSAGE(bar, line);
        *bar = '\0';
        const char *expected = bar + 3;
        write_file(truth_path, line, unescape(line));
        if (expected[0] == ':') {
            assert_refused(expected);
            bad++;
        } else {
            assert_boxes(expected);
            good++;
        }
    }
    (void)fclose(list);
    TEST_ASSERT_TRUE(good > 10 && bad > 50);
}

/* 511 bytes are a line, its '\r' counted, and 512 are none, even where they are blank. */
static void test_long_lines(void) {
    char line[600];
    memset(line, ' ', sizeof line);
    memcpy(line, "1,2,30,40", 9);
    memcpy(line + 510, "\r\n", 2);
    write_file(truth_path, line, 512);
    assert_boxes("1,2,30,40");
    write_file(truth_path, line, 510);
    assert_boxes("1,2,30,40");
    memcpy(line + 510, " \r\n", 3);
    write_file(truth_path, line, 513);
    assert_refused(":1: too long for four numbers x,y,w,h");
    memcpy(line, "1,2,30,40\n", 10);
    memset(line + 510, ' ', sizeof line - 510);
    write_file(truth_path, line, 10 + 511);
    assert_boxes("1,2,30,40");
    write_file(truth_path, line, 10 + 512);
    assert_refused(":2: too long for four numbers x,y,w,h");
}

int main(int argc, char **argv) {
    (void)argc;
    if (command_open(argv[0]) != 0) return 1;
    UNITY_BEGIN();
    RUN_TEST(test_frames_come_in_natural_order);
    RUN_TEST(test_the_same_frame_twice_is_refused);
    RUN_TEST(test_unpadded_frames_are_tracked_in_order);
    RUN_TEST(make_truth_directory);
    RUN_TEST(test_ground_truth_is_read_or_refused_by_its_line);
    RUN_TEST(test_long_lines);
    command_close();
    return UNITY_END();
}
