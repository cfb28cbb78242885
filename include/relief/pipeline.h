/* Relief: the frame loop. Source, surface, physics and render in one object.
 * SPDX-License-Identifier: MIT */
#ifndef RELIEF_PIPELINE_H
#define RELIEF_PIPELINE_H

#include "relief/compositor.h"
#include "relief/hands.h"
#include "relief/known.h"
#include "relief/map.h"
#include "relief/reconstruct.h"
#include "relief/source.h"
#include "relief/track.h"
#include "relief/world.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What an event of a hand does in a scene. */
typedef enum rlf_hand_action {
    RLF_HAND_ACTION_NONE = 0,
    RLF_HAND_ACTION_SPAWN = 1,  /* one more of the scene's first body, where the event is */
    RLF_HAND_ACTION_THROW = 2,  /* the same, with 3 m/s along the event's direction */
    RLF_HAND_ACTION_REMOVE = 3, /* the body that the ray of a pointing hand meets, or that is within
                                   0.25 m of another event */
    RLF_HAND_ACTION_RESET = 4,  /* all bodies as at the start */
    RLF_HAND_ACTION_COUNT = 5
} rlf_hand_action;

/* Bodies and gravity to start with; see io.h for reading one from scene.json. */
typedef struct rlf_scene {
    rlf_vec3 gravity;      /* m/s^2, world */
    bool is_gravity_given; /* the scene's file says what gravity is; else it is the default */
    /* True: gravity is turned away from where the first frame's floors, tables and walls say that
     * up is (rlf_surface_find_up), and keeps its strength. Where they are not sure the next nine
     * frames are asked, too, and the surest answer counts; if that is still not sure, a warning
     * says so. Where there is nothing to ask it stays as it is. */
    bool finds_gravity;
    rlf_body_def *bodies;      /* owned when made by rlf_scene_create or rlf_scene_load, with their
                                  hulls, of which each is that of bodies in a row */
    int32_t body_count;        /* 0 = no bodies */
    rlf_border border;         /* what is beyond the camera's view; default extend */
    rlf_known_def *known;      /* models of real things; owned as the bodies are */
    int32_t known_count;       /* at most RLF_KNOWN_MAX */
    struct rlf_model **models; /* what the bodies' looks borrow; owned as the bodies are */
    int32_t model_count;       /* 0 = none */
    rlf_hand_action on[RLF_HAND_EVENT_COUNT]; /* by rlf_hand_event_kind; default: none */
} rlf_scene;

/* Most models of real things in one scene. */
#define RLF_KNOWN_MAX 64

/* The thesis's two cubes: one thrown from the camera, one from the right. *out owns its arrays:
 * destroy it. RLF_ERROR_MEMORY. */
RLF_API rlf_result rlf_scene_create_two_cubes(rlf_scene *out);
/* Frees what the scene owns and zeroes it. NULL and a zeroed scene are allowed. Worlds that borrow
 * its hulls and models must be gone; a pipeline has copies of its own. */
RLF_API void rlf_scene_destroy(rlf_scene *scene);

/* A stage of the caller's own between surface and physics: returns what physics and the picture get
 * in place of `sensed`; both stay as they are until the next call. NULL = it failed, and the step
 * with it: RLF_ERROR_INVALID. */
typedef const rlf_surface *(*rlf_surface_fn)(void *context, const rlf_surface *sensed);

/* Whether the camera stands. */
typedef enum rlf_camera_mode {
    RLF_CAMERA_FIXED = 0,  /* it stands; while it is moved all is one sheet at rest */
    RLF_CAMERA_MOVING = 1, /* its pose is found for each frame, against a map of the room */
    RLF_CAMERA_AUTO = 2    /* it stands; MOVING from when the view as a whole moves until it stands
                              again. Needs the adaptive background; else as FIXED */
} rlf_camera_mode;

/* Who says where a moving camera is. */
typedef enum rlf_pose_origin {
    RLF_POSES_TRACKED = 0, /* a tracker, see track.h */
    RLF_POSES_SOURCE = 1   /* the source's own poses, the first one being the mount pose; a frame
                              without one keeps the last pose and is not fused */
} rlf_pose_origin;

/* All that a pipeline is made of. From rlf_pipeline_def_default, for the settings of the stages
 * depend on profile and source; then change what shall differ. */
typedef struct rlf_pipeline_def {
    uint32_t cookie;                 /* from rlf_pipeline_def_default */
    rlf_profile profile;             /* thesis or live */
    rlf_source *source;              /* borrowed for the pipeline's life; NULL: frames are pushed */
    rlf_reconstruct_def reconstruct; /* set by rlf_pipeline_def_default from profile and source */
    rlf_world_def world; /* its capacities are raised to what the scene needs, and 256 throws */
    rlf_compositor_def compositor; /* of the soft renderer */
    const rlf_scene *scene;        /* copied; NULL = no bodies */
    bool enable_render;            /* default true; false: no picture is made */
    bool enable_hands;             /* default false; true where the scene binds their events, and
                                      where the world may grab */
    rlf_pose T_world_camera;       /* mount pose; default identity */
    rlf_camera_mode camera;        /* default fixed; what moves needs the live profile */
    rlf_pose_origin poses;         /* of a moving camera; default tracked */
    /* The room of a moving camera: borrowed for the pipeline's life and fused into. One that holds
     * blocks is a known room: the camera is looked for in it, and its world is the world. NULL
     * (default): a room of the pipeline's own, empty, made when it is needed. */
    rlf_map *map;
    /* Another camera of the same room, whose world this one shares: bodies collide with what either
     * sees, and each draws its own picture. Borrowed; it must outlive this one. Its def.world has
     * a camera_capacity for both, this def's T_world_camera says where this camera stands in that
     * world, and scene, map and a camera that moves are the other's alone. The other's step takes a
     * frame of this one's source, too, before it advances the world; frames that are pushed come
     * before that step. rlf_pipeline_redraw gives this one's picture. NULL (default): this pipeline
     * has a world of its own. */
    struct rlf_pipeline *joins;
    rlf_surface_fn replace_surface; /* default NULL: physics gets what was sensed */
    void *replace_context;          /* given to replace_surface */
    rlf_pool *pool;                 /* borrowed; NULL = one thread */
} rlf_pipeline_def;

/* Settings of a profile for a source, which must be open, since sizes and noise come from its rig.
 * The pool is borrowed; NULL = one thread. Any number of threads gives the same bits. */
RLF_API rlf_pipeline_def rlf_pipeline_def_default(rlf_profile profile, rlf_source *source,
                                                  rlf_pool *pool);

/* As rlf_pipeline_def_default for a camera that calls its program back: no source, frames come by
 * rlf_pipeline_push. The rig (copied) says what they look like; rlf_rig_default makes one. */
RLF_API rlf_pipeline_def rlf_pipeline_def_for_rig(rlf_profile profile, const rlf_rig *rig,
                                                  rlf_pool *pool);

/* Wall time of the stages of one frame, milliseconds. Capture is the wait for the source. */
typedef struct rlf_stage_times {
    double capture_ms, surface_ms, physics_ms, render_ms; /* render_ms 0 without pictures */
    double hands_ms; /* of surface_ms; 0 when no hands are looked for */
} rlf_stage_times;

/* All values of one frame; valid until the next step. */
typedef struct rlf_pipeline_output {
    int64_t frame_index;           /* 0, 1, 2, ... */
    double time_s;                 /* since the first frame */
    rlf_frame frame;               /* planes borrowed from the source */
    const rlf_surface *surface;    /* the pipeline's */
    rlf_pose T_world_camera;       /* depth camera in the world */
    const rlf_track_result *track; /* how sure a moving camera's pose is; NULL while it stands */
    /* What the map shows from there; NULL = nothing is known. */
    const rlf_prediction *room;
    const rlf_hands *hands;       /* NULL when none are looked for; see rlf_pipeline_set_hands */
    const rlf_snapshot *snapshot; /* bodies and contacts after the step */
    double gravity_confidence;    /* 0..1; below RLF_UP_SURE it is a guess; 1 when it was given */
    rlf_render_output render;     /* image.data NULL when rendering is off */
    rlf_stage_times times;        /* where its time went */
    /* From the frame's arrival at this machine to the finished picture; 0 = unknown, as of files.
     */
    double latency_ms;
    /* The camera has given no frame for a second: surface and bodies are as they were. Set by
     * rlf_pipeline_redraw. */
    bool is_stale;
} rlf_pipeline_output;

/* The frame loop. Not copied, and used from one thread at a time; any number live side by side. */
typedef struct rlf_pipeline rlf_pipeline;

/* Settings of a camera that joins the world of `first`, see rlf_pipeline_def.joins: it stands at
 * T_world_camera, and the rules for its surface and its picture are those of the first one, but for
 * the light's direction. It makes no picture unless enable_render is set. */
RLF_API rlf_pipeline_def rlf_pipeline_def_joining(rlf_pipeline *first, rlf_source *source,
                                                  const rlf_pose *T_world_camera);

/* Makes all stages and copies the scene. RLF_ERROR_INVALID names the def's field that is wrong,
 * RLF_ERROR_MEMORY; *out is then NULL. */
RLF_API rlf_result rlf_pipeline_create(const rlf_pipeline_def *def, rlf_pipeline **out);
/* Frees it with all stages and nulls the pointer. The source and the pool stay the caller's. NULL
 * and a NULL pipeline are allowed. */
RLF_API void rlf_pipeline_destroy(rlf_pipeline **pipeline);

/* Replaces the renderer (takes ownership). NULL goes back to the soft one, and so does the pipeline
 * itself, with a warning, when a renderer fails with RLF_ERROR_DEVICE. */
RLF_API rlf_result rlf_pipeline_set_compositor(rlf_pipeline *pipeline, rlf_compositor *compositor);
/* What a compositor for this pipeline must be made with. */
RLF_API rlf_compositor_def rlf_pipeline_get_compositor_def(const rlf_pipeline *pipeline);

/* Draws from a projector's lens from now on, in place of the colour camera's: RLF_VIEW_BODIES is
 * then what it has to throw on the room. The projector is a camera that shines: its intrinsics with
 * the lens, its size, and T_projector_depth, which takes points of the depth camera's frame
 * (metres) to its own. Bodies keep the scene's light, and depth alone hides them
 * (RLF_OCCLUSION_DEPTH), for the colour picture is not the projector's. Other views show the colour
 * picture as if it were. Makes a soft renderer: give a GL one again with
 * rlf_pipeline_set_compositor, of rlf_pipeline_get_compositor_def. May allocate. RLF_ERROR_INVALID
 * names what is wrong with the lens or the pose, RLF_ERROR_MEMORY: it goes on as it was. */
RLF_API rlf_result rlf_pipeline_set_projector(rlf_pipeline *pipeline, const rlf_camera *projector,
                                              const rlf_pose *T_projector_depth);

/* Draws pictures of that size from now on, e.g. half of it where a machine is too slow; 0 x 0 = the
 * colour camera's, or the projector's. Makes a soft renderer, as above. May allocate.
 * RLF_ERROR_INVALID for a size beyond RLF_IMAGE_SIZE_MAX, RLF_ERROR_MEMORY: it goes on as it was.
 */
RLF_API rlf_result rlf_pipeline_set_picture_size(rlf_pipeline *pipeline, int32_t width,
                                                 int32_t height);

/* One to four views side by side in the next pictures, each as large as the picture by itself: two
 * in a row, more in two rows. There is no matte of more than one. May allocate. */
#define RLF_PIPELINE_VIEWS 4
/* Views of the next pictures, count of them, 1 to RLF_PIPELINE_VIEWS. RLF_ERROR_INVALID for others,
 * RLF_ERROR_MEMORY when a view needs hands that cannot be had. */
RLF_API rlf_result rlf_pipeline_set_views(rlf_pipeline *pipeline, const rlf_view *views,
                                          int32_t count);
/* Where RLF_VIEW_POINTS and RLF_VIEW_MAP are seen from in the next pictures. */
RLF_API void rlf_pipeline_set_orbit(rlf_pipeline *pipeline, const rlf_orbit *orbit);
/* True: a plot of the milliseconds per stage of the last frames, with overlay lines. default false
 */
RLF_API void rlf_pipeline_set_plot(rlf_pipeline *pipeline, bool is_shown);

/* True: every view of the next pictures has its legend (rlf_view_legend) in its lower left corner.
 * default false */
RLF_API void rlf_pipeline_set_legend(rlf_pipeline *pipeline, bool is_shown);

/* View of the next pictures: a single one. RLF_VIEW_CAMERA at the start. A value that is no view
 * breaks the contract and leaves it as it was. */
RLF_API void rlf_pipeline_set_view(rlf_pipeline *pipeline, rlf_view view);
/* Overlay lines of the next pictures, copied, at most 32 of 127 bytes; a NULL line is an empty one.
 * Shown where the compositor's def enables them. */
RLF_API void rlf_pipeline_set_overlay(rlf_pipeline *pipeline, const char *const *lines,
                                      int32_t count);

/* One frame through all stages. RLF_OK, RLF_NO_FRAME, RLF_END, or an error. Allocates nothing after
 * the first frames. Two frames with the same time: the second advances physics by nothing, and so
 * does the first frame after a second in which ten or more are missing. While no frame comes
 * physics waits: bodies would rest on what may have gone meanwhile. */
RLF_API rlf_result rlf_pipeline_step(rlf_pipeline *pipeline, rlf_pipeline_output *out);
/* rlf_pipeline_step with a frame of the caller's, of the def's rig; frame->rig is not looked at.
 * Its planes are read during the call and borrowed by out->frame. RLF_ERROR_INVALID names what is
 * wrong with the frame (rlf_frame_check), or says that the pipeline has a source: the pipeline is
 * then as it was. A step of a pipeline without source gives RLF_NO_FRAME. Thread-safety: one thread
 * at a time, as all calls: a callback may push from its own thread. */
RLF_API rlf_result rlf_pipeline_push(rlf_pipeline *pipeline, const rlf_frame *frame,
                                     rlf_pipeline_output *out);
/* Draws the last frame again, e.g. after a change of view while paused. */
RLF_API rlf_result rlf_pipeline_redraw(rlf_pipeline *pipeline, rlf_pipeline_output *out);
/* Times of the surface stage's steps; see rlf_reconstruct_set_times. */
RLF_API void rlf_pipeline_set_surface_times(rlf_pipeline *pipeline, rlf_surface_times *times);
/* First frame, empty background, the scene's bodies again: as after rlf_pipeline_create, so the
 * same frames give the same bits. RLF_ERROR_UNSUPPORTED when the source cannot start again. */
RLF_API rlf_result rlf_pipeline_restart(rlf_pipeline *pipeline);
/* Adds a model of a real thing, or moves the one of that name, from the next frame on. Picked
 * pixels are looked up in the last frame: rlf_known_solve has the errors, and out_fit (may be NULL)
 * how well it fits. RLF_NO_FRAME before the first frame when there are points. The live profile
 * only. */
RLF_API rlf_result rlf_pipeline_set_known(rlf_pipeline *pipeline, const rlf_known_def *def,
                                          rlf_known_fit *out_fit);
/* The models with their poses; those with points wait for the first frame, those without pose and
 * points to be placed. Valid until the next call that changes them. */
RLF_API const rlf_known_def *rlf_pipeline_get_known(const rlf_pipeline *pipeline,
                                                    int32_t *out_count);
/* Looks for hands from the next frame on, or no longer. RLF_VIEW_HANDS and a scene that binds their
 * events turn it on by themselves. May allocate: RLF_ERROR_MEMORY. */
RLF_API rlf_result rlf_pipeline_set_hands(rlf_pipeline *pipeline, bool is_on);
/* The hands of the last frame, in the depth camera's frame; NULL when none are looked for, and
 * before the first frame. Valid until the next step. */
RLF_API const rlf_hands *rlf_pipeline_hands(const rlf_pipeline *pipeline);
/* The room of a moving camera; NULL while there is none. For questions and views between steps. */
RLF_API rlf_map *rlf_pipeline_get_map(rlf_pipeline *pipeline);
/* A surface as physics sees it, for a world of one's own and for questions (query.h): views of the
 * planes, valid as long as the surface. `regions` has room for `region_capacity` entries, and
 * further regions are left out; NULL with 0: none, which the live method does without. Until the
 * background is known all that is seen is one endlessly thick sheet. Thread-safety: safe. */
RLF_API void rlf_grid_from_surface(const rlf_surface *surface, const rlf_pose *T_world_camera,
                                   rlf_grid_region *regions, int32_t region_capacity,
                                   rlf_grid *out);
/* The world, to add or throw bodies between steps. */
RLF_API rlf_world *rlf_pipeline_get_world(rlf_pipeline *pipeline);

#ifdef __cplusplus
}
#endif
#endif
