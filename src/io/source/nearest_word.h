/* Which word of a list was meant. */
#ifndef RLF_IO_SOURCE_NEAREST_WORD_H
#define RLF_IO_SOURCE_NEAREST_WORD_H

#include "relief/base.h"

/* Whether `list`, words with blanks between (NULL = none), has the word. */
bool io_word_is_in(const char *list, const char *word);

/* Copies the word of the list that takes the fewest edits (Levenshtein 1966) to make of `word`.
 * False when none is within a third of its letters. */
bool io_word_nearest(const char *list, const char *word, char *out, size_t size);

#endif
