/* Finds the subcommand of a program and runs it; `PROGRAM help`, --help and --version. */
#include "dispatch.h"

#include "command.h"
#include "parts.h"

#include <stdio.h>
#include <string.h>

#define COMMANDS_MAX 32

static void print_help(const program *p, FILE *file)
{
    fprintf(file, "%s\n\nusage: %s COMMAND [OPTIONS]\n\ncommands:\n", p->purpose, p->name);
    for (const subcommand *s = p->commands; s->name != NULL; s++) {
        fprintf(file, "  %-9s %s\n", s->name, s->summary);
    }
    fprintf(file,
            "\nexamples:\n%s\n"
            "`%s help COMMAND` tells more. Exit status: 0 done, 1 failed, 2 wrong usage,\n"
            "130 stopped by Ctrl-C, in general 128 and the signal's number.\n",
            p->examples, p->name);
}

static const subcommand *find(const program *p, const char *name)
{
    for (const subcommand *s = p->commands; s->name != NULL; s++) {
        if (strcmp(name, s->name) == 0) {
            return s;
        }
    }
    return NULL;
}

static int refuse(const program *p, const char *name)
{
    static const char *const options[] = {"--help", "--version", NULL};
    const char *names[COMMANDS_MAX + 2] = {"help"};
    const bool is_option = name[0] == '-';
    int count = 1;
    for (const subcommand *s = p->commands; s->name != NULL && count <= COMMANDS_MAX; s++) {
        names[count++] = s->name;
    }
    const char *now = options_now(name, NULL);
    if (now != NULL) {
        fprintf(stderr, "%s: '%s' is now `%s`\n", p->name, name, now);
        return EXIT_USAGE;
    }
    char nearest[SUGGEST_TEXT];
    fprintf(stderr, "%s: there is no %s '%s': %s (see `%s --help`)\n", p->name,
            is_option ? "option" : "command", name,
            suggest_text(name, is_option ? options : names, false, nearest), p->name);
    return EXIT_USAGE;
}

static bool is_either(const char *text, const char *a, const char *b)
{
    return strcmp(text, a) == 0 || strcmp(text, b) == 0;
}

static int refuse_more(const program *p, const char *after, const char *argument)
{
    fprintf(stderr, "%s: '%s' after %s: leave it out (see `%s --help`)\n", p->name, argument, after,
            p->name);
    return EXIT_USAGE;
}

/* `help` and `help COMMAND`; and what completion asks. */
static int help(const program *p, int argc, char **argv)
{
    if (argc > 2 && strcmp(argv[2], "--complete") == 0) {
        return complete_print(p->commands, argc - 3, argv + 3);
    }
    const bool is_asked = argc > 2 && !is_either(argv[2], "--help", "-h");
    const subcommand *found = is_asked ? find(p, argv[2]) : NULL;
    if (is_asked && found == NULL) {
        return refuse(p, argv[2]);
    }
    if (argc > 3) {
        return refuse_more(p, "help", argv[3]);
    }
    if (found != NULL) {
        char asked[] = "--help";
        char *arguments[] = {argv[2], asked, NULL};
        return found->main(2, arguments);
    }
    print_help(p, stdout);
    return EXIT_DONE;
}

static int run_without_words(const program *p)
{
    command_catch_interrupts();
    const int status = p->run_alone != NULL ? p->run_alone() : -1;
    if (status >= 0) {
        return status;
    }
    print_help(p, stderr);
    if (p->run_alone != NULL && !part_is_built(PART_WINDOW)) {
        fprintf(stderr, "\n%s: %s\n", p->name, rlf_error_text());
    }
    return EXIT_USAGE;
}

static int run(const program *p, int argc, char **argv)
{
    if (argc < 2) {
        return run_without_words(p);
    }
    const char *name = argv[1];
    if (strcmp(name, "help") == 0) {
        return help(p, argc, argv);
    }
    const bool asks_help = is_either(name, "--help", "-h");
    if (argc > 2 && (asks_help || is_either(name, "--version", "-V"))) {
        return refuse_more(p, name, argv[2]);
    }
    if (asks_help) {
        print_help(p, stdout);
        return EXIT_DONE;
    }
    if (is_either(name, "--version", "-V")) {
        printf("%s %s\n", p->name, rlf_version());
        parts_print();
        return EXIT_DONE;
    }
    const subcommand *found = find(p, name);
    if (found == NULL) {
        return refuse(p, name);
    }
    command_catch_interrupts();
    return found->main(argc - 1, argv + 1);
}

int dispatch(const program *p, int argc, char **argv)
{
    command_program = p->name;
    options_moved = p->moved;
    streams_open();
    return streams_end(run(p, argc, argv));
}
