/* `relief settings`: what `--set` takes. */
#include "command.h"
#include "commands.h"
#include "relief/io.h"
#include "settings.h"

#include <stdio.h>
#include <string.h>

static void print_help(FILE *file)
{
    fprintf(file,
            "usage: relief settings [SOURCE]\n\n"
            "Lists the settings of the surface stage that `--set NAME=VALUE` of run, export,\n"
            "measure and eval takes, with the values of both profiles for SOURCE's camera\n"
            "(default synthetic:room).\n\n"
            "examples:\n"
            "  relief settings\n"
            "  relief run synthetic:room --set smoothing=off --view normals\n"
            "  relief eval --scene room --set hold=off\n");
}

int settings_main(int argc, char **argv)
{
    bool asks = argc == 2 && (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0);
    if (asks) {
        print_help(stdout);
        return EXIT_DONE;
    }
    if (argc > 2 || (argc == 2 && argv[1][0] == '-')) {
        return command_usage("settings", "takes one SOURCE or nothing");
    }
    rlf_source *source = NULL;
    if (rlf_open_source(argc == 2 ? argv[1] : "synthetic:room", NULL, &source) != RLF_OK) {
        return command_failed();
    }
    settings_print(&rlf_source_get_info(source)->rig);
    rlf_source_destroy(&source);
    return EXIT_DONE;
}
