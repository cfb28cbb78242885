/* What a shell offers behind the cursor: `relief help --complete WORD...`, which the files in
 * app/completion ask. Hidden: what it prints is for them. */
#ifndef RELIEF_APP_COMPLETE_H
#define RELIEF_APP_COMPLETE_H

#include "dispatch.h"

/* `words` are those behind "relief", the last one being the one that is completed, perhaps "".
 * Prints one line for each word that could stand there, "WORD<tab>what it is"; a word that ends in
 * "=" or
 * "," goes on. Where files are wanted there is also a line ":files", with endings behind it where
 * only such are, or ":folders". The commands end with a NULL name. Returns EXIT_DONE. */
int complete_print(const subcommand *commands, int count, char **words);

#endif
