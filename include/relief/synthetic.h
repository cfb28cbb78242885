/* Relief: the synthetic room, a ray-cast sensor that knows the truth.
 *
 * Rooms, people and sensors can be drawn at random, see scene random. Otherwise:
 * a level depth camera (Kinect v2 intrinsics) looks into a room: wall, column, floor, table, boxes,
 * ball, chair, and a person of rounded limbs who walks and reaches. A colour camera sits 52 mm
 * beside it. Noise and dropout follow Fankhauser et al. 2015 and the libfreenect2 invalidation
 * chain. SPDX-License-Identifier: MIT */
#ifndef RELIEF_SYNTHETIC_H
#define RELIEF_SYNTHETIC_H

#include "relief/source.h"
#include "relief/synthetic_hands.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What is in the room. */
typedef enum rlf_synthetic_scene {
    RLF_SYNTHETIC_ROOM = 0,   /* everything; the person enters after the background frames */
    RLF_SYNTHETIC_EMPTY = 1,  /* the same room, nobody in it */
    RLF_SYNTHETIC_THESIS = 2, /* thesis chapter 5: wall 3.2 m, column, floor, person at 2.2-2.4 m */
    RLF_SYNTHETIC_CHAIR = 3,  /* as room; the chair is taken away at t = 4 s */
    RLF_SYNTHETIC_BOOK = 4,   /* the person holds a book edge-on, then turns it to the camera */
    RLF_SYNTHETIC_HAND = 5,   /* a hand moves close to the camera (0.6-1.2 m) */
    RLF_SYNTHETIC_LIFT = 6, /* a tray comes in, rises 0.4 m at `speed` from t = 3 s on, and stops */
    RLF_SYNTHETIC_SWIPE = 7,    /* an upright board moves 1.1 m along the floor from t = 3 s on */
    RLF_SYNTHETIC_CARRY = 8,    /* a tray comes in and moves along a circle from t = 3 s on */
    RLF_SYNTHETIC_CROSSING = 9, /* bare room; two people walk past each other, 0.8 m apart */
    RLF_SYNTHETIC_RANDOM = 10,  /* room, people, camera and sensor drawn by the seed */
    RLF_SYNTHETIC_HANDS = 11    /* hands grasp and gesture by a script: see synthetic_hands.h */
} rlf_synthetic_scene;

/* What happens in a random room instead of people who come: something that stood there since the
 * first frame is moved at `speed` from t = 3 s on. Truth has its pose from the first frame on. */
typedef enum rlf_synthetic_push {
    RLF_SYNTHETIC_PUSH_NONE = 0,
    RLF_SYNTHETIC_PUSH_LIFT = 1,  /* "plate", 0.5 x 0.024 x 0.4 m, rises by 0.4 m and stops */
    RLF_SYNTHETIC_PUSH_SWIPE = 2, /* "board", 0.024 x 0.5 x 0.4 m, upright, moves 1.1 m on the floor
                                     and stops; its frame's x axis is turned by 0.35 rad against
                                     its way, so that its pushing side shows */
    RLF_SYNTHETIC_PUSH_CARRY = 3  /* "tray", as the plate, moves along a circle of 0.25 m radius */
} rlf_synthetic_push;

/* How the camera moves. Every path begins at rest, is smooth and the same for every seed; nothing
 * is blurred. The pictures are cast anew for every frame, which costs tenths of a second; colour is
 * lit without shadows. rlf_frame.T_world_camera is the true pose, the world is the first camera's
 * frame, and all truth is in the frame of the camera as it stands at that frame. Rooms but thesis
 * and random get walls and things to the sides and behind. OPPOSITE does not move: it is a second
 * camera of the same room, and costs and shows what a camera at rest does. */
typedef enum rlf_synthetic_path {
    RLF_SYNTHETIC_PATH_NONE = 0,
    RLF_SYNTHETIC_PATH_ORBIT = 1,     /* about a point 2 m ahead, 29 degrees to both sides */
    RLF_SYNTHETIC_PATH_WALK = 2,      /* 1 m forward and back, with the bob of steps */
    RLF_SYNTHETIC_PATH_HANDHELD = 3,  /* sways by 0.2 m and 7 degrees, up to 6 mm a frame */
    RLF_SYNTHETIC_PATH_LOOK_AWAY = 4, /* as handheld; turns by 100 degrees for 1 s at t = 2 s + 8 n
                                         and back */
    RLF_SYNTHETIC_PATH_FAST = 5,      /* shaken: up to 1.3 m/s, 100 degrees a second */
    RLF_SYNTHETIC_PATH_CARRIED = 6,   /* stands for 2 s, is carried 0.3 m in 1.5 s, and stands */
    RLF_SYNTHETIC_PATH_BUMP = 7,      /* stands for 2 s, is pushed 1 cm and 1 degree in 0.2 s, and
                                         stands */
    RLF_SYNTHETIC_PATH_OPPOSITE = 8   /* stands 5 m ahead of the camera at rest and looks back, as
                                         if the wall between them were glass */
} rlf_synthetic_path;

/* Values of rlf_truth.label. The first four are the room's shell: endlessly thick, thickness 0. */
typedef enum rlf_synthetic_label {
    RLF_SYNTHETIC_LABEL_WALL = 1,
    RLF_SYNTHETIC_LABEL_FLOOR = 2,
    RLF_SYNTHETIC_LABEL_CEILING = 3,
    RLF_SYNTHETIC_LABEL_COLUMN = 4,
    RLF_SYNTHETIC_LABEL_CUPBOARD = 5,
    RLF_SYNTHETIC_LABEL_TABLE = 6,
    RLF_SYNTHETIC_LABEL_BOX_LARGE = 7,
    RLF_SYNTHETIC_LABEL_BOX_SMALL = 8,
    RLF_SYNTHETIC_LABEL_BOX_TOP = 9,
    RLF_SYNTHETIC_LABEL_BALL = 10,
    RLF_SYNTHETIC_LABEL_CHAIR = 11,
    RLF_SYNTHETIC_LABEL_PERSON = 12, /* from here to THING: foreground */
    RLF_SYNTHETIC_LABEL_BOOK = 13,
    RLF_SYNTHETIC_LABEL_HAND = 14,
    RLF_SYNTHETIC_LABEL_TRAY = 15,
    RLF_SYNTHETIC_LABEL_SECOND_PERSON = 16, /* 17, 18: the third and fourth of a random room */
    RLF_SYNTHETIC_LABEL_THING = 32          /* from here on: what stands in a random room */
} rlf_synthetic_label;

/* Which room, and what the sensor is like. From rlf_synthetic_def_default or rlf_synthetic_parse.
 */
typedef struct rlf_synthetic_def {
    uint32_t cookie;           /* from rlf_synthetic_def_default */
    rlf_synthetic_scene scene; /* default room */
    uint64_t seed;             /* of noise and dropout, of a random room too; default 1 */
    uint64_t person;           /* who it is; default 1: an adult of 1.75 m. Every other number is
                                  someone else in size, build, clothes and pace */
    double frames_per_second;  /* default 30 */
    int64_t frame_count;       /* default 300 (10 s); -1 = endless */
    double speed;              /* of the tray, board or carrying hand, m/s, above 0, at most 10;
                                  default 0.5 */
    rlf_synthetic_push push;   /* of a random room only; default none */
    rlf_synthetic_path path;   /* of the camera; not with push; default none */
    rlf_synthetic_hands_def hands; /* of scene "hands" only */
    rlf_vec3 lamp;                 /* a wide lamp's middle, metres, camera frame, at most 20 m away;
                                      default (-0.7, -1.85, 1.5): under the ceiling, left */
    bool enable_noise; /* default true: axial noise, dropout, flying pixels, edge filter */
    bool enable_structured_light; /* default false; true: depth in steps, noise that is alike in
                                     neighbouring pixels, as a Kinect v1's; needs enable_noise */
    bool enable_edge_filter;      /* default true: the driver's invalid band at silhouettes */
    bool enable_color;            /* default true */
    bool enable_truth;            /* default true: made when it is asked for; false saves memory */
    bool opens_soon; /* default false; true: a standing camera's colour is coarse at first and a
                        band of 16 rows sharper with each frame, so that less is done before the
                        first. Depth and truth are the same */
    int32_t color_width, color_height; /* default 960 x 540; fx scales with the width */
    rlf_pool *pool;                    /* borrowed; NULL = one thread */
} rlf_synthetic_def;

/* The defaults that the fields name. */
RLF_API rlf_synthetic_def rlf_synthetic_def_default(void);

/* Opens the room: an rlf_source that can restart and seek. Same def, same bits, on every machine
 * and for every pool size. RLF_ERROR_INVALID names the def's field that is wrong; RLF_ERROR_MEMORY.
 */
RLF_API rlf_result rlf_synthetic_create(const rlf_synthetic_def *def, rlf_source **out);

/* Reads "synthetic:NAME[?key=value[&key=value...]]" into *def: NAME one of room, empty, thesis,
 * chair, book, hand, lift, swipe, carry, crossing, random, hands; keys seed, person, frames, fps,
 * speed, lamp (X,Y,Z), noise (0|1|steps), edge_filter (0|1), color (WxH or 0), push
 * (none|lift|swipe|carry), path
 * (none|orbit|walk|handheld|look_away|fast|carried|bump|opposite); of scene "hands" also
 * grasp or gesture (an act's name), view, body, distance, size and hold. A random room draws its
 * sensor and its lamp itself: of noise only 0 has an effect there. RLF_ERROR_INVALID names the part
 * that is wrong and what is allowed. */
RLF_API rlf_result rlf_synthetic_parse(const char *source, rlf_synthetic_def *def);

/* True surface point nearest along the true scene at this instant of a source made by
 * rlf_synthetic_create: signed distance from p (camera frame, metres; negative inside a solid) and
 * the outward unit normal there. For checking collisions against truth. out_normal and out_label
 * may be NULL. RLF_ERROR_INVALID when the source is not a synthetic one. */
RLF_API rlf_result rlf_synthetic_distance(rlf_source *source, rlf_vec3 p, double *out_distance,
                                          rlf_vec3 *out_normal, int32_t *out_label);

/* Truth along rays of any camera at this instant: out_distance[i] is the t > 0 at which
 * origin + t directions[i] (camera frame, metres) first meets the scene, 0 where it never does, and
 * out_label[i] (may be NULL) what it meets. With direction z = 1 and an origin at z = 0, t is the
 * depth. Rays of one call that lie close together are cheaper. For checking pictures against truth.
 * RLF_ERROR_INVALID when the source is not a synthetic one. */
RLF_API rlf_result rlf_synthetic_cast(rlf_source *source, rlf_vec3 origin,
                                      const rlf_vec3 *directions, int32_t count,
                                      float *out_distance, int32_t *out_label);

/* Unit vector towards the floor, frame of the camera as it stands now: (0, 1, 0) but in random
 * rooms, whose cameras are tilted, and on a path. RLF_ERROR_INVALID when the source is not a
 * synthetic one. */
RLF_API rlf_result rlf_synthetic_get_down(const rlf_source *source, rlf_vec3 *out);

/* What rlf_synthetic_nearest found. */
typedef struct rlf_synthetic_hit {
    double distance;   /* metres, negative inside a solid */
    rlf_vec3 normal;   /* unit, out of the solid, at its point nearest to p */
    rlf_vec3 velocity; /* of that point, m/s */
    int32_t label;     /* rlf_synthetic_label */
} rlf_synthetic_hit;

/* As rlf_synthetic_distance at any time (seconds since the source's first frame, >= 0), with the
 * velocity: the true scene between two frames. RLF_ERROR_INVALID when the source is not a synthetic
 * one. Thread-safety: as rlf_source_next. */
RLF_API rlf_result rlf_synthetic_nearest(rlf_source *source, double time_s, rlf_vec3 p,
                                         rlf_synthetic_hit *out);

#ifdef __cplusplus
}
#endif
#endif
