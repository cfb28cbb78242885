/* Standard streams: there, and told when they are full. */
#define _POSIX_C_SOURCE 200809L
#include "streams.h"

#include "command.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

void streams_open(void)
{
    for (int i = STDIN_FILENO; i <= STDERR_FILENO; i++) {
        /* open takes the lowest number that is free, which is this one. */
        if (fcntl(i, F_GETFD) < 0 && errno == EBADF && open("/dev/null", O_RDWR) < 0) {
            return;
        }
    }
}

int streams_end(int status)
{
    errno = 0;
    const bool is_full = fflush(stdout) != 0 || ferror(stdout) != 0;
    if (!is_full || status != EXIT_DONE) {
        return status;
    }
    if (errno == 0) { /* an earlier write failed; the next one tells why */
        clearerr(stdout);
        (void)(putchar('\n') != EOF && fflush(stdout) == 0);
    }
    fprintf(stderr, "relief: standard output cannot be written: %s: check what reads it\n",
            errno != 0 ? strerror(errno) : "an earlier write failed");
    return EXIT_FAILED;
}
