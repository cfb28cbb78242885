/* LIFT and SWIPE, without restitution: a surface that rises under a resting body, or comes through
 * one. A new one is seen 30 times a second: Relief takes its grid, the others its mesh. */
#include "eval/physics/sheet.h"
#include "peer.h"

#define FRAME_S (2.0 * PEER_STEP)
#define HALF 0.05 /* m, of the bodies */
#define PLATE_Y 0.8
#define RISE 0.3
#define ON 0.03 /* m off the plate at most */
#define SPEED_ERROR 0.1

static const double SPEEDS[PEER_SPEEDS] = {0.25, 0.5, 1.0, 2.0};
static const rlf_vec3 FLOOR_NORMAL = {0, -1, 0}, WALL_NORMAL = {0, 0, -1};

typedef struct stage {
    const peer *p;
    void *engine;
    eval_sheet *sheet;
    peer_mesher *mesher;
} stage;

static bool open_stage(stage *s, bool is_ball, rlf_vec3 position)
{
    peer_body body = {.half = {HALF, HALF, HALF}, .mass = 0.1, .friction = 0.5};
    body.radius = is_ball ? HALF : 0.0;
    body.pose = rlf_pose_identity();
    body.pose.p = position;
    s->engine = s->p->open(rlf_vec3_make(0, 9.81, 0), 1);
    if (s->engine == NULL || !s->p->add(s->engine, &body)) {
        return false;
    }
    if (s->p->set_mesh != NULL) {
        const rlf_grid *grid = &s->sheet->grid;
        peer_mesh mesh = peer_mesh_of(s->mesher, grid, &grid->background);
        return s->p->set_mesh(s->engine, 0, &mesh);
    }
    return true;
}

static void close_stage(stage *s)
{
    if (s->engine != NULL) {
        s->p->close(s->engine);
    }
    s->engine = NULL;
}

/* Shows the slab, lets a frame pass, and tells what the body does. */
static peer_state advance(const stage *s, const eval_slab *slab)
{
    const rlf_grid *grid = &s->sheet->grid;
    eval_sheet_set_slab(s->sheet, slab);
    if (s->p->set_mesh != NULL) {
        peer_mesh mesh = peer_mesh_of(s->mesher, grid, &grid->foreground);
        s->p->set_mesh(s->engine, 1, &mesh);
    }
    s->p->step(s->engine, PEER_STEP, grid);
    s->p->step(s->engine, PEER_STEP, grid);
    return s->p->state(s->engine, 0);
}

static eval_slab plate(double y, double rising)
{
    eval_slab slab = {.wall = {FLOOR_NORMAL, -y},
                      .centre = {0, y, 2},
                      .half = {0.2, 0, 0.2},
                      .thickness = 0.05,
                      .velocity = {0, -rising, 0}};
    return slab;
}

/* It rests, is lifted, and the plate stops: the body leaves at the plate's speed, and a second
 * later lies on it again. */
static bool lifts(stage *s, bool is_ball, double speed)
{
    double y = PLATE_Y;
    bool is_good = open_stage(s, is_ball, rlf_vec3_make(0.01, y - HALF, 2.01));
    eval_slab slab = plate(y, 0.0);
    for (int32_t k = 0; k < 20 && is_good; k++) {
        advance(s, &slab);
    }
    double leaving = 0.0, gap = 1.0;
    for (int32_t k = 0; k < (int32_t)(RISE / (speed * FRAME_S) + 0.5) && is_good; k++) {
        y -= speed * FRAME_S;
        slab = plate(y, speed);
        leaving = -advance(s, &slab).v.y;
    }
    slab = plate(y, 0.0);
    for (int32_t k = 0; k < 30 && is_good; k++) {
        gap = y - HALF - advance(s, &slab).pose.p.y;
    }
    close_stage(s);
    double error = leaving / speed - 1.0;
    return is_good && gap > -ON && gap < ON && error < SPEED_ERROR && error > -SPEED_ERROR;
}

/* A board whose front is seen comes through what lies on the floor: the body never gets behind it
 * and is moved by 10 cm at least. */
static bool sweeps(stage *s, bool is_ball, double speed)
{
    const double BEGIN = 3.6, END = 2.8, PLACE = 3.2;
    bool is_good = open_stage(s, is_ball, rlf_vec3_make(0.01, 1.2 - HALF, PLACE));
    double z = BEGIN, ahead = 1.0, moved = 0.0;
    while (z > END && is_good) {
        z -= speed * FRAME_S;
        const eval_slab slab = {
            {WALL_NORMAL, -z}, {0, 1.1, z}, {0.3, 0.12, 0}, 0.04, {0, 0, -speed}};
        double place = advance(s, &slab).pose.p.z;
        ahead = rlf_min(ahead, z - place);
        moved = PLACE - place;
    }
    close_stage(s);
    return is_good && ahead > 0.0 && moved > 0.1;
}

bool peer_push(const peer *p, int32_t *out_lifted, int32_t *out_swept)
{
    const eval_wall floor = {FLOOR_NORMAL, -1.2};
    eval_sheet sheet;
    peer_mesher mesher = {NULL, NULL};
    *out_lifted = *out_swept = 0;
    if (eval_sheet_open(&sheet) != RLF_OK) {
        return false;
    }
    bool is_good = peer_mesher_open(&mesher, &sheet.grid);
    stage s = {p, NULL, &sheet, &mesher};
    eval_sheet_set_room(&sheet, &floor, 1);
    for (int32_t i = 0; i < 2 * PEER_SPEEDS && is_good; i++) {
        bool is_ball = i >= PEER_SPEEDS;
        *out_lifted += lifts(&s, is_ball, SPEEDS[i % PEER_SPEEDS]);
        *out_swept += sweeps(&s, is_ball, SPEEDS[i % PEER_SPEEDS]);
    }
    peer_mesher_close(&mesher);
    eval_sheet_close(&sheet);
    return is_good;
}
