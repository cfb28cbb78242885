/* Narrow faces beside contours.
 *
 * The side of a chair's leg is a pixel or two wide. The sensor drops the outer one, no window fits
 * the inner one, and all of it looks like the front going on. But a face that is seen at such a
 * slant is several times as noisy as the front (Fankhauser et al. 2015), and it lies behind it. So
 * where nothing moves, the pixels along the contour are held against the front's plane: either its
 * noise explains what they are off by, or they are on another face. That face's slope cannot be
 * measured; it is taken to be at a right angle to the front, as the sides of made things are, if
 * such a face can be seen from here at all.
 *
 * Of a side that is one pixel wide nothing is ever seen. A thing that is no wider than a leg or a
 * pole is then taken to be as deep as it is wide: if its side would reach the outermost pixel's
 * ray, that pixel is on it. */
#include "surface/normals/contour.h"

static const double LEAST_FLAT = 0.985;  /* cosine between two normals of a front */
static const double LEAST_FACING = 0.05; /* cosine between a ray and a face that it sees */
/* A pixel's evidence: half of the square of its sigmas from the front, at most, and what the wider
 * noise of the other face costs, the logarithm of the ratio. */
static const float MOST_SIGMAS = 5.0f, PRICE = 2.0f;
static const float PLANE_SIGMAS = 0.6f; /* error of the front's plane where it is continued */
static const float MOST_BEFORE = 2.0f;  /* sigmas, mean: a side does not lie before its front */
/* Metres. A leg or a pole is as deep as it is wide; what is wider may be a board. */
static const double MOST_POLE = 0.06;
/* Pixels: what is narrower is not met by a pixel's ray, what is wider has been seen. */
static const double LEAST_SIDE = 0.5, MOST_SIDE = 2.0;

enum { TO_FRONT = 2, ALONG = 2, LEAST_PIXELS = 2 };

typedef struct place {
    int32_t x, y;
    float out_x, out_y;
    ptrdiff_t pixel, seen; /* itself; the first seen one on the way in */
    int32_t steps;         /* from one to the other */
} place;

/* A pixel of the front, and its plane. */
typedef struct front {
    rlf_vec3 normal;
    double offset; /* n p of its points */
} front;

static ptrdiff_t move(const contour_sides *job, const place *at, float out, float along)
{
    float x = (float)at->x + out * at->out_x - along * at->out_y;
    float y = (float)at->y + out * at->out_y + along * at->out_x;
    return (ptrdiff_t)(int32_t)(y + 0.5f) * job->planes.width + (int32_t)(x + 0.5f);
}

static rlf_vec3 ray_at(const contour_sides *job, ptrdiff_t i)
{
    return rlf_vec3_make(job->planes.ray_x[i], job->planes.ray_y[i], 1.0);
}

static bool goes_on(const contour_sides *job, float from, float to)
{
    return to > 0.0f && !depth_step_between(&job->step, from, to);
}

/* Finds the first seen pixel on the way in; false when the thing ends before there is one and a
 * front behind it. */
static bool find_seen(const contour_sides *job, place *at)
{
    float last = job->planes.depth[at->pixel];
    for (int32_t k = 1; k <= CONTOUR_DROPPED + TO_FRONT + 1; k++) {
        ptrdiff_t i = move(job, at, -(float)k, 0.0f);
        if (!goes_on(job, last, job->planes.depth[i]) || (at->steps == 0 && k > CONTOUR_DROPPED)) {
            return false;
        }
        last = job->planes.depth[i];
        if (at->steps == 0 && job->planes.known[i] != 0) {
            at->steps = k;
            at->seen = i;
        }
        if (at->steps > 0 && k == at->steps + TO_FRONT + 1) {
            return true;
        }
    }
    return at->steps > 0;
}

static bool find_front(const contour_sides *job, const place *at, front *out)
{
    ptrdiff_t i = move(job, at, -(float)(at->steps + TO_FRONT), 0.0f);
    ptrdiff_t next = move(job, at, -(float)(at->steps + TO_FRONT + 1), 0.0f);
    if (job->planes.known[i] == 0 || job->planes.known[next] == 0) {
        return false;
    }
    out->normal = image_grid_vector(job->planes.normal, i);
    out->offset = job->planes.depth[i] * rlf_dot(out->normal, ray_at(job, i));
    return rlf_dot(out->normal, image_grid_vector(job->planes.normal, next)) > LEAST_FLAT;
}

/* Square to the front and to the contour, facing the camera; false when it cannot. */
static bool find_side(const contour_sides *job, const place *at, const front *f, rlf_vec3 *out)
{
    rlf_vec3 ray = ray_at(job, at->pixel), inside = ray_at(job, move(job, at, -2.0f, 0.0f));
    rlf_vec3 one = ray_at(job, move(job, at, 0.0f, -2.0f));
    rlf_vec3 two = ray_at(job, move(job, at, 0.0f, 2.0f));
    double at_one = rlf_dot(f->normal, one), at_two = rlf_dot(f->normal, two);
    if (!(at_one < -LEAST_FACING) || !(at_two < -LEAST_FACING)) {
        return false;
    }
    rlf_vec3 crease = rlf_sub(rlf_scale(two, 1.0 / at_two), rlf_scale(one, 1.0 / at_one));
    rlf_vec3 side = rlf_normalize(rlf_cross(crease, f->normal));
    *out = rlf_scale(side, rlf_dot(side, rlf_sub(ray, inside)) < 0.0 ? -1.0 : 1.0);
    double facing = rlf_dot(*out, ray);
    return facing < 0.0 && facing * facing > LEAST_FACING * LEAST_FACING * rlf_dot(ray, ray);
}

/* What has been seen of the pixels along the contour speaks against the front. */
static bool is_off_front(const contour_sides *job, const place *at, const front *f)
{
    float evidence = 0.0f, before = 0.0f;
    int32_t count = 0;
    for (int32_t k = -ALONG; k <= ALONG; k++) {
        ptrdiff_t i = move(job, at, -(float)at->steps, (float)k);
        float z = (float)(f->offset / rlf_dot(f->normal, ray_at(job, i)));
        if (job->planes.known[i] == 0 || !(job->frames[i] > 0.0f) || !(z > 0.0f)) {
            continue;
        }
        float own = 1.0f / job->mean[i], off = own - z,
              sigma = rlf_kernel_sigma(job->step.noise, z);
        if (!goes_on(job, own, z)) {
            continue; /* it is of another thing */
        }
        float left = sigma * sigma * (1.0f / job->frames[i] + PLANE_SIGMAS * PLANE_SIGMAS);
        float square = off * off / left, most = MOST_SIGMAS * MOST_SIGMAS;
        evidence += 0.5f * (square < most ? square : most) - PRICE;
        before -= off / sigma;
        count++;
    }
    return count >= LEAST_PIXELS && evidence > 0.0f && before < MOST_BEFORE * (float)count;
}

/* Pixels across what ends behind the place, on the way in; 0 when it does not. */
static int32_t count_across(const contour_sides *job, const place *at)
{
    float last = job->planes.depth[at->pixel];
    for (int32_t k = 1; k <= CONTOUR_BORDER; k++) {
        float z = job->planes.depth[move(job, at, -(float)k, 0.0f)];
        if (!goes_on(job, last, z)) {
            return z > last ? k : 0;
        }
        last = z;
    }
    return 0;
}

/* The place is the outermost pixel of a pole that shows its side: of a square one, it would be
 * so wide that the ray meets it, and not so wide that it would have been seen by now. */
static bool is_pole(const contour_sides *job, const place *at, const front *f, rlf_vec3 side)
{
    float z = job->planes.depth[at->pixel], next = job->planes.depth[move(job, at, 1.0f, 0.0f)];
    int32_t across = next > z && !goes_on(job, z, next) ? count_across(job, at) : 0;
    if (across == 0) {
        return false;
    }
    rlf_vec3 ray = ray_at(job, at->pixel), other = ray_at(job, move(job, at, -(float)across, 0.0f));
    double slant = rlf_dot(side, ray) / rlf_dot(f->normal, ray); /* side to front, in the image */
    double before = across / (1.0 + slant), wide = rlf_length(rlf_sub(ray, other)) * z;
    double beside = before * slant;
    return wide * before < MOST_POLE * across && beside > LEAST_SIDE && beside < MOST_SIDE;
}

bool contour_side_find(const contour_sides *job, int32_t x, int32_t y, float out_x, float out_y,
                       float normal[3], ptrdiff_t *last)
{
    place at = {x, y, out_x, out_y, (ptrdiff_t)y * job->planes.width + x, 0, 0};
    front f;
    rlf_vec3 side;
    if (job->mean == NULL || temporal_may_move(job->stage, x, y) || !find_seen(job, &at) ||
        !find_front(job, &at, &f) || !find_side(job, &at, &f, &side)) {
        return false;
    }
    bool is_off = is_off_front(job, &at, &f);
    *last = is_off ? at.seen : at.pixel;
    normal[0] = (float)side.x;
    normal[1] = (float)side.y;
    normal[2] = (float)side.z;
    return is_off || is_pole(job, &at, &f, side);
}
