/* Relief: playing a recording: what comes after its end, and going to any place in it. Put it
 * between a source and a pipeline: the pipeline then takes the source's frames with times that
 * never go back.
 * SPDX-License-Identifier: MIT */
#ifndef RELIEF_PLAYBACK_H
#define RELIEF_PLAYBACK_H

#include "relief/source.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What comes after the last frame. */
typedef enum rlf_playback_end {
    RLF_PLAYBACK_STOP = 0, /* the end is the end */
    RLF_PLAYBACK_LOOP = 1, /* the first frame comes again; bodies stay */
    RLF_PLAYBACK_HOLD = 2  /* time goes on over the last frame: bodies fall on */
} rlf_playback_end;

/* A source that gives another one's frames with times that never go back. It belongs to that
 * source, so there is nothing to destroy. Thread-safety: the thread that takes the frames. */
typedef struct rlf_playback rlf_playback;

/* Reads "stop", "loop" or "hold"; false for anything else. */
RLF_API bool rlf_playback_parse(const char *text, rlf_playback_end *out);
/* The word for an end, e.g. "loop". Static. */
RLF_API const char *rlf_playback_name(rlf_playback_end end);

/* Puts in place of *source a source that plays it and owns it. *out is good for as long as that
 * source. A camera has no end and stays as it is: *out is then NULL. RLF_ERROR_MEMORY leaves
 * *source as it was. */
RLF_API rlf_result rlf_playback_wrap(rlf_source **source, rlf_playback_end end, rlf_playback **out);

/* Chooses what comes after the end, also while it plays: the choice holds from the next frame on,
 * and a recording that had ended goes on. */
RLF_API void rlf_playback_set_end(rlf_playback *p, rlf_playback_end end);
/* The choice that holds now. */
RLF_API rlf_playback_end rlf_playback_get_end(const rlf_playback *p);
/* Number of the frame given last, from 0; -1 before the first. */
RLF_API int64_t rlf_playback_get_index(const rlf_playback *p);
/* How far it is to the end: the number of frames; -1 when the source does not know it, and then
 * there is no seeking. */
RLF_API int64_t rlf_playback_get_count(const rlf_playback *p);
/* Makes a frame the next one. Bodies stay, and wait while that frame comes. RLF_ERROR_INVALID: no
 * such frame, or a source that cannot seek. */
RLF_API rlf_result rlf_playback_seek(rlf_playback *p, int64_t index);

#ifdef __cplusplus
}
#endif
#endif
