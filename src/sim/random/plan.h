/* The drawing of a room while it is being made. Coordinates are those of the level frame: the
 * camera is the origin, y down, x and z along the walls. Heights are above the floor. */
#ifndef RLF_SIM_RANDOM_PLAN_H
#define RLF_SIM_RANDOM_PLAN_H

#include "sim/gait.h"
#include "sim/hash.h"
#include "sim/noise.h"
#include "sim/scene.h"

/* ---- random.c: A room drawn at random: what of it does not lie in the list of parts. */

#define SYNTH_PEOPLE_MAX 4
#define SYNTH_ACTS_MAX 4
#define SYNTH_CLOTHES_MAX 16 /* beside the body's own solids */
#define SYNTH_THING_MAX 16   /* parts of the thing that is moved */
#define SYNTH_SWEEP_WAY 1.1  /* metres, of a board */
#define SYNTH_CIRCLE 0.25    /* metres, radius of a tray's way */

/* Level frame: the camera is its origin, y down, x and z along the walls. */
typedef struct synth_individual {
    synth_figure figure;
    synth_flesh flesh[SYNTH_PERSON_FLESH + SYNTH_CLOTHES_MAX];
    int32_t flesh_count;
    synth_look looks[SYNTH_MATERIAL_COUNT];
    synth_act acts[SYNTH_ACTS_MAX];
    synth_script script; /* its acts are those above */
    rlf_pose T_level_path;
    int32_t label;
} synth_individual;

/* A thing that stands from the first frame on and is moved from `start` on. */
typedef struct synth_moved {
    rlf_synthetic_push push;
    synth_part parts[SYNTH_THING_MAX]; /* at rest, camera frame */
    int32_t part_count;                /* 0 = nothing is moved */
    bool is_gone;                      /* taken away at once */
    double start;                      /* s */
    double speed;                      /* m/s */
    double rise;                       /* metres, of what is lifted */
    rlf_vec3 along, up, aside;         /* unit, camera frame */
} synth_moved;

typedef struct synth_random {
    rlf_quat q_camera_level;
    double focal;        /* of the depth camera, pixels */
    double min_m, max_m; /* its range */
    rlf_depth_noise sigma;
    synth_drawn_noise noise;
    synth_individual people[SYNTH_PEOPLE_MAX];
    int32_t people_count;
    synth_moved moved;
} synth_random;

/* Draws the room of def->seed into *scene (its other fields zero) and *random, which the scene
 * keeps a pointer to. */
void synth_random_build(synth_scene *scene, synth_random *random, const rlf_synthetic_def *def);

/* The movers at time t. */
void synth_random_move(synth_scene *scene, double t);

/* ---- The plan. */

#define SYNTH_PLOTS_MAX 64
#define SYNTH_STATICS_MAX 170 /* things are added while there are fewer parts */

/* A rectangle of the floor. */
typedef struct synth_plot {
    double x0, x1, z0, z1;
} synth_plot;

/* A strip of the floor that people walk along. */
typedef struct synth_lane {
    double from_x, from_z, to_x, to_z;
} synth_lane;

/* A place on the floor; a thing's back looks along +z of its own frame. */
typedef struct synth_spot {
    double x, z, yaw;
} synth_spot;

typedef struct synth_plan {
    synth_draw draw;
    synth_scene *scene;
    synth_random *random;
    synth_plot room;
    double height;  /* of the ceiling */
    double floor_y; /* of the floor below the camera */
    bool is_crowded;
    synth_look wood, cloth, metal; /* of this room's furniture */
    synth_plot taken[SYNTH_PLOTS_MAX];
    int32_t taken_count;
    synth_lane lanes[SYNTH_PEOPLE_MAX];
    int32_t lane_count;
    int32_t label; /* given last */
} synth_plan;

/* Something being put together: its frame's origin lies `base` above the floor. */
typedef struct synth_maker {
    synth_plan *plan;
    synth_spot spot;
    double base;
    int32_t label;
} synth_maker;

/* make.c: parts at (x, height, z) of the maker's frame, metres. Box and round stand on that point,
 * the egg is about it. */
synth_maker synth_make(synth_plan *plan, synth_spot spot);
/* The same on top of another thing, as a thing of its own. */
synth_maker synth_make_on(const synth_maker *under, double x, double height, double z, double yaw);
void synth_make_box(synth_maker *m, const synth_look *look, rlf_vec3 at, rlf_vec3 size);
void synth_make_round(synth_maker *m, const synth_look *look, rlf_vec3 at, double bottom,
                      double top, double height);
void synth_make_egg(synth_maker *m, const synth_look *look, rlf_vec3 at, rlf_vec3 radii);
void synth_make_rod(synth_maker *m, const synth_look *look, rlf_vec3 from, rlf_vec3 to,
                    double radius);
/* Solid beyond the plane through (x, height, z) whose inner normal is `inwards`, level frame. */
void synth_make_plane(synth_maker *m, const synth_look *look, rlf_vec3 at, rlf_vec3 inwards);

/* place.c */
bool synth_place_is_free(const synth_plan *plan, synth_plot plot);
void synth_place_take(synth_plan *plan, synth_plot plot);
/* A free spot for something of that width and depth: along a wall or anywhere, and takes it. */
bool synth_place_at_wall(synth_plan *plan, double width, double depth, synth_spot *out);
bool synth_place_anywhere(synth_plan *plan, double width, double depth, synth_spot *out);
/* Distance of (x, z) from the lane, metres. */
double synth_place_from_lane(const synth_lane *lane, double x, double z);
/* Whether the depth camera sees (x, height, z), `margin` metres inside its picture; < 0: outside.
 */
bool synth_place_is_seen(const synth_plan *plan, rlf_vec3 at, double margin);

/* looks.c */
synth_look synth_look_wood(synth_draw *d);
synth_look synth_look_cloth(synth_draw *d);
synth_look synth_look_paint(synth_draw *d); /* smooth: nothing to match */
synth_look synth_look_any(synth_draw *d);
synth_look synth_look_plain(rlf_vec3 color, double reflectance, double texture);

/* What stands in the room. */
void synth_draw_camera(synth_plan *plan, bool is_pushed);
void synth_draw_device(synth_plan *plan, uint64_t seed);
void synth_draw_shell(synth_plan *plan);
void synth_draw_people(synth_plan *plan, uint64_t seed);
void synth_draw_clothes(synth_individual *person, synth_draw *d);
void synth_draw_furniture(synth_plan *plan);
void synth_draw_clutter(synth_maker *top, double width, double depth, int32_t count);
bool synth_draw_table(synth_plan *plan);
bool synth_draw_seat(synth_plan *plan, int32_t kind);
bool synth_draw_storage(synth_plan *plan, int32_t kind);
bool synth_draw_loose(synth_plan *plan, int32_t kind);
/* False when there is no place for it in view. */
bool synth_draw_push(synth_plan *plan, const rlf_synthetic_def *def);
/* Something that is taken away or lifted, in some rooms. */
void synth_draw_moved(synth_plan *plan);
/* What is moved was taken out of the room; as its last parts it stands in it until it starts. */
void synth_draw_put_back(synth_plan *plan);

#endif
