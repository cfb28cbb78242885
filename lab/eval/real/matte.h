/* A virtual slab at rest before a clip, and what of it the matte shows. */
#ifndef RELIEF_APP_EVAL_REAL_MATTE_H
#define RELIEF_APP_EVAL_REAL_MATTE_H

#include "eval/real/clip.h"

typedef struct real_matte {
    rlf_source *source;
    rlf_pipeline *pipeline;
    rlf_compositor *compositor;
    rlf_body_state slab;
} real_matte;

/* The slab's front is square to the camera at depth `z`, and fills the view. */
rlf_result real_matte_open(const real_clip *clip, double z, real_matte *out);
void real_matte_close(real_matte *m);
/* The next frame; alpha of the slab goes to *out_matte, valid until the next call. */
rlf_result real_matte_next(real_matte *m, rlf_pipeline_output *out_frame, rlf_plane_u8 *out_matte);

#endif
