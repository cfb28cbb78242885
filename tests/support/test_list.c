/* The list of a program's tests, and what else test.h has. */
#include "test.h"

#include <stdio.h>
#include <stdlib.h>

static test_entry *first;
static CMFixtureFunction each[2], group[2];

/* By line: constructors run in either order. */
void test_add(test_entry *entry)
{
    test_entry **at = &first;
    while (*at != NULL && (*at)->line < entry->line) {
        at = &(*at)->next;
    }
    entry->next = *at;
    *at = entry;
}

void test_for_each(CMFixtureFunction set_up, CMFixtureFunction tear_down)
{
    each[0] = set_up;
    each[1] = tear_down;
}

void test_for_group(CMFixtureFunction set_up, CMFixtureFunction tear_down)
{
    group[0] = set_up;
    group[1] = tear_down;
}

int test_run_all(void)
{
    size_t count = 0;
    for (const test_entry *e = first; e != NULL; e = e->next) {
        count++;
    }
    if (count == 0) {
        puts("no tests");
        return 1;
    }
    struct CMUnitTest *tests = calloc(count, sizeof(*tests));
    size_t k = 0;
    for (const test_entry *e = first; e != NULL; e = e->next, k++) {
        tests[k] = e->test;
        if (e->test.setup_func == NULL && e->test.teardown_func == NULL) {
            tests[k].setup_func = each[0];
            tests[k].teardown_func = each[1];
        }
    }
    int failed = _cmocka_run_group_tests("tests", tests, count, group[0], group[1]);
    free(tests);
    return failed;
}

void test_less(double a, double b, const char *a_text, const char *b_text, const char *file,
               int line)
{
    if (!(a < b)) {
        print_error("%s < %s: %g is not less than %g\n", a_text, b_text, a, b);
        _fail(file, line);
    }
}
