/* A source and the pipeline that runs on it, for physics on what the synthetic sensor shows. */
#ifndef RELIEF_APP_EVAL_SENSED_ROOM_H
#define RELIEF_APP_EVAL_SENSED_ROOM_H

#include "eval/oracle.h"
#include "relief/io.h"

/* A source and the pipeline that runs on it without pictures. */
typedef struct eval_room {
    rlf_source *truth;   /* the synthetic one; `source` is it, or drops frames of it */
    rlf_source *source;  /* NULL: `truth` itself */
    eval_oracle *oracle; /* NULL: all is sensed */
    int32_t lost;        /* frames dropped after each that is given */
    rlf_pipeline *pipeline;
    rlf_world *world;
    rlf_pipeline_output frame; /* the last one */
} eval_room;

/* Opens a synthetic source; `lost` frames are dropped between any two, and `oracle` says what of
 * the surface is true, bits of eval_oracle_part. */
rlf_result eval_room_open(const char *source, int32_t lost, rlf_profile profile, int32_t oracle,
                          eval_room *out);
void eval_room_close(eval_room *stage);
/* RLF_END after Ctrl-C too. */
rlf_result eval_room_step(eval_room *stage);

#endif
