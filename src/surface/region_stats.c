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

static void add_point(rlf_region *region, rlf_region_sum *sum, int32_t x, int32_t y, rlf_vec3 p)
{
    region->point_count++;
    region->x0 = x < region->x0 ? x : region->x0;
    region->y0 = y < region->y0 ? y : region->y0;
    region->x1 = x + 1 > region->x1 ? x + 1 : region->x1;
    region->y1 = y + 1 > region->y1 ? y + 1 : region->y1;
    rlf_aabb_extend(&region->box, p);
    sum->s[0] += p.x;
    sum->s[1] += p.y;
    sum->s[2] += p.z;
    sum->ss[0] += p.x * p.x;
    sum->ss[1] += p.x * p.y;
    sum->ss[2] += p.x * p.z;
    sum->ss[3] += p.y * p.y;
    sum->ss[4] += p.y * p.z;
    sum->ss[5] += p.z * p.z;
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

static void finish_region(rlf_region *region, const rlf_region_sum *sum)
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
}

/* Extents along the principal axes; until finish_boxes, oriented_pose.p holds their least and
 * oriented_half their largest values, from the centroid. */
static void measure_boxes(const rlf_grid *grid, const rlf_layer_in *in, const int32_t *number,
                          rlf_region *regions)
{
    rlf_region *region = NULL;
    rlf_vec3 axis[3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    for (int32_t i = 0; i < grid->count; i++) {
        if (number[i] == 0) {
            continue;
        }
        if (region != &regions[number[i] - 1]) {
            region = &regions[number[i] - 1];
            rlf_quat q = region->oriented_pose.q;
            axis[0] = rlf_rotate(q, rlf_vec3_make(1, 0, 0));
            axis[1] = rlf_rotate(q, rlf_vec3_make(0, 1, 0));
            axis[2] = rlf_rotate(q, rlf_vec3_make(0, 0, 1));
        }
        double z = in->depth[i];
        rlf_vec3 p = {z * grid->ray_x[i], z * grid->ray_y[i], z};
        p = rlf_sub(p, region->centroid);
        p = rlf_vec3_make(rlf_dot(axis[0], p), rlf_dot(axis[1], p), rlf_dot(axis[2], p));
        region->oriented_pose.p = rlf_vec3_min(region->oriented_pose.p, p);
        region->oriented_half = rlf_vec3_max(region->oriented_half, p);
    }
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
static void list_points(rlf_reconstruct *stage, const int32_t *number, rlf_layer_out *out)
{
    int32_t *next = stage->work.vote[0];
    int32_t total = 0;
    for (int32_t r = 0; r < out->region_count; r++) {
        out->regions[r].first_point = total;
        next[r] = total;
        total += out->regions[r].point_count;
    }
    for (int32_t i = 0; i < stage->grid.count; i++) {
        if (number[i] != 0) {
            out->points[next[number[i] - 1]++] = i;
        }
    }
    out->point_count = total;
}

void rlf_region_measure(rlf_reconstruct *stage, const rlf_layer_in *in, const int32_t *number,
                        rlf_layer_out *out)
{
    const rlf_grid *grid = &stage->grid;
    rlf_region_sum *sums = stage->work.region_sums;
    for (int32_t r = 0; r < out->region_count; r++) {
        clear_region(&out->regions[r], &sums[r], in, grid);
    }
    for (int32_t y = 0; y < grid->height; y++) {
        for (int32_t x = 0; x < grid->width; x++) {
            int32_t i = y * grid->width + x;
            if (number[i] == 0) {
                continue;
            }
            double z = in->depth[i];
            rlf_vec3 p = {z * grid->ray_x[i], z * grid->ray_y[i], z};
            add_point(&out->regions[number[i] - 1], &sums[number[i] - 1], x, y, p);
        }
    }
    for (int32_t r = 0; r < out->region_count; r++) {
        finish_region(&out->regions[r], &sums[r]);
    }
    measure_boxes(grid, in, number, out->regions);
    for (int32_t r = 0; r < out->region_count; r++) {
        finish_box(&out->regions[r]);
    }
    out->point_count = 0;
    if (out->points != NULL) {
        list_points(stage, number, out);
    }
}
