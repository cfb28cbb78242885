/* What Relief uses of POSIX, on Windows. The build puts this header before every source of Relief
 * (-include), so that nothing else asks for the system. Names of files are UTF-8, with / or \
 * between; files are binary; a file's identity is that of its volume. */
#ifndef RLF_WINDOWS_POSIX_H
#define RLF_WINDOWS_POSIX_H

#define _POSIX_THREAD_SAFE_FUNCTIONS /* localtime_r, gmtime_r */

#include <direct.h>
#include <fcntl.h>
#include <io.h>
#include <limits.h>
#include <pthread.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <time.h>
#include <unistd.h>

/* Their headers' names that are also Relief's. */
#define tell win_own_tell

/* ---- files ---- */

#undef PATH_MAX
#define PATH_MAX 4096

#define O_CLOEXEC _O_NOINHERIT
#define O_NONBLOCK 0 /* opening a pipe does not wait */

typedef struct win_stat {
    uint64_t st_dev, st_ino;
    unsigned st_mode, st_nlink;
    int64_t st_size;
    time_t st_mtime;
} win_stat_value;

int win_open(const char *path, int flags, ...);
FILE *win_fopen(const char *path, const char *mode);
int win_fclose(FILE *file);
int win_stat(const char *path, struct win_stat *out);
int win_fstat(int descriptor, struct win_stat *out);
ssize_t win_pread(int descriptor, void *out, size_t size, off_t position);
int win_mkdir(const char *path, int mode);
int win_rename(const char *from, const char *to); /* replaces */
int win_remove(const char *path);
int win_access(const char *path, int mode);
char *win_realpath(const char *path, char *out); /* with / between */
/* Of "/proc/self/exe": this program's file. */
ssize_t win_readlink(const char *path, char *out, size_t size);
int win_fcntl(int descriptor, int command);
int win_flock(int descriptor, int operation);
FILE *win_open_memstream(char **out_text, size_t *out_size);
char *win_mkdtemp(char *pattern);

#undef stat
#undef fstat
#define stat win_stat
#define fstat win_fstat
#define open win_open
#define fopen win_fopen
#define fclose win_fclose
#define pread win_pread
#define mkdir win_mkdir
#define rename win_rename
#define remove win_remove
#define unlink win_remove
#define access win_access
#define realpath win_realpath
#define readlink win_readlink
#define fcntl win_fcntl
#define flock win_flock
#define open_memstream win_open_memstream
#define mkdtemp win_mkdtemp

#define F_GETFD 1
#define LOCK_EX 2
#define LOCK_NB 4

/* ---- the machine ---- */

#define _SC_NPROCESSORS_ONLN 1
long win_sysconf(int name);
#define sysconf win_sysconf

/* ---- threads: every wait of Relief is by the monotonic clock ---- */

int win_cond_timedwait(pthread_cond_t *condition, pthread_mutex_t *mutex,
                       const struct timespec *until);
#define pthread_cond_timedwait win_cond_timedwait
#define pthread_condattr_setclock(attributes, clock) ((void)(attributes))

/* ---- signals: Ctrl-C, Ctrl-Break (as SIGTERM) and a closed console ---- */

#define SIGHUP 1
#define SIGPIPE 13
#define SIGXFSZ 25
#undef sigset_t
#define sigset_t unsigned

struct sigaction {
    void (*sa_handler)(int signal_number);
    unsigned sa_mask;
};

int win_sigaction(int signal_number, const struct sigaction *action, struct sigaction *before);
#define sigaction(number, action, before) win_sigaction(number, action, before)
#define sigemptyset(set) ((void)(set))
#define sigaddset(set, number) ((void)(set), (void)(number))

#endif
