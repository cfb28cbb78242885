/* Narrow faces beside outlines.
 *
 * The side of a chair's leg is a pixel or two wide. The sensor drops the outer one, no window fits
 * the inner one, and all of it looks like the front going on. But a face that is seen at such a
 * slant is several times as noisy as the front (Fankhauser et al. 2015), and it lies behind it. So
 * where nothing moves, the pixels along the outline are held against the front's plane: either its
 * noise explains what they are off by, or they are on another face. That face's slope cannot be
 * measured; it is taken to be at a right angle to the front, as the sides of made things are, if
 * such a face can be seen from here at all.
 *
 * Of a side that is one pixel wide nothing is ever seen. A thing that is no wider than a leg or a
 * pole is then taken to be as deep as it is wide: if its side would reach the outermost pixel's
 * ray, that pixel is on it. */
#include "surface/normals/side.h"

static const float MOST_STEP = 0.03f;    /* share of the depth from pixel to pixel of one thing */
static const double LEAST_FLAT = 0.985;  /* cosine between two normals of a front */
static const double LEAST_FACING = 0.05; /* cosine between a ray and a face that it sees */
static const float MOST_APART = 0.04f; /* share of the depth: what is farther off is not its side */
/* A pixel's evidence: half of the square of its sigmas from the front, at most, and what the wider
 * noise of the other face costs, the logarithm of the ratio. */
static const float MOST_SIGMAS = 5.0f, PRICE = 2.0f;
static const float PLANE_SIGMAS = 0.6f; /* error of the front's plane where it is continued */
static const float MOST_BEFORE = 2.0f; /* sigmas, mean: a side does not lie in front of its front */

/* Metres. A leg or a pole is as deep as it is wide; what is wider may be a board. */
static const double MOST_POLE = 0.06;
/* Pixels: what is narrower is not met by a pixel's ray, what is wider has been seen. */
static const double LEAST_SIDE = 0.5, MOST_SIDE = 2.0;

enum { MOST_DROPPED = 3, TO_FRONT = 2, ALONG = 2, LEAST_PIXELS = 2, BORDER = 8 };

typedef struct place {
    int32_t x, y;
    float out_x, out_y;
    ptrdiff_t pixel;
    int32_t steps; /* from it inwards to the first known pixel */
} place;

/* The offset from a place to its first known pixel, as one byte that is not 0. */
enum { MARK_SIDE = 1 + 2 * MOST_DROPPED };

static ptrdiff_t move(const rlf_side_job *job, const place *at, float out, float along)
{
    float x = (float)at->x + out * at->out_x - along * at->out_y;
    float y = (float)at->y + out * at->out_y + along * at->out_x;
    return (ptrdiff_t)(int32_t)(y + 0.5f) * job->width + (int32_t)(x + 0.5f);
}

static rlf_vec3 ray_at(const rlf_side_job *job, ptrdiff_t i)
{
    return rlf_vec3_make(job->ray_x[i], job->ray_y[i], 1.0);
}

static rlf_vec3 normal_at(const rlf_side_job *job, ptrdiff_t i)
{
    return rlf_vec3_make(job->normal[0][i], job->normal[1][i], job->normal[2][i]);
}

/* Steps inwards from the place to the first known pixel; 0 when the thing ends before there is one
 * and a front behind it. */
static int32_t steps_to_known(const rlf_side_job *job, const place *at)
{
    float last = job->depth[at->pixel], most = MOST_STEP * last;
    int32_t found = 0;
    for (int32_t k = 1; k <= MOST_DROPPED + TO_FRONT + 1; k++) {
        ptrdiff_t i = move(job, at, -(float)k, 0.0f);
        if (!(rlf_kernel_abs(job->depth[i] - last) < most)) {
            return 0;
        }
        last = job->depth[i];
        found = found == 0 && job->known[i] != 0 ? k : found;
        if (found > MOST_DROPPED || (found > 0 && k == found + TO_FRONT + 1)) {
            break;
        }
    }
    return found <= MOST_DROPPED ? found : 0;
}

typedef struct front {
    rlf_vec3 normal;
    double offset; /* n p of its points */
} front;

static bool find_front(const rlf_side_job *job, const place *at, front *out)
{
    ptrdiff_t i = move(job, at, -(float)(at->steps + TO_FRONT), 0.0f);
    ptrdiff_t next = move(job, at, -(float)(at->steps + TO_FRONT + 1), 0.0f);
    if (job->known[i] == 0 || job->known[next] == 0) {
        return false;
    }
    out->normal = normal_at(job, i);
    out->offset = job->depth[i] * rlf_dot(out->normal, ray_at(job, i));
    return rlf_dot(out->normal, normal_at(job, next)) > LEAST_FLAT;
}

/* Square to the front and to the outline, facing the camera; false when it cannot. */
static bool find_side(const rlf_side_job *job, const place *at, const front *f, rlf_vec3 *out)
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
    double outwards = rlf_dot(side, rlf_sub(ray, inside)) < 0.0 ? -1.0 : 1.0;
    *out = rlf_scale(side, outwards);
    double facing = rlf_dot(*out, ray);
    return facing < 0.0 && facing * facing > LEAST_FACING * LEAST_FACING * rlf_dot(ray, ray);
}

/* What has been seen of the pixels along the outline speaks against the front. */
static bool is_off_front(const rlf_side_job *job, const place *at, const front *f)
{
    float evidence = 0.0f, before = 0.0f;
    int32_t count = 0;
    for (int32_t k = -ALONG; k <= ALONG; k++) {
        ptrdiff_t i = move(job, at, -(float)at->steps, (float)k);
        float z = (float)(f->offset / rlf_dot(f->normal, ray_at(job, i)));
        if (job->known[i] == 0 || !(job->frames[i] > 0.0f) || !(z > 0.0f)) {
            continue;
        }
        float off = 1.0f / job->mean[i] - z, sigma = rlf_kernel_sigma(job->noise, z);
        if (!(rlf_kernel_abs(off) < MOST_APART * z)) {
            continue;
        }
        float own = sigma * sigma * (1.0f / job->frames[i] + PLANE_SIGMAS * PLANE_SIGMAS);
        float square = off * off / own, most = MOST_SIGMAS * MOST_SIGMAS;
        evidence += 0.5f * (square < most ? square : most) - PRICE;
        before -= off / sigma;
        count++;
    }
    return count >= LEAST_PIXELS && evidence > 0.0f && before < MOST_BEFORE * (float)count;
}

/* Pixels across what ends behind the place, on the way in; 0 when it does not, within BORDER. */
static int32_t count_across(const rlf_side_job *job, const place *at)
{
    float last = job->depth[at->pixel];
    for (int32_t k = 1; k <= BORDER; k++) {
        float z = job->depth[move(job, at, -(float)k, 0.0f)];
        if (z > (1.0f + MOST_APART) * last) {
            return k;
        }
        if (!(rlf_kernel_abs(z - last) < MOST_STEP * last)) {
            return 0;
        }
        last = z;
    }
    return 0;
}

/* The place is the outermost pixel of a pole that shows its side: of a square one, it would be
 * so wide that the ray meets it, and not so wide that it would have been seen by now. */
static bool is_pole(const rlf_side_job *job, const place *at, const front *f, rlf_vec3 side)
{
    float z = job->depth[at->pixel];
    bool is_last = job->depth[move(job, at, 1.0f, 0.0f)] > (1.0f + MOST_APART) * z;
    int32_t across = is_last ? count_across(job, at) : 0;
    if (across == 0) {
        return false;
    }
    rlf_vec3 ray = ray_at(job, at->pixel), other = ray_at(job, move(job, at, -(float)across, 0.0f));
    double slant = rlf_dot(side, ray) / rlf_dot(f->normal, ray); /* side to front, in the image */
    double before = across / (1.0 + slant), wide = rlf_length(rlf_sub(ray, other)) * z;
    double beside = before * slant;
    return wide * before < MOST_POLE * across && beside > LEAST_SIDE && beside < MOST_SIDE;
}

static uint8_t mark_of(const rlf_side_job *job, const place *at)
{
    ptrdiff_t i = move(job, at, -(float)at->steps, 0.0f);
    int32_t dx = (int32_t)(i % job->width) - at->x, dy = (int32_t)(i / job->width) - at->y;
    return (uint8_t)(1 + (dy + MOST_DROPPED) * MARK_SIDE + dx + MOST_DROPPED);
}

bool rlf_side_find(const rlf_side_job *job, int32_t x, int32_t y, float out_x, float out_y)
{
    place at = {x, y, out_x, out_y, (ptrdiff_t)y * job->width + x, 0};
    bool inside = x >= BORDER && y >= BORDER && x + BORDER < job->width && y + BORDER < job->height;
    if (job->mean == NULL || !inside || rlf_hold_may_move(job->stage, x, y)) {
        return false;
    }
    at.steps = steps_to_known(job, &at);
    front f;
    rlf_vec3 side;
    if (at.steps == 0 || !find_front(job, &at, &f) || !find_side(job, &at, &f, &side)) {
        return false;
    }
    bool is_off = is_off_front(job, &at, &f);
    if (!is_off && !is_pole(job, &at, &f, side)) {
        return false;
    }
    job->normal[0][at.pixel] = (float)side.x;
    job->normal[1][at.pixel] = (float)side.y;
    job->normal[2][at.pixel] = (float)side.z;
    job->mark[at.pixel] = is_off ? mark_of(job, &at) : 0;
    return true;
}

rlf_side_job rlf_side_job_make(const rlf_reconstruct *stage, const rlf_slot *slot)
{
    const rlf_grid *grid = &stage->grid;
    return (rlf_side_job){.stage = stage,
                          .width = grid->width,
                          .height = grid->height,
                          .ray_x = grid->ray_x,
                          .ray_y = grid->ray_y,
                          .depth = slot->depth,
                          .known = stage->work.mask[0],
                          .mean = stage->steady.mean,
                          .frames = stage->steady.frames,
                          .normal = slot->normal,
                          .mark = stage->work.mask[1],
                          .noise = rlf_kernel_noise_make(&stage->def.rig.noise)};
}

static void spread_from(const rlf_side_job *job, int32_t x, int32_t y)
{
    ptrdiff_t from = (ptrdiff_t)y * job->width + x;
    int32_t mark = job->mark[from] - 1, dx = mark % MARK_SIDE - MOST_DROPPED;
    int32_t dy = mark / MARK_SIDE - MOST_DROPPED;
    int32_t across = dx < 0 ? -dx : dx, down = dy < 0 ? -dy : dy;
    int32_t steps = across > down ? across : down;
    for (int32_t k = 1; k <= steps; k++) {
        ptrdiff_t i = from + (ptrdiff_t)(dy * k / steps) * job->width + dx * k / steps;
        rlf_settle_ask(job->stage, i);
        for (int32_t n = 0; n < 3; n++) {
            job->normal[n][i] = job->normal[n][from];
        }
    }
}

void rlf_side_spread(const rlf_side_job *job)
{
    for (int32_t y = 0; y < job->height; y++) {
        const uint8_t *mark = job->mark + (ptrdiff_t)y * job->width;
        for (int32_t x = 0; (x = rlf_kernel_next_mark(mark, x, job->width)) < job->width; x++) {
            spread_from(job, x, y);
        }
    }
}
