/* Where things have room. */
#include "sim/random/plan.h"

#define CAMERA_CLEAR 0.75 /* metres about the camera that nothing stands in */
#define LANE_HALF 0.40    /* metres that people need on either side of their way */
#define WALL_GAP 0.02
#define TRIES 24

static bool overlaps(synth_plot a, synth_plot b)
{
    return a.x0 < b.x1 && b.x0 < a.x1 && a.z0 < b.z1 && b.z0 < a.z1;
}

static double from_plot(synth_plot p, double x, double z)
{
    double dx = rlf_max(0.0, rlf_max(p.x0 - x, x - p.x1));
    double dz = rlf_max(0.0, rlf_max(p.z0 - z, z - p.z1));
    return sqrt(dx * dx + dz * dz);
}

double synth_place_from_lane(const synth_lane *l, double x, double z)
{
    double dx = l->to_x - l->from_x, dz = l->to_z - l->from_z;
    double square = dx * dx + dz * dz;
    double share = square > 0.0 ? ((x - l->from_x) * dx + (z - l->from_z) * dz) / square : 0.0;
    share = rlf_clamp(share, 0.0, 1.0);
    double ex = x - l->from_x - share * dx, ez = z - l->from_z - share * dz;
    return sqrt(ex * ex + ez * ez);
}

static bool meets_lane(const synth_lane *l, synth_plot plot)
{
    for (int32_t i = 0; i <= 40; i++) {
        double x = l->from_x + (l->to_x - l->from_x) * i / 40.0;
        double z = l->from_z + (l->to_z - l->from_z) * i / 40.0;
        if (from_plot(plot, x, z) < LANE_HALF) {
            return true;
        }
    }
    return false;
}

bool synth_place_is_free(const synth_plan *plan, synth_plot plot)
{
    const synth_plot *room = &plan->room;
    bool is_free = plot.x0 >= room->x0 && plot.x1 <= room->x1 && plot.z0 >= room->z0 &&
                   plot.z1 <= room->z1 && from_plot(plot, 0.0, 0.0) > CAMERA_CLEAR &&
                   plan->taken_count < SYNTH_PLOTS_MAX;
    for (int32_t i = 0; i < plan->taken_count && is_free; i++) {
        is_free = !overlaps(plan->taken[i], plot);
    }
    for (int32_t i = 0; i < plan->lane_count && is_free; i++) {
        is_free = !meets_lane(&plan->lanes[i], plot);
    }
    return is_free;
}

void synth_place_take(synth_plan *plan, synth_plot plot)
{
    if (plan->taken_count < SYNTH_PLOTS_MAX) {
        plan->taken[plan->taken_count++] = plot;
    }
}

static bool take_about(synth_plan *plan, synth_spot spot, double across, double along)
{
    const double gap = 0.03;
    synth_plot plot = {spot.x - 0.5 * across, spot.x + 0.5 * across, spot.z - 0.5 * along,
                       spot.z + 0.5 * along};
    if (!synth_place_is_free(plan, plot)) {
        return false;
    }
    synth_place_take(plan,
                     (synth_plot){plot.x0 - gap, plot.x1 + gap, plot.z0 - gap, plot.z1 + gap});
    return true;
}

bool synth_place_at_wall(synth_plan *plan, double width, double depth, synth_spot *out)
{
    const synth_plot *r = &plan->room;
    const double off = 0.5 * depth + WALL_GAP;
    for (int32_t i = 0; i < TRIES; i++) {
        const int32_t wall = synth_draw_index(&plan->draw, 4);
        const bool is_side = wall == 1 || wall == 3;
        const double low = (is_side ? r->z0 : r->x0) + 0.5 * width + WALL_GAP;
        const double high = (is_side ? r->z1 : r->x1) - 0.5 * width - WALL_GAP;
        const double at = synth_draw_range(&plan->draw, low, rlf_max(low, high));
        const synth_spot spots[4] = {{at, r->z1 - off, 0.0},
                                     {r->x1 - off, at, 0.5 * RLF_PI},
                                     {at, r->z0 + off, RLF_PI},
                                     {r->x0 + off, at, -0.5 * RLF_PI}};
        *out = spots[wall];
        if (take_about(plan, *out, is_side ? depth : width, is_side ? width : depth)) {
            return true;
        }
    }
    return false;
}

bool synth_place_anywhere(synth_plan *plan, double width, double depth, synth_spot *out)
{
    const synth_plot *r = &plan->room;
    const double half = 0.5 * sqrt(width * width + depth * depth);
    for (int32_t i = 0; i < TRIES; i++) {
        out->x = synth_draw_range(&plan->draw, r->x0 + half, rlf_max(r->x0 + half, r->x1 - half));
        out->z = synth_draw_range(&plan->draw, r->z0 + half, rlf_max(r->z0 + half, r->z1 - half));
        out->yaw = synth_draw_range(&plan->draw, -RLF_PI, RLF_PI);
        if (take_about(plan, *out, 2.0 * half, 2.0 * half)) {
            return true;
        }
    }
    return false;
}

bool synth_place_is_seen(const synth_plan *plan, rlf_vec3 at, double margin)
{
    const rlf_vec3 level = {at.x, plan->floor_y - at.y, at.z};
    const rlf_vec3 p = rlf_rotate(plan->random->q_camera_level, level);
    const double half[2] = {0.5 * SYNTH_DEPTH_WIDTH / plan->random->focal,
                            0.5 * SYNTH_DEPTH_HEIGHT / plan->random->focal};
    const double across[2] = {p.x < 0.0 ? -p.x : p.x, p.y < 0.0 ? -p.y : p.y};
    bool is_seen = p.z > margin;
    for (int k = 0; k < 2; k++) { /* distance inside the plane through the picture's side */
        double inside = (half[k] * p.z - across[k]) / sqrt(1.0 + half[k] * half[k]);
        is_seen = is_seen && inside > margin;
    }
    return is_seen;
}
