/* Options by getopt_long, from a table. */
#include "options.h"

#include "command.h"
#include "session.h"

#include <getopt.h>
#include <stdio.h>
#include <string.h>

#define OPTIONS_MAX 40

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
    case OPTION_CHOICE:
        return o->take(optarg, o->out)
                   ? -1
                   : command_usage(command, "--%s '%s': %s", o->name, optarg, o->choices);
    }
    return -1;
}

/* getopt's view of the table; an option's value is its place. False when the table is too long. */
static bool list_options(const option_def *options, struct option *out)
{
    int count = 0;
    for (; options[count].name != NULL && count < OPTIONS_MAX; count++) {
        bool has_value = options[count].kind != OPTION_FLAG;
        out[count] = (struct option){options[count].name,
                                     has_value ? required_argument : no_argument, NULL, count};
    }
    out[count] = (struct option){"help", no_argument, NULL, 'h'};
    return options[count].name == NULL;
}

int options_parse(const char *command, int argc, char **argv, const option_def *options,
                  void (*print_help)(void))
{
    struct option list[OPTIONS_MAX + 2];
    memset(list, 0, sizeof(list));
    if (!list_options(options, list)) {
        return command_usage(command, "has more than %d options: OPTIONS_MAX", OPTIONS_MAX);
    }
    opterr = 0; /* the messages below instead */
    int option;
    while ((option = getopt_long(argc, argv, ":h", list, NULL)) != -1) {
        int status = -1;
        switch (option) {
        case 'h': print_help(); return EXIT_DONE;
        case ':': return command_usage(command, "%s needs a value", argv[optind - 1]);
        case '?': return command_usage(command, "unknown option '%s'", argv[optind - 1]);
        default: status = take(command, &options[option]); break;
        }
        if (status >= 0) {
            return status;
        }
    }
    return -1;
}
