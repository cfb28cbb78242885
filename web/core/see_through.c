/* A see-through device's depth: WebXR's buffers become frames of a camera in the world, and the
 * room that they are pushed into. */
#include "page.h"
#include "see_view.h"

#include <math.h>
#include <string.h>

enum { FORMAT_UINT16 = 0, FORMAT_FLOAT32 = 1 };

static struct {
    see_numbers numbers;
    void *raw;
    size_t raw_bytes;
    float *depth; /* metres; NULL = not open */
    rlf_map *map; /* what was seen so far */
    rlf_rig rig;
    rlf_pose T_world_camera; /* of the last frame, with */
    int64_t time_ns;         /* its time, in the room's, */
    double page_ms;          /* and in the page's */
    uint64_t pushed;
    uint64_t hash;   /* of the last frame's buffer, */
    double head[16]; /* and from where it was looked at */
} see;

#define AWAY_S 0.25        /* without a frame: what moved meanwhile nobody saw, so bodies waited */
#define AFTER_AWAY_S 0.033 /* passes for them then: a frame of a usual sensor */
#define CHANGE_PIXELS 0.25 /* of intrinsics: less than that is rounding, not another camera */
#define MAP_VOXEL_M 0.016  /* under a pixel that is taken, at 2 m */
#define MAP_MEMORY_MB 96   /* 200 m2 of surface */
#define ABSORB_S 5.0 /* a phone's first depth is poor: what stands before it is the room soon */
#define MAP_BLOCKS_FRAME 64 /* what is new in a view is in the map within two seconds */

/* ---- the page writes here ---------------------------------------------------------------------
 */

double *EXPORT(relief_see_numbers)(void)
{
    return (double *)&see.numbers;
}

/* Where the page copies a buffer of so many bytes; 0 = out of memory, or more than any device has.
 */
void *EXPORT(relief_see_raw)(uint32_t bytes)
{
    const size_t most = (size_t)RLF_IMAGE_SIZE_MAX * 1024 * sizeof(float);
    if (bytes == 0 || bytes > most) {
        (void)rlf_fail(RLF_ERROR_INVALID, "depth buffer: %u bytes", (unsigned)bytes);
        return NULL;
    }
    if (bytes > see.raw_bytes) {
        rlf_free(see.raw);
        see.raw = rlf_alloc(bytes);
        see.raw_bytes = see.raw != NULL ? bytes : 0;
    }
    return see.raw;
}

/* ---- depth -------------------------------------------------------------------------------------
 */

/* Metres of a raw value that is linear in them, or in an OpenGL depth. 0 stays missing. */
static float metres_of(float raw, const see_numbers *n)
{
    const float value = raw * (float)n->raw_to_m;
    if (n->near_m == 0.0 || !(value > 0.0f)) {
        return value;
    }
    const float near = (float)n->near_m;
    const float ratio = n->far_m < 1e30 ? (float)(n->near_m / n->far_m) : 0.0f;
    return value < 1.0f ? near / (1.0f - value * (1.0f - ratio)) : 0.0f;
}

static void read_row(float *out, const void *raw, int32_t format, int32_t count)
{
    const see_numbers *n = &see.numbers;
    const int32_t every = (int32_t)n->every;
    if (format == FORMAT_UINT16) {
        const uint16_t *values = raw;
        for (int32_t i = 0; i < count; i++) {
            out[i] = metres_of((float)values[(ptrdiff_t)i * every], n);
        }
    } else {
        const float *values = raw;
        for (int32_t i = 0; i < count; i++) {
            out[i] = metres_of(values[(ptrdiff_t)i * every], n);
        }
    }
}

static void read_depth(const see_view *view, int32_t format)
{
    const int32_t width = view->camera.width, every = (int32_t)see.numbers.every;
    const size_t row = (size_t)view->whole.width * (format == FORMAT_UINT16 ? 2 : 4);
    for (int32_t y = 0; y < view->camera.height; y++) {
        const int32_t from = view->is_mirrored ? view->whole.height - 1 - y * every : y * every;
        read_row(see.depth + (size_t)y * (size_t)width, (const char *)see.raw + (size_t)from * row,
                 format, width);
    }
}

static rlf_result check_buffer(int32_t format, int32_t width, int32_t height, uint32_t bytes)
{
    if (format != FORMAT_UINT16 && format != FORMAT_FLOAT32) {
        return rlf_fail(RLF_ERROR_INVALID, "depth format %d: use 0 or 1", (int)format);
    }
    if (width < 1 || height < 1 || width > RLF_IMAGE_SIZE_MAX || height > RLF_IMAGE_SIZE_MAX) {
        return rlf_fail(RLF_ERROR_INVALID, "depth buffer of %d x %d pixels", (int)width,
                        (int)height);
    }
    const uint64_t wanted = (uint64_t)width * (uint64_t)height * (format == FORMAT_UINT16 ? 2 : 4);
    if (wanted != bytes || bytes > see.raw_bytes) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "depth buffer of %d x %d pixels: %u bytes came, not %llu", (int)width,
                        (int)height, (unsigned)bytes, (unsigned long long)wanted);
    }
    return RLF_OK;
}

static rlf_result look(int32_t format, int32_t width, int32_t height, uint32_t bytes, see_view *out)
{
    rlf_result result = check_buffer(format, width, height, bytes);
    if (result == RLF_OK) {
        result = see_numbers_check(&see.numbers);
    }
    return result == RLF_OK ? see_view_make(&see.numbers, width, height, out) : result;
}

/* ---- the room ----------------------------------------------------------------------------------
 */

void page_see_forget(void)
{
    rlf_map_destroy(&see.map);
    rlf_free(see.depth);
    see.depth = NULL;
}

/* Coarser than a room that is to be a mesh, and fused in smaller helpings: a headset has a dozen
 * milliseconds for all of a frame. */
static rlf_result open_map(void)
{
    rlf_map_def def = rlf_map_def_default();
    def.rig = see.rig;
    def.voxel_m = MAP_VOXEL_M;
    def.memory_mb = MAP_MEMORY_MB;
    def.blocks_per_frame = MAP_BLOCKS_FRAME;
    return rlf_map_create(&def, &see.map);
}

static rlf_result open_room(const see_view *view)
{
    rlf_pipeline_def def = rlf_pipeline_def_for_rig(RLF_PROFILE_LIVE, &see.rig, NULL);
    def.enable_render = false;
    def.camera = RLF_CAMERA_MOVING;
    def.poses = RLF_POSES_SOURCE;
    def.map = see.map;
    rlf_reconstruct_def *stage = &def.reconstruct;
    stage->enable_smoothing = stage->enable_wide_planes = stage->enable_edge_normals = false;
    stage->absorb_after_s = ABSORB_S;
    def.T_world_camera = view->T_world_camera;
    def.world.gravity = rlf_vec3_make(0.0, -9.81, 0.0); /* a reference space's y is up */
    return page_open(&def);
}

/* Opens the room by the numbers and the size of a first buffer, which is not read. The world is the
 * pose's reference space: y up. Returns an rlf_result. */
int32_t EXPORT(relief_see_open)(int32_t width, int32_t height)
{
    see_view view;
    relief_close();
    rlf_result result =
        relief_see_raw((uint32_t)width * (uint32_t)height * 4) != NULL
            ? look(FORMAT_FLOAT32, width, height, (uint32_t)width * (uint32_t)height * 4, &view)
            : RLF_ERROR_INVALID;
    if (result != RLF_OK) {
        return result;
    }
    see.rig = rlf_rig_default();
    see.rig.depth = view.camera;
    result = open_map();
    if (result == RLF_OK) {
        result = open_room(&view);
    }
    if (result == RLF_OK) {
        const rlf_camera *grid = &see.rig.depth;
        see.depth = rlf_alloc_array((size_t)grid->width * (size_t)grid->height, sizeof(float));
        result = see.depth != NULL ? RLF_OK : RLF_ERROR_MEMORY;
    }
    see.pushed = 0;
    see.time_ns = 0;
    return result;
}

/* Another lens, or another crop: the room's grid would no longer fit. */
static bool is_another(const rlf_camera *a, const rlf_camera *b)
{
    const double reach = 0.5 * rlf_max(a->width, a->height);
    return a->width != b->width || a->height != b->height ||
           fabs(a->fx / b->fx - 1.0) * reach > CHANGE_PIXELS ||
           fabs(a->fy / b->fy - 1.0) * reach > CHANGE_PIXELS ||
           fabs(a->cx - b->cx) > CHANGE_PIXELS || fabs(a->cy - b->cy) > CHANGE_PIXELS;
}

/* Seconds from the last frame to this one, as bodies live them. */
static double time_passed(double page_ms)
{
    const double s = see.pushed > 0 ? 1e-3 * (page_ms - see.page_ms) : 0.0;
    return s > AWAY_S ? AFTER_AWAY_S : s;
}

/* The same bits again though the head has moved: the device repeats its last buffer, and where it
 * was seen from is not where the head is now. */
static bool is_old(uint32_t bytes)
{
    const uint64_t *words = see.raw;
    uint64_t hash = 14695981039346656037u; /* FNV-1a, by eight bytes */
    for (uint32_t i = 0; i < bytes / sizeof(*words); i++) {
        hash = (hash ^ words[i]) * 1099511628211u;
    }
    const bool has_moved = memcmp(see.head, see.numbers.world_from_head, sizeof(see.head)) != 0;
    const bool is_same = see.pushed > 0 && hash == see.hash;
    if (!(is_same && has_moved)) {
        memcpy(see.head, see.numbers.world_from_head, sizeof(see.head));
    }
    see.hash = hash;
    return is_same && has_moved;
}

/* The buffer in relief_see_raw as the room's next frame. format: 0 = 16 bits, little endian
 * (luminance-alpha and unsigned-short), 1 = float32. Returns an rlf_result; RLF_ERROR_UNSUPPORTED:
 * it is another camera than the room was opened for; RLF_NO_FRAME: the buffer is an old one. What
 * is refused changes nothing. */
int32_t EXPORT(relief_see_push)(int32_t format, int32_t width, int32_t height, uint32_t bytes)
{
    see_view view;
    if (see.depth == NULL) {
        return rlf_fail(RLF_ERROR_INVALID, "no see-through room is open: open one first");
    }
    rlf_result result = look(format, width, height, bytes, &view);
    if (result != RLF_OK) {
        return result;
    }
    if (is_another(&view.camera, &see.rig.depth)) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED,
                        "the depth camera has changed (%d x %d, focal length %.1f): open it again",
                        (int)width, (int)height, view.camera.fx);
    }
    const double passed = time_passed(see.numbers.time_ms);
    if (!(passed >= 0.0)) {
        return rlf_fail(RLF_ERROR_INVALID, "time %g ms: it must not go back", see.numbers.time_ms);
    }
    if (is_old(bytes)) {
        return RLF_NO_FRAME;
    }
    read_depth(&view, format);
    see.time_ns += (int64_t)(passed * 1e9);
    see.page_ms = see.numbers.time_ms;
    see.T_world_camera = view.T_world_camera;
    page_touch_move(passed);
    const rlf_frame frame = {.sequence = see.pushed++,
                             .time_ns = see.time_ns,
                             .rig = &see.rig,
                             .depth_f32 = see.depth,
                             .depth_stride = (ptrdiff_t)sizeof(float) * see.rig.depth.width,
                             .has_pose = true,
                             .T_world_camera = view.T_world_camera};
    return page_push(&frame);
}

/* Pose of the newest frame's camera in the world: place, quaternion (x y z w). */
const float *EXPORT(relief_see_camera)(void)
{
    static float out[7];
    const rlf_pose *T = &see.T_world_camera;
    const double v[7] = {T->p.x, T->p.y, T->p.z, T->q.x, T->q.y, T->q.z, T->q.w};
    for (int i = 0; i < 7; i++) {
        out[i] = (float)v[i];
    }
    return out;
}
