/* Moving bodies into view from beyond the picture's border, and what they may touch there. */
#include "physics/grid/unseen/unseen.h"

#define FARTHEST 0.25 /* m that a place is moved until it is in view */
#define SAME_SIDE 0.1 /* m beside a touch that its side may be at the border */
#define BESIDE_PX 1   /* an outline's place is that far off */
#define RING_SHARE 8  /* missing pixels at the border are no wider than the picture by this */

static const grid_shift no_shift = {{0, 0, 0}, 0.0, 0, 0};

/* The shortest shift along a way that takes q to where something is in view; 0: none does. */
static double length_to_view(const grid_query *query, rlf_vec3 q, rlf_vec3 way)
{
    const rlf_grid *grid = query->grid;
    int32_t x, y;
    if (!grid_pixel_of(grid, rlf_mad(q, way, FARTHEST), &x, &y)) {
        return 0.0;
    }
    double pixel = rlf_max(q.z * grid->pixel_angle, 0.002);
    for (double length = pixel; length < FARTHEST; length += pixel) {
        field_cell cell;
        if (grid_pixel_of(grid, rlf_mad(q, way, length), &x, &y) &&
            grid_cell_read(grid, &grid->background, x, y, &cell)) {
            return length;
        }
    }
    return 0.0;
}

/* Along the axis of the image on which q comes in: a camera may be rolled, or upside down. */
static void set_inwards(grid_shift *shift, rlf_vec3 q)
{
    double x = shift->way.x - shift->way.z * (q.x / q.z);
    double y = shift->way.y - shift->way.z * (q.y / q.z);
    bool is_row = x * x > y * y;
    shift->dx = !is_row ? 0 : x > 0.0 ? 1 : -1;
    shift->dy = is_row ? 0 : y > 0.0 ? 1 : -1;
}

/* The border's pixel from which the way comes to (x, y). Returns how many pixels that is away. */
static int32_t border_pixel(const rlf_grid *grid, const grid_shift *shift, int32_t x, int32_t y,
                            int32_t *u, int32_t *v)
{
    *u = shift->dx == 0 ? x : shift->dx > 0 ? 0 : grid->width - 1;
    *v = shift->dy == 0 ? y : shift->dy > 0 ? 0 : grid->height - 1;
    return shift->dx * (x - *u) + shift->dy * (y - *v);
}

/* Whether the pixel is one of a ring of missing ones at the border, which the way leaves. What is
 * wider is a hole in what is seen. */
static bool is_in_ring(const rlf_grid *grid, const grid_shift *shift, int32_t x, int32_t y)
{
    int32_t u, v, own = border_pixel(grid, shift, x, y, &u, &v);
    int32_t widest = (shift->dx != 0 ? grid->width : grid->height) / RING_SHARE;
    for (int32_t k = 0; own < widest && k <= widest; k++, u += shift->dx, v += shift->dy) {
        field_cell cell;
        if (grid_cell_read(grid, &grid->background, u, v, &cell)) {
            return k > own;
        }
    }
    return false;
}

static grid_shift find_shift(const grid_query *query, rlf_vec3 q, double radius)
{
    int32_t x = 0, y = 0;
    bool is_in_picture = grid_pixel_of(query->grid, q, &x, &y);
    const rlf_vec3 ways[4] = {query->up, {1, 0, 0}, {-1, 0, 0}, rlf_neg(query->up)};
    for (int k = 0; k < 4; k++) {
        grid_shift shift = {.way = ways[k]};
        set_inwards(&shift, q);
        bool is_way = rlf_dot(shift.way, shift.way) > 0.0 &&
                      (!is_in_picture || is_in_ring(query->grid, &shift, x, y));
        shift.length = is_way ? length_to_view(query, q, shift.way) : 0.0;
        if (shift.length > 0.0) {
            shift.length += radius;
            return shift;
        }
    }
    return no_shift;
}

grid_shift grid_out_of_view(const grid_query *query, rlf_vec3 q, double radius)
{
    int32_t x, y;
    field_cell cell;
    if (query->room == NULL || !(q.z > 0.0)) {
        return no_shift;
    }
    bool is_seen = grid_pixel_of(query->grid, q, &x, &y) &&
                   grid_cell_read(query->grid, &query->grid->background, x, y, &cell);
    return is_seen ? no_shift : find_shift(query, q, radius);
}

static bool is_along(const grid_shift *shift, rlf_vec3 normal)
{
    double slope = rlf_dot(normal, shift->way);
    return slope < ASIDE_COS && slope > -ASIDE_COS;
}

/* The pixel next to the border, of those of a row or column out to (x, y), that shows anything. */
static bool read_outermost(const rlf_grid *grid, const grid_shift *shift, int32_t x, int32_t y,
                           field_cell *out)
{
    int32_t u, v;
    (void)border_pixel(grid, shift, x, y, &u, &v);
    while (u >= 0 && v >= 0 && u < grid->width && v < grid->height) {
        if (grid_cell_read(grid, &grid->background, u, v, out)) {
            return true;
        }
        if (u == x && v == y) {
            return false;
        }
        u += shift->dx;
        v += shift->dy;
    }
    return false;
}

bool grid_goes_on(const grid_query *query, const grid_shift *shift, const grid_hit *hit)
{
    const rlf_grid *grid = query->grid;
    int32_t x, y;
    if (!is_along(shift, hit->normal) || !grid_pixel_of(grid, hit->point, &x, &y)) {
        return false;
    }
    for (int32_t k = -BESIDE_PX; k <= BESIDE_PX; k++) {
        field_cell end;
        int32_t u = x + k * (shift->dy != 0), v = y + k * (shift->dx != 0);
        if (!read_outermost(grid, shift, u, v, &end) || !is_along(shift, end.normal)) {
            continue;
        }
        rlf_vec3 off = rlf_sub(end.point, hit->point);
        off = rlf_mad(off, shift->way, -rlf_dot(off, shift->way));
        if (rlf_dot(off, off) < SAME_SIDE * SAME_SIDE) {
            return true;
        }
    }
    return false;
}
