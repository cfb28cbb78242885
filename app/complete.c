/* What a shell offers behind the cursor. */
#include "complete.h"

#include "command.h"
#include "complete_values.h"
#include "help_text.h"
#include "options.h"

#include <stdio.h>
#include <string.h>

#define TEXT_SIZE 160

/* The words behind the command. */
static struct {
    int count;
    char **words;
} line;

static bool takes_value(const option_def *o)
{
    return o->kind != OPTION_FLAG;
}

static const option_def *find(const option_def *options, const char *word)
{
    for (int i = 0; strncmp(word, "--", 2) == 0 && options[i].name != NULL; i++) {
        if (strcmp(options[i].name, word + 2) == 0) {
            return &options[i];
        }
    }
    return NULL;
}

static void print_options(const option_def *options, const char *help)
{
    char text[TEXT_SIZE];
    for (int i = 0; options[i].name != NULL; i++) {
        help_text_of_option(help, options[i].name, text, sizeof(text));
        printf("--%s\t%s\n", options[i].name, text);
    }
    printf("--help\tprint the options\n");
}

/* "--NAME=VALUE" in one word: values with "--NAME=" before them; false when the word is none. */
static bool print_glued(const option_def *options, const char *word)
{
    char name[64];
    const char *equal = strchr(word, '=');
    if (equal == NULL) {
        return false;
    }
    (void)snprintf(name, sizeof(name), "%.*s", (int)(equal - word), word);
    const option_def *o = find(options, name);
    if (o != NULL && takes_value(o)) {
        complete_values(o, equal + 1, (int)(equal + 1 - word), word);
    }
    return true;
}

/* Called with a command's table in place of reading its options. */
static void visit(const option_def *options, void (*print_help)(void))
{
    static char help[HELP_TEXT_SIZE];
    const char *word = line.words[line.count - 1];
    const option_def *before = line.count > 1 ? find(options, line.words[line.count - 2]) : NULL;
    help_text_read(print_help, help);
    if (before != NULL && takes_value(before)) {
        complete_values(before, word, 0, "");
    } else if (word[0] == '-') {
        if (!print_glued(options, word)) {
            print_options(options, help);
        }
    } else {
        complete_argument(help);
    }
}

int complete_print(const subcommand *commands, int count, char **words)
{
    const bool is_command = count == 1 || (count == 2 && strcmp(words[0], "help") == 0);
    if (count < 1) {
        return EXIT_DONE;
    }
    for (const subcommand *c = commands; c->name != NULL; c++) {
        if (is_command) {
            printf("%s\t%s\n", c->name, c->summary);
        } else if (strcmp(c->name, words[0]) == 0) {
            char *arguments[] = {words[0], NULL};
            line.count = count - 1;
            line.words = words + 1;
            options_visit(visit);
            (void)c->main(1, arguments);
            options_visit(NULL);
        }
    }
    if (count == 1) {
        printf("help\ttell what a command does\n--help\tlist the commands\n--version\ttell what is "
               "built in\n");
    }
    return EXIT_DONE;
}
