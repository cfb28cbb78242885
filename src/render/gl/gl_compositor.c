/* The OpenGL renderer behind the compositor interface.
 *
 * The camera and mesh views are drawn here; every other view is a picture of a plane, which the
 * soft renderer inside paints as well without a GPU. */
#include "gl_compositor.h"

#include "gl_bodies.h"
#include "gl_layers.h"
#include "gl_target.h"
#include "gl_thesis.h"
#include "gl_wireframe.h"

#include "base/cookie.h"

typedef struct gl_compositor {
    rlf_compositor_def def;
    rlf_camera picture;       /* the colour (or depth) camera at the picture's size */
    rlf_pose T_picture_depth; /* A.2 */
    rlf_compositor *soft;
    rlf_registration *registration;
    rlf_plane_f32 real_depth; /* registered: z in the picture's camera */
    rlf_plane_u8 real_state;
    rlf_image_rgba8 image; /* read back */
    rlf_plane_u8 matte;

    gl_context context;
    gl_target target;
    gl_bodies bodies;
    gl_layers layers;
    gl_thesis thesis;
    gl_wireframe wireframe;
    gl_texture color_texture, depth_texture;
    bool has_wireframe; /* made when the view is first asked for */
} gl_compositor;

static const float wire_color[3] = {0.1f, 1.0f, 0.4f};

/* ---- create and destroy --------------------------------------------------------------------- */

static void destroy_gl(gl_compositor *c)
{
    if (c->has_wireframe) {
        gl_wireframe_destroy(&c->wireframe);
    }
    gl_texture_destroy(&c->color_texture);
    gl_texture_destroy(&c->depth_texture);
    gl_thesis_destroy(&c->thesis);
    gl_layers_destroy(&c->layers);
    gl_bodies_destroy(&c->bodies);
    gl_target_destroy(&c->target);
}

static void free_planes(gl_compositor *c)
{
    rlf_registration_destroy(&c->registration);
    rlf_compositor_destroy(&c->soft);
    rlf_free(c->real_depth.data);
    rlf_free(c->real_state.data);
    rlf_free(c->image.data);
    rlf_free(c->matte.data);
}

static void destroy(void *self)
{
    gl_compositor *c = self;
    gl_context_saved saved;
    if (gl_context_enter(&c->context, &saved)) {
        destroy_gl(c);
        gl_context_leave(&c->context, &saved);
    }
    gl_context_close(&c->context);
    free_planes(c);
    rlf_free(c);
}

static rlf_result create_planes(gl_compositor *c)
{
    int32_t w = c->picture.width;
    int32_t h = c->picture.height;
    size_t count = (size_t)w * (size_t)h;
    c->real_depth = (rlf_plane_f32){rlf_alloc_array(count, sizeof(float)), w, h, 4 * (ptrdiff_t)w};
    c->real_state = (rlf_plane_u8){rlf_alloc_array(count, 1), w, h, w};
    c->image = (rlf_image_rgba8){rlf_alloc_array(count, 4), w, h, 4 * (ptrdiff_t)w};
    c->matte = (rlf_plane_u8){rlf_alloc_array(count, 1), w, h, w};
    if (c->real_depth.data == NULL || c->real_state.data == NULL || c->image.data == NULL ||
        c->matte.data == NULL) {
        return RLF_ERROR_MEMORY;
    }
    const rlf_compositor_def *def = &c->def;
    rlf_result result = rlf_registration_create(&def->grid, def->ray_x, def->ray_y, &c->picture,
                                                &c->T_picture_depth, &c->registration);
    return result == RLF_OK ? rlf_compositor_create_soft(def, &c->soft) : result;
}

static rlf_result check_errors(void)
{
    GLenum error = glGetError();
    if (error == GL_NO_ERROR) {
        return RLF_OK;
    }
    return rlf_fail(RLF_ERROR_DEVICE,
                    "OpenGL: drawing failed with error 0x%x%s: use --renderer soft",
                    (unsigned)error,
                    error == GL_OUT_OF_MEMORY  ? " (out of memory)"
                    : error == GL_CONTEXT_LOST ? " (the driver lost the context)"
                                               : "");
}

/* With the context current. */
static rlf_result create_gl(gl_compositor *c)
{
    int32_t w = c->picture.width;
    int32_t h = c->picture.height;
    bool is_es = c->context.is_es;
    rlf_result result = gl_target_create(w, h, &c->target);
    if (result == RLF_OK) {
        result = gl_bodies_create(is_es, &c->bodies);
    }
    if (result == RLF_OK) {
        result = gl_layers_create(is_es, &c->layers);
    }
    if (result == RLF_OK) {
        result = gl_thesis_create(w, h, &c->thesis);
    }
    if (result != RLF_OK) {
        return result;
    }
    c->color_texture = gl_texture_create(GL_LINEAR);
    c->depth_texture = gl_texture_create(GL_NEAREST);
    return check_errors();
}

static rlf_result check_def(const rlf_compositor_def *def)
{
    if (def->grid.width < 1 || def->ray_x == NULL || def->ray_y == NULL) {
        return rlf_fail(RLF_ERROR_INVALID, "compositor: grid, ray_x and ray_y must be set");
    }
    if (def->width < 0 || def->height < 0 || def->width > RLF_IMAGE_SIZE_MAX ||
        def->height > RLF_IMAGE_SIZE_MAX) {
        return rlf_fail(RLF_ERROR_INVALID, "compositor: picture of %d x %d: use 0 to %d",
                        (int)def->width, (int)def->height, RLF_IMAGE_SIZE_MAX);
    }
    return rlf_camera_check(def->rig.has_color ? &def->rig.color : &def->rig.depth, "compositor");
}

static void set_picture(gl_compositor *c)
{
    const rlf_rig *rig = &c->def.rig;
    const rlf_camera *camera = rig->has_color ? &rig->color : &rig->depth;
    int32_t w = c->def.width > 0 ? c->def.width : camera->width;
    int32_t h = c->def.height > 0 ? c->def.height : camera->height;
    c->picture = rlf_camera_resize(camera, w, h);
    c->T_picture_depth = rig->has_color ? rig->T_color_depth : rlf_pose_identity();
}

static rlf_result render(void *self, const rlf_render_input *input, rlf_render_output *out);

static const rlf_compositor_methods methods = {render, destroy, "gl"};

/* Takes over an open context. */
static rlf_result create(const rlf_compositor_def *def, const gl_context *context,
                         rlf_compositor **out)
{
    gl_compositor *c = rlf_alloc(sizeof *c);
    if (c == NULL) {
        return RLF_ERROR_MEMORY;
    }
    c->def = *def;
    c->context = *context;
    set_picture(c);
    rlf_result result = create_planes(c);
    gl_context_saved saved;
    if (result == RLF_OK && !gl_context_enter(&c->context, &saved)) {
        result = rlf_fail(RLF_ERROR_DEVICE, "OpenGL: the context cannot be made current: use "
                                            "--renderer soft");
    } else if (result == RLF_OK) {
        result = create_gl(c);
        gl_context_leave(&c->context, &saved);
    }
    if (result == RLF_OK) {
        result = rlf_compositor_create_custom(&methods, c, out);
    }
    if (result != RLF_OK) {
        destroy(c);
    }
    return result;
}

rlf_result gl_compositor_create_offscreen(const rlf_compositor_def *def, gl_api api,
                                          rlf_compositor **out)
{
    gl_context context;
    rlf_result result = check_def(def);
    if (result == RLF_OK) {
        result = gl_context_open(api, &context);
    }
    return result == RLF_OK ? create(def, &context, out) : result;
}

rlf_result rlf_gl_compositor_create(const rlf_compositor_def *def, bool use_current_context,
                                    rlf_compositor **out)
{
    if (!RLF_ASSERT(def != NULL && def->cookie == RLF_DEF_COOKIE && out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    if (!use_current_context) {
        return gl_compositor_create_offscreen(def, CONTEXT_API_ANY, out);
    }
    gl_context context;
    rlf_result result = check_def(def);
    if (result == RLF_OK) {
        result = gl_context_adopt(&context);
    }
    return result == RLF_OK ? create(def, &context, out) : result;
}

/* ---- draw ----------------------------------------------------------------------------------- */

/* The colour image; without one the soft renderer's grey picture of the depth. */
static rlf_result upload_background(gl_compositor *c, const rlf_render_input *input)
{
    if (input->frame->color.data != NULL) {
        gl_texture_upload_rgba8(&c->color_texture, &input->frame->color);
        return RLF_OK;
    }
    rlf_render_input plain = *input;
    rlf_render_output grey;
    plain.snapshot = NULL;
    plain.view = RLF_VIEW_CAMERA;
    plain.overlay_count = 0;
    rlf_result result = rlf_compositor_render(c->soft, &plain, &grey);
    if (result == RLF_OK) {
        gl_texture_upload_rgba8(&c->color_texture, &grey.image);
    }
    return result;
}

static void upload_real_depth(gl_compositor *c, const rlf_render_input *input)
{
    rlf_registration_apply(c->registration, input->surface->depth, &c->real_depth, &c->real_state);
    gl_texture_upload_f32(&c->depth_texture, c->real_depth.data, c->real_depth.width,
                          c->real_depth.height);
}

static void draw_bodies(gl_compositor *c, const rlf_render_input *input, const gl_view *view)
{
    bool is_hidden_in_shader = c->def.occlusion == RLF_OCCLUSION_DEPTH;
    gl_bodies_pass pass = {view, c->def.light_direction,
                           is_hidden_in_shader ? &c->depth_texture : NULL};
    const rlf_snapshot *snapshot = input->snapshot;
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_CULL_FACE);
    glFrontFace(GL_CW); /* see gl_view_make */
    if (c->def.occlusion == RLF_OCCLUSION_THESIS) {
        gl_thesis_pass thesis = {
            &c->target,
            &c->bodies,
            &c->layers,
            pass,
            {&c->color_texture, &c->depth_texture, NULL, c->target.width, c->target.height}};
        for (int32_t i = 0; i < snapshot->body_count; i++) {
            gl_thesis_draw(&c->thesis, &thesis, &snapshot->bodies[i]);
        }
    } else {
        gl_bodies_begin(&c->bodies, &pass);
        for (int32_t i = 0; i < snapshot->body_count; i++) {
            gl_bodies_draw(&c->bodies, &pass, &snapshot->bodies[i]);
        }
        gl_bodies_end();
    }
    glFrontFace(GL_CCW);
    glDisable(GL_CULL_FACE);
    glDisable(GL_DEPTH_TEST);
}

static rlf_result draw_wireframe(gl_compositor *c, const rlf_render_input *input,
                                 const gl_view *view)
{
    if (!c->has_wireframe) {
        rlf_result result = gl_wireframe_create(c->context.is_es, &c->def.grid, c->def.ray_x,
                                                c->def.ray_y, &c->wireframe);
        if (result != RLF_OK) {
            return result;
        }
        c->has_wireframe = true;
    }
    gl_wireframe_draw(&c->wireframe, input->surface, view, wire_color);
    return RLF_OK;
}

/* Nothing that another user of a window's context left on may change the picture. */
static void reset_state(void)
{
    glDisable(GL_BLEND);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_STENCIL_TEST);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_CULL_FACE);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
}

/* With the context current. */
static rlf_result draw(gl_compositor *c, const rlf_render_input *input)
{
    gl_view view = gl_view_make(&c->picture, &c->T_picture_depth, &input->T_world_camera);
    reset_state();
    rlf_result result = upload_background(c, input);
    if (result != RLF_OK) {
        return result;
    }
    gl_target_bind(&c->target);
    glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    gl_layer_images images = {&c->color_texture, NULL, NULL, c->target.width, c->target.height};
    gl_layers_draw_background(&c->layers, &images);
    if (input->view == RLF_VIEW_MESH) {
        result = draw_wireframe(c, input, &view);
    } else if (input->snapshot != NULL && input->snapshot->body_count > 0) {
        if (c->def.occlusion != RLF_OCCLUSION_OFF) {
            upload_real_depth(c, input);
        }
        gl_target_bind(&c->target);
        draw_bodies(c, input, &view);
    }
    gl_target_read(&c->target, &c->image);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    return result == RLF_OK ? check_errors() : result;
}

/* Alpha of the read-back picture is the matte; the picture itself is opaque. */
static void split_matte(gl_compositor *c)
{
    size_t count = (size_t)c->image.width * (size_t)c->image.height;
    for (size_t i = 0; i < count; i++) {
        c->matte.data[i] = c->image.data[4 * i + 3];
        c->image.data[4 * i + 3] = 255;
    }
}

static rlf_result render(void *self, const rlf_render_input *input, rlf_render_output *out)
{
    gl_compositor *c = self;
    if (input->view != RLF_VIEW_CAMERA && input->view != RLF_VIEW_MESH) {
        return rlf_compositor_render(c->soft, input, out);
    }
    if (!RLF_ASSERT(input->surface->width == c->def.grid.width &&
                    input->surface->height == c->def.grid.height)) {
        return RLF_ERROR_INVALID;
    }
    gl_context_saved saved;
    if (!gl_context_enter(&c->context, &saved)) {
        return rlf_fail(RLF_ERROR_DEVICE, "OpenGL: the driver lost the context: use --renderer "
                                          "soft");
    }
    rlf_result result = draw(c, input);
    gl_context_leave(&c->context, &saved);
    if (result != RLF_OK) {
        return result;
    }
    split_matte(c);
    out->image = c->image;
    out->matte = c->matte;
    return RLF_OK;
}
