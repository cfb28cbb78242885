/* Pieces of the background that are boxes: a cupboard, a carton, a table's top.
 *
 * One face of a box says nothing about how deep it is, but a second one does: it ends where the box
 * ends. So two faces square to each other are sought, and the box is as large along each axis as
 * what is seen of the piece. What has no face is left to the conics. */
#include "surface/thickness/thickness.h"

#include "relief/base.h"

#include <math.h>

enum { SAMPLES = 1024, TRIES = 128, REFINEMENTS = 3, BINS = 512 };

static const double bin_m = 0.01;        /* within which the ends of a box are found */
static const double face_cos = 0.97;     /* a normal within 14 degrees is the face's */
static const double square_cos = 0.25;   /* two faces of a box, up to noise */
static const double face_share = 0.25;   /* of the samples are on the largest face ... */
static const double second_share = 0.04; /* ... and on the next */
static const double box_share = 0.85;    /* of the samples are on the faces of a box */
static const double near_share = 0.01;   /* of the depth: a sample that near a face is on it */
static const double through_m = 0.05;    /* of a box that a ray goes through, and more, ... */
static const double through_share = 0.1; /* ... in so many pixels, of those of the piece */
static const double end_share = 0.005;   /* of the pixels may lie beyond its ends */
static const double least_slope = 0.05;  /* of a face against a ray */

typedef struct shape_search {
    rlf_vec3 point[SAMPLES], normal[SAMPLES];
    int32_t count;
} shape_search;

typedef struct face {
    rlf_vec3 normal;
    int32_t count;
} face;

static rlf_vec3 ray_of(const image_grid *grid, ptrdiff_t i)
{
    return rlf_vec3_make(grid->ray_x[i], grid->ray_y[i], 1.0);
}

/* Pixels of the piece on a pattern that the samples have room for. */
static void take_samples(const rlf_reconstruct *stage, float *const normal[3], int32_t piece,
                         shape_search *search)
{
    const static_thickness *state = &stage->background.thick;
    const rlf_rect *w = &state->window[piece];
    int32_t step = 1;
    while ((w->x1 - w->x0 + step) / step * ((w->y1 - w->y0 + step) / step) > SAMPLES) {
        step++;
    }
    search->count = 0;
    for (int32_t y = w->y0; y < w->y1; y += step) {
        for (int32_t x = w->x0; x < w->x1; x += step) {
            ptrdiff_t i = (ptrdiff_t)y * stage->grid.width + x;
            rlf_vec3 n = image_grid_vector(normal, i);
            if (state->piece[i] == piece && rlf_dot(n, n) > 0.5) {
                search->point[search->count] = image_grid_point(&stage->grid, state->depth, i);
                search->normal[search->count++] = n;
            }
        }
    }
}

/* The face of those whose normal is like this one. */
static face gather(const shape_search *search, rlf_vec3 normal)
{
    face f = {{0, 0, 0}, 0};
    for (int32_t i = 0; i < search->count; i++) {
        if (rlf_dot(search->normal[i], normal) > face_cos) {
            f.normal = rlf_add(f.normal, search->normal[i]);
            f.count++;
        }
    }
    f.normal = f.count > 0 ? rlf_normalize(f.normal) : normal;
    return f;
}

/* The largest face, of those square to `other` if one is given. */
static face find_face(const shape_search *search, const face *other)
{
    face best = {{0, 0, 0}, 0};
    for (int32_t i = 0; i < search->count; i += search->count / TRIES + 1) {
        double cosine = other == NULL ? 0.0 : rlf_dot(search->normal[i], other->normal);
        if (cosine < square_cos && cosine > -square_cos) {
            face f = gather(search, search->normal[i]);
            best = f.count > best.count ? f : best;
        }
    }
    for (int32_t k = 0; k < REFINEMENTS && best.count > 0; k++) {
        best = gather(search, best.normal);
    }
    return best;
}

/* How many pixels end where along an axis, from its middle on, and how many of these at the border
 * of the image. */
typedef struct end_bins {
    int32_t all[BINS], border[BINS];
} end_bins;

/* Counts the ends of pixel i. At the piece's rim it covers half its footprint on its face to each
 * side: of one seen at a low angle that is centimetres. */
static void add_pixel(const rlf_reconstruct *stage, ptrdiff_t i, rlf_vec3 normal,
                      const static_box *box, const double middle[3], end_bins bins[3][2])
{
    const image_grid *grid = &stage->grid;
    const uint8_t *piece = stage->background.thick.piece + i;
    int32_t x = (int32_t)(i % grid->width), y = (int32_t)(i / grid->width), on = 0;
    bool is_border = x == 0 || y == 0 || x + 1 == grid->width || y + 1 == grid->height;
    bool is_contour = is_border || piece[-1] != piece[0] || piece[1] != piece[0] ||
                      piece[-grid->width] != piece[0] || piece[grid->width] != piece[0];
    const rlf_vec3 p = image_grid_point(grid, stage->background.thick.depth, i);
    for (int k = 1; k < 3; k++) {
        double best = rlf_dot(box->axis[on], normal), cosine = rlf_dot(box->axis[k], normal);
        on = cosine * cosine > best * best ? k : on;
    }
    const rlf_vec3 n = box->axis[on];
    double slope = rlf_max(fabs(rlf_dot(n, p)) / p.z, least_slope);
    slope = rlf_dot(n, p) < 0.0 ? -slope : slope;
    for (int k = 0; k < 3; k++) {
        double along = rlf_dot(box->axis[k], p) / p.z, at = rlf_dot(box->axis[k], p);
        double u = p.z / grid->camera.fx * (box->axis[k].x - along * n.x / slope);
        double v = p.z / grid->camera.fy * (box->axis[k].y - along * n.y / slope);
        double half = is_contour ? 0.5 * (fabs(u) + fabs(v)) : 0.0;
        for (int e = 0; e < 2; e++) {
            double off = at + (e == 0 ? -half : half) - middle[k];
            int32_t b = (int32_t)rlf_clamp(off / bin_m + 0.5 * BINS, 0.0, BINS - 1.0);
            bins[k][e].all[b]++;
            bins[k][e].border[b] += is_border;
        }
    }
}

/* The bin, from one end on, that holds the few-th; `is_open`: most of those before it, and of its
 * own, are at the border. */
static int32_t find_end(const end_bins *bins, int32_t end, int32_t few, bool *is_open)
{
    int32_t k = end == 0 ? 0 : BINS - 1, step = end == 0 ? 1 : -1;
    int32_t sum = bins->all[k], border = bins->border[k];
    for (int32_t left = BINS - 1; sum <= few && left > 0; left--) {
        k += step;
        sum += bins->all[k];
        border += bins->border[k];
    }
    *is_open = 2 * border > sum;
    return k;
}

/* Ends of the piece's pixels along the axes, but for a few outliers. */
static void find_ends(const rlf_reconstruct *stage, float *const normal[3], int32_t piece,
                      rlf_vec3 middle, static_box *box)
{
    const static_thickness *state = &stage->background.thick;
    const rlf_rect *w = &state->window[piece];
    end_bins bins[3][2] = {{{{0}, {0}}}};
    int32_t count = 0;
    double at[3];
    for (int k = 0; k < 3; k++) {
        at[k] = rlf_dot(box->axis[k], middle);
    }
    for (int32_t y = w->y0; y < w->y1; y++) {
        for (int32_t x = w->x0; x < w->x1; x++) {
            ptrdiff_t i = (ptrdiff_t)y * stage->grid.width + x;
            if (state->piece[i] == piece) {
                add_pixel(stage, i, image_grid_vector(normal, i), box, at, bins);
                count++;
            }
        }
    }
    for (int k = 0; k < 3; k++) {
        for (int e = 0; e < 2; e++) {
            int32_t few = (int32_t)(end_share * count);
            int32_t bin = find_end(&bins[k][e], e, few, &box->is_open[k][e]);
            box->end[k][e] = at[k] + bin_m * (bin + 0.5 - 0.5 * BINS);
        }
    }
}

/* Whether the samples lie on the box's faces. */
static bool agrees(const shape_search *search, const static_box *box)
{
    int32_t on = 0;
    for (int32_t i = 0; i < search->count; i++) {
        double near = near_share * search->point[i].z, least = near;
        for (int k = 0; k < 3; k++) {
            double at = rlf_dot(box->axis[k], search->point[i]);
            least = rlf_min(least, fabs(box->end[k][1] - at));
            least = k == 2 ? rlf_min(least, fabs(at - box->end[k][0])) : least;
        }
        on += least < near;
    }
    return on >= box_share * search->count;
}

/* Depths between which the ray is in the box, as far as its ends count; false when it misses it. */
static bool cut_box(const static_box *box, rlf_vec3 ray, bool is_open_counted, double *enter,
                    double *leave)
{
    *enter = 0.0;
    *leave = 1e9;
    for (int k = 0; k < 3; k++) {
        double along = rlf_dot(box->axis[k], ray);
        int far = along > 0.0;
        along = fabs(along) < 1e-9 ? 1e-9 : along;
        if (is_open_counted || !box->is_open[k][far]) {
            *leave = rlf_min(*leave, box->end[k][far] / along);
        }
        *enter = rlf_max(*enter, box->end[k][!far] / along);
    }
    return *enter < *leave;
}

double static_box_exit(const static_box *box, rlf_vec3 ray)
{
    double enter, leave;
    (void)cut_box(box, ray, false, &enter, &leave);
    return leave;
}

/* Whether the camera sees through the box beside the piece: a seat and a leg are no box. */
static bool is_seen_through(const rlf_reconstruct *stage, int32_t piece, const static_box *box)
{
    const static_thickness *state = &stage->background.thick;
    const rlf_rect *w = &state->window[piece];
    int32_t own = 0, through = 0;
    for (int32_t y = w->y0; y < w->y1; y++) {
        for (int32_t x = w->x0; x < w->x1; x++) {
            ptrdiff_t i = (ptrdiff_t)y * stage->grid.width + x;
            double enter, leave, seen = state->depth[i];
            bool is_own = state->piece[i] == piece;
            own += is_own;
            through += !is_own && cut_box(box, ray_of(&stage->grid, i), true, &enter, &leave) &&
                       rlf_min(leave, seen) > enter + through_m;
        }
    }
    return through > through_share * own;
}

static_shape static_find_shape(const rlf_reconstruct *stage, float *const normal[3], int32_t piece,
                               static_box *out)
{
    shape_search search;
    take_samples(stage, normal, piece, &search);
    const face first = find_face(&search, NULL), second = find_face(&search, &first);
    if (first.count < face_share * search.count) {
        return STATIC_ROUND;
    }
    if (second.count == 0 || second.count < second_share * search.count) {
        return STATIC_UNKNOWN;
    }
    out->axis[0] = first.normal;
    out->axis[2] = rlf_normalize(rlf_cross(first.normal, second.normal));
    out->axis[1] = rlf_cross(out->axis[2], out->axis[0]);
    find_ends(stage, normal, piece, search.point[0], out);
    bool is_box = agrees(&search, out) && !is_seen_through(stage, piece, out);
    return is_box ? STATIC_BOX : STATIC_UNKNOWN;
}
