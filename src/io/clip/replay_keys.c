/* The keys of playing, read. */
#include "io/file.h"
#include "io/source/address.h"
#include "io/clip/clip.h"

#include <string.h>

#define FRAMES_MAX 1e9
#define SPEED_MAX 1000.0

typedef struct replay_key {
    const char *name;
    double low, high;
    bool is_whole;
    const char *meaning;
} replay_key;

static const replay_key keys[] = {
    {"loop", 0, 1, true, "1 to start again at the end, or 0"},
    {"speed", 0, SPEED_MAX, false, "1 for as recorded, 0 for as fast as possible, up to 1000"},
    {"start", 0, FRAMES_MAX, true, "the first frame to give, from 0"},
    {"count", 1, FRAMES_MAX, true, "how many frames to give, from 1"},
    {"drop", 0, 1, false, "the share of frames to lose, from 0 to 1"},
    {"seed", 0, FRAMES_MAX, true, "a whole number from 0"},
    {"aligned", 0, 1, true, "1 when colour is in the depth camera's pixels, 0 when it is not"},
    {"direct", 0, 1, true, "1 to call the driver without a thread of its own, or 0"},
};
#define KEY_COUNT ((int)(sizeof(keys) / sizeof(keys[0])))

static rlf_result parse(const replay_key *key, const char *text, const char *place, double *out)
{
    if (!io_number_parse(text, out) || *out < key->low || *out > key->high ||
        (key->is_whole && *out != (double)(int64_t)*out)) {
        return rlf_fail(RLF_ERROR_INVALID, "%s: %s=%.40s: use %s", place, key->name, text,
                        key->meaning);
    }
    return RLF_OK;
}

rlf_result io_replay_take(io_address *parts, const rlf_backend *backend, io_replay *out)
{
    const char *allowed = backend->is_live ? IO_REPLAY_LIVE_KEYS : IO_REPLAY_FILE_KEYS;
    double values[KEY_COUNT] = {0, 0, 0, 0, 0, 0, -1, 0};
    memset(out, 0, sizeof(*out));
    for (int i = 0; i < KEY_COUNT; i++) {
        if (!io_word_is_in(allowed, keys[i].name) || io_word_is_in(backend->keys, keys[i].name)) {
            continue;
        }
        const char *text = io_address_take(parts, keys[i].name);
        if (text != NULL) {
            rlf_result result = parse(&keys[i], text, parts->place, &values[i]);
            if (result != RLF_OK) {
                return result;
            }
            out->is_wanted = out->is_wanted || strcmp(keys[i].name, "direct") != 0;
        }
    }
    out->loop = values[0] != 0.0;
    out->speed = values[1];
    out->start = (int64_t)values[2];
    out->count = (int64_t)values[3];
    out->drop = values[4];
    out->seed = (uint64_t)values[5];
    out->aligned = (int32_t)values[6];
    out->is_direct = values[7] != 0.0;
    return RLF_OK;
}
