/* Playing a recording: what comes after its end, and going to any place in it. */
#ifndef RELIEF_APP_PLAYBACK_H
#define RELIEF_APP_PLAYBACK_H

#include "relief/source.h"

typedef enum playback_end {
    PLAYBACK_STOP = 0, /* the end is the end */
    PLAYBACK_LOOP = 1, /* the first frame comes again; bodies stay */
    PLAYBACK_HOLD = 2  /* time goes on over the last frame: bodies fall on */
} playback_end;

/* A source that gives another one's frames with times that never go back. */
typedef struct playback playback;

/* Reads "stop", "loop" or "hold". */
bool playback_parse(const char *text, playback_end *out);
const char *playback_name(playback_end end);

/* Puts in place of *source one that plays it and owns it. *out is good for as long. A camera, which
 * has no end, stays as it is: *out is then NULL. */
rlf_result playback_wrap(rlf_source **source, playback_end end, playback **out);

void playback_set_end(playback *p, playback_end end);
playback_end playback_get_end(const playback *p);
/* Number of the frame given last, from 0; -1 before the first. */
int64_t playback_get_index(const playback *p);
/* Frames there are; -1 when that is not known, and then there is no seeking. */
int64_t playback_get_count(const playback *p);
/* Makes a frame the next one. Bodies stay, and wait while that frame comes. */
rlf_result playback_seek(playback *p, int64_t index);

#endif
