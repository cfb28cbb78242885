/* Watches a live source in a test: what the log says, and when. Include after cmocka.h and with
 * POSIX. */
#ifndef RLF_TEST_LIVE_WATCH_H
#define RLF_TEST_LIVE_WATCH_H

#include "test.h"
#include "relief/source.h"

#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#define MS INT64_C(1000000)
#define SECOND (1000 * MS)

static inline void sleep_ms(int ms)
{
    const struct timespec t = {ms / 1000, (long)(ms % 1000) * 1000000};
    nanosleep(&t, NULL);
}

#define LINES_MAX 32

static pthread_mutex_t log_mutex = PTHREAD_MUTEX_INITIALIZER;
static char log_lines[LINES_MAX][256];
static int64_t log_times[LINES_MAX];
static int log_count;

static inline void take_line(void *context, rlf_log_level level, const char *line)
{
    (void)context;
    (void)level;
    pthread_mutex_lock(&log_mutex);
    if (log_count < LINES_MAX) {
        log_times[log_count] = rlf_clock_ns();
        (void)snprintf(log_lines[log_count++], sizeof(log_lines[0]), "%s", line);
    }
    pthread_mutex_unlock(&log_mutex);
}

/* How many lines have the word; *out_ns is when the first came. */
static inline int count_lines(const char *word, int64_t *out_ns)
{
    int count = 0;
    pthread_mutex_lock(&log_mutex);
    for (int i = 0; i < log_count; i++) {
        if (strstr(log_lines[i], word) != NULL) {
            *out_ns = count == 0 ? log_times[i] : *out_ns;
            count++;
        }
    }
    pthread_mutex_unlock(&log_mutex);
    return count;
}

static inline void log_start(void)
{
    log_count = 0;
    rlf_set_log(take_line, NULL);
}

static inline rlf_frame next_frame(rlf_source *source)
{
    rlf_frame frame;
    rlf_result result = RLF_NO_FRAME;
    const int64_t end_ns = rlf_clock_ns() + 20 * SECOND;
    while (result == RLF_NO_FRAME && rlf_clock_ns() < end_ns) {
        result = rlf_source_next(source, &frame);
    }
    assert_int_equal(result, RLF_OK);
    return frame;
}

/* Reads until the message has come; returns how long after `since_ns`. */
static inline int64_t await_line(rlf_source *source, const char *word, int64_t since_ns)
{
    rlf_frame frame;
    int64_t at_ns = 0;
    while (count_lines(word, &at_ns) == 0) {
        assert_true(rlf_clock_ns() - since_ns < 20 * SECOND);
        assert_true(rlf_source_next(source, &frame) >= 0);
    }
    return at_ns - since_ns;
}

/* The line comes a moment after the frame that it tells of. */
static inline void await_count(const char *word, int count)
{
    int64_t at_ns;
    for (int i = 0; i < 500 && count_lines(word, &at_ns) < count; i++) {
        sleep_ms(10);
    }
    assert_int_equal(count_lines(word, &at_ns), count);
}

#endif
