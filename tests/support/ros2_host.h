/* A camera host of ROS 2 in a process of its own, whose pictures are known by their numbers. */
#ifndef RLF_TEST_ROS2_HOST_H
#define RLF_TEST_ROS2_HOST_H

#include "relief/io.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#define HOST_W 64
#define HOST_H 48
#define HOST_CW 96
#define HOST_CH 54
#define HOST_STEP_NS INT64_C(33333333)

/* Domains of tests that run side by side differ. */
static inline void host_choose_domain(void)
{
    char text[16];
    snprintf(text, sizeof(text), "%d", 20 + (int)(getpid() % 200));
    setenv("ROS_DOMAIN_ID", text, 1);
    unsetenv("RELIEF_ROS2_PROFILE");
}

static inline rlf_rig host_rig(void)
{
    rlf_rig rig = rlf_rig_default();
    rig.depth = (rlf_camera){.width = HOST_W,
                             .height = HOST_H,
                             .fx = 61.25,
                             .fy = 60.5,
                             .cx = 31.125,
                             .cy = 23.0625,
                             .distortion_model = RLF_DISTORTION_RATIONAL_POLYNOMIAL,
                             .distortion = {0.1, -0.02, 0.001, -0.002, 0.003, 0.05, 0.01, -0.004}};
    rig.has_color = true;
    rig.color = (rlf_camera){.width = HOST_CW,
                             .height = HOST_CH,
                             .fx = 80.0,
                             .fy = 80.25,
                             .cx = 48.5,
                             .cy = 26.75,
                             .distortion_model = RLF_DISTORTION_PLUMB_BOB,
                             .distortion = {0.05, -0.1, 0.0005, 0.001, 0.02}};
    rig.T_color_depth = (rlf_pose){.p = {0.025, -0.001, 0.004},
                                   .q = {0.0, 0.0087262032186418, 0.0, 0.99996192306417}};
    return rig;
}

static inline uint16_t host_depth(uint32_t number, int32_t x, int32_t y)
{
    const uint32_t hash = (number * 2654435761u + (uint32_t)(y * HOST_W + x)) * 2246822519u;
    return x == 0 && y == 0 ? (uint16_t)(number + 1) : (uint16_t)(500 + (hash >> 20) % 4000);
}

static inline uint8_t host_color(uint32_t number, int32_t x, int32_t y, int32_t channel)
{
    return (uint8_t)(number * 7 + (uint32_t)(x * 3 + y * 5 + channel * 64));
}

static inline void host_fill(uint32_t number, uint16_t *depth, uint8_t *rgba, rlf_frame *out)
{
    for (int32_t y = 0; y < HOST_H; y++) {
        for (int32_t x = 0; x < HOST_W; x++) {
            depth[y * HOST_W + x] = host_depth(number, x, y);
        }
    }
    for (int32_t i = 0; i < HOST_CW * HOST_CH; i++) {
        for (int32_t k = 0; k < 3; k++) {
            rgba[4 * i + k] = host_color(number, i % HOST_CW, i / HOST_CW, k);
        }
        rgba[4 * i + 3] = 255;
    }
    memset(out, 0, sizeof(*out));
    out->sequence = number;
    out->time_ns = (int64_t)number * HOST_STEP_NS;
    out->depth_u16 = depth;
    out->depth_stride = HOST_W * 2;
    out->depth_units_per_metre = 1000.0;
    out->color = (rlf_image_rgba8){rgba, HOST_CW, HOST_CH, HOST_CW * 4};
    out->color_time_ns = out->time_ns;
}

/* Until it is killed, 30 frames a second. */
static inline void host_run(const char *path)
{
    static uint16_t depth[HOST_W * HOST_H];
    static uint8_t rgba[HOST_CW * HOST_CH * 4];
    const rlf_source_info info = {.rig = host_rig()};
    rlf_recording_def def = rlf_recording_def_default();
    def.jpeg_quality = 0; /* what is packed is exact, too */
    rlf_recording *out = NULL;
    if (rlf_recording_open(path, &info, &def, &out) != RLF_OK) {
        fprintf(stderr, "%s\n", rlf_error_text());
        _exit(1);
    }
    struct timespec due;
    clock_gettime(CLOCK_MONOTONIC, &due);
    for (uint32_t number = 0;; number++) {
        rlf_frame frame;
        host_fill(number, depth, rgba, &frame);
        if (rlf_recording_add(out, &frame) != RLF_OK) {
            fprintf(stderr, "%s\n", rlf_error_text());
            _exit(1);
        }
        due.tv_nsec += HOST_STEP_NS;
        due.tv_sec += due.tv_nsec / 1000000000;
        due.tv_nsec %= 1000000000;
        clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, NULL);
    }
}

static inline pid_t host_start(const char *path)
{
    const pid_t pid = fork();
    if (pid == 0) {
        host_run(path);
    }
    return pid;
}

static inline void host_kill(pid_t pid)
{
    kill(pid, SIGKILL);
    waitpid(pid, NULL, 0);
}

#endif
