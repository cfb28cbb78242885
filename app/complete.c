/* What a shell offers behind the cursor, from the tables of the options and their help. */
#define _POSIX_C_SOURCE 200809L
#include "dispatch.h"

#include "command.h"
#include "options.h"
#include "scene_files.h"
#include "settings.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* ---- the help as text ------------------------------------------------------------------------ */

#define HELP_TEXT_SIZE 16384
#define LINE_SIZE 256

/* What print_help prints on standard output; "" where there is no place for a file. */
static void help_text_read(void (*print_help)(void), char out[HELP_TEXT_SIZE])
{
    out[0] = '\0';
    FILE *file = tmpfile();
    if (file == NULL) {
        return;
    }
    (void)fflush(stdout);
    const int kept = dup(STDOUT_FILENO);
    if (kept >= 0 && dup2(fileno(file), STDOUT_FILENO) >= 0) {
        print_help();
        (void)fflush(stdout);
        (void)dup2(kept, STDOUT_FILENO);
        rewind(file);
        out[fread(out, 1, HELP_TEXT_SIZE - 1, file)] = '\0';
    }
    if (kept >= 0) {
        (void)close(kept);
    }
    (void)fclose(file);
}

/* Adds the words of a line that begins at column `from`, one blank between. */
static void add_words(const char *from, size_t length, char *out, size_t size)
{
    char text[LINE_SIZE];
    (void)snprintf(text, sizeof(text), "%.*s", (int)length, from);
    const size_t used = strlen(out);
    const size_t blanks = strspn(text, " ");
    (void)snprintf(out + used, size - used, "%s%s", used > 0 ? " " : "", text + blanks);
}

/* "  --NAME ARGUMENT   what it does": the last part, which two blanks part from the others, or one
 * where the argument is long. */
static const char *meaning(const char *text, size_t length)
{
    size_t second = length;
    for (size_t i = 2, blanks = 0; i + 1 < length; i++) {
        if (text[i] == ' ' && text[i + 1] == ' ') {
            return text + i;
        }
        if (text[i] == ' ' && ++blanks == 2) {
            second = i;
        }
    }
    return text + second;
}

/* Whether the line is about the option. */
static bool is_of(const char *text, const char *name)
{
    const size_t length = strlen(name);
    return strncmp(text, "  --", 4) == 0 && strncmp(text + 4, name, length) == 0 &&
           (text[4 + length] == ' ' || text[4 + length] == '\n');
}

/* What the help says of "--name" up to its first semicolon, on one line; "" = nothing. */
static void help_text_of_option(const char *help, const char *name, char *out, size_t size)
{
    bool is_inside = false;
    out[0] = '\0';
    for (const char *at = help; *at != '\0';) {
        const size_t length = strcspn(at, "\n");
        if (is_of(at, name)) {
            const char *text = meaning(at, length);
            add_words(text, length - (size_t)(text - at), out, size);
            is_inside = true;
        } else if (is_inside && strncmp(at, "     ", 5) != 0) {
            break;
        } else if (is_inside) {
            add_words(at, length, out, size);
        }
        at += length + (at[length] == '\n');
    }
    out[strcspn(out, ";")] = '\0';
}

/* ---- values ---------------------------------------------------------------------------------- */

#define WORDS_MAX 8
#define WORD_SIZE 32

/* What goes before each value. */
typedef struct prefix {
    int length;
    const char *text;
} prefix;

static void print_word(prefix p, const char *word, const char *meaning)
{
    printf("%.*s%s\t%s\n", p.length, p.text, word, meaning);
}

/* The words that "use A, B or C" names; 0 when it is no such list. */
static int read_choices(const char *choices, char out[WORDS_MAX][WORD_SIZE])
{
    char text[256];
    int count = 0;
    if (choices == NULL || strncmp(choices, "use ", 4) != 0) {
        return 0;
    }
    (void)snprintf(text, sizeof(text), "%s", choices + 4);
    for (char *word = strtok(text, " "); word != NULL; word = strtok(NULL, " ")) {
        word[strcspn(word, ",")] = '\0';
        if (strcmp(word, "or") == 0) {
            continue;
        }
        const bool is_plain = strspn(word, "abcdefghijklmnopqrstuvwxyz0123456789_") == strlen(word);
        if (!is_plain || count == WORDS_MAX) {
            return 0;
        }
        (void)snprintf(out[count++], WORD_SIZE, "%s", word);
    }
    return count;
}

/* Names of which the value has one, or several with commas between. */
static void print_names(prefix p, const char *const *names, const char *so_far)
{
    const char *comma = strrchr(so_far, ',');
    const int kept = comma != NULL ? (int)(comma + 1 - so_far) : 0;
    for (int i = 0; names[i] != NULL; i++) {
        printf("%.*s%.*s%s\t\n", p.length, p.text, kept, so_far, names[i]);
    }
}

/* "NAME=" of every setting, or "NAME=WORD" once the name is there. */
static void print_settings(prefix p, const char *so_far)
{
    static const rlf_reconstruct_def none = {0};
    const size_t length = strcspn(so_far, "=");
    for (int32_t i = 0; i < settings_count(); i++) {
        setting_view s;
        settings_look(i, &none, &s);
        const bool is_named = so_far[length] == '=' && strlen(s.name) == length &&
                              strncmp(s.name, so_far, length) == 0;
        if (so_far[length] != '=') {
            printf("%.*s%s=\t%s\n", p.length, p.text, s.name, s.meaning);
        }
        for (int w = 0; is_named && s.words != NULL && s.words[w] != NULL; w++) {
            printf("%.*s%s=%s\t\n", p.length, p.text, s.name, s.words[w]);
        }
    }
}

static void print_scenes(prefix p)
{
    static scene_entry entries[SCENES_MAX];
    const int32_t count = scene_files_list(entries, SCENES_MAX);
    for (int32_t i = 0; i < count; i++) {
        print_word(p, entries[i].name, entries[i].about);
    }
    printf(":files .json\n");
}

static void print_choices(prefix p, const option_def *o)
{
    char words[WORDS_MAX][WORD_SIZE];
    const int count = read_choices(o->choices, words);
    for (int i = 0; i < count; i++) {
        print_word(p, words[i], "");
    }
    if (count == 0 && strstr(o->choices, "the name in") != NULL) {
        printf(":files\n");
    }
}

static void complete_values(const option_def *o, const char *so_far, int length,
                            const char *before);

/* "NAME=" of every key behind what is typed, or what could be the value of the last one. */
static void print_keys(prefix p, const option_def *o, const char *so_far)
{
    const char *key = so_far;
    for (const char *c = so_far; *c != '\0'; c++) {
        key = *c == '?' || *c == '&' || *c == ',' ? c + 1 : key;
    }
    const size_t length = strcspn(key, "=");
    for (const option_def *k = o->keys; k->name != NULL; k++) {
        const bool is_named = strlen(k->name) == length && strncmp(k->name, key, length) == 0;
        char before[512];
        if (key[length] == '=' && is_named) {
            const int kept = (int)(key + length + 1 - so_far);
            (void)snprintf(before, sizeof before, "%.*s%.*s", p.length, p.text, kept, so_far);
            complete_values(k, key + length + 1, (int)strlen(before), before);
        } else if (key[length] != '=') {
            printf("%.*s%.*s%s%s\t\n", p.length, p.text, (int)(key - so_far), so_far, k->name,
                   k->kind == OPTION_FLAG ? "" : "=");
        }
    }
}

/* Prints what could be the option's value, `so_far` having been typed; the first `length`
 * characters of `before` go before each. */
static void complete_values(const option_def *o, const char *so_far, int length, const char *before)
{
    const prefix p = {length, before};
    if (o->keys != NULL && (o->kind == OPTION_KEYS || strchr(so_far, '?') != NULL)) {
        print_keys(p, o, so_far);
        return;
    }
    if (o->names != NULL) {
        print_names(p, o->names, so_far);
        return;
    }
    switch (o->kind) {
    case OPTION_PROFILE:
        print_word(p, "live", "the best method of each stage");
        print_word(p, "thesis", "the method as written");
        break;
    case OPTION_SET: print_settings(p, so_far); break;
    case OPTION_SCENE: print_scenes(p); break;
    case OPTION_CHOICE: print_choices(p, o); break;
    case OPTION_TEXT: printf(":files\n"); break;
    case OPTION_PLUGIN: printf(":files .so\n"); break;
    case OPTION_FILE: printf(":files %s\n", o->choices); break;
    case OPTION_FOLDER: printf(":folders\n"); break;
    case OPTION_KEYS:
    case OPTION_FLAG:
    case OPTION_INT32:
    case OPTION_INT64: break;
    }
}

/* Prints what could be an argument of the command with this help. */
static void complete_argument(const char *command, const char *help)
{
    static const char *const lists[] = {"sources", "scenes", "settings"};
    for (int i = 0; strcmp(command, "list") == 0 && i < 3; i++) {
        printf("%s\t\n", lists[i]);
    }
    static const char *const rooms[] = {"room", "empty", "thesis", "chair",    "book",  "hand",
                                        "lift", "swipe", "carry",  "crossing", "random"};
    const char *usage_end = strstr(help, "\n\n");
    const char *source = strstr(help, "SOURCE");
    if (source == NULL || usage_end == NULL || source > usage_end) {
        return;
    }
    for (size_t i = 0; i < sizeof(rooms) / sizeof(rooms[0]); i++) {
        printf("synthetic:%s\ta simulated room\n", rooms[i]);
    }
    printf(":files\n");
}

/* ---- words ----------------------------------------------------------------------------------- */

#define TEXT_SIZE 160

/* The words behind the command. */
static struct {
    int count;
    char **words;
    const char *command;
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
        complete_argument(line.command, help);
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
            line.command = c->name;
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
