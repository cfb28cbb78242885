/* One value of every kind that the public functions take by pointer, each all right by itself: a
 * camera of 64 x 48 that sees a wall, and what is made of it. For test_null_calls.c, which gives
 * all arguments of a function but one.
 *
 * VALID_TYPE names the value of a TYPE; kinds of which any zeroed memory will do have none. A new
 * object without one does not compile: its size is not known. */
#ifndef RLF_TEST_VALID_ARGUMENTS_H
#define RLF_TEST_VALID_ARGUMENTS_H

#include "test.h"
#include "relief/relief.h"
#include "relief/synthetic.h"
#ifdef RLF_TEST_WITH_IO
#include "relief/io.h"
#endif
#ifdef RLF_TEST_WITH_GL
#include "relief/gl.h"
#endif

#include <string.h>

#define VALID_WIDTH 64
#define VALID_HEIGHT 48
#define VALID_PIXELS (VALID_WIDTH * VALID_HEIGHT)

typedef struct valid_arguments {
    rlf_rig rig;
    rlf_source_info info;
    float depth[VALID_PIXELS], ray_x[VALID_PIXELS], ray_y[VALID_PIXELS], one[VALID_PIXELS];
    uint8_t color[4 * VALID_PIXELS];
    rlf_source *source, *synthetic, *played;
    rlf_playback *playback;
    rlf_pool *pool;
    rlf_registration *registration;
    rlf_reconstruct *reconstruct;
    rlf_pipeline *pipeline;
    rlf_pipeline_output output;
    rlf_compositor *compositor;
    rlf_hand_tracker *hand_tracker;
    rlf_map *map;
    rlf_prediction prediction;
    rlf_model *model;
    rlf_tracker *tracker;
    rlf_world *world;
    rlf_compositor_def compositor_def;
    rlf_pipeline_def pipeline_def;
    rlf_reconstruct_def reconstruct_def;
    rlf_hand_tracker_def hand_tracker_def;
    rlf_map_def map_def;
    rlf_tracker_def tracker_def;
    rlf_model_def model_def;
    rlf_world_def world_def;
    rlf_body_def body_def;
    rlf_known_def known_def;
    rlf_synthetic_def synthetic_def;
    rlf_shape shape;
    rlf_pose pose;
    rlf_image_rgba8 image;
    rlf_plane_f32 plane_f32;
    rlf_plane_u8 plane_u8;
    rlf_aligned aligned;
    rlf_known_view known_view;
    rlf_map_view map_view;
    rlf_track_view track_view;
    rlf_render_input input;
    rlf_grid grid;
    rlf_source_methods source_methods;
    rlf_compositor_methods compositor_methods;
    rlf_region region;
    rlf_legend legend;
    rlf_model_texture texture;
#ifdef RLF_TEST_WITH_IO
    rlf_recording_def recording_def;
    rlf_recording *recording;
    rlf_ros2_publisher *ros2_publisher;
    rlf_video *video;
    rlf_csv_log *csv_log;
    rlf_map_mesh mesh;
#endif
} valid_arguments;

static valid_arguments valid;

/* Zeroed memory for any kind of value or array. */
static inline void *blank(size_t size)
{
    return rlf_default_alloc(NULL, size < 65536 ? 65536 : size);
}

static inline void *valid_text(void)
{
    char *text = blank(64);
    memcpy(text, "null_calls.bin", 15);
    return text;
}

/* A place for a pointer. */
static inline void *slot(void *value)
{
    void **place = blank(sizeof(void *));
    place[0] = value;
    return place;
}

/* ---- functions ------------------------------------------------------------------------------- */

static inline rlf_result valid_next(void *self, rlf_frame *out)
{
    valid_arguments *v = self;
    out->sequence++;
    out->time_ns = (int64_t)out->sequence * 33333333;
    out->depth_f32 = v->depth;
    out->depth_stride = VALID_WIDTH * (ptrdiff_t)sizeof(float);
    out->color = v->image;
    return RLF_OK;
}

static inline rlf_result valid_render(void *self, const rlf_render_input *input,
                                      rlf_render_output *out)
{
    (void)self;
    (void)input;
    (void)out;
    return RLF_OK;
}

static inline bool valid_project(const void *context, rlf_vec3 p, double *out_u, double *out_v)
{
    (void)context;
    (void)p;
    *out_u = *out_v = 1.0;
    return true;
}

static inline void fn_rlf_log_fn(void *context, rlf_log_level level, const char *line)
{
    (void)context;
    (void)level;
    (void)line;
}

static inline bool fn_rlf_assert_fn(void *context, const char *condition, const char *file,
                                    int line)
{
    (void)context;
    (void)condition;
    (void)file;
    (void)line;
    return false;
}

static inline void *fn_rlf_alloc_fn(void *context, size_t size)
{
    return rlf_default_alloc(context, size);
}

static inline void fn_rlf_free_fn(void *context, void *memory)
{
    rlf_default_free(context, memory);
}

static inline void fn_rlf_range_fn(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)context;
    (void)begin;
    (void)end;
    (void)worker;
}

static inline void fn_rlf_frame_fn(void *context, const rlf_frame *frame)
{
    (void)context;
    (void)frame;
}

static inline rlf_result fn_rlf_source_next_fn(void *self, rlf_frame *out_frame)
{
    (void)self;
    (void)out_frame;
    return RLF_END;
}

static inline bool fn_rlf_map_write_fn(void *context, const void *data, size_t size)
{
    (void)context;
    (void)data;
    (void)size;
    return true;
}

static inline bool fn_rlf_map_read_fn(void *context, void *data, size_t size)
{
    (void)context;
    memset(data, 0, size);
    return true;
}

/* ---- values ---------------------------------------------------------------------------------- */

static inline rlf_camera valid_camera(void)
{
    return (rlf_camera){
        .width = VALID_WIDTH, .height = VALID_HEIGHT, .fx = 50, .fy = 50, .cx = 32, .cy = 24};
}

static inline void make_planes(void)
{
    const rlf_camera camera = valid_camera();
    for (int32_t i = 0; i < VALID_PIXELS; i++) {
        valid.depth[i] = 2.0f;
        valid.ray_x[i] = (float)((i % VALID_WIDTH - camera.cx) / camera.fx);
        valid.ray_y[i] = (float)((i / VALID_WIDTH - camera.cy) / camera.fy);
        valid.one[i] = -1.0f;
    }
    memset(valid.color, 128, sizeof(valid.color));
    valid.image = (rlf_image_rgba8){valid.color, VALID_WIDTH, VALID_HEIGHT, 4 * VALID_WIDTH};
    valid.plane_f32 =
        (rlf_plane_f32){blank(4 * VALID_PIXELS), VALID_WIDTH, VALID_HEIGHT, 4 * VALID_WIDTH};
    valid.plane_u8 = (rlf_plane_u8){blank(VALID_PIXELS), VALID_WIDTH, VALID_HEIGHT, VALID_WIDTH};
    valid.aligned = (rlf_aligned){valid.plane_f32, valid.plane_u8, NULL};
    valid.pose = rlf_pose_identity();
    valid.rig = (rlf_rig){.depth = camera,
                          .color = camera,
                          .T_color_depth = valid.pose,
                          .has_color = true,
                          .depth_min_m = 0.5,
                          .depth_max_m = 4.5,
                          .noise = {0.001, 0.0, 0.001}};
}

static inline bool make_source(void)
{
    valid.source_methods = (rlf_source_methods){.next = valid_next};
    valid.compositor_methods = (rlf_compositor_methods){valid_render, NULL, "none"};
    valid.info.rig = valid.rig;
    valid.info.frames_per_second = 30.0;
    memcpy(valid.info.name, "wall", 5);
    valid.synthetic_def = rlf_synthetic_def_default();
    valid.synthetic_def.scene = RLF_SYNTHETIC_HANDS;
    valid.synthetic_def.color_width = 64;
    valid.synthetic_def.color_height = 36;
    return rlf_source_create_custom(&valid.source_methods, &valid.info, &valid, &valid.source) ==
               RLF_OK &&
           rlf_synthetic_create(&valid.synthetic_def, &valid.synthetic) == RLF_OK &&
           rlf_synthetic_create(&valid.synthetic_def, &valid.played) == RLF_OK &&
           rlf_playback_wrap(&valid.played, RLF_PLAYBACK_LOOP, &valid.playback) == RLF_OK &&
           rlf_pool_create(1, &valid.pool) == RLF_OK;
}

static inline bool make_stages(void)
{
    valid.pipeline_def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, valid.source, NULL);
    valid.reconstruct_def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &valid.rig);
    valid.hand_tracker_def = rlf_hand_tracker_def_default(VALID_WIDTH, VALID_HEIGHT);
    valid.map_def = rlf_map_def_default();
    valid.map_def.rig = valid.rig;
    valid.map_def.memory_mb = 8;
    valid.tracker_def = rlf_tracker_def_default();
    valid.tracker_def.rig = valid.rig;
    static const rlf_model_vertex corners[3] = {
        {.position = {0, 0, 0}}, {.position = {1, 0, 0}}, {.position = {0, 1, 0}}};
    static const int32_t triangle[3] = {0, 1, 2};
    valid.model_def = rlf_model_def_default();
    valid.model_def.vertices = corners;
    valid.model_def.vertex_count = 3;
    valid.model_def.triangles = triangle;
    valid.model_def.triangle_count = 1;
    valid.world_def = rlf_world_def_default();
    valid.world_def.body_capacity = 16;
    valid.world_def.contact_capacity = 64;
    valid.body_def = rlf_body_def_default();
    valid.known_def = rlf_known_def_default();
    valid.shape = valid.body_def.shape;
    return rlf_pipeline_create(&valid.pipeline_def, &valid.pipeline) == RLF_OK &&
           rlf_pipeline_step(valid.pipeline, &valid.output) == RLF_OK &&
           rlf_reconstruct_create(&valid.reconstruct_def, &valid.reconstruct) == RLF_OK &&
           rlf_hand_tracker_create(&valid.hand_tracker_def, &valid.hand_tracker) == RLF_OK &&
           rlf_map_create(&valid.map_def, &valid.map) == RLF_OK &&
           rlf_tracker_create(&valid.tracker_def, &valid.tracker) == RLF_OK &&
           rlf_model_create(&valid.model_def, &valid.model) == RLF_OK &&
           rlf_world_create(&valid.world_def, &valid.world) == RLF_OK &&
           rlf_registration_create(&valid.rig.depth, valid.ray_x, valid.ray_y, &valid.rig.color,
                                   &valid.pose, &valid.registration) == RLF_OK;
}

static inline bool make_views(void)
{
    const rlf_camera camera = valid_camera();
    valid.compositor_def = rlf_pipeline_get_compositor_def(valid.pipeline);
    valid.known_view = (rlf_known_view){valid.output.surface, &valid.rig, valid.pose};
    valid.map_view = (rlf_map_view){.depth = valid.depth};
    valid.track_view = (rlf_track_view){.depth = valid.depth};
    valid.input = (rlf_render_input){.frame = &valid.output.frame,
                                     .surface = valid.output.surface,
                                     .T_world_camera = valid.pose};
    valid.grid = (rlf_grid){.width = VALID_WIDTH,
                            .height = VALID_HEIGHT,
                            .ray_x = valid.ray_x,
                            .ray_y = valid.ray_y,
                            .background = {.depth = valid.depth,
                                           .normal_x = blank(4 * VALID_PIXELS),
                                           .normal_y = blank(4 * VALID_PIXELS),
                                           .normal_z = valid.one},
                            .project = valid_project,
                            .pixel_angle = 0.02,
                            .T_world_grid = valid.pose};
    valid.region =
        (rlf_region){.label = 1, .point_count = 0, .x1 = VALID_WIDTH, .y1 = VALID_HEIGHT};
    valid.legend = rlf_view_legend(RLF_VIEW_DEPTH, &valid.rig);
    valid.texture =
        (rlf_model_texture){.texels = valid.color, .width = 8, .height = 8, .level_count = 4};
    return rlf_compositor_create_soft(&valid.compositor_def, &valid.compositor) == RLF_OK &&
           rlf_map_integrate(valid.map, &valid.map_view, &valid.pose, NULL) == RLF_OK &&
           rlf_map_predict(valid.map, &camera, &valid.pose, &valid.prediction) == RLF_OK;
}

/* Files go into the current folder. */
static inline bool make_files(void)
{
#ifdef RLF_TEST_WITH_IO
    valid.recording_def = rlf_recording_def_default();
    /* NULL where the build has no ROS 2. */
    (void)rlf_ros2_publisher_open("ros2:/null_calls", &valid.info, &valid.ros2_publisher);
    return rlf_recording_open("null_calls/", &valid.info, &valid.recording_def, &valid.recording) ==
               RLF_OK &&
           rlf_video_open("null_calls.y4m", VALID_WIDTH, VALID_HEIGHT, 30, &valid.video) ==
               RLF_OK &&
           rlf_csv_log_open("null_calls_log", &valid.csv_log) == RLF_OK &&
           rlf_map_mesh_create(valid.map, 1, &valid.mesh) == RLF_OK;
#else
    return true;
#endif
}

static inline bool valid_make(void)
{
    make_planes();
    return make_source() && make_stages() && make_views() && make_files();
}

#define VALID_char valid_text()
#define VALID_void blank(1)
#define VALID_rlf_address (&(rlf_address){.source = "a:b", .place = "b"})
#define VALID_rlf_pool valid.pool
#define VALID_rlf_camera (&valid.rig.depth)
#define VALID_rlf_rig (&valid.rig)
#define VALID_rlf_pose (&valid.pose)
#define VALID_rlf_registration valid.registration
#define VALID_rlf_plane_f32 (&valid.plane_f32)
#define VALID_rlf_plane_u8 (&valid.plane_u8)
#define VALID_rlf_aligned (&valid.aligned)
#define VALID_rlf_legend (&valid.legend)
#define VALID_rlf_image_rgba8 (&valid.image)
#define VALID_rlf_compositor_def (&valid.compositor_def)
#define VALID_rlf_compositor_methods (&valid.compositor_methods)
#define VALID_rlf_compositor valid.compositor
#define VALID_rlf_render_input (&valid.input)
#define VALID_rlf_hand_tracker_def (&valid.hand_tracker_def)
#define VALID_rlf_hand_tracker valid.hand_tracker
#define VALID_rlf_surface (void *)valid.output.surface
#define VALID_rlf_source valid.synthetic
#define VALID_rlf_playback valid.playback
#define VALID_rlf_source_info (&valid.info)
#define VALID_rlf_source_methods (&valid.source_methods)
#define VALID_rlf_recording_def (&valid.recording_def)
#define VALID_rlf_recording valid.recording
#define VALID_rlf_ros2_publisher valid.ros2_publisher
#define VALID_rlf_frame (&valid.output.frame)
#define VALID_rlf_snapshot (void *)valid.output.snapshot
#define VALID_rlf_known_def (&valid.known_def)
#define VALID_rlf_model_def (&valid.model_def)
#define VALID_rlf_model valid.model
#define VALID_rlf_model_texture (&valid.texture)
#define VALID_rlf_region (&valid.region)
#define VALID_rlf_map valid.map
#define VALID_rlf_map_def (&valid.map_def)
#define VALID_rlf_map_mesh (&valid.mesh)
#define VALID_rlf_map_view (&valid.map_view)
#define VALID_rlf_prediction (&valid.prediction)
#define VALID_rlf_video valid.video
#define VALID_rlf_csv_log valid.csv_log
#define VALID_rlf_pipeline_output (&valid.output)
#define VALID_rlf_pipeline_def (&valid.pipeline_def)
#define VALID_rlf_pipeline valid.pipeline
#define VALID_rlf_shape (&valid.shape)
#define VALID_rlf_known_view (&valid.known_view)
#define VALID_rlf_world valid.world
#define VALID_rlf_world_def (&valid.world_def)
#define VALID_rlf_body_def (&valid.body_def)
#define VALID_rlf_grid (&valid.grid)
#define VALID_rlf_reconstruct_def (&valid.reconstruct_def)
#define VALID_rlf_reconstruct valid.reconstruct
#define VALID_rlf_synthetic_def (&valid.synthetic_def)
#define VALID_rlf_tracker_def (&valid.tracker_def)
#define VALID_rlf_tracker valid.tracker
#define VALID_rlf_track_view (&valid.track_view)
#define VALID_rlf_gl_presenter blank(1) /* needs a window; NULL is told before it is looked at */

#endif
