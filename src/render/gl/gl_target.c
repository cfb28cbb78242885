/* Framebuffer objects and read back. */
#include "render/gl/gl_context.h"

static void make_buffers(gl_target *target)
{
    GLsizei w = target->width;
    GLsizei h = target->height;
    GLuint names[3];
    glGenRenderbuffers(3, names);
    target->color = names[0];
    target->depth = names[1];
    target->resolved_color = names[2];
    glBindRenderbuffer(GL_RENDERBUFFER, target->color);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, TARGET_SAMPLES, GL_RGBA8, w, h);
    glBindRenderbuffer(GL_RENDERBUFFER, target->depth);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, TARGET_SAMPLES, GL_DEPTH24_STENCIL8, w, h);
    glBindRenderbuffer(GL_RENDERBUFFER, target->resolved_color);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, w, h);
    glBindRenderbuffer(GL_RENDERBUFFER, 0);
}

/* Leaves the multisampled framebuffer bound; returns what is wrong with either. */
static GLenum make_framebuffers(gl_target *target)
{
    GLuint names[2];
    glGenFramebuffers(2, names);
    target->framebuffer = names[0];
    target->resolved = names[1];
    glBindFramebuffer(GL_FRAMEBUFFER, target->resolved);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                              target->resolved_color);
    GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        return status;
    }
    glBindFramebuffer(GL_FRAMEBUFFER, target->framebuffer);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, target->color);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER,
                              target->depth);
    return glCheckFramebufferStatus(GL_FRAMEBUFFER);
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
    gl_target made = {.width = width, .height = height};
    make_buffers(&made);
    GLenum status = make_framebuffers(&made);
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
    const GLuint framebuffers[2] = {target->framebuffer, target->resolved};
    const GLuint buffers[3] = {target->color, target->depth, target->resolved_color};
    glDeleteFramebuffers(2, framebuffers);
    glDeleteRenderbuffers(3, buffers);
    *target = (gl_target){0};
}

void gl_target_bind(const gl_target *target)
{
    glBindFramebuffer(GL_FRAMEBUFFER, target->framebuffer);
    glViewport(0, 0, target->width, target->height);
}

void gl_target_read(const gl_target *target, const rlf_image_rgba8 *out)
{
    GLint w = target->width;
    GLint h = target->height;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target->framebuffer);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target->resolved);
    glBlitFramebuffer(0, 0, w, h, 0, 0, w, h, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target->resolved);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glPixelStorei(GL_PACK_ROW_LENGTH, 0);
    glReadPixels(0, 0, w, h, GL_RGBA, GL_UNSIGNED_BYTE, out->data);
}
