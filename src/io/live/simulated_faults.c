/* What goes wrong with a simulated camera, and when. */
#include "io/live/simulated.h"

#include <stdio.h>

#define TIME_MAX_S 1e6
#define EVERY_MAX 1000000

static rlf_result fail_key(const rlf_address *address, const char *key, const char *cure)
{
    return rlf_fail(RLF_ERROR_INVALID, "%s: %s=%.40s: use %s", address->source, key,
                    rlf_address_get(address, key), cure);
}

static rlf_result parse_time(const rlf_address *address, const char *key, double *out)
{
    const char *text = rlf_address_get(address, key);
    char rest;
    if (text == NULL) {
        return RLF_OK;
    }
    const bool is_good =
        sscanf(text, "%lf%c", out, &rest) == 1 && *out >= 0.0 && *out <= TIME_MAX_S;
    return is_good ? RLF_OK : fail_key(address, key, "seconds, 0 to 1000000");
}

static rlf_result parse_every(const rlf_address *address, const char *key, int32_t *out)
{
    const char *text = rlf_address_get(address, key);
    char rest;
    double value = 0.0;
    if (text == NULL) {
        return RLF_OK;
    }
    if (sscanf(text, "%lf%c", &value, &rest) != 1 || !(value >= 2.0) || value > EVERY_MAX) {
        return fail_key(address, key, "a number of frames, 2 to 1000000");
    }
    *out = (int32_t)value;
    return RLF_OK;
}

static rlf_result parse_stall(const rlf_address *address, simulated_faults *out)
{
    const char *text = rlf_address_get(address, "stall");
    char rest;
    if (text == NULL) {
        return RLF_OK;
    }
    const bool is_good = sscanf(text, "%lf@%lf%c", &out->stall_s, &out->stall_from_s, &rest) == 2 &&
                         out->stall_s > 0.0 && out->stall_s <= TIME_MAX_S &&
                         out->stall_from_s >= 0.0 && out->stall_from_s <= TIME_MAX_S;
    return is_good ? RLF_OK : fail_key(address, "stall", "SECONDS@WHEN, e.g. 2@10");
}

rlf_result simulated_faults_parse(const rlf_address *address, simulated_faults *out)
{
    *out = (simulated_faults){.unplug_s = -1, .replug_s = -1, .hang_s = -1, .time_back_s = -1};
    double jitter_ms = 0.0;
    rlf_result result = parse_time(address, "unplug_after", &out->unplug_s);
    result = result == RLF_OK ? parse_time(address, "replug_after", &out->replug_s) : result;
    result = result == RLF_OK ? parse_stall(address, out) : result;
    result = result == RLF_OK ? parse_time(address, "hang", &out->hang_s) : result;
    result = result == RLF_OK ? parse_time(address, "time_back", &out->time_back_s) : result;
    result = result == RLF_OK ? parse_time(address, "jitter", &jitter_ms) : result;
    result = result == RLF_OK ? parse_every(address, "drop", &out->drop) : result;
    result = result == RLF_OK ? parse_every(address, "doubled", &out->doubled) : result;
    out->jitter_s = jitter_ms * 1e-3;
    return result;
}

bool simulated_is_plugged(const simulated_faults *f, double time_s)
{
    const bool is_pulled = f->unplug_s >= 0.0 && time_s >= f->unplug_s;
    return !is_pulled || (f->replug_s >= 0.0 && time_s >= f->unplug_s + f->replug_s);
}

bool simulated_is_stalled(const simulated_faults *f, double time_s)
{
    return f->stall_s > 0.0 && time_s >= f->stall_from_s && time_s < f->stall_from_s + f->stall_s;
}
