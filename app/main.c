/* The `relief` command: finds the subcommand. */
#include "command.h"
#include "commands.h"
#include "streams.h"

#include <stdio.h>
#include <string.h>

typedef struct subcommand {
    const char *name;
    int (*main)(int argc, char **argv);
    const char *summary;
} subcommand;

static const subcommand subcommands[] = {
    {"run", run_main, "run a source with virtual bodies, in a window or headless"},
    {"record", record_main, "record a camera, or turn a recording into another kind"},
    {"place", place_main, "put models of real things where the things are"},
    {"export", export_main, "write arrays of every frame: depth, normals, labels, truth, ..."},
    {"info", info_main, "tell what a source is"},
    {"sources", sources_main, "list the kinds of source that this build can open"},
    {"calibrate", calibrate_main, "lenses and poses of the cameras, from pictures of a chessboard"},
    {"settings", settings_main, "list the settings of the surface stage, for --set"},
    {"eval", eval_main, "measure accuracy where the truth is known, against goals and bounds"},
    {"measure", measure_main, "missing points and wrong normals: table 5.1 of the thesis"},
    {"bench", bench_main, "time and memory of every stage, and how they grow"},
};
#define SUBCOMMAND_COUNT ((int)(sizeof(subcommands) / sizeof(subcommands[0])))

static void print_help(FILE *file)
{
    fprintf(file, "Relief lets virtual things touch the real world that a depth camera sees.\n\n"
                  "usage: relief COMMAND [OPTIONS]\n\ncommands:\n");
    for (int i = 0; i < SUBCOMMAND_COUNT; i++) {
        fprintf(file, "  %-9s %s\n", subcommands[i].name, subcommands[i].summary);
    }
    fprintf(file,
            "\nexamples:\n"
            "  relief run synthetic:room                      a window, no camera needed\n"
            "  relief run synthetic:room --headless --video out.mp4\n"
            "  relief run path/to/clip --scene scenes/rain.json\n\n"
            "`relief COMMAND --help` tells more. Exit status: 0 done, 1 failed, 2 wrong usage,\n"
            "128 and more: stopped by a signal before there was anything to write.\n");
}

static int run(int argc, char **argv)
{
    if (argc < 2) {
        print_help(stderr);
        return EXIT_USAGE;
    }
    const char *name = argv[1];
    if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0 || strcmp(name, "help") == 0) {
        print_help(stdout);
        return EXIT_DONE;
    }
    if (strcmp(name, "--version") == 0) {
        printf("relief %d.%d.%d\n", RLF_VERSION_MAJOR, RLF_VERSION_MINOR, RLF_VERSION_PATCH);
        return EXIT_DONE;
    }
    for (int i = 0; i < SUBCOMMAND_COUNT; i++) {
        if (strcmp(name, subcommands[i].name) == 0) {
            command_catch_interrupts();
            return subcommands[i].main(argc - 1, argv + 1);
        }
    }
    fprintf(stderr, "relief: there is no command '%s' (see `relief --help`)\n", name);
    return EXIT_USAGE;
}

int main(int argc, char **argv)
{
    streams_open();
    return streams_end(run(argc, argv));
}
