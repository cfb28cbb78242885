/* Clips in memory. */
#include "eval/real/clip.h"

#include "command.h"
#include "eval/real/real.h"

#include <stdio.h>
#include <string.h>

#define FRAME_NS INT64_C(33333333) /* between passes */

void real_clip_free(real_clip *clip)
{
    rlf_free(clip->time_ns);
    rlf_free(clip->depth);
    rlf_free(clip->color);
    rlf_free(clip->has_color);
    memset(clip, 0, sizeof(*clip));
}

static size_t color_bytes(const rlf_rig *rig)
{
    return (size_t)rig->color.width * (size_t)rig->color.height * 4;
}

static rlf_result allocate(real_clip *clip, int32_t count)
{
    size_t n = (size_t)count;
    clip->count = count;
    clip->time_ns = rlf_alloc_array(n, sizeof(*clip->time_ns));
    clip->has_color = rlf_alloc_array(n, 1);
    clip->depth = rlf_alloc_array(n * (size_t)real_clip_pixels(clip), sizeof(*clip->depth));
    if (clip->rig.has_color) {
        clip->color = rlf_alloc_array(n, color_bytes(&clip->rig));
    }
    bool is_ready = clip->time_ns != NULL && clip->has_color != NULL && clip->depth != NULL &&
                    (!clip->rig.has_color || clip->color != NULL);
    return is_ready ? RLF_OK : RLF_ERROR_MEMORY;
}

static void take_frame(real_clip *clip, int32_t index, const rlf_frame *frame)
{
    const rlf_camera *c = &clip->rig.depth;
    clip->time_ns[index] = frame->time_ns;
    clip->units_per_metre = frame->depth_units_per_metre;
    memcpy(real_clip_depth(clip, index), frame->depth_u16,
           (size_t)c->width * (size_t)c->height * sizeof(uint16_t));
    clip->has_color[index] = frame->color.data != NULL;
    if (frame->color.data != NULL) {
        size_t bytes = color_bytes(&clip->rig);
        memcpy(clip->color + (size_t)index * bytes, frame->color.data, bytes);
    }
}

rlf_result real_clip_load(const char *folder, int32_t first, int32_t count, real_clip *out)
{
    memset(out, 0, sizeof(*out));
    rlf_source *source = NULL;
    rlf_result result = rlf_folder_source_open(folder, &source);
    if (result != RLF_OK) {
        return result;
    }
    const rlf_source_info *info = rlf_source_get_info(source);
    int32_t there = (int32_t)info->frame_count - first;
    out->rig = info->rig;
    result = there > 0 ? allocate(out, there < count ? there : count)
                       : rlf_fail(RLF_ERROR_INVALID, "%s: has no frame %d", folder, (int)first);
    for (int32_t i = -first; i < out->count && result == RLF_OK; i++) {
        rlf_frame frame;
        result = rlf_source_next(source, &frame);
        if (result == RLF_OK && i >= 0) {
            take_frame(out, i, &frame);
        }
    }
    rlf_source_destroy(&source);
    if (result != RLF_OK) {
        real_clip_free(out);
    }
    return result;
}

rlf_result real_clip_load_single(const char *folder, real_clip *out)
{
    const rlf_camera camera = {
        .width = 640, .height = 480, .fx = 525, .fy = 525, .cx = 319.5, .cy = 239.5};
    char path[REAL_PATH_SIZE];
    uint16_t *depth = NULL;
    rlf_image_rgba8 color = {0};
    int32_t width, height;
    memset(out, 0, sizeof(*out));
    out->rig = (rlf_rig){.depth = camera,
                         .color = camera,
                         .T_color_depth = rlf_pose_identity(),
                         .has_color = true,
                         .depth_min_m = 0.1,
                         .depth_max_m = 8.0,
                         .noise = {0.0008, 0.0, 0.0012}}; /* as of any folder */
    bool fits = real_join(path, folder, "depth.png");
    rlf_result result = fits ? rlf_png_read_u16(path, &depth, &width, &height) : RLF_ERROR_IO;
    if (result == RLF_OK && real_join(path, folder, "color.png")) {
        result = rlf_picture_read(path, &color);
    }
    bool is_right = result == RLF_OK && width == camera.width && height == camera.height &&
                    color.width == camera.width && color.height == camera.height;
    if (result == RLF_OK && !is_right) {
        result = rlf_fail(RLF_ERROR_FORMAT, "%s: its pictures are not 640 x 480", folder);
    }
    result = result == RLF_OK ? allocate(out, 1) : result;
    if (result == RLF_OK) {
        rlf_frame frame = {.depth_u16 = depth, .depth_units_per_metre = 1000, .color = color};
        take_frame(out, 0, &frame);
    } else {
        real_clip_free(out);
    }
    rlf_free(depth);
    rlf_free(color.data);
    return result;
}

/* ---- turned ---------------------------------------------------------------------------------- */

static rlf_vec3 turn_once(rlf_vec3 v)
{
    return rlf_vec3_make(-v.y, v.x, v.z);
}

rlf_vec3 real_turn_vector(rlf_vec3 v, int32_t quarters, bool is_mirrored)
{
    v.x = is_mirrored ? -v.x : v.x;
    for (int32_t k = 0; k < quarters; k++) {
        v = turn_once(v);
    }
    return v;
}

/* The tangential part of the distortion turns with the picture: p1 and p2. */
static rlf_camera turn_camera_once(const rlf_camera *c)
{
    rlf_camera out = *c;
    out.width = c->height;
    out.height = c->width;
    out.fx = c->fy;
    out.fy = c->fx;
    out.cx = c->height - 1 - c->cy;
    out.cy = c->cx;
    out.distortion[2] = c->distortion[3];
    out.distortion[3] = -c->distortion[2];
    return out;
}

rlf_camera real_turn_camera(const rlf_camera *camera, int32_t quarters, bool is_mirrored)
{
    rlf_camera out = *camera;
    if (is_mirrored) {
        out.cx = out.width - 1 - out.cx;
        out.distortion[3] = -out.distortion[3];
    }
    for (int32_t k = 0; k < quarters; k++) {
        out = turn_camera_once(&out);
    }
    return out;
}

/* A rotation's axis is mirrored the other way round than a point. */
static rlf_pose turn_pose(rlf_pose T, int32_t quarters, bool is_mirrored)
{
    rlf_vec3 axis = rlf_vec3_make(T.q.x, T.q.y, T.q.z);
    axis = real_turn_vector(is_mirrored ? rlf_scale(axis, -1.0) : axis, quarters, is_mirrored);
    T.q.x = axis.x;
    T.q.y = axis.y;
    T.q.z = axis.z;
    T.p = real_turn_vector(T.p, quarters, is_mirrored);
    return T;
}

/* Where pixel (x, y) of a picture comes to lie in the turned one. */
static size_t turned_index(const rlf_camera *c, int32_t x, int32_t y, int32_t quarters,
                           bool is_mirrored)
{
    int32_t width = c->width, height = c->height;
    x = is_mirrored ? width - 1 - x : x;
    for (int32_t k = 0; k < quarters; k++) {
        int32_t old_x = x, old_width = width;
        x = height - 1 - y;
        y = old_x;
        width = height;
        height = old_width;
    }
    return (size_t)y * (size_t)width + (size_t)x;
}

static void turn_picture(const rlf_camera *c, const void *from, void *to, size_t pixel_bytes,
                         int32_t quarters, bool is_mirrored)
{
    for (int32_t y = 0; y < c->height; y++) {
        for (int32_t x = 0; x < c->width; x++) {
            size_t i = (size_t)y * (size_t)c->width + (size_t)x;
            memcpy((char *)to + turned_index(c, x, y, quarters, is_mirrored) * pixel_bytes,
                   (const char *)from + i * pixel_bytes, pixel_bytes);
        }
    }
}

rlf_result real_clip_turn(const real_clip *clip, int32_t quarters, bool is_mirrored, real_clip *out)
{
    memset(out, 0, sizeof(*out));
    out->rig = clip->rig;
    out->rig.depth = real_turn_camera(&clip->rig.depth, quarters, is_mirrored);
    out->rig.color = real_turn_camera(&clip->rig.color, quarters, is_mirrored);
    out->rig.T_color_depth = turn_pose(clip->rig.T_color_depth, quarters, is_mirrored);
    out->units_per_metre = clip->units_per_metre;
    rlf_result result = allocate(out, clip->count);
    size_t bytes = color_bytes(&clip->rig);
    for (int32_t i = 0; i < clip->count && result == RLF_OK; i++) {
        out->time_ns[i] = clip->time_ns[i];
        out->has_color[i] = clip->has_color[i];
        turn_picture(&clip->rig.depth, real_clip_depth(clip, i), real_clip_depth(out, i),
                     sizeof(uint16_t), quarters, is_mirrored);
        if (clip->has_color[i]) {
            turn_picture(&clip->rig.color, clip->color + (size_t)i * bytes,
                         out->color + (size_t)i * bytes, 4, quarters, is_mirrored);
        }
    }
    if (result != RLF_OK) {
        real_clip_free(out);
    }
    return result;
}

/* ---- played ---------------------------------------------------------------------------------- */

typedef struct player {
    const real_clip *clip;
    int32_t next, passes;
} player;

static rlf_result player_next(void *self, rlf_frame *out)
{
    player *p = self;
    const real_clip *clip = p->clip;
    if (p->next >= p->passes * clip->count) {
        return RLF_END;
    }
    int32_t pass = p->next / clip->count, index = p->next % clip->count;
    const int64_t *t = clip->time_ns;
    memset(out, 0, sizeof(*out));
    out->sequence = (uint64_t)p->next++;
    out->time_ns = t[index] + pass * (t[clip->count - 1] - t[0] + FRAME_NS);
    out->depth_u16 = real_clip_depth(clip, index);
    out->depth_stride = (ptrdiff_t)clip->rig.depth.width * (ptrdiff_t)sizeof(uint16_t);
    out->depth_units_per_metre = clip->units_per_metre;
    if (clip->has_color[index]) {
        const rlf_camera *c = &clip->rig.color;
        out->color = (rlf_image_rgba8){clip->color + (size_t)index * color_bytes(&clip->rig),
                                       c->width, c->height, (ptrdiff_t)c->width * 4};
    }
    return RLF_OK;
}

rlf_result real_clip_source(const real_clip *clip, int32_t passes, rlf_source **out)
{
    static const rlf_source_methods methods = {.next = player_next, .destroy = rlf_free};
    player *p = rlf_alloc(sizeof(*p));
    if (p == NULL) {
        return RLF_ERROR_MEMORY;
    }
    *p = (player){.clip = clip, .passes = passes};
    rlf_source_info info = {.rig = clip->rig, .frame_count = (int64_t)passes * clip->count};
    (void)snprintf(info.name, sizeof(info.name), "clip");
    rlf_result result = rlf_source_create_custom(&methods, &info, p, out);
    if (result != RLF_OK) {
        rlf_free(p);
    }
    return result;
}

rlf_result real_clip_surfaces(const real_clip *clip, int32_t passes, real_surface_fn take,
                              void *context)
{
    rlf_source *source = NULL;
    rlf_reconstruct *stage = NULL;
    rlf_result result = real_clip_source(clip, passes, &source);
    if (result == RLF_OK) {
        rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &clip->rig);
        result = rlf_reconstruct_create(&def, &stage);
    }
    for (int32_t i = 0; i < passes * clip->count && result == RLF_OK && !command_interrupted; i++) {
        rlf_frame frame;
        const rlf_surface *surface;
        result = rlf_source_next(source, &frame);
        result = result == RLF_OK ? rlf_reconstruct_process(stage, &frame, &surface) : result;
        result = result == RLF_OK ? take(context, &frame, surface, i) : result;
    }
    rlf_reconstruct_destroy(&stage);
    rlf_source_destroy(&source);
    return result;
}
