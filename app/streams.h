/* Standard input, output and error. */
#ifndef RELIEF_APP_STREAMS_H
#define RELIEF_APP_STREAMS_H

/* First of all: a stream that the caller closed becomes /dev/null, or the first file opened would
 * take its number and get what is printed. */
void streams_open(void);
/* Last of all: the exit status, which is EXIT_FAILED after a line on stderr when not all that was
 * printed could be written. */
int streams_end(int status);

#endif
