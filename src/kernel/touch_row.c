/* How far places are off trunks, shoulders and legs, and sums of that. */
#include "kernel/touch.h"

#include <string.h>

enum { LANES = RLF_KERNEL_RAY_LANES, SLOPES = RLF_KERNEL_SLOPES };

static const double tiny = 1e-9;

/* Of so many lanes. */
typedef struct touch_lanes {
    double distance[LANES], is_any[LANES], slope[SLOPES][LANES];
} touch_lanes;

RLF_KERNEL_PART double clamp(double x, double low, double high)
{
    return x < low ? low : (x > high ? high : x);
}

RLF_KERNEL_PART void touch_trunk(const rlf_kernel_torso *torso, const double *restrict side,
                                 const double *restrict down, const double *restrict ahead,
                                 touch_lanes *restrict out)
{
    const rlf_kernel_trunk t = torso->trunk;
    const double deepest = torso->deepest;
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < LANES; i++) {
        double below = down[i] + t.above;
        bool is_any = (below > t.first) & (below < t.last);
        rlf_kernel_section s = rlf_kernel_section_at(t, down[i]);
        double u = side[i] / s.breadth, v = (ahead[i] - t.ahead - t.lean * down[i]) / s.depth;
        double gu = u / s.breadth, gv = v / s.depth, steep = sqrt(gu * gu + gv * gv) + tiny;
        gu /= steep;
        gv /= steep;
        double distance = (u * u + v * v - 1.0) / (2.0 * steep);
        distance = distance > -deepest ? distance : -deepest;
        out->is_any[i] = is_any ? 1.0 : 0.0;
        out->distance[i] = distance;
        out->slope[RLF_TORSO_AHEAD][i] = -gv;
        out->slope[RLF_TORSO_LEAN][i] = -gv * down[i];
        out->slope[RLF_TORSO_TURN][i] = gu * ahead[i] - gv * side[i];
        out->slope[RLF_TORSO_SHOULDER][i] = 0.0;
        out->slope[RLF_TORSO_DROP][i] = 0.0;
        RLF_KERNEL_UNROLLED(RLF_KERNEL_SECTIONS)
        for (int32_t k = 0; k < RLF_KERNEL_SECTIONS; k++) {
            out->slope[RLF_TORSO_BREADTH + k][i] = -gu * u * s.share[k];
            out->slope[RLF_TORSO_DEPTH + k][i] = -gv * v * s.share[k];
        }
    }
}

RLF_KERNEL_PART void touch_bar(const rlf_kernel_torso *torso, const double *restrict side,
                               const double *restrict down, const double *restrict ahead,
                               touch_lanes *restrict out)
{
    const rlf_kernel_bar bar = torso->bar;
    const double top = torso->bar_top, bottom = torso->bar_bottom;
    memset(out, 0, sizeof *out);
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < LANES; i++) {
        double end = clamp(side[i], -bar.reach, bar.reach);
        double u = side[i] - end, v = ahead[i] - bar.ahead;
        double r = sqrt(u * u + v * v + down[i] * down[i]) + tiny;
        out->is_any[i] = (down[i] <= bottom) & (down[i] >= top) ? 1.0 : 0.0;
        out->distance[i] = r - bar.radius;
        out->slope[RLF_TORSO_AHEAD][i] = -v / r;
        out->slope[RLF_TORSO_TURN][i] = (u * ahead[i] - v * side[i]) / r;
        out->slope[RLF_TORSO_SHOULDER][i] = (u < 0.0 ? u : -u) / r;
        out->slope[RLF_TORSO_DROP][i] = -down[i] / r;
    }
}

RLF_KERNEL void rlf_kernel_touch_torso(const rlf_kernel_torso *torso,
                                       const rlf_kernel_places *places,
                                       rlf_kernel_touches *restrict out)
{
    for (int32_t first = 0; first < places->count; first += LANES) {
        const double *side = places->side + first, *down = places->down + first,
                     *ahead = places->ahead + first;
        touch_lanes trunk, bar;
        double of_trunk[LANES], of_bar[LANES];
        touch_trunk(torso, side, down, ahead, &trunk);
        touch_bar(torso, side, down, ahead, &bar);
        RLF_KERNEL_WHOLE
        for (int32_t i = 0; i < LANES; i++) {
            bool has_trunk = trunk.is_any[i] > 0.0, has_bar = bar.is_any[i] > 0.0;
            bool is_bar = has_bar & (!has_trunk | (bar.distance[i] < trunk.distance[i]));
            of_bar[i] = is_bar ? 1.0 : 0.0;
            of_trunk[i] = has_trunk & !is_bar ? 1.0 : 0.0;
            double distance = is_bar ? bar.distance[i] : trunk.distance[i];
            out->is_any[first + i] = has_trunk | has_bar ? 1.0 : 0.0;
            out->distance[first + i] = has_trunk | has_bar ? distance : 0.0;
        }
        for (int32_t k = 0; k < SLOPES; k++) {
            RLF_KERNEL_WHOLE
            for (int32_t i = 0; i < LANES; i++) {
                double slope = of_trunk[i] > 0.0 ? trunk.slope[k][i] : 0.0;
                out->slope[k][first + i] = of_bar[i] > 0.0 ? bar.slope[k][i] : slope;
            }
        }
    }
}

RLF_KERNEL void rlf_kernel_trunk_beside(const rlf_kernel_trunk *trunk, const double camera[3],
                                        rlf_kernel_places *restrict places, double *restrict by)
{
    const rlf_kernel_trunk t = *trunk;
    const double from[3] = {camera[0], camera[1], camera[2]};
    for (int32_t i = 0; i < places->count; i++) {
        double side = places->side[i], down = places->down[i], ahead = places->ahead[i];
        double way_side = side - from[0], way_down = down - from[1], way_ahead = ahead - from[2];
        rlf_kernel_section s = rlf_kernel_section_at(t, down);
        double axis = t.ahead + t.lean * down;
        double u = side / s.breadth, v = (ahead - axis) / s.depth;
        double du = way_side / s.breadth, dv = way_ahead / s.depth;
        double share = -(u * du + v * dv) / (du * du + dv * dv);
        by[i] = share;
        places->side[i] = side + share * way_side;
        places->down[i] = down + share * way_down;
        places->ahead[i] = ahead + share * way_ahead;
    }
}

/* Each place's own axis. */
typedef struct own_axes {
    double begin[3][LANES], along[3][LANES], unit[3][LANES];
    double square[LANES], radius[LANES], wider[LANES];
} own_axes;

RLF_KERNEL_PART void find_axes(const rlf_kernel_legs *legs, const double *restrict axis,
                               own_axes *restrict out)
{
    for (int32_t i = 0; i < LANES; i++) {
        int32_t at = (int32_t)axis[i];
        const rlf_kernel_axis *a = &legs->axis[at];
        for (int32_t k = 0; k < 3; k++) {
            out->begin[k][i] = a->begin[k];
            out->along[k][i] = a->along[k];
            out->unit[k][i] = legs->unit[at][k];
        }
        out->square[i] = a->square;
        out->radius[i] = a->radius[0];
        out->wider[i] = a->radius[1] - a->radius[0];
    }
}

/* The unit vector away from the axis, its share t, and the distance; on the far side of what is
 * seen from the camera turned about. */
typedef struct feet {
    double n[3][LANES], t[LANES], distance[LANES];
} feet;

RLF_KERNEL_PART void find_feet(const rlf_kernel_legs *legs, const own_axes *restrict a,
                               const rlf_kernel_places *restrict places, int32_t first,
                               feet *restrict out)
{
    const double *camera = legs->camera, behind = legs->behind;
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < LANES; i++) {
        double px = places->side[first + i], py = places->down[first + i];
        double pz = places->ahead[first + i];
        double x = px - a->begin[0][i], y = py - a->begin[1][i], z = pz - a->begin[2][i];
        double t = (x * a->along[0][i] + y * a->along[1][i] + z * a->along[2][i]) / a->square[i];
        t = clamp(t, 0.0, 1.0);
        x += a->along[0][i] * -t;
        y += a->along[1][i] * -t;
        z += a->along[2][i] * -t;
        double length = sqrt(x * x + y * y + z * z) + tiny, per = 1.0 / length;
        double wx = px - camera[0], wy = py - camera[1], wz = pz - camera[2];
        double toward = x * per * wx + y * per * wy + z * per * wz;
        double sign = toward > behind * sqrt(wx * wx + wy * wy + wz * wz) ? -1.0 : 1.0;
        out->n[0][i] = x * per * sign;
        out->n[1][i] = y * per * sign;
        out->n[2][i] = z * per * sign;
        out->t[i] = t;
        out->distance[i] = length * sign - (a->radius[i] + t * a->wider[i]);
    }
}

RLF_KERNEL void rlf_kernel_touch_legs(const rlf_kernel_legs *legs, const rlf_kernel_places *places,
                                      const double *restrict axis, rlf_kernel_touches *restrict out)
{
    const double heel = legs->heel, foot_length = legs->length;
    for (int32_t first = 0; first < places->count; first += LANES) {
        own_axes a;
        feet f;
        find_axes(legs, axis + first, &a);
        find_feet(legs, &a, places, first, &f);
        RLF_KERNEL_WHOLE
        for (int32_t i = 0; i < LANES; i++) {
            double at = axis[first + i], t = f.t[i];
            double part = at < RLF_LEG_PARTS ? at : at - RLF_LEG_PARTS;
            bool is_thigh = part == RLF_THIGH, is_shin = part == RLF_SHIN;
            bool is_foot = part == RLF_FOOT;
            double knee = is_thigh ? t : (is_shin ? 1.0 - t : 0.0);
            double ankle = is_thigh ? 0.0 : (is_shin ? t : 1.0);
            double share = (t * foot_length - heel) / foot_length;
            double across = f.n[0][i] * a.along[2][i] - f.n[2][i] * a.along[0][i];
            out->is_any[first + i] = 1.0;
            out->distance[first + i] = f.distance[i];
            RLF_KERNEL_UNROLLED(3)
            for (int32_t k = 0; k < 3; k++) {
                out->slope[RLF_LEG_KNEE + k][first + i] = -knee * f.n[k][i];
                out->slope[RLF_LEG_ANKLE + k][first + i] = -ankle * f.n[k][i];
            }
            out->slope[RLF_LEG_TOES][first + i] = is_foot ? -share * across : 0.0;
            out->slope[RLF_LEG_RADIUS][first + i] = is_thigh ? t - 1.0 : 0.0;
            out->slope[RLF_LEG_RADIUS + 1][first + i] = is_thigh ? -t : (is_shin ? t - 1.0 : 0.0);
            out->slope[RLF_LEG_RADIUS + 2][first + i] = is_shin ? -t : 0.0;
            out->slope[RLF_LEG_HIP][first + i] = is_thigh ? (t - 1.0) * f.n[2][i] : 0.0;
        }
    }
}

RLF_KERNEL void rlf_kernel_legs_beside(const rlf_kernel_legs *legs, const double *restrict axis,
                                       rlf_kernel_places *restrict places)
{
    const double camera[3] = {legs->camera[0], legs->camera[1], legs->camera[2]};
    const double least = legs->least_aslant;
    for (int32_t first = 0; first < places->count; first += LANES) {
        double *side = places->side + first, *down = places->down + first,
               *ahead = places->ahead + first;
        own_axes a;
        find_axes(legs, axis + first, &a);
        RLF_KERNEL_WHOLE
        for (int32_t i = 0; i < LANES; i++) {
            double x = side[i] - camera[0], y = down[i] - camera[1], z = ahead[i] - camera[2];
            double length = sqrt(x * x + y * y + z * z), per = length > 0.0 ? 1.0 / length : 1.0;
            x *= per;
            y *= per;
            z *= per;
            double ox = a.begin[0][i] - side[i], oy = a.begin[1][i] - down[i],
                   oz = a.begin[2][i] - ahead[i];
            double ux = a.unit[0][i], uy = a.unit[1][i], uz = a.unit[2][i];
            double cosine = ux * x + uy * y + uz * z, square = 1.0 - cosine * cosine;
            double off_way = ox * x + oy * y + oz * z, off_axis = ox * ux + oy * uy + oz * uz;
            bool is_aslant = !(square < least);
            double by = (off_way - cosine * off_axis) / (is_aslant ? square : 1.0);
            side[i] = is_aslant ? side[i] + x * by : side[i];
            down[i] = is_aslant ? down[i] + y * by : down[i];
            ahead[i] = is_aslant ? ahead[i] + z * by : ahead[i];
        }
    }
}

RLF_KERNEL_PART void add_row(double part, const double *restrict row, double *restrict sum)
{
    RLF_KERNEL_WHOLE
    for (int32_t c = 0; c < LANES; c++) {
        sum[c] += part * row[c];
    }
}

/* The touches as rows, those that count: the sums are of rows of unknowns. */
RLF_KERNEL void rlf_kernel_add_touches(const rlf_kernel_touches *touches,
                                       const double *restrict weight, int32_t count,
                                       rlf_kernel_equations *restrict sum)
{
    enum { COLUMNS = RLF_KERNEL_SLOPE_COLUMNS };
    double row[COLUMNS] = {0.0}, part[COLUMNS];
    rlf_kernel_equations all = *sum;
    for (int32_t i = 0; i < count; i++) {
        double distance = touches->distance[i];
        if (weight[i] == 0.0) {
            continue;
        }
        for (int32_t k = 0; k < SLOPES; k++) {
            row[k] = touches->slope[k][i];
        }
        RLF_KERNEL_WHOLE
        for (int32_t k = 0; k < COLUMNS; k++) {
            part[k] = weight[i] * row[k];
            all.b[k] -= part[k] * distance;
        }
        for (int32_t r = 0; r < SLOPES; r++) {
            add_row(part[r], row, all.a[r]);
        }
        for (int32_t r = LANES; r < SLOPES; r++) {
            add_row(part[r], row + LANES, all.a[r] + LANES);
        }
    }
    *sum = all;
}
