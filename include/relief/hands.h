/* Relief: hands in the surface's foreground, found without training and without a skeleton.
 *
 * A hand is the end of a limb: what lies furthest along the foreground from where the limb comes
 * in, which is the picture's border or the body that it belongs to. The palm is the largest disc
 * inside that end. A model of a hand is fitted there; its fingers give tips and gestures, and how
 * well it fits, against things that are no hand, gives the confidence.
 *
 *     border            wrist      palm        tips
 *       |=================|====( centre )====< point
 *       |   arm_direction -->    direction -->
 *
 * Everything is in the depth camera's frame of the surface it was found in, metres and seconds.
 * Sources: Plagemann et al. 2010 (geodesic extrema), Melax et al. 2013 and Tagliasacchi et al. 2015
 * (fits of hands), Casiez et al. 2012 (the 1 Euro filter).
 * SPDX-License-Identifier: MIT */
#ifndef RELIEF_HANDS_H
#define RELIEF_HANDS_H

#include "relief/surface.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Most hands of one frame: those with the highest confidence are kept. */
#define RLF_HANDS_MAX 8
/* Most finger tips of one hand, the thumb's included. */
#define RLF_HAND_TIPS_MAX 5
/* Most events of one frame; more are dropped. */
#define RLF_HAND_EVENTS_MAX 32
/* Cones of a hand's shape: the palm's six, then three of each digit from its root on, the thumb
 * first. */
#define RLF_HAND_CONES 21
/* Below this confidence a thing is rather no hand: nothing is to be done by it. */
#define RLF_HAND_SURE 0.5

/* Whose hand, as its owner says. Told by where the arm comes from, so it may be wrong where arms
 * cross, and it is unknown where nothing tells. */
typedef enum rlf_hand_side {
    RLF_HAND_SIDE_UNKNOWN = 0,
    RLF_HAND_LEFT = 1,
    RLF_HAND_RIGHT = 2
} rlf_hand_side;

/* What a pixel's footprint allows to tell. A finger is 16 mm wide: with four pixels across, up
 * to 1.5 m from a Kinect v2, its tip can be seen; beyond, up to 3 m, only how large the blob is. */
typedef enum rlf_hand_detail {
    RLF_HAND_PALM_ONLY = 0, /* palm, open or closed; tip_count is 0, no pinch, no pointing */
    RLF_HAND_TIPS = 1       /* tips, pinch and pointing, too */
} rlf_hand_detail;

/* What the hand does, held against flicker: it changes when some frames in a row agree. */
typedef enum rlf_gesture {
    RLF_GESTURE_NONE = 0,  /* none of these, or it cannot be told */
    RLF_GESTURE_OPEN = 1,  /* fingers spread or stretched */
    RLF_GESTURE_FIST = 2,  /* no finger sticks out */
    RLF_GESTURE_PINCH = 3, /* thumb and another finger meet */
    RLF_GESTURE_POINT = 4  /* one finger sticks out: the index */
} rlf_gesture;

/* Name as in hands.csv and in scene files: none, open, fist, pinch, point; NULL outside. */
RLF_API const char *rlf_gesture_name(rlf_gesture gesture);

/* One hand. All numbers are finite. */
typedef struct rlf_hand {
    int32_t id; /* > 0; the same while it is seen and through gaps of 0.3 s; not used again */
    rlf_hand_side side;     /* as its owner says */
    rlf_hand_detail detail; /* what its distance allows to tell */
    double confidence;      /* 0..1 that this is a hand; see RLF_HAND_SURE */
    int64_t age_ns;         /* since it was first seen */

    rlf_vec3 palm;          /* middle of the palm, on the seen surface, metres; smoothed */
    rlf_vec3 velocity;      /* of the palm, m/s; 0 in the first frame */
    rlf_vec3 normal;        /* of the seen side of the palm: unit, towards the camera */
    rlf_vec3 direction;     /* from the wrist to the fingers: unit, across the normal */
    rlf_vec3 arm_direction; /* along the forearm towards the hand: unit */
    double palm_radius;     /* of the largest disc inside, metres */

    int32_t tip_count;               /* 0..RLF_HAND_TIPS_MAX */
    rlf_vec3 tip[RLF_HAND_TIPS_MAX]; /* on the seen surface at the ends of fingers that stick out,
                                        metres, from the thumb to the little finger; of a hand
                                        that points the index first */

    rlf_gesture gesture; /* what it does, held against flicker */
    /* Between the two fingers that pinch, metres; when gesture is not PINCH: where they would. */
    rlf_vec3 pinch_point;
    /* Gap between thumb and index, metres: 0 while they touch, < 0 = not known. */
    double pinch_width;
    /* Of a hand that points: the ray begins at `tip[0]` and goes along this; unit. Of others it is
     * `direction`. */
    rlf_vec3 point_direction;

    /* Its skin, hidden sides too, as the fit of this frame has it; where there is none, zeros. */
    bool is_shape_sure;                   /* the fit is right in nine of ten frames */
    rlf_vec3 facing;                      /* out of the palm: unit */
    rlf_round_cone shape[RLF_HAND_CONES]; /* metres */

    uint64_t holding; /* the body that it holds: its id's index1, and generation << 32; 0 = none.
                         Filled by the pipeline; the tracker leaves 0 */
} rlf_hand;

/* What has just begun or ended. */
typedef enum rlf_hand_event_kind {
    RLF_HAND_EVENT_PINCH_BEGIN = 0,
    RLF_HAND_EVENT_PINCH_END = 1,
    RLF_HAND_EVENT_OPEN = 2,        /* the gesture became open */
    RLF_HAND_EVENT_FIST = 3,        /* the gesture became a fist */
    RLF_HAND_EVENT_POINT_BEGIN = 4, /* with the ray: position, direction */
    RLF_HAND_EVENT_POINT_END = 5,
    RLF_HAND_EVENT_PUSH = 6,        /* the palm went along its arm, fast, and stopped */
    RLF_HAND_EVENT_SWIPE_LEFT = 7,  /* as the camera sees it */
    RLF_HAND_EVENT_SWIPE_RIGHT = 8, /* as the camera sees it */
    RLF_HAND_EVENT_WAVE = 9,        /* to and fro three times, not going away */
    RLF_HAND_EVENT_COUNT = 10
} rlf_hand_event_kind;

/* Name as in a scene file's "on": pinch, pinch_end, open, fist, point, point_end, push, swipe_left,
 * swipe_right, wave; NULL outside. */
RLF_API const char *rlf_hand_event_name(rlf_hand_event_kind kind);
/* Event of such a name. False, and *out as it was, when there is none. */
RLF_API bool rlf_hand_event_parse(const char *name, rlf_hand_event_kind *out);

/* One event. It tells of the frame in which it was recognised. */
typedef struct rlf_hand_event {
    rlf_hand_event_kind kind; /* what began or ended */
    int32_t hand;             /* id */
    rlf_vec3 position;        /* pinch point, finger tip of point, else the palm; metres */
    rlf_vec3 direction;       /* of the ray for point, else of the motion or of the hand; unit */
    rlf_vec3 velocity;        /* of the palm, m/s */
} rlf_hand_event;

/* The hands of one frame, beside its surface. */
typedef struct rlf_hands {
    uint64_t sequence;                         /* of the surface */
    int64_t time_ns;                           /* device time of the surface */
    int32_t count;                             /* 0..RLF_HANDS_MAX */
    rlf_hand hand[RLF_HANDS_MAX];              /* in the order of their ids */
    int32_t event_count;                       /* 0..RLF_HAND_EVENTS_MAX */
    rlf_hand_event event[RLF_HAND_EVENTS_MAX]; /* of this frame, hand by hand */
    /* Which pixel of the surface's grid belongs to which hand: 1 + its index in `hand`, else 0.
     * width * height values; the tracker's, valid until its next update or its end. */
    const uint8_t *owner;
    int32_t width, height; /* of owner: the surface's grid */
} rlf_hands;

/* What a tracker is made for. From rlf_hand_tracker_def_default. */
typedef struct rlf_hand_tracker_def {
    uint32_t cookie;       /* from rlf_hand_tracker_def_default */
    int32_t width, height; /* of the surface's grid; > 0 */
    /* Smoothing of what stands still: cut-off frequency, Hz, > 0. Higher trembles more. default 1.
     */
    double smooth_hz;
    /* How much speed opens the filter: Hz per (m/s), >= 0. Higher lags less. default 20. */
    double smooth_opening;
} rlf_hand_tracker_def;

/* All at the defaults that the fields name, for a grid of this size. */
RLF_API rlf_hand_tracker_def rlf_hand_tracker_def_default(int32_t width, int32_t height);

/* Finds hands and follows them. Thread-safety: one call at a time per tracker. */
typedef struct rlf_hand_tracker rlf_hand_tracker;

/* Takes all the memory that it will ever need. RLF_ERROR_INVALID names the def's field that is
 * wrong; RLF_ERROR_MEMORY. */
RLF_API rlf_result rlf_hand_tracker_create(const rlf_hand_tracker_def *def, rlf_hand_tracker **out);
/* Frees it and nulls the pointer. NULL and a NULL tracker are allowed. */
RLF_API void rlf_hand_tracker_destroy(rlf_hand_tracker **tracker);
/* Tells where down is, in the camera's frame, from the next update on: any length; 0 = not known.
 * What stands on the floor under a body is a foot and no hand; without `down` that is not told.
 * Created for a level camera: (0, 1, 0). */
RLF_API void rlf_hand_tracker_set_down(rlf_hand_tracker *tracker, rlf_vec3 down);
/* The hands of this surface, which must have the def's size; borrowed for the call. Allocates
 * nothing. Same surfaces in the same order give the same bits. What it returns is the tracker's and
 * valid until the next call; NULL only for a broken contract. A surface of a moving camera, whose
 * foreground is empty, gives no hands. */
RLF_API const rlf_hands *rlf_hand_tracker_update(rlf_hand_tracker *tracker,
                                                 const rlf_surface *surface);
/* Forgets all hands, as after create. Ids begin at 1 again. */
RLF_API void rlf_hand_tracker_reset(rlf_hand_tracker *tracker);

#ifdef __cplusplus
}
#endif
#endif
