/* cmocka, the headers that it wants before it, and the list of a program's tests.
 *
 *     TEST_CASE(a_ball_bounces)
 *     {
 *         assert_true(...);
 *     }
 *
 * is both a test and its place on the list, which runs in the order of the file. What a test
 * needs is made before it and freed after it: TEST_CASE_WITH says what of one test, TEST_EACH of
 * each that does not say it, TEST_GROUP of all together. */
#ifndef RLF_TESTS_TEST_H
#define RLF_TESTS_TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

typedef struct test_entry test_entry;

struct test_entry {
    struct CMUnitTest test;
    int line;
    test_entry *next;
};

void test_add(test_entry *entry);
void test_for_each(CMFixtureFunction set_up, CMFixtureFunction tear_down);
void test_for_group(CMFixtureFunction set_up, CMFixtureFunction tear_down);

/* Runs the list: how many failed. For a program whose main() must look first whether it can. */
int test_run_all(void);

#define TEST_CASE_WITH(name, set_up, tear_down)                                                    \
    static void name(void **state);                                                                \
    __attribute__((constructor)) static void add_##name(void)                                      \
    {                                                                                              \
        static test_entry entry = {{#name, name, set_up, tear_down, NULL}, __LINE__, NULL};        \
        test_add(&entry);                                                                          \
    }                                                                                              \
    static void name(__attribute__((unused)) void **state)

#define TEST_CASE(name) TEST_CASE_WITH(name, NULL, NULL)

#define TEST_EACH(set_up, tear_down)                                                               \
    __attribute__((constructor)) static void add_each(void)                                        \
    {                                                                                              \
        test_for_each(set_up, tear_down);                                                          \
    }

#define TEST_GROUP(set_up, tear_down)                                                              \
    __attribute__((constructor)) static void add_group(void)                                       \
    {                                                                                              \
        test_for_group(set_up, tear_down);                                                         \
    }

/* assert_true(a < b) of numbers, which are told when it is not so. */
#define assert_less(a, b) test_less(a, b, #a, #b, __FILE__, __LINE__)

void test_less(double a, double b, const char *a_text, const char *b_text, const char *file,
               int line);

#endif
