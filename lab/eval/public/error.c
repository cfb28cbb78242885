/* How far a normal is from the published one. */
#include "eval/public/frame.h"

double public_error_deg(const public_frame *f, int32_t pixel, rlf_vec3 normal)
{
    const uint16_t *png = &f->truth[3 * (size_t)pixel];
    rlf_vec3 real = {1.0 - 2.0 * png[0] / 65535.0, 1.0 - 2.0 * png[1] / 65535.0,
                     1.0 - 2.0 * png[2] / 65535.0};
    double cosine = rlf_dot(normal, rlf_normalize(real));
    cosine = cosine < 0.0 ? -cosine : cosine;
    return rlf_acos(rlf_min(cosine, 1.0)) * 180.0 / RLF_PI;
}
