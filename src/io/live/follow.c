/* Times and counts of a camera's frames, kept going when its own clock or counter starts anew. */
#include "io/live/live.h"

#include "io/clip/clip.h"

/* The device's clock and this machine's agree about the time between two frames up to this; a wider
 * difference is a clock that was set, or wrapped around. */
#define CLOCKS_APART_NS INT64_C(1000000000)
/* No depth camera makes more frames in the time between two frames: its counter started anew. */
#define FRAMES_PER_SECOND_MAX 1000

void live_follow_reconnect(live_follow *follow)
{
    follow->is_connection_new = follow->has_last;
}

/* Clocks of bad drivers may say anything: what is too far apart wraps around, and is not right. */
static int64_t gap_between(int64_t before_ns, int64_t after_ns)
{
    return (int64_t)((uint64_t)after_ns - (uint64_t)before_ns);
}

static bool is_time_right(int64_t gap_ns, int64_t host_gap_ns)
{
    return gap_ns > 0 && gap_ns - host_gap_ns <= CLOCKS_APART_NS &&
           host_gap_ns - gap_ns <= CLOCKS_APART_NS;
}

static bool is_count_right(uint64_t step, int64_t host_gap_ns)
{
    const int64_t most = FRAMES_PER_SECOND_MAX + host_gap_ns / (1000000000 / FRAMES_PER_SECOND_MAX);
    return step >= 1 && step <= (uint64_t)most;
}

bool live_follow_frame(live_follow *f, int64_t host_ns, rlf_frame *frame, uint64_t *out_lost)
{
    const uint64_t device_sequence = frame->sequence;
    const int64_t device_time_ns = frame->time_ns;
    *out_lost = 0;
    if (!f->has_last && !io_time_is_usable(device_time_ns)) {
        frame->time_ns = host_ns; /* time goes on from here */
        frame->color_time_ns = 0;
    }
    if (f->has_last) {
        const int64_t host_gap_ns = host_ns > f->host_ns ? host_ns - f->host_ns : 1;
        const int64_t gap_ns = gap_between(f->device_time_ns, device_time_ns);
        const uint64_t step = device_sequence - f->device_sequence;
        if (!f->is_connection_new && step == 0 && gap_ns == 0) {
            return false;
        }
        const bool keeps_time = !f->is_connection_new && is_time_right(gap_ns, host_gap_ns);
        const bool keeps_count = !f->is_connection_new && is_count_right(step, host_gap_ns);
        *out_lost = keeps_count ? step - 1 : 0;
        frame->sequence = f->sequence + (keeps_count ? step : 1);
        frame->time_ns = f->time_ns + (keeps_time ? gap_ns : host_gap_ns);
        const int64_t color_gap_ns = gap_between(device_time_ns, frame->color_time_ns);
        if (frame->color_time_ns != 0) {
            const bool is_near = color_gap_ns > -CLOCKS_APART_NS && color_gap_ns < CLOCKS_APART_NS;
            frame->color_time_ns = is_near ? frame->time_ns + color_gap_ns : 0;
        }
    }
    *f = (live_follow){.has_last = true,
                       .device_sequence = device_sequence,
                       .device_time_ns = device_time_ns,
                       .host_ns = host_ns,
                       .sequence = frame->sequence,
                       .time_ns = frame->time_ns};
    return true;
}
