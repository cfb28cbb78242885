/* Light probes: radiance by direction about bodies, and its harmonics. */
#include "render/probe.h"

#include "kernel/kernel.h"

#include <string.h>

#define FOUR_PI 12.566371f
#define LEAST_PATCHES 64    /* fewer say nothing about a room */
#define MIRRORED 0.3f       /* weight of what is seen for what is behind the camera */
#define NEAR_M2 0.3f        /* light of places so far (squared) tells how light a place is */
#define DARKEST 0.2f        /* share of the lamp that the darkest place gets */
#define DARKEST_MEAN 0.002f /* of a picture that is not black */

enum { LEVELS = 5, ALL_LEVELS = 256 + 64 + 16 + 4 + 1 };

/* Sums by direction, with those of smaller maps. */
typedef struct radiance {
    float weight[ALL_LEVELS], light[ALL_LEVELS][3];
} radiance;

static float sign_of(float x)
{
    return x < 0.0f ? -1.0f : 1.0f;
}

static float magnitude(float x)
{
    return x < 0.0f ? -x : x;
}

/* Unit direction of a cell's centre. The map's middle is towards the camera. */
static float direction_of(int32_t x, int32_t y, float out[3])
{
    const float per_cell = 2.0f / (float)PROBE_SIDE;
    float u = ((float)x + 0.5f) * per_cell - 1.0f;
    float v = ((float)y + 0.5f) * per_cell - 1.0f;
    const float w = 1.0f - magnitude(u) - magnitude(v);
    if (w < 0.0f) {
        const float folded = (1.0f - magnitude(v)) * sign_of(u);
        v = (1.0f - magnitude(u)) * sign_of(v);
        u = folded;
    }
    const float length = sqrtf(u * u + v * v + w * w);
    out[0] = u / length;
    out[1] = v / length;
    out[2] = -w / length;
    return 1.0f / (length * length * length); /* solid angle, but for a factor */
}

/* The cell of a direction of any length. */
static int32_t cell_of(float x, float y, float z)
{
    const float scale = 1.0f / (magnitude(x) + magnitude(y) + magnitude(z) + 1e-12f);
    float u = x * scale;
    float v = y * scale;
    if (z > 0.0f) {
        const float folded = (1.0f - magnitude(v)) * sign_of(u);
        v = (1.0f - magnitude(u)) * sign_of(v);
        u = folded;
    }
    const int32_t column = (int32_t)((u + 1.0f) * (0.5f * (float)PROBE_SIDE));
    const int32_t row = (int32_t)((v + 1.0f) * (0.5f * (float)PROBE_SIDE));
    return (row < PROBE_SIDE ? row : PROBE_SIDE - 1) * PROBE_SIDE +
           (column < PROBE_SIDE ? column : PROBE_SIDE - 1);
}

void probe_set_init(probe_set *set)
{
    float sum = 0.0f;
    for (int32_t i = 0; i < PROBE_SIDE * PROBE_SIDE; i++) {
        float d[3];
        set->solid[i] = direction_of(i % PROBE_SIDE, i / PROBE_SIDE, d);
        sum += set->solid[i];
        const float terms[PROBE_TERMS] = {0.282095f,
                                          0.488603f * d[0],
                                          0.488603f * d[1],
                                          0.488603f * d[2],
                                          1.092548f * d[0] * d[1],
                                          1.092548f * d[1] * d[2],
                                          1.092548f * d[2] * d[0],
                                          0.315392f * (3.0f * d[2] * d[2] - 1.0f),
                                          0.546274f * (d[0] * d[0] - d[1] * d[1])};
        memcpy(set->basis[i], terms, sizeof(terms));
    }
    for (int32_t i = 0; i < PROBE_SIDE * PROBE_SIDE; i++) {
        set->solid[i] *= FOUR_PI / sum;
    }
}

void probe_set_destroy(probe_set *set)
{
    rlf_free(set->of);
    set->of = NULL;
    set->capacity = 0;
}

/* ---- one probe ------------------------------------------------------------------------------ */

static void add(radiance *r, int32_t cell, float weight, const probe_room *room, int32_t patch)
{
    r->weight[cell] += weight;
    for (int c = 0; c < 3; c++) {
        r->light[cell][c] += weight * room->light[c][patch];
    }
}

/* Radiance by direction from a ball; a patch that is as near as the ball is wide counts as one at
 * its rim. Returns how light the lighter places around are. */
static float gather(const probe_room *room, const float center[3], float radius, radiance *r)
{
    float square = 0.0f;
    float all = 1e-6f;
    memset(r, 0, sizeof(*r));
    for (int32_t k = 0; k < room->count; k++) {
        const float x = room->p[0][k] - center[0];
        const float y = room->p[1][k] - center[1];
        const float z = room->p[2][k] - center[2];
        const float distance2 = x * x + y * y + z * z + 1e-6f;
        const float facing = -(x * room->n[0][k] + y * room->n[1][k] + z * room->n[2][k]);
        const float grey = room->light[0][k] + room->light[1][k] + room->light[2][k];
        const float from = 1.0f / (distance2 + NEAR_M2);
        const float near_by = room->area[k] * from * from;
        all += near_by * grey;
        square += near_by * grey * grey;
        if (facing > 0.0f) {
            const float angle =
                room->area[k] * facing / (sqrtf(distance2) * (distance2 + radius * radius));
            add(r, cell_of(x, y, z), angle, room, k);
            add(r, cell_of(x, y, -z), MIRRORED * angle, room, k);
        }
    }
    return square / all;
}

/* No cell counts for more than it is wide; then sums of four into one of the next level. */
static void pull(const probe_set *set, radiance *r)
{
    for (int32_t i = 0; i < PROBE_SIDE * PROBE_SIDE; i++) {
        const float most = set->solid[i];
        const float share = r->weight[i] > most ? most / r->weight[i] : 1.0f;
        r->weight[i] *= share;
        for (int c = 0; c < 3; c++) {
            r->light[i][c] *= share;
        }
    }
    int32_t from = 0;
    int32_t to = PROBE_SIDE * PROBE_SIDE;
    for (int32_t side = PROBE_SIDE / 2; side > 0; side /= 2) {
        for (int32_t i = 0; i < 4 * side * side; i++) {
            const int32_t at = to + i / (2 * side) / 2 * side + i % (2 * side) / 2;
            r->weight[at] += r->weight[from + i];
            for (int c = 0; c < 3; c++) {
                r->light[at][c] += r->light[from + i][c];
            }
        }
        from = to;
        to += side * side;
    }
}

/* Sums become radiance; what is not seen is as what is around it, and all of it as the mean. */
static void push(const float mean[3], radiance *r)
{
    int32_t above = ALL_LEVELS;
    int32_t at = ALL_LEVELS - 1;
    for (int32_t side = 1; side <= PROBE_SIDE; side *= 2) {
        const float doubt = 0.1f * FOUR_PI / (float)(side * side);
        for (int32_t i = 0; i < side * side; i++) {
            const int32_t parent = above + i / side / 2 * (side / 2) + i % side / 2;
            const float *guess = side > 1 ? r->light[parent] : mean;
            for (int c = 0; c < 3; c++) {
                r->light[at + i][c] =
                    (r->light[at + i][c] + doubt * guess[c]) / (r->weight[at + i] + doubt);
            }
        }
        above = at;
        at -= 4 * side * side;
    }
}

/* The map with what is beyond its edges: an octahedron's faces go on across them. */
static void fill_map(const radiance *r, light_probe *out)
{
    for (int32_t i = 0; i < PROBE_CELLS; i++) {
        int32_t x = i % PROBE_ROW - 1;
        int32_t y = i / PROBE_ROW - 1;
        if (x < 0 || x >= PROBE_SIDE) {
            x = x < 0 ? 0 : PROBE_SIDE - 1;
            y = PROBE_SIDE - 1 - y;
        }
        if (y < 0 || y >= PROBE_SIDE) {
            y = y < 0 ? 0 : PROBE_SIDE - 1;
            x = PROBE_SIDE - 1 - x;
        }
        memcpy(out->map[i], r->light[y * PROBE_SIDE + x], sizeof(out->map[i]));
    }
}

/* Harmonics' coefficients, each band by its share, as a polynomial of the direction. */
static void fold(float coefficients[PROBE_TERMS][3], const float band[3], const float scale[3],
                 float out[PROBE_TERMS][3])
{
    static const float factor[PROBE_TERMS] = {0.282095f, 0.488603f, 0.488603f, 0.488603f, 1.092548f,
                                              1.092548f, 1.092548f, 0.946176f, 0.546274f};
    for (int i = 0; i < PROBE_TERMS; i++) {
        const float share = band[i == 0 ? 0 : (i < 4 ? 1 : 2)] * factor[i];
        for (int c = 0; c < 3; c++) {
            out[i][c] = coefficients[i][c] * share * scale[c];
        }
    }
    for (int c = 0; c < 3; c++) {
        out[0][c] -= 0.315392f * band[2] * coefficients[7][c] * scale[c];
    }
}

/* A rough surface mirrors the sky with a lobe, whose bands these are. */
static void find_harmonics(const probe_set *set, const radiance *r, const float scale[3],
                           light_probe *out)
{
    static const float white[3] = {1.0f, 2.0f / 3.0f, 0.25f};
    static const float lobe[3] = {1.0f, 0.8f, 0.5f};
    static const float one[3] = {1.0f, 1.0f, 1.0f};
    float coefficients[PROBE_TERMS][3] = {{0.0f}};
    for (int32_t i = 0; i < PROBE_SIDE * PROBE_SIDE; i++) {
        for (int k = 0; k < PROBE_TERMS; k++) {
            for (int c = 0; c < 3; c++) {
                coefficients[k][c] += set->solid[i] * set->basis[i][k] * r->light[i][c];
            }
        }
    }
    fold(coefficients, white, scale, out->around);
    fold(coefficients, lobe, one, out->rough);
}

static void make(const probe_set *set, const float lamp[3], float radius, light_probe *out)
{
    radiance r;
    float scale[3];
    const float bright = gather(&set->room, out->center, radius, &r);
    float here = set->room.bright > 0.0f ? bright / set->room.bright : 1.0f;
    here = here < DARKEST ? DARKEST : (here > 1.0f ? 1.0f : here);
    pull(set, &r);
    push(set->room.mean, &r);
    for (int c = 0; c < 3; c++) {
        const float mean = set->room.mean[c];
        scale[c] = (float)PROBE_AMBIENT * lamp[c] / (mean > DARKEST_MEAN ? mean : DARKEST_MEAN);
        out->direct[c] = (float)PROBE_DIRECT * lamp[c] * here;
    }
    find_harmonics(set, &r, scale, out);
    fill_map(&r, out);
}

/* The same light from everywhere. */
static void make_even(const float lamp[3], light_probe *out)
{
    memset(out->around, 0, sizeof(out->around));
    memset(out->rough, 0, sizeof(out->rough));
    for (int c = 0; c < 3; c++) {
        out->around[0][c] = out->rough[0][c] = (float)PROBE_AMBIENT * lamp[c];
        out->direct[c] = (float)PROBE_DIRECT * lamp[c];
    }
    for (int32_t i = 0; i < PROBE_CELLS; i++) {
        memcpy(out->map[i], out->around[0], sizeof(out->map[i]));
    }
}

/* ---- all of a picture ----------------------------------------------------------------------- */

static rlf_result reserve(probe_set *set, int32_t count)
{
    if (count <= set->capacity) {
        return RLF_OK;
    }
    rlf_free(set->of);
    set->of = rlf_alloc((size_t)count * 2);
    set->capacity = set->of != NULL ? 2 * count : 0;
    return set->of != NULL ? RLF_OK : RLF_ERROR_MEMORY;
}

static rlf_vec3 place_of(const probe_def *def, const rlf_snapshot *snapshot, int32_t i)
{
    return rlf_transform(&def->T_picture_world, snapshot->bodies[i].T_world_body.p);
}

/* The nearest bodies to the camera, in order. */
static int32_t choose(const probe_def *def, const rlf_snapshot *snapshot, int32_t out[PROBE_OWN])
{
    double depth[PROBE_OWN];
    int32_t count = 0;
    for (int32_t i = 0; i < snapshot->body_count; i++) {
        const rlf_vec3 p = place_of(def, snapshot, i);
        if (!rlf_vec3_is_finite(p) || !(p.z > 0.0)) {
            continue;
        }
        int32_t at = count < PROBE_OWN ? count++ : PROBE_OWN;
        for (; at > 0 && p.z < depth[at - 1]; at--) {
            if (at < PROBE_OWN) {
                depth[at] = depth[at - 1];
                out[at] = out[at - 1];
            }
        }
        if (at < PROBE_OWN) {
            depth[at] = p.z;
            out[at] = i;
        }
    }
    return count;
}

/* The probe that is nearest to a body. */
static uint8_t nearest(const probe_set *set, rlf_vec3 p)
{
    int32_t best = 0;
    double least = 1e30;
    for (int32_t k = 0; k < set->count; k++) {
        const float *c = set->probes[k].center;
        const rlf_vec3 step = {p.x - (double)c[0], p.y - (double)c[1], p.z - (double)c[2]};
        const double away = rlf_dot(step, step);
        best = away < least ? k : best;
        least = away < least ? away : least;
    }
    return (uint8_t)best;
}

typedef struct probe_job {
    probe_set *set;
    float lamp[3], radius[PROBE_OWN];
    bool is_on;
} probe_job;

static void make_probes(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const probe_job *job = context;
    (void)worker;
    for (int32_t k = begin; k < end; k++) {
        if (job->is_on) {
            make(job->set, job->lamp, job->radius[k], &job->set->probes[k]);
        } else {
            make_even(job->lamp, &job->set->probes[k]);
        }
    }
}

rlf_result probe_set_update(probe_set *set, const probe_def *def, const rlf_frame *frame,
                            const rlf_surface *surface, const rlf_snapshot *snapshot)
{
    int32_t own[PROBE_OWN] = {0};
    const rlf_result result = reserve(set, snapshot->body_count);
    if (result != RLF_OK) {
        return result;
    }
    probe_job job = {.set = set};
    if (def->is_on) {
        probe_room_read(&set->room, def->rig, frame, surface, &def->T_picture_depth);
    }
    const int32_t chosen = choose(def, snapshot, own);
    job.is_on = def->is_on && set->room.count >= LEAST_PATCHES && chosen > 0;
    for (int c = 0; c < 3; c++) {
        job.lamp[c] = def->lamp[c] * def->lamp[c];
    }
    set->count = job.is_on ? chosen : 1;
    for (int32_t k = 0; k < set->count; k++) {
        const rlf_vec3 p = place_of(def, snapshot, own[k]);
        const double radius = rlf_shape_radius(&snapshot->bodies[own[k]].shape);
        set->probes[k].center[0] = (float)p.x;
        set->probes[k].center[1] = (float)p.y;
        set->probes[k].center[2] = (float)p.z;
        job.radius[k] = (float)(rlf_is_finite(radius) ? radius : 1.0);
    }
    rlf_parallel_for(def->pool, set->count, 1, make_probes, &job);
    for (int32_t i = 0; i < snapshot->body_count; i++) {
        set->of[i] = nearest(set, place_of(def, snapshot, i));
    }
    return RLF_OK;
}
