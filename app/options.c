/* Options by getopt_long, from a table. */
#include "options.h"

#include "command.h"
#include "relief/io.h"
#include "scene_files.h"
#include "session.h"
#include "suggest.h"

#include <getopt.h>
#include <stdio.h>
#include <string.h>

#define OPTIONS_MAX 64
#define NAME_SIZE 64
#define LIST_SIZE 1024
#define FIRST_VALUE 256 /* of getopt's for the table's options: none is a letter */

static int take_int(const char *command, const option_def *o)
{
    int64_t value = 0;
    if (!command_parse_int(optarg, o->low, o->high, &value)) {
        return command_usage(command, "--%s '%s': use a number from %lld to %lld", o->name, optarg,
                             (long long)o->low, (long long)o->high);
    }
    if (o->kind == OPTION_INT32) {
        *(int32_t *)o->out = (int32_t)value;
    } else {
        *(int64_t *)o->out = value;
    }
    return -1;
}

static bool is_in(const char *const *names, const char *name)
{
    for (int i = 0; names[i] != NULL; i++) {
        if (strcmp(names[i], name) == 0) {
            return true;
        }
    }
    return false;
}

/* The first of some names with commas between that is none; false when all are. */
static bool find_wrong_name(const char *text, const char *const *names, char out[NAME_SIZE])
{
    for (const char *rest = text;; rest++) {
        const size_t length = strcspn(rest, ",");
        (void)snprintf(out, NAME_SIZE, "%.*s", (int)length, rest);
        if (!is_in(names, out)) {
            return true;
        }
        rest += length;
        if (*rest == '\0') {
            return false;
        }
    }
}

static int refuse_choice(const char *command, const option_def *o)
{
    char name[NAME_SIZE];
    char nearest[SUGGEST_TEXT];
    if (o->names == NULL || !find_wrong_name(optarg, o->names, name)) {
        return command_usage(command, "--%s '%s': %s", o->name, optarg, o->choices);
    }
    return command_usage(command, "--%s '%s': %s: %s", o->name, optarg, o->choices,
                         suggest_text(name, o->names, true, nearest));
}

/* One scene a command: its path lives as long as the program. */
static int take_scene(const char *command, const option_def *o)
{
    static char path[SCENE_PATH];
    char message[SUGGEST_TEXT + SCENE_TEXT];
    if (!scene_files_find(optarg, path, message, sizeof(message))) {
        return command_usage(command, "--%s: %s", o->name, message);
    }
    *(const char **)o->out = path;
    return -1;
}

static int take(const char *command, const option_def *o)
{
    switch (o->kind) {
    case OPTION_FLAG: *(bool *)o->out = true; return -1;
    case OPTION_TEXT: *(const char **)o->out = optarg; return -1;
    case OPTION_INT32:
    case OPTION_INT64: return take_int(command, o);
    case OPTION_PROFILE:
        return session_parse_profile(optarg, o->out)
                   ? -1
                   : command_usage(command, "--%s '%s': use live or thesis", o->name, optarg);
    case OPTION_PLUGIN: command_load_plugin(optarg); return -1;
    case OPTION_SET: return command_set(command, o->out, optarg);
    case OPTION_SCENE: return take_scene(command, o);
    case OPTION_CHOICE: return o->take(optarg, o->out) ? -1 : refuse_choice(command, o);
    }
    return -1;
}

/* getopt's view of the table; an option's value is its place. False when the table is too long. */
static bool list_options(const option_def *options, struct option *out)
{
    int count = 0;
    for (; options[count].name != NULL && count < OPTIONS_MAX; count++) {
        bool has_value = options[count].kind != OPTION_FLAG;
        out[count] =
            (struct option){options[count].name, has_value ? required_argument : no_argument, NULL,
                            FIRST_VALUE + count};
    }
    out[count] = (struct option){"help", no_argument, NULL, 'h'};
    return options[count].name == NULL;
}

/* What has no room is cut. */
static void add_word(char out[LIST_SIZE], const char *before, const char *word)
{
    const size_t used = strlen(out);
    (void)snprintf(out + used, LIST_SIZE - used, "%s%s", before, word);
}

/* After getopt's '?': the argument it stopped at may be the next one, so it tells of short ones
 * itself. */
static int refuse_option(const char *command, const option_def *options, const char *argument)
{
    if (optopt >= FIRST_VALUE) {
        return command_usage(command, "--%s takes no value", options[optopt - FIRST_VALUE].name);
    }
    if (optopt != 0) {
        return command_usage(command, "unknown option '-%c'", optopt);
    }
    char name[NAME_SIZE];
    char begins_so[LIST_SIZE] = "";
    char all[LIST_SIZE] = "help";
    char nearest[NAME_SIZE];
    (void)snprintf(name, sizeof(name), "%.*s", (int)strcspn(argument, "="), argument);
    const char *word = name + strspn(name, "-");
    for (int i = 0; options[i].name != NULL; i++) {
        add_word(all, " ", options[i].name);
        if (strncmp(options[i].name, word, strlen(word)) == 0) {
            add_word(begins_so, " --", options[i].name);
        }
    }
    if (begins_so[0] != '\0') {
        return command_usage(command, "'%s' may be one of%s", name, begins_so);
    }
    const bool is_near = rlf_word_nearest(all, word, nearest, sizeof(nearest));
    return command_usage(command, "unknown option '%s'%s%s%s", name,
                         is_near ? ": did you mean '--" : "", is_near ? nearest : "",
                         is_near ? "'?" : "");
}

int options_parse(const char *command, int argc, char **argv, const option_def *options,
                  void (*print_help)(void))
{
    struct option list[OPTIONS_MAX + 2];
    memset(list, 0, sizeof(list));
    if (!list_options(options, list)) {
        return command_usage(command, "has more than %d options: OPTIONS_MAX", OPTIONS_MAX);
    }
    optopt = 0;
    opterr = 0; /* the messages below instead */
    int option;
    while ((option = getopt_long(argc, argv, ":h", list, NULL)) != -1) {
        int status = -1;
        switch (option) {
        case 'h': print_help(); return EXIT_DONE;
        case ':': return command_usage(command, "%s needs a value", argv[optind - 1]);
        case '?': return refuse_option(command, options, argv[optind - 1]);
        default: status = take(command, &options[option - FIRST_VALUE]); break;
        }
        if (status >= 0) {
            return status;
        }
    }
    return -1;
}

bool options_take_orbit(const char *text, void *out)
{
    rlf_orbit *orbit = out;
    double yaw_deg, pitch_deg;
    double zoom = 1.0;
    char rest;
    int count = sscanf(text, "%lf,%lf,%lf%c", &yaw_deg, &pitch_deg, &zoom, &rest);
    bool is_good = (count == 2 || count == 3) && yaw_deg >= -360.0 && yaw_deg <= 360.0 &&
                   pitch_deg >= -85.0 && pitch_deg <= 85.0 && zoom >= 0.1 && zoom <= 10.0;
    *orbit = (rlf_orbit){yaw_deg * RLF_PI / 180.0, pitch_deg * RLF_PI / 180.0, zoom};
    return is_good && (count == 3 || strchr(strchr(text, ',') + 1, ',') == NULL);
}
