/* The OpenGL renderer behind the compositor interface.
 *
 * The camera and mesh views are drawn here; every other view is a picture of a plane, which the
 * soft renderer inside paints as well without a GPU. */
#include "render/gl/gl_compositor.h"

#include "render/gl/gl_backdrop.h"
#include "render/gl/gl_bodies.h"
#include "render/gl/gl_thesis.h"
#include "render/gl/gl_context.h"
#include "render/gl/gl_wireframe.h"

#include "base/checks.h"
#include "environment/light.h"
#include "environment/real_depth.h"
#include "environment/edge_matte.h"
#include "render/finish.h"
#include "render/render.h"
#include "render/soft/draw.h"

typedef struct gl_compositor {
    rlf_compositor_def def;
    gl_view view; /* of the picture */
    rlf_compositor *soft;
    real_depth real;
    room_light lamp;
    light_direction direction;
    edge_matte edges; /* RLF_OCCLUSION_SOFT only */
    caster *casters;  /* as the snapshot's bodies */
    int32_t caster_capacity;
    gl_shade shade;        /* of what real things take */
    gl_obscurance near_by; /* of the light around */
    gl_probes probes;
    finish finish;         /* of the picture that is read back */
    rlf_image_rgba8 image; /* read back */
    rlf_plane_u8 matte;

    gl_context context;
    gl_target target;
    gl_backdrop backdrop;
    gl_bodies bodies;
    gl_layers layers;
    gl_thesis thesis;
    gl_wireframe wireframe;
    gl_texture color_texture, depth_texture;
    gl_texture near_texture, far_texture, cover_texture;
    bool has_wireframe; /* made when the view is first asked for */
} gl_compositor;

/* ---- create and destroy --------------------------------------------------------------------- */

static void destroy_gl(gl_compositor *c)
{
    if (c->has_wireframe) {
        gl_wireframe_destroy(&c->wireframe);
    }
    gl_texture_destroy(&c->color_texture);
    gl_texture_destroy(&c->depth_texture);
    gl_texture_destroy(&c->near_texture);
    gl_texture_destroy(&c->far_texture);
    gl_texture_destroy(&c->cover_texture);
    gl_shade_destroy(&c->shade);
    gl_probes_destroy(&c->probes);
    gl_thesis_destroy(&c->thesis);
    gl_layers_destroy(&c->layers);
    gl_bodies_destroy(&c->bodies);
    gl_backdrop_destroy(&c->backdrop);
    gl_target_destroy(&c->target);
}

static void free_planes(gl_compositor *c)
{
    real_depth_destroy(&c->real);
    light_direction_destroy(&c->direction);
    edge_matte_destroy(&c->edges);
    finish_destroy(&c->finish);
    rlf_compositor_destroy(&c->soft);
    gl_obscurance_destroy(&c->near_by);
    rlf_free(c->casters);
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
    rlf_camera picture = render_camera(&c->def);
    rlf_pose T_picture_camera = render_pose(&c->def);
    int32_t w = picture.width;
    int32_t h = picture.height;
    size_t count = (size_t)w * (size_t)h;
    c->view = gl_view_make(&picture, &T_picture_camera);
    c->image = (rlf_image_rgba8){rlf_alloc_array(count, 4), w, h, 4 * (ptrdiff_t)w};
    c->matte = (rlf_plane_u8){rlf_alloc_array(count, 1), w, h, w};
    if (c->image.data == NULL || c->matte.data == NULL) {
        return RLF_ERROR_MEMORY;
    }
    if (finish_create(w, h, &c->finish) != RLF_OK) {
        return RLF_ERROR_MEMORY;
    }
    if (c->def.occlusion == RLF_OCCLUSION_SOFT) {
        rlf_result result = edge_matte_create(&picture, &c->def.rig.depth, c->def.pool, &c->edges);
        if (result != RLF_OK) {
            return result;
        }
        c->edges.fills_all = true;
    }
    rlf_result result = light_direction_create(
        c->def.light_direction, c->def.estimates_light_direction, &c->def.grid, &c->direction);
    const real_depth_def real = render_depth_def(&c->def);
    return result == RLF_OK ? real_depth_create(&real, &c->real) : result;
}

static rlf_result fail_lost(void)
{
    return rlf_fail(RLF_ERROR_DEVICE, "OpenGL: the driver lost the context: use --renderer soft");
}

static rlf_result check_errors(const gl_context *context)
{
    GLenum error = glGetError();
    if (error == GL_CONTEXT_LOST || gl_context_is_lost(context)) {
        return fail_lost();
    }
    if (error == GL_NO_ERROR) {
        return RLF_OK;
    }
    return rlf_fail(RLF_ERROR_DEVICE,
                    "OpenGL: drawing failed with error 0x%x%s: use --renderer soft",
                    (unsigned)error, error == GL_OUT_OF_MEMORY ? " (out of memory)" : "");
}

/* With the context current. */
static rlf_result create_gl(gl_compositor *c)
{
    int32_t w = c->image.width;
    int32_t h = c->image.height;
    bool is_es = c->context.is_es;
    rlf_result result = gl_target_create(w, h, &c->target);
    if (result == RLF_OK) {
        result = gl_backdrop_create(is_es, w, h, &c->backdrop);
    }
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
    c->near_texture = gl_texture_create(GL_NEAREST);
    c->far_texture = gl_texture_create(GL_NEAREST);
    c->cover_texture = gl_texture_create(GL_NEAREST);
    c->shade = gl_shade_create();
    result = gl_probes_create(&c->probes);
    return result == RLF_OK ? check_errors(&c->context) : result;
}

static rlf_result render(void *self, const rlf_render_input *input, rlf_render_output *out);

static const rlf_compositor_methods methods = {render, destroy, "gl"};

/* Everything that needs no GL; the soft renderer inside checks the def. */
static rlf_result prepare(const rlf_compositor_def *def, gl_compositor **out)
{
    rlf_compositor *inner = NULL;
    rlf_result result = rlf_compositor_create_soft(def, &inner);
    if (result != RLF_OK) {
        return result;
    }
    gl_compositor *c = rlf_alloc(sizeof(*c));
    if (c == NULL) {
        rlf_compositor_destroy(&inner);
        return RLF_ERROR_MEMORY;
    }
    c->def = *def;
    c->soft = inner;
    result = create_planes(c);
    if (result != RLF_OK) {
        free_planes(c);
        rlf_free(c);
        return result;
    }
    *out = c;
    return RLF_OK;
}

/* Finishes a prepared compositor with the context it was given; destroys it on failure. */
static rlf_result complete(gl_compositor *c, rlf_compositor **out)
{
    gl_context_saved saved;
    rlf_result result;
    if (gl_context_enter(&c->context, &saved)) {
        result = create_gl(c);
        gl_context_leave(&c->context, &saved);
    } else {
        result = rlf_fail(RLF_ERROR_DEVICE, "OpenGL: the context cannot be made current: use "
                                            "--renderer soft");
    }
    if (result == RLF_OK) {
        result = rlf_compositor_create_custom(&methods, c, out);
    }
    if (result != RLF_OK) {
        destroy(c);
    }
    return result;
}

static rlf_result create(const rlf_compositor_def *def, bool use_current_context, gl_api api,
                         rlf_compositor **out)
{
    gl_context context;
    *out = NULL;
    rlf_result result =
        use_current_context ? gl_context_adopt(&context) : gl_context_open(api, &context);
    if (result != RLF_OK) {
        return result;
    }
    gl_compositor *c;
    result = prepare(def, &c);
    if (result != RLF_OK) {
        gl_context_close(&context);
        return result;
    }
    c->context = context;
    return complete(c, out);
}

rlf_result gl_compositor_create_offscreen(const rlf_compositor_def *def, gl_api api,
                                          rlf_compositor **out)
{
    return create(def, false, api, out);
}

rlf_result rlf_gl_compositor_create(const rlf_compositor_def *def, bool use_current_context,
                                    rlf_compositor **out)
{
    if (!RLF_ASSERT(def != NULL && out != NULL) || !RLF_ASSERT(def->cookie == RLF_DEF_COOKIE)) {
        return RLF_ERROR_INVALID;
    }
    return create(def, use_current_context, CONTEXT_API_ANY, out);
}

/* ---- draw ----------------------------------------------------------------------------------- */

static bool has_bodies(const rlf_render_input *input)
{
    return (input->view == RLF_VIEW_CAMERA || input->view == RLF_VIEW_BODIES) &&
           input->snapshot != NULL && input->snapshot->body_count > 0;
}

static bool has_edges(const gl_compositor *c, const rlf_render_input *input)
{
    return has_bodies(input) && c->def.occlusion == RLF_OCCLUSION_SOFT;
}

/* Unit, picture camera frame. */
static rlf_vec3 to_light_of(const gl_compositor *c)
{
    return rlf_neg(rlf_rotate(c->view.T_picture_camera.q, c->direction.now));
}

static rlf_result update_real_depth(gl_compositor *c, const rlf_render_input *input)
{
    edge_matte *s = has_edges(c, input) ? &c->edges : NULL;
    if (s != NULL) {
        const render_casters casters = {c->casters, input->snapshot->body_count, to_light_of(c)};
        render_place_bodies(s, &c->view.camera, &c->view.T_picture_world, input->snapshot,
                            &casters);
    }
    const real_windows all = {{{0, 0, c->real.z.width, c->real.z.height}}, 1};
    const observation now = render_observation(input);
    real_depth_read(&c->real, &now);
    rlf_result result = real_depth_update(&c->real, &now, s, &all);
    gl_texture_upload_f32(&c->depth_texture, c->real.z.data, c->real.z.width, c->real.z.height);
    return result;
}

/* What the real world is like where the bodies are, as the soft renderer works it out. */
static void update_edges(gl_compositor *c, const rlf_render_input *input)
{
    edge_matte *s = &c->edges;
    int32_t width = s->cover.width;
    int32_t height = s->cover.height;
    if (c->real.has_moved) {
        edge_matte_forget(s);
    }
    edge_matte_update(s, &c->real.z, real_depth_known(&c->real), input->frame);
    gl_texture_upload_f32(&c->near_texture, s->near_z.data, width, height);
    gl_texture_upload_f32(&c->far_texture, s->far_z.data, width, height);
    gl_texture_upload_u8(&c->cover_texture, s->cover.data, width, height);
}

static rlf_result place_casters(gl_compositor *c, const rlf_snapshot *snapshot)
{
    if (snapshot->body_count > c->caster_capacity) {
        rlf_free(c->casters);
        c->caster_capacity = 2 * snapshot->body_count;
        c->casters = rlf_alloc_array((size_t)c->caster_capacity, sizeof(*c->casters));
        if (c->casters == NULL) {
            c->caster_capacity = 0;
            return RLF_ERROR_MEMORY;
        }
    }
    for (int32_t i = 0; i < snapshot->body_count; i++) {
        (void)caster_make(&snapshot->bodies[i], &c->view.T_picture_world, to_light_of(c),
                          &c->casters[i]);
    }
    return RLF_OK;
}

static bool has_shadows(const gl_compositor *c)
{
    /* The thesis has none, and plain augmented reality does not know the real world. */
    return c->def.occlusion == RLF_OCCLUSION_DEPTH || c->def.occlusion == RLF_OCCLUSION_SOFT;
}

static bool has_real_shade(const gl_compositor *c)
{
    return c->def.enable_real_shade && has_shadows(c);
}

static rlf_result update_shade(gl_compositor *c, const rlf_render_input *input, rlf_vec3 to_light)
{
    const rlf_camera *k = &c->view.camera;
    const real_shade_world world = {.surface = input->surface,
                                    .T_depth_picture = rlf_pose_invert(&c->view.T_picture_camera),
                                    .to_light = to_light,
                                    .focal_px = 0.5 * (k->fx + k->fy)};
    return gl_shade_update(&c->shade, &world, c->casters, input->snapshot->body_count);
}

static bool has_real_ambient(const gl_compositor *c)
{
    return c->def.enable_real_ambient && has_shadows(c);
}

static gl_soft_real soft_real(const gl_compositor *c)
{
    return (gl_soft_real){&c->near_texture, &c->far_texture, &c->cover_texture, &c->def.rig.noise};
}

/* The colour image, or depth in grey when the frame has none, and the bodies' shadows. */
static rlf_result draw_backdrop(gl_compositor *c, const rlf_render_input *input)
{
    rlf_result result = RLF_OK;
    const rlf_rig *rig = &c->def.rig;
    const bool has_color = input->frame->color.data != NULL;
    const bool is_grey = !has_color && input->view != RLF_VIEW_BODIES;
    const bool is_shadowed = has_bodies(input) && has_shadows(c);
    if (is_shadowed) {
        result = place_casters(c, input->snapshot);
    }
    if (result == RLF_OK && (is_grey || has_bodies(input))) {
        result = update_real_depth(c, input);
    }
    if (result != RLF_OK) {
        return result;
    }
    if (input->view == RLF_VIEW_BODIES) {
        gl_backdrop_clear(&c->backdrop);
    } else if (has_color) {
        gl_texture_upload_rgba8(&c->color_texture, &input->frame->color);
        gl_backdrop_draw_color(&c->backdrop, &c->color_texture);
    } else {
        bool has_range = rig->depth_max_m > rig->depth_min_m;
        gl_backdrop_draw_grey(&c->backdrop, &c->depth_texture, has_range ? rig->depth_min_m : 0.5,
                              has_range ? rig->depth_max_m : 4.5);
    }
    if (has_edges(c, input)) {
        update_edges(c, input);
    }
    if (is_shadowed) {
        const gl_soft_real sides = soft_real(c);
        const gl_backdrop_shadows shadows = {
            &c->view,       &c->depth_texture, has_edges(c, input) ? &sides : NULL,
            to_light_of(c), c->casters,        input->snapshot->body_count};
        gl_backdrop_draw_shadows(&c->backdrop, &shadows);
        if (has_real_shade(c)) {
            result = update_shade(c, input, shadows.to_light);
        }
        if (result == RLF_OK && has_real_ambient(c)) {
            const rlf_pose T_depth_picture = rlf_pose_invert(&c->view.T_picture_camera);
            result = gl_obscurance_update(&c->near_by, input->surface, &T_depth_picture, c->casters,
                                          input->snapshot->body_count);
        }
    }
    return result;
}

static bool is_drawable(const rlf_body_state *body)
{
    const rlf_shape *shape = &body->shape;
    return (int)shape->type >= 0 && shape->type <= RLF_SHAPE_HULL &&
           (shape->type != RLF_SHAPE_HULL || shape->hull != NULL);
}

static void draw_bodies(gl_compositor *c, const rlf_snapshot *snapshot)
{
    rlf_occlusion occlusion = c->def.occlusion;
    const gl_soft_real sides = soft_real(c);
    gl_bodies_pass pass = {&c->view,
                           &c->probes,
                           c->direction.now,
                           &c->backdrop.texture,
                           occlusion == RLF_OCCLUSION_DEPTH ? &c->depth_texture : NULL,
                           occlusion == RLF_OCCLUSION_SOFT ? &sides : NULL,
                           has_shadows(c) ? c->casters : NULL,
                           has_real_shade(c) ? &c->shade : NULL,
                           has_real_ambient(c) ? &c->near_by : NULL};
    gl_layer_images images = {&c->backdrop.texture, &c->depth_texture, NULL};
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_CULL_FACE);
    glFrontFace(GL_CW); /* see gl_view_make */
    if (c->def.occlusion == RLF_OCCLUSION_THESIS) {
        gl_thesis_pass thesis = {&c->target, &c->bodies, &c->layers, pass, images};
        for (int32_t i = 0; i < snapshot->body_count; i++) {
            if (is_drawable(&snapshot->bodies[i])) {
                gl_thesis_draw(&c->thesis, &thesis, snapshot, i);
            }
        }
    } else {
        gl_bodies_begin(&c->bodies, &pass);
        for (int32_t i = 0; i < snapshot->body_count; i++) {
            if (is_drawable(&snapshot->bodies[i])) {
                gl_bodies_draw(&c->bodies, &pass, snapshot, i);
            }
        }
        gl_bodies_end();
    }
    glFrontFace(GL_CCW);
    glDisable(GL_CULL_FACE);
    glDisable(GL_DEPTH_TEST);
}

static rlf_result draw_wireframe(gl_compositor *c, const rlf_surface *surface)
{
    if (!c->has_wireframe) {
        rlf_result result = gl_wireframe_create(c->context.is_es, &c->def.rig, &c->def.grid,
                                                surface->scale_factor, &c->wireframe);
        if (result != RLF_OK) {
            return result;
        }
        c->has_wireframe = true;
    }
    gl_wireframe_draw(&c->wireframe, surface, &c->view);
    return RLF_OK;
}

static rlf_result update_probes(gl_compositor *c, const rlf_render_input *input)
{
    const probe_def def = {.rig = &c->def.rig,
                           .lamp = c->lamp.color,
                           .T_picture_depth = c->view.T_picture_camera,
                           .T_picture_world = c->view.T_picture_world,
                           .pool = c->def.pool,
                           .is_on = has_real_ambient(c)};
    return gl_probes_update(&c->probes, &def, input);
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
    glStencilMask(0xff);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
}

/* With the context current. */
static rlf_result draw(gl_compositor *c, const rlf_render_input *input)
{
    rlf_result result = RLF_OK;
    gl_view_place(&c->view, &input->T_world_camera);
    room_light_update(&c->lamp, c->def.light_color, c->def.estimates_light, input->frame);
    light_direction_update(&c->direction, &c->def.rig, input->frame, input->surface);
    reset_state();
    result = draw_backdrop(c, input);
    if (result != RLF_OK) {
        return result;
    }
    gl_target_bind(&c->target);
    glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    gl_layer_images images = {&c->backdrop.texture, NULL, NULL};
    gl_layers_draw_backdrop(&c->layers, &images);
    if (input->view == RLF_VIEW_MESH) {
        result = draw_wireframe(c, input->surface);
    } else if (has_bodies(input)) {
        result = update_probes(c, input);
        if (result == RLF_OK) {
            draw_bodies(c, input->snapshot);
        }
    }
    gl_target_read(&c->target, &c->image);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    return result == RLF_OK ? check_errors(&c->context) : result;
}

/* Alpha of the read-back picture is the matte; the picture itself is opaque, but over nothing. */
static void split_matte(gl_compositor *c, bool is_bare)
{
    size_t count = (size_t)c->image.width * (size_t)c->image.height;
    for (size_t i = 0; i < count; i++) {
        c->matte.data[i] = c->image.data[4 * i + 3];
        c->image.data[4 * i + 3] = is_bare ? c->matte.data[i] : 255;
    }
}

static rlf_result render(void *self, const rlf_render_input *input, rlf_render_output *out)
{
    gl_compositor *c = self;
    const bool is_bare = input->view == RLF_VIEW_BODIES;
    if (input->view != RLF_VIEW_CAMERA && input->view != RLF_VIEW_MESH && !is_bare) {
        return rlf_compositor_render(c->soft, input, out);
    }
    if (input->surface->width != c->def.grid.width ||
        input->surface->height != c->def.grid.height) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "compositor: the surface is %d x %d, made for a grid of %d x %d",
                        (int)input->surface->width, (int)input->surface->height,
                        (int)c->def.grid.width, (int)c->def.grid.height);
    }
    gl_context_saved saved;
    if (!gl_context_enter(&c->context, &saved)) {
        return fail_lost();
    }
    rlf_result result = draw(c, input);
    gl_context_leave(&c->context, &saved);
    if (result != RLF_OK) {
        return result;
    }
    split_matte(c, is_bare);
    finish_look(&c->finish, input->frame);
    if (has_bodies(input) && !is_bare) {
        finish_picture(&c->finish, c->def.pool, &c->image, &c->matte);
    }
    if (c->def.enable_overlay) {
        soft_draw_overlay(&c->image, input);
    }
    out->image = c->image;
    out->matte = c->matte;
    out->light_direction = c->direction.now;
    out->is_light_estimated = c->direction.is_known;
    return RLF_OK;
}
