/* Processors, waits, signals and the name of the system. */
#include "windows/posix.h"

#include <stdbool.h>
#include <sys/utsname.h>
#include <windows.h>

#undef pthread_cond_timedwait

#define SECOND_NS 1000000000

long win_sysconf(int name)
{
    (void)name; /* the only one asked for */
    SYSTEM_INFO info;
    GetSystemInfo(&info);
    return (long)info.dwNumberOfProcessors;
}

/* winpthreads waits by the clock of the day. */
int win_cond_timedwait(pthread_cond_t *condition, pthread_mutex_t *mutex,
                       const struct timespec *until)
{
    struct timespec now, day;
    clock_gettime(CLOCK_MONOTONIC, &now);
    clock_gettime(CLOCK_REALTIME, &day);
    int64_t left = (int64_t)(until->tv_sec - now.tv_sec) * SECOND_NS + until->tv_nsec - now.tv_nsec;
    left = (left > 0 ? left : 0) + day.tv_nsec;
    const struct timespec day_until = {.tv_sec = day.tv_sec + left / SECOND_NS,
                                       .tv_nsec = (long)(left % SECOND_NS)};
    return pthread_cond_timedwait(condition, mutex, &day_until);
}

static void (*handlers[3])(int); /* of SIGINT, SIGTERM, SIGHUP */
static const int numbers[3] = {SIGINT, SIGTERM, SIGHUP};

static BOOL WINAPI on_console(DWORD event)
{
    const int which = event == CTRL_C_EVENT ? 0 : (event == CTRL_BREAK_EVENT ? 1 : 2);
    if (handlers[which] == NULL) {
        return FALSE;
    }
    handlers[which](numbers[which]);
    return TRUE;
}

int win_sigaction(int signal_number, const struct sigaction *action, struct sigaction *before)
{
    for (int i = 0; i < 3; i++) {
        if (numbers[i] == signal_number) {
            if (before != NULL) {
                before->sa_handler = handlers[i];
            }
            if (action != NULL) {
                handlers[i] = action->sa_handler;
                SetConsoleCtrlHandler(on_console, TRUE);
            }
            return 0;
        }
    }
    return -1; /* there is no such signal here */
}

int win_uname(struct utsname *out)
{
    snprintf(out->sysname, sizeof(out->sysname), "Windows");
    snprintf(out->machine, sizeof(out->machine), "x86_64");
    return 0;
}
