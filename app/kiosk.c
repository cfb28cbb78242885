/* The log of a kiosk, and its first look for the camera. */
#define _POSIX_C_SOURCE 200809L
#include "run_window.h"

#include "command.h"
#include "relief/io.h"
#include "state_folder.h"

#include <stdio.h>
#include <string.h>
#include <time.h>

#define LARGE (1024L * 1024L)
#define TICK_NS 100000000L /* so that Ctrl-C is noticed */
#define WAIT_TICKS_MAX 300 /* between two attempts: half a minute */

static FILE *file;

/* Of any thread: one call writes one line. */
static void write_line(void *context, rlf_log_level level, const char *line)
{
    static const char *const words[3] = {"error: ", "warning: ", ""};
    char at[32] = "";
    struct tm parts;
    const time_t now = time(NULL);
    (void)context;
    if (localtime_r(&now, &parts) != NULL) {
        (void)strftime(at, sizeof at, "%Y-%m-%d %H:%M:%S", &parts);
    }
    (void)fprintf(file, "%s %s%s\n", at, words[level], line);
    (void)fflush(file);
    if (level <= RLF_LOG_WARNING) {
        (void)fprintf(stderr, "relief: %s%s\n", level == RLF_LOG_WARNING ? "warning: " : "", line);
    }
}

static void put_aside(const char *path)
{
    char old[STATE_PATH_SIZE + 8];
    FILE *now = fopen(path, "r");
    if (now == NULL) {
        return;
    }
    const bool is_large = fseek(now, 0, SEEK_END) == 0 && ftell(now) > LARGE;
    (void)fclose(now);
    if (is_large && snprintf(old, sizeof old, "%s.old", path) < (int)sizeof old) {
        (void)rename(path, old);
    }
}

rlf_result kiosk_log_open(const char *path)
{
    char usual[STATE_PATH_SIZE] = "";
    if (path == NULL) {
        if (!state_path("kiosk.log", usual) || !state_make_folder()) {
            return rlf_fail(RLF_ERROR_IO, "kiosk: no folder for its log: set HOME, or give "
                                          "--window kiosk=LOG");
        }
        path = usual;
    }
    put_aside(path);
    file = fopen(path, "a");
    if (file == NULL) {
        return rlf_fail(RLF_ERROR_IO,
                        "%s: the kiosk's log cannot be written there: give "
                        "--window kiosk=LOG",
                        path);
    }
    rlf_set_log(write_line, NULL);
    rlf_log(RLF_LOG_INFO, "kiosk: begins, relief %s", rlf_version());
    return RLF_OK;
}

void kiosk_log_close(void)
{
    if (file != NULL) {
        rlf_log(RLF_LOG_INFO, "kiosk: ends");
        rlf_set_log(NULL, NULL);
        (void)fclose(file);
        file = NULL;
    }
}

static bool is_mended_by_waiting(rlf_result result)
{
    return result != RLF_OK && result != RLF_ERROR_INVALID && result != RLF_ERROR_FORMAT &&
           !command_interrupted;
}

rlf_result kiosk_session_open(const session_options *options, session *out)
{
    const struct timespec tick = {0, TICK_NS};
    int32_t ticks = 10;
    rlf_result result = session_open(options, out);
    if (is_mended_by_waiting(result)) {
        rlf_log(RLF_LOG_WARNING, "kiosk: not yet: %s", rlf_error_text());
    }
    while (is_mended_by_waiting(result)) {
        for (int32_t i = 0; i < ticks && !command_interrupted; i++) {
            (void)nanosleep(&tick, NULL);
        }
        ticks = 2 * ticks < WAIT_TICKS_MAX ? 2 * ticks : WAIT_TICKS_MAX;
        result = session_open(options, out);
    }
    return result;
}
