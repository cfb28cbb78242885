/* `relief record`: any source into a file or a folder. */
#define _POSIX_C_SOURCE 200809L
#include "command.h"
#include "options.h"
#include "recorder.h"

#include <getopt.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define PROGRESS_INTERVAL_NS 200000000
/* Longer pauses within a recording are not waited for. */
#define PAUSE_MAX_NS 1000000000

typedef struct record_options {
    const char *source;
    recorder_options recorder;
    int64_t frames;  /* -1 = all */
    int64_t seconds; /* -1 = all */
    bool is_quiet;
} record_options;

static void print_help(void)
{
    printf("usage: relief record SOURCE FILE.mcap [OPTIONS]\n"
           "       relief record SOURCE FOLDER/   [OPTIONS]\n"
           "       relief record SOURCE ros2:/CAMERA  [OPTIONS]\n\n"
           "Records a camera, or turns a recording into another kind. FILE.mcap has ROS 2\n"
           "messages that any MCAP program reads; FOLDER/ (with the slash, or a folder that is\n"
           "there) has the TUM layout: depth.txt, rgb.txt, camera.json, pictures. Depth is kept\n"
           "bit by bit. Ctrl-C ends the recording and closes the file properly. After a crash or\n"
           "a power cut at most the last second is missing. ros2:/CAMERA keeps nothing: other\n"
           "programs and machines see the camera live, with ?profile=lan and ?domain=N.\n\n"
           "  --frames N            stop after N frames\n"
           "  --seconds N           stop after N seconds\n"
           "  --codec NAME          of depth in FILE.mcap: rvl (default) or png\n"
           "  --jpeg-quality N      of colour: 1 to 100, default 90\n"
           "  --lossless color      colour as PNG: bit by bit, but slow and large; the default\n"
           "                        of FOLDER/\n"
           "  --compression NAME    of FILE.mcap: zstd (default), lz4 or none\n"
           "  --quiet               no progress and no summary\n"
           "  --plugin FILE         a plug-in that brings a camera or a format; any number\n\n"
           "examples:\n"
           "  relief record path/to/clip clip.mcap\n"
           "  relief record clip.mcap folder/\n"
           "  relief record synthetic:room room.mcap --frames 90 --lossless color\n");
}

static bool is_folder_name(const char *path)
{
    const size_t length = strlen(path);
    return length > 0 && path[length - 1] == '/';
}

static int parse(int argc, char **argv, record_options *o)
{
    *o = (record_options){.recorder = recorder_options_default(), .frames = -1, .seconds = -1};
    const int32_t quality = o->recorder.def.jpeg_quality;
    o->recorder.def.jpeg_quality = -1; /* not said */
    const option_def options[] = {
        ROW_INT64("frames", &o->frames, 1, 1000000000),
        ROW_INT64("seconds", &o->seconds, 1, 1000000000),
        RECORDER_OPTIONS(&o->recorder),
        ROW_FLAG("quiet", &o->is_quiet),
        ROW_PLUGIN,
        {0},
    };
    const int status = options_parse("record", argc, argv, options, print_help);
    if (status >= 0) {
        return status;
    }
    if (argc - optind != 2) {
        return command_usage("record", "needs a SOURCE and where to record it: FILE.mcap, "
                                       "FOLDER/ or ros2:/CAMERA");
    }
    o->source = argv[optind];
    if (!recorder_take_path(argv[optind + 1], &o->recorder)) {
        return command_usage("record", "'%s': " RECORDER_PATH, argv[optind + 1]);
    }
    if (o->recorder.def.jpeg_quality < 0) {
        o->recorder.def.jpeg_quality = is_folder_name(o->recorder.path) ? 0 : quality;
    }
    return -1;
}

typedef struct progress {
    int64_t start_ns, shown_ns;
    int64_t frames, total; /* total -1 = not known */
    bool is_paced;
    int64_t time_ns, due_ns; /* of the last frame: its own time, and when it was due */
} progress;

static void show_progress(progress *p, recorder *r)
{
    const int64_t now = rlf_clock_ns();
    if (now - p->shown_ns < PROGRESS_INTERVAL_NS || !isatty(STDERR_FILENO)) {
        return;
    }
    p->shown_ns = now;
    const double seconds = 1e-9 * (double)(now - p->start_ns);
    const recorder_status s = recorder_get_status(r);
    fprintf(stderr, "\r%lld frames, %.1f MB", (long long)p->frames, 1e-6 * (double)s.written.bytes);
    if (p->total > 0 && p->frames > 0) {
        const double left = seconds * (double)(p->total - p->frames) / (double)p->frames;
        fprintf(stderr, ", %.0f %%, %.0f s left", 100.0 * (double)p->frames / (double)p->total,
                left > 0.0 ? left : 0.0);
    }
    fprintf(stderr, "   ");
}

static bool is_done(const record_options *o, const progress *p, const rlf_frame *frame,
                    int64_t first_ns)
{
    const bool has_frames = o->frames >= 0 && p->frames >= o->frames;
    const double elapsed_s = 1e-9 * (double)(frame->time_ns - first_ns);
    /* The next frame would be over the time. */
    return has_frames || (o->seconds >= 0 && elapsed_s >= (double)o->seconds);
}

static int64_t total_of(const record_options *o, const rlf_source_info *info)
{
    int64_t total = info->frame_count;
    const double by_time = o->seconds >= 0 ? (double)o->seconds * info->frames_per_second : 0.0;
    if (by_time > 0.0 && (total < 0 || by_time < (double)total)) {
        total = (int64_t)by_time;
    }
    return o->frames >= 0 && (total < 0 || o->frames < total) ? o->frames : total;
}

/* To who looks on, frames of a file go when they are due. */
static void wait_until_due(progress *p, int64_t time_ns)
{
    const int64_t now_ns = rlf_clock_ns();
    const int64_t wait_ns = p->due_ns + (time_ns - p->time_ns) - now_ns;
    const bool is_on = p->frames > 0 && wait_ns < PAUSE_MAX_NS && wait_ns > -PAUSE_MAX_NS;
    p->due_ns = is_on ? now_ns + wait_ns : now_ns;
    p->time_ns = time_ns;
    if (is_on && wait_ns > 0) {
        const struct timespec rest = {.tv_sec = (time_t)(wait_ns / 1000000000),
                                      .tv_nsec = (long)(wait_ns % 1000000000)};
        (void)nanosleep(&rest, NULL); /* Ctrl-C ends it */
    }
}

static rlf_result copy_frames(const record_options *o, rlf_source *source, recorder *r, progress *p)
{
    rlf_result result = RLF_OK;
    int64_t first_ns = 0;
    while (!command_interrupted && !recorder_has_failed(r)) {
        rlf_frame frame;
        result = rlf_source_next(source, &frame);
        if (result != RLF_OK && result != RLF_NO_FRAME) {
            break;
        }
        if (result == RLF_OK) {
            if (p->is_paced) {
                wait_until_due(p, frame.time_ns);
            }
            first_ns = p->frames == 0 ? frame.time_ns : first_ns;
            p->frames++;
            if (is_done(o, p, &frame, first_ns)) {
                break;
            }
        }
        if (!o->is_quiet) {
            show_progress(p, r);
        }
    }
    return result == RLF_END || result == RLF_NO_FRAME ? RLF_OK : result;
}

static void print_summary(const record_options *o, const recorder_status *s, double seconds,
                          const rlf_source_status *source)
{
    printf("%s: %llu %s, %.1f MB in %.1f s\n", o->recorder.path,
           (unsigned long long)s->written.frames, command_frames((int64_t)s->written.frames),
           1e-6 * (double)s->written.bytes, seconds);
    if (s->dropped > 0) {
        printf("%llu frames were dropped: the disk or the processor is too slow for them\n",
               (unsigned long long)s->dropped);
    }
    if (source->lost + source->late + source->damaged > 0) {
        printf("of the source's frames %llu were lost, %llu late, %llu damaged\n",
               (unsigned long long)source->lost, (unsigned long long)source->late,
               (unsigned long long)source->damaged);
    }
}

/* The source is the recorder's once it is tapped. */
static int record(const record_options *o, rlf_source **source)
{
    recorder *r = NULL;
    const rlf_source_info *info = rlf_source_get_info(*source);
    progress p = {.start_ns = rlf_clock_ns(),
                  .total = total_of(o, info),
                  .is_paced = !info->is_live && strncmp(o->recorder.path, "ros2:", 5) == 0};
    rlf_result result = recorder_create(&o->recorder, info, &r);
    if (result == RLF_ERROR_INVALID) { /* what is read */
        return command_usage("record", "%s", rlf_error_text());
    }
    if (result == RLF_OK) {
        result = recorder_tap(r, source);
    }
    if (result == RLF_OK) {
        result = copy_frames(o, *source, r, &p);
    }
    int status = result == RLF_OK ? EXIT_DONE : command_failed();
    if (status == EXIT_DONE && command_interrupted && p.frames == 0) {
        fprintf(stderr, "relief record: stopped before the first frame; %s holds none\n",
                o->recorder.path);
        status = 128 + command_interrupted;
    }
    recorder_status s = {0};
    if (recorder_destroy(&r, &s) != RLF_OK && status == EXIT_DONE) {
        status = command_failed();
    }
    if (!o->is_quiet && isatty(STDERR_FILENO)) {
        fprintf(stderr, "\r%60s\r", "");
    }
    if (!o->is_quiet && s.written.frames > 0) {
        const rlf_source_status counts = rlf_source_get_status(*source);
        print_summary(o, &s, 1e-9 * (double)(rlf_clock_ns() - p.start_ns), &counts);
    }
    return status;
}

int record_main(int argc, char **argv)
{
    record_options options;
    const int status = parse(argc, argv, &options);
    if (status >= 0) {
        return status;
    }
    rlf_source *source = NULL;
    if (rlf_open_source(options.source, NULL, &source) != RLF_OK) {
        return command_not_opened("record");
    }
    const int done = record(&options, &source);
    rlf_source_destroy(&source);
    return done;
}
