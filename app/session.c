/* Opens and closes what a run needs. */
#define _POSIX_C_SOURCE 200809L
#include "session.h"

#include <string.h>
#include <sys/stat.h>

session_options session_options_default(void)
{
    session_options options;
    memset(&options, 0, sizeof(options));
    options.profile = RLF_PROFILE_LIVE;
    options.enable_render = true;
    options.record = recorder_options_default();
    return options;
}

bool session_parse_profile(const char *text, rlf_profile *out)
{
    bool is_live = strcmp(text, "live") == 0;
    *out = is_live ? RLF_PROFILE_LIVE : RLF_PROFILE_THESIS;
    return is_live || strcmp(text, "thesis") == 0;
}

static rlf_result open_scene(const session_options *options, rlf_scene *out)
{
    if (options->scene != NULL) {
        *out = *options->scene;
        memset(options->scene, 0, sizeof(*options->scene));
        return RLF_OK;
    }
    if (options->scene_path != NULL) {
        return rlf_scene_load(options->scene_path, out);
    }
    if (options->use_default_scene) {
        return rlf_scene_create_two_cubes(out);
    }
    out->gravity = rlf_world_def_default().gravity;
    return RLF_OK;
}

void session_set_scale(rlf_reconstruct_def *def, int32_t factor)
{
    double ratio = (double)def->scale_factor / factor;
    int32_t points = (int32_t)(def->min_region_points * ratio * ratio + 0.5);
    def->min_region_points = points > 1 ? points : 1;
    def->scale_factor = factor;
}

static bool matches_light(const session_options *options, const rlf_source_info *info)
{
    bool is_wanted =
        options->profile == RLF_PROFILE_LIVE && !info->is_simulated && !options->keeps_light;
    return options->matches_light || is_wanted;
}

/* Where neither the user nor the scene nor the source says which way is down, the floor tells. Not
 * for those who only look: nothing falls there. */
static void set_gravity(const session_options *options, const rlf_source_info *info,
                        rlf_scene *scene)
{
    if (options->is_gravity_set) {
        scene->finds_gravity = options->finds_gravity;
        scene->gravity = options->gravity;
    } else if (!scene->is_gravity_given && options->scene == NULL) {
        const bool is_known = rlf_length(info->gravity) > 0.0;
        const bool has_bodies = options->scene_path != NULL || options->use_default_scene;
        scene->gravity = is_known ? info->gravity : scene->gravity;
        scene->finds_gravity = !is_known && has_bodies;
    }
}

static rlf_result open_recorder(const session_options *options, session *s)
{
    rlf_result result =
        recorder_create(&options->record, rlf_source_get_info(s->source), &s->recorder);
    return result == RLF_OK ? recorder_tap(s->recorder, &s->source) : result;
}

/* The pair's second camera is the projector, which shines where a camera looks. */
static rlf_result set_projector(const char *path, rlf_pipeline *pipeline)
{
    rlf_rig rig;
    double units;
    if (path == NULL) {
        return RLF_OK;
    }
    const rlf_result result = rlf_rig_load(path, &rig, &units);
    if (result == RLF_OK && !rig.has_color) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: has one camera: a projector needs a calibrated pair, of the depth "
                        "camera and the projector (relief calibrate)",
                        path);
    }
    return result == RLF_OK ? rlf_pipeline_set_projector(pipeline, &rig.color, &rig.T_color_depth)
                            : result;
}

static rlf_result create_pipeline(const session_options *options, session *s)
{
    const rlf_source_info *info = rlf_source_get_info(s->source);
    set_gravity(options, info, &s->scene);
    rlf_pipeline_def def = rlf_pipeline_def_default(options->profile, s->source, s->pool);
    def.scene = &s->scene;
    if (options->scale_factor > 0) {
        session_set_scale(&def.reconstruct, options->scale_factor);
    }
    settings_apply(&options->settings, &def.reconstruct);
    settings_warn(&options->settings, &def.reconstruct);
    def.enable_render = options->enable_render;
    def.enable_hands = options->enable_hands;
    def.camera = s->cameras.count > 1 ? RLF_CAMERA_FIXED : options->camera;
    def.world.camera_capacity = s->cameras.count;
    def.T_world_camera = s->cameras.places[0].T_world_camera;
    def.poses = options->poses;
    def.map = s->map;
    def.world.enable_grab = options->enable_grab;
    if (options->is_occlusion_set) {
        def.compositor.occlusion = options->occlusion;
    }
    if (options->is_light_set) {
        def.compositor.light_direction = options->light_direction;
    }
    const bool matches = matches_light(options, info);
    def.compositor.estimates_light = matches;
    def.compositor.estimates_light_direction = matches && !options->is_light_set;
    def.compositor.enable_real_shade = !options->no_real_shade;
    def.compositor.enable_real_ambient = !options->no_real_ambient;
    s->reconstruct = def.reconstruct;
    rlf_result result = rlf_pipeline_create(&def, &s->pipeline);
    if (result == RLF_OK) {
        result = session_cameras_join(&s->cameras, s->pipeline, options->drawn_camera);
    }
    if (result == RLF_OK) {
        result = set_projector(options->projector_path, s->pipeline);
    }
    if (result != RLF_OK) {
        session_cameras_leave(&s->cameras);
        rlf_pipeline_destroy(&s->pipeline);
    }
    return result;
}

/* A block of a map has 1.2 times its bytes in the file; the rest is for what the room grows by. */
#define MAP_MEMORY_PER_FILE 1.5

/* As much memory as the room needs: whoever fused it had that, too. */
static int32_t map_memory_mb(const char *path, int32_t least_mb)
{
    struct stat file;
    const bool is_there = stat(path, &file) == 0;
    const double mb = is_there ? MAP_MEMORY_PER_FILE * (double)file.st_size / 1048576.0 : 0.0;
    return (int32_t)rlf_clamp(mb, least_mb, RLF_MAP_MEMORY_MOST_MB);
}

static rlf_result open_map(const session_options *options, session *s)
{
    const char *path = options->map_path;
    if (path == NULL && !options->makes_map) {
        return RLF_OK;
    }
    rlf_map_def def = rlf_map_def_default();
    def.rig = rlf_source_get_info(s->source)->rig;
    def.pool = s->pool;
    def.memory_mb = path != NULL ? map_memory_mb(path, def.memory_mb) : def.memory_mb;
    def.memory_mb = options->map_memory_mb > 0 ? options->map_memory_mb : def.memory_mb;
    def.voxel_m = options->voxel_mm > 0 ? 0.001 * options->voxel_mm : def.voxel_m;
    def.blocks_per_frame = options->map_is_whole ? 0 : def.blocks_per_frame;
    rlf_result result = rlf_map_create(&def, &s->map);
    return result == RLF_OK && path != NULL ? rlf_map_read_file(s->map, path) : result;
}

/* Of several cameras none moves: where they stand is known. */
static rlf_result open_sources(const session_options *options, session *s)
{
    rlf_result result = session_cameras_find(options->source, &s->cameras);
    if (result != RLF_OK) {
        return result;
    }
    const char *first = s->cameras.places[0].source;
    if (s->cameras.count > 1 && options->is_camera_set && options->camera != RLF_CAMERA_FIXED) {
        return rlf_fail(RLF_ERROR_INVALID, "%s: its cameras stand: leave out --camera",
                        options->source);
    }
    result = rlf_open_source(first[0] != '\0' ? first : options->source, s->pool, &s->source);
    return result == RLF_OK ? session_cameras_open(&s->cameras, options, s->pool) : result;
}

static rlf_result open_all(const session_options *options, session *s)
{
    rlf_result result = rlf_pool_create(options->thread_count, &s->pool);
    if (result == RLF_OK) {
        result = open_sources(options, s);
    }
    if (result == RLF_OK) {
        result = open_scene(options, &s->scene);
    }
    if (result == RLF_OK && (options->record.path != NULL || options->record.is_switched)) {
        result = open_recorder(options, s);
    }
    if (result == RLF_OK) {
        result = open_map(options, s);
    }
    if (result == RLF_OK && options->is_played) {
        result = rlf_playback_wrap(&s->source, options->end, &s->playback);
    }
    return result == RLF_OK ? create_pipeline(options, s) : result;
}

rlf_result session_open(const session_options *options, session *out)
{
    memset(out, 0, sizeof(*out));
    rlf_result result = open_all(options, out);
    if (result != RLF_OK) {
        session_close(out);
    }
    return result;
}

void session_close(session *s)
{
    recorder_destroy(&s->recorder, NULL);
    session_cameras_close(&s->cameras);
    rlf_pipeline_destroy(&s->pipeline);
    rlf_map_destroy(&s->map);
    rlf_scene_destroy(&s->scene);
    rlf_source_destroy(&s->source);
    rlf_pool_destroy(&s->pool);
}

rlf_result session_replace(session *s, const session_options *options)
{
    session fresh;
    rlf_result result = session_open(options, &fresh);
    if (result == RLF_OK) {
        session_close(s);
        *s = fresh;
    }
    return result;
}

rlf_result session_again(session *s, const session_options *options)
{
    (void)recorder_destroy(&s->recorder, NULL);
    session_cameras_close(&s->cameras);
    rlf_source_destroy(&s->source);
    s->playback = NULL; /* was the source's */
    return session_replace(s, options);
}

rlf_result session_renew(session *s, const session_options *options)
{
    if (s->source == NULL) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED, "there is no source now, and it comes first");
    }
    session fresh = *s;
    fresh.pipeline = NULL;
    memset(fresh.cameras.pipelines, 0, sizeof(fresh.cameras.pipelines));
    memset(&fresh.scene, 0, sizeof(fresh.scene));
    rlf_result result = open_scene(options, &fresh.scene);
    if (result == RLF_OK) {
        result = create_pipeline(options, &fresh);
    }
    rlf_scene *unused = result == RLF_OK ? &s->scene : &fresh.scene;
    if (result == RLF_OK) {
        session_cameras_leave(&s->cameras);
        rlf_pipeline_destroy(&s->pipeline);
    }
    rlf_scene_destroy(unused);
    if (result == RLF_OK) {
        *s = fresh;
    }
    return result;
}
