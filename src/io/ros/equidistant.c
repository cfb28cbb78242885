/* The equidistant lens (Kannala and Brandt 2006, OpenCV's fisheye): the distance from the centre
 * goes as t (1 + k1 t^2 + k2 t^4 + k3 t^6 + k4 t^8) of the angle t. Relief's lens is fitted to it.
 */
#include "io/live/driver.h"
#include "io/ros/messages.h"

#include <math.h>

#define SAMPLES_WIDE 24
#define SAMPLES_HIGH 18
#define SAMPLE_COUNT (SAMPLES_WIDE * SAMPLES_HIGH)
/* A ray farther from the axis leaves a pinhole's picture: 80 degrees. */
#define ANGLE_MAX 1.4
#define STEPS 20

static double distorted(const double k[4], double t)
{
    const double s = t * t;
    return t * (1.0 + s * (k[0] + s * (k[1] + s * (k[2] + s * k[3]))));
}

static double slope(const double k[4], double t)
{
    const double s = t * t;
    return 1.0 + s * (3.0 * k[0] + s * (5.0 * k[1] + s * (7.0 * k[2] + s * 9.0 * k[3])));
}

/* The angle of a distance; false when the lens does not see that far, or not this way round. */
static bool angle_of(const double k[4], double distance, double *out)
{
    double t = distance;
    for (int i = 0; i < STEPS; i++) {
        const double down = slope(k, t);
        if (!(down > 0.1)) {
            return false;
        }
        t -= (distorted(k, t) - distance) / down;
    }
    *out = t;
    return t >= 0.0 && t < ANGLE_MAX && fabs(distorted(k, t) - distance) < 1e-9;
}

double io_equidistant_lens(const double k[4], rlf_camera *c)
{
    io_lens_sample samples[SAMPLE_COUNT];
    for (int i = 0; i < SAMPLE_COUNT; i++) {
        const double u = (c->width - 1.0) * (i % SAMPLES_WIDE) / (SAMPLES_WIDE - 1);
        const double v = (c->height - 1.0) * (i / SAMPLES_WIDE) / (SAMPLES_HIGH - 1);
        const double x = (u - c->cx) / c->fx, y = (v - c->cy) / c->fy;
        const double distance = sqrt(x * x + y * y);
        double t;
        if (!angle_of(k, distance, &t)) {
            return INFINITY;
        }
        const double scale = distance > 1e-9 ? rlf_sin(t) / (rlf_cos(t) * distance) : 1.0;
        samples[i] = (io_lens_sample){x * scale, y * scale, u, v};
    }
    return io_lens_fit(samples, SAMPLE_COUNT, c);
}
