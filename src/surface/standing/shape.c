/* Pieces of the background that are boxes, a cupboard, a carton, a table's top; or balls.
 *
 * One face of a box says nothing about how deep it is, but a second one does: it ends where the
 * box ends. So two faces square to each other are sought, and the box is as large along each axis
 * as what is seen of the piece. What has no face may be a ball, or is left to the conics. */
#include "surface/standing/standing.h"

#include "relief/base.h"

enum { SAMPLES = 1024, TRIES = 128, REFINEMENTS = 3, BINS = 256 };

static const double face_cos = 0.97;     /* a normal within 14 degrees is the face's */
static const double square_cos = 0.25;   /* two faces of a box, up to noise */
static const double face_share = 0.25;   /* of the samples are on the largest face ... */
static const double second_share = 0.04; /* ... and on the next */
static const double before_share = 0.06; /* so many before a face: it is no convex thing */
static const double box_share = 0.85;    /* of the samples are on the faces of a box */
static const double through_m = 0.05;    /* of a box that a ray goes through, and more, ... */
static const double through_share = 0.1; /* ... in so many pixels, of those of the piece */
static const double ball_share = 0.04;   /* of the radius: RMS of what a ball's samples are off */
static const double largest_m = 0.5;     /* radius */
static const double end_share = 0.005;   /* of the samples may lie beyond its ends */

typedef struct shape_sample {
    rlf_vec3 point, normal;
} shape_sample;

typedef struct shape_search {
    shape_sample sample[SAMPLES];
    int32_t count;
} shape_search;

typedef struct face {
    rlf_vec3 normal;
    double offset; /* normal . p */
    int32_t count;
} face;

static bool take(const rlf_reconstruct *stage, float *const normal[3], int32_t x, int32_t y,
                 shape_sample *out)
{
    const rlf_grid *grid = &stage->grid;
    ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
    double z = stage->background.thick.depth[i];
    out->point = rlf_vec3_make(z * grid->ray_x[i], z * grid->ray_y[i], z);
    out->normal = rlf_vec3_make(normal[0][i], normal[1][i], normal[2][i]);
    return rlf_dot(out->normal, out->normal) > 0.5;
}

/* Pixels of the piece on a pattern that the samples have room for. */
static void take_samples(const rlf_reconstruct *stage, float *const normal[3], int32_t piece,
                         shape_search *search)
{
    const rlf_grid *grid = &stage->grid;
    const rlf_rect *w = &stage->background.thick.window[piece];
    int32_t step = 1;
    while ((w->x1 - w->x0 + step) / step * ((w->y1 - w->y0 + step) / step) > SAMPLES) {
        step++;
    }
    search->count = 0;
    for (int32_t y = w->y0; y < w->y1; y += step) {
        for (int32_t x = w->x0; x < w->x1; x += step) {
            bool is_own = stage->background.thick.piece[(ptrdiff_t)y * grid->width + x] == piece;
            if (is_own && take(stage, normal, x, y, &search->sample[search->count])) {
                search->count++;
            }
        }
    }
}

/* Where the outermost of the face's samples are: what lies deeper is another, alike. */
static double outermost(const shape_search *search, rlf_vec3 normal)
{
    double least = -1e9;
    for (int32_t pass = 0; pass < 3; pass++) {
        double sum = 0.0, count = 0.0;
        for (int32_t i = 0; i < search->count; i++) {
            double at = rlf_dot(normal, search->sample[i].point);
            if (rlf_dot(search->sample[i].normal, normal) > face_cos && at >= least) {
                sum += at;
                count += 1.0;
            }
        }
        least = count > 0.0 ? sum / count : least;
    }
    return least;
}

/* The face of those whose normal is like this one. */
static face gather(const shape_search *search, rlf_vec3 normal)
{
    face f = {{0, 0, 0}, 0.0, 0};
    for (int32_t i = 0; i < search->count; i++) {
        if (rlf_dot(search->sample[i].normal, normal) > face_cos) {
            f.normal = rlf_add(f.normal, search->sample[i].normal);
            f.count++;
        }
    }
    f.normal = f.count > 0 ? rlf_normalize(f.normal) : normal;
    return f;
}

/* The largest face, of those square to `other` if one is given. */
static face find_face(const shape_search *search, const face *other)
{
    face best = {{0, 0, 0}, 0.0, 0};
    int32_t step = search->count / TRIES + 1;
    for (int32_t i = 0; i < search->count; i += step) {
        rlf_vec3 n = search->sample[i].normal;
        double cosine = other == NULL ? 0.0 : rlf_dot(n, other->normal);
        if (cosine < square_cos && cosine > -square_cos) {
            face f = gather(search, n);
            best = f.count > best.count ? f : best;
        }
    }
    for (int32_t k = 0; k < REFINEMENTS && best.count > 0; k++) {
        best = gather(search, best.normal);
    }
    best.offset = outermost(search, best.normal);
    return best;
}

static double tolerance(double z)
{
    return 0.01 + 0.005 * z;
}

/* Whether the samples lie on the box's faces, next to none of them before one. */
static bool agrees(const shape_search *search, const face faces[2], const rlf_standing_solid *box)
{
    int32_t before = 0, on = 0;
    for (int32_t i = 0; i < search->count; i++) {
        rlf_vec3 p = search->sample[i].point;
        double off[2], off_end = rlf_dot(box->axis[2], p), near = tolerance(p.z);
        bool is_on = off_end > box->high[2] - near || off_end < box->low[2] + near;
        for (int k = 0; k < 2; k++) {
            off[k] = rlf_dot(faces[k].normal, p) - faces[k].offset;
            is_on = is_on || (off[k] > -near && off[k] < near);
        }
        before += off[0] > near || off[1] > near;
        on += is_on;
    }
    return before <= before_share * search->count && on >= box_share * search->count;
}

/* Least and most of what one pixel covers, along the box's axes. */
typedef struct pixel_span {
    double low[3], high[3];
} pixel_span;

/* The face that p is on. */
static const face *face_at(const face faces[2], rlf_vec3 p)
{
    double off[2];
    for (int k = 0; k < 2; k++) {
        off[k] = rlf_dot(faces[k].normal, p) - faces[k].offset;
        off[k] = off[k] < 0.0 ? -off[k] : off[k];
    }
    return &faces[off[1] < off[0]];
}

static bool is_at_border(const rlf_grid *grid, int32_t x, int32_t y)
{
    return x == 0 || y == 0 || x + 1 == grid->width || y + 1 == grid->height;
}

/* Whether another piece, or the image's border, is beside pixel (x, y). */
static bool is_rim(const rlf_reconstruct *stage, int32_t x, int32_t y)
{
    ptrdiff_t width = stage->grid.width;
    const uint8_t *piece = stage->background.thick.piece + y * width + x;
    return is_at_border(&stage->grid, x, y) || piece[-1] != piece[0] || piece[1] != piece[0] ||
           piece[-width] != piece[0] || piece[width] != piece[0];
}

/* What pixel (x, y) covers of its face, at a rim: of one seen at a low angle centimetres. */
static pixel_span span_of(const rlf_reconstruct *stage, int32_t x, int32_t y, const face faces[2],
                          const rlf_standing_solid *box)
{
    const double least_slope = 0.05;
    const rlf_grid *grid = &stage->grid;
    ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
    double z = stage->background.thick.depth[i];
    rlf_vec3 ray = {grid->ray_x[i], grid->ray_y[i], 1.0}, p = rlf_scale(ray, z);
    pixel_span span;
    for (int k = 0; k < 3; k++) {
        span.low[k] = span.high[k] = rlf_dot(box->axis[k], p);
    }
    if (!is_rim(stage, x, y)) {
        return span;
    }
    const face *on = face_at(faces, p);
    for (int corner = 0; corner < 4; corner++) {
        rlf_vec3 r = {ray.x + (corner % 2 - 0.5) / grid->camera.fx,
                      ray.y + (corner / 2 - 0.5) / grid->camera.fy, 1.0};
        double slope = -rlf_dot(on->normal, r);
        double far = slope > least_slope ? -rlf_dot(on->normal, p) / slope : z;
        for (int k = 0; k < 3; k++) {
            double at = far * rlf_dot(box->axis[k], r);
            span.low[k] = rlf_min(span.low[k], at);
            span.high[k] = rlf_max(span.high[k], at);
        }
    }
    return span;
}

/* How many pixels lie where along an axis, and how many of these at the border of the image; the
 * first bin is at the end that is sought. */
typedef struct end_bins {
    int32_t all[BINS], border[BINS];
} end_bins;

/* The bin that holds the few-th; `is_open`: most of those before it, and of its own, are at the
 * border. */
static int32_t find_end(const end_bins *bins, int32_t few, bool *is_open)
{
    int32_t k = 0, sum = bins->all[0], border = bins->border[0];
    while (sum <= few && k + 1 < BINS) {
        k++;
        sum += bins->all[k];
        border += bins->border[k];
    }
    *is_open = 2 * border > sum;
    return k;
}

static void add_end(end_bins *bins, double along, double length, bool is_at_border)
{
    int32_t k = (int32_t)rlf_clamp(along / rlf_max(length, 1e-6) * BINS, 0.0, BINS - 1.0);
    bins->all[k]++;
    bins->border[k] += is_at_border;
}

/* Ends of the piece's pixels along the axes, but for a few outliers. */
static void find_ends(const rlf_reconstruct *stage, int32_t piece, const face faces[2],
                      rlf_standing_solid *box)
{
    const rlf_rect *w = &stage->background.thick.window[piece];
    end_bins low_bins[3] = {{{0}, {0}}}, high_bins[3] = {{{0}, {0}}};
    int32_t count = 0;
    double low[3] = {1e9, 1e9, 1e9}, high[3] = {-1e9, -1e9, -1e9};
    for (int pass = 0; pass < 2; pass++) {
        for (int32_t y = w->y0; y < w->y1; y++) {
            for (int32_t x = w->x0; x < w->x1; x++) {
                if (stage->background.thick.piece[(ptrdiff_t)y * stage->grid.width + x] != piece) {
                    continue;
                }
                const pixel_span at = span_of(stage, x, y, faces, box);
                bool is_cut = is_at_border(&stage->grid, x, y);
                for (int k = 0; k < 3 && pass == 0; k++) {
                    low[k] = rlf_min(low[k], at.low[k]);
                    high[k] = rlf_max(high[k], at.high[k]);
                }
                for (int k = 0; k < 3 && pass == 1; k++) {
                    add_end(&low_bins[k], at.low[k] - low[k], high[k] - low[k], is_cut);
                    add_end(&high_bins[k], high[k] - at.high[k], high[k] - low[k], is_cut);
                }
                count += pass;
            }
        }
    }
    for (int k = 0; k < 3; k++) {
        double size = (high[k] - low[k]) / BINS;
        int32_t few = (int32_t)(end_share * count);
        box->low[k] = low[k] + size * find_end(&low_bins[k], few, &box->is_open_low[k]);
        box->high[k] = high[k] - size * find_end(&high_bins[k], few, &box->is_open_high[k]);
    }
}

/* The ball whose surface the samples are: least squares for |p|^2 = 2 p.c + r^2 - c^2. */
static bool find_ball(const shape_search *search, rlf_standing_solid *out)
{
    rlf_vec3 mean = {0, 0, 0}, right = {0, 0, 0}, column[3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    double square = 0.0, n = search->count;
    for (int32_t i = 0; i < search->count; i++) {
        mean = rlf_mad(mean, search->sample[i].point, 1.0 / n);
    }
    for (int32_t i = 0; i < search->count; i++) {
        rlf_vec3 q = rlf_sub(search->sample[i].point, mean);
        double q2 = rlf_dot(q, q);
        square += q2 / n;
        right = rlf_mad(right, q, q2 / n);
        column[0] = rlf_mad(column[0], q, 2.0 * q.x / n);
        column[1] = rlf_mad(column[1], q, 2.0 * q.y / n);
        column[2] = rlf_mad(column[2], q, 2.0 * q.z / n);
    }
    double det = rlf_dot(column[0], rlf_cross(column[1], column[2]));
    if (!(det > 1e-15)) {
        return false;
    }
    rlf_vec3 to = {rlf_dot(right, rlf_cross(column[1], column[2])) / det,
                   rlf_dot(column[0], rlf_cross(right, column[2])) / det,
                   rlf_dot(column[0], rlf_cross(column[1], right)) / det};
    out->centre = rlf_add(mean, to);
    out->radius = sqrt(square + rlf_dot(to, to));
    double rest = 0.0;
    for (int32_t i = 0; i < search->count; i++) {
        double off = rlf_length(rlf_sub(search->sample[i].point, out->centre)) - out->radius;
        rest += off * off / n;
    }
    double near = ball_share * out->radius;
    return rest < near * near && out->radius < largest_m;
}

/* Depths between which the ray is in the box; false when it misses it. */
static bool cut_box(const rlf_standing_solid *box, rlf_vec3 ray, double *enter, double *leave)
{
    *enter = 0.0;
    *leave = 1e9;
    for (int k = 0; k < 3; k++) {
        double along = rlf_dot(box->axis[k], ray);
        bool is_along = along < 1e-9 && along > -1e-9;
        double a = box->low[k] / (is_along ? 1e-9 : along);
        double b = box->high[k] / (is_along ? 1e-9 : along);
        *enter = rlf_max(*enter, rlf_min(a, b));
        *leave = rlf_min(*leave, rlf_max(a, b));
    }
    return *enter < *leave;
}

/* Whether the camera sees through the box beside the piece: a seat and a leg are no box. */
static bool is_seen_through(const rlf_reconstruct *stage, int32_t piece,
                            const rlf_standing_solid *box)
{
    const rlf_standing *standing = &stage->background.thick;
    const rlf_grid *grid = &stage->grid;
    const rlf_rect *w = &standing->window[piece];
    int32_t own = 0, through = 0;
    for (int32_t y = w->y0; y < w->y1; y++) {
        for (int32_t x = w->x0; x < w->x1; x++) {
            ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
            double enter, leave, seen = standing->depth[i];
            if (standing->piece[i] == piece) {
                own++;
            } else if (cut_box(box, rlf_vec3_make(grid->ray_x[i], grid->ray_y[i], 1.0), &enter,
                               &leave)) {
                through += rlf_min(leave, seen) > enter + through_m;
            }
        }
    }
    return through > through_share * own;
}

/* The box whose largest face is given; false when it shows no second one, or is no convex thing. */
static bool find_box(const rlf_reconstruct *stage, int32_t piece, const shape_search *search,
                     face largest, rlf_standing_solid *out)
{
    const face faces[2] = {largest, find_face(search, &largest)};
    if (faces[1].count < second_share * search->count) {
        return false;
    }
    out->axis[0] = faces[0].normal;
    out->axis[2] = rlf_normalize(rlf_cross(faces[0].normal, faces[1].normal));
    out->axis[1] = rlf_cross(out->axis[2], out->axis[0]);
    find_ends(stage, piece, faces, out);
    return agrees(search, faces, out) && !is_seen_through(stage, piece, out);
}

void rlf_standing_find_shape(const rlf_reconstruct *stage, float *const normal[3], int32_t piece,
                             rlf_standing_solid *out)
{
    shape_search search;
    take_samples(stage, normal, piece, &search);
    face largest = find_face(&search, NULL);
    if (largest.count >= face_share * search.count) {
        bool is_box = find_box(stage, piece, &search, largest, out);
        out->shape = is_box ? RLF_STANDING_BOX : RLF_STANDING_UNKNOWN;
    } else {
        bool is_ball = search.count > 0 && find_ball(&search, out);
        out->shape = is_ball ? RLF_STANDING_BALL : RLF_STANDING_ROUND;
    }
}

static double box_exit(const rlf_standing_solid *box, rlf_vec3 ray)
{
    double leave = 1e9;
    for (int k = 0; k < 3; k++) {
        double along = rlf_dot(box->axis[k], ray);
        if (along > 1e-9 && !box->is_open_high[k]) {
            leave = rlf_min(leave, box->high[k] / along);
        } else if (along < -1e-9 && !box->is_open_low[k]) {
            leave = rlf_min(leave, box->low[k] / along);
        }
    }
    return leave;
}

static double ball_exit(const rlf_standing_solid *ball, rlf_vec3 ray)
{
    double a = rlf_dot(ray, ray), b = rlf_dot(ray, ball->centre);
    double c = rlf_dot(ball->centre, ball->centre) - ball->radius * ball->radius;
    return (b + sqrt(rlf_max(0.0, b * b - a * c))) / a;
}

float rlf_standing_exit(const rlf_standing_solid *solid, double ray_x, double ray_y)
{
    const rlf_vec3 ray = {ray_x, ray_y, 1.0};
    return (float)(solid->shape == RLF_STANDING_BALL ? ball_exit(solid, ray)
                                                     : box_exit(solid, ray));
}
