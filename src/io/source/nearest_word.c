/* Which word of a list was meant. */
#include "io/source/address.h"
#include "relief/io.h"

#include <string.h>

#define WORD_MAX 31

bool io_word_is_in(const char *list, const char *word)
{
    const size_t length = strlen(word);
    while (list != NULL && *list != '\0') {
        const size_t size = strcspn(list, " ");
        if (size == length && strncmp(list, word, size) == 0) {
            return true;
        }
        list += size;
        list += strspn(list, " ");
    }
    return false;
}

static size_t least(size_t a, size_t b, size_t c)
{
    const size_t m = a < b ? a : b;
    return m < c ? m : c;
}

/* Letters put in, taken out or changed; one row of the table at a time. */
static size_t edits(const char *a, size_t a_length, const char *b, size_t b_length)
{
    size_t row[WORD_MAX + 1];
    for (size_t j = 0; j <= b_length; j++) {
        row[j] = j;
    }
    for (size_t i = 1; i <= a_length; i++) {
        size_t before = row[0]; /* of the row above, one to the left */
        row[0] = i;
        for (size_t j = 1; j <= b_length; j++) {
            const size_t above = row[j];
            row[j] = least(above + 1, row[j - 1] + 1, before + (a[i - 1] != b[j - 1] ? 1 : 0));
            before = above;
        }
    }
    return row[b_length];
}

bool rlf_word_nearest(const char *list, const char *word, char *out, size_t size)
{
    if (!RLF_ASSERT(word != NULL && out != NULL)) {
        return false;
    }
    const size_t length = strlen(word);
    size_t best = length / 3 + 1 + 1; /* one more than what is allowed */
    bool is_found = false;
    while (length <= WORD_MAX && list != NULL && *list != '\0') {
        const size_t candidate = strcspn(list, " ");
        if (candidate > 0 && candidate <= WORD_MAX && candidate < size) {
            const size_t distance = edits(word, length, list, candidate);
            if (distance < best) {
                best = distance;
                memcpy(out, list, candidate);
                out[candidate] = '\0';
                is_found = true;
            }
        }
        list += candidate;
        list += strspn(list, " ");
    }
    return is_found;
}
