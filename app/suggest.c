/* Near names, and lists of all. */
#include "suggest.h"

#include "relief/io.h"

#include <stdio.h>
#include <string.h>

/* Appends; what has no room is cut. */
static void append(char out[SUGGEST_TEXT], const char *before, const char *text)
{
    const size_t used = strlen(out);
    (void)snprintf(out + used, SUGGEST_TEXT - used, "%s%s", before, text);
}

static void join(const char *const *names, const char *between, char out[SUGGEST_TEXT])
{
    for (int i = 0; names[i] != NULL; i++) {
        append(out, i > 0 ? between : "", names[i]);
    }
}

const char *suggest_text(const char *text, const char *const *names, bool lists_all,
                         char out[SUGGEST_TEXT])
{
    char words[SUGGEST_TEXT] = "";
    char nearest[64];
    join(names, " ", words);
    out[0] = '\0';
    const bool is_near = rlf_word_nearest(words, text, nearest, sizeof(nearest));
    if (is_near) {
        append(out, "did you mean '", nearest);
        append(out, "'?", "");
    }
    if (names[0] != NULL && (lists_all || !is_near)) {
        append(out, is_near ? " there are " : "there are ", "");
        join(names, ", ", out);
    }
    return out;
}
