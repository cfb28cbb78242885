/* Words of a list. */
#ifndef RLF_IO_SOURCE_NEAREST_WORD_H
#define RLF_IO_SOURCE_NEAREST_WORD_H

#include "relief/base.h"

/* Whether `list`, words with blanks between (NULL = none), has the word. */
bool io_word_is_in(const char *list, const char *word);

#endif
