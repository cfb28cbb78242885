/* Everything a subcommand opens to run frames: pool, source, scene and pipeline. */
#ifndef RELIEF_APP_SESSION_H
#define RELIEF_APP_SESSION_H

#include "relief/playback.h"
#include "recorder.h"
#include "relief/io.h"
#include "settings.h"

typedef struct session_options {
    const char *source;
    rlf_scene *scene;       /* taken over (emptied) when not NULL; else the file below */
    const char *scene_path; /* NULL = the default scene below */
    bool use_default_scene; /* the thesis's two cubes when there is no scene_path */
    rlf_profile profile;
    int32_t scale_factor;  /* 0 = the profile's */
    setting_list settings; /* in place of the profile's */
    int32_t thread_count;  /* 0 = all processors */
    bool is_gravity_set;   /* else the scene's; the default of all sources but the synthetic room is
                              the floor's */
    bool finds_gravity;
    rlf_vec3 gravity;
    bool is_occlusion_set; /* else the profile's */
    rlf_occlusion occlusion;
    bool is_light_set; /* else the compositor's */
    rlf_vec3 light_direction;
    /* Bodies lit as the camera's picture is: always, never, or (both false) by profile live and all
     * sources but the synthetic room, whose light is the default one. */
    bool matches_light, keeps_light;
    bool no_real_shade, no_real_ambient;
    recorder_options record; /* of what the source gives; no path = not recorded */
    bool is_played;          /* by a playback, with this after the end */
    rlf_playback_end end;
    bool enable_render;
    int32_t drawn_camera; /* of a list, whose picture is made, too: 1 is the first; 0 = none */
    bool enable_hands, enable_grab;
    rlf_camera_mode camera; /* default fixed */
    bool is_camera_set;     /* by the user */
    rlf_pose_origin poses;
    const char *map_path; /* of a room that is known; NULL = none */
    bool makes_map;       /* an empty one where none is known, as follows; 0 = the default */
    int32_t voxel_mm, map_memory_mb;
    const char *projector_path; /* calibration of the lens to draw from; NULL = the camera's */
    bool map_is_whole;          /* every frame into all of its blocks, as nobody waits */
} session_options;

/* What a SOURCE names: one camera, or those of a list (rlf_cameras_load). */
typedef struct session_cameras {
    rlf_placed_camera places[RLF_WORLD_CAMERAS_MAX];
    int32_t count;
    rlf_source *sources[RLF_WORLD_CAMERAS_MAX]; /* but the first, which is the session's */
    rlf_pipeline *pipelines[RLF_WORLD_CAMERAS_MAX];
} session_cameras;

typedef struct session {
    rlf_pool *pool;
    session_cameras cameras;
    rlf_source *source;
    rlf_scene scene;
    rlf_map *map; /* that is known or will be; NULL = the pipeline's own */
    rlf_pipeline *pipeline;
    rlf_reconstruct_def reconstruct; /* that the pipeline was made with */
    rlf_playback *playback;          /* the source's; NULL = it is not played */
    recorder *recorder;              /* NULL = nothing is recorded; close it for its status */
} session;

session_options session_options_default(void);
/* Opens all four; on failure everything is closed again. */
rlf_result session_open(const session_options *options, session *out);
void session_close(session *s);
/* Opens all four anew and then closes the old ones; on failure they go on as they were. */
rlf_result session_replace(session *s, const session_options *options);
/* The source again, which has ended or failed: it is closed first, as a camera cannot be open
 * twice. On failure there is none, and the pipeline goes on without it: call this once more. */
rlf_result session_again(session *s, const session_options *options);
/* Scene and pipeline alone, for the same source and pool; on failure the old ones go on. */
rlf_result session_renew(session *s, const session_options *options);

/* Sets the scale factor. Regions keep their size in the world: their least number of points follows
 * the grid's spacing. */
void session_set_scale(rlf_reconstruct_def *def, int32_t factor);

/* Reads "live" or "thesis". */
bool session_parse_profile(const char *text, rlf_profile *out);

/* ---- session_cameras.c: the cameras beside the first: their surfaces join its world */

/* Whether it names a list of cameras, FILE.json. */
bool session_is_camera_list(const char *source);
/* Where `source` names: itself, or the cameras of a list, FILE.json. */
rlf_result session_cameras_find(const char *source, session_cameras *out);
/* Opens all sources but the first, which play as it does. */
rlf_result session_cameras_open(session_cameras *cameras, const session_options *options,
                                rlf_pool *pool);
/* Their pipelines, which join `first`; the one of number `drawn` makes pictures. */
rlf_result session_cameras_join(session_cameras *cameras, rlf_pipeline *first, int32_t drawn);
/* Ends the pipelines; the sources stay. */
void session_cameras_leave(session_cameras *cameras);
void session_cameras_close(session_cameras *cameras);

#endif
