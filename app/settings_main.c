/* `relief settings`: what `--set` takes. */
#include "command.h"
#include "commands.h"
#include "options.h"
#include "relief/io.h"
#include "settings.h"

#include <getopt.h>
#include <stdio.h>

static void print_help(void)
{
    printf("usage: relief settings [SOURCE]\n\n"
           "Lists the settings of the surface stage that `--set NAME=VALUE` of run, export,\n"
           "measure and eval takes, with the values of both profiles for SOURCE's camera\n"
           "(default synthetic:room).\n\n"
           "%s\n"
           "examples:\n"
           "  relief settings\n"
           "  relief run synthetic:room --set smoothing=off --view normals\n"
           "  relief-lab eval --scene room --set hold=off\n",
           COMMAND_PLUGIN_HELP);
}

int settings_main(int argc, char **argv)
{
    const option_def options[] = {{.name = "plugin", .kind = OPTION_PLUGIN}, {0}};
    const int status = options_parse("settings", argc, argv, options, print_help);
    if (status >= 0) {
        return status;
    }
    if (argc - optind > 1) {
        return command_usage("settings", "takes one SOURCE or nothing");
    }
    rlf_source *source = NULL;
    if (rlf_open_source(optind < argc ? argv[optind] : "synthetic:room", NULL, &source) != RLF_OK) {
        return command_failed();
    }
    settings_print(&rlf_source_get_info(source)->rig);
    rlf_source_destroy(&source);
    return EXIT_DONE;
}
