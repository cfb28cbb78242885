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
    OPTION_FOLDER = 10 /* const char *: a folder to be written into */
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
} option_def;

/* Reads the options of argv, whole names only, and puts the arguments behind them, in their order;
 * `optind` of <getopt.h> is then the first one's place. All that follows "--" are arguments. --help
 * and -h print the help. Returns -1 to go on, or an exit status after one line that says what is
 * wrong. */
int options_parse(const char *command, int argc, char **argv, const option_def *options,
                  void (*print_help)(void));

/* While set, options_parse hands its table and its help to the function instead of reading argv,
 * and returns EXIT_DONE. NULL ends it. */
typedef void (*options_visit_fn)(const option_def *options, void (*print_help)(void));
void options_visit(options_visit_fn visit);

/* Reads an rlf_orbit: degrees, and the distance. `choices` of an option that does. */
#define OPTIONS_ORBIT "use YAW,PITCH or YAW,PITCH,ZOOM: within 360, 85 degrees, 0.1 to 10"
bool options_take_orbit(const char *text, void *out);

#endif
