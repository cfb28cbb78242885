/* Options of a command, from a table. */
#include "options.h"

#include "command.h"
#include "relief/io.h"
#include "scene_files.h"
#include "session.h"

#include <getopt.h>
#include <stdio.h>
#include <string.h>

#define NAME_SIZE 64
#define LIST_SIZE 1024
#define KEYS_MAX 16

const moved_word *options_moved;

static int take_int(const char *command, const option_def *o, const char *text)
{
    int64_t value = 0;
    if (!command_parse_int(text, o->low, o->high, &value)) {
        return command_usage(command, "--%s '%s': use a number from %lld to %lld", o->name, text,
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

static int refuse_choice(const char *command, const option_def *o, const char *text)
{
    char name[NAME_SIZE];
    char nearest[SUGGEST_TEXT];
    if (o->names == NULL || !find_wrong_name(text, o->names, name)) {
        return command_usage(command, "--%s '%s': %s", o->name, text, o->choices);
    }
    return command_usage(command, "--%s '%s': %s: %s", o->name, text, o->choices,
                         suggest_text(name, o->names, true, nearest));
}

/* One scene a command: its path lives as long as the program. */
static int take_scene(const char *command, const option_def *o, const char *text)
{
    static char path[SCENE_PATH];
    char message[SUGGEST_TEXT + SCENE_TEXT];
    if (!scene_files_find(text, path, message, sizeof(message))) {
        return command_usage(command, "--%s: %s", o->name, message);
    }
    *(const char **)o->out = path;
    return -1;
}

/* A file or a folder to be written: its name must not say that it is something else. */
static int take_output(const char *command, const option_def *o, const char *text)
{
    const bool is_file = o->kind == OPTION_FILE;
    if (is_file ? !output_name_is_right(text, o->choices) : !output_name_is_folder(text)) {
        return command_usage(command, "--%s '%s': give %s%s", o->name, text,
                             is_file ? "a file that ends in " : "a folder, not the name of a file",
                             is_file ? o->choices : "");
    }
    *(const char **)o->out = text;
    return -1;
}

static int take_plugin(const char *path)
{
    return rlf_plugin_load(path) == RLF_OK ? -1 : command_failed();
}

static int take_keys(const char *command, const option_def *o, char *text, const char *between);

static int take_text(const char *command, const option_def *o, char *text)
{
    switch (o->kind) {
    case OPTION_FLAG: *(bool *)o->out = true; return -1;
    case OPTION_TEXT: *(const char **)o->out = text; return -1;
    case OPTION_INT32:
    case OPTION_INT64: return take_int(command, o, text);
    case OPTION_PROFILE:
        return session_parse_profile(text, o->out)
                   ? -1
                   : command_usage(command, "--%s '%s': use live or thesis", o->name, text);
    case OPTION_PLUGIN: return take_plugin(text);
    case OPTION_SET: return command_set(command, o->out, text);
    case OPTION_SCENE: return take_scene(command, o, text);
    case OPTION_CHOICE: return o->take(text, o->out) ? -1 : refuse_choice(command, o, text);
    case OPTION_FILE:
    case OPTION_FOLDER: return take_output(command, o, text);
    case OPTION_KEYS: return take_keys(command, o, text, ",");
    }
    return -1;
}

/* The text, and the keys behind its "?". */
static int take(const char *command, const option_def *o, char *text)
{
    char *keys = o->keys != NULL && o->kind != OPTION_KEYS ? strchr(text, '?') : NULL;
    if (keys != NULL) {
        *keys++ = '\0';
    }
    const int status = take_text(command, o, text);
    return status < 0 && keys != NULL ? take_keys(command, o, keys, "&") : status;
}

static int refuse_key(const char *command, const option_def *o, const char *key)
{
    const char *names[KEYS_MAX + 1] = {NULL};
    char nearest[SUGGEST_TEXT];
    for (int i = 0; i < KEYS_MAX && o->keys[i].name != NULL; i++) {
        names[i] = o->keys[i].name;
    }
    return command_usage(command, "--%s has no '%s': %s", o->name, key,
                         suggest_text(key, names, true, nearest));
}

/* "key" or "key=value"; messages name the option and the key. */
static int take_key(const char *command, const option_def *o, char *text)
{
    char name[NAME_SIZE], bare[NAME_SIZE] = "";
    char *equal = strchr(text, '=');
    if (equal != NULL) {
        *equal = '\0';
    }
    for (const option_def *k = o->keys; k->name != NULL; k++) {
        if (strcmp(k->name, text) != 0) {
            continue;
        }
        option_def named = *k;
        named.name = name;
        (void)snprintf(name, sizeof(name), "%s %s", o->name, k->name);
        const bool is_flag = k->kind == OPTION_FLAG;
        if (is_flag && equal != NULL && strcmp(equal + 1, "1") != 0) {
            return command_usage(command, "--%s takes no value", name);
        }
        if (!is_flag && equal == NULL && k->bare == NULL) {
            return command_usage(command, "--%s=VALUE: the value is missing", name);
        }
        (void)snprintf(bare, sizeof(bare), "%s", k->bare != NULL ? k->bare : "");
        return take(command, &named, equal != NULL ? equal + 1 : bare);
    }
    return refuse_key(command, o, text);
}

static int take_keys(const char *command, const option_def *o, char *text, const char *between)
{
    int status = -1;
    for (char *rest = text; status < 0 && rest != NULL;) {
        char *key = rest;
        rest = strpbrk(key, between);
        if (rest != NULL) {
            *rest++ = '\0';
        }
        status = take_key(command, o, key);
    }
    return status;
}

/* What has no room is cut. */
static void add_word(char out[LIST_SIZE], const char *before, const char *word)
{
    const size_t used = strlen(out);
    (void)snprintf(out + used, LIST_SIZE - used, "%s%s", before, word);
}

const char *options_now(const char *command, const char *option)
{
    for (const moved_word *m = options_moved; m != NULL && m->command != NULL; m++) {
        const bool is_same = option == NULL || m->option == NULL ? option == m->option
                                                                 : strcmp(m->option, option) == 0;
        if (is_same && strcmp(m->command, command) == 0) {
            return m->now;
        }
    }
    return NULL;
}

/* The one that is near, or those that begin so. */
static int refuse_option(const char *command, const option_def *options, const char *argument)
{
    char name[NAME_SIZE];
    char begins_so[LIST_SIZE] = "";
    char all[LIST_SIZE] = "help";
    char nearest[NAME_SIZE];
    int count = 0;
    (void)snprintf(name, sizeof(name), "%.*s", (int)strcspn(argument, "="), argument);
    const char *word = name + strspn(name, "-");
    const char *now = options_now(command, word);
    if (now != NULL) {
        return command_usage(command, "%s is now %s", name, now);
    }
    for (int i = 0; options[i].name != NULL; i++) {
        add_word(all, " ", options[i].name);
        if (strncmp(options[i].name, word, strlen(word)) == 0) {
            add_word(begins_so, " --", options[i].name);
            count++;
        }
    }
    if (count > 1) {
        return command_usage(command, "'%s' may be one of%s", name, begins_so);
    }
    if (count == 1) {
        return command_usage(command, "unknown option '%s': did you mean '%s'?", name,
                             begins_so + 1);
    }
    const bool is_near = rlf_word_nearest(all, word, nearest, sizeof(nearest));
    return command_usage(command, "unknown option '%s'%s%s%s", name,
                         is_near ? ": did you mean '--" : "", is_near ? nearest : "",
                         is_near ? "'?" : "");
}

/* The option whose name is the whole of "--NAME" or of what stands before "="; NULL = none. */
static const option_def *find_option(const option_def *options, const char *argument)
{
    const char *name = argument + 2;
    const size_t length = strcspn(name, "=");
    for (int i = 0; options[i].name != NULL; i++) {
        if (strlen(options[i].name) == length && strncmp(options[i].name, name, length) == 0) {
            return &options[i];
        }
    }
    return NULL;
}

/* Takes the option at *at and what belongs to it; *at is then its last word. */
static int take_option(const char *command, int argc, char **argv, const option_def *options,
                       int *at)
{
    char *argument = argv[*at];
    if (argument[1] != '-') {
        return command_usage(command, "unknown option '-%c'", argument[1]);
    }
    const option_def *o = find_option(options, argument);
    if (o == NULL) {
        return refuse_option(command, options, argument);
    }
    char *equal = strchr(argument, '=');
    if (o->kind == OPTION_FLAG && equal != NULL) {
        return command_usage(command, "--%s takes no value", o->name);
    }
    const bool is_next = o->kind != OPTION_FLAG && equal == NULL;
    if (is_next && *at + 1 >= argc) {
        return command_usage(command, "%s needs a value", argument);
    }
    *at += is_next ? 1 : 0;
    return take(command, o, equal != NULL ? equal + 1 : argv[*at]);
}

static bool is_help(const char *argument)
{
    return strcmp(argument, "--help") == 0 || strcmp(argument, "-h") == 0;
}

/* Moves argv[from..to] before the arguments, which begin at *first. */
static void move_up(char **argv, int from, int to, int *first)
{
    for (int i = from; i <= to; i++, ++*first) {
        char *option = argv[i];
        memmove(&argv[*first + 1], &argv[*first], (size_t)(i - *first) * sizeof(argv[0]));
        argv[*first] = option;
    }
}

static options_visit_fn visitor;

void options_visit(options_visit_fn visit)
{
    visitor = visit;
}

int options_parse(const char *command, int argc, char **argv, const option_def *options,
                  void (*print_help)(void))
{
    if (visitor != NULL) {
        visitor(options, print_help);
        return EXIT_DONE;
    }
    int first = 1; /* of the arguments found so far */
    bool is_over = false;
    for (int at = 1; at < argc && !is_over; at++) {
        const int from = at;
        is_over = strcmp(argv[at], "--") == 0;
        if (argv[at][0] != '-' || argv[at][1] == '\0') {
            continue;
        }
        if (is_help(argv[at])) {
            print_help();
            return EXIT_DONE;
        }
        const int status = is_over ? -1 : take_option(command, argc, argv, options, &at);
        if (status >= 0) {
            return status;
        }
        move_up(argv, from, at, &first);
    }
    optind = first;
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
