/* Puts things together of the simulator's solids. */
#include "sim/bones.h"
#include "sim/random/plan.h"

static rlf_quat yaw_of(const synth_maker *m)
{
    return rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), m->spot.yaw);
}

static rlf_vec3 to_level(const synth_maker *m, rlf_vec3 at)
{
    rlf_vec3 p = rlf_rotate(yaw_of(m), rlf_vec3_make(at.x, 0, at.z));
    return rlf_vec3_make(p.x + m->spot.x, m->plan->floor_y - m->base - at.y, p.z + m->spot.z);
}

static synth_part *add(synth_maker *m, const synth_look *look, synth_shape_type type)
{
    synth_scene *scene = m->plan->scene;
    int32_t i = scene->static_count < SYNTH_PART_MAX ? scene->static_count++ : SYNTH_PART_MAX - 1;
    synth_part *part = &scene->statics[i];
    *part =
        (synth_part){.name = "thing", .label = m->label, .material = SYNTH_DRAWN, .look = *look};
    part->shape.type = type;
    part->shape.T_camera_shape.q = yaw_of(m);
    return part;
}

synth_maker synth_make(synth_plan *plan, synth_spot spot)
{
    plan->label++;
    return (synth_maker){plan, spot, 0.0, plan->label};
}

synth_maker synth_make_on(const synth_maker *under, double x, double height, double z, double yaw)
{
    rlf_vec3 p = to_level(under, rlf_vec3_make(x, height, z));
    synth_maker m = synth_make(under->plan, (synth_spot){p.x, p.z, under->spot.yaw + yaw});
    m.base = under->base + height;
    return m;
}

void synth_make_box(synth_maker *m, const synth_look *look, rlf_vec3 at, rlf_vec3 size)
{
    synth_part *part = add(m, look, SYNTH_BOX);
    part->shape.size = rlf_scale(size, 0.5);
    part->shape.T_camera_shape.p = to_level(m, rlf_vec3_make(at.x, at.y + 0.5 * size.y, at.z));
}

void synth_make_round(synth_maker *m, const synth_look *look, rlf_vec3 at, double bottom,
                      double top, double height)
{
    synth_part *part = add(m, look, SYNTH_FRUSTUM);
    part->shape.radius_a = bottom;
    part->shape.radius_b = top;
    part->shape.length = height;
    part->shape.T_camera_shape.p = to_level(m, at);
    part->shape.T_camera_shape.q = rlf_quat_from_axis_angle(rlf_vec3_make(1, 0, 0), RLF_PI);
}

void synth_make_egg(synth_maker *m, const synth_look *look, rlf_vec3 at, rlf_vec3 radii)
{
    synth_part *part = add(m, look, SYNTH_ELLIPSOID);
    part->shape.size = radii;
    part->shape.T_camera_shape.p = to_level(m, at);
}

void synth_make_rod(synth_maker *m, const synth_look *look, rlf_vec3 from, rlf_vec3 to,
                    double radius)
{
    synth_part *part = add(m, look, SYNTH_CONE);
    rlf_vec3 a = to_level(m, from), b = to_level(m, to);
    rlf_vec3 way = rlf_sub(b, a);
    rlf_vec3 other =
        way.y * way.y > 0.5 * rlf_dot(way, way) ? rlf_vec3_make(0, 0, 1) : rlf_vec3_make(0, 1, 0);
    part->shape.length = rlf_length(way);
    part->shape.radius_a = part->shape.radius_b = radius;
    part->shape.T_camera_shape = synth_bone_pose(a, way, other);
}

void synth_make_plane(synth_maker *m, const synth_look *look, rlf_vec3 at, rlf_vec3 inwards)
{
    synth_part *part = add(m, look, SYNTH_HALF_SPACE);
    part->shape.T_camera_shape.p = to_level(m, at);
    rlf_vec3 other = inwards.y * inwards.y > 0.5 ? rlf_vec3_make(0, 0, 1) : rlf_vec3_make(0, 1, 0);
    part->shape.T_camera_shape.q =
        synth_bone_pose(rlf_vec3_make(0, 0, 0), rlf_neg(inwards), other).q;
}
