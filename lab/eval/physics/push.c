/* LIFT: a plate rises under a resting body and stops. SWIPE: a board is swept through one. */
#include "eval/physics/experiments.h"
#include "eval/physics/sheet.h"
#include "eval/physics/world.h"
#include "eval/table.h"

#define FRAME_S (1.0 / 30)
#define HALF 0.05 /* m, of the bodies: from the centre to what they stand on */
#define SHAPES 3
#define SPEEDS 4

static const double speeds[SPEEDS] = {0.25, 0.5, 1.0, 2.0};

static const rlf_vec3 FLOOR_NORMAL = {0, -1, 0}, WALL_NORMAL = {0, 0, -1};

/* Box, ball, and a three-sided prism that lies on a face. */
static rlf_body_def body_of(int shape)
{
    static const rlf_vec3 corners[6] = {{0.06, HALF, 0},      {-0.03, HALF, 0.05},
                                        {-0.03, HALF, -0.05}, {0.06, -HALF, 0},
                                        {-0.03, -HALF, 0.05}, {-0.03, -HALF, -0.05}};
    static const int32_t triangles[24] = {0, 2, 1, 3, 4, 5, 0, 1, 4, 0, 4, 3,
                                          1, 2, 5, 1, 5, 4, 2, 0, 3, 2, 3, 5};
    static const rlf_hull prism = {corners, 6, triangles, 8};
    static const rlf_shape_type types[SHAPES] = {RLF_SHAPE_BOX, RLF_SHAPE_SPHERE, RLF_SHAPE_HULL};
    rlf_body_def def = rlf_body_def_default();
    def.shape.type = types[shape];
    def.shape.radius = HALF;
    def.shape.hull = &prism;
    def.restitution = 0.2;
    return def;
}

static rlf_world *open_world(int shape, rlf_vec3 position)
{
    rlf_world *world = eval_world_open(RLF_PHYSICS_LIVE, rlf_vec3_make(0, 9.81, 0), 1);
    rlf_body_def def = body_of(shape);
    def.position = position;
    if (world != NULL && rlf_world_add_body(world, &def, NULL) != RLF_OK) {
        rlf_world_destroy(&world);
    }
    return world;
}

/* Shows the slab, lets a frame pass, and tells where the body is. */
static rlf_vec3 advance(eval_sheet *sheet, rlf_world *world, const eval_slab *slab)
{
    eval_sheet_set_slab(sheet, slab);
    rlf_world_advance(world, &sheet->grid, FRAME_S);
    return eval_world_body(world, 0)->T_world_body.p;
}

static eval_slab plate(double y, double rising)
{
    eval_slab slab = {.wall = {FLOOR_NORMAL, -y},
                      .centre = {0, y, 2},
                      .half = {0.2, 0, 0.2},
                      .thickness = 0.05,
                      .velocity = {0, -rising, 0}};
    return slab;
}

/* Rests, is lifted by 0.3 m, and the plate stops: it stayed on, is not inside, and leaves with at
 * least 90 % of the plate's speed. */
static bool lifts(eval_sheet *sheet, int shape, double speed)
{
    double y = 0.8, gap = 1.0, deepest = 0.0, peak = 0.0;
    rlf_world *world = open_world(shape, rlf_vec3_make(0.01, y - HALF, 2.01));
    if (world == NULL) {
        return false;
    }
    eval_slab slab = plate(y, 0.0);
    for (int k = 0; k < 20; k++) {
        advance(sheet, world, &slab);
    }
    for (int k = 0; k < (int)(0.3 / (speed * FRAME_S) + 0.5); k++) {
        y -= speed * FRAME_S;
        slab = plate(y, speed);
        deepest = rlf_min(deepest, y - advance(sheet, world, &slab).y - HALF);
    }
    double leaving = -eval_world_body(world, 0)->velocity.y;
    slab = plate(y, 0.0);
    for (int k = 0; k < 30; k++) {
        gap = y - HALF - advance(sheet, world, &slab).y;
        peak = rlf_max(peak, gap);
    }
    rlf_world_destroy(&world);
    bool is_on = gap > -0.003 && gap < 0.01 + peak;
    return is_on && deepest > -0.005 && leaving > 0.9 * speed;
}

/* A board that moves along `axis` (0 = x, 2 = z) from `from` towards `to`. */
typedef struct sweep {
    eval_slab slab;
    int axis;
    double from, to;
    double behind; /* where the board's far side is from its front, along the axis */
    double start;  /* the body's place on the axis */
} sweep;

/* The body never gets behind the side that hits it, and is moved by 10 cm at least. */
static bool sweeps(eval_sheet *sheet, const sweep *s, int shape, double speed)
{
    rlf_vec3 position = rlf_vec3_make(0.01, 1.15, 3.2);
    rlf_world *world = open_world(shape, position);
    if (world == NULL) {
        return false;
    }
    double direction = s->to > s->from ? 1.0 : -1.0, at = s->from, ahead = 1.0, moved = 0.0;
    eval_slab slab = s->slab;
    double *const velocity = s->axis == 0 ? &slab.velocity.x : &slab.velocity.z;
    *velocity = direction * speed;
    while ((s->to - at) * direction > 0.0) {
        at += direction * speed * FRAME_S;
        if (s->axis == 0) {
            slab.centre.x = at;
        } else {
            slab.centre.z = at;
            slab.wall.d = -at;
        }
        rlf_vec3 p = advance(sheet, world, &slab);
        double place = s->axis == 0 ? p.x : p.z;
        ahead = rlf_min(ahead, direction * (place - at - s->behind));
        moved = direction * (place - s->start);
    }
    rlf_world_destroy(&world);
    return ahead > 0.0 && moved > 0.1;
}

rlf_result eval_push_run(eval_table *table, eval_sheet *sheet)
{
    const eval_wall room[2] = {{FLOOR_NORMAL, -1.2}, {WALL_NORMAL, -5.0}};
    const eval_slab across = {{WALL_NORMAL, -3.0}, {0, 1.1, 3.0}, {0.3, 0.12, 0}, 0.04, {0, 0, 0}};
    const eval_slab edge_on = {
        {WALL_NORMAL, -3.1}, {0, 1.1, 3.1}, {0.015, 0.12, 0}, 0.2, {0, 0, 0}};
    const sweep ways[3] = {{across, 2, 2.8, 3.8, 0.04, 3.2},    /* away: its unseen back hits */
                           {across, 2, 3.6, 2.8, 0.0, 3.2},     /* near: its seen front */
                           {edge_on, 0, -0.4, 0.4, 0.0, 0.01}}; /* sideways: its silhouette */
    eval_sheet_set_room(sheet, room, 2);
    int lifted = 0, swept = 0;
    for (int shape = 0; shape < SHAPES; shape++) {
        for (int i = 0; i < SPEEDS; i++) {
            lifted += lifts(sheet, shape, speeds[i]);
            for (int w = 0; w < 3; w++) {
                swept += sweeps(sheet, &ways[w], shape, speeds[i]);
            }
        }
    }
    eval_table_add(table, "physics", "lift_count", "LIFT: carried and thrown, of 12",
                   RLF_PROFILE_LIVE, lifted);
    eval_table_add(table, "physics", "swipe_count", "SWIPE: pushed, none passed, of 36",
                   RLF_PROFILE_LIVE, swept);
    return RLF_OK;
}
