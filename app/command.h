/* What the subcommands of `relief` share: messages and exit statuses.
 *
 * Exit status: 0 done, 1 the input or the machine failed, 2 wrong usage, 128 and the signal's
 * number when one stopped the command: 130 for Ctrl-C. Files that it has begun are whole then. */
#ifndef RELIEF_APP_COMMAND_H
#define RELIEF_APP_COMMAND_H

#include "settings.h"

#include <signal.h>

#define EXIT_DONE 0
#define EXIT_FAILED 1
#define EXIT_USAGE 2

/* The program's name in messages; dispatch sets it. */
extern const char *command_program;

/* The signal's number after Ctrl-C, SIGTERM or SIGHUP; loops look at it once per frame and then
 * close their files. */
extern volatile sig_atomic_t command_interrupted;
void command_catch_interrupts(void);

/* Prints "relief COMMAND: message (see `relief COMMAND --help`)" and returns EXIT_USAGE. */
int command_usage(const char *command, const char *format, ...) RLF_PRINTF(2, 3);
/* `--set TEXT` of a command: -1 to go on, or EXIT_USAGE after saying what is wrong with it. */
int command_set(const char *command, setting_list *s, const char *text);
/* Line of the help of commands that take --plugin. */
#define COMMAND_PLUGIN_HELP                                                                        \
    "  --plugin FILE     a plug-in that brings a camera or a format; any number\n"
/* Prints the library's error line and returns EXIT_FAILED. */
int command_failed(void);
/* After a source that could not be opened: as command_failed, or as command_stopped when the user
 * was tired of waiting for it. */
int command_not_opened(const char *command);
/* After Ctrl-C, when there is no result or half of one, which is none: prints that nothing was
 * written and returns 128 and the signal's number. */
int command_stopped(const char *command);
/* EXIT_DONE, or 128 and the signal's number when one ended a command whose files are whole. */
int command_done(void);

/* "frame" or "frames". */
const char *command_frames(int64_t count);
/* The value, or 0 for one that would be printed as -0 with so many decimals. */
double command_tidy(double value, int decimals);

/* Whole-string numbers; false when the text is not one or is out of [low, high]. */
bool command_parse_int(const char *text, int64_t low, int64_t high, int64_t *out);
/* "A,B,...": at most `capacity` numbers, each within [low, high]. */
bool command_parse_list(const char *text, int64_t low, int64_t high, int capacity, int64_t *out,
                        int *out_count);
/* "A:B", "A:", ":B" or "N" (= ":N"): frames A <= i < B. */
bool command_parse_range(const char *text, int64_t *out_begin, int64_t *out_end);

#endif
