/* A published frame as a camera sees it that stands still. */
#ifndef RELIEF_APP_EVAL_PUBLIC_STILL_H
#define RELIEF_APP_EVAL_PUBLIC_STILL_H

#include "eval/public/frame.h"
#include "eval/table.h"

/* The frame seen with noise for two seconds, by sensors of two kinds. */
rlf_result public_still_run(eval_table *table, const public_frame *f, const char *name,
                            int profile_mask);

#endif
