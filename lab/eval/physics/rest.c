/* Bodies that rest on a still, level floor. */
#include "eval/physics/experiments.h"
#include "eval/physics/sheet.h"
#include "eval/physics/world.h"
#include "eval/table.h"

#include <math.h>

#define FRAME_S (1.0 / 30)
#define GRAVITY 9.81
#define STACK 10
#define FRICTION 0.5
#define DEGREE (RLF_PI / 180.0)

static rlf_result run_stack(eval_table *table, eval_sheet *sheet)
{
    rlf_world *world = eval_world_open(RLF_PHYSICS_LIVE, rlf_vec3_make(0, GRAVITY, 0), STACK);
    rlf_result result = world != NULL ? RLF_OK : RLF_ERROR_MEMORY;
    for (int i = 0; i < STACK && result == RLF_OK; i++) {
        rlf_body_def def = rlf_body_def_default();
        def.position = rlf_vec3_make(0.2, 0.95 - 0.1 * i, 2.5);
        result = rlf_world_add_body(world, &def, NULL);
    }
    for (int k = 0; k < 600 && result == RLF_OK; k++) {
        sheet->grid.time_ns++;
        rlf_world_advance(world, &sheet->grid, FRAME_S);
    }
    double drift = 0.0, deepest = 0.0;
    for (int i = 0; i < STACK && result == RLF_OK; i++) {
        rlf_vec3 p = eval_world_body(world, i)->T_world_body.p;
        double under = i == 0 ? 1.0 : eval_world_body(world, i - 1)->T_world_body.p.y - 0.05;
        deepest = rlf_max(deepest, p.y + 0.05 - under);
        drift = rlf_max(drift, hypot(p.x - 0.2, p.z - 2.5));
    }
    if (result == RLF_OK) {
        eval_table_add(table, "physics", "stack_drift_mm", "stack of 10 cubes, 20 s: drift, mm",
                       RLF_PROFILE_LIVE, 1e3 * drift);
        eval_table_add(table, "physics", "stack_penetration_mm",
                       "stack of 10 cubes, 20 s: penetration, mm", RLF_PROFILE_LIVE, 1e3 * deepest);
    }
    rlf_world_destroy(&world);
    return result;
}

/* A cube on the floor under a tilted gravity, after `frames`: how far it slid and how fast it is.
 */
static rlf_result slide(const eval_sheet *sheet, double slope, int frames, double *out_m,
                        double *out_speed)
{
    rlf_vec3 gravity = rlf_vec3_make(GRAVITY * sin(slope), GRAVITY * cos(slope), 0);
    rlf_world *world = eval_world_open(RLF_PHYSICS_LIVE, gravity, 1);
    rlf_body_def def = rlf_body_def_default();
    def.friction = FRICTION;
    def.position = rlf_vec3_make(-0.5, 0.95, 2.5);
    if (world == NULL || rlf_world_add_body(world, &def, NULL) != RLF_OK) {
        rlf_world_destroy(&world);
        return RLF_ERROR_MEMORY;
    }
    for (int k = 0; k < frames; k++) {
        rlf_world_advance(world, &sheet->grid, FRAME_S);
    }
    *out_m = fabs(eval_world_body(world, 0)->T_world_body.p.x - def.position.x);
    *out_speed = fabs(eval_world_body(world, 0)->velocity.x);
    rlf_world_destroy(&world);
    return RLF_OK;
}

/* Halves the interval in which the slope starts to slip: faster than 1 mm/s after a second. */
static rlf_result run_slope(eval_table *table, const eval_sheet *sheet)
{
    double low = 25.0, high = 28.0, slid, speed;
    while (high - low > 0.002) {
        double middle = 0.5 * (low + high);
        rlf_result result = slide(sheet, middle * DEGREE, 30, &slid, &speed);
        if (result != RLF_OK) {
            return result;
        }
        low = speed > 1e-3 ? low : middle;
        high = speed > 1e-3 ? middle : high;
    }
    rlf_result result = slide(sheet, 26.0 * DEGREE, 300, &slid, &speed);
    eval_table_add(table, "physics", "slope_error_deg", "slope at which a cube slips: error, deg",
                   RLF_PROFILE_LIVE, fabs(low - atan(FRICTION) / DEGREE));
    eval_table_add(table, "physics", "creep_mm", "slope of 26 deg, 10 s: creep, mm",
                   RLF_PROFILE_LIVE, 1e3 * slid);
    return result;
}

rlf_result eval_rest_run(eval_table *table, eval_sheet *sheet)
{
    const eval_wall room[2] = {{{0, -1, 0}, -1.0}, {{0, 0, -1}, -5.0}};
    eval_sheet_set_room(sheet, room, 2);
    rlf_result result = run_stack(table, sheet);
    return result == RLF_OK ? run_slope(table, sheet) : result;
}
