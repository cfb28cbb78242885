/* What is known of each region: rectangle, box, centroid, flatness, points. */
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

/* Smallest eigenvalue of a symmetric 3x3 matrix (xx xy xz yy yz zz), in closed form (Smith 1961).
 */
static double smallest_eigenvalue(const double c[6])
{
    double q = (c[0] + c[3] + c[5]) / 3.0;
    double xx = c[0] - q, yy = c[3] - q, zz = c[5] - q;
    double off = c[1] * c[1] + c[2] * c[2] + c[4] * c[4];
    double p = sqrt((xx * xx + yy * yy + zz * zz + 2.0 * off) / 6.0);
    if (!(p > 0.0)) {
        return q;
    }
    double det = xx * (yy * zz - c[4] * c[4]) - c[1] * (c[1] * zz - c[4] * c[2]) +
                 c[2] * (c[1] * c[4] - yy * c[2]);
    double angle = rlf_acos(rlf_clamp(det / (2.0 * p * p * p), -1.0, 1.0)) / 3.0;
    return q + 2.0 * p * rlf_cos(angle + 2.0 * RLF_PI / 3.0);
}

static void finish_region(rlf_region *region, const rlf_region_sum *sum)
{
    double inv = 1.0 / region->point_count;
    double m[3];
    for (int k = 0; k < 3; k++) {
        m[k] = sum->s[k] * inv;
    }
    region->centroid = rlf_vec3_make(m[0], m[1], m[2]);
    const double c[6] = {sum->ss[0] * inv - m[0] * m[0], sum->ss[1] * inv - m[0] * m[1],
                         sum->ss[2] * inv - m[0] * m[2], sum->ss[3] * inv - m[1] * m[1],
                         sum->ss[4] * inv - m[1] * m[2], sum->ss[5] * inv - m[2] * m[2]};
    region->plane_residual = sqrt(rlf_max(smallest_eigenvalue(c), 0.0));
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
    out->point_count = 0;
    if (out->points != NULL) {
        list_points(stage, number, out);
    }
}
