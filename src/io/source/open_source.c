/* From the SOURCE of a command line to a source. */
#include "io/live/live.h"
#include "io/source/backends.h"
#include "io/source/address.h"
#include "io/clip/clip.h"
#include "relief/io.h"

#include <stdio.h>
#include <string.h>

static rlf_result open_synthetic(const char *source, rlf_pool *pool, rlf_source **out)
{
    rlf_synthetic_def def = rlf_synthetic_def_default();
    rlf_result result = rlf_synthetic_parse(source, &def);
    if (result != RLF_OK) {
        return result;
    }
    def.pool = pool;
    return rlf_synthetic_create(&def, out);
}

static rlf_result fail_key(const rlf_backend *backend, const char *source, const char *key)
{
    char keys[512];
    const char *own = backend->keys != NULL ? backend->keys : "";
    snprintf(keys, sizeof(keys), "camera %s%s%s",
             backend->is_live ? IO_REPLAY_LIVE_KEYS : IO_REPLAY_FILE_KEYS,
             own[0] != '\0' ? " " : "", own);
    char nearest[32];
    const bool is_near = rlf_word_nearest(keys, key, nearest, sizeof(nearest));
    return rlf_fail(RLF_ERROR_INVALID, "%s: there is no key \"%.40s\" here%s%s%s: use %s", source,
                    key, is_near ? ", \"" : "", is_near ? nearest : "",
                    is_near ? "\" may be meant" : "", keys);
}

/* The keys left are the back end's own. */
static rlf_result give_keys(const rlf_backend *backend, const io_address *parts,
                            rlf_address *address)
{
    for (int32_t i = 0; i < parts->key_count; i++) {
        if (!io_word_is_in(backend->keys, parts->keys[i]) || i >= RLF_ADDRESS_KEYS_MAX) {
            return fail_key(backend, address->source, parts->keys[i]);
        }
        address->keys[i] = parts->keys[i];
        address->values[i] = parts->values[i];
        address->key_count = i + 1;
    }
    return RLF_OK;
}

static rlf_result wrap(const io_replay *replay, const char *source, rlf_opened *inout)
{
    rlf_result result = replay->is_wanted ? io_replay_wrap(replay, source, inout) : RLF_OK;
    if (result != RLF_OK && inout->methods.destroy != NULL) {
        inout->methods.destroy(inout->self);
    }
    return result;
}

/* A camera's newest frame, or each in its turn; both by a thread of its own. */
static rlf_result open_device(const rlf_backend *backend, bool is_direct,
                              const rlf_address *address, rlf_opened *out)
{
    if (!backend->is_live) {
        return backend->open(address, out);
    }
    return is_direct ? io_direct_open(backend, address, out) : io_live_open(backend, address, out);
}

static rlf_result open_with(const rlf_backend *backend, const char *source, io_address *parts,
                            rlf_source **out)
{
    /* Error lines put a colon behind it: "openni2: no such camera", not "openni2::". */
    const bool is_bare = parts->place[0] == '\0' && parts->key_count == 0;
    rlf_address address = {.source = is_bare ? parts->scheme : source, .place = parts->place};
    rlf_rig rig;
    rlf_result result = RLF_OK;
    const char *camera_path = io_address_take(parts, "camera");
    if (camera_path != NULL) {
        result = rlf_rig_load(camera_path, &rig, &address.units_per_metre);
        address.rig = &rig;
    }
    io_replay replay = {0};
    result = result == RLF_OK ? io_replay_take(parts, backend, &replay) : result;
    result = result == RLF_OK ? give_keys(backend, parts, &address) : result;
    rlf_opened opened;
    memset(&opened, 0, sizeof(opened));
    result = result == RLF_OK ? open_device(backend, replay.is_direct, &address, &opened) : result;
    result = result == RLF_OK ? wrap(&replay, source, &opened) : result;
    return result == RLF_OK ? io_source_create(&opened, out) : result;
}

rlf_result rlf_open_source(const char *source, rlf_pool *pool, rlf_source **out)
{
    if (!RLF_ASSERT(source != NULL && out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    *out = NULL;
    if (source[0] == '\0') {
        return rlf_fail(RLF_ERROR_INVALID, "the SOURCE is empty: give synthetic:room or a folder "
                                           "with depth.txt and camera.json");
    }
    if (strncmp(source, "synthetic:", strlen("synthetic:")) == 0) {
        return open_synthetic(source, pool, out);
    }
    io_simulated_lend_open(rlf_open_source);
    io_address parts;
    const rlf_backend *backend = NULL;
    rlf_result result = io_address_parse(source, &parts);
    result = result == RLF_OK ? io_backend_find(source, &parts, &backend) : result;
    return result == RLF_OK ? open_with(backend, source, &parts, out) : result;
}
