/* NULL where none is allowed is a safe no-op that is told as such (relief/base.h), and NULL where
 * it is allowed is all right: every public function, inline ones too, with each of its pointers
 * NULL in turn and with all of them. The calls are made from the headers, by
 * tests/headers/null_calls.awk; tests/headers/may_be_null.txt lists what may be NULL. Each call has
 * a process of its own. */

#include "count_assert.h"
#include "test.h"
#include "valid_arguments.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#define POINTERS_MAX 8
#define ALL_NULL (-1)

typedef struct null_call {
    const char *name;
    bool (*make)(int k); /* with the k-th pointer NULL; true = it gave what a no-op gives */
    int pointer_count;
    const char *pointers[POINTERS_MAX];
    bool may_be_null[POINTERS_MAX];
} null_call;

#include "null_calls.h"

/* What is wrong with a call, as the exit status of its process. */
enum { FINE = 0, NOT_TOLD = 10, TOLD_FOR_NOTHING = 11, NOT_A_NO_OP = 12, OLD_LINE = 13 };

static int judge(const null_call *call, int k)
{
    bool is_allowed = true;
    for (int i = 0; i < call->pointer_count; i++) {
        is_allowed = is_allowed && (call->may_be_null[i] || (k != ALL_NULL && k != i));
    }
    int count = 0;
    rlf_set_log(NULL, NULL);
    rlf_set_assert(count_assert, &count);
    rlf_fail(RLF_ERROR_IO, "of an earlier call");
    const bool is_no_op = call->make(k);
    if (is_allowed) {
        return count == 0 ? FINE : TOLD_FOR_NOTHING;
    }
    if (count == 0) {
        return NOT_TOLD;
    }
    return strcmp(rlf_error_text(), "of an earlier call") == 0 ? OLD_LINE
           : is_no_op                                          ? FINE
                                                               : NOT_A_NO_OP;
}

/* Exit status of the call in a process of its own, or 256 + the signal that ended it. */
static int status_of(const null_call *call, int k)
{
    fflush(NULL);
    const pid_t child = fork();
    if (child == 0) {
        const int crashes[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}; /* cmocka's own */
        for (int i = 0; i < 5; i++) {
            signal(crashes[i], SIG_DFL);
        }
        alarm(60);
        _exit(judge(call, k));
    }
    int status = 0;
    if (child < 0 || waitpid(child, &status, 0) != child) {
        return -1;
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 256 + WTERMSIG(status);
}

static const char *words_of(int status)
{
    switch (status) {
    case NOT_TOLD: return "is not told (or may be NULL and is not listed)";
    case TOLD_FOR_NOTHING: return "may be NULL, but is told";
    case NOT_A_NO_OP: return "is told, but the call returns something";
    case OLD_LINE: return "is told, but the error line is an earlier one";
    default: return status > 256 ? "ends the program by a signal" : "ends the program";
    }
}

TEST_CASE(every_pointer_may_be_null_safely)
{
    int wrong = 0, made = 0;
    for (size_t i = 0; i < sizeof(null_calls) / sizeof(null_calls[0]); i++) {
        const null_call *call = &null_calls[i];
        for (int k = call->pointer_count > 1 ? ALL_NULL : 0; k < call->pointer_count; k++) {
            const int status = status_of(call, k);
            made++;
            if (status != FINE) {
                print_error("%s: %s NULL %s (%d)\n", call->name,
                            k == ALL_NULL ? "all" : call->pointers[k], words_of(status), status);
                wrong++;
            }
        }
    }
    print_message("%d calls\n", made);
    assert_int_equal(wrong, 0);
}

static int set_up(void **state)
{
    (void)state;
    mkdir("null_calls", 0777);
    if (chdir("null_calls") != 0 || !valid_make()) {
        print_error("%s\n", rlf_error_text());
        return -1;
    }
    return 0;
}

TEST_GROUP(set_up, NULL)
