/* What a page calls: a room or pushed frames through the frame loop, and views of what came out.
 *
 * Everything is one `web_room`, an address to the page. Arrays are addresses in the module's
 * memory: views of them hold until the next step, or until the memory grows. web/relief/relief.js
 * wraps all of this. */
#include "relief/pipeline.h"
#include "relief/synthetic.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define EXPORT(name) __attribute__((export_name(#name))) name

enum { BODY_FLOATS = 16, NAME_MAX_LENGTH = 512, CONTACT_FLOATS = 8 };

typedef struct web_room {
    rlf_source *source; /* NULL: frames are pushed */
    rlf_pipeline *pipeline;
    rlf_pipeline_output out;
    rlf_rig rig;
    uint16_t *depth; /* of a pushed frame; NULL with a source */
    uint64_t pushed;
    float *bodies; /* BODY_FLOATS of each */
    float *contacts;
    int32_t body_capacity, contact_capacity;
    char text[NAME_MAX_LENGTH]; /* an address or a name on its way in */
} web_room;

static web_room room; /* a page has one module for each room that it wants */

/* ---- text -------------------------------------------------------------------------------------
 */

/* Where the page writes a text of at most 511 bytes and a zero. */
char *EXPORT(relief_text)(void)
{
    return room.text;
}

const char *EXPORT(relief_error)(void)
{
    return rlf_error_text();
}

const char *EXPORT(relief_version)(void)
{
    return rlf_version();
}

/* ---- a room ------------------------------------------------------------------------------------
 */

void EXPORT(relief_close)(void)
{
    rlf_pipeline_destroy(&room.pipeline);
    rlf_source_destroy(&room.source);
    rlf_free(room.depth);
    rlf_free(room.bodies);
    rlf_free(room.contacts);
    memset(&room, 0, sizeof(room));
}

static rlf_result make_pipeline(rlf_pipeline_def *def, int32_t scene)
{
    rlf_scene cubes = {0};
    rlf_result result = scene == 0 ? RLF_OK : rlf_scene_create_two_cubes(&cubes);
    def->scene = scene == 0 ? NULL : &cubes;
    if (result == RLF_OK) {
        result = rlf_pipeline_create(def, &room.pipeline);
    }
    rlf_scene_destroy(&cubes);
    return result;
}

/* Opens the synthetic room whose address is in relief_text, e.g.
 * "synthetic:room?seed=2&color=480x270". scene: 0 no bodies, 1 the thesis's two cubes. Returns an
 * rlf_result. */
int32_t EXPORT(relief_open_synthetic)(int32_t profile, int32_t scene, int32_t draws)
{
    rlf_synthetic_def def = rlf_synthetic_def_default();
    char address[NAME_MAX_LENGTH];
    memcpy(address, room.text, sizeof(address));
    address[sizeof(address) - 1] = '\0';
    relief_close();
    rlf_result result = rlf_synthetic_parse(address, &def);
    if (result == RLF_OK) {
        result = rlf_synthetic_create(&def, &room.source);
    }
    if (result == RLF_OK) {
        rlf_pipeline_def pipeline =
            rlf_pipeline_def_default((rlf_profile)profile, room.source, NULL);
        pipeline.enable_render = draws != 0;
        pipeline.camera = RLF_CAMERA_AUTO;
        room.rig = rlf_source_get_info(room.source)->rig;
        result = make_pipeline(&pipeline, scene);
    }
    return result;
}

/* Opens a room for frames that are pushed: a pinhole camera of so many pixels. Depth is in
 * millimetres. Returns an rlf_result. */
int32_t EXPORT(relief_open_camera)(int32_t width, int32_t height, double fx, double fy, double cx,
                                   double cy, int32_t profile, int32_t scene, int32_t draws)
{
    relief_close();
    room.rig = rlf_rig_default();
    room.rig.depth =
        (rlf_camera){.width = width, .height = height, .fx = fx, .fy = fy, .cx = cx, .cy = cy};
    rlf_pipeline_def def = rlf_pipeline_def_for_rig((rlf_profile)profile, &room.rig, NULL);
    def.enable_render = draws != 0;
    rlf_result result = make_pipeline(&def, scene);
    if (result != RLF_OK) {
        return result;
    }
    room.depth = rlf_alloc_array((size_t)width * (size_t)height, sizeof(uint16_t));
    return room.depth != NULL ? RLF_OK : RLF_ERROR_MEMORY;
}

/* Where the page writes a frame's depth, row by row, millimetres, 0 = missing; 0 = not open for
 * pushed frames. */
uint16_t *EXPORT(relief_depth_in)(void)
{
    return room.depth;
}

/* ---- a frame -----------------------------------------------------------------------------------
 */

/* The source's next frame through all stages. Returns an rlf_result; RLF_END at its end. */
int32_t EXPORT(relief_step)(void)
{
    if (room.pipeline == NULL || room.source == NULL) {
        return rlf_fail(RLF_ERROR_INVALID, "no room with a source is open: open one first");
    }
    return rlf_pipeline_step(room.pipeline, &room.out);
}

/* The frame that was written to relief_depth_in, taken at time_ms. Returns an rlf_result. */
int32_t EXPORT(relief_push)(double time_ms)
{
    if (room.pipeline == NULL || room.depth == NULL) {
        return rlf_fail(RLF_ERROR_INVALID, "no room for pushed frames is open: open one first");
    }
    if (!(fabs(time_ms) < 1e12)) {
        return rlf_fail(RLF_ERROR_INVALID, "time %g ms: it must be finite", time_ms);
    }
    const rlf_frame frame = {.sequence = room.pushed++,
                             .time_ns = (int64_t)(time_ms * 1e6),
                             .rig = &room.rig,
                             .depth_u16 = room.depth,
                             .depth_stride = 2 * (ptrdiff_t)room.rig.depth.width,
                             .depth_units_per_metre = 1000.0};
    return rlf_pipeline_push(room.pipeline, &frame, &room.out);
}

int32_t EXPORT(relief_restart)(void)
{
    return room.pipeline != NULL ? rlf_pipeline_restart(room.pipeline) : RLF_ERROR_INVALID;
}

/* ---- what came out: planes of the surface, and the picture --------------------------------------
 */

int32_t EXPORT(relief_width)(void)
{
    return room.out.surface != NULL ? room.out.surface->width : 0;
}

int32_t EXPORT(relief_height)(void)
{
    return room.out.surface != NULL ? room.out.surface->height : 0;
}

/* Address of a plane of width x height values, 0 = no frame yet or no such plane: see PLANES in
 * relief.js for names and types. */
const void *EXPORT(relief_plane)(int32_t plane)
{
    const rlf_surface *s = room.out.surface;
    if (s == NULL) {
        return NULL;
    }
    const void *const planes[] = {s->depth,      s->normal_x,   s->normal_y,   s->normal_z,
                                  s->velocity_x, s->velocity_y, s->velocity_z, s->thickness,
                                  s->label,      s->foreground, s->reason,     s->background_depth,
                                  s->ray_x,      s->ray_y};
    const int32_t count = (int32_t)(sizeof(planes) / sizeof(planes[0]));
    return plane >= 0 && plane < count ? planes[plane] : NULL;
}

/* The composited picture, RGBA, rows without padding; 0 where none was drawn. */
const uint8_t *EXPORT(relief_picture)(void)
{
    return room.out.render.image.data;
}

int32_t EXPORT(relief_picture_width)(void)
{
    return room.out.render.image.width;
}

int32_t EXPORT(relief_picture_height)(void)
{
    return room.out.render.image.height;
}

/* The view of the next pictures, an rlf_view. Returns 0 for one that is none. */
int32_t EXPORT(relief_set_view)(int32_t view)
{
    if (room.pipeline == NULL || view < 0 || view >= RLF_VIEW_COUNT) {
        return 0;
    }
    rlf_pipeline_set_view(room.pipeline, (rlf_view)view);
    return 1;
}

/* ---- bodies ------------------------------------------------------------------------------------
 */

static rlf_world *world(void)
{
    return room.pipeline != NULL ? rlf_pipeline_get_world(room.pipeline) : NULL;
}

/* Adds a body: a shape (rlf_shape_type) of these sizes in metres (box: edges; sphere: radius in x;
 * others: radius in x, height in y) at p with velocity v, world frame, and a material. Returns an
 * rlf_result. */
int32_t EXPORT(relief_add_body)(int32_t type, double x, double y, double z, double px, double py,
                                double pz, double vx, double vy, double vz, double mass,
                                double friction, double restitution)
{
    if (world() == NULL) {
        return RLF_ERROR_INVALID;
    }
    rlf_body_def def = rlf_body_def_default();
    def.shape.type = (rlf_shape_type)type;
    def.shape.size = rlf_vec3_make(x, y, z);
    def.shape.radius = x;
    def.shape.height = y;
    def.position = rlf_vec3_make(px, py, pz);
    def.velocity = rlf_vec3_make(vx, vy, vz);
    def.mass = mass;
    def.friction = friction;
    def.restitution = restitution;
    return rlf_world_add_body(world(), &def, NULL);
}

int32_t EXPORT(relief_set_gravity)(double x, double y, double z)
{
    return world() != NULL && rlf_world_set_gravity(world(), rlf_vec3_make(x, y, z));
}

/* Hash of all body states: the same as `relief run --hash` prints for the same frames. */
uint64_t EXPORT(relief_hash)(void)
{
    return world() != NULL ? rlf_world_hash(world()) : 0;
}

static float *grow(float **values, int32_t *capacity, int32_t count, int32_t each)
{
    if (count > *capacity) {
        rlf_free(*values);
        *capacity = 2 * count;
        *values = rlf_alloc_array((size_t)*capacity * (size_t)each, sizeof(float));
        *capacity = *values != NULL ? *capacity : 0;
    }
    return *values;
}

static const rlf_snapshot *snapshot(void)
{
    return room.out.snapshot;
}

int32_t EXPORT(relief_body_count)(void)
{
    return snapshot() != NULL ? snapshot()->body_count : 0;
}

/* BODY_FLOATS of each body: position, quaternion (x y z w), velocity, shape type, sizes (as in
 * relief_add_body), whether it sleeps, whether it waits; 0 = none. */
const float *EXPORT(relief_bodies)(void)
{
    const int32_t count = relief_body_count();
    float *out = grow(&room.bodies, &room.body_capacity, count, BODY_FLOATS);
    for (int32_t i = 0; out != NULL && i < count; i++) {
        const rlf_body_state *b = &snapshot()->bodies[i];
        const bool is_box = b->shape.type == RLF_SHAPE_BOX;
        const double v[BODY_FLOATS] = {b->T_world_body.p.x,
                                       b->T_world_body.p.y,
                                       b->T_world_body.p.z,
                                       b->T_world_body.q.x,
                                       b->T_world_body.q.y,
                                       b->T_world_body.q.z,
                                       b->T_world_body.q.w,
                                       b->velocity.x,
                                       b->velocity.y,
                                       b->velocity.z,
                                       b->shape.type,
                                       is_box ? b->shape.size.x : b->shape.radius,
                                       is_box ? b->shape.size.y : b->shape.height,
                                       is_box ? b->shape.size.z : 0.0,
                                       b->is_asleep,
                                       b->is_held};
        for (int k = 0; k < BODY_FLOATS; k++) {
            out[BODY_FLOATS * i + k] = (float)v[k];
        }
    }
    return out;
}

int32_t EXPORT(relief_contact_count)(void)
{
    return snapshot() != NULL ? snapshot()->contact_count : 0;
}

/* CONTACT_FLOATS of each contact of the last frame: point, normal, impulse in N s, what was met (an
 * rlf_contact_other); 0 = none. */
const float *EXPORT(relief_contacts)(void)
{
    const int32_t count = relief_contact_count();
    float *out = grow(&room.contacts, &room.contact_capacity, count, CONTACT_FLOATS);
    for (int32_t i = 0; out != NULL && i < count; i++) {
        const rlf_contact *c = &snapshot()->contacts[i];
        const double v[CONTACT_FLOATS] = {c->point.x,  c->point.y,  c->point.z, c->normal.x,
                                          c->normal.y, c->normal.z, c->impulse, c->other};
        for (int k = 0; k < CONTACT_FLOATS; k++) {
            out[CONTACT_FLOATS * i + k] = (float)v[k];
        }
    }
    return out;
}
