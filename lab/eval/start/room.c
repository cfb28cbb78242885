/* The scene of section "start", ray by ray, and its sensors. */
#include "eval/start/room.h"

#include "eval/analytic.h"

#include <string.h>

#define WIDTH 320
#define HEIGHT 240
#define COUNT (WIDTH * HEIGHT)
#define FOCAL 285.0
#define WALL_M 3.8    /* from the camera, level */
#define STEPS_M 348.0 /* steps of a shift at 1 m, of a Kinect v1 */
#define STEP_SIGMA 0.35
#define EDGE_M 0.05 /* between neighbours: an edge */
#define PITCH 4     /* pixels between independent errors */

start_box start_box_at(const start_def *def, double time_s, double *out_speed)
{
    double t = rlf_max(0.0, time_s - def->begin_s), ramp = def->ramp_s;
    double way = t < ramp ? 0.5 * def->speed * t * t / ramp : def->speed * (t - 0.5 * ramp);
    bool is_over = way >= def->far;
    *out_speed = is_over ? 0.0 : t < ramp ? def->speed * t / ramp : def->speed * (t > 0.0);
    start_box box = def->box;
    box.centre = rlf_mad(box.centre, def->way, is_over ? def->far : way);
    return box;
}

rlf_vec3 start_box_local(const start_box *box, rlf_vec3 p)
{
    double c = rlf_cos(box->yaw), s = rlf_sin(box->yaw);
    rlf_vec3 d = rlf_sub(p, box->centre);
    return rlf_vec3_make(c * d.x - s * d.z, d.y, s * d.x + c * d.z);
}

/* Where a ray from the origin meets the box, in lengths of the ray; 0: nowhere. */
static double box_depth(const start_box *box, rlf_vec3 ray)
{
    const rlf_vec3 none = {0, 0, 0};
    rlf_vec3 o = start_box_local(box, none);
    rlf_vec3 d = rlf_sub(start_box_local(box, ray), o);
    const double from[3] = {o.x, o.y, o.z}, way[3] = {d.x, d.y, d.z};
    const double half[3] = {box->half.x, box->half.y, box->half.z};
    double enter = 0.0, leave = 1e9;
    for (int k = 0; k < 3; k++) {
        double w = way[k] < 1e-9 && way[k] > -1e-9 ? 1e-9 : way[k];
        double a = (-half[k] - from[k]) / w, b = (half[k] - from[k]) / w;
        enter = rlf_max(enter, rlf_min(a, b));
        leave = rlf_min(leave, rlf_max(a, b));
    }
    return enter < leave ? enter : 0.0;
}

static double room_depth(const start_def *def, rlf_vec3 ray)
{
    double floor = ray.y > 1e-6 ? def->height / ray.y : 1e9;
    double wall = ray.z > 1e-6 ? WALL_M / ray.z : 1e9;
    double z = rlf_min(floor, wall);
    return z < 1e8 ? z : 0.0;
}

/* The nearest or, at random, any of the pixels about one where they differ by an edge. */
static float at_edge(start_room *room, int32_t x, int32_t y)
{
    int32_t reach = room->def.sensor == START_SMEARED ? 2 : 1;
    float z = room->clean[y * WIDTH + x], near = z;
    for (int32_t v = y - reach; v <= y + reach; v++) {
        for (int32_t u = x - reach; u <= x + reach; u++) {
            bool is_in = u >= 0 && v >= 0 && u < WIDTH && v < HEIGHT;
            near = is_in && room->clean[v * WIDTH + u] < near ? room->clean[v * WIDTH + u] : near;
        }
    }
    if (!(z - near > EDGE_M)) {
        return z;
    }
    double share = eval_random_uniform(&room->random);
    bool is_near = room->def.sensor == START_SMEARED || share < 0.5;
    double mixed = near + (z - near) * eval_random_uniform(&room->random);
    return room->def.sensor == START_TOF ? (float)mixed : is_near ? near : z;
}

/* Standard normal numbers that neighbours share, bilinear between the corners of squares. */
static void smooth_noise(eval_random *random, float *out)
{
    enum { COLUMNS = WIDTH / PITCH + 2, ROWS = HEIGHT / PITCH + 2 };
    static _Thread_local float corner[ROWS][COLUMNS];
    for (int32_t r = 0; r < ROWS; r++) {
        for (int32_t c = 0; c < COLUMNS; c++) {
            corner[r][c] = (float)(1.5 * eval_random_normal(random));
        }
    }
    for (int32_t i = 0; i < COUNT; i++) {
        int32_t c = i % WIDTH / PITCH, r = i / WIDTH / PITCH;
        float u = (float)(i % WIDTH % PITCH) / PITCH, v = (float)(i / WIDTH % PITCH) / PITCH;
        float top = corner[r][c] + (corner[r][c + 1] - corner[r][c]) * u;
        float below = corner[r + 1][c] + (corner[r + 1][c + 1] - corner[r + 1][c]) * u;
        out[i] = top + (below - top) * v;
    }
}

static float measured(start_room *room, int32_t i, double z, double noise)
{
    double sigma = rlf_depth_noise_sigma(&room->info.rig.noise, z);
    if (room->def.sensor == START_STEPS) {
        double shift = STEPS_M / z + STEP_SIGMA * (0.7071 * (noise + room->common[i]));
        int32_t steps = (int32_t)(shift + 0.5);
        return (float)(STEPS_M / (steps < 1 ? 1 : steps));
    }
    return (float)(z + sigma * noise);
}

static void draw(start_room *room)
{
    double speed;
    start_box box = start_box_at(&room->def, (double)room->frame / 30.0, &speed);
    for (int32_t i = 0; i < COUNT; i++) {
        double z = box_depth(&box, room->rays[i]);
        float behind = room->still[i];
        room->clean[i] = z > 0.0 && (!(behind > 0.0f) || z < behind) ? (float)z : behind;
    }
    bool is_white = room->def.sensor == START_TOF;
    if (!is_white) {
        smooth_noise(&room->random, room->depth);
    }
    for (int32_t i = 0; i < COUNT; i++) {
        double noise = is_white ? eval_random_normal(&room->random) : room->depth[i];
        float z = at_edge(room, i % WIDTH, i / WIDTH);
        bool is_in = z > room->info.rig.depth_min_m && z < room->info.rig.depth_max_m;
        room->depth[i] = is_in ? measured(room, i, z, noise) : 0.0f;
    }
}

static rlf_result next(void *self, rlf_frame *out)
{
    start_room *room = self;
    draw(room);
    memset(out, 0, sizeof(*out));
    out->sequence = (uint64_t)room->frame;
    out->time_ns = room->frame++ * INT64_C(33333333);
    out->depth_f32 = room->depth;
    out->depth_stride = WIDTH * (ptrdiff_t)sizeof(float);
    return RLF_OK;
}

static void set_rig(start_room *room)
{
    rlf_rig *rig = &room->info.rig;
    *rig = eval_kinect_rig();
    rig->depth.width = WIDTH;
    rig->depth.height = HEIGHT;
    rig->depth.fx = rig->depth.fy = FOCAL;
    rig->depth.cx = 0.5 * (WIDTH - 1);
    rig->depth.cy = 0.5 * (HEIGHT - 1);
    rig->depth_min_m = 0.3;
    if (room->def.sensor == START_STEPS) {
        rig->noise = (rlf_depth_noise){0.0008, 0.0, 0.0012};
    }
}

static rlf_result open_all(start_room *room)
{
    float **const planes[4] = {&room->still, &room->depth, &room->clean, &room->common};
    for (int k = 0; k < 4; k++) {
        *planes[k] = rlf_alloc_array(COUNT, sizeof(float));
        if (*planes[k] == NULL) {
            return RLF_ERROR_MEMORY;
        }
    }
    room->rays = rlf_alloc_array(COUNT, sizeof(*room->rays));
    if (room->rays == NULL) {
        return RLF_ERROR_MEMORY;
    }
    for (int32_t i = 0; i < COUNT; i++) {
        rlf_vec3 ray;
        rlf_camera_unproject(&room->info.rig.depth, i % WIDTH, i / WIDTH, &ray);
        room->rays[i] = rlf_rotate(room->T_world_camera.q, ray);
        room->still[i] = (float)room_depth(&room->def, room->rays[i]);
    }
    smooth_noise(&room->random, room->common);
    static const rlf_source_methods methods = {.next = next};
    return rlf_source_create_custom(&methods, &room->info, room, &room->source);
}

rlf_result start_room_open(const start_def *def, start_room *out)
{
    memset(out, 0, sizeof(*out));
    out->def = *def;
    out->random = eval_random_start(def->seed);
    out->info = (rlf_source_info){.name = "start", .frame_count = -1, .frames_per_second = 30.0};
    out->T_world_camera.q = rlf_quat_from_axis_angle(rlf_vec3_make(1, 0, 0), -def->pitch);
    set_rig(out);
    rlf_result result = open_all(out);
    if (result != RLF_OK) {
        start_room_close(out);
    }
    return result;
}

void start_room_close(start_room *room)
{
    rlf_source_destroy(&room->source);
    rlf_free(room->rays);
    rlf_free(room->still);
    rlf_free(room->depth);
    rlf_free(room->clean);
    rlf_free(room->common);
    memset(room, 0, sizeof(*room));
}
