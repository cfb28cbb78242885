/* Several cameras of one room. */
#include "session.h"

#include <string.h>

bool session_is_camera_list(const char *source)
{
    const size_t length = strlen(source);
    return length > 5 && strcmp(source + length - 5, ".json") == 0 && strchr(source, '?') == NULL;
}

rlf_result session_cameras_find(const char *source, session_cameras *out)
{
    memset(out, 0, sizeof(*out));
    if (session_is_camera_list(source)) {
        return rlf_cameras_load(source, out->places, &out->count);
    }
    out->count = 1;
    out->places[0].T_world_camera = rlf_pose_identity();
    return RLF_OK;
}

rlf_result session_cameras_open(session_cameras *cameras, const session_options *options,
                                rlf_pool *pool)
{
    rlf_result result = RLF_OK;
    for (int32_t k = 1; k < cameras->count && result == RLF_OK; k++) {
        rlf_playback *playback;
        result = rlf_open_source(cameras->places[k].source, pool, &cameras->sources[k]);
        if (result == RLF_OK && options->is_played) {
            result = rlf_playback_wrap(&cameras->sources[k], options->end, &playback);
        }
    }
    return result;
}

rlf_result session_cameras_join(session_cameras *cameras, rlf_pipeline *first, int32_t drawn)
{
    rlf_result result = RLF_OK;
    for (int32_t k = 1; k < cameras->count && result == RLF_OK; k++) {
        rlf_pipeline_def def = rlf_pipeline_def_joining(first, cameras->sources[k],
                                                        &cameras->places[k].T_world_camera);
        def.enable_render = k + 1 == drawn;
        result = rlf_pipeline_create(&def, &cameras->pipelines[k]);
    }
    if (result != RLF_OK) {
        session_cameras_leave(cameras);
    }
    return result;
}

void session_cameras_leave(session_cameras *cameras)
{
    for (int32_t k = 1; k < cameras->count; k++) {
        rlf_pipeline_destroy(&cameras->pipelines[k]);
    }
}

void session_cameras_close(session_cameras *cameras)
{
    session_cameras_leave(cameras);
    for (int32_t k = 1; k < cameras->count; k++) {
        rlf_source_destroy(&cameras->sources[k]);
    }
}
