/* The `relief` command: finds the subcommand. */
#include "command.h"
#include "commands.h"
#include "complete.h"
#include "parts.h"
#include "streams.h"
#include "suggest.h"

#include <stdio.h>
#include <string.h>

static const subcommand subcommands[] = {
    {"run", run_main, "show a source with virtual bodies, in a window or headless"},
    {"record", record_main, "record a camera, or turn a recording into another kind"},
    {"place", place_main, "put models of real things where the things are"},
    {"export", export_main, "write arrays of every frame: depth, normals, labels, truth, ..."},
    {"fuse", fuse_main, "fuse the frames of a moving camera into a mesh and a map of the room"},
    {"info", info_main, "tell what a source is"},
    {"calibrate", calibrate_main, "lenses and poses of the cameras, from pictures of a chessboard"},
    {"sources", sources_main, "list cameras, and the kinds of source that this build can open"},
    {"scenes", scenes_main, "list the scenes that come with Relief, for --scene"},
    {"settings", settings_main, "list the settings of the surface stage, for --set"},
    {"eval", eval_main, "accuracy where the truth is known, against goals and bounds"},
    {"measure", measure_main, "missing points and wrong normals: table 5.1 of the thesis"},
    {"bench", bench_main, "time and memory of every stage, and how they grow"},
    {NULL, NULL, NULL},
};
#define SUBCOMMAND_COUNT ((int)(sizeof(subcommands) / sizeof(subcommands[0])) - 1)

/* Listed apart: they tell what Relief is worth, and do nothing for a user. */
static bool is_measuring(const subcommand *s)
{
    return s->main == eval_main || s->main == measure_main || s->main == bench_main;
}

static void print_commands(FILE *file, bool measures)
{
    for (int i = 0; i < SUBCOMMAND_COUNT; i++) {
        if (is_measuring(&subcommands[i]) == measures) {
            fprintf(file, "  %-9s %s\n", subcommands[i].name, subcommands[i].summary);
        }
    }
}

static void print_help(FILE *file)
{
    fprintf(file, "Relief lets virtual things touch the real world that a depth camera sees.\n\n"
                  "usage: relief COMMAND [OPTIONS]\n\ncommands:\n");
    print_commands(file, false);
    fprintf(file, "\nto measure Relief itself:\n");
    print_commands(file, true);
    fprintf(file,
            "\nexamples:\n"
            "  relief                                         choose a camera, recording or scene\n"
            "  relief run synthetic:room                      a window, no camera needed\n"
            "  relief run synthetic:room --headless --video out.mp4\n"
            "  relief run path/to/clip --scene rain\n\n"
            "`relief help COMMAND` tells more. Exit status: 0 done, 1 failed, 2 wrong usage,\n"
            "130 stopped by Ctrl-C, in general 128 and the signal's number.\n");
}

static const subcommand *find(const char *name)
{
    for (int i = 0; i < SUBCOMMAND_COUNT; i++) {
        if (strcmp(name, subcommands[i].name) == 0) {
            return &subcommands[i];
        }
    }
    return NULL;
}

static int refuse(const char *name)
{
    static const char *const options[] = {"--help", "--version", NULL};
    const char *names[SUBCOMMAND_COUNT + 2] = {"help"};
    const bool is_option = name[0] == '-';
    for (int i = 0; i < SUBCOMMAND_COUNT; i++) {
        names[i + 1] = subcommands[i].name;
    }
    char nearest[SUGGEST_TEXT];
    fprintf(stderr, "relief: there is no %s '%s': %s (see `relief --help`)\n",
            is_option ? "option" : "command", name,
            suggest_text(name, is_option ? options : names, false, nearest));
    return EXIT_USAGE;
}

static bool is_either(const char *text, const char *a, const char *b)
{
    return strcmp(text, a) == 0 || strcmp(text, b) == 0;
}

static int refuse_more(const char *after, const char *argument)
{
    fprintf(stderr, "relief: '%s' after %s: leave it out (see `relief --help`)\n", argument, after);
    return EXIT_USAGE;
}

/* `relief help` and `relief help COMMAND`; and what completion asks. */
static int help(int argc, char **argv)
{
    if (argc > 2 && strcmp(argv[2], "--complete") == 0) {
        return complete_print(subcommands, argc - 3, argv + 3);
    }
    const bool is_asked = argc > 2 && !is_either(argv[2], "--help", "-h");
    const subcommand *found = is_asked ? find(argv[2]) : NULL;
    if (is_asked && found == NULL) {
        return refuse(argv[2]);
    }
    if (argc > 3) {
        return refuse_more("help", argv[3]);
    }
    if (found != NULL) {
        char asked[] = "--help";
        char *arguments[] = {argv[2], asked, NULL};
        return found->main(2, arguments);
    }
    print_help(stdout);
    return EXIT_DONE;
}

/* `relief` alone: the window's start page; the usage where there is no window. */
static int run_bare(void)
{
    command_catch_interrupts();
    const int status = run_alone();
    if (status >= 0) {
        return status;
    }
    print_help(stderr);
    if (!part_is_built(PART_WINDOW)) {
        fprintf(stderr, "\nrelief: %s\n", rlf_error_text());
    }
    return EXIT_USAGE;
}

static int run(int argc, char **argv)
{
    if (argc < 2) {
        return run_bare();
    }
    const char *name = argv[1];
    if (strcmp(name, "help") == 0) {
        return help(argc, argv);
    }
    const bool asks_help = is_either(name, "--help", "-h");
    if (argc > 2 && (asks_help || is_either(name, "--version", "-V"))) {
        return refuse_more(name, argv[2]);
    }
    if (asks_help) {
        print_help(stdout);
        return EXIT_DONE;
    }
    if (is_either(name, "--version", "-V")) {
        printf("relief %s\n", rlf_version());
        parts_print();
        return EXIT_DONE;
    }
    const subcommand *found = find(name);
    if (found == NULL) {
        return refuse(name);
    }
    command_catch_interrupts();
    return found->main(argc - 1, argv + 1);
}

int main(int argc, char **argv)
{
    streams_open();
    return streams_end(run(argc, argv));
}
