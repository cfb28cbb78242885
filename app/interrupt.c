/* Ctrl-C, SIGTERM and SIGHUP. */
#define _POSIX_C_SOURCE 200809L
#include "command.h"

#include <errno.h>
#include <string.h>
#include <time.h>

/* `timeout` and a terminal that closes send one signal to the command and again to its group. */
#define SAME_NS 500000000

volatile sig_atomic_t command_interrupted;

static struct timespec first; /* when it came */

static long long since_first_ns(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (long long)(now.tv_sec - first.tv_sec) * 1000000000 + now.tv_nsec - first.tv_nsec;
}

/* The first one asks the command to end; another one, later, ends it at once. */
static void on_interrupt(int signal_number)
{
    const int errno_before = errno;
    if (!command_interrupted) {
        clock_gettime(CLOCK_MONOTONIC, &first);
        command_interrupted = signal_number;
    } else if (since_first_ns() > SAME_NS) {
        signal(signal_number, SIG_DFL);
        raise(signal_number); /* once this handler has returned */
    }
    errno = errno_before;
}

void command_catch_interrupts(void)
{
    static const int signals[3] = {SIGINT, SIGTERM, SIGHUP};
    struct sigaction action;
    memset(&action, 0, sizeof(action));
    action.sa_handler = on_interrupt;
    sigemptyset(&action.sa_mask);
    for (int i = 0; i < 3; i++) {
        sigaddset(&action.sa_mask, signals[i]);
    }
    for (int i = 0; i < 3; i++) {
        struct sigaction before;
        const bool is_ignored = signals[i] == SIGHUP && sigaction(SIGHUP, NULL, &before) == 0 &&
                                before.sa_handler == SIG_IGN; /* nohup */
        if (!is_ignored) {
            sigaction(signals[i], &action, NULL);
        }
    }
    struct sigaction ignore;
    memset(&ignore, 0, sizeof(ignore));
    ignore.sa_handler = SIG_IGN; /* a closed pipe is reported by the writer instead */
    sigaction(SIGPIPE, &ignore, NULL);
    sigaction(SIGXFSZ, &ignore, NULL); /* and so is a file that has grown to its limit */
}
