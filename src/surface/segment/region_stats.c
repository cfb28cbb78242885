/* What is known of each region: rectangle, boxes, centroid, flatness, points. */
#include "surface/steps.h"

static void clear_extents(rlf_region_lanes *lanes)
{
    for (int32_t k = 0; k < 3 * RLF_REGION_LANES; k++) {
        lanes->least[k / RLF_REGION_LANES][k % RLF_REGION_LANES] = INFINITY;
        lanes->most[k / RLF_REGION_LANES][k % RLF_REGION_LANES] = -INFINITY;
    }
}

static void clear_region(rlf_region *region, rlf_region_sum *sum, const rlf_layer_in *in,
                         const image_grid *grid)
{
    *region = (rlf_region){0};
    region->layer = in->layer;
    region->first_point = -1;
    region->x0 = grid->width;
    region->y0 = grid->height;
    region->plane_residual = -1.0;
    region->oriented_pose = rlf_pose_identity();
    *sum = (rlf_region_sum){0};
    clear_extents(&sum->points);
}

void rlf_region_grow(rlf_region *region, const rlf_run *run, int32_t y)
{
    region->point_count += run->x1 - run->x0;
    region->x0 = run->x0 < region->x0 ? run->x0 : region->x0;
    region->x1 = run->x1 > region->x1 ? run->x1 : region->x1;
    region->y0 = y < region->y0 ? y : region->y0;
    region->y1 = y + 1 > region->y1 ? y + 1 : region->y1;
}

/* Sums of the runs' points, or when `is_extent` how far these go along the axes of their sum. */
static void add_runs(rlf_reconstruct *stage, const rlf_layer_in *in, rlf_layer_out *out,
                     bool is_extent)
{
    const image_grid *grid = &stage->grid;
    const rlf_runs *runs = &stage->work.runs;
    for (int32_t y = 0; y < grid->height; y++) {
        for (int32_t r = runs->first[y]; r < runs->first[y + 1]; r++) {
            const rlf_run *run = &runs->run[r];
            int32_t k = run->component - 1, count = run->x1 - run->x0;
            const ptrdiff_t i = (ptrdiff_t)y * grid->width + run->x0;
            const float *z = in->depth + i, *ray_x = grid->ray_x + i, *ray_y = grid->ray_y + i;
            if (k >= 0 && is_extent) {
                rlf_region_sum *sum = &stage->work.region_sums[k];
                rlf_kernel_extent_row(&sum->axes, z, ray_x, ray_y, count, &sum->points);
            } else if (k >= 0) {
                rlf_region_grow(&out->regions[k], run, y);
                rlf_kernel_region_row(z, ray_x, ray_y, count, &stage->work.region_sums[k].points);
            }
        }
    }
}

static double total(const double lanes[RLF_REGION_LANES])
{
    return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
}

static rlf_aabb box_of(const rlf_region_lanes *lanes)
{
    rlf_aabb box = rlf_aabb_empty();
    for (int32_t k = 0; k < RLF_REGION_LANES; k++) {
        const double *low = &lanes->least[0][k], *high = &lanes->most[0][k];
        rlf_vec3 least = {low[0], low[RLF_REGION_LANES], low[2 * RLF_REGION_LANES]};
        rlf_vec3 most = {high[0], high[RLF_REGION_LANES], high[2 * RLF_REGION_LANES]};
        box.min = rlf_vec3_min(box.min, least);
        box.max = rlf_vec3_max(box.max, most);
    }
    return box;
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
    double m[3], ss[6];
    for (int k = 0; k < 3; k++) {
        m[k] = total(sum->points.sum[k]) * inv;
    }
    for (int k = 0; k < 6; k++) {
        ss[k] = total(sum->points.square[k]) * inv;
    }
    region->box = box_of(&sum->points);
    region->centroid = rlf_vec3_make(m[0], m[1], m[2]);
    double xy = ss[1] - m[0] * m[1], xz = ss[2] - m[0] * m[2], yz = ss[4] - m[1] * m[2];
    double a[3][3] = {{ss[0] - m[0] * m[0], xy, xz},
                      {xy, ss[3] - m[1] * m[1], yz},
                      {xz, yz, ss[5] - m[2] * m[2]}};
    double v[3][3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    diagonalize(a, v);
    const double value[3] = {a[0][0], a[1][1], a[2][2]};
    double least = rlf_min(value[0], rlf_min(value[1], value[2]));
    region->plane_residual = sqrt(rlf_max(least, 0.0));
    region->oriented_pose.q = principal_axes(v, value);
    for (int k = 0; k < 3; k++) {
        rlf_vec3 axis = rlf_rotate(region->oriented_pose.q, rlf_vec3_make(k == 0, k == 1, k == 2));
        sum->axes.axis[k][0] = axis.x;
        sum->axes.axis[k][1] = axis.y;
        sum->axes.axis[k][2] = axis.z;
        sum->axes.origin[k] = m[k];
    }
    clear_extents(&sum->points);
}

static void finish_box(rlf_region *region, const rlf_region_sum *sum)
{
    rlf_aabb along = box_of(&sum->points);
    rlf_vec3 middle = rlf_scale(rlf_add(along.min, along.max), 0.5);
    region->oriented_half = rlf_scale(rlf_sub(along.max, along.min), 0.5);
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

void rlf_region_measure(rlf_reconstruct *stage, const rlf_layer_in *in, rlf_layer_out *out)
{
    rlf_region_sum *sums = stage->work.region_sums;
    for (int32_t r = 0; r < out->region_count; r++) {
        clear_region(&out->regions[r], &sums[r], in, &stage->grid);
    }
    add_runs(stage, in, out, false);
    for (int32_t r = 0; r < out->region_count; r++) {
        finish_region(&out->regions[r], &sums[r]);
    }
    add_runs(stage, in, out, true);
    for (int32_t r = 0; r < out->region_count; r++) {
        finish_box(&out->regions[r], &sums[r]);
    }
    out->point_count = 0;
    if (out->points != NULL) {
        list_points(stage, out);
    }
}

bool rlf_region_is_flat(const rlf_reconstruct *stage, const rlf_region *region)
{
    double sigma = rlf_depth_noise_sigma(&stage->def.rig.noise, region->centroid.z);
    return region->plane_residual >= 0.0 && region->plane_residual <= 2.0 * sigma;
}
