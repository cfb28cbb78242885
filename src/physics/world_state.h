/* The world object, as the files of this module see it. */
#ifndef RLF_PHYSICS_WORLD_STATE_H
#define RLF_PHYSICS_WORLD_STATE_H

#include "kernel/lanes.h"
#include "physics/body.h"
#include "physics/grid/unseen/room_planes.h"
#include "physics/grid/tiles.h"

/* Substeps between searches for pairs. */
#define PHYS_PERIOD_MAX 4

/* A contact that may touch in a substep, as the bounces and the solver see it. */
typedef struct phys_point {
    rlf_vec3 normal;
    rlf_vec3 r_a, r_b;  /* from the centres to the touching points, world; of a surface r_b is its
                           velocity, m/s */
    double separation;  /* metres at the start of the substep */
    double impulses[3]; /* of the last substep, as the contact's */
    phys_contact *contact;
    bool is_impacted; /* bounced in this substep */
} phys_point;

/* The contacts of a pair, or of a body with the surface, in a substep. */
typedef struct phys_group {
    phys_point *points;
    phys_body *a, *b; /* b NULL: surface */
    phys_stance *stance;
    int32_t point_count;
    double friction, restitution;
    double speed; /* no point of the two bodies moves faster past the other, m/s */
} phys_group;

/* The contacts of a batch's point; NULL where a lane has none. */
typedef struct phys_lane_contacts {
    phys_contact *of[RLF_LANES];
} phys_lane_contacts;

/* Groups that are solved side by side; see batch.c. */
typedef struct phys_batch {
    rlf_lane_batch lanes;
    const phys_group *groups[RLF_LANES];
    phys_lane_contacts *contacts; /* of lanes.points */
    int32_t count;
    bool resists_rolling; /* some group does */
    bool is_deep;         /* two bodies overlap so much that they are pushed apart at full speed */
    bool is_hard;         /* a blow without restitution, which no impact has answered, is in it */
    bool is_apart;        /* shares no body that moves with the batch before */
} phys_batch;

/* Two bodies whose boxes overlap. */
typedef struct phys_near {
    int32_t a, b; /* a < b */
} phys_near;

/* A body in the broad phase. */
typedef struct phys_proxy {
    rlf_vec3 centre, half;
    float ends[6];      /* of its box, see box_lanes.h */
    int32_t bin, place; /* see pair/broad_phase.c */
    bool is_there, is_idle, is_fixed;
    bool is_real, meets_bodies; /* see phys_body */
} phys_proxy;

/* Bodies that touch each other, directly or through others, and some more of the kind until there
 * is work enough; ranges of island_bodies and island_pairs. */
typedef struct phys_island {
    int32_t body_begin, body_end;
    int32_t pair_begin, pair_end;
} phys_island;

/* Two things that touched during an advance. */
typedef struct phys_touch {
    uint64_t key; /* body index, then the other: 1, 2 = the sheets, 3 + index of a body */
    rlf_body_id body, other_body;
} phys_touch;

typedef struct phys_grab phys_grab;

/* What one camera showed last. */
typedef struct phys_view {
    bool has_grid; /* whether the last advance saw one, and where its time stands */
    int64_t time_ns;
    double gap; /* s of the last one's way that was not extrapolated before this one came */
    double tau; /* s from when the grid was seen to now, negative before */
    grid_tiles foreground, background;
    const float *background_depth; /* of the last grid, and its version */
    int64_t background_version;
    rlf_pose pose;
} phys_view;

struct rlf_world {
    rlf_world_def def;
    phys_body *bodies;
    bool has_free_slot; /* bodies below body_top may have gone */
    int32_t body_top;   /* bodies beyond it were never used */

    rlf_vec3 *points;      /* of the bodies' shapes */
    phys_contact *surface; /* of the bodies */

    phys_pair *pairs, *old_pairs; /* sorted by (a, b); and the list before it */
    int32_t pair_count, pair_capacity;
    /* Of the pairs, in their order: what is read from end to end comes faster from memory. */
    phys_contact *pair_contacts, *old_pair_contacts;
    int32_t free_count;  /* so many pairs more can be kept */
    int32_t *due_pairs;  /* whose contacts are to be searched now */
    int32_t *due_bodies; /* that are to ask the surface now */
    phys_proxy *proxies; /* see pair/broad_phase.c */
    int32_t *bins;       /* where each of bin_count begins in the list of boxes; and its end */
    int32_t bin_count;
    float *box_ends;     /* of the boxes in that list; see box_lanes.h */
    int32_t *box_bodies; /* whose they are */
    int32_t *box_found;
    phys_near *near, *near_sorted;
    int32_t near_count;
    int32_t *near_begin; /* per body, and one more */

    int32_t *parent;    /* union-find over bodies */
    int32_t *island_of; /* per body */
    phys_island *islands;
    int32_t island_count;
    int32_t *island_bodies, *island_pairs;

    phys_group *groups; /* of each island, those that may touch */
    phys_point *near_points;

    phys_batch *batches; /* of each island; see batch.c */
    rlf_lane_point *batch_points;
    phys_lane_contacts *batch_contacts; /* of batch_points */
    int32_t *batch_keys, *batch_order;  /* of an island's groups */
    uint64_t *colours;                  /* per body: those of its pairs, as bits */
    rlf_lane_speed *speeds;             /* per body: its velocities while they are solved for */
    rlf_lane_speed *old_speeds;         /* ... and before */
    float *lightness;                   /* per body: mass by the one it is solved with; 1 or less */
    int32_t *busy_pass;                 /* per body: the pass in which it is to be solved again */

    double *event_times;   /* see impact/impact.c; of the groups, island by island */
    int32_t *event_counts; /* of this substep */
    int32_t *pending;      /* groups that have an event; island by island */
    int32_t *first_link;   /* first link of each body's list of groups, -1 = none */
    int32_t *next_link;    /* link 2 k is an island's k-th group as its a sees it, 2 k + 1: its b */

    phys_touch *touches, *old_touches; /* of this advance and the one before, sorted by key */
    phys_touch *unsorted_touches;      /* of this advance as they were listed */
    int32_t *touch_begin;              /* see events.c */
    int32_t touch_count, old_touch_count;
    rlf_contact_event *events; /* of this advance */
    int32_t event_count;

    phys_grab *grabs; /* as many as hands hold bodies at once */
    int32_t grab_count;
    struct phys_grab_hand *grab_hands; /* RLF_GRID_HANDS_MAX */

    rlf_contact *log; /* contacts of this frame; capacity def.contact_capacity */
    int32_t log_count;
    int64_t log_begin; /* contacts that earlier frames listed: theirs are not in this list */
    rlf_body_state *states;
    rlf_snapshot snapshot;

    rlf_world_times times; /* of this advance */

    double time; /* s */
    uint64_t frame;
    int32_t substep; /* of this advance */

    phys_view views[RLF_WORLD_CAMERAS_MAX];
    int64_t rest_version; /* while it is the same, what stays does not change under a sleeper */
    const struct rlf_map *map; /* the room as far as it is known; NULL = it is not */
    room_planes room;
    rlf_pose room_pose; /* of the grid in the world when its planes were found */
    double room_time;   /* ... and the world's time */
};

/* Gets all memory as the def asks; false when there is too little. phys_world_free gives it back.
 */
bool phys_world_allocate(rlf_world *world);
void phys_world_free(rlf_world *world);

/* Of box_ends. */
static inline int32_t phys_box_stride(const rlf_world *world)
{
    return world->def.body_capacity + RLF_BOX_LANES;
}

/* Writes the snapshot from the bodies and the contact log. */
void phys_world_publish(rlf_world *world);

/* Adds the body in the last slot to it. */
void phys_world_publish_last(rlf_world *world);

/* Lets go of bodies whose release time has come, and sets the masses of the held ones to none. */
void phys_world_release(rlf_world *world);

/* Removes bodies whose centre left the scene (Algorithm 1: "while x(t) is within the scene"). */
void phys_world_remove_strays(rlf_world *world);

/* Index of the body with that id; -1 when it is gone. */
int32_t phys_find_body(const rlf_world *world, rlf_body_id id);
/* Ends a body's sleep. */
void phys_body_wake(phys_body *body);

/* Adds the contact's impulse to the frame's contact list, with where it met. */
void phys_log_impulse(rlf_world *world, phys_contact *contact);

/* Moves the impulses that contacts have gathered to the list. */
void phys_log_contacts(rlf_world *world, phys_contact *contacts, int32_t count);

/* Lists the touches that began and ended in this advance. */
void phys_find_events(rlf_world *world);

/* One advance by each method. */
void phys_live_advance(rlf_world *world, const rlf_grid *grid, double dt);
void phys_thesis_advance(rlf_world *world, const rlf_grid *grid, double dt);

/* Whether the grid's room goes on where the camera does not look. */
static inline bool phys_world_has_room(const rlf_world *world, const rlf_grid *grid)
{
    const rlf_grid_sheet *sheet = &grid->background;
    return sheet->depth != NULL && sheet->normal_x != NULL &&
           world->def.border == RLF_BORDER_EXTEND && sheet->border == RLF_BORDER_EXTEND;
}

/* Adds the milliseconds since *clock_ns to *sum_ms and sets the clock. */
static inline void phys_clock(int64_t *clock_ns, double *sum_ms)
{
    int64_t now = rlf_clock_ns();
    *sum_ms += 1e-6 * (double)(now - *clock_ns);
    *clock_ns = now;
}

static inline rlf_body_id phys_body_id(const rlf_world *world, int32_t index)
{
    rlf_body_id id = {(uint32_t)index + 1u, world->bodies[index].generation};
    return id;
}

#endif
