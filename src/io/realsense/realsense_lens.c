/* RealSense lens models. The name of a model does not say what it means: "inverse" Brown-Conrady
 * was undone by the polynomial in early versions and is projected with it in later ones. So the
 * library itself is asked where points go, and Relief's model is fitted to the answers. */
#include "io/realsense/realsense.h"

#include "io/live/driver.h"

#include <math.h>

#define SAMPLES_WIDE 24
#define SAMPLES_HIGH 18
#define SAMPLE_COUNT (SAMPLES_WIDE * SAMPLES_HIGH)

static bool has_distortion(const rs2_intrinsics *in)
{
    bool is_zero = true;
    for (int i = 0; i < 5; i++) {
        is_zero = is_zero && fabsf(in->coeffs[i]) < 1e-7F;
    }
    return in->model != RS2_DISTORTION_NONE && !is_zero;
}

/* Rays of an even grid over the pinhole's picture, and the pixels where the library sees them. */
static void sample_lens(const realsense_api *api, const rs2_intrinsics *in, io_lens_sample *out)
{
    for (int i = 0; i < SAMPLE_COUNT; i++) {
        const float u = (float)in->width * (float)(i % SAMPLES_WIDE) / (SAMPLES_WIDE - 1);
        const float v = (float)in->height * (float)(i / SAMPLES_WIDE) / (SAMPLES_HIGH - 1);
        const float point[3] = {(u - in->ppx) / in->fx, (v - in->ppy) / in->fy, 1.0F};
        float pixel[2] = {0.0F, 0.0F};
        api->project_point_to_pixel(pixel, in, point);
        out[i] = (io_lens_sample){(double)point[0], (double)point[1], (double)pixel[0],
                                  (double)pixel[1]};
    }
}

double io_realsense_lens(const realsense_api *api, const rs2_intrinsics *in, rlf_camera *out)
{
    *out = (rlf_camera){.width = in->width,
                        .height = in->height,
                        .fx = (double)in->fx,
                        .fy = (double)in->fy,
                        .cx = (double)in->ppx,
                        .cy = (double)in->ppy};
    if (!has_distortion(in)) {
        return 0.0;
    }
    if (in->model == RS2_DISTORTION_BROWN_CONRADY) {
        out->distortion_model = RLF_DISTORTION_PLUMB_BOB;
        for (int i = 0; i < 5; i++) {
            out->distortion[i] = (double)in->coeffs[i];
        }
        return 0.0;
    }
    if (api->project_point_to_pixel == NULL) {
        return INFINITY;
    }
    io_lens_sample samples[SAMPLE_COUNT];
    sample_lens(api, in, samples);
    return io_lens_fit(samples, SAMPLE_COUNT, out);
}

rlf_result io_realsense_check(const realsense_api *api, rs2_error **error, rlf_result result,
                              const char *source, const char *cure)
{
    if (*error == NULL) {
        return RLF_OK;
    }
    const char *message = api->get_error_message(*error);
    rlf_fail(result, "%s: librealsense2 says \"%.200s\": %s", source,
             message != NULL ? message : "nothing", cure);
    api->free_error(*error);
    *error = NULL;
    return result;
}

bool io_realsense_forget(const realsense_api *api, rs2_error **error)
{
    const bool had_error = *error != NULL;
    if (had_error) {
        api->free_error(*error);
        *error = NULL;
    }
    return had_error;
}
