/* How much wider lenses make a depth pixel's rectangle than the focal lengths alone.
 *
 * A lens that draws the border of the depth image together (Azure Kinect's: 1.3 times half-way to
 * the border, 2 in the corner) puts its pixels' rays further apart, and one that draws the colour
 * image apart shows them so. */
#include "camera/register.h"

#define SIZE_LEAST                                                                                 \
    1.01              /* less than that leaves no gaps: rectangles are widened against rounding    \
                       */
#define SIZE_MOST 8.0 /* more is no neighbour's ray: outside the lens rays are anything */

/* Where a far point on pixel i's ray is in the colour image. */
static bool project_far(const rlf_registration *r, size_t i, double uv[2])
{
    if (!(r->c[i] > 0.1f)) {
        return false;
    }
    const rlf_camera *k = &r->color;
    double u = (double)r->a[i] / r->c[i];
    double v = (double)r->b[i] / r->c[i];
    rlf_vec3 ray = {(u - k->cx) / k->fx, (v - k->cy) / k->fy, 1.0};
    return rlf_camera_project(k, ray, &uv[0], &uv[1]);
}

static double distance(double a, double b)
{
    return a < b ? b - a : a - b;
}

/* Steps between pixel i and the next ones along the row and the column, in rectangles. */
static double step_over(const rlf_registration *r, size_t i, size_t right, size_t below)
{
    double at[2];
    double across[2];
    double down[2];
    if (!project_far(r, i, at) || !project_far(r, right, across) || !project_far(r, below, down)) {
        return 1.0;
    }
    double wide = distance(across[0], at[0]) + distance(down[0], at[0]);
    double high = distance(across[1], at[1]) + distance(down[1], at[1]);
    double size = rlf_max(wide / (2.0 * r->pinhole.half_x), high / (2.0 * r->pinhole.half_y));
    return size > SIZE_LEAST && size < SIZE_MOST ? size : 1.0;
}

rlf_result registration_make_sizes(rlf_registration *r)
{
    size_t width = (size_t)r->width;
    size_t count = width * (size_t)r->height;
    double most = 1.0;
    r->size = rlf_alloc_array(count, sizeof(*r->size));
    if (r->size == NULL) {
        return RLF_ERROR_MEMORY;
    }
    for (size_t i = 0; i < count; i++) { /* the last of a row or column steps back instead */
        size_t right = i % width + 1 < width ? i + 1 : i - (width > 1);
        size_t below = i + width < count ? i + width : i - (count > width ? width : 0);
        double size = step_over(r, i, right, below);
        r->size[i] = (float)size;
        most = rlf_max(most, size);
    }
    if (most == 1.0) {
        rlf_free(r->size);
        r->size = NULL;
    }
    return RLF_OK;
}
