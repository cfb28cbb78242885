/* Search for posts: pixels of a row that are narrow and stand before what is at both their sides,
 * row above row over the same spot of the floor; and for rectangles of three. */
#include "physics/grid/post.h"
#include "physics/grid/edge.h"
#include "physics/grid/field.h"

#define WIDEST 0.09     /* m that a post is wide */
#define NARROWEST_PX 2  /* what is narrower may be noise */
#define HOLE_PX 3       /* missing pixels beside an outline */
#define SAME_SPOT 0.04  /* m beside a post's axis */
#define HIGH_MIN 0.25   /* m of a post that are seen */
#define ROW_STEP 2      /* rows from one that is looked at to the next */
#define SHARE_MIN 0.6   /* of the rows there that show it */
#define SHORT 0.25      /* m from post to post ... */
#define LONG 2.0        /* ... */
#define SQUARE 0.1      /* cosine of a right angle */
#define SAME_WIDTH 0.03 /* m: a square bar of 6 cm seen at its corner is so much wider */
#define ABOVE 0.25      /* m: something level is no higher than that over the posts */
#define RIM 0.05        /* m that it is wider than the posts' rectangle */
#define LEVEL 0.95      /* cosine between it and the vertical */
#define LEVEL_STEP 4    /* pixels between those that are looked at ... */
#define LEVEL_SHARE 0.1 /* ... of which those that are level fill so much of the rectangle */
#define DOWN 0.1 /* m below what is seen of a post: its foot is the same depth as the floor */

typedef struct post_search {
    grid_posts *posts;
    const rlf_grid *grid;
    rlf_vec3 up;
} post_search;

static rlf_vec3 level_part(rlf_vec3 p, rlf_vec3 up)
{
    return rlf_mad(p, up, -rlf_dot(p, up));
}

/* Adds one row of a post: pixels first to last. */
static void add_row(post_search *s, int32_t y, int32_t first, int32_t last)
{
    const rlf_grid *grid = s->grid;
    grid_posts *posts = s->posts;
    int32_t i = y * grid->width + (first + last) / 2;
    double z = grid->background.depth[i];
    rlf_vec3 p = rlf_vec3_make(z * grid->ray_x[i], z * grid->ray_y[i], z);
    double width = (last - first + 1) * z * grid->pixel_angle, height = rlf_dot(p, s->up);
    rlf_vec3 axis = level_part(p, s->up);
    axis = rlf_mad(axis, rlf_normalize(axis), 0.5 * width);
    post_seen *post = NULL;
    for (int32_t k = 0; k < posts->seen_count && post == NULL; k++) {
        rlf_vec3 off = rlf_sub(axis, posts->seen[k].axis);
        post = rlf_dot(off, off) < SAME_SPOT * SAME_SPOT ? &posts->seen[k] : NULL;
    }
    if (post == NULL) {
        if (posts->seen_count == POSTS_SEEN_MAX) {
            return;
        }
        post = &posts->seen[posts->seen_count++];
        *post = (post_seen){.low = height, .high = height};
    }
    post->points = rlf_add(post->points, axis);
    post->widths += width;
    post->count += 1.0;
    post->axis = rlf_scale(post->points, 1.0 / post->count);
    post->low = rlf_min(post->low, height);
    post->high = rlf_max(post->high, height);
}

/* Walks a row from step to step in depth: what comes nearer and goes away again soon. */
static void search_row(post_search *s, int32_t y)
{
    const float *depth = s->grid->background.depth + (ptrdiff_t)y * s->grid->width;
    int32_t first = -1, last = -1;
    for (int32_t x = 0; x < s->grid->width; x++) {
        double z = depth[x], before = last >= 0 ? depth[last] : 0.0;
        if (!(z > 0.0)) {
            continue;
        }
        bool is_close = last >= 0 && x - last <= HOLE_PX + 1;
        if (is_close && z < before - grid_edge_step(z)) {
            first = x;
        } else if (!is_close) {
            first = -1;
        } else if (z > before + grid_edge_step(before)) {
            double width = (last - first + 1) * before * s->grid->pixel_angle;
            if (first >= 0 && last - first + 1 >= NARROWEST_PX && width <= WIDEST) {
                add_row(s, y, first, last);
            }
            first = -1;
        }
        last = x;
    }
}

/* Keeps what is as high as a post and seen in most rows. */
static void keep_posts(post_search *s)
{
    grid_posts *posts = s->posts;
    int32_t kept = 0;
    for (int32_t i = 0; i < posts->seen_count; i++) {
        const post_seen *post = &posts->seen[i];
        double high = post->high - post->low;
        double row = rlf_length(rlf_mad(post->axis, s->up, post->low)) * s->grid->pixel_angle;
        if (high > HIGH_MIN && post->count * ROW_STEP * row > SHARE_MIN * high) {
            posts->seen[kept++] = *post;
        }
    }
    posts->seen_count = kept;
}

/* A rectangle of which three corners are posts: `corner` is between the other two. */
typedef struct post_corners {
    rlf_vec3 corner, a, b; /* a and b: from the corner to the others */
    double low, high, radius;
} post_corners;

static bool is_rectangle(const post_seen *corner, const post_seen *a, const post_seen *b,
                         post_corners *out)
{
    double widths[3] = {corner->widths / corner->count, a->widths / a->count, b->widths / b->count};
    *out = (post_corners){.corner = corner->axis};
    out->a = rlf_sub(a->axis, corner->axis);
    out->b = rlf_sub(b->axis, corner->axis);
    double long_a = rlf_length(out->a), long_b = rlf_length(out->b);
    double turn = rlf_dot(out->a, out->b);
    double wide = rlf_max(widths[0], rlf_max(widths[1], widths[2]));
    double narrow = rlf_min(widths[0], rlf_min(widths[1], widths[2]));
    out->radius = 0.5 * narrow;
    out->low = rlf_min(corner->low, rlf_min(a->low, b->low));
    out->high = rlf_max(corner->high, rlf_max(a->high, b->high));
    return long_a > SHORT && long_a < LONG && long_b > SHORT && long_b < LONG &&
           turn < SQUARE * long_a * long_b && turn > -SQUARE * long_a * long_b &&
           wide - narrow < SAME_WIDTH;
}

/* Whether something level is seen above those posts; its height over the origin. */
static bool find_level(const post_search *s, const post_corners *r, double *out_height)
{
    const rlf_grid *grid = s->grid;
    double long_a = rlf_length(r->a), long_b = rlf_length(r->b), count = 0.0, sum = 0.0, area = 0.0;
    for (int32_t y = 0; y < grid->height; y += LEVEL_STEP) {
        for (int32_t x = 0; x < grid->width; x += LEVEL_STEP) {
            field_cell cell;
            if (!grid_cell_read(grid, &grid->background, x, y, &cell) ||
                !(rlf_dot(cell.normal, s->up) > LEVEL)) {
                continue;
            }
            double height = rlf_dot(cell.point, s->up) - r->high;
            rlf_vec3 off = rlf_sub(level_part(cell.point, s->up), r->corner);
            double along_a = rlf_dot(off, r->a) / long_a, along_b = rlf_dot(off, r->b) / long_b;
            if (height > -RIM && height < ABOVE && along_a > -RIM && along_a < long_a + RIM &&
                along_b > -RIM && along_b < long_b + RIM) {
                double side = LEVEL_STEP * cell.point.z * grid->pixel_angle;
                double facing = -rlf_dot(cell.normal, cell.point) / cell.point.z;
                area += side * side / rlf_max(facing, 0.1);
                sum += height;
                count += 1.0;
            }
        }
    }
    *out_height = count > 0.0 ? r->high + sum / count : r->high;
    return area > LEVEL_SHARE * long_a * long_b;
}

/* Whether the camera sees that nothing stands there. */
static bool is_seen_empty(const post_search *s, const grid_post *post)
{
    const int32_t STEPS = 16;
    for (int32_t k = 1; k < STEPS; k++) {
        rlf_vec3 q = rlf_mad(post->foot, s->up, k * post->height / STEPS);
        if (grid_field_is_seen_through(s->grid, &s->grid->background, q)) {
            return true;
        }
    }
    return false;
}

static bool is_known(const post_search *s, rlf_vec3 axis)
{
    const grid_posts *posts = s->posts;
    for (int32_t i = 0; i < posts->seen_count + posts->count; i++) {
        rlf_vec3 other = i < posts->seen_count
                             ? posts->seen[i].axis
                             : level_part(posts->posts[i - posts->seen_count].foot, s->up);
        rlf_vec3 off = rlf_sub(axis, other);
        if (rlf_dot(off, off) < WIDEST * WIDEST) {
            return true;
        }
    }
    return false;
}

static void complete(post_search *s, const post_corners *r)
{
    grid_posts *posts = s->posts;
    rlf_vec3 axis = rlf_add(r->corner, rlf_add(r->a, r->b));
    double high;
    if (posts->count == POSTS_MAX || is_known(s, axis)) {
        return;
    }
    grid_post post = {.radius = r->radius, .height = r->high - r->low + DOWN};
    post.foot = rlf_mad(axis, s->up, r->low - DOWN);
    if (!is_seen_empty(s, &post) && find_level(s, r, &high)) {
        post.height = high - r->low + DOWN;
        posts->posts[posts->count++] = post;
    }
}

void grid_posts_update(grid_posts *posts, const rlf_grid *grid, rlf_vec3 up)
{
    const rlf_grid_sheet *sheet = &grid->background;
    bool is_same = sheet->version != 0 && posts->version == sheet->version;
    if (is_same || sheet->depth == NULL || sheet->normal_x == NULL || !(rlf_dot(up, up) > 0.0)) {
        return;
    }
    post_search search = {posts, grid, up};
    posts->count = posts->seen_count = 0;
    posts->version = sheet->version;
    for (int32_t y = grid->height - 1; y >= 0; y -= ROW_STEP) {
        search_row(&search, y);
    }
    keep_posts(&search);
    for (int32_t i = 0; i < posts->seen_count; i++) {
        for (int32_t a = 0; a < posts->seen_count; a++) {
            for (int32_t b = 0; b < a; b++) {
                post_corners r;
                if (a != i && b != i &&
                    is_rectangle(&posts->seen[i], &posts->seen[a], &posts->seen[b], &r)) {
                    complete(&search, &r);
                }
            }
        }
    }
}

double grid_post_distance(const grid_post *post, rlf_vec3 up, rlf_vec3 q)
{
    rlf_vec3 way = rlf_sub(q, post->foot);
    double along = rlf_clamp(rlf_dot(way, up), 0.0, post->height);
    return rlf_length(rlf_mad(way, up, -along)) - post->radius;
}
