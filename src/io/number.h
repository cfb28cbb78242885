/* Decimal numbers with a point, whatever the program's locale says. */
#ifndef RLF_IO_NUMBER_H
#define RLF_IO_NUMBER_H

#include <stdbool.h>

#define IO_NUMBER_SIZE 32 /* bytes that io_number_format may write, with the ending zero */

/* Nine significant digits ("%.9g"). Returns the length. */
int io_number_format(double x, char out[IO_NUMBER_SIZE]);

/* Reads a whole token, e.g. "-1.5e3". False when it is not a finite number. */
bool io_number_parse(const char *token, double *out);

#endif
