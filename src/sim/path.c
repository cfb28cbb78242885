/* Paths of a camera that moves through the scene. They are smooth, begin at rest, and are the same
 * for every seed. */
#include "sim/path.h"

#include "sim/random/plan.h"

#define CLEARANCE 0.3  /* metres that the camera keeps from what stands */
#define LOOKED_AT 20.0 /* seconds of the path whose clearance is looked at */
#define PIVOT 2.0      /* metres ahead: what an orbit goes about */
#define STOOD 2.0      /* seconds before a camera that stands is moved */
#define APART 5.0      /* metres between the camera at rest and the one that faces it */

/* Six numbers of a camera, path frame: metres; radians about y, then x, then z. */
typedef struct placed {
    rlf_vec3 p;
    double yaw, pitch, roll;
} placed;

/* A swing of a frequency in hertz. */
static double wave(double t, double hertz, double phase)
{
    return rlf_sin(2.0 * RLF_PI * hertz * t + phase);
}

/* 0 before 0, 1 after 1, smooth between. */
static double ease(double x)
{
    const double s = rlf_clamp(x, 0.0, 1.0);
    return s * s * s * (10.0 + s * (6.0 * s - 15.0));
}

static placed orbit(double t)
{
    const double a = 0.5 * wave(t, 0.11, 0.0) * ease(t);
    return (placed){
        {-PIVOT * rlf_sin(a), 0.05 * wave(t, 0.2, 0.0), PIVOT * (1.0 - rlf_cos(a))}, a, 0.0, 0.0};
}

/* Forward and back with the bob of steps. */
static placed walk(double t)
{
    return (placed){{0.25 * wave(t, 0.17, 0.0), 0.015 * wave(t, 1.8, 0.0),
                     0.5 - 0.5 * rlf_cos(2.0 * RLF_PI * 0.12 * t)},
                    0.25 * wave(t, 0.14, 0.0),
                    0.01 * wave(t, 1.8, 0.6),
                    0.01 * wave(t, 0.9, 0.0)};
}

/* Slow sway of who stands and looks about, and a hand's tremor. */
static placed handheld(double t)
{
    return (placed){{0.20 * wave(t, 0.13, 0.0) + 0.02 * wave(t, 0.71, 1.0),
                     0.08 * wave(t, 0.17, 0.5) + 0.005 * wave(t, 1.1, 0.0),
                     0.12 * wave(t, 0.11, 2.0) + 0.01 * wave(t, 0.83, 0.0)},
                    0.12 * wave(t, 0.15, 0.0) + 0.01 * wave(t, 0.9, 2.0),
                    0.08 * wave(t, 0.19, 2.0) + 0.004 * wave(t, 2.3, 0.0),
                    0.05 * wave(t, 0.12, 1.0) + 0.003 * wave(t, 1.7, 0.0)};
}

/* Every 8 seconds the camera turns by 100 degrees for a second, and back. */
static placed look_away(double t)
{
    placed c = handheld(t);
    const double s = t - 8.0 * (double)(int64_t)(t / 8.0);
    c.yaw += 1.75 * (ease((s - 2.0) / 1.5) - ease((s - 4.5) / 1.5));
    return c;
}

/* As much as a hand shakes a camera in a game: 1.3 m/s, 100 degrees a second. */
static placed fast(double t)
{
    return (placed){{0.30 * wave(t, 0.7, 0.0), 0.06 * wave(t, 1.3, 0.0), 0.15 * wave(t, 0.5, 0.0)},
                    0.35 * wave(t, 0.8, 1.0),
                    0.15 * wave(t, 0.9, 0.0),
                    0.10 * wave(t, 0.6, 2.0)};
}

/* From where it stands to where it stands then; `s` of the way. */
static placed carried(double s)
{
    return (placed){{0.25 * s, -0.06 * s, 0.15 * s}, 0.2 * s, 0.06 * s, -0.03 * s};
}

static placed bump(double s)
{
    return (placed){{0.008 * s, 0.004 * s, -0.004 * s}, 0.014 * s, 0.01 * s, 0.004 * s};
}

static placed place_at(rlf_synthetic_path kind, double t)
{
    switch (kind) {
    case RLF_SYNTHETIC_PATH_ORBIT: return orbit(t);
    case RLF_SYNTHETIC_PATH_WALK: return walk(t);
    case RLF_SYNTHETIC_PATH_HANDHELD: return handheld(t);
    case RLF_SYNTHETIC_PATH_LOOK_AWAY: return look_away(t);
    case RLF_SYNTHETIC_PATH_FAST: return fast(t);
    case RLF_SYNTHETIC_PATH_CARRIED: return carried(ease((t - STOOD) / 1.5));
    case RLF_SYNTHETIC_PATH_BUMP: return bump(ease((t - STOOD) / 0.2));
    case RLF_SYNTHETIC_PATH_OPPOSITE: return (placed){{0, 0, APART}, RLF_PI, 0.0, 0.0};
    default: return (placed){.yaw = 0.0};
    }
}

rlf_pose synth_path_pose(const synth_path *path, double t)
{
    const bool is_opposite = path->kind == RLF_SYNTHETIC_PATH_OPPOSITE;
    const placed c = place_at(path->kind, t);
    const double begun = is_opposite ? 1.0 : ease(t);
    const rlf_quat yaw = rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), begun * c.yaw);
    const rlf_quat pitch = rlf_quat_from_axis_angle(rlf_vec3_make(1, 0, 0), begun * c.pitch);
    const rlf_quat roll = rlf_quat_from_axis_angle(rlf_vec3_make(0, 0, 1), begun * c.roll);
    const rlf_quat turn = rlf_quat_mul(yaw, rlf_quat_mul(pitch, roll));
    const rlf_quat q = path->q_camera_path;
    rlf_pose pose;
    pose.p = rlf_scale(rlf_rotate(q, c.p), begun * path->scale);
    pose.q = rlf_quat_normalize(rlf_quat_mul(rlf_quat_mul(q, turn), rlf_quat_conjugate(q)));
    return pose;
}

static bool is_clear(const synth_path *path, const synth_scene *rest)
{
    for (double t = 0.0; t < LOOKED_AT; t += 0.1) {
        const rlf_pose pose = synth_path_pose(path, t);
        double distance;
        rlf_vec3 normal;
        (void)synth_nearest(rest->statics, rest->static_count, pose.p, &distance, &normal);
        if (distance < CLEARANCE) {
            return false;
        }
    }
    return true;
}

void synth_path_make(synth_path *path, rlf_synthetic_path kind, const synth_scene *rest)
{
    *path = (synth_path){.kind = kind, .q_camera_path = rlf_quat_identity(), .scale = 1.0};
    if (rest->random != NULL) {
        const rlf_quat q_camera_level = rest->random->q_camera_level;
        const rlf_vec3 ahead =
            rlf_rotate(rlf_quat_conjugate(q_camera_level), rlf_vec3_make(0, 0, 1));
        const rlf_quat heading =
            rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), rlf_atan2(ahead.x, ahead.z));
        path->q_camera_path = rlf_quat_mul(q_camera_level, heading);
    }
    while (kind != RLF_SYNTHETIC_PATH_OPPOSITE && path->scale > 0.01 && !is_clear(path, rest)) {
        path->scale *= 0.8;
    }
}

static void see_parts(synth_part *parts, int32_t count, const rlf_pose *T_camera_world)
{
    for (int32_t i = 0; i < count; i++) {
        synth_part *part = &parts[i];
        part->shape.T_camera_shape = rlf_pose_mul(T_camera_world, &part->shape.T_camera_shape);
        part->velocity = rlf_rotate(T_camera_world->q, part->velocity);
        part->angular_velocity = rlf_rotate(T_camera_world->q, part->angular_velocity);
    }
}

void synth_path_see(const synth_scene *rest, const rlf_pose *T_world_camera, synth_scene *out)
{
    const rlf_pose T_camera_world = rlf_pose_invert(T_world_camera);
    *out = *rest;
    see_parts(out->statics, out->static_count, &T_camera_world);
    see_parts(out->movers, out->mover_count, &T_camera_world);
    out->floor_y = rest->floor_y - rlf_dot(T_world_camera->p, rest->down);
    out->down = rlf_rotate(T_camera_world.q, rest->down);
    out->lamp = rlf_transform(&T_camera_world, rest->lamp);
    synth_scene_bound(out);
}
