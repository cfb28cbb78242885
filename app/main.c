/* The `relief` command: finds the subcommand. */
#include "command.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct subcommand {
    const char *name;
    int (*main)(int argc, char **argv);
    const char *summary;
} subcommand;

static const subcommand subcommands[] = {
    {"run", run_main, "run a source with virtual bodies, in a window or headless"},
    {"place", place_main, "put models of real things where the things are"},
    {"export", export_main, "write arrays of every frame: depth, normals, labels, truth, ..."},
    {"info", info_main, "tell what a source is"},
    {"sources", sources_main, "list the kinds of source that this build can open"},
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
        fprintf(file, "  %-8s %s\n", subcommands[i].name, subcommands[i].summary);
    }
    fprintf(file,
            "\nexamples:\n"
            "  relief run synthetic:room                      a window, no camera needed\n"
            "  relief run synthetic:room --headless --video out.mp4\n"
            "  relief run path/to/clip --scene scenes/rain.json\n\n"
            "`relief COMMAND --help` tells more. Exit status: 0 done, 1 failed, 2 wrong usage.\n");
}

int command_usage(const char *command, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fprintf(stderr, "relief %s: ", command);
    vfprintf(stderr, format, arguments);
    fprintf(stderr, " (see `relief %s --help`)\n", command);
    va_end(arguments);
    return EXIT_USAGE;
}

int command_set(const char *command, setting_list *s, const char *text)
{
    return settings_add(s, text) == RLF_OK ? -1
                                           : command_usage(command, "--set %s", rlf_error_text());
}

int command_failed(void)
{
    fprintf(stderr, "relief: %s\n", rlf_error_text());
    return EXIT_FAILED;
}

int command_stopped(const char *command)
{
    fprintf(stderr, "relief %s: stopped before the end; nothing was written\n", command);
    return EXIT_FAILED;
}

bool command_parse_int(const char *text, int64_t low, int64_t high, int64_t *out)
{
    char *end = NULL;
    long long value = strtoll(text, &end, 10);
    if (end == text || *end != '\0' || value < low || value > high) {
        return false;
    }
    *out = value;
    return true;
}

bool command_parse_list(const char *text, int64_t low, int64_t high, int capacity, int64_t *out,
                        int *out_count)
{
    *out_count = 0;
    for (const char *rest = text; *out_count < capacity;) {
        char number[24];
        size_t length = strcspn(rest, ",");
        if (length >= sizeof(number)) {
            return false;
        }
        memcpy(number, rest, length);
        number[length] = '\0';
        if (!command_parse_int(number, low, high, &out[*out_count])) {
            return false;
        }
        ++*out_count;
        if (rest[length] == '\0') {
            return true;
        }
        rest += length + 1;
    }
    return false;
}

bool command_parse_range(const char *text, int64_t *out_begin, int64_t *out_end)
{
    const int64_t limit = INT64_C(1000000000);
    const char *colon = strchr(text, ':');
    *out_begin = 0;
    *out_end = limit;
    if (colon == NULL) {
        return command_parse_int(text, 1, limit, out_end);
    }
    char first[32];
    size_t length = (size_t)(colon - text);
    if (length >= sizeof(first)) {
        return false;
    }
    memcpy(first, text, length);
    first[length] = '\0';
    if (length > 0 && !command_parse_int(first, 0, limit, out_begin)) {
        return false;
    }
    if (colon[1] != '\0' && !command_parse_int(colon + 1, 1, limit, out_end)) {
        return false;
    }
    return *out_begin < *out_end;
}

int main(int argc, char **argv)
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
