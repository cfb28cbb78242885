/* THROW: random bodies into a room of planes. BEHIND and EDGE: at the unseen back of a slab, and at
 * the side of a thin one. */
#include "eval/analytic.h"
#include "eval/physics/experiments.h"
#include "eval/physics/sheet.h"
#include "eval/physics/world.h"
#include "eval/table.h"

#define FRAME_S (1.0 / 30)
#define THROWS 60
#define SLAB_THROWS 30
#define WALLS 5

/* Floor, back wall, side walls and a ramp, all within the view. */
static const eval_wall room[WALLS] = {{{0, -1, 0}, -1.0},
                                      {{0, 0, -1}, -4.5},
                                      {{1, 0, 0}, -1.6},
                                      {{-1, 0, 0}, -1.6},
                                      {{0, -0.6, -0.8}, -3.6}};

/* Any shape of 2 to 15 cm. */
static rlf_body_def random_body(eval_random *r)
{
    rlf_body_def def = rlf_body_def_default();
    double size = eval_random_range(r, 0.02, 0.15);
    def.shape.type = (rlf_shape_type)(int)(4.0 * eval_random_uniform(r));
    def.shape.size = eval_random_in_box(r, rlf_vec3_make(size, 0.5 * size, 0.5 * size),
                                        rlf_vec3_make(size, 1.5 * size, 1.5 * size));
    def.shape.radius = 0.5 * size;
    def.shape.height = size * eval_random_range(r, 0.5, 1.5);
    def.mass = eval_random_range(r, 0.05, 1.05);
    def.restitution = eval_random_uniform(r);
    def.friction = eval_random_uniform(r);
    def.orientation = rlf_quat_from_rotation_vector(
        eval_random_in_box(r, rlf_vec3_make(-3, -3, -3), rlf_vec3_make(3, 3, 3)));
    def.angular_velocity =
        eval_random_in_box(r, rlf_vec3_make(-10, -10, -10), rlf_vec3_make(10, 10, 10));
    return def;
}

static bool is_out_of_room(rlf_vec3 p)
{
    for (int i = 0; i < WALLS; i++) {
        if (rlf_dot(room[i].n, p) < room[i].d) {
            return true;
        }
    }
    return false;
}

/* Whether it got through what the camera sees, within two seconds. */
static bool tunnels(eval_sheet *sheet, eval_random *r)
{
    rlf_body_def def = random_body(r);
    def.position =
        eval_random_in_box(r, rlf_vec3_make(-0.6, -0.5, 1.3), rlf_vec3_make(0.6, 0.3, 2.3));
    rlf_vec3 target =
        eval_random_in_box(r, rlf_vec3_make(-1.2, -0.6, 3.5), rlf_vec3_make(1.2, 1, 4.5));
    def.velocity =
        rlf_scale(rlf_normalize(rlf_sub(target, def.position)), eval_random_range(r, 0.5, 10.0));
    rlf_world *world = eval_world_open(RLF_PHYSICS_LIVE, rlf_vec3_make(0, 9.81, 0), 1);
    bool is_through = world == NULL || rlf_world_add_body(world, &def, NULL) != RLF_OK;
    bool is_gone = is_through;
    for (int k = 0; k < 60 && !is_gone; k++) {
        eval_sheet_set_slab(sheet, NULL);
        rlf_world_advance(world, &sheet->grid, FRAME_S);
        bool is_there = rlf_world_get_snapshot(world)->body_count > 0;
        rlf_vec3 p = is_there ? eval_world_body(world, 0)->T_world_body.p : def.position;
        is_gone = !is_there || !eval_sheet_sees(p); /* where nothing is seen, nothing is solid */
        is_through = !is_gone && (is_out_of_room(p) || !rlf_vec3_is_finite(p));
        is_gone = is_gone || is_through;
    }
    rlf_world_destroy(&world);
    return is_through;
}

/* A throw at the slab from behind along -z, or from the side along -x: it touches, and turns. */
static bool bounces(eval_sheet *sheet, eval_random *r, bool is_edge)
{
    rlf_body_def def = random_body(r);
    double speed = eval_random_range(r, 0.5, 5.0);
    double y = eval_random_range(r, is_edge ? -0.1 : -0.3, is_edge ? 0.1 : 0.3);
    double across = eval_random_range(r, -1.0, 1.0);
    def.position =
        is_edge ? rlf_vec3_make(0.5, y, 2.1 + 0.05 * across) : rlf_vec3_make(0.15 * across, y, 3.0);
    def.velocity = is_edge ? rlf_vec3_make(-speed, 0, 0) : rlf_vec3_make(0, 0, -speed);
    rlf_world *world = eval_world_open(RLF_PHYSICS_LIVE, rlf_vec3_make(0, 0, 0), 1);
    bool is_through = world == NULL || rlf_world_add_body(world, &def, NULL) != RLF_OK;
    bool has_touched = false;
    for (int k = 0; k < (int)(36.0 / speed) + 2 && !is_through; k++) {
        sheet->grid.time_ns++;
        rlf_world_advance(world, &sheet->grid, FRAME_S);
        const rlf_snapshot *s = rlf_world_get_snapshot(world);
        for (int32_t c = 0; c < s->contact_count; c++) {
            has_touched = has_touched || s->contacts[c].other == RLF_CONTACT_FOREGROUND;
        }
        rlf_vec3 p = s->bodies[0].T_world_body.p;
        is_through = is_edge ? p.x < 0.0 : p.z < 2.0;
    }
    rlf_world_destroy(&world);
    return has_touched && !is_through;
}

static double bounce_percent(eval_sheet *sheet, eval_random *r, bool is_edge)
{
    eval_slab slab = {.wall = {{0, 0, -1}, -2.0}, .centre = {0, 0, 2}, .thickness = 0.2};
    slab.half = is_edge ? rlf_vec3_make(0.012, 0.2, 0) : rlf_vec3_make(0.25, 0.5, 0);
    eval_sheet_set_slab(sheet, &slab);
    int count = 0;
    for (int i = 0; i < SLAB_THROWS; i++) {
        count += bounces(sheet, r, is_edge);
    }
    return 100.0 * count / SLAB_THROWS;
}

rlf_result eval_throw_run(eval_table *table, eval_sheet *sheet, int64_t seed)
{
    eval_random r = eval_random_start((uint64_t)seed);
    eval_sheet_set_room(sheet, room, WALLS);
    int through = 0;
    for (int i = 0; i < THROWS; i++) {
        through += tunnels(sheet, &r);
    }
    eval_table_add(table, "physics", "throw_tunnelled", "THROW: tunnelled, of 60 random throws",
                   RLF_PROFILE_LIVE, through);
    eval_table_add(table, "physics", "behind_bounced_percent", "BEHIND: bounced off a back, %",
                   RLF_PROFILE_LIVE, bounce_percent(sheet, &r, false));
    eval_table_add(table, "physics", "edge_bounced_percent", "EDGE: bounced off a book's edge, %",
                   RLF_PROFILE_LIVE, bounce_percent(sheet, &r, true));
    return RLF_OK;
}
