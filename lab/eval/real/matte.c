/* The slab is no body of physics: it only is in the picture. */
#include "eval/real/matte.h"

#include "eval/real/clip.h"

#include <string.h>

#define SLAB_WIDE 8.0 /* times its depth */
#define SLAB_THICK_M 0.02

rlf_result real_matte_open(const real_clip *clip, double z, real_matte *out)
{
    memset(out, 0, sizeof(*out));
    rlf_result result = real_clip_source(clip, 1, &out->source);
    if (result != RLF_OK) {
        return result;
    }
    rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, out->source, NULL);
    def.enable_render = false;
    result = rlf_pipeline_create(&def, &out->pipeline);
    if (result == RLF_OK) {
        rlf_compositor_def compositor = rlf_pipeline_get_compositor_def(out->pipeline);
        compositor.occlusion = RLF_OCCLUSION_SOFT;
        compositor.enable_real_shade = false; /* the matte does not know of them */
        compositor.enable_real_ambient = false;
        result = rlf_compositor_create_soft(&compositor, &out->compositor);
    }
    out->slab = (rlf_body_state){
        .id = {1, 1},
        .shape = {.type = RLF_SHAPE_BOX, .size = {SLAB_WIDE * z, SLAB_WIDE * z, SLAB_THICK_M}},
        .T_world_body = rlf_pose_identity(),
        .mass = 1.0,
        .color = {1.0f, 0.5f, 0.0f}};
    out->slab.T_world_body.p = rlf_vec3_make(0, 0, z + 0.5 * SLAB_THICK_M);
    if (result != RLF_OK) {
        real_matte_close(out);
    }
    return result;
}

void real_matte_close(real_matte *m)
{
    rlf_compositor_destroy(&m->compositor);
    rlf_pipeline_destroy(&m->pipeline);
    rlf_source_destroy(&m->source);
}

rlf_result real_matte_next(real_matte *m, rlf_pipeline_output *out_frame, rlf_plane_u8 *out_matte)
{
    rlf_result result = rlf_pipeline_step(m->pipeline, out_frame);
    if (result != RLF_OK) {
        return result;
    }
    const rlf_snapshot snapshot = {.bodies = &m->slab, .body_count = 1};
    const rlf_render_input input = {.frame = &out_frame->frame,
                                    .surface = out_frame->surface,
                                    .snapshot = &snapshot,
                                    .T_world_camera = rlf_pose_identity()};
    rlf_render_output out;
    result = rlf_compositor_render(m->compositor, &input, &out);
    *out_matte = out.matte;
    return result;
}
