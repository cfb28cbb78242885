/* What a page calls: a room or pushed frames through the frame loop, and views of what came out.
 *
 * Everything is one `web_room`, an address to the page. Arrays are addresses in the module's
 * memory: views of them hold until the next step, or until the memory grows. web/relief/relief.js
 * wraps all of this. */
#include "page.h"

#include "relief/playback.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

enum { BODY_FLOATS = 16, NAME_MAX_LENGTH = 512, CONTACT_FLOATS = 8 };

typedef struct web_room {
    rlf_source *source; /* NULL: frames are pushed */
    rlf_playback *playback;
    rlf_pipeline *pipeline;
    rlf_pipeline_output out;
    rlf_rig rig;
    uint16_t *depth; /* of a pushed frame; NULL with a source */
    uint8_t *color;  /* RGBA of a pushed frame; NULL where the rig has none */
    double units_per_metre;
    uint64_t pushed;
    double gap_s;  /* between the last two frames; 0 = not known */
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
    page_hand_forget();
    page_touch_forget();
    rlf_pipeline_destroy(&room.pipeline);
    page_see_forget();
    rlf_source_destroy(&room.source);
    rlf_free(room.depth);
    rlf_free(room.color);
    rlf_free(room.bodies);
    rlf_free(room.contacts);
    memset(&room, 0, sizeof(room));
}

rlf_pipeline *page_pipeline(void)
{
    return room.pipeline;
}

const rlf_pipeline_output *page_output(void)
{
    return &room.out;
}

/* flags: what a room is opened with. */
enum { DRAWS = 1, MATCHES_LIGHT = 2, OPENS_SOON = 4 };

static rlf_result make_pipeline(rlf_pipeline_def *def, int32_t kind, int32_t flags)
{
    rlf_scene scene;
    rlf_result result = page_scene_make((page_scene)kind, &scene);
    def->scene = kind == PAGE_SCENE_NONE ? NULL : &scene;
    def->enable_render = (flags & DRAWS) != 0;
    def->compositor.estimates_light = (flags & MATCHES_LIGHT) != 0;
    def->compositor.estimates_light_direction = (flags & MATCHES_LIGHT) != 0;
    if (result == RLF_OK) {
        result = rlf_pipeline_create(def, &room.pipeline);
    }
    rlf_scene_destroy(&scene);
    return result;
}

static rlf_result open_source(const char *address, int32_t end, bool opens_soon)
{
    rlf_synthetic_def def = rlf_synthetic_def_default();
    rlf_result result = rlf_synthetic_parse(address, &def);
    def.enable_truth = false;
    def.opens_soon = opens_soon;
    if (result == RLF_OK) {
        result = page_room_check(&def);
    }
    if (result == RLF_OK) {
        result = rlf_synthetic_create(&def, &room.source);
    }
    return result == RLF_OK ? rlf_playback_wrap(&room.source, (rlf_playback_end)end, &room.playback)
                            : result;
}

/* Opens the synthetic room whose address is in relief_text, e.g.
 * "synthetic:room?seed=2&color=480x270". scene: a page_scene; end: an rlf_playback_end. Returns an
 * rlf_result. */
int32_t EXPORT(relief_open_synthetic)(int32_t profile, int32_t scene, int32_t flags, int32_t end)
{
    char address[NAME_MAX_LENGTH];
    memcpy(address, room.text, sizeof(address));
    address[sizeof(address) - 1] = '\0';
    relief_close();
    rlf_result result = open_source(address, end, (flags & OPENS_SOON) != 0);
    if (result == RLF_OK) {
        rlf_pipeline_def def = rlf_pipeline_def_default((rlf_profile)profile, room.source, NULL);
        def.camera = RLF_CAMERA_AUTO;
        room.rig = rlf_source_get_info(room.source)->rig;
        result = make_pipeline(&def, scene, flags);
    }
    return result;
}

/* Opens a room for frames that are pushed, of the cameras at relief_rig_in, whose depth has so many
 * units a metre. Returns an rlf_result. */
int32_t EXPORT(relief_open_camera)(double units_per_metre, int32_t profile, int32_t scene,
                                   int32_t flags)
{
    relief_close();
    room.rig = page_rig_read();
    room.units_per_metre = units_per_metre;
    rlf_pipeline_def def = rlf_pipeline_def_for_rig((rlf_profile)profile, &room.rig, NULL);
    def.camera = RLF_CAMERA_AUTO;
    rlf_result result = make_pipeline(&def, scene, flags);
    if (result != RLF_OK) {
        return result;
    }
    const rlf_camera *depth = &room.rig.depth, *color = &room.rig.color;
    room.depth = rlf_alloc_array((size_t)depth->width * (size_t)depth->height, sizeof(uint16_t));
    if (room.rig.has_color) {
        room.color = rlf_alloc_array((size_t)color->width * (size_t)color->height, 4);
    }
    return room.depth != NULL && (room.color != NULL || !room.rig.has_color) ? RLF_OK
                                                                             : RLF_ERROR_MEMORY;
}

/* Where the page writes a frame's depth, row by row, in its units, 0 = missing; 0 = not open for
 * pushed frames. */
uint16_t *EXPORT(relief_depth_in)(void)
{
    return room.depth;
}

/* Where it writes the colour, RGBA; 0 = the cameras have none. */
uint8_t *EXPORT(relief_color_in)(void)
{
    return room.color;
}

/* ---- a frame -----------------------------------------------------------------------------------
 */

#define GAP_S (1.0 / 30.0) /* between frames, before two are known */
#define GAP_MAX_S 0.25     /* a longer one says nothing of the next */

/* What bodies were advanced by is what the next frame will advance them by, as far as one knows. */
static void note_gap(int64_t before_ns)
{
    const double gap_s = 1e-9 * (double)(room.out.frame.time_ns - before_ns);
    if (gap_s > 0.0 && gap_s < GAP_MAX_S) {
        room.gap_s = gap_s;
    }
}

static void pull(void)
{
    page_hand_pull(room.gap_s > 0.0 ? room.gap_s : GAP_S);
}

/* The source's next frame through all stages. Returns an rlf_result; RLF_END at its end. */
int32_t EXPORT(relief_step)(void)
{
    if (room.pipeline == NULL || room.source == NULL) {
        return rlf_fail(RLF_ERROR_INVALID, "no room with a source is open: open one first");
    }
    const int64_t before_ns = room.out.frame.time_ns;
    pull();
    const rlf_result result = rlf_pipeline_step(room.pipeline, &room.out);
    note_gap(before_ns);
    return result;
}

static rlf_frame pushed_frame(int64_t time_ns, bool has_color)
{
    const rlf_rig *rig = &room.rig;
    rlf_frame frame = {.sequence = room.pushed,
                       .time_ns = time_ns,
                       .rig = rig,
                       .depth_u16 = room.depth,
                       .depth_stride = 2 * (ptrdiff_t)rig->depth.width,
                       .depth_units_per_metre = room.units_per_metre};
    if (has_color && room.color != NULL) {
        frame.color = (rlf_image_rgba8){.data = room.color,
                                        .width = rig->color.width,
                                        .height = rig->color.height,
                                        .stride = 4 * (ptrdiff_t)rig->color.width};
    }
    return frame;
}

/* The frame that was written to relief_depth_in, and to relief_color_in if has_color, taken at
 * time_ms. Returns an rlf_result. */
int32_t EXPORT(relief_push)(double time_ms, int32_t has_color)
{
    if (room.pipeline == NULL || room.depth == NULL) {
        return rlf_fail(RLF_ERROR_INVALID, "no room for pushed frames is open: open one first");
    }
    if (!(fabs(time_ms) < 1e12)) {
        return rlf_fail(RLF_ERROR_INVALID, "time %g ms: it must be finite", time_ms);
    }
    const int64_t before_ns = room.out.frame.time_ns;
    const rlf_frame frame = pushed_frame((int64_t)(time_ms * 1e6 + 0.5), has_color != 0);
    pull();
    const rlf_result result = rlf_pipeline_push(room.pipeline, &frame, &room.out);
    note_gap(before_ns);
    room.pushed++;
    return result;
}

/* Draws the last frame again, e.g. in another view while nothing moves. Returns an rlf_result. */
int32_t EXPORT(relief_redraw)(void)
{
    return room.pipeline != NULL && room.out.surface != NULL
               ? rlf_pipeline_redraw(room.pipeline, &room.out)
               : RLF_OK;
}

/* Number of the source's last frame, and how many there are; -1 = not known. */
double EXPORT(relief_index)(void)
{
    return room.playback != NULL ? (double)rlf_playback_get_index(room.playback) : -1.0;
}

double EXPORT(relief_count)(void)
{
    return room.playback != NULL ? (double)rlf_playback_get_count(room.playback) : -1.0;
}

int32_t EXPORT(relief_seek)(double index)
{
    return room.playback != NULL ? rlf_playback_seek(room.playback, (int64_t)index)
                                 : RLF_ERROR_INVALID;
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

/* Where the views "points" and "map" are seen from. */
void EXPORT(relief_set_orbit)(double yaw, double pitch, double zoom)
{
    const rlf_orbit orbit = {yaw, pitch, zoom};
    if (room.pipeline != NULL) {
        rlf_pipeline_set_orbit(room.pipeline, &orbit);
    }
}

/* Whether what a view's colours mean is drawn into the picture. */
void EXPORT(relief_set_legend)(int32_t is_shown)
{
    if (room.pipeline != NULL) {
        rlf_pipeline_set_legend(room.pipeline, is_shown != 0);
    }
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

/* Adds the body at relief_body_in to the world. Returns an rlf_result. */
int32_t EXPORT(relief_add_body)(void)
{
    const rlf_body_def def = page_body_read();
    return world() != NULL ? rlf_world_add_body(world(), &def, NULL)
                           : rlf_fail(RLF_ERROR_INVALID, "no room is open: open one first");
}

/* Removes all bodies, those of the scene, too. */
void EXPORT(relief_remove_all)(void)
{
    if (world() != NULL) {
        rlf_world_reset(world());
    }
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

/* ---- frames that a see-through device gives: see_through.c -----------------------------------
 */

rlf_result page_open(const rlf_pipeline_def *def)
{
    room.rig = def->reconstruct.rig;
    return rlf_pipeline_create(def, &room.pipeline);
}

rlf_result page_push(const rlf_frame *frame)
{
    return room.pipeline != NULL ? rlf_pipeline_push(room.pipeline, frame, &room.out)
                                 : rlf_fail(RLF_ERROR_INVALID, "no room is open: open one first");
}

rlf_world *page_world(void)
{
    return world();
}
