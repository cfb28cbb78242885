/* One Azure Kinect or Femto camera that streams. */
#ifndef RLF_IO_K4A_K4A_H
#define RLF_IO_K4A_K4A_H

#include "io/driver/live.h"
#include "io/k4a/k4a_api.h"

typedef struct k4a {
    const k4a_api *api;
    char source[256], serial[64];
    k4a_device_t device;
    bool is_streaming;
    rlf_rig rig;
    k4a_configuration configuration;
    int32_t frames_per_second;
    rlf_image_rgba8 color;
    k4a_image_t held; /* the depth picture that was given last; the library's */
    io_live_count count;
    uint64_t damaged, unpaired;
} k4a;

/* Modes of the camera that are asked for; the defaults where 0. */
rlf_result io_k4a_configure(k4a *k, const io_mode *depth, const io_mode *color);

/* Reads the rig of the configured modes. */
rlf_result io_k4a_read_rig(k4a *k);

/* A rlf_source's `next`. */
rlf_result io_k4a_next(void *self, rlf_frame *out);

#endif
