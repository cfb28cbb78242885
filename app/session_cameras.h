/* The cameras of a session beside its first: their surfaces join its world. */
#ifndef RELIEF_APP_SESSION_CAMERAS_H
#define RELIEF_APP_SESSION_CAMERAS_H

#include "session.h"

/* Where `source` names: itself, or the cameras of a list, FILE.json. */
rlf_result session_cameras_find(const char *source, session_cameras *out);
/* Opens all sources but the first, which play as it does. */
rlf_result session_cameras_open(session_cameras *cameras, const session_options *options,
                                rlf_pool *pool);
/* Their pipelines, which join `first`; the one of number `drawn` makes pictures. */
rlf_result session_cameras_join(session_cameras *cameras, rlf_pipeline *first, int32_t drawn);
/* Ends the pipelines; the sources stay. */
void session_cameras_leave(session_cameras *cameras);
void session_cameras_close(session_cameras *cameras);

#endif
