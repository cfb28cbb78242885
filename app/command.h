/* What the subcommands of `relief` share: messages and exit statuses.
 *
 * Exit status: 0 done, 1 the input or the machine failed, 2 wrong usage, 128 and the signal's
 * number when one stopped the command: 130 for Ctrl-C. Files that it has begun are whole then. */
#ifndef RELIEF_APP_COMMAND_H
#define RELIEF_APP_COMMAND_H

#include "relief/base.h"
#include "settings.h"

#include <signal.h>
#include <stdbool.h>

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

/* ---- the subcommands of `relief` ------------------------------------------------------------- */

/* One per subcommand; argv[0] is the subcommand's name. */
int run_main(int argc, char **argv);
/* As `relief run` without a SOURCE; -1 where there is no window to choose one in. */
int run_alone(void);
int record_main(int argc, char **argv);
int place_main(int argc, char **argv);
int export_main(int argc, char **argv);
int info_main(int argc, char **argv);
int calibrate_main(int argc, char **argv);
int list_main(int argc, char **argv);

/* ---- standard input, output and error -------------------------------------------------------- */

/* First of all: a stream that the caller closed becomes /dev/null, or the first file opened would
 * take its number and get what is printed. */
void streams_open(void);
/* Last of all: the exit status, which is EXIT_FAILED after a line on stderr when not all that was
 * printed could be written. */
int streams_end(int status);

/* ---- names ----------------------------------------------------------------------------------- */

/* A file of one of the `endings`, words with blanks between. A name that ends as files of another
 * kind do is wrong; one that ends as none does is right, and so are a device and a pipe. */
bool output_name_is_right(const char *path, const char *endings);
/* A file that only its ending tells from others: it has one of the `endings`, or is a device or a
 * pipe. */
bool output_name_has(const char *path, const char *endings);
/* A folder: one that is there, or whose name does not end as a file's. */
bool output_name_is_folder(const char *path);

#define SUGGEST_TEXT 1024
/* "did you mean 'depth'?" into `out`, which is returned; where no name is near, or `lists_all`,
 * also "there are camera, depth, ...". `names` end with NULL; "" of none. Thread-safety: any. */
const char *suggest_text(const char *text, const char *const *names, bool lists_all,
                         char out[SUGGEST_TEXT]);

#endif
