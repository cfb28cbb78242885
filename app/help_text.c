/* The help of a command as text. */
#define _POSIX_C_SOURCE 200809L
#include "help_text.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define LINE_SIZE 256

void help_text_read(void (*print_help)(void), char out[HELP_TEXT_SIZE])
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

void help_text_of_option(const char *help, const char *name, char *out, size_t size)
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
