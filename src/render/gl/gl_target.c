/* Framebuffer object and read back. */
#include "gl_target.h"

static void attach_renderbuffers(gl_target *target)
{
    GLuint buffers[2];
    glGenRenderbuffers(2, buffers);
    target->color = buffers[0];
    target->depth_stencil = buffers[1];
    glBindRenderbuffer(GL_RENDERBUFFER, target->color);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, target->width, target->height);
    glBindRenderbuffer(GL_RENDERBUFFER, target->depth_stencil);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH24_STENCIL8, target->width, target->height);
    glBindRenderbuffer(GL_RENDERBUFFER, 0);
    glGenFramebuffers(1, &target->framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, target->framebuffer);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, target->color);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER,
                              target->depth_stencil);
}

rlf_result gl_target_create(int32_t width, int32_t height, gl_target *out)
{
    GLint texture_max = 0;
    GLint buffer_max = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &texture_max);
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &buffer_max);
    GLint limit = texture_max < buffer_max ? texture_max : buffer_max;
    if (width > limit || height > limit) {
        return rlf_fail(
            RLF_ERROR_DEVICE,
            "OpenGL: a picture of %d x %d is beyond this driver's limit of %d: choose a "
            "smaller one or --renderer soft",
            (int)width, (int)height, (int)limit);
    }
    gl_target made = {0, 0, 0, width, height};
    attach_renderbuffers(&made);
    GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        gl_target_destroy(&made);
        return rlf_fail(RLF_ERROR_DEVICE,
                        "OpenGL: no framebuffer of %d x %d (status 0x%x): use --renderer soft",
                        (int)width, (int)height, (unsigned)status);
    }
    *out = made;
    return RLF_OK;
}

void gl_target_destroy(gl_target *target)
{
    const GLuint buffers[2] = {target->color, target->depth_stencil};
    glDeleteFramebuffers(1, &target->framebuffer);
    glDeleteRenderbuffers(2, buffers);
    *target = (gl_target){0};
}

void gl_target_bind(const gl_target *target)
{
    glBindFramebuffer(GL_FRAMEBUFFER, target->framebuffer);
    glViewport(0, 0, target->width, target->height);
}

void gl_target_read(const gl_target *target, const rlf_image_rgba8 *out)
{
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target->framebuffer);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glReadPixels(0, 0, target->width, target->height, GL_RGBA, GL_UNSIGNED_BYTE, out->data);
}
