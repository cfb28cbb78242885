/* Frames of a camera between two processes by ROS 2: lost ones and how old they are on arrival.
 *   bench_ros2 [OPTIONS]           host and reader on this machine
 *   bench_ros2 --host [OPTIONS]    the host alone, until it is killed
 *   bench_ros2 --read [OPTIONS]    the reader alone
 * --seconds N (5), --profile local|lan|FILE, --color WxH (1920x1080; 0x0 = none), --name /CAMERA
 * (/bench). Depth is
 * 512 x 424 counts that RVL packs as it packs a room; 30 Hz. */
#define _POSIX_C_SOURCE 200809L
#include "io/source/backends.h"
#include "relief/io.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#define WIDTH 512
#define HEIGHT 424
#define FRAME_NS 33333333
#define RATE 30
#define TIMES_MAX 4096
#define TRIES 4 /* of a second each, for the host to be there */

typedef struct options {
    bool is_host, is_reader;
    int seconds, color_width, color_height;
    const char *profile, *name;
} options;

static int64_t wall_ns(void)
{
    struct timespec t = {0};
    clock_gettime(CLOCK_REALTIME, &t);
    return (int64_t)t.tv_sec * 1000000000 + t.tv_nsec;
}

static int fail(void)
{
    fprintf(stderr, "bench_ros2: %s\n", rlf_error_text());
    return 1;
}

/* ---- the host ------------------------------------------------------------------------------- */

static rlf_rig rig_of(const options *o)
{
    rlf_rig rig = rlf_rig_default();
    rig.depth = (rlf_camera){
        .width = WIDTH, .height = HEIGHT, .fx = 365, .fy = 365, .cx = 255.5, .cy = 211.5};
    rig.has_color = o->color_width > 0;
    if (rig.has_color) {
        rig.color = (rlf_camera){.width = o->color_width,
                                 .height = o->color_height,
                                 .fx = 0.55 * o->color_width,
                                 .fy = 0.55 * o->color_width,
                                 .cx = 0.5 * (o->color_width - 1),
                                 .cy = 0.5 * (o->color_height - 1)};
    }
    return rig;
}

/* Walls with steps and a millimetre or two of noise; the number is in the first pixel. */
static void fill_depth(uint16_t *depth, uint32_t number)
{
    uint32_t hash = number * 2654435761u + 1;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        hash = hash * 1664525u + 1013904223u;
        const int x = i % WIDTH, y = i / WIDTH;
        depth[i] = (uint16_t)(1200 + (x / 64) * 150 + y + (int)(hash >> 30));
    }
    depth[0] = (uint16_t)(1 + number % 60000);
}

static void fill_color(uint8_t *rgba, int width, int height)
{
    for (int i = 0; i < width * height; i++) {
        const int x = i % width, y = i / width;
        rgba[4 * i + 0] = (uint8_t)(x / 8 + y / 16);
        rgba[4 * i + 1] = (uint8_t)((x ^ y) & 0xf0);
        rgba[4 * i + 2] = (uint8_t)(y / 5);
        rgba[4 * i + 3] = 255;
    }
}

static int run_host(const options *o)
{
    char path[128];
    snprintf(path, sizeof(path), "ros2:%s?profile=%s", o->name, o->profile);
    const rlf_source_info info = {.rig = rig_of(o), .is_live = true};
    const rlf_recording_def def = rlf_recording_def_default();
    rlf_recording *out = NULL;
    uint16_t *depth = malloc(sizeof(uint16_t) * WIDTH * HEIGHT);
    const size_t color_size = (size_t)o->color_width * (size_t)o->color_height * 4;
    uint8_t *rgba = malloc(color_size + 1);
    if (depth == NULL || rgba == NULL || rlf_recording_open(path, &info, &def, &out) != RLF_OK) {
        return fail();
    }
    fill_color(rgba, o->color_width, o->color_height);
    struct timespec due;
    clock_gettime(CLOCK_MONOTONIC, &due);
    for (uint32_t number = 0;; number++) {
        fill_depth(depth, number);
        const rlf_frame frame = {.sequence = number,
                                 .time_ns = wall_ns(),
                                 .depth_u16 = depth,
                                 .depth_stride = WIDTH * 2,
                                 .depth_units_per_metre = 1000,
                                 .color = {color_size > 0 ? rgba : NULL, o->color_width,
                                           o->color_height, (ptrdiff_t)o->color_width * 4}};
        if (rlf_recording_add(out, &frame) != RLF_OK) {
            return fail();
        }
        due.tv_nsec += FRAME_NS;
        due.tv_sec += due.tv_nsec / 1000000000;
        due.tv_nsec %= 1000000000;
        clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, NULL);
    }
}

/* ---- the reader ----------------------------------------------------------------------------- */

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y ? 1 : 0;
}

typedef struct result {
    double ages_ms[TIMES_MAX], longest_gap_ms;
    int got, last, lost, sent, without_color;
} result;

static void read_frames(rlf_opened *source, const options *o, result *r)
{
    const int64_t end_ns = rlf_clock_ns() + (int64_t)o->seconds * 1000000000;
    int64_t before_ns = rlf_clock_ns();
    while (rlf_clock_ns() < end_ns && r->got < TIMES_MAX) {
        rlf_frame frame = {0};
        if (source->methods.next(source->self, &frame) != RLF_OK) {
            continue;
        }
        const int64_t now_ns = rlf_clock_ns();
        const double gap_ms = 1e-6 * (double)(now_ns - before_ns);
        before_ns = now_ns;
        r->longest_gap_ms = gap_ms > r->longest_gap_ms ? gap_ms : r->longest_gap_ms;
        const int number = frame.depth_u16[0];
        const int steps = r->got > 0 && number > r->last ? number - r->last : 1; /* or a new host */
        r->lost += steps - 1;
        r->sent += steps;
        r->last = number;
        r->without_color += frame.color.data == NULL && o->color_width > 0 ? 1 : 0;
        r->ages_ms[r->got++] = 1e-6 * (double)(wall_ns() - frame.time_ns);
    }
}

static int run_reader(const options *o)
{
    static result r;
    rlf_opened source = {0};
    const rlf_address address = {.source = "ros2:",
                                 .place = o->name,
                                 .key_count = 1,
                                 .keys = {"profile"},
                                 .values = {o->profile}};
    rlf_result opened = RLF_ERROR_DEVICE;
    for (int i = 0; i < TRIES && opened != RLF_OK; i++) {
        opened = io_backend_ros2.open(&address, &source);
    }
    if (opened != RLF_OK) {
        return fail();
    }
    read_frames(&source, o, &r);
    source.methods.destroy(source.self);
    if (r.got == 0) {
        fprintf(stderr, "bench_ros2: no frame came\n");
        return 1;
    }
    qsort(r.ages_ms, (size_t)r.got, sizeof(r.ages_ms[0]), by_size);
    printf("%s, colour %dx%d: %d of %d lost, %d without colour, age p50 %.1f p99 %.1f ms, longest "
           "gap %.0f ms\n",
           o->profile, o->color_width, o->color_height, r.lost, r.sent, r.without_color,
           r.ages_ms[r.got / 2], r.ages_ms[r.got * 99 / 100], r.longest_gap_ms);
    return 0;
}

/* ---- both ----------------------------------------------------------------------------------- */

static bool parse(int argc, char **argv, options *o)
{
    *o = (options){.seconds = 5,
                   .color_width = 1920,
                   .color_height = 1080,
                   .profile = "local",
                   .name = "/bench"};
    for (int i = 1; i < argc; i++) {
        const char *value = i + 1 < argc ? argv[i + 1] : "";
        if (strcmp(argv[i], "--host") == 0) {
            o->is_host = true;
        } else if (strcmp(argv[i], "--read") == 0) {
            o->is_reader = true;
        } else if (strcmp(argv[i], "--seconds") == 0) {
            o->seconds = atoi(value);
            i++;
        } else if (strcmp(argv[i], "--profile") == 0) {
            o->profile = value;
            i++;
        } else if (strcmp(argv[i], "--name") == 0) {
            o->name = value;
            i++;
        } else if (strcmp(argv[i], "--color") == 0 &&
                   sscanf(value, "%dx%d", &o->color_width, &o->color_height) == 2) {
            i++;
        } else {
            fprintf(stderr, "usage: bench_ros2 [--host | --read] [--seconds N] [--profile NAME] "
                            "[--color WxH] [--name /CAMERA]\n");
            return false;
        }
    }
    return true;
}

int main(int argc, char **argv)
{
    options o;
    if (!parse(argc, argv, &o)) {
        return 2;
    }
    if (o.is_host || o.is_reader) {
        return o.is_host ? run_host(&o) : run_reader(&o);
    }
    const pid_t host = fork();
    if (host == 0) {
        _exit(run_host(&o));
    }
    const int status = run_reader(&o);
    kill(host, SIGKILL);
    waitpid(host, NULL, 0);
    return status;
}
