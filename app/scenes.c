/* `relief scenes`: the scenes that come with Relief. */
#include "command.h"
#include "commands.h"
#include "options.h"
#include "scene_files.h"

#include <getopt.h>
#include <stdio.h>
#include <string.h>

static void print_help(void)
{
    printf("usage: relief scenes\n\n"
           "Lists the scenes that come with Relief: bodies and their motion, by the name that\n"
           "`--scene NAME` of run and export takes, and the source that each was made for.\n\n"
           "examples:\n"
           "  relief scenes\n"
           "  relief run synthetic:room --scene rain\n");
}

static int widest(int so_far, const char *text)
{
    const int width = (int)strlen(text);
    return width > so_far ? width : so_far;
}

int scenes_main(int argc, char **argv)
{
    const option_def options[] = {{0}};
    const int status = options_parse("scenes", argc, argv, options, print_help);
    if (status >= 0) {
        return status;
    }
    if (argc != optind) {
        return command_usage("scenes", "takes no argument: `relief run SOURCE --scene NAME` plays "
                                       "one");
    }
    static scene_entry entries[SCENES_MAX];
    const int32_t count = scene_files_list(entries, SCENES_MAX);
    if (count == 0) {
        fprintf(stderr, "relief scenes: no scene was installed with this command: give --scene a "
                        "file\n");
        return EXIT_FAILED;
    }
    int name = 0;
    int source = 0;
    for (int32_t i = 0; i < count; i++) {
        name = widest(name, entries[i].name);
        source = widest(source, entries[i].source);
    }
    for (int32_t i = 0; i < count; i++) {
        const scene_entry *e = &entries[i];
        printf("%-*s  %-*s  %s\n", name, e->name, source, e->source[0] != '\0' ? e->source : "any",
               e->about);
    }
    return EXIT_DONE;
}
