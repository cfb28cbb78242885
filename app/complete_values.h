/* What a shell offers as an option's value. */
#ifndef RELIEF_APP_COMPLETE_VALUES_H
#define RELIEF_APP_COMPLETE_VALUES_H

#include "options.h"

/* Prints what could be the option's value, `so_far` having been typed; the first `length`
 * characters of `before` go before each. */
void complete_values(const option_def *o, const char *so_far, int length, const char *before);
/* Prints what could be an argument of the command with this help. */
void complete_argument(const char *help);

#endif
