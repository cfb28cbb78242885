/* Walls, floor, ceiling; a doorway with its door open, windows, pillars. */
#include "sim/random/plan.h"

#define WALL_THICK 0.14
#define DOOR_WIDTH 0.85
#define DOOR_HEIGHT 2.03
#define CORRIDOR 1.4 /* metres from the doorway to the wall behind it */

/* A wall seen from inside: its frame's +z looks out, `length` runs along x. */
typedef struct side {
    synth_spot spot; /* middle of the inner face */
    double length;
} side;

static side side_of(const synth_plan *plan, int32_t wall)
{
    const synth_plot *r = &plan->room;
    const double x = 0.5 * (r->x0 + r->x1), z = 0.5 * (r->z0 + r->z1);
    const side sides[4] = {{{x, r->z1, 0.0}, r->x1 - r->x0},
                           {{r->x1, z, 0.5 * RLF_PI}, r->z1 - r->z0},
                           {{x, r->z0, RLF_PI}, r->x1 - r->x0},
                           {{r->x0, z, -0.5 * RLF_PI}, r->z1 - r->z0}};
    return sides[wall];
}

static synth_maker maker_of(synth_plan *plan, const side *s, int32_t label)
{
    synth_maker m = {plan, s->spot, 0.0, label};
    return m;
}

static rlf_vec3 inwards_of(const side *s)
{
    const rlf_quat turn = rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), s->spot.yaw);
    return rlf_rotate(turn, rlf_vec3_make(0, 0, -1));
}

static void add_wall(synth_plan *plan, const side *s, const synth_look *look, double behind)
{
    synth_maker m = maker_of(plan, s, RLF_SYNTHETIC_LABEL_WALL);
    synth_make_plane(&m, look, rlf_vec3_make(0, 0, behind), inwards_of(s));
}

/* The floor before the doorway and where the open leaf is stays free. */
static void keep_doorway_free(synth_plan *plan, const side *s, double middle)
{
    const double c = rlf_cos(s->spot.yaw), n = rlf_sin(s->spot.yaw);
    const double x = s->spot.x + c * middle - n * 0.5, z = s->spot.z - n * middle - c * 0.5;
    const double half = 0.6;
    synth_place_take(plan, (synth_plot){x - half, x + half, z - half, z + half});
}

/* A wall of three boxes about an opening, the leaf turned into the room, a corridor behind. */
static void add_doorway(synth_plan *plan, const side *s, const synth_look *look)
{
    synth_draw *d = &plan->draw;
    synth_maker m = maker_of(plan, s, RLF_SYNTHETIC_LABEL_WALL);
    const double half = 0.5 * s->length, reach = half - 0.75;
    const double middle = synth_draw_range(d, -reach, reach);
    const double left = middle - 0.5 * DOOR_WIDTH, right = middle + 0.5 * DOOR_WIDTH;
    const double z = 0.5 * WALL_THICK, far = 4.0; /* beyond the room's corners */
    const double h = plan->height;
    synth_make_box(&m, look, rlf_vec3_make(0.5 * (left - half - far), 0, z),
                   rlf_vec3_make(left + half + far, h, WALL_THICK));
    synth_make_box(&m, look, rlf_vec3_make(0.5 * (right + half + far), 0, z),
                   rlf_vec3_make(half + far - right, h, WALL_THICK));
    synth_make_box(&m, look, rlf_vec3_make(middle, DOOR_HEIGHT, z),
                   rlf_vec3_make(DOOR_WIDTH, h - DOOR_HEIGHT, WALL_THICK));
    add_wall(plan, s, look, CORRIDOR);
    const double angle = synth_draw_range(d, 0.5, 1.9);
    const double c = rlf_cos(angle), n = rlf_sin(angle);
    synth_maker wall = maker_of(plan, s, 0);
    synth_maker leaf = synth_make_on(&wall, left + 0.5 * c * DOOR_WIDTH, 0.01,
                                     -0.02 - 0.5 * n * DOOR_WIDTH, angle);
    const synth_look paint = synth_look_paint(d);
    synth_make_box(&leaf, &paint, rlf_vec3_make(0, 0, 0), rlf_vec3_make(DOOR_WIDTH, 2.0, 0.04));
    synth_make_egg(&leaf, &plan->metal, rlf_vec3_make(0.36, 1.02, 0.05),
                   rlf_vec3_make(0.05, 0.015, 0.03));
    keep_doorway_free(plan, s, middle);
}

/* Glass sends nothing back; its frame does. */
static void add_window(synth_plan *plan, const side *s)
{
    synth_draw *d = &plan->draw;
    const synth_look glass = synth_look_plain(rlf_vec3_make(0.75, 0.85, 0.95), 0.003, 0.0);
    const synth_look frame = synth_look_plain(rlf_vec3_make(0.8, 0.8, 0.78), 0.6, 0.4);
    const double width = synth_draw_range(d, 0.6, 1.5), height = synth_draw_range(d, 0.6, 1.2);
    const double reach = rlf_max(0.0, 0.5 * (s->length - width) - 0.3);
    const double x = synth_draw_range(d, -reach, reach), sill = 0.9;
    synth_maker wall = maker_of(plan, s, 0);
    synth_maker m = synth_make_on(&wall, x, sill, 0.0, 0.0);
    synth_make_box(&m, &frame, rlf_vec3_make(0, -0.04, 0.01),
                   rlf_vec3_make(width + 0.16, height + 0.08, 0.07));
    synth_make_box(&m, &glass, rlf_vec3_make(0, 0.04, 0.0),
                   rlf_vec3_make(width, height - 0.08, 0.06));
    synth_make_box(&m, &frame, rlf_vec3_make(0, 0.0, 0.0), rlf_vec3_make(0.05, height, 0.08));
}

/* Flat things on a wall: pictures, a board, a screen that is off. */
static void add_picture(synth_plan *plan, const side *s)
{
    synth_draw *d = &plan->draw;
    const double width = synth_draw_range(d, 0.25, 1.1), height = synth_draw_range(d, 0.25, 0.7);
    const double reach = rlf_max(0.0, 0.5 * (s->length - width) - 0.3);
    const double x = synth_draw_range(d, -reach, reach);
    const bool is_screen = synth_draw_chance(d, 0.3);
    const double thick = is_screen ? 0.06 : 0.03;
    synth_look look = is_screen ? synth_look_plain(rlf_vec3_make(0.02, 0.02, 0.02), 0.012, 0.05)
                                : synth_look_any(d);
    if (!is_screen) {
        look.pattern = SYNTH_PRINT;
        look.size = 0.08;
        look.texture = 0.95f;
    }
    synth_maker wall = maker_of(plan, s, 0);
    synth_maker m = synth_make_on(&wall, x, synth_draw_range(d, 1.0, 1.5), -0.5 * thick, 0.0);
    synth_make_box(&m, &look, rlf_vec3_make(0, 0, 0), rlf_vec3_make(width, height, thick));
}

static void add_pillar(synth_plan *plan)
{
    synth_spot spot;
    const double wide = synth_draw_range(&plan->draw, 0.2, 0.45);
    if (synth_place_at_wall(plan, wide, wide, &spot)) {
        synth_maker m = {plan, spot, 0.0, RLF_SYNTHETIC_LABEL_COLUMN};
        const synth_look look = synth_look_paint(&plan->draw);
        synth_make_box(&m, &look, rlf_vec3_make(0, 0, 0),
                       rlf_vec3_make(wide, plan->height, wide + 0.05));
    }
}

void synth_draw_shell(synth_plan *plan)
{
    synth_draw *d = &plan->draw;
    const synth_look walls = synth_look_paint(d);
    synth_look ground = synth_draw_chance(d, 0.5) ? synth_look_wood(d) : synth_look_cloth(d);
    ground.reflectance = ground.reflectance < 0.15f ? 0.15f : ground.reflectance;
    const synth_look above = synth_look_plain(rlf_vec3_make(0.8, 0.8, 0.78), 0.6, 0.3);
    const synth_spot origin = {0, 0, 0};
    synth_maker floor = {plan, origin, 0.0, RLF_SYNTHETIC_LABEL_FLOOR};
    synth_maker ceiling = {plan, origin, plan->height, RLF_SYNTHETIC_LABEL_CEILING};
    synth_make_plane(&floor, &ground, rlf_vec3_make(0, 0, 0), rlf_vec3_make(0, -1, 0));
    synth_make_plane(&ceiling, &above, rlf_vec3_make(0, 0, 0), rlf_vec3_make(0, 1, 0));
    const int32_t door = synth_draw_chance(d, 0.5) ? synth_draw_index(d, 4) : -1;
    for (int32_t wall = 0; wall < 4; wall++) {
        const side s = side_of(plan, wall);
        if (wall == door && wall != 2) { /* the camera hangs at wall 2 */
            add_doorway(plan, &s, &walls);
            continue;
        }
        add_wall(plan, &s, &walls, 0.0);
        if (synth_draw_chance(d, 0.3)) {
            add_window(plan, &s);
        } else if (synth_draw_chance(d, 0.6)) {
            add_picture(plan, &s);
        }
    }
    if (synth_draw_chance(d, 0.3)) {
        add_pillar(plan);
    }
}
