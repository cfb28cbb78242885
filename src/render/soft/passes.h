/* Inside the CPU renderer: the passes that make a picture, in the order in which they run. */
#ifndef RLF_RENDER_SOFT_PASSES_H
#define RLF_RENDER_SOFT_PASSES_H

#include "kernel/kernel.h"
#include "render/soft/soft.h"

#include <string.h>

/* ---- background.c: the picture before any body is in it. */

/* The colour picture, or, when it has no data, registered depth in grey. */
void soft_set_background(soft *s, const rlf_image_rgba8 *color);
/* Rows [begin, end) of it; the matte there becomes 0. Real depth must be up to date if it is grey.
 */
void soft_draw_background(const soft *s, int32_t begin, int32_t end);

/* ---- scene.c: all bodies of a picture as faces. */

/* What the picture is seen from. */
void soft_set_viewpoint(soft *s, const rlf_camera *camera, const rlf_pose *T_picture_depth);
/* All bodies in the picture as faces, with the light where they are; then, with what is real read,
 * what takes light from them. */
rlf_result soft_scene_build(soft *s, const rlf_render_input *input);
void soft_scene_light(soft *s, const rlf_render_input *input);

/* ---- scene_model.c: bodies that are drawn as models. */

/* The faces of a body; its colour is that of the body. */
rlf_result soft_scene_add_model(soft *s, const rlf_look *look, const rlf_pose *T_picture_body,
                                int32_t body);

/* ---- face.c: the faces of a scene. */

/* Room for so many faces, here and with every worker. */
rlf_result soft_scene_reserve(soft *s, int32_t face_count);
/* Clips at the near plane, drops what faces away or lies outside, and adds the rest; 3 or 4 corners
 * in one plane. */
void soft_scene_add_face(soft *s, const soft_corner *corners, int32_t corner_count, int32_t body);

/* ---- needed.c: which part of the registered depth a picture needs. */

/* Scene and matte's bodies must be in place. */
real_windows soft_needed_depth(const soft *s, const rlf_render_input *input);

/* ---- obscure.c: light around that real surfaces near a body keep from it. */

/* Which real surfaces the bodies of the scene are near. */
void soft_place_obscurances(soft *s, const rlf_render_input *input);
/* False when real surfaces take none within `radius` of a point of the face. */
bool soft_may_obscure(const soft *s, const soft_face *f, const float middle[3], float radius);
/* Multiplies `left`, of points of the face. */
void soft_obscure_nodes(const soft *s, const soft_face *f, const caster_points *points,
                        float *left);

/* ---- bodies.c: bodies over the picture. */

/* Draws the scene over the image and writes the matte; with_background: first the background, in
 * the same go through memory. */
void soft_draw_bodies(soft *s, bool with_background);

/* ---- raster.c: which samples of a group of rows see which face. */

/* Which of the group's first `count` faces are alone: no other one is before or behind them. */
void soft_find_alone(const soft_scene *scene, int32_t count, soft_group *group);
/* Where the face begins and ends in the group's rows; false when it touches no sample. */
bool soft_find_ends(const soft_face *face, const soft_group *group, soft_ends *out);
/* Lets the face win the samples of the group's rows where it is nearest so far, unless it is alone;
 * marks the parts of rows that it touches. */
void soft_raster_face(const soft_face *face, const soft_ends *ends, soft_group *group);

/* ---- shade.c: what samples see of faces. */

/* Adds what the samples see of the faces to the sums of the group's rows. */
void soft_shade_faces(const soft *s, const soft_ends *ends, int32_t count, const soft_group *group);

/* ---- skin.c: the colours of a model's texture. */

/* Shares of red, green and blue that one of the skin's textures shows in SOFT_LANES pixels of row y
 * from x on, of which `count` count; z are their depths. */
void soft_skin_colors(const soft_skin *skin, const rlf_model_texture *texture,
                      const soft_face *face, soft_lanes_at at, const float *z,
                      float rgb[3][SOFT_LANES]);

/* ---- shadow.c: shadows of bodies on real surfaces. */

/* Darkens the real surfaces of rows [begin, end) that the bodies keep the light from. */
void soft_draw_shadows(const soft *s, soft_shade_tile *tiles, int32_t begin, int32_t end);

/* ---- compose.c: the last step of a row. */

/* Puts sums (red, green, blue, shown; whole lanes) over `count` pixels. */
void soft_compose_row(float *const sum[4], int32_t count, uint8_t *restrict pixels,
                      uint8_t *restrict matte);

/* ---- Pixels as numbers: the lowest byte is red, whatever the machine's order. */

RLF_KERNEL_PART void soft_load_pixels(const uint8_t *bytes, int32_t count, uint32_t *out)
{
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    memcpy(out, bytes, 4 * (size_t)count);
#else
    for (int32_t i = 0; i < count; i++) {
        const uint8_t *p = bytes + 4 * (ptrdiff_t)i;
        out[i] = (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
    }
#endif
}

RLF_KERNEL_PART void soft_store_pixels(const uint32_t *pixels, int32_t count, uint8_t *out)
{
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    memcpy(out, pixels, 4 * (size_t)count);
#else
    for (int32_t i = 0; i < 4 * count; i++) {
        out[i] = (uint8_t)(pixels[i / 4] >> 8 * (i % 4));
    }
#endif
}

#endif
