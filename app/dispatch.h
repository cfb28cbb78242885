/* A program that is made of subcommands: `relief`, and the laboratory's `relief-lab`. */
#ifndef RELIEF_APP_DISPATCH_H
#define RELIEF_APP_DISPATCH_H

#include "options.h"

typedef struct subcommand {
    const char *name;
    int (*main)(int argc, char **argv); /* argv[0] is the subcommand's name; returns a status */
    const char *summary;
} subcommand;

typedef struct program {
    const char *name, *purpose, *examples;
    const subcommand *commands; /* at most 32; a NULL name ends them */
    const moved_word *moved;    /* commands and options of earlier versions; NULL = none */
    /* Without any word: the exit status, or -1 to print the help. NULL = prints the help. */
    int (*run_alone)(void);
} program;

/* Runs the subcommand that the words ask for. Returns the program's exit status. */
int dispatch(const program *p, int argc, char **argv);

/* ---- complete.c: what a shell offers behind the cursor: `relief help --complete WORD...`, which
 * the files in app/completion ask. Hidden: what it prints is for them */

/* `words` are those behind "relief", the last one being the one that is completed, perhaps "".
 * Prints one line for each word that could stand there, "WORD<tab>what it is"; a word that ends in
 * "=" or
 * "," goes on. Where files are wanted there is also a line ":files", with endings behind it where
 * only such are, or ":folders". The commands end with a NULL name. Returns EXIT_DONE. */
int complete_print(const subcommand *commands, int count, char **words);

#endif
