/* Where the rays of a row enter and leave trunks, shoulders and limbs. */
#include "kernel/solid.h"

enum { LANES = RLF_KERNEL_RAY_LANES };

/* a z^2 - 2 b z + c, negative at depths z where a ray is inside a round solid. */
typedef struct quadratic {
    double a, b, c;
} quadratic;

/* enter > leave: there is none. */
typedef struct roots {
    double enter, leave;
} roots;

static const roots none = {1e9, -1e9};

typedef struct roots_of_lanes {
    double enter[LANES], leave[LANES];
} roots_of_lanes;

RLF_KERNEL_PART roots find_roots(quadratic q, double least_a)
{
    double d = q.b * q.b - q.a * q.c;
    bool has_any = (q.a > least_a) & (d > 0.0);
    double root = sqrt(has_any ? d : 0.0), a = has_any ? q.a : 1.0;
    double enter = (q.b - root) / a, leave = (q.b + root) / a;
    return (roots){has_any ? enter : none.enter, has_any ? leave : none.leave};
}

/* Cuts the upright cylinders over the sections at some heights. */
RLF_KERNEL_PART void cut_sections(const rlf_kernel_trunk t, const rlf_kernel_ray_lanes *rays,
                                  int32_t first, const double z[LANES], roots_of_lanes *out)
{
    const double x = -rays->camera[0], y = rays->camera[1], z_ = rays->camera[2];
    const double *side = rays->side + first, *ahead = rays->ahead + first;
    const double *height = rays->down + first;
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < LANES; i++) {
        double down = y + height[i] * z[i], below = down + t.above;
        bool is_any = (below > t.first) & (below < t.last) & (down <= t.lowest);
        rlf_kernel_section s = rlf_kernel_section_at(t, down);
        double u1 = side[i] / s.breadth, u0 = x / s.breadth;
        double axis = t.ahead + t.lean * down;
        double v1 = ahead[i] / s.depth, v0 = (axis - z_) / s.depth;
        const quadratic q = {u1 * u1 + v1 * v1, u1 * u0 + v1 * v0, u0 * u0 + v0 * v0 - 1.0};
        roots found = find_roots(q, 1e-6);
        out->enter[i] = is_any ? found.enter : none.enter;
        out->leave[i] = is_any ? found.leave : none.leave;
    }
}

RLF_KERNEL void rlf_kernel_cut_trunk(const rlf_kernel_trunk *trunk,
                                     const rlf_kernel_ray_lanes *rays,
                                     rlf_kernel_cuts *restrict out)
{
    const rlf_kernel_trunk t = *trunk;
    double z[LANES];
    for (int32_t i = 0; i < LANES; i++) {
        z[i] = t.middle;
    }
    for (int32_t first = 0; first < rays->count; first += LANES) {
        roots_of_lanes middle, front, back;
        cut_sections(t, rays, first, z, &middle);
        cut_sections(t, rays, first, middle.enter, &front);
        cut_sections(t, rays, first, middle.leave, &back);
        RLF_KERNEL_WHOLE
        for (int32_t i = 0; i < LANES; i++) {
            bool is_hit = middle.enter[i] <= middle.leave[i];
            bool has_front = is_hit & (front.enter[i] <= front.leave[i]);
            bool has_back = is_hit & (back.enter[i] <= back.leave[i]);
            out->enter[first + i] = has_front ? front.enter[i] : middle.enter[i];
            out->leave[first + i] = has_back ? back.leave[i] : middle.leave[i];
        }
    }
}

/* From where the first of two begins to where the last ends. */
RLF_KERNEL_PART roots unite(roots a, roots b)
{
    return (roots){a.enter < b.enter ? a.enter : b.enter, a.leave > b.leave ? a.leave : b.leave};
}

RLF_KERNEL void rlf_kernel_cut_bar(const rlf_kernel_bar *bar, const rlf_kernel_ray_lanes *rays,
                                   rlf_kernel_cuts *restrict out)
{
    const double reach = bar->reach, round = bar->radius * bar->radius;
    const double camera = rays->camera[0], a = bar->ahead - rays->camera[2], d = -rays->camera[1];
    const double right = reach - camera, left = -reach - camera;
    const double off[3] = {right * right + a * a + d * d - round,
                           left * left + a * a + d * d - round, a * a + d * d - round};
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < rays->count; i++) {
        double side = rays->side[i], ahead = rays->ahead[i], down = rays->down[i];
        double all = side * side + ahead * ahead + down * down;
        const quadratic one = {all, side * right + ahead * a + down * d, off[0]};
        const quadratic other = {all, side * left + ahead * a + down * d, off[1]};
        const quadratic tube = {ahead * ahead + down * down, ahead * a + down * d, off[2]};
        roots ends = unite(find_roots(one, 1e-6), find_roots(other, 1e-6));
        roots cut = find_roots(tube, 1e-6);
        double enter = camera + side * cut.enter, leave = camera + side * cut.leave;
        cut.enter = (enter >= -reach) & (enter <= reach) ? cut.enter : none.enter;
        cut.leave = (leave >= -reach) & (leave <= reach) ? cut.leave : none.leave;
        ends = unite(ends, cut);
        out->enter[i] = ends.enter;
        out->leave[i] = ends.leave;
    }
}

RLF_KERNEL_PART double dot(const double a[3], double x, double y, double z)
{
    return a[0] * x + a[1] * y + a[2] * z;
}

/* A root of the cylinder where it lies between the ends, `at` along it. */
RLF_KERNEL_PART roots keep_within(double root, double at, double length)
{
    bool is_in = (at >= 0.0) & (at <= length);
    return (roots){is_in ? root : none.enter, is_in ? root : none.leave};
}

RLF_KERNEL void rlf_kernel_cut_limb(const rlf_kernel_limb *limb, const rlf_kernel_ray_lanes *rays,
                                    int32_t begin, int32_t end, rlf_kernel_cuts *restrict out)
{
    const rlf_kernel_limb l = *limb;
    const double *o = l.off[0], *far_o = l.off[1], *a = l.along;
    const double off_along = dot(a, o[0], o[1], o[2]), off_2 = dot(o, o[0], o[1], o[2]);
    const double one_c = off_2 - l.radius[0] * l.radius[0];
    const double other_c = dot(far_o, far_o[0], far_o[1], far_o[2]) - l.radius[1] * l.radius[1];
    for (int32_t i = begin; i < end; i++) {
        double x = rays->side[i], y = rays->down[i], z = rays->ahead[i];
        double way_2 = x * x + y * y + z * z, way_along = dot(a, x, y, z),
               way_off = dot(o, x, y, z);
        const quadratic one = {way_2, way_off, one_c};
        const quadratic other = {way_2, dot(far_o, x, y, z), other_c};
        quadratic tube = {way_2 - way_along * way_along, way_off - off_along * way_along,
                          off_2 - off_along * off_along};
        bool is_aslant = tube.a > 1e-9;
        double nearest = is_aslant ? tube.b / (is_aslant ? tube.a : 1.0) : 0.0;
        double t = (nearest * way_along - off_along) / l.length;
        t = t < 0.0 ? 0.0 : (t > 1.0 ? 1.0 : t);
        double radius = l.radius[0] + t * (l.radius[1] - l.radius[0]);
        tube.c -= radius * radius;
        roots cut = find_roots(tube, 1e-9);
        roots all = unite(keep_within(cut.enter, cut.enter * way_along - off_along, l.length),
                          keep_within(cut.leave, cut.leave * way_along - off_along, l.length));
        bool has_any = cut.enter <= cut.leave;
        all = (roots){has_any ? all.enter : none.enter, has_any ? all.leave : none.leave};
        all = unite(all, unite(find_roots(one, 1e-9), find_roots(other, 1e-9)));
        out->enter[i] = all.enter;
        out->leave[i] = all.leave;
    }
}

RLF_KERNEL void rlf_kernel_find_nearest(const rlf_kernel_axis *axes, int32_t axis_count,
                                        const rlf_kernel_places *places,
                                        rlf_kernel_nearest *restrict out)
{
    for (int32_t k = 0; k < axis_count; k++) {
        const rlf_kernel_axis a = axes[k];
        const double *along = a.along;
        for (int32_t i = 0; i < places->count; i++) {
            double x = places->side[i] - a.begin[0], y = places->down[i] - a.begin[1];
            double z = places->ahead[i] - a.begin[2];
            double t = dot(along, x, y, z) / a.square;
            t = t < 0.0 ? 0.0 : (t > 1.0 ? 1.0 : t);
            x += along[0] * -t;
            y += along[1] * -t;
            z += along[2] * -t;
            double radius = a.radius[0] + t * (a.radius[1] - a.radius[0]);
            double distance = sqrt(x * x + y * y + z * z) - radius;
            bool is_nearer = (k == 0) | (distance < out->distance[i]);
            out->distance[i] = is_nearer ? distance : out->distance[i];
            out->axis[i] = is_nearer ? (double)k : out->axis[i];
        }
    }
}
