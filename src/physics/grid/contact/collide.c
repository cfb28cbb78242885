/* Contacts of one body with the grid: its own surface points against the sheets, and the sheets'
 * outlines and bumps against it. Costs per body, not per pixel; nothing is built per frame. */
#include "physics/grid/ball/ball.h"
#include "physics/grid/contact/search.h"
#include "physics/grid/mapped/mapped.h"
#include "physics/grid/unseen/unseen.h"

/* Most substeps between two queries: a body that falls from rest must not fall through the margin;
 * one that lies on something does not fall. */
#define PERIOD_MAX 4.0
#define PERIOD_AT_REST 8.0
/* A surface that moves may come so much nearer until the next query, metres. */
#define APPROACH_M GRID_THIN_M
/* A body that moved less than this share of the margin keeps its contacts. */
#define SETTLED_SHARE 0.5
/* Touches with what goes on beyond the picture. */
#define OUT_OF_VIEW_MAX 16

static void set_up(grid_job *job, const grid_query *query, const phys_body *body)
{
    rlf_quat q_grid_body = rlf_quat_mul(query->T_grid_world.q, body->q);
    job->query = query;
    job->body = body;
    job->motion.centre = rlf_transform(&query->T_grid_world, body->x);
    job->motion.v = rlf_rotate(query->T_grid_world.q, body->v);
    job->motion.w = rlf_rotate(query->T_grid_world.q, body->w);
    job->motion.speed = rlf_length(job->motion.v);
    job->motion.spin = rlf_length(job->motion.w);
    job->motion.R_grid_body = rlf_quat_to_mat3(q_grid_body);
    job->motion.R_body_grid = rlf_mat3_transpose(&job->motion.R_grid_body);
}

/* How far a sheet may come by itself until the next query, metres. */
static double approach_margin_of(const grid_tiles *tiles)
{
    return tiles->sheet->velocity_x != NULL ? APPROACH_M : 0.0;
}

/* How far from the body's centre anything that stays can matter until its contacts are asked for
 * again. */
static double reach_of(const grid_query *query, const phys_body *body, int32_t period)
{
    double speed = rlf_length(body->v) + 0.5 * rlf_length(body->w) * body->shape.radius;
    return body->shape.radius + GRID_MARGIN + speed * (period + 1) * query->step;
}

/* A bump counts only where no contact plane explains it: noise on a flat surface is no bump. */
static void add_bumps(grid_job *job)
{
    int32_t plane_count = job->hit_count;
    for (int32_t i = 0; i < job->scan.bump_count && job->hit_count < GRID_HITS_MAX; i++) {
        const grid_hit *bump = &job->scan.bumps[i];
        bool is_explained = false;
        for (int32_t k = 0; k < plane_count && !is_explained; k++) {
            const grid_hit *hit = &job->hits[k];
            double off = rlf_dot(hit->normal, rlf_sub(bump->point, hit->point));
            is_explained = rlf_dot(hit->normal, bump->facing) > APART_COS && off < GRID_NOISE_M;
        }
        if (!is_explained) {
            job->hits[job->hit_count++] = *bump;
        }
    }
}

static void clear(grid_job *job)
{
    job->scan.surface_velocity = rlf_vec3_make(0, 0, 0);
    job->scan.nearest2 = job->window.reach * job->window.reach;
    job->scan.stride = 0;
    job->scan.is_near = job->scan.is_flat = false;
    job->scan.flat_count = 0;
    job->scan.normal_count = 0;
    job->scan.bump_count = 0;
    job->touch_count = 0;
    job->hit_count = 0;
    job->scan.solid_count = 0;
    job->scan.is_listed = true;
}

/* Whether the surface's plane had not yet passed the body's centre, which is behind it now, when
 * the body's contacts were last asked for: frames were lost, or it is fast. */
static bool is_swept(const grid_job *job, const field_cell *cell, rlf_vec3 seen)
{
    double since = job->query->time - job->window.asked_before + job->query->lag;
    double height = rlf_dot(cell->normal, rlf_sub(seen, cell->point));
    return height + rlf_dot(cell->normal, cell->velocity) * since > 0.0;
}

/* What came behind somebody stays there while he has a hole, or is lost for a frame. */
static bool is_still_behind(const grid_job *job, field_state state, uint8_t side, rlf_vec3 seen)
{
    return state == FIELD_NONE && side == FIELD_BEHIND && job->tiles == job->query->foreground &&
           grid_field_may_hide(job->query->grid, job->sheet, seen);
}

/* Inside a solid a body still belongs to the side from which it came. True when it is inside, or
 * the solid swept over it. */
static bool update_side(grid_job *job, uint8_t *side)
{
    field_cell cell;
    rlf_vec3 seen = rlf_mad(job->motion.centre, job->scan.surface_velocity, -job->query->tau);
    field_state state = FIELD_NONE;
    bool is_mapped = job->tiles == job->query->background && mapped_answers(job->query, seen);
    if (job->scan.is_near && !is_mapped) {
        state = grid_field_state(job->query->grid, job->sheet, seen, &cell);
    }
    if (is_mapped) {
        *side = FIELD_NONE; /* whatever the sheet guesses of its back */
    } else if (state == FIELD_BEHIND && *side == FIELD_FRONT && is_swept(job, &cell, seen)) {
        *side = FIELD_INSIDE;
    } else if (state != FIELD_INSIDE && !(state == FIELD_BEHIND && *side == FIELD_INSIDE) &&
               !is_still_behind(job, state, *side, seen)) {
        *side = (uint8_t)state;
    }
    job->side = (field_side){(field_state)*side, seen, true};
    return state == FIELD_INSIDE || *side == FIELD_INSIDE;
}

static void collide_layer(grid_job *job, const grid_tiles *tiles, uint8_t *side)
{
    job->tiles = tiles;
    job->sheet = tiles->sheet;
    job->window.reach =
        reach_of(job->query, job->body, job->body->surface_period) + approach_margin_of(tiles);
    clear(job);
    if (job->sheet->depth == NULL || job->sheet->normal_x == NULL) {
        return;
    }
    job->is_ball = job->body->shape.shape.type == RLF_SHAPE_SPHERE;
    grid_scan_footprint(job);
    bool is_inside = update_side(job, side);
    if (job->is_ball && is_inside) { /* no touch, but a way out: by the points of its surface */
        clear(job);
        job->is_ball = false;
        grid_scan_footprint(job);
    }
    if (job->is_ball) {
        grid_ball_add_hits(job);
    } else if (job->scan.is_near) {
        grid_cast_points(job);
        add_bumps(job);
    }
}

/* Touches of the body with what goes on beyond the picture, from a look at it moved into view. */
typedef struct unseen_hits {
    grid_hit hits[OUT_OF_VIEW_MAX];
    int32_t count;
    double nearest2;
} unseen_hits;

static void collide_out_of_view(grid_job *job, grid_shift shift, unseen_hits *beyond)
{
    const grid_query *query = job->query;
    beyond->count = 0;
    beyond->nearest2 = 1e18;
    if (!(shift.length > 0.0)) {
        return;
    }
    rlf_vec3 centre = job->motion.centre;
    uint8_t side = FIELD_NONE;
    job->motion.centre = rlf_mad(centre, shift.way, shift.length);
    collide_layer(job, query->background, &side);
    job->motion.centre = centre;
    beyond->nearest2 = job->scan.nearest2;
    for (int32_t i = 0; i < job->hit_count && beyond->count < OUT_OF_VIEW_MAX; i++) {
        grid_hit hit = job->hits[i];
        hit.point = rlf_mad(hit.point, shift.way, -shift.length);
        if (grid_goes_on(query, &shift, &job->hits[i]) &&
            mapped_first_known(query, centre, hit.point) == RLF_MAP_UNKNOWN) {
            beyond->hits[beyond->count++] = hit;
        }
    }
}

static void add_out_of_view(grid_job *job, const unseen_hits *beyond)
{
    job->scan.nearest2 = rlf_min(job->scan.nearest2, beyond->nearest2);
    for (int32_t i = 0; i < beyond->count && job->hit_count < GRID_HITS_MAX; i++) {
        job->hits[job->hit_count++] = beyond->hits[i];
    }
}

/* How many substeps this body's contacts stay good: it must not travel far in that time. */
static int32_t query_period(const phys_body *body, double step, double most)
{
    double travel = (rlf_length(body->v) + rlf_length(body->w) * body->shape.radius) * step;
    double period = 0.2 * body->shape.inner_radius / rlf_max(travel, 1e-9);
    return (int32_t)rlf_clamp(period, 1.0, most);
}

static void set_period(grid_job *job, phys_body *body, double most)
{
    body->surface_period = query_period(body, job->query->step, most);
    job->window.horizon = (body->surface_period + 1) * job->query->step;
}

/* How far the body may go before it comes to what the last scan saw. */
static double clearance_of(const grid_job *job)
{
    double approaching = approach_margin_of(job->tiles);
    double gaps = job->scan.stride * job->motion.centre.z * job->query->grid->pixel_angle;
    double beside = job->body->shape.radius + GRID_MARGIN + approaching + gaps;
    return rlf_max(0.0, sqrt(job->scan.nearest2) - beside);
}

static bool prepare_view(const grid_query *query, const phys_body *body)
{
    int32_t rect[4], stride;
    double reach = reach_of(query, body, query_period(body, query->step, PERIOD_AT_REST));
    reach = rlf_max(reach, reach_of(query, body, (int32_t)PERIOD_MAX));
    reach += approach_margin_of(query->foreground);
    rlf_vec3 centre = rlf_transform(&query->T_grid_world, body->x);
    grid_shift shift = grid_out_of_view(query, centre, body->shape.radius);
    rlf_vec3 moved = rlf_mad(centre, shift.way, shift.length);
    if (shift.length > 0.0 && grid_footprint(query->grid, moved, reach, rect, &stride)) {
        grid_tiles_make(query->background, query->grid, rect);
    }
    if (!grid_footprint(query->grid, centre, reach, rect, &stride)) {
        return false;
    }
    grid_tiles_make(query->background, query->grid, rect);
    return grid_tiles_make(query->foreground, query->grid, rect);
}

bool grid_collide_prepare(const grid_query *query, const phys_body *body)
{
    bool is_near = false;
    for (const grid_query *one = query; one != NULL; one = one->next) {
        is_near = prepare_view(one, body) || is_near;
    }
    return is_near;
}

static void start_contacts(const grid_query *query, phys_body *body)
{
    body->stance.is_set = false;
    body->is_restless = false;
    body->surface_count = 0;
    body->surface_flow = rlf_vec3_make(0, 0, 0);
    body->surface_age = 0;
    body->surface_time = query->time;
    body->surface_x = body->x;
    body->surface_turned = body->turned;
    body->surface_version = 0;
}

/* Whether nothing of the foreground of the cameras from the job's on can come near the body before
 * the next query. */
static bool is_alone(grid_job *job, double period)
{
    const grid_query *query = job->query;
    bool is_free = true;
    for (const grid_query *one = query; one != NULL && is_free; one = one->next) {
        double reach = reach_of(one, job->body, (int32_t)period);
        if (one != query) {
            set_up(job, one, job->body);
        }
        is_free = grid_is_free(job, one->foreground, reach + approach_margin_of(one->foreground));
    }
    if (query->next != NULL) {
        set_up(job, query, job->body);
    }
    return is_free;
}

/* Whether a search would find what the last one found: what stays is the same, nothing else is
 * near, and the body has hardly moved. All that was within the margin is known. */
static bool is_settled(grid_job *job)
{
    const grid_query *query = job->query;
    const phys_body *body = job->body;
    double moved = rlf_length(rlf_sub(body->x, body->surface_x)) +
                   (body->turned - body->surface_turned) * body->shape.radius;
    double coming = phys_body_speed(body) * (PERIOD_AT_REST + 1.0) * query->step;
    return body->surface_version != 0 && body->surface_version == query->rest_version &&
           moved + coming < SETTLED_SHARE * GRID_MARGIN && is_alone(job, PERIOD_AT_REST);
}

static void keep_contacts(const grid_query *query, phys_body *body)
{
    body->is_restless = false;
    body->surface_age = 0;
    body->surface_time = query->time;
    body->surface_period =
        query_period(body, query->step, body->is_pressed ? PERIOD_AT_REST : PERIOD_MAX);
}

/* Whether the way from the body's centre to a place begins in free space, as far as it is known. */
static bool is_from_free(const grid_job *job, rlf_vec3 place)
{
    field_cell cell;
    const grid_query *query = job->query;
    rlf_vec3 centre = job->motion.centre;
    field_state state = grid_field_state(query->grid, query->background->sheet, centre, &cell);
    return state == FIELD_FRONT ||
           (state != FIELD_INSIDE && mapped_first_known(query, centre, place) == RLF_MAP_FREE);
}

/* What faces away from a body's centre in free space is the far side of a thin shell, or the guess
 * of one: the body lies on the outer side of all that it touches. */
static void drop_far_sides(grid_job *job)
{
    int32_t kept = 0;
    for (int32_t i = 0; i < job->hit_count; i++) {
        const grid_hit *hit = &job->hits[i];
        if (rlf_dot(hit->normal, rlf_sub(job->motion.centre, hit->point)) > 0.0 ||
            !is_from_free(job, hit->point)) {
            job->hits[kept++] = *hit;
        }
    }
    job->hit_count = kept;
}

/* Both sheets of one camera, the nearer first. */
static void collide_layers(grid_job *job, grid_shift shift, phys_body *body, int32_t body_index)
{
    const grid_query *query = job->query;
    uint8_t *side = body->side[query->grid->camera];
    set_period(job, body, PERIOD_MAX);
    collide_layer(job, query->foreground, &side[0]);
    if (query->grid->camera == 0) {
        body->surface_flow = job->scan.surface_velocity;
    }
    body->surface_clear = rlf_min(body->surface_clear, clearance_of(job));
    grid_reduce(job, body, body_index, RLF_CONTACT_FOREGROUND);
    if (!job->scan.is_near && body->is_pressed) {
        set_period(job, body, PERIOD_AT_REST);
    }
    unseen_hits beyond;
    collide_out_of_view(job, shift, &beyond);
    collide_layer(job, query->background, &side[1]);
    add_out_of_view(job, &beyond);
    grid_unseen_collide(job);
    mapped_collide(job);
    drop_far_sides(job);
    body->surface_clear = rlf_min(body->surface_clear, clearance_of(job));
    grid_reduce(job, body, body_index, RLF_CONTACT_BACKGROUND);
}

/* What one camera only guesses, a back or what lies beyond its view, is not there where another one
 * sees past its face or past the body's point in it. And a body whose centre is in the open was not
 * inside of anything: no face that it is behind of pushes it out. */
static void drop_seen_free(const grid_query *query, phys_body *body)
{
    const rlf_vec3 still = {0, 0, 0};
    const bool is_in_open = grid_is_seen_free(query, body->x, still);
    int32_t kept = 0;
    for (int32_t i = 0; i < body->surface_count; i++) {
        const phys_contact *c = &body->surface[i];
        const rlf_vec3 own = rlf_add(body->x, phys_contact_arm(c, body));
        const bool is_behind = rlf_dot(c->normal, rlf_sub(body->x, c->anchor_b)) < 0.0;
        if (!(is_in_open && is_behind) &&
            !grid_is_seen_free(query, c->anchor_b, c->surface_velocity) &&
            !grid_is_seen_free(query, own, c->surface_velocity)) {
            body->surface[kept++] = *c;
        }
    }
    body->surface_count = kept;
}

static void collide_cameras(grid_job *job, phys_body *body, int32_t body_index)
{
    const grid_query *first = job->query;
    int32_t period = INT32_MAX;
    body->surface_clear = INFINITY;
    for (const grid_query *one = first; one != NULL; one = one->next) {
        if (one != first) {
            set_up(job, one, body);
        }
        grid_shift shift = grid_out_of_view(one, job->motion.centre, body->shape.radius);
        collide_layers(job, shift, body, body_index);
        period = body->surface_period < period ? body->surface_period : period;
    }
    body->surface_period = period;
    if (first->next != NULL) {
        drop_seen_free(first, body);
        set_up(job, first, body);
    }
}

static bool are_backgrounds_still(const grid_query *query)
{
    bool are_still = true;
    for (const grid_query *one = query; one != NULL; one = one->next) {
        are_still = are_still && one->background->sheet->velocity_x == NULL;
    }
    return are_still;
}

void grid_collide(const grid_query *query, phys_body *body, int32_t body_index)
{
    double swept_from = body->surface_time;
    int32_t old_count = body->surface_count;
    phys_trace old[PHYS_SURFACE_CONTACTS];
    grid_job job;
    set_up(&job, query, body);
    if (is_settled(&job)) {
        keep_contacts(query, body);
        return;
    }
    start_contacts(query, body);
    for (int32_t i = 0; i < old_count; i++) {
        old[i] = phys_trace_of(&body->surface[i]);
    }
    job.window.asked_before = swept_from;
    collide_cameras(&job, body, body_index);
    if (are_backgrounds_still(query) && is_alone(&job, body->surface_period)) {
        body->surface_version = query->rest_version;
    }
    if (body->surface_count == 0) {
        body->surface_period++; /* all of the horizon is free */
    } else {
        body->surface_clear = 0.0;
    }
    grid_keep_impulses(body, old, old_count);
}
