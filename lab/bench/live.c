/* `relief-lab bench --live`. */
#include "bench/live.h"

#include "command.h"
#include "session.h"
#include "timing.h"

#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

#define UNPLUG_S 6.0
#define REPLUG_S 2.0
#define STALL_AT_S 11.0
#define STALL_S 2.0
#define PATIENCE_NS INT64_C(60000000000)

/* A camera that was lost, and what was said of it. */
typedef struct live_loss {
    int64_t last_frame_ns, told_ns, back_ns;
} live_loss;

typedef struct live_bench {
    session s;
    timing_series latency_ms;
    int64_t open_ns, first_picture_ns;
    live_loss losses[2]; /* pulled out, stalled */
    int32_t loss;        /* that is to come, or is */
    rlf_source_status status;
} live_bench;

static _Atomic int64_t told_ns; /* when the log told of the camera's loss; 0 = it did not */

static void note_line(void *context, rlf_log_level level, const char *line)
{
    (void)context;
    (void)level;
    if (strstr(line, "trying again") != NULL) {
        atomic_store(&told_ns, rlf_clock_ns());
    }
    fprintf(stderr, "relief: %s\n", line);
}

/* What is played jumps, too, when it starts again: a loss is told of. */
static void note_frame(live_bench *b, const rlf_pipeline_output *frame, int64_t now_ns)
{
    live_loss *loss = &b->losses[b->loss];
    const int64_t told = atomic_load(&told_ns);
    if (told != 0 && (frame->frame.flags & RLF_FRAME_DISCONTINUITY) != 0) {
        loss->told_ns = told;
        loss->back_ns = now_ns;
        b->loss++;
        atomic_store(&told_ns, 0);
    } else {
        loss->last_frame_ns = frame->frame.host_time_ns;
    }
    if (b->first_picture_ns == 0) {
        b->first_picture_ns = now_ns;
    } else {
        timing_add(&b->latency_ms, frame->latency_ms);
    }
}

static rlf_result run(live_bench *b)
{
    while (b->loss < 2 && !command_interrupted) {
        rlf_pipeline_output frame;
        const rlf_result result = rlf_pipeline_step(b->s.pipeline, &frame);
        const int64_t now_ns = rlf_clock_ns();
        if (result == RLF_OK) {
            note_frame(b, &frame, now_ns);
        } else if (result != RLF_NO_FRAME || now_ns - b->open_ns > PATIENCE_NS) {
            return result < 0 ? result : rlf_fail(RLF_ERROR_DEVICE, "the camera did not come back");
        }
    }
    b->status = rlf_source_get_status(b->s.source);
    return RLF_OK;
}

static double ms_since(int64_t from_ns, int64_t to_ns)
{
    return (double)(to_ns - from_ns) * 1e-6;
}

static void print(const live_bench *b, const char *source)
{
    const live_loss *pulled = &b->losses[0];
    const live_loss *stalled = &b->losses[1];
    const int64_t replug_ns = pulled->last_frame_ns + (int64_t)(REPLUG_S * 1e9);
    printf("live loop, a simulated camera that plays %s at %.1f per second; ms\n", source,
           rlf_source_get_info(b->s.source)->frames_per_second);
    printf("                                     median     p95    goal\n");
    printf("  frame's arrival to its picture    %7.1f %7.1f    33.0\n",
           timing_percentile(&b->latency_ms, 50), timing_percentile(&b->latency_ms, 95));
    printf("  opening to the first picture      %7.1f          1500.0\n",
           ms_since(b->open_ns, b->first_picture_ns));
    printf("  plugging in to the first picture  %7.1f          1500.0\n",
           ms_since(replug_ns, pulled->back_ns));
    printf("  pulling out to the message        %7.1f          1000.0\n",
           ms_since(pulled->last_frame_ns, pulled->told_ns));
    printf("  falling silent to the message     %7.1f          1000.0\n",
           ms_since(stalled->last_frame_ns, stalled->told_ns));
    printf("frames: %llu shown, %llu overtaken by newer ones, %llu lost\n",
           (unsigned long long)b->status.given, (unsigned long long)b->status.late,
           (unsigned long long)b->status.lost);
}

rlf_result bench_live(const char *source, int32_t threads)
{
    static live_bench b; /* large: timing samples */
    char text[1024];
    memset(&b, 0, sizeof(b));
    (void)snprintf(text, sizeof(text),
                   "simulated:bench?of=%.900s&unplug_after=%.1f&replug_after=%.1f&stall=%.1f@%.1f",
                   source, UNPLUG_S, REPLUG_S, STALL_S, STALL_AT_S);
    session_options options = session_options_default();
    options.source = text;
    options.use_default_scene = true;
    options.is_gravity_set = true;
    options.gravity = rlf_world_def_default().gravity;
    options.thread_count = threads;
    rlf_set_log(note_line, NULL);
    b.open_ns = rlf_clock_ns();
    rlf_result result = session_open(&options, &b.s);
    if (result != RLF_OK) {
        return result;
    }
    result = run(&b);
    if (result == RLF_OK && !command_interrupted) {
        print(&b, source);
    }
    session_close(&b.s);
    return result;
}
