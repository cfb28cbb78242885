/* Stencil-limited layers, one per body. */
#include "render/gl/gl_thesis.h"

#include "camera/pixel_rect.h"

rlf_result gl_thesis_create(int32_t width, int32_t height, gl_thesis *out)
{
    const GLenum none = GL_NONE;
    out->body_depth = gl_texture_create(GL_NEAREST);
    gl_texture_allocate_depth(&out->body_depth, width, height);
    glGenFramebuffers(1, &out->framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, out->framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, out->body_depth.name,
                           0);
    glDrawBuffers(1, &none);
    glReadBuffer(GL_NONE);
    GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        gl_thesis_destroy(out);
        return rlf_fail(RLF_ERROR_DEVICE,
                        "OpenGL: no depth framebuffer of %d x %d (status 0x%x): use --renderer "
                        "soft",
                        (int)width, (int)height, (unsigned)status);
    }
    return RLF_OK;
}

void gl_thesis_destroy(gl_thesis *thesis)
{
    glDeleteFramebuffers(1, &thesis->framebuffer);
    gl_texture_destroy(&thesis->body_depth);
    *thesis = (gl_thesis){0};
}

static void draw_body(const gl_thesis_pass *pass, const rlf_snapshot *snapshot, int32_t index)
{
    gl_bodies_begin(pass->bodies, &pass->body_pass);
    gl_bodies_draw(pass->bodies, &pass->body_pass, snapshot, index);
    gl_bodies_end();
}

void gl_thesis_draw(const gl_thesis *thesis, const gl_thesis_pass *pass,
                    const rlf_snapshot *snapshot, int32_t index)
{
    /* Clearing and layering the whole picture once per body would cost bodies times pixels. */
    const gl_view *view = pass->body_pass.view;
    rlf_vec3 center = rlf_transform(&view->T_picture_world, snapshot->bodies[index].T_world_body.p);
    const double radius = rlf_shape_radius(&snapshot->bodies[index].shape);
    pixel_rect rect;
    if (!pixel_rect_of_ball(&view->camera, center, radius, &rect)) {
        return;
    }
    glEnable(GL_SCISSOR_TEST);
    glScissor(rect.x0, rect.y0, rect.x1 - rect.x0, rect.y1 - rect.y0);

    /* The body's z per pixel, for the layer's comparison. */
    glBindFramebuffer(GL_FRAMEBUFFER, thesis->framebuffer);
    glClear(GL_DEPTH_BUFFER_BIT);
    draw_body(pass, snapshot, index);

    /* The body itself marks its pixels in the stencil buffer. */
    gl_target_bind(pass->target);
    glClear(GL_STENCIL_BUFFER_BIT);
    glEnable(GL_STENCIL_TEST);
    glStencilFunc(GL_ALWAYS, 1, 0xff);
    glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
    draw_body(pass, snapshot, index);

    /* Reality over it. Blending scales the matte in alpha by what the layer leaves to be seen. */
    gl_layer_images images = pass->images;
    images.body_depth = &thesis->body_depth;
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE); /* which counts with the mirrored rows of bodies */
    glStencilFunc(GL_EQUAL, 1, 0xff);
    glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE_MINUS_SRC_ALPHA);
    gl_layers_draw_occlusion(pass->layers, &images);
    glDisable(GL_BLEND);
    glDisable(GL_STENCIL_TEST);
    glDisable(GL_SCISSOR_TEST);
    glEnable(GL_CULL_FACE);
    glEnable(GL_DEPTH_TEST);
}
