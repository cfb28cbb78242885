/* Options of a subcommand as a table, read the same way by all of them. */
#ifndef RELIEF_APP_OPTIONS_H
#define RELIEF_APP_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

typedef enum option_kind {
    OPTION_FLAG = 0,    /* bool: set */
    OPTION_TEXT = 1,    /* const char *: into argv */
    OPTION_INT32 = 2,   /* int32_t within [low, high] */
    OPTION_INT64 = 3,   /* int64_t within [low, high] */
    OPTION_PROFILE = 4, /* rlf_profile: live or thesis */
    OPTION_SET = 5,     /* setting_list: one more "NAME=VALUE" */
    OPTION_CHOICE = 6,  /* read by `take` */
    OPTION_PLUGIN = 7,  /* loads a plug-in: `out` is not used */
    OPTION_SCENE =
        8,           /* const char *: path of a scene, given as a file or by a shipped one's name */
    OPTION_FILE = 9, /* const char *: a file to be written, with an ending of `choices` */
    OPTION_FOLDER = 10, /* const char *: a folder to be written into */
    OPTION_KEYS = 11    /* "key,key=value": its `keys`; `out` is not used */
} option_kind;

/* A table ends with a NULL name. */
typedef struct option_def {
    const char *name; /* without the dashes */
    option_kind kind;
    void *out; /* of the kind's type; what `take` is given */
    int64_t low, high;
    /* Reads the text into `out`; false when it is none of `choices`. */
    bool (*take)(const char *text, void *out);
    /* For the message, and in the form "use live, thesis or both" also for a shell's completion; of
     * a file its endings: ".yml .yaml". */
    const char *choices;
    /* Words of which the text has one, or several with commas between: the message lists them, or
     * tells the nearest one. NULL = `choices` says it all; ends with NULL. */
    const char *const *names;
    /* What may follow the text, as a source's keys do: "DIR?every=30&shrink=2". A flag's value is
     * nothing or 1. A table as this one; NULL = none. */
    const struct option_def *keys;
    const char *bare; /* value of a key that stands alone; NULL = it needs one */
} option_def;

/* Reads the options of argv, whole names only, and puts the arguments behind them, in their order;
 * `optind` of <getopt.h> is then the first one's place. All that follows "--" are arguments. --help
 * and -h print the help. Returns -1 to go on, or an exit status after one line that says what is
 * wrong. */
int options_parse(const char *command, int argc, char **argv, const option_def *options,
                  void (*print_help)(void));

/* Rows of a table. */
#define ROW_FLAG(name_, out_)                                                                      \
    {                                                                                              \
        .name = name_, .kind = OPTION_FLAG, .out = out_                                            \
    }
#define ROW_TEXT(name_, out_)                                                                      \
    {                                                                                              \
        .name = name_, .kind = OPTION_TEXT, .out = out_                                            \
    }
#define ROW_INT32(name_, out_, low_, high_)                                                        \
    {                                                                                              \
        .name = name_, .kind = OPTION_INT32, .out = out_, .low = low_, .high = high_               \
    }
#define ROW_INT64(name_, out_, low_, high_)                                                        \
    {                                                                                              \
        .name = name_, .kind = OPTION_INT64, .out = out_, .low = low_, .high = high_               \
    }
#define ROW_CHOICE(name_, out_, take_, choices_)                                                   \
    {                                                                                              \
        .name = name_, .kind = OPTION_CHOICE, .out = out_, .take = take_, .choices = choices_      \
    }
#define ROW_FILE(name_, out_, endings_)                                                            \
    {                                                                                              \
        .name = name_, .kind = OPTION_FILE, .out = out_, .choices = endings_                       \
    }
#define ROW_FOLDER(name_, out_)                                                                    \
    {                                                                                              \
        .name = name_, .kind = OPTION_FOLDER, .out = out_                                          \
    }
#define ROW_PLUGIN                                                                                 \
    {                                                                                              \
        .name = "plugin", .kind = OPTION_PLUGIN                                                    \
    }

/* A word that was a command or an option once, and what to type now. A NULL command ends them. */
typedef struct moved_word {
    const char *command;
    const char *option; /* without the dashes; NULL = the command itself */
    const char *now;
} moved_word;

/* Of the program that runs; NULL = none. dispatch sets it. */
extern const moved_word *options_moved;
/* What to type in place of a command (`option` NULL) or of its option; NULL = it was never one. */
const char *options_now(const char *command, const char *option);

/* While set, options_parse hands its table and its help to the function instead of reading argv,
 * and returns EXIT_DONE. NULL ends it. */
typedef void (*options_visit_fn)(const option_def *options, void (*print_help)(void));
void options_visit(options_visit_fn visit);

/* Reads an rlf_orbit: degrees, and the distance. `choices` of an option that does. */
#define OPTIONS_ORBIT "use YAW,PITCH or YAW,PITCH,ZOOM: within 360, 85 degrees, 0.1 to 10"
bool options_take_orbit(const char *text, void *out);

#endif
