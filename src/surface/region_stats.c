/* What is known of each region: rectangle, boxes, centroid, flatness, points. */
#include "surface/steps.h"

static void clear_region(rlf_region *region, rlf_region_sum *sum, const rlf_layer_in *in,
                         const rlf_grid *grid)
{
    *region = (rlf_region){0};
    region->layer = in->layer;
    region->first_point = -1;
    region->x0 = grid->width;
    region->y0 = grid->height;
    region->box = rlf_aabb_empty();
    region->plane_residual = -1.0;
    region->oriented_pose = rlf_pose_identity();
    *sum = (rlf_region_sum){0};
}

static void add_run(rlf_region *region, rlf_region_sum *sum, const rlf_grid *grid,
                    const float *depth, const rlf_run *run, int32_t y)
{
    region->point_count += run->x1 - run->x0;
    region->x0 = run->x0 < region->x0 ? run->x0 : region->x0;
    region->x1 = run->x1 > region->x1 ? run->x1 : region->x1;
    region->y0 = y < region->y0 ? y : region->y0;
    region->y1 = y + 1;
    rlf_aabb box = region->box;
    rlf_region_sum t = *sum;
    ptrdiff_t row = (ptrdiff_t)y * grid->width;
    for (ptrdiff_t i = row + run->x0; i < row + run->x1; i++) {
        double z = depth[i], x_m = z * grid->ray_x[i], y_m = z * grid->ray_y[i];
        rlf_aabb_extend(&box, rlf_vec3_make(x_m, y_m, z));
        t.s[0] += x_m;
        t.s[1] += y_m;
        t.s[2] += z;
        t.ss[0] += x_m * x_m;
        t.ss[1] += x_m * y_m;
        t.ss[2] += x_m * z;
        t.ss[3] += y_m * y_m;
        t.ss[4] += y_m * z;
        t.ss[5] += z * z;
    }
    region->box = box;
    *sum = t;
}

/* Eigenvalues on the diagonal of a and eigenvectors in the columns of v: cyclic Jacobi rotations
 * (Golub and Van Loan, algorithm 8.5.1). */
static void diagonalize(double a[3][3], double v[3][3])
{
    enum { SWEEPS = 8 };
    for (int k = 0; k < 3 * SWEEPS; k++) {
        int p = k % 3 == 2 ? 1 : 0, q = k % 3 == 0 ? 1 : 2, r = 3 - p - q;
        if (a[p][q] == 0.0) {
            continue;
        }
        double theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
        double size = theta < 0.0 ? -theta : theta;
        double t = (theta < 0.0 ? -1.0 : 1.0) / (size + sqrt(theta * theta + 1.0));
        double c = 1.0 / sqrt(t * t + 1.0), s = t * c;
        double arp = a[r][p], arq = a[r][q];
        a[p][p] -= t * a[p][q];
        a[q][q] += t * a[p][q];
        a[p][q] = a[q][p] = 0.0;
        a[r][p] = a[p][r] = c * arp - s * arq;
        a[r][q] = a[q][r] = s * arp + c * arq;
        for (int i = 0; i < 3; i++) {
            double vp = v[i][p], vq = v[i][q];
            v[i][p] = c * vp - s * vq;
            v[i][q] = s * vp + c * vq;
        }
    }
}

/* Rotation whose x axis is the longest of a region and whose z axis is the shortest. */
static rlf_quat principal_axes(double v[3][3], const double value[3])
{
    int longest = value[0] >= value[1] ? 0 : 1;
    longest = value[2] > value[longest] ? 2 : longest;
    int shortest = longest == 0 ? 1 : 0;
    shortest = value[3 - longest - shortest] < value[shortest] ? 3 - longest - shortest : shortest;
    rlf_vec3 x = {v[0][longest], v[1][longest], v[2][longest]};
    rlf_vec3 z = {v[0][shortest], v[1][shortest], v[2][shortest]};
    x = x.x + x.y + x.z < 0.0 ? rlf_neg(x) : x; /* one of the two senses, always the same */
    z = z.x + z.y + z.z < 0.0 ? rlf_neg(z) : z;
    rlf_vec3 y = rlf_cross(z, x);
    const rlf_mat3 m = {{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
    return rlf_quat_from_mat3(&m);
}

static void finish_region(rlf_region *region, rlf_region_sum *sum)
{
    double inv = 1.0 / region->point_count;
    double m[3];
    for (int k = 0; k < 3; k++) {
        m[k] = sum->s[k] * inv;
    }
    region->centroid = rlf_vec3_make(m[0], m[1], m[2]);
    double xy = sum->ss[1] * inv - m[0] * m[1], xz = sum->ss[2] * inv - m[0] * m[2];
    double yz = sum->ss[4] * inv - m[1] * m[2];
    double a[3][3] = {{sum->ss[0] * inv - m[0] * m[0], xy, xz},
                      {xy, sum->ss[3] * inv - m[1] * m[1], yz},
                      {xz, yz, sum->ss[5] * inv - m[2] * m[2]}};
    double v[3][3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    diagonalize(a, v);
    const double value[3] = {a[0][0], a[1][1], a[2][2]};
    double least = rlf_min(value[0], rlf_min(value[1], value[2]));
    region->plane_residual = sqrt(rlf_max(least, 0.0));
    region->oriented_pose.q = principal_axes(v, value);
    sum->axis[0] = rlf_rotate(region->oriented_pose.q, rlf_vec3_make(1, 0, 0));
    sum->axis[1] = rlf_rotate(region->oriented_pose.q, rlf_vec3_make(0, 1, 0));
    sum->axis[2] = rlf_rotate(region->oriented_pose.q, rlf_vec3_make(0, 0, 1));
}

/* Extents along the principal axes; until finish_box, oriented_pose.p holds their least and
 * oriented_half their largest values, from the centroid. */
static void add_extents(rlf_region *region, const rlf_region_sum *sum, const rlf_grid *grid,
                        const float *depth, const rlf_run *run, int32_t y)
{
    rlf_vec3 low = region->oriented_pose.p, high = region->oriented_half;
    const rlf_vec3 axis[3] = {sum->axis[0], sum->axis[1], sum->axis[2]}, origin = region->centroid;
    ptrdiff_t row = (ptrdiff_t)y * grid->width;
    for (ptrdiff_t i = row + run->x0; i < row + run->x1; i++) {
        double z = depth[i];
        rlf_vec3 p = {z * grid->ray_x[i], z * grid->ray_y[i], z};
        p = rlf_sub(p, origin);
        p = rlf_vec3_make(rlf_dot(axis[0], p), rlf_dot(axis[1], p), rlf_dot(axis[2], p));
        low = rlf_vec3_min(low, p);
        high = rlf_vec3_max(high, p);
    }
    region->oriented_pose.p = low;
    region->oriented_half = high;
}

static void finish_box(rlf_region *region)
{
    rlf_vec3 low = region->oriented_pose.p, high = region->oriented_half;
    rlf_vec3 middle = rlf_scale(rlf_add(low, high), 0.5);
    region->oriented_half = rlf_scale(rlf_sub(high, low), 0.5);
    region->oriented_pose.p =
        rlf_add(region->centroid, rlf_rotate(region->oriented_pose.q, middle));
}

/* Point lists, region by region, in raster order. */
static void list_points(rlf_reconstruct *stage, rlf_layer_out *out)
{
    const rlf_runs *runs = &stage->work.runs;
    int32_t *next = stage->work.vote[0];
    int32_t total = 0;
    for (int32_t r = 0; r < out->region_count; r++) {
        out->regions[r].first_point = total;
        next[r] = total;
        total += out->regions[r].point_count;
    }
    for (int32_t y = 0; y < stage->grid.height; y++) {
        for (int32_t k = runs->first[y]; k < runs->first[y + 1]; k++) {
            const rlf_run *run = &runs->run[k];
            for (int32_t x = run->x0; x < run->x1 && run->component > 0; x++) {
                out->points[next[run->component - 1]++] = y * stage->grid.width + x;
            }
        }
    }
    out->point_count = total;
}

typedef void (*run_fn)(rlf_reconstruct *stage, const rlf_layer_in *in, rlf_layer_out *out,
                       const rlf_run *run, int32_t y);

static void sum_run(rlf_reconstruct *stage, const rlf_layer_in *in, rlf_layer_out *out,
                    const rlf_run *run, int32_t y)
{
    add_run(&out->regions[run->component - 1], &stage->work.region_sums[run->component - 1],
            &stage->grid, in->depth, run, y);
}

static void extend_run(rlf_reconstruct *stage, const rlf_layer_in *in, rlf_layer_out *out,
                       const rlf_run *run, int32_t y)
{
    add_extents(&out->regions[run->component - 1], &stage->work.region_sums[run->component - 1],
                &stage->grid, in->depth, run, y);
}

static void for_runs(rlf_reconstruct *stage, const rlf_layer_in *in, rlf_layer_out *out,
                     run_fn visit)
{
    const rlf_runs *runs = &stage->work.runs;
    for (int32_t y = 0; y < stage->grid.height; y++) {
        for (int32_t r = runs->first[y]; r < runs->first[y + 1]; r++) {
            if (runs->run[r].component > 0) {
                visit(stage, in, out, &runs->run[r], y);
            }
        }
    }
}

void rlf_region_measure(rlf_reconstruct *stage, const rlf_layer_in *in, rlf_layer_out *out)
{
    rlf_region_sum *sums = stage->work.region_sums;
    for (int32_t r = 0; r < out->region_count; r++) {
        clear_region(&out->regions[r], &sums[r], in, &stage->grid);
    }
    for_runs(stage, in, out, sum_run);
    for (int32_t r = 0; r < out->region_count; r++) {
        finish_region(&out->regions[r], &sums[r]);
    }
    for_runs(stage, in, out, extend_run);
    for (int32_t r = 0; r < out->region_count; r++) {
        finish_box(&out->regions[r]);
    }
    out->point_count = 0;
    if (out->points != NULL) {
        list_points(stage, out);
    }
}
