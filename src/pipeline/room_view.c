/* The map's part of the picture. */
#include "pipeline/room_view.h"

#include <string.h>

#define PATH_STEP_M 0.01 /* at first; less is noise */
#define ROWS 16          /* that one worker fills at a time */
#define LOOKS 2          /* the first finds the surface, the second what the ray meets of it */
#define GRAZING 0.05     /* cosine below which a plane says too little of where a ray meets it */

void room_view_clear(room_view *v)
{
    v->has_surface = false;
    v->path_count = 0;
    v->path_step_m = PATH_STEP_M;
}

void room_view_destroy(room_view *v)
{
    rlf_free(v->depth);
    for (int k = 0; k < 3; k++) {
        rlf_free(v->normal[k]);
    }
    memset(v, 0, sizeof(*v));
}

/* ---- the camera's way ----------------------------------------------------------------------- */

static void pass_by(room_view *v, const rlf_pose *T_world_camera)
{
    if (v->path_count == 0) {
        v->T_world_first = *T_world_camera;
        v->path_step_m = PATH_STEP_M;
    } else {
        const rlf_vec3 way = rlf_sub(T_world_camera->p, v->path[v->path_count - 1]);
        if (!(rlf_dot(way, way) >= v->path_step_m * v->path_step_m)) {
            return;
        }
    }
    if (v->path_count == ROOM_VIEW_PATH) {
        for (int32_t i = 0; i < ROOM_VIEW_PATH / 2; i++) {
            v->path[i] = v->path[2 * i];
        }
        v->path_count = ROOM_VIEW_PATH / 2;
        v->path_step_m *= 2.0;
    }
    v->path[v->path_count++] = T_world_camera->p;
}

/* ---- where the frame has no depth ----------------------------------------------------------- */

typedef struct fill_job {
    room_view *v;
    const rlf_surface *surface;
    const rlf_prediction *room;
    rlf_mat3 R; /* from the camera to the room's, which is near by */
    rlf_vec3 t;
} fill_job;

/* Pixel of the room's camera that a point is seen at; -1 outside. */
static int32_t pixel_of(const rlf_camera *k, rlf_vec3 p)
{
    if (!(p.z > 1e-6)) {
        return -1;
    }
    const double u = k->fx * p.x / p.z + k->cx + 0.5, v = k->fy * p.y / p.z + k->cy + 0.5;
    if (!(u >= 0.0 && v >= 0.0 && u < k->width && v < k->height)) {
        return -1;
    }
    return (int32_t)v * k->width + (int32_t)u;
}

static rlf_vec3 normal_at(const rlf_prediction *room, int32_t i)
{
    return rlf_vec3_make((double)room->normal_x[i], (double)room->normal_y[i],
                         (double)room->normal_z[i]);
}

/* Depth at which t + z way meets the plane that pixel i shows, or as deep as it where the plane
 * grazes the ray. */
static double meet(const fill_job *job, int32_t i, rlf_vec3 way)
{
    const rlf_camera *k = &job->room->camera;
    const double depth = (double)job->room->depth[i];
    const rlf_vec3 ray = {(i % k->width - k->cx) / k->fx, (i / k->width - k->cy) / k->fy, 1.0};
    const rlf_vec3 n = normal_at(job->room, i);
    const double slope = rlf_dot(n, way);
    if (slope < -GRAZING * rlf_length(way)) {
        return rlf_dot(n, rlf_sub(rlf_scale(ray, depth), job->t)) / slope;
    }
    return way.z > 1e-6 ? (depth - job->t.z) / way.z : 0.0;
}

/* What the room is along the ray of a pixel. */
static void fill_pixel(const fill_job *job, int32_t i)
{
    const rlf_surface *s = job->surface;
    const rlf_vec3 way =
        rlf_mat3_mul_vec(&job->R, rlf_vec3_make((double)s->ray_x[i], (double)s->ray_y[i], 1.0));
    rlf_vec3 p = way; /* as if it were endlessly far */
    double z = 0.0;
    int32_t at = -1;
    for (int k = 0; k < LOOKS; k++) {
        at = pixel_of(&job->room->camera, p);
        if (at < 0 || !(job->room->depth[at] > 0.0f)) {
            return;
        }
        z = meet(job, at, way);
        p = rlf_mad(job->t, way, z);
    }
    if (!(z > 0.0)) {
        return;
    }
    const rlf_mat3 back = rlf_mat3_transpose(&job->R);
    const rlf_vec3 n = rlf_mat3_mul_vec(&back, normal_at(job->room, at));
    job->v->depth[i] = (float)z;
    job->v->normal[0][i] = (float)n.x;
    job->v->normal[1][i] = (float)n.y;
    job->v->normal[2][i] = (float)n.z;
}

/* Copies a plane's pixels; a plane that is not there is 0. */
static void copy(const float *from, size_t first, size_t count, float *to)
{
    if (from != NULL) {
        memcpy(to + first, from + first, count * sizeof(*to));
    } else {
        memset(to + first, 0, count * sizeof(*to));
    }
}

static void fill_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const fill_job *job = context;
    const rlf_surface *s = job->surface;
    const size_t first = (size_t)begin * (size_t)s->width;
    const size_t count = (size_t)(end - begin) * (size_t)s->width;
    (void)worker;
    copy(s->background_depth, first, count, job->v->depth);
    copy(s->background_normal_x, first, count, job->v->normal[0]);
    copy(s->background_normal_y, first, count, job->v->normal[1]);
    copy(s->background_normal_z, first, count, job->v->normal[2]);
    for (int32_t i = begin * s->width; i < end * s->width; i++) {
        const bool is_in_lens = s->ray_x[i] != 0.0f || s->ray_y[i] != 0.0f;
        if (!(s->depth[i] > 0.0f) && !(job->v->depth[i] > 0.0f) && is_in_lens) {
            fill_pixel(job, i);
        }
    }
}

static rlf_result reserve(room_view *v, const rlf_surface *surface)
{
    const size_t count = (size_t)surface->width * (size_t)surface->height;
    if (v->depth != NULL) {
        return RLF_OK;
    }
    v->depth = rlf_alloc_array(count, sizeof(float));
    bool has_all = v->depth != NULL;
    for (int k = 0; k < 3; k++) {
        rlf_free(v->normal[k]);
        v->normal[k] = rlf_alloc_array(count, sizeof(float));
        has_all = has_all && v->normal[k] != NULL;
    }
    if (!has_all) {
        rlf_free(v->depth);
        v->depth = NULL;
    }
    return has_all ? RLF_OK : RLF_ERROR_MEMORY;
}

rlf_result room_view_see(room_view *v, const rlf_surface *surface, const rlf_pose *T_world_camera,
                         const rlf_prediction *room, rlf_pool *pool)
{
    v->has_surface = false;
    pass_by(v, T_world_camera);
    if (room == NULL) {
        return RLF_OK;
    }
    rlf_result result = reserve(v, surface);
    if (result != RLF_OK) {
        return result;
    }
    const rlf_pose T_room_world = rlf_pose_invert(&room->T_world_camera);
    const rlf_pose T_room_camera = rlf_pose_mul(&T_room_world, T_world_camera);
    fill_job job = {v, surface, room, rlf_quat_to_mat3(T_room_camera.q), T_room_camera.p};
    rlf_parallel_for(pool, surface->height, ROWS, fill_rows, &job);
    v->surface = *surface;
    v->surface.background_depth = v->depth;
    v->surface.background_normal_x = v->normal[0];
    v->surface.background_normal_y = v->normal[1];
    v->surface.background_normal_z = v->normal[2];
    v->surface.background_version = 0; /* these planes change by themselves */
    v->has_surface = true;
    return RLF_OK;
}

const rlf_surface *room_view_surface(const room_view *v, const rlf_surface *surface)
{
    return v->has_surface ? &v->surface : surface;
}

/* ---- the whole room ------------------------------------------------------------------------- */

const rlf_room_sight *room_view_look(room_view *v, rlf_map *map, const rlf_compositor_def *def,
                                     const rlf_orbit *orbit)
{
    const rlf_map_status status =
        map != NULL ? rlf_map_get_status(map) : (rlf_map_status){.block_count = 0};
    if (status.block_count == 0) {
        return NULL;
    }
    const rlf_pose base = v->path_count > 0 ? v->T_world_first : rlf_pose_identity();
    rlf_camera camera;
    rlf_pose T_world_view;
    rlf_room_look(def, &status.box, &base, orbit, &camera, &T_world_view);
    if (rlf_map_predict(map, &camera, &T_world_view, &v->prediction) != RLF_OK) {
        return NULL;
    }
    v->sight = (rlf_room_sight){&v->prediction, rlf_map_predict_color(map), v->path, v->path_count};
    return &v->sight;
}
