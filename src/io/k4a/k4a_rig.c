/* Modes and calibration of Azure Kinect and Femto cameras. */
#include "io/k4a/k4a.h"

#define DEPTH_MAX_M 6.0
typedef struct depth_mode {
    int32_t width, height, mode, rate_max;
    double depth_min_m;
} depth_mode;

/* The first one is the default. */
static const depth_mode depth_modes[] = {
    {640, 576, K4A_DEPTH_MODE_NFOV_UNBINNED, 30, 0.5},
    {320, 288, K4A_DEPTH_MODE_NFOV_2X2BINNED, 30, 0.5},
    {512, 512, K4A_DEPTH_MODE_WFOV_2X2BINNED, 30, 0.25},
    {1024, 1024, K4A_DEPTH_MODE_WFOV_UNBINNED, 15, 0.25},
};
#define DEPTH_MODE_COUNT ((int32_t)(sizeof(depth_modes) / sizeof(depth_modes[0])))

typedef struct color_mode {
    int32_t width, height, resolution, rate_max;
} color_mode;

static const color_mode color_modes[] = {
    {1280, 720, K4A_COLOR_RESOLUTION_720P, 30},   {1920, 1080, K4A_COLOR_RESOLUTION_1080P, 30},
    {2560, 1440, K4A_COLOR_RESOLUTION_1440P, 30}, {2048, 1536, K4A_COLOR_RESOLUTION_1536P, 30},
    {3840, 2160, K4A_COLOR_RESOLUTION_2160P, 30}, {4096, 3072, K4A_COLOR_RESOLUTION_3072P, 15},
};
#define COLOR_MODE_COUNT ((int32_t)(sizeof(color_modes) / sizeof(color_modes[0])))

static const depth_mode *find_depth(const io_mode *wish)
{
    for (int32_t i = 0; i < DEPTH_MODE_COUNT; i++) {
        const depth_mode *m = &depth_modes[i];
        if (wish->width == 0 || (wish->width == m->width && wish->height == m->height)) {
            return m;
        }
    }
    return NULL;
}

static const color_mode *find_color(const io_mode *wish)
{
    for (int32_t i = 0; i < COLOR_MODE_COUNT; i++) {
        const color_mode *m = &color_modes[i];
        if (wish->width == 0 || (wish->width == m->width && wish->height == m->height)) {
            return m;
        }
    }
    return NULL;
}

static int fps_of(int32_t rate)
{
    return rate == 5 ? K4A_FPS_5 : rate == 15 ? K4A_FPS_15 : rate == 30 ? K4A_FPS_30 : -1;
}

rlf_result io_k4a_configure(k4a *k, const io_mode *depth, const io_mode *color)
{
    const depth_mode *d = find_depth(depth);
    const color_mode *c = find_color(color);
    if (d == NULL) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: the camera has no depth mode %d x %d: use 640x576, 320x288, 512x512 "
                        "or 1024x1024",
                        k->source, (int)depth->width, (int)depth->height);
    }
    if (c == NULL) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: the camera has no colour mode %d x %d: use 1280x720, 1920x1080, "
                        "2560x1440, 2048x1536, 3840x2160 or 4096x3072",
                        k->source, (int)color->width, (int)color->height);
    }
    const int32_t rate_max = d->rate_max < c->rate_max ? d->rate_max : c->rate_max;
    int32_t rate =
        depth->frames_per_second > 0 ? depth->frames_per_second : color->frames_per_second;
    rate = rate > 0 ? rate : rate_max;
    if (fps_of(rate) < 0 || rate > rate_max ||
        (color->frames_per_second > 0 && color->frames_per_second != rate)) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: both cameras run at one rate of 5, 15 or 30 pictures per second, in "
                        "these modes at most %d",
                        k->source, (int)rate_max);
    }
    k->configuration = (k4a_configuration){.color_format = K4A_FORMAT_COLOR_MJPG,
                                           .color_resolution = c->resolution,
                                           .depth_mode = d->mode,
                                           .camera_fps = fps_of(rate)};
    k->frames_per_second = rate;
    k->count.interval_ns = 1000000000 / rate;
    k->rig.depth_min_m = d->depth_min_m;
    k->rig.depth_max_m = DEPTH_MAX_M;
    k->rig.noise = IO_TIME_OF_FLIGHT_NOISE; /* as the Kinect v2, by the same principle */
    return RLF_OK;
}

static rlf_result read_camera(const k4a *k, const k4a_camera *in, const char *which,
                              rlf_camera *out)
{
    const k4a_lens *l = &in->lens;
    /* The early model differs in what is 0 in every camera that was sold. */
    const bool is_same = l->codx == 0.0F && l->cody == 0.0F && l->p1 == 0.0F && l->p2 == 0.0F;
    if (in->type != K4A_LENS_BROWN_CONRADY && !(in->type == K4A_LENS_RATIONAL_6KT && is_same)) {
        return rlf_fail(RLF_ERROR_DEVICE,
                        "%s: the %s lens is of a model that is not read (type %d of k4a): use "
                        "another camera",
                        k->source, which, in->type);
    }
    *out = (rlf_camera){.width = in->width,
                        .height = in->height,
                        .fx = (double)l->fx,
                        .fy = (double)l->fy,
                        .cx = (double)l->cx,
                        .cy = (double)l->cy,
                        .distortion_model = RLF_DISTORTION_RATIONAL_POLYNOMIAL,
                        .distortion = {(double)l->k1, (double)l->k2, (double)l->p1, (double)l->p2,
                                       (double)l->k3, (double)l->k4, (double)l->k5, (double)l->k6}};
    return rlf_camera_check(out, k->source);
}

rlf_result io_k4a_read_rig(k4a *k)
{
    k4a_calibration in = {0};
    if (k->api->device_get_calibration(k->device, k->configuration.depth_mode,
                                       k->configuration.color_resolution, &in) != K4A_SUCCEEDED) {
        return rlf_fail(RLF_ERROR_DEVICE,
                        "%s: the camera does not give its calibration: plug it in again",
                        k->source);
    }
    k->rig.has_color = true;
    rlf_result result = read_camera(k, &in.depth, "depth", &k->rig.depth);
    result = result == RLF_OK ? read_camera(k, &in.color, "colour", &k->rig.color) : result;
    const k4a_extrinsics *e = &in.extrinsics[K4A_CAMERA_DEPTH][K4A_CAMERA_COLOR];
    if (result == RLF_OK &&
        !io_live_pose(e->rotation, e->translation, 0.001, &k->rig.T_color_depth)) {
        result = rlf_fail(RLF_ERROR_DEVICE,
                          "%s: its transform from depth to colour is no rotation: use another "
                          "camera",
                          k->source);
    }
    return result;
}
