/* The object behind rlf_source, and how a source recognises its own. */
#ifndef RLF_CAPTURE_SOURCE_OBJECT_H
#define RLF_CAPTURE_SOURCE_OBJECT_H

#include "relief/source.h"

/* The context of a source whose frames come from `next`; NULL when it is another kind of source. */
void *capture_source_self(const rlf_source *source, rlf_result (*next)(void *, rlf_frame *));

#endif
