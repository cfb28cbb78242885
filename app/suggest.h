/* What to say when a name is wrong: the one that was meant, or all that there are. */
#ifndef RELIEF_APP_SUGGEST_H
#define RELIEF_APP_SUGGEST_H

#include "relief/base.h"

#define SUGGEST_TEXT 1024
/* "did you mean 'depth'?" into `out`, which is returned; where no name is near, or `lists_all`,
 * also "there are camera, depth, ...". `names` end with NULL; "" of none. Thread-safety: any. */
const char *suggest_text(const char *text, const char *const *names, bool lists_all,
                         char out[SUGGEST_TEXT]);

#endif
