/* Ctrl-C, SIGTERM and SIGHUP. */
#define _POSIX_C_SOURCE 200809L
#include "command.h"

#include <string.h>

volatile sig_atomic_t command_interrupted;

static void on_interrupt(int signal_number)
{
    command_interrupted = signal_number;
}

void command_catch_interrupts(void)
{
    struct sigaction action;
    memset(&action, 0, sizeof(action));
    action.sa_handler = on_interrupt;
    action.sa_flags = (int)SA_RESETHAND; /* a second Ctrl-C ends at once */
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    struct sigaction before;
    if (sigaction(SIGHUP, NULL, &before) == 0 && before.sa_handler != SIG_IGN) { /* nohup */
        sigaction(SIGHUP, &action, NULL); /* the terminal was closed */
    }
    struct sigaction ignore;
    memset(&ignore, 0, sizeof(ignore));
    ignore.sa_handler = SIG_IGN; /* a closed pipe is reported by the writer instead */
    sigaction(SIGPIPE, &ignore, NULL);
    sigaction(SIGXFSZ, &ignore, NULL); /* and so is a file that has grown to its limit */
}
