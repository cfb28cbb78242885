/* Search for what a level face shows at both sides of what stands on it. Rows are walked from the
 * nearest on: a row that shows the face at one side only, since the other side ends before it,
 * takes the strip's other end from the row before. */
#include "physics/grid/level.h"
#include "physics/grid/edge.h"
#include "physics/grid/field.h"

#define LEVEL 0.95     /* cosine between a level face and the vertical */
#define OFF 0.02       /* m: what is no farther from a plane lies on it */
#define SETTLED_PX 3   /* so far from an outline depth and normal are those of the face */
#define HOLE_PX 4      /* missing pixels beside an outline */
#define WIDEST 0.8     /* m from side to side */
#define ASIDE_PX 3     /* the end of a strip moves by no more from row to row */
#define SAME_FACE 0.98 /* cosine */

typedef struct level_search {
    grid_levels *levels;
    const grid_shell *shell;
    const rlf_grid *grid;
    rlf_vec3 up;
    int32_t before; /* first of the runs of the row before */
    int32_t first;  /* ... and of this one */
} level_search;

static double height_over(const shell_plane *plane, rlf_vec3 p)
{
    return rlf_dot(plane->normal, p) - plane->offset;
}

static bool is_near_zero(double height, double limit)
{
    return height < limit && height > -limit;
}

/* A pixel of a level face. */
static bool read_level(const level_search *s, int32_t x, int32_t y, field_cell *out)
{
    return grid_cell_read(s->grid, &s->grid->background, x, y, out) &&
           rlf_dot(out->normal, s->up) > LEVEL;
}

static bool is_level_at(const level_search *s, ptrdiff_t i)
{
    const rlf_grid_sheet *sheet = &s->grid->background;
    double up = (double)sheet->normal_x[i] * s->up.x + (double)sheet->normal_y[i] * s->up.y +
                (double)sheet->normal_z[i] * s->up.z;
    return up > LEVEL;
}

static bool is_of_shell(const level_search *s, rlf_vec3 p)
{
    for (int32_t i = 0; i < s->shell->count; i++) {
        if (is_near_zero(height_over(&s->shell->planes[i], p), 2.0 * OFF)) {
            return true;
        }
    }
    return false;
}

/* The face on whose plane that pixel is, or a new one; -1 when there is no room. */
static int32_t face_of(grid_levels *levels, const field_cell *cell)
{
    for (int32_t i = 0; i < levels->face_count; i++) {
        const shell_plane *plane = &levels->faces[i].plane;
        if (is_near_zero(height_over(plane, cell->point), OFF) &&
            rlf_dot(plane->normal, cell->normal) > SAME_FACE) {
            return i;
        }
    }
    if (levels->face_count == LEVEL_FACES_MAX) {
        return -1;
    }
    level_face *face = &levels->faces[levels->face_count];
    *face = (level_face){.plane = {cell->normal, rlf_dot(cell->normal, cell->point)}};
    return levels->face_count++;
}

/* Fits the face's plane to one more pixel. */
static void add_to_face(level_face *face, const field_cell *cell)
{
    face->normals = rlf_add(face->normals, cell->normal);
    face->points = rlf_add(face->points, cell->point);
    face->count += 1.0;
    face->plane.normal = rlf_normalize(face->normals);
    face->plane.offset = rlf_dot(face->plane.normal, face->points) / face->count;
}

/* Where the strip of that face ended in the row before that began about x; -1 = nowhere. */
static int32_t end_before(const level_search *s, int32_t face, int32_t x)
{
    for (int32_t i = s->before; i < s->first; i++) {
        const level_run *run = &s->levels->runs[i];
        if (run->face == face && run->x0 - x <= ASIDE_PX && x - run->x0 <= ASIDE_PX) {
            return run->x1;
        }
    }
    return -1;
}

/* The end of the strip that begins at x behind what stands there, beside the face's pixel `from`;
 * -1 when the face does not go on. */
static int32_t find_end(const level_search *s, const field_cell *from, int32_t face, int32_t x)
{
    const rlf_grid *grid = s->grid;
    const shell_plane plane = {from->normal, rlf_dot(from->normal, from->point)};
    double widest = WIDEST / rlf_max(from->point.z * grid->pixel_angle, 1e-6);
    int32_t limit = (int32_t)rlf_min(x + widest, grid->width - SETTLED_PX);
    for (int32_t k = x; k < limit; k++) {
        field_cell cell, beside;
        if (!grid_cell_read(grid, &grid->background, k, from->y, &cell)) {
            continue;
        }
        double height = height_over(&plane, cell.point);
        if (height < -OFF) {
            int32_t end = end_before(s, face, x); /* past it: only seen at this side */
            return end < k ? end : k;
        }
        if (height < OFF && read_level(s, k + SETTLED_PX, from->y, &beside) &&
            is_near_zero(height_over(&plane, beside.point), OFF)) {
            add_to_face(&s->levels->faces[face], from);
            add_to_face(&s->levels->faces[face], &beside);
            return k;
        }
    }
    return -1;
}

static void look_behind(level_search *s, int32_t last, int32_t x, int32_t y)
{
    grid_levels *levels = s->levels;
    field_cell from;
    if (levels->run_count == LEVEL_RUNS_MAX || !read_level(s, last - SETTLED_PX, y, &from) ||
        is_of_shell(s, from.point)) {
        return;
    }
    int32_t faces = levels->face_count, face = face_of(levels, &from);
    int32_t end = face < 0 ? -1 : find_end(s, &from, face, x);
    if (end > x) {
        levels->runs[levels->run_count++] = (level_run){y, x, end, face};
    } else {
        levels->face_count = faces;
    }
}

/* A level face may end at a pixel because something before it hides it, or stands on it. */
static void search_row(level_search *s, int32_t y)
{
    const rlf_grid_sheet *sheet = &s->grid->background;
    ptrdiff_t row = (ptrdiff_t)y * s->grid->width;
    bool was_level = false;
    int32_t last = -1;
    for (int32_t x = 0; x < s->grid->width; x++) {
        double z = (double)sheet->depth[row + x];
        if (!(z > 0.0)) {
            continue;
        }
        bool is_level = is_level_at(s, row + x);
        bool is_near = last >= SETTLED_PX && x - last <= HOLE_PX;
        bool is_hidden = is_near && (double)sheet->depth[row + last] > z + grid_edge_step(z);
        if (is_hidden || (is_near && was_level && !is_level)) {
            look_behind(s, last, last + 1, y);
        }
        was_level = is_level;
        last = x;
    }
}

void grid_levels_update(grid_levels *levels, const grid_shell *shell, const rlf_grid *grid,
                        rlf_vec3 up)
{
    const rlf_grid_sheet *sheet = &grid->background;
    bool is_same = sheet->version != 0 && levels->version == sheet->version;
    if (is_same || sheet->depth == NULL || sheet->normal_x == NULL || !(rlf_dot(up, up) > 0.0)) {
        return;
    }
    level_search search = {.levels = levels, .shell = shell, .grid = grid, .up = up};
    levels->face_count = levels->run_count = 0;
    levels->version = sheet->version;
    for (int32_t y = grid->height - 1; y >= 0; y--) {
        search.before = search.first;
        search.first = levels->run_count;
        search_row(&search, y);
    }
}

static bool is_in_strip(const grid_levels *levels, int32_t face, int32_t x, int32_t y)
{
    for (int32_t i = 0; i < levels->run_count && levels->runs[i].y >= y; i++) {
        const level_run *run = &levels->runs[i];
        if (run->y == y && run->face == face && x >= run->x0 && x < run->x1) {
            return true;
        }
    }
    return false;
}

bool grid_level_find(const grid_levels *levels, const rlf_grid *grid, rlf_vec3 q, double reach,
                     shell_plane *out)
{
    for (int32_t i = 0; i < levels->face_count; i++) {
        const shell_plane *plane = &levels->faces[i].plane;
        double height = height_over(plane, q);
        int32_t x, y;
        if (height < reach && height > -OFF &&
            grid_pixel_of(grid, rlf_mad(q, plane->normal, -height), &x, &y) &&
            is_in_strip(levels, i, x, y)) {
            *out = *plane;
            return true;
        }
    }
    return false;
}

bool grid_level_is_hidden(const rlf_grid *grid, rlf_vec3 q)
{
    field_cell cell;
    return grid_field_state(grid, &grid->background, q, &cell) != FIELD_FRONT;
}
