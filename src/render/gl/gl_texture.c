/* Texture uploads. */
#include "render/gl/gl_context.h"

gl_texture gl_texture_create(GLint filter)
{
    gl_texture texture = {0, 0, 0};
    glGenTextures(1, &texture.name);
    glBindTexture(GL_TEXTURE_2D, texture.name);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    return texture;
}

void gl_texture_destroy(gl_texture *texture)
{
    glDeleteTextures(1, &texture->name);
    *texture = (gl_texture){0, 0, 0};
}

/* Binds for an upload; true when the storage has the size already. */
static bool prepare(gl_texture *texture, int32_t width, int32_t height)
{
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, texture->name);
    bool is_same = texture->width == width && texture->height == height;
    texture->width = width;
    texture->height = height;
    return is_same;
}

void gl_texture_upload_rgba8(gl_texture *texture, const rlf_image_rgba8 *image)
{
    int32_t w = image->width;
    int32_t h = image->height;
    if (!prepare(texture, w, h)) {
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, w, h, 0, GL_RGBA, GL_UNSIGNED_BYTE, NULL);
    }
    if (image->stride > 0 && image->stride % 4 == 0) {
        glPixelStorei(GL_UNPACK_ROW_LENGTH, (GLint)(image->stride / 4));
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, w, h, GL_RGBA, GL_UNSIGNED_BYTE, image->data);
        glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
        return;
    }
    for (int32_t y = 0; y < h; y++) {
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, y, w, 1, GL_RGBA, GL_UNSIGNED_BYTE,
                        rlf_rgba8_row(image, y));
    }
}

void gl_texture_upload_f32(gl_texture *texture, const float *data, int32_t width, int32_t height)
{
    if (!prepare(texture, width, height)) {
        glTexImage2D(GL_TEXTURE_2D, 0, GL_R32F, width, height, 0, GL_RED, GL_FLOAT, NULL);
    }
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RED, GL_FLOAT, data);
}

void gl_texture_upload_u8(gl_texture *texture, const uint8_t *data, int32_t width, int32_t height)
{
    if (!prepare(texture, width, height)) {
        glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, width, height, 0, GL_RED, GL_UNSIGNED_BYTE, NULL);
    }
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RED, GL_UNSIGNED_BYTE, data);
}

void gl_texture_allocate_rgba8(gl_texture *texture, int32_t width, int32_t height)
{
    (void)prepare(texture, width, height);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, NULL);
}

void gl_texture_allocate_depth(gl_texture *texture, int32_t width, int32_t height)
{
    (void)prepare(texture, width, height);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, width, height, 0, GL_DEPTH_COMPONENT,
                 GL_UNSIGNED_INT, NULL);
}

void gl_texture_bind(const gl_texture *texture, int unit)
{
    glActiveTexture(GL_TEXTURE0 + (GLenum)unit);
    glBindTexture(GL_TEXTURE_2D, texture->name);
}
