/* The help of a command as text. */
#ifndef RELIEF_APP_HELP_TEXT_H
#define RELIEF_APP_HELP_TEXT_H

#include <stddef.h>

#define HELP_TEXT_SIZE 16384

/* What print_help prints on standard output; "" where there is no place for a file. */
void help_text_read(void (*print_help)(void), char out[HELP_TEXT_SIZE]);
/* What the help says of "--name" up to its first semicolon, on one line; "" when it says nothing.
 */
void help_text_of_option(const char *help, const char *name, char *out, size_t size);

#endif
