/* The reader of callgrind's profiles. */
#include <stdio.h>

#include "callgrind.h"
#include "unity.h"

void setUp(void) {
}
void tearDown(void) {
}

static bool read_text(const char *text, struct callgrind_count *counts, int count) {
    FILE *file = tmpfile();
    TEST_ASSERT_NOT_NULL(file);
    TEST_ASSERT_TRUE(fputs(text, file) >= 0);
    rewind(file);
    const bool good = callgrind_read(file, counts, count);
    TEST_ASSERT_EQUAL_INT(0, fclose(file));
    return good;
}

/* Names are written out once and numbered from then on; a call's cost is on the line behind it, callees included. */
static const char profile[] = "# callgrind format\n"
                              "version: 1\n"
                              "positions: line\n"
                              "events: Ir\n"
                              "summary: 1234\n\n"
                              "fl=(1) step.c\n"
                              "fn=(1) counted_step\n"
                              "10 5\n"
                              "cfi=(2) tile.c\n"
                              "cfn=(2) tile\n"
                              "calls=3 7\n"
                              "11 300\n"
                              "+1 2\n"
                              "cfn=(3) tile_of_other\n"
                              "calls=1 9\n"
                              "* 40\n\n"
                              "fn=(4) main\n"
                              "cfn=(1)\n"
                              "calls=2 10\n"
                              "1 347\n"
                              "cfn=(2)\n"
                              "calls=1 7\n"
                              "2 100\n";

static void test_calls_are_added_up(void) {
    struct callgrind_count counts[] = {{"tile", 7}, {"counted_step", 7}, {"main", 7}, {"absent", 7}};
    TEST_ASSERT_TRUE(read_text(profile, counts, 4));
    TEST_ASSERT_EQUAL_UINT64(400, counts[0].instructions);
    TEST_ASSERT_EQUAL_UINT64(347, counts[1].instructions);
    TEST_ASSERT_EQUAL_UINT64(0, counts[2].instructions); /* nobody calls it */
    TEST_ASSERT_EQUAL_UINT64(0, counts[3].instructions);
}

static void test_what_is_no_profile(void) {
    struct callgrind_count counts[] = {{"tile", 7}};
    TEST_ASSERT_FALSE(read_text("", counts, 1));
    TEST_ASSERT_FALSE(read_text("fn=(1\ncalls=\n\ncfn=(999999999) tile\ncalls=1\n1 5\n", counts, 1));
    TEST_ASSERT_EQUAL_UINT64(0, counts[0].instructions);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_calls_are_added_up);
    RUN_TEST(test_what_is_no_profile);
    return UNITY_END();
}
