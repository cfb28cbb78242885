/* A pipeline is made, with all of its stages and the scene, and goes. */
#include "base/checks.h"
#include "camera/checks.h"
#include "pipeline/state.h"

#include <string.h>

#define THROWS_MAX 256 /* bodies that there is room for beside a scene's */

/* ---- frames that are pushed ---- */

/* A camera that calls its program back has no `next` to ask: its frames are pushed. They go through
 * a source of one frame, so that they are checked as any source's. */

static rlf_result next_pushed(void *self, rlf_frame *out_frame)
{
    pushed_frame *slot = self;
    if (!slot->is_full) {
        return RLF_NO_FRAME;
    }
    slot->is_full = false;
    *out_frame = slot->frame;
    return RLF_OK;
}

static rlf_result restart_pushed(void *self)
{
    ((pushed_frame *)self)->is_full = false;
    return RLF_OK;
}

rlf_result pushed_frame_open(pushed_frame *slot, const rlf_rig *rig)
{
    const rlf_source_methods methods = {.next = next_pushed, .restart = restart_pushed};
    const rlf_source_info info = {.name = "pushed frame", .rig = *rig, .frame_count = -1};
    slot->is_full = false;
    return rlf_source_create_custom(&methods, &info, slot, &slot->source);
}

void pushed_frame_put(pushed_frame *slot, const rlf_frame *frame)
{
    slot->is_full = frame != NULL;
    slot->frame = frame != NULL ? *frame : (rlf_frame){0};
}

void pushed_frame_close(pushed_frame *slot)
{
    rlf_source_destroy(&slot->source);
}

/* ---- the pipeline ---- */

/* A rig that is NULL leaves the settings of the stages zero: such a def is refused. */
static rlf_pipeline_def def_of(rlf_profile profile, const rlf_rig *rig, rlf_pool *pool)
{
    rlf_pipeline_def def;
    memset(&def, 0, sizeof(def));
    def.cookie = RLF_DEF_COOKIE;
    def.profile = profile;
    def.enable_render = true;
    def.T_world_camera = rlf_pose_identity();
    def.pool = pool;
    if (rig == NULL) {
        return def;
    }
    bool is_thesis = profile == RLF_PROFILE_THESIS;
    def.reconstruct = rlf_reconstruct_def_default(profile, rig);
    def.reconstruct.pool = pool;
    def.world = rlf_world_def_default();
    def.world.method = is_thesis ? RLF_PHYSICS_THESIS : RLF_PHYSICS_LIVE;
    def.world.pool = pool;
    def.compositor = rlf_compositor_def_default();
    def.compositor.rig = *rig;
    def.compositor.occlusion = is_thesis ? RLF_OCCLUSION_THESIS : RLF_OCCLUSION_SOFT;
    def.compositor.pool = pool;
    return def;
}

rlf_pipeline_def rlf_pipeline_def_default(rlf_profile profile, rlf_source *source, rlf_pool *pool)
{
    const bool is_there = RLF_ASSERT(source != NULL);
    rlf_pipeline_def def =
        def_of(profile, is_there ? &rlf_source_get_info(source)->rig : NULL, pool);
    def.source = source;
    return def;
}

rlf_pipeline_def rlf_pipeline_def_joining(rlf_pipeline *first, rlf_source *source,
                                          const rlf_pose *T_world_camera)
{
    if (!RLF_ASSERT(first != NULL && T_world_camera != NULL)) {
        return def_of(RLF_PROFILE_LIVE, NULL, NULL);
    }
    rlf_pipeline_def def = rlf_pipeline_def_default(first->def.profile, source, first->def.pool);
    const rlf_reconstruct_def own = def.reconstruct;
    def.reconstruct = first->def.reconstruct;
    def.reconstruct.rig = own.rig;
    def.reconstruct.depth_min_m = own.depth_min_m;
    def.reconstruct.depth_max_m = own.depth_max_m;
    def.compositor = first->def.compositor;
    def.compositor.rig = own.rig;
    def.compositor.light_direction = rlf_compositor_def_default().light_direction;
    def.joins = first;
    def.T_world_camera = *T_world_camera;
    def.enable_render = false;
    return def;
}

rlf_pipeline_def rlf_pipeline_def_for_rig(rlf_profile profile, const rlf_rig *rig, rlf_pool *pool)
{
    return def_of(profile, RLF_ASSERT(rig != NULL) ? rig : NULL, pool);
}

static rlf_result copy_scene(rlf_pipeline *p, const rlf_scene *scene)
{
    p->scene.gravity = p->def.world.gravity;
    p->scene.border = p->def.world.border;
    if (scene == NULL) {
        return RLF_OK;
    }
    p->scene.gravity = scene->gravity;
    p->scene.finds_gravity = scene->finds_gravity;
    p->scene.border = scene->border;
    memcpy(p->scene.on, scene->on, sizeof(p->scene.on));
    p->scene.body_count = scene->body_count;
    p->scene.bodies = rlf_alloc_array((size_t)scene->body_count, sizeof(*scene->bodies));
    if (p->scene.bodies == NULL) {
        return RLF_ERROR_MEMORY;
    }
    if (scene->body_count > 0) {
        memcpy(p->scene.bodies, scene->bodies, (size_t)scene->body_count * sizeof(*scene->bodies));
    }
    return RLF_OK;
}

rlf_result pipeline_add_bodies(rlf_pipeline *p)
{
    for (int32_t i = 0; i < p->scene.body_count; i++) {
        rlf_body_id id;
        rlf_result result = rlf_world_add_body(p->world, &p->scene.bodies[i], &id);
        if (result != RLF_OK) {
            return result;
        }
    }
    return known_models_start(&p->known, p->world);
}

/* Rays of the decimated grid for the compositor; the surface's own are not known before the first
 * frame. */
static rlf_result make_rays(rlf_pipeline *p, const rlf_camera *depth)
{
    rlf_camera grid = rlf_camera_decimate(depth, p->def.reconstruct.scale_factor);
    size_t count = (size_t)grid.width * (size_t)grid.height;
    p->ray_x = rlf_alloc_array(count, sizeof(float));
    p->ray_y = rlf_alloc_array(count, sizeof(float));
    if (p->ray_x == NULL || p->ray_y == NULL) {
        return RLF_ERROR_MEMORY;
    }
    for (int32_t i = 0; i < (int32_t)count; i++) {
        rlf_vec3 ray;
        if (rlf_camera_unproject(&grid, i % grid.width, i / grid.width, &ray)) {
            p->ray_x[i] = (float)ray.x;
            p->ray_y[i] = (float)ray.y;
        }
    }
    p->compositor_def.grid = grid;
    p->compositor_def.ray_x = p->ray_x;
    p->compositor_def.ray_y = p->ray_y;
    return RLF_OK;
}

/* A scene's file cannot ask for a larger world: its bodies do, with as many contacts for each as
 * the default has. */
static void make_room(rlf_world_def *def, const rlf_scene *scene)
{
    const double CONTACTS_EACH = 16, CONTACTS_MAX = 1e7;
    int32_t bodies = scene->body_count + RLF_KNOWN_MAX + THROWS_MAX;
    if (def->body_capacity < bodies) {
        def->body_capacity = bodies;
        def->contact_capacity =
            (int32_t)rlf_min(CONTACTS_MAX, rlf_max(def->contact_capacity, bodies * CONTACTS_EACH));
    }
}

static rlf_result create_world(rlf_pipeline *p)
{
    p->def.world.gravity = p->scene.gravity;
    p->def.world.border = p->scene.border;
    make_room(&p->def.world, &p->scene);
    return rlf_world_create(&p->def.world, &p->world);
}

/* Shares the world of another camera's pipeline. */
static rlf_result join_world(rlf_pipeline *p, rlf_pipeline *to)
{
    int32_t index = 1;
    if (to->joined != NULL || p->def.scene != NULL || p->def.map != NULL ||
        p->def.camera != RLF_CAMERA_FIXED) {
        return rlf_fail(RLF_ERROR_INVALID, "pipeline def: joins: scene, map and a camera that "
                                           "moves are those of the first camera's pipeline");
    }
    while (index < to->def.world.camera_capacity && to->others[index] != NULL) {
        index++;
    }
    if (index >= to->def.world.camera_capacity) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "pipeline def: joins: its world has room for %d cameras: raise "
                        "world.camera_capacity",
                        (int)to->def.world.camera_capacity);
    }
    p->world = to->world;
    p->joined = to;
    p->index = index;
    to->others[index] = p;
    return RLF_OK;
}

static void leave_world(rlf_pipeline *p)
{
    if (p->joined != NULL) {
        p->joined->others[p->index] = NULL;
        p->world = NULL;
    }
}

static rlf_result create_stages(rlf_pipeline *p)
{
    rlf_source_expect_range(p->def.source, p->def.reconstruct.depth_min_m,
                            p->def.reconstruct.depth_max_m);
    rlf_result result = rlf_reconstruct_create(&p->def.reconstruct, &p->reconstruct);
    if (result != RLF_OK) {
        return result;
    }
    result = p->def.joins != NULL ? join_world(p, p->def.joins) : create_world(p);
    if (result != RLF_OK) {
        return result;
    }
    p->region_capacity = 2 * p->def.reconstruct.region_capacity + 2; /* two layers */
    p->regions = rlf_alloc_array((size_t)p->region_capacity, sizeof(*p->regions));
    if (p->regions == NULL) {
        return RLF_ERROR_MEMORY;
    }
    p->compositor_def = p->def.compositor;
    result = make_rays(p, &p->def.reconstruct.rig.depth);
    if (result == RLF_OK) {
        const rlf_camera *seen = &p->compositor_def.grid;
        result = far_side_create(seen->width, seen->height, &p->far);
    }
    if (result == RLF_OK &&
        (p->def.enable_hands || p->def.world.enable_grab || hand_scene_binds(&p->scene))) {
        result = rlf_pipeline_set_hands(p, true);
    }
    if (result != RLF_OK || !p->def.enable_render) {
        return result;
    }
    return rlf_compositor_create_soft(&p->compositor_def, &p->compositor);
}

static rlf_result check_def(const rlf_pipeline_def *def)
{
    const struct {
        const char *name;
        int value, count;
    } choices[] = {{"profile", (int)def->profile, RLF_PROFILE_THESIS + 1},
                   {"camera", (int)def->camera, RLF_CAMERA_AUTO + 1},
                   {"poses", (int)def->poses, RLF_POSES_SOURCE + 1}};
    for (int i = 0; i < 3; i++) {
        if (choices[i].value < 0 || choices[i].value >= choices[i].count) {
            return rlf_fail(RLF_ERROR_INVALID, "pipeline def: %s is %d; use 0 to %d",
                            choices[i].name, choices[i].value, choices[i].count - 1);
        }
    }
    return pose_check(&def->T_world_camera, "pipeline def", "T_world_camera");
}

/* Without a source frames are pushed. */
static rlf_result find_source(rlf_pipeline *p)
{
    if (p->def.source != NULL) {
        return RLF_OK;
    }
    rlf_result result = pushed_frame_open(&p->pushed, &p->def.reconstruct.rig);
    p->def.source = p->pushed.source;
    return result;
}

rlf_result rlf_pipeline_create(const rlf_pipeline_def *def, rlf_pipeline **out)
{
    if (!RLF_ASSERT(out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    *out = NULL;
    if (!RLF_ASSERT(def != NULL && def->cookie == RLF_DEF_COOKIE)) {
        return rlf_fail(RLF_ERROR_INVALID, "pipeline def: start from rlf_pipeline_def_default");
    }
    rlf_result result = check_def(def);
    if (result != RLF_OK) {
        return result;
    }
    rlf_pipeline *p = rlf_alloc(sizeof(*p));
    if (p == NULL) {
        return RLF_ERROR_MEMORY;
    }
    p->def = *def;
    result = find_source(p);
    if (result == RLF_OK) {
        result = copy_scene(p, def->scene);
    }
    if (result == RLF_OK) {
        result = known_models_create(def->scene, &p->known);
    }
    if (result == RLF_OK) {
        result = create_stages(p);
    }
    if (result == RLF_OK && p->joined == NULL) {
        result = pipeline_add_bodies(p);
    }
    if (result == RLF_OK) {
        result = camera_start(p);
    }
    if (result != RLF_OK) {
        rlf_pipeline_destroy(&p);
        return result;
    }
    for (int32_t i = 0; i < OVERLAY_LINES_MAX; i++) {
        p->overlay_lines[i] = p->overlay[i];
    }
    p->view_count = 1;
    p->camera.T_world = p->def.T_world_camera;
    *out = p;
    return RLF_OK;
}

void rlf_pipeline_destroy(rlf_pipeline **pipeline)
{
    if (pipeline == NULL || *pipeline == NULL) {
        return;
    }
    rlf_pipeline *p = *pipeline;
    *pipeline = NULL;
    rlf_compositor_destroy(&p->compositor);
    leave_world(p);
    rlf_world_destroy(&p->world);
    known_models_destroy(&p->known);
    rlf_reconstruct_destroy(&p->reconstruct);
    camera_stop(p);
    rlf_free(p->sheet.data);
    far_side_destroy(&p->far);
    hand_stage_destroy(&p->hands);
    rlf_free(p->regions);
    rlf_free(p->ray_x);
    rlf_free(p->ray_y);
    rlf_free(p->scene.bodies);
    pushed_frame_close(&p->pushed);
    rlf_free(p);
}
