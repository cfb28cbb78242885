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

#endif
