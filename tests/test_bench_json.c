/* The writer of the bench's file. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "json.h"
#include "unity.h"

static FILE *stream;
static char text[1024];

void setUp(void) {
    stream = tmpfile();
    TEST_ASSERT_NOT_NULL(stream);
}
void tearDown(void) {
    TEST_ASSERT_EQUAL_INT(0, fclose(stream));
}

/* What has been written, without the white space between its parts. */
static const char *written(void) {
    size_t length = 0;
    int quoted = 0, c;
    rewind(stream);
    while ((c = fgetc(stream)) != EOF) {
        if (c == '"' && (length == 0 || text[length - 1] != '\\')) quoted = !quoted;
        if (quoted || (c != ' ' && c != '\n')) text[length++] = (char)c;
        TEST_ASSERT_TRUE(length < sizeof text);
    }
    text[length] = '\0';
    return text;
}

static void test_an_object_with_nothing_in_it(void) {
    struct json j;
    json_start(&j, stream);
    json_end(&j);
    TEST_ASSERT_EQUAL_STRING("{}", written());
}

static void test_nesting_and_commas(void) {
    struct json j;
    json_start(&j, stream);
    json_number(&j, "a", 1);
    json_array(&j, "b");
    json_end(&j);
    json_array(&j, "c");
    json_object(&j, NULL);
    json_bool(&j, "d", true);
    json_bool(&j, "e", false);
    json_end(&j);
    json_number(&j, NULL, 2.5);
    json_end(&j);
    json_text(&j, "f", NULL);
    json_end(&j);
    TEST_ASSERT_EQUAL_STRING("{\"a\":1,\"b\":[],\"c\":[{\"d\":true,\"e\":false},2.5],\"f\":null}", written());
}

static void test_text_is_escaped(void) {
    struct json j;
    json_start(&j, stream);
    json_text(&j, "a\"b", "c\\d\ne\x01 f\xc3\xa9");
    json_end(&j);
    TEST_ASSERT_EQUAL_STRING("{\"a\\\"b\":\"c\\\\d\\u000ae\\u0001 f\xc3\xa9\"}", written());
}

/* JSON has no nan and no infinity. */
static void test_numbers_that_are_none(void) {
    struct json j;
    const struct spread s = {0.001, NAN, INFINITY, 2};
    json_start(&j, stream);
    json_spread(&j, "s", &s, 1e3);
    json_end(&j);
    TEST_ASSERT_EQUAL_STRING("{\"s\":{\"least\":1,\"median\":null,\"greatest\":null,\"count\":2}}", written());
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_an_object_with_nothing_in_it);
    RUN_TEST(test_nesting_and_commas);
    RUN_TEST(test_text_is_escaped);
    RUN_TEST(test_numbers_that_are_none);
    return UNITY_END();
}
