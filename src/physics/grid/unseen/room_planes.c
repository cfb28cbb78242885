/* Finding the room's shell. */
#include "physics/grid/unseen/room_planes.h"
#include "physics/grid/field.h"

#define SAMPLES_PER_ROW 32
#define SAMPLES_MAX (SAMPLES_PER_ROW * SAMPLES_PER_ROW)
#define SAMPLES_MIN 64
#define REFINEMENTS 3
#define TRIES_FIRST 96 /* pixels to begin at, in the first search and in each later one */
#define TRIES 12
#define SHARE_MIN 0.03  /* of the samples lie on a plane of the shell ... */
#define BEYOND_MAX 0.01 /* ... and at most so many beyond it; more than twice that ends it */
#define SAME_OFFSET 0.1 /* m */
#define GLIDE_S 2.0     /* time constant of a plane on its way to a new fit ... */
#define REACHED 0.0005  /* ... where it is no farther off than this at ... */
#define REACH 3.0       /* ... so far from the camera, m */

typedef struct room_sample {
    rlf_vec3 point, normal;
} room_sample;

typedef struct room_search {
    room_sample samples[SAMPLES_MAX];
    int32_t count;
} room_search;

typedef struct room_support {
    int32_t on, beyond;
    room_plane refined;
} room_support;

static void take_samples(room_search *search, const rlf_grid *grid)
{
    int32_t longest = grid->width > grid->height ? grid->width : grid->height;
    int32_t step = (longest - 1) / SAMPLES_PER_ROW + 1;
    search->count = 0;
    for (int32_t y = step / 2; y < grid->height; y += step) {
        for (int32_t x = step / 2; x < grid->width; x += step) {
            field_cell cell;
            if (grid_cell_read(grid, &grid->background, x, y, &cell)) {
                room_sample *sample = &search->samples[search->count++];
                sample->point = cell.point;
                sample->normal = cell.normal;
            }
        }
    }
}

/* How far points of a plane may lie off it: walls are not quite even, depth noise grows with z. */
static double tolerance_at(double z)
{
    return 0.03 + 0.01 * z;
}

/* Counts the samples on and beyond the plane, and fits it to those on it. */
static room_support look_at_plane(const room_search *search, const room_plane *plane)
{
    room_support support = {0};
    rlf_vec3 normals = {0, 0, 0}, points = {0, 0, 0};
    for (int32_t i = 0; i < search->count; i++) {
        const room_sample *sample = &search->samples[i];
        double height = room_plane_height(plane, sample->point);
        double tolerance = tolerance_at(sample->point.z);
        support.beyond += height < -tolerance;
        if (height <= tolerance && height >= -tolerance &&
            rlf_dot(sample->normal, plane->normal) > ONE_FACE_COS) {
            support.on++;
            normals = rlf_add(normals, sample->normal);
            points = rlf_add(points, sample->point);
        }
    }
    support.refined = *plane;
    if (support.on > 0) {
        support.refined.normal = rlf_normalize(normals);
        support.refined.offset = rlf_dot(support.refined.normal, points) / support.on;
    }
    return support;
}

static bool is_known(const room_planes *shell, const room_plane *plane)
{
    for (int32_t i = 0; i < shell->count; i++) {
        const room_plane *known = &shell->fitted[i];
        double off = known->offset - plane->offset;
        if (rlf_dot(known->normal, plane->normal) > ONE_PLANE_COS && off < SAME_OFFSET &&
            off > -SAME_OFFSET) {
            return true;
        }
    }
    return false;
}

static void keep_known(room_planes *shell, const room_search *search)
{
    int32_t kept = 0;
    for (int32_t i = 0; i < shell->count; i++) {
        room_support support = look_at_plane(search, &shell->fitted[i]);
        if (support.beyond <= 2.0 * BEYOND_MAX * search->count) {
            bool is_seen = support.on >= SHARE_MIN * search->count;
            shell->planes[kept] = shell->planes[i];
            shell->fitted[kept++] = is_seen ? support.refined : shell->fitted[i];
        }
    }
    shell->count = kept;
}

static void find_new(room_planes *shell, const room_search *search)
{
    int32_t tries = shell->turn == 0 ? TRIES_FIRST : TRIES;
    int32_t stride = search->count / tries + 1;
    for (int32_t i = (int32_t)(shell->turn % (uint32_t)stride);
         i < search->count && shell->count < ROOM_PLANES_MAX; i += stride) {
        const room_sample *sample = &search->samples[i];
        room_plane plane = {sample->normal, rlf_dot(sample->normal, sample->point)};
        room_support support = {0};
        for (int32_t k = 0; k <= REFINEMENTS && !is_known(shell, &plane); k++) {
            support = look_at_plane(search, &plane);
            if (k == REFINEMENTS && support.on >= SHARE_MIN * search->count &&
                support.beyond <= BEYOND_MAX * search->count) {
                shell->fitted[shell->count] = plane;
                shell->planes[shell->count++] = plane;
                break;
            }
            plane = support.refined;
        }
    }
}

void room_planes_update(room_planes *shell, const rlf_grid *grid)
{
    room_search search;
    if (grid->background.depth == NULL || grid->background.normal_x == NULL) {
        return;
    }
    take_samples(&search, grid);
    if (search.count < SAMPLES_MIN) {
        return; /* the camera is covered: the room is still there */
    }
    keep_known(shell, &search);
    find_new(shell, &search);
    shell->turn++;
}

bool room_planes_glide(room_planes *shell, double dt)
{
    double share = dt / (dt + GLIDE_S);
    bool has_moved = false;
    for (int32_t i = 0; i < shell->count; i++) {
        room_plane *plane = &shell->planes[i];
        const room_plane *to = &shell->fitted[i];
        rlf_vec3 turn = rlf_sub(to->normal, plane->normal);
        double off = to->offset - plane->offset;
        double way = rlf_max(off, -off) + REACH * rlf_length(turn);
        if (way > REACHED) {
            rlf_vec3 normal = rlf_mad(plane->normal, turn, share);
            double length = rlf_length(normal);
            plane->offset = (plane->offset + off * share) / length;
            plane->normal = rlf_scale(normal, 1.0 / length);
            has_moved = true;
        }
    }
    return has_moved;
}

static void carry(room_plane *plane, const rlf_pose *T_before_now)
{
    plane->offset -= rlf_dot(plane->normal, T_before_now->p);
    plane->normal = rlf_rotate(rlf_quat_conjugate(T_before_now->q), plane->normal);
}

void room_planes_carry(room_planes *shell, const rlf_pose *T_before_now)
{
    for (int32_t i = 0; i < shell->count; i++) {
        carry(&shell->planes[i], T_before_now);
        carry(&shell->fitted[i], T_before_now);
    }
}

bool room_is_hidden(const rlf_grid *grid, rlf_vec3 q)
{
    field_cell cell;
    if (grid_field_is_open(grid, &grid->background, q)) {
        return false;
    }
    field_state state = grid_field_state(grid, &grid->background, q, &cell);
    return state == FIELD_NONE || state == FIELD_BEHIND;
}
