/* What stands in the room, and who moves in it. */
#ifndef RLF_SIM_SCENE_H
#define RLF_SIM_SCENE_H

#include "sim/figure.h"
#include "sim/shape.h"
#include "relief/synthetic.h"

#define SYNTH_PART_MAX 224 /* of the room, and of the movers */

typedef enum synth_pattern {
    SYNTH_PLAIN = 0,
    SYNTH_WOOD,
    SYNTH_STRIPES,
    SYNTH_CHECKS,
    SYNTH_SPECKLE, /* carpet, plaster, wool */
    SYNTH_PRINT,   /* blots of a second colour: a rug, a picture, a printed shirt */
    SYNTH_PATTERN_COUNT
} synth_pattern;

/* What a drawn part looks like; linear colours, 0..1. */
typedef struct synth_look {
    rlf_vec3 color, second;
    synth_pattern pattern;
    double size;       /* of the pattern's cell, metres */
    float reflectance; /* of infrared light, 0..1 */
    float texture;     /* 0..1: how much a stereo camera finds to match */
} synth_look;

struct synth_random;
struct synth_hands;

typedef struct synth_part {
    synth_shape shape;
    const char *name;
    int32_t label; /* rlf_synthetic_label */
    synth_material material;
    synth_look look;           /* of a drawn part; of a face its skin, where it is not black */
    rlf_vec3 velocity;         /* of the shape's origin, m/s, camera frame */
    rlf_vec3 angular_velocity; /* rad/s, camera frame */
} synth_part;

/* A ball that holds a part. */
typedef struct synth_ball {
    rlf_vec3 centre;
    double radius;
} synth_ball;

typedef struct synth_scene {
    rlf_synthetic_scene kind;
    double floor_y;      /* height of the camera above the floor, metres */
    rlf_vec3 down;       /* unit, towards the floor, camera frame */
    double speed;        /* of the tray, m/s */
    rlf_vec3 lamp;       /* middle of the lamp, camera frame */
    double removal_time; /* s; when the last parts of the room are taken away; 0 = never */
    synth_part statics[SYNTH_PART_MAX];
    synth_ball bounds[SYNTH_PART_MAX]; /* of the statics, see synth_scene_bound */
    int32_t static_count;              /* at start */
    int32_t removed_count;             /* so many of the last statics go at removal_time */
    synth_part movers[SYNTH_PART_MAX];
    int32_t mover_count;
    synth_figure person, second; /* the second is in scene "crossing" */
    bool is_moving; /* the camera moves: the room is lit without shadows, cast for every frame */
    const struct synth_random *random; /* borrowed: a room drawn at random; NULL in the others */
    const struct synth_hands *hands;   /* borrowed: of scene "hands"; NULL in the others */
    const rlf_quat *q_camera_level;    /* borrowed: a camera that is tilted; NULL = it is level */
} synth_scene;

/* A scene with a tray, see tray.c. */
static inline bool synth_has_tray(rlf_synthetic_scene kind)
{
    return kind == RLF_SYNTHETIC_LIFT || kind == RLF_SYNTHETIC_SWIPE || kind == RLF_SYNTHETIC_CARRY;
}

static inline bool synth_is_shell(int32_t label)
{
    return label >= RLF_SYNTHETIC_LABEL_WALL && label <= RLF_SYNTHETIC_LABEL_COLUMN;
}

/* Builds the room and names the movers; their poses are those of time 0. The person is that of seed
 * 1. */
void synth_scene_build(synth_scene *scene, rlf_synthetic_scene kind);

/* Finds the statics' bounds, once they are all there. */
void synth_scene_bound(synth_scene *scene);

/* Gives the people the figures of a seed, see figure.h, at time 0. */
void synth_scene_set_people(synth_scene *scene, uint64_t seed);

/* Number of static parts that are there at time t (the first ones). */
int32_t synth_scene_static_count(const synth_scene *scene, double t);

/* Moves the movers to time t, seconds since the first frame. */
void synth_scene_move(synth_scene *scene, double t);

/* Velocity of the point p that moves with the part: v + w x (p - origin). */
rlf_vec3 synth_part_velocity(const synth_part *part, rlf_vec3 p);

/* Part of parts[0..count) whose solid is nearest to p; out_normal points outwards. */
const synth_part *synth_nearest(const synth_part *parts, int32_t count, rlf_vec3 p,
                                double *out_distance, rlf_vec3 *out_normal);

#endif
