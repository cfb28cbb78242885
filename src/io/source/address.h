/* SOURCE of a command line, taken apart. */
#ifndef RLF_IO_SOURCE_ADDRESS_H
#define RLF_IO_SOURCE_ADDRESS_H

#include "relief/base.h"

#define IO_ADDRESS_MAX 4096
#define IO_ADDRESS_KEYS_MAX 24

/* "scheme:place?key=value&...", or a path in place of "scheme:place". */
typedef struct io_address {
    char text[IO_ADDRESS_MAX]; /* holds the parts, each with its ending zero */
    const char *scheme;        /* "" = none: a path */
    const char *place;
    int32_t key_count;
    const char *keys[IO_ADDRESS_KEYS_MAX];
    const char *values[IO_ADDRESS_KEYS_MAX];
} io_address;

/* A path that exists is a path, whatever characters it has. RLF_ERROR_INVALID with a line that says
 * what is wrong: too long, a key without a value, a key given twice. */
rlf_result io_address_parse(const char *source, io_address *out);

/* Takes a key out; NULL when it was not given. */
const char *io_address_take(io_address *address, const char *key);

/* Whether `list`, words with blanks between (NULL = none), has the word. */
bool io_word_is_in(const char *list, const char *word);

#endif
