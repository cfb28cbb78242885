/* What a shell offers as an option's value, from what the option's row says of it. */
#include "complete_values.h"

#include "scene_files.h"
#include "settings.h"

#include <stdio.h>
#include <string.h>

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

void complete_values(const option_def *o, const char *so_far, int length, const char *before)
{
    const prefix p = {length, before};
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
    case OPTION_FLAG:
    case OPTION_INT32:
    case OPTION_INT64: break;
    }
}

void complete_argument(const char *help)
{
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
