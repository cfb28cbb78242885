/* The box that explains a frame: its faces where they are seen, its outline where depth steps. */
#include "surface/thin/slab.h"

#include "math/inverse.h"

#include <string.h>

enum {
    N = SLAB_UNKNOWNS,
    PASSES = 5,       /* at most; */
    LOOSE_PASSES = 3, /* of these with a wide scale for places of the outline */
    REACH_PX = 6,
    MARGIN_PX = 3,
    MOST_PLACES = 48,
    MOST_PIXELS = 640 /* of its window: of a larger one every second of every second row ... */
};

static const double thing_m = 0.025;   /* what is seen so near the box is it */
static const double outline_m = 0.015; /* the same, where its outline is looked for */
static const double robust_m = 0.010;  /* scale of Geman and McClure's weight */
static const double shared = 0.15;     /* weight of one measurement: neighbours have one error */
static const double outline_px = 0.7;  /* how well a step places the outline */
static const double beyond_px = 1.2;   /* the same, by what is seen beyond it alone */
static const double band_px = 1.8;     /* beside an edge are not seen */
static const double beside_px = 0.4;   /* a pixel shows what is so far beside its middle, too */
static const double least_sigma_m = 0.0005;
static const double beside_m = 0.008; /* a point so far beside a face may be on it */
static const double spacing_px = 1.5;
static const double settled = 0.5; /* of its sigma moves no unknown: a sixth of that is left */

/* Normal equations of the correction x: J x = e. */
typedef struct equations {
    const thin_in *in;
    slab_view view;
    double a[N][N], b[N];
    slab_fit fit;
    double loose_px; /* scale of Geman and McClure's weight */
    int32_t stride;  /* of the pixels that are looked at */
} equations;

static void add_row(equations *sum, const double row[N], double error, double weight)
{
    for (int r = 0; r < N; r++) {
        sum->b[r] += weight * row[r] * error;
        for (int c = 0; c <= r; c++) {
            sum->a[r][c] += weight * row[r] * row[c];
        }
    }
}

/* How fast a point of the box, at `arm` from its centre, goes along `way` with each unknown. */
static void set_row(double row[N], rlf_vec3 way, rlf_vec3 arm)
{
    rlf_vec3 turn = rlf_cross(arm, way);
    const double part[N] = {way.x, way.y, way.z, turn.x, turn.y, turn.z, 0.0, 0.0, 0.0};
    memcpy(row, part, sizeof part);
}

/* The face that a point is on. */
typedef struct on_face {
    int32_t axis;
    double sign, error; /* metres out of the box */
    double off;         /* metres from the face, squared */
} on_face;

static void look_along_view(const slab_view *view, rlf_vec3 p, slab_point *at)
{
    const rlf_vec3 way = rlf_normalize(p);
    for (int k = 0; k < 3; k++) {
        at->facing[k] = rlf_dot(view->axis[k], way);
    }
}

/* The nearest among those that the camera sees at an angle whose sine is between the bounds. */
static on_face nearest_face(const slab_view *view, const slab_point *at, double least, double most)
{
    on_face best = {.axis = -1, .off = 1e9};
    for (int k = 0; k < 3; k++) {
        const int o = (k + 1) % 3, m = (k + 2) % 3;
        const double beside = at->beyond[o] * at->beyond[o] + at->beyond[m] * at->beyond[m];
        for (double sign = -1.0; sign <= 1.0; sign += 2.0) {
            double error = sign * at->q[k] - view->half[k], facing = -sign * at->facing[k];
            double off = error * error + beside;
            if (facing > least && facing <= most && off < best.off) {
                best = (on_face){k, sign, error, off};
            }
        }
    }
    return best;
}

/* Noise puts points of the other faces on a face that is seen at a low angle, or is about to come
 * into view: those that are far behind these are on it. */
static on_face face_of(const slab_view *view, const slab_point *at)
{
    const double low = 0.15, hidden = -0.2, far_m = 0.02;
    on_face face = nearest_face(view, at, low, 1.0);
    if (face.axis < 0 || face.off > far_m * far_m) {
        on_face other = nearest_face(view, at, hidden, low);
        bool is_inside = other.axis == 2 && other.off <= other.error * other.error;
        face = is_inside && other.off < robust_m * robust_m ? other : face;
    }
    return face;
}

static void add_pixel(equations *sum, ptrdiff_t i)
{
    const image_grid *grid = sum->in->grid;
    double z = sum->in->depth[i], x = grid->ray_x[i], y = grid->ray_y[i], row[N];
    rlf_vec3 p = rlf_vec3_make(z * x, z * y, z);
    slab_point at = slab_local(&sum->view, p);
    if (!(z > 0.0) || at.square > thing_m * thing_m) {
        return;
    }
    look_along_view(&sum->view, p, &at);
    on_face face = face_of(&sum->view, &at);
    if (face.axis < 0 || face.off > face.error * face.error + beside_m * beside_m) {
        return;
    }
    rlf_vec3 n = rlf_scale(sum->view.axis[face.axis], face.sign);
    double facing = -face.sign * at.facing[face.axis];
    double sigma = rlf_depth_noise_sigma(sum->in->noise, z) * rlf_max(facing, 0.0) +
                   beside_px * z / grid->camera.fx * sqrt(rlf_max(1.0 - facing * facing, 0.0)) +
                   least_sigma_m;
    double robust = 1.0 / (1.0 + face.error * face.error / (robust_m * robust_m));
    int32_t others = sum->stride * sum->stride; /* for which it stands */
    double weight = rlf_min(shared * others, 1.0) * robust * robust;
    set_row(row, n, rlf_sub(p, sum->view.centre));
    row[6 + face.axis] = 1.0;
    add_row(sum, row, face.error, weight / (sigma * sigma));
    sum->fit.faces += face.error < robust_m && face.error > -robust_m ? others : 0;
}

enum { NOTHING, THING, BEYOND, BEFORE };

/* What the pixel nearest to `at` + `k` `out` shows. */
typedef struct sight {
    int32_t kind;
    double seen;   /* depth, m */
    double offset; /* of the pixel's middle from `at`, along `out` */
} sight;

static sight look_at(const equations *sum, const double at[2], const double out[2], int32_t k,
                     double z)
{
    const image_grid *grid = sum->in->grid;
    const double u = at[0] + k * out[0], v = at[1] + k * out[1];
    sight s = {.kind = BEFORE};
    if (!(u > -0.5) || !(v > -0.5) || !(u < grid->width - 0.5) || !(v < grid->height - 0.5)) {
        return s;
    }
    int32_t x = (int32_t)(u + 0.5), y = (int32_t)(v + 0.5);
    ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
    s.seen = sum->in->depth[i];
    s.offset = (x - at[0]) * out[0] + (y - at[1]) * out[1];
    rlf_vec3 p = rlf_vec3_make(s.seen * grid->ray_x[i], s.seen * grid->ray_y[i], s.seen);
    if (!(s.seen > 0.0)) {
        s.kind = NOTHING;
    } else if (slab_is_near(&sum->view, p, outline_m)) {
        s.kind = THING;
    } else {
        s.kind = s.seen > z + THIN_STEP_M ? BEYOND : BEFORE;
    }
    return s;
}

/* Pixels from `at`, outwards along `out`, to where depth steps for the last time; false when it
 * does not, as where something else begins that goes on behind. What is beyond a narrow slab is
 * seen on its other side, too. */
static bool find_step(const equations *sum, const double at[2], const double out[2], double z,
                      double *offset, double *sigma)
{
    sight last = {.kind = NOTHING, .seen = z}, step = {.kind = NOTHING};
    for (int32_t k = -REACH_PX; k <= REACH_PX && (k <= 0 || step.kind == NOTHING); k++) {
        sight s = look_at(sum, at, out, k, z);
        if (s.kind == BEFORE || (s.kind == BEYOND && s.seen < last.seen + THIN_STEP_M)) {
            return false;
        }
        last = s.kind == THING ? s : last;
        step = s.kind == BEYOND && step.kind == NOTHING ? s : s.kind == BEYOND ? step : (sight){0};
    }
    bool is_seen = last.kind == THING;
    *offset = is_seen ? 0.5 * (step.offset + last.offset) : step.offset - band_px;
    *sigma = is_seen ? outline_px : beyond_px;
    return step.kind == BEYOND;
}

/* A place on an edge of the outline: depth steps `offset` pixels farther out. */
typedef struct place {
    double row[N], offset, sigma;
} place;

/* On the edge between the faces `sign` of the axes other than `axis`; false where nothing shows it.
 */
static bool look_at_place(const equations *sum, rlf_vec3 p, int32_t axis, const double sign[3],
                          place *found)
{
    const rlf_camera *camera = &sum->in->grid->camera;
    const double fx = camera->fx, fy = camera->fy;
    const rlf_vec3 along = sum->view.axis[axis];
    double at[2];
    if (!rlf_camera_project(camera, p, &at[0], &at[1])) {
        return false;
    }
    double du = fx * (along.x - along.z * p.x / p.z), dv = fy * (along.y - along.z * p.y / p.z);
    double length = sqrt(du * du + dv * dv);
    if (!(length > 0.0)) {
        return false;
    }
    double out[2] = {dv / length, -du / length};
    rlf_vec3 way = rlf_scale(
        rlf_vec3_make(fx * out[0], fy * out[1], -(fx * out[0] * p.x + fy * out[1] * p.y) / p.z),
        1.0 / p.z);
    rlf_vec3 arm = rlf_sub(p, sum->view.centre);
    if (rlf_dot(way, arm) < 0.0) {
        out[0] = -out[0];
        out[1] = -out[1];
        way = rlf_neg(way);
    }
    set_row(found->row, way, arm);
    for (int k = 0; k < 3; k++) {
        found->row[6 + k] = k == axis ? 0.0 : sign[k] * rlf_dot(way, sum->view.axis[k]);
    }
    return find_step(sum, at, out, p.z, &found->offset, &found->sigma);
}

/* Edges of the outline lie between a face that the camera sees and one that it does not. */
static bool is_outline(const slab_view *view, int32_t axis, const double sign[3])
{
    int32_t seen = 0;
    for (int k = 0; k < 3; k++) {
        if (k != axis) {
            double from = sign[k] * rlf_dot(view->centre, view->axis[k]);
            seen += from + view->half[k] < 0.0;
        }
    }
    return seen == 1;
}

/* Pixels from a to b; 0 where either is not to be seen. */
static double length_in_pixels(const rlf_camera *camera, rlf_vec3 a, rlf_vec3 b)
{
    double from[2], to[2];
    if (!rlf_camera_project(camera, a, &from[0], &from[1]) ||
        !rlf_camera_project(camera, b, &to[0], &to[1])) {
        return 0.0;
    }
    double du = to[0] - from[0], dv = to[1] - from[1];
    return sqrt(du * du + dv * dv);
}

static void add_edge(equations *sum, int32_t axis, const double sign[3])
{
    const slab_view *view = &sum->view;
    rlf_vec3 middle = view->centre, half = rlf_scale(view->axis[axis], view->half[axis]);
    for (int k = 0; k < 3; k++) {
        middle = k == axis ? middle : rlf_mad(middle, view->axis[k], sign[k] * view->half[k]);
    }
    double pixels =
        length_in_pixels(&sum->in->grid->camera, rlf_sub(middle, half), rlf_add(middle, half));
    const int32_t count = (int32_t)rlf_min(pixels / spacing_px + 0.5, MOST_PLACES);
    for (int32_t k = 0; k < count; k++) {
        const double along = (2.0 * k + 1.0) / count - 1.0;
        place at;
        sum->fit.places++;
        if (look_at_place(sum, rlf_mad(middle, half, along), axis, sign, &at)) {
            const double loose = at.offset / sum->loose_px, robust = 1.0 / (1.0 + loose * loose);
            const double share = rlf_max(shared, 1.0 / count);
            add_row(sum, at.row, at.offset, share * robust * robust / (at.sigma * at.sigma));
            sum->fit.outline++;
        }
    }
}

static void measure(equations *sum)
{
    const image_grid *grid = sum->in->grid;
    const rlf_rect w = slab_window(grid, &sum->view, MARGIN_PX);
    sum->stride = slab_stride(&w, MOST_PIXELS);
    for (int32_t y = w.y0; y < w.y1; y += sum->stride) {
        for (int32_t x = w.x0; x < w.x1; x += sum->stride) {
            add_pixel(sum, (ptrdiff_t)y * grid->width + x);
        }
    }
    for (int32_t axis = 0; axis < 3; axis++) {
        for (int32_t corner = 0; corner < 4; corner++) {
            double sign[3] = {0.0, 0.0, 0.0};
            sign[(axis + 1) % 3] = (corner & 1) != 0 ? 1.0 : -1.0;
            sign[(axis + 2) % 3] = (corner & 2) != 0 ? 1.0 : -1.0;
            if (w.x1 > w.x0 && is_outline(&sum->view, axis, sign)) {
                add_edge(sum, axis, sign);
            }
        }
    }
}

static void apply(const double x[N], slab *s)
{
    s->pose.p = rlf_add(s->pose.p, rlf_vec3_make(x[0], x[1], x[2]));
    rlf_quat turn = rlf_quat_from_rotation_vector(rlf_vec3_make(x[3], x[4], x[5]));
    s->pose.q = rlf_quat_normalize(rlf_quat_mul(turn, s->pose.q));
    for (int k = 0; k < 3; k++) {
        s->half[k] = rlf_max(s->half[k] + x[6 + k], 0.002);
    }
}

/* The correction x that the equations and what was known before, less what is `gone` of it, give;
 * their inverse is the covariance. True when no unknown moves by more than a share of its sigma. */
static bool solve(double prior[N][N], double gone[N], equations *sum, double x[N])
{
    bool is_settled = true;
    for (int r = 0; r < N; r++) {
        for (int c = 0; c < N; c++) {
            sum->a[r][c] = prior[r][c] + (c <= r ? sum->a[r][c] : sum->a[c][r]);
            sum->b[r] -= prior[r][c] * gone[c];
        }
    }
    math_invert(&sum->a[0][0], N);
    for (int r = 0; r < N; r++) {
        x[r] = 0.0;
        for (int c = 0; c < N; c++) {
            x[r] += sum->a[r][c] * sum->b[c];
        }
        is_settled = is_settled && x[r] * x[r] <= settled * settled * sum->a[r][r];
    }
    for (int r = 0; r < N; r++) {
        gone[r] += x[r];
    }
    return is_settled;
}

slab_fit slab_improve(const thin_in *in, slab *s)
{
    double prior[N][N], gone[N] = {0.0}, x[N];
    equations sum;
    memcpy(prior, s->doubt, sizeof prior);
    math_invert(&prior[0][0], N);
    for (int pass = 0; pass < PASSES; pass++) {
        sum = (equations){
            .in = in, .view = slab_look(s), .loose_px = pass < LOOSE_PASSES ? 4.0 : 1.2};
        measure(&sum);
        bool is_settled = solve(prior, gone, &sum, x);
        apply(x, s);
        if (is_settled) {
            pass = pass < LOOSE_PASSES ? LOOSE_PASSES - 1 : PASSES;
        }
    }
    memcpy(s->doubt, sum.a, sizeof s->doubt);
    return sum.fit;
}
