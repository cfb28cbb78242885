/* The surface stage's own state: grid, ring of published surfaces, background, work memory. */
#ifndef RLF_SURFACE_STAGE_H
#define RLF_SURFACE_STAGE_H

#include "relief/reconstruct.h"

#include "kernel/kernel.h"

/* The planes of a grid that every step reads. */
typedef struct rlf_grid {
    int32_t width, height, count;
    int32_t factor;
    rlf_camera camera;
    const float *ray_x, *ray_y;
    const uint8_t *has_ray;
} rlf_grid;

/* Pixels x0 <= x < x1 of one row. */
typedef struct rlf_span {
    int32_t x0, x1;
} rlf_span;

/* The smallest that holds both. */
static inline rlf_span rlf_span_unite(rlf_span a, rlf_span b)
{
    if (a.x0 >= a.x1 || b.x0 >= b.x1) {
        return a.x0 >= a.x1 ? b : a;
    }
    const rlf_span both = {a.x0 < b.x0 ? a.x0 : b.x0, a.x1 > b.x1 ? a.x1 : b.x1};
    return both;
}

/* The buffers of one published surface. */
typedef struct rlf_slot {
    rlf_surface surface;
    float *depth;
    float *normal[3];
    float *velocity[3];
    float *thickness;
    int32_t *label;
    uint8_t *reason, *foreground;
    rlf_span *moved; /* per row, where the velocity planes were written */
    rlf_span *thick; /* the same of thickness */
    rlf_region *regions;
    int32_t *region_points;
    int32_t foreground_region_first, foreground_region_count; /* in regions */
} rlf_slot;

/* One published state of the background. It never changes while a surface refers to it. */
typedef struct rlf_sheet {
    float *depth;
    float *normal[3];
    int32_t *label;
    rlf_region *regions;
    int32_t *region_points;
    int32_t region_count, point_count;
    int32_t version;
} rlf_sheet;

/* Surfaces refer to at most RLF_RECONSTRUCT_SURFACES sheets while the next one is made. */
enum { RLF_SHEETS = RLF_RECONSTRUCT_SURFACES + 1 };

/* A sheet is made in tiles of so many pixels on a side. */
enum { RLF_SHEET_TILE = 104 };

/* Pixels x0 <= x < x1, y0 <= y < y1. */
typedef struct rlf_rect {
    int32_t x0, y0, x1, y1;
} rlf_rect;

/* At most so many pieces of the background are looked at. */
enum { RLF_PIECES = 255 };

/* The thickness of static things: see thickness/static.h; NULL planes when it is not wanted. */
typedef struct static_thickness {
    float *depth, *thickness;        /* planes: what is fitted in this round, and found */
    float *done_depth, *done;        /* the same of the last round that came to its end */
    float *published[RLF_SHEETS];    /* planes: `done` where the newest sheet has that depth */
    uint8_t *piece;                  /* plane: of which piece; 0 = of none */
    rlf_rect window[RLF_PIECES + 1]; /* of each piece, from 1; empty = it is not looked at */
    int32_t piece_count, next_piece; /* next_piece 0: they are still being found ... */
    int32_t step;                    /* ... in this step */
    bool is_round;                   /* one goes on */
    int32_t rounds, round_age;       /* begun so far, up to a few; frames since the last began */
    int32_t newest;                  /* of `published`; -1 = none */
    int32_t publications;            /* so far; never less than before */
    int32_t sheet_version;           /* of the sheet that it was published for */
    int32_t changed;                 /* pixels of that sheet that are not as they were fitted */
} static_thickness;

/* What starts to move out of the background: see background/depart.c; NULL planes when things are
 * not known. */
typedef struct rlf_depart {
    uint8_t *thing; /* plane: of which of the background's things; 0 = of none */
    float *depth;   /* plane: of it as it stood */
    uint8_t *left;  /* plane: 1 where the mean is of something that moves: no background */
    rlf_rect extent[RLF_PIECES + 1]; /* of each thing, from 1 ... */
    int32_t size[RLF_PIECES + 1];    /* ... and its pixels */
    bool is_urgent;                  /* something has left in this frame */
} rlf_depart;

/* The background model. AVERAGE: mean holds sums until it is ready. */
typedef struct rlf_background {
    float *mean;
    float *deviation;     /* ADAPTIVE: mean absolute difference from the mean */
    uint8_t *weight;      /* samples in the mean */
    uint8_t *beyond;      /* ADAPTIVE: frames in a row that saw past the mean */
    uint8_t *absent;      /* ADAPTIVE: share of the frames without depth, of 255 */
    uint8_t *unknown_age; /* ADAPTIVE: frames in a row that a hole had a background sample */
    float *still;         /* ADAPTIVE: depth of what stands in front */
    uint16_t *still_ms;   /* ADAPTIVE: how long it has not moved */
    float *beneath;       /* ADAPTIVE: the background that an absorbed thing hides; 0 = none */
    rlf_span *standing;   /* ADAPTIVE: per row, where still_ms is not 0 */
    uint32_t *color;      /* see segment/color.c; 0 = not seen */
    uint8_t *hides;       /* ADAPTIVE: per row, whether there is anything beneath */
    int32_t frames;
    int32_t *row_changes; /* ADAPTIVE: pixels replaced in this frame, per row and tile column */
    int32_t *changes;     /* per tile: pixels replaced since it was made */
    int32_t changed;      /* their sum */
    uint8_t *age;         /* per tile: frames since it was made of new pixels */
    uint8_t *is_better;   /* per tile: 1 when its means are better than when it was made */
    int32_t *version;     /* per tile: of the sheet that it was made for */
    int32_t next_version; /* of the next sheet */
    int32_t sheet_age;    /* frames since the newest sheet was finished */
    bool is_drafting;     /* the next sheet is being made, */
    bool is_made;         /* every tile of it is, */
    int32_t object_steps; /* and so many steps to its regions are done */
    rlf_background_state state;
    rlf_sheet sheets[RLF_SHEETS];
    int32_t newest;       /* sheet; -1 = none */
    bool is_stale;        /* the newest sheet shows a room that is gone */
    int32_t other_frames; /* ADAPTIVE: frames in a row that showed another room */
    static_thickness thick;
    rlf_depart depart;
} rlf_background;

enum { RLF_SETTLE_MOST_VOTES = 32 }; /* a second: as long may what was stay */

/* The normal that most frames agree on at a pixel that is watched: see normals/settle.c. */
typedef struct rlf_settled {
    float normal[3], depth;
    float own[3];  /* what the newest frame found where it was overruled */
    int32_t votes; /* 0 = no normal yet */
} rlf_settled;

/* How much of the noise stays in any mean: see normals/lasting.c. */
enum { RLF_LASTING_BINS = 64, RLF_LASTING_ALL = 1000 };

typedef struct rlf_lasting {
    float sigma;                     /* of inverse depth, 1/m; RLF_LASTING_ALL = not known yet */
    int32_t count[RLF_LASTING_BINS]; /* of windows, by what they leave */
    int32_t phase;                   /* which rows of windows are next */
    int32_t frame;                   /* since some were looked at */
} rlf_lasting;

/* Means of inverse depth over time; NULL planes when they are not wanted. */
typedef struct rlf_steady {
    float *mean, *frames;
    rlf_settled *settled; /* plane; NULL when normals at edges are not wanted */
    uint8_t *mark;        /* plane: not 0 where one is watched, see normals/settle.c */
    uint8_t *overruled;   /* plane: not 0 where the newest frame's own normal is another */
    uint8_t *calm;     /* per block of RLF_HOLD_BLOCK pixels, frames since something moved there */
    uint8_t *restless; /* per block: 1 where it, or one beside it, is not calm */
    int32_t age;       /* frames that were averaged, up to 255 */
    rlf_lasting lasting;
} rlf_steady;

/* Coarser pictures of a frame, each of half the resolution of the one before: see normals/wide.c.
 */
enum { RLF_WIDE_LEVELS = 2 };

/* Planes; NULL when they are not wanted. */
typedef struct rlf_wide {
    int32_t width, height;
    float *ray_x, *ray_y;
    float *depth, *frames, *smooth, *normal[3];
} rlf_wide;

/* Side of a block in pixels, and the frames without motion after which one is calm. */
enum { RLF_HOLD_BLOCK = 8, RLF_HOLD_CALM = 8 };

/* All memory of a stage. */
typedef struct rlf_arena {
    unsigned char *memory;
    size_t used;    /* bytes */
    int32_t blocks; /* handed out so far */
} rlf_arena;

/* A run of linked pixels of one row, the unit of segmentation. */
typedef struct rlf_run {
    int32_t x0, x1;
    int32_t component; /* > 0, 0 = none; later the number of its region */
} rlf_run;

/* Runs in raster order; row y has first[y] <= r < first[y + 1]. */
typedef struct rlf_runs {
    rlf_run *run;
    int32_t *first; /* height + 1 */
} rlf_runs;

/* A label that is in the picture or was until lately. */
typedef struct rlf_kin {
    int32_t label;
    int32_t origin; /* label of what it came out of lately; 0 = of nothing */
    rlf_aabb box;   /* where it is expected: as large as when it was last seen whole */
    rlf_vec3 velocity;
    double depth;              /* of its centroid */
    double points;             /* of it then, a little less each frame */
    int64_t age_ns, hidden_ns; /* how long it was followed; how long it has not been seen */
} rlf_kin;

typedef struct rlf_family {
    rlf_kin *kin;
    int32_t *origin; /* per region that is being named */
    int32_t count, capacity;
} rlf_family;

/* What was seen and is hidden now: see past.h. */
typedef struct rlf_past {
    uint8_t *is_ahead;    /* a bit per pixel: whether something is expected where nothing is seen */
    float *ahead;         /* plane: its depth ... */
    uint8_t *ahead_ticks; /* ... and how long it was not seen */
    int32_t *ahead_from;  /* ... and its pixel in the frame before */
    int32_t *ahead_pixel; /* where that is */
    int32_t ahead_count;
    uint8_t *lost_ticks; /* plane: how long what a gap was filled with was not seen, 1/100 s */
    int32_t *lost_from;  /* plane: its pixel in the frame before */
} rlf_past;

/* A thin flat thing that moves, as a box: see plate.h. */
typedef struct rlf_plate {
    rlf_pose pose;                  /* T_camera_plate; its face is square to z */
    double half[3];                 /* half its extents, metres */
    rlf_vec3 speed, spin;           /* m/s, rad/s */
    double doubt[9][9];             /* covariance of the pose's place and rotation and of `half` */
    double age_s, lost_s, passed_s; /* since it was found; since it was seen; how
                                       long the camera has seen past it */
} rlf_plate;

enum { RLF_PLATES = 4 };

typedef struct rlf_plates {
    rlf_plate item[RLF_PLATES];
    int32_t count;
    int32_t frame;  /* of some, see plate/find.c */
    int32_t region; /* of the foreground at which the next search begins */
} rlf_plates;

/* How the colour picture lies beside depth at edges: see color_side.c. */
typedef struct rlf_color_sum {
    double square[9], value[3]; /* normal equations of the offset */
    double agree, asked;        /* pixels */
} rlf_color_sum;

typedef struct rlf_color_side {
    rlf_image_rgba8 image; /* of the frame that is being made; data NULL = is not asked */
    bool can_tell;         /* the rig has a picture that shows what depth shows */
    float step[2][2];      /* colour pixels, of u and of v, per column and row of the grid */
    float reach;           /* colour pixels that are read about one */
    float offset[3];       /* pixels of the grid: columns, rows, and towards the nearer side */
    float trust;           /* 0..1 */
    rlf_color_sum sum;     /* of the frames before, older ones counting less */
    rlf_color_sum *part;   /* of this frame, per chunk of rows; NULL = colour is not wanted */
    int32_t parts;
} rlf_color_side;

/* What is seen of an earlier frame, see ego_motion.c. */
enum { RLF_EGO_POINTS = 640 };

typedef struct rlf_ego_point {
    rlf_vec3 point, normal;
    int32_t pixel;
} rlf_ego_point;

typedef struct rlf_ego_motion {
    rlf_ego_point points[RLF_EGO_POINTS];
    int32_t count, age;  /* age: frames since they were seen */
    rlf_pose pose, step; /* their motion since then, and that of the last frame */
    int32_t seen_frames; /* in a row in which the camera moved */
    int32_t hold;        /* frames for which it is still taken to move */
    bool moves;
} rlf_ego_motion;

/* The shadow that the sensor's projector leaves beside near things: see shadow.h. Two sides of a
 * thing: left, right. */
enum { RLF_SHADOW_BINS = 32 };

typedef struct rlf_shadow {
    float told[2][RLF_SHADOW_BINS]; /* by how many runs without depth, per baseline */
    float baseline[2];              /* metres; 0 = none there */
    bool is_known;                  /* enough was told */
    int32_t next_row;               /* the first that is asked next */
} rlf_shadow;

/* Memory that is free between steps. */
typedef struct rlf_work {
    float *depth[2];    /* planes; these, sum and component have room for RLF_CHORD_PAD */
    float *sum[2];      /* planes: velocity sums, thickness */
    float *seen;        /* plane of velocity.c; 0 between its frames */
    uint8_t *mask[2];   /* planes */
    uint32_t *color;    /* plane: of the frame, see segment/color.c */
    uint8_t *links;     /* plane of RLF_LINK_ bits */
    int32_t *component; /* plane */
    rlf_span *front;    /* per row: where the foreground may be; finished with the background */
    rlf_runs runs;      /* of the layer that was segmented last */
    int32_t *parent;    /* count + 1 */
    int32_t *size;      /* count + 1 */
    int32_t *map;       /* count + 1 */
    int32_t *vote[2];   /* count + 1 */
    float *zeros;       /* one row */
    uint8_t *ones;      /* one row */
    uint8_t *missing;   /* one row of RLF_SEEN_MISSING */
    float *zero_plane;  /* published where there is no background */
    int32_t *zero_labels;
    struct rlf_region_sum *region_sums; /* region_capacity */
    int32_t *heirs;                     /* label table of segment/region_track.c */
    float *crop[6];                     /* of background/sheet.c */
    struct rlf_cell *cells;             /* of velocity/cells.c */
    float *knot;                        /* padded plane, see thickness.h */
    float *solid[6];                    /* padded planes: own and hidden, see thickness.h */
    struct rlf_chord *chords;           /* of the lines in one direction */
    uint8_t *squares;                   /* of pixels, see thickness.h */
} rlf_work;

struct rlf_reconstruct {
    rlf_reconstruct_def def;
    rlf_grid grid;
    rlf_slot ring[RLF_RECONSTRUCT_SURFACES];
    int32_t current;          /* slot being made or last made */
    const rlf_slot *previous; /* slot of the frame before, NULL at the first */
    int32_t next_label;
    rlf_background background;
    rlf_steady steady;
    rlf_wide wide[RLF_WIDE_LEVELS];
    rlf_family family; /* of the foreground */
    rlf_past past;     /* of the foreground */
    rlf_plates plates; /* of the foreground */
    rlf_color_side side;
    struct rlf_objects *objects; /* see objects/objects.h; NULL = they are not wanted */
    rlf_ego_motion ego;
    rlf_shadow shadow;
    rlf_work work;
    bool has_color;      /* work.color holds the frame's */
    bool has_components; /* work.runs holds the front sheet's, so many: */
    int32_t component_count;
    rlf_surface_times *times; /* borrowed; NULL = not measured */
    int64_t clock_ns;         /* end of the last step that was timed */
    rlf_arena arena;
};

/* def.c */
rlf_result rlf_reconstruct_def_check(const rlf_reconstruct_def *def);

/* times.c: nanoseconds from the frame before to that of the slot, 0 to an hour: 0 at the first and
 * where time runs backwards. */
int64_t rlf_stage_elapsed_ns(const rlf_reconstruct *stage, const rlf_slot *slot);
/* Begins a frame's times; adds the time since the last call to a step. */
void rlf_stage_start_times(rlf_reconstruct *stage);
void rlf_stage_add_time(rlf_reconstruct *stage, rlf_surface_step step);

/* memory.c: allocates all buffers of a stage whose def is set; false when memory is short. */
bool rlf_stage_allocate(rlf_reconstruct *stage);
void rlf_stage_release(rlf_reconstruct *stage);

/* grid.c */
void rlf_grid_fill_rays(const rlf_grid *grid, float *ray_x, float *ray_y, uint8_t *has_ray);

/* Rows per chunk of a parallel loop: even, and a multiple of the normal tiles. */
enum { RLF_ROW_GRAIN = 16 };

#endif
