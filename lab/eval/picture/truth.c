/* Truth at the colour camera: which share of every pixel of a body real things leave visible. */
#include "eval/picture/truth.h"

#include "relief/synthetic.h"

#include <string.h>

#define TRIES 4000
#define PROBES 12 /* rays across a body */
#define TILE 16
#define CHANNELS (PICTURE_SAMPLES + 1)
#define BAND 9
#define CLOSE 3
#define INNER 8

/* ---- bodies --------------------------------------------------------------------------------- */

static double next_random(uint64_t *state, double low, double high)
{
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * (double)(*state >> 33) / 2147483648.0;
}

rlf_body_state picture_random_body(uint64_t *random)
{
    rlf_body_state body = {.mass = 1.0, .is_held = true};
    double z = next_random(random, 1.1, 3.3);
    body.T_world_body.p =
        rlf_vec3_make(z * next_random(random, -0.6, 0.6), z * next_random(random, -0.42, 0.42), z);
    rlf_vec3 turn;
    turn.x = next_random(random, -1.5, 1.5);
    turn.y = next_random(random, -1.5, 1.5);
    turn.z = next_random(random, -1.5, 1.5);
    body.T_world_body.q = rlf_quat_from_rotation_vector(turn);
    double size = next_random(random, 0.2, 0.4);
    body.shape = (rlf_shape){.type = RLF_SHAPE_BOX, .size = {size, size, size}};
    if (next_random(random, 0.0, 1.0) < 0.25) {
        body.shape = (rlf_shape){.type = RLF_SHAPE_SPHERE, .radius = 0.5 * size};
    }
    body.color[0] = (float)next_random(random, 0.3, 1.0);
    body.color[1] = (float)next_random(random, 0.3, 1.0);
    body.color[2] = (float)next_random(random, 0.3, 1.0);
    return body;
}

rlf_result picture_is_free(rlf_source *source, const rlf_body_state *bodies, int32_t count,
                           const rlf_body_state *body, bool *out)
{
    double radius = rlf_shape_radius(&body->shape);
    double distance = 0.0;
    rlf_result result = rlf_synthetic_distance(source, body->T_world_body.p, &distance, NULL, NULL);
    *out = distance > radius + 0.03;
    for (int32_t k = 0; k < count && *out; k++) {
        rlf_vec3 step = rlf_sub(bodies[k].T_world_body.p, body->T_world_body.p);
        *out = rlf_length(step) > radius + rlf_shape_radius(&bodies[k].shape);
    }
    return result;
}

/* True when something real hides a tenth of the body at least, and shows a tenth. */
static rlf_result is_partly_hidden(rlf_source *source, const rlf_body_state *body, bool *out)
{
    const double reach = rlf_shape_radius(&body->shape);
    rlf_vec3 origin = rlf_neg(rlf_source_get_info(source)->rig.T_color_depth.p);
    rlf_vec3 to_body = rlf_sub(body->T_world_body.p, origin);
    rlf_vec3 rays[PROBES * PROBES];
    double enter[PROBES * PROBES];
    float z[PROBES * PROBES];
    int32_t count = 0;
    for (int32_t k = 0; k < PROBES * PROBES; k++) {
        rlf_vec3 at = to_body;
        at.x += reach * (2.0 * (k % PROBES) / (PROBES - 1) - 1.0);
        at.y += reach * (2.0 * (k / PROBES) / (PROBES - 1) - 1.0);
        rays[count] = rlf_scale(at, 1.0 / at.z);
        enter[count] = picture_enter_body(body, origin, rays[count]);
        count += enter[count] > 0.0;
    }
    rlf_result result = rlf_synthetic_cast(source, origin, rays, count, z, NULL);
    int32_t hidden = 0;
    for (int32_t k = 0; k < count; k++) {
        hidden += z[k] > 0.0f && z[k] < enter[k];
    }
    *out = 10 * hidden >= count && 10 * hidden <= 9 * count;
    return result;
}

rlf_result picture_place_bodies(uint64_t seed, rlf_source *source,
                                rlf_body_state bodies[PICTURE_BODIES], int32_t *out_count)
{
    uint64_t random = seed * 977 + 5;
    int32_t count = 0;
    for (int i = 0; i < TRIES && count < PICTURE_BODIES; i++) {
        rlf_body_state body = picture_random_body(&random);
        bool is_free = false;
        bool is_hidden = false;
        rlf_result result = picture_is_free(source, bodies, count, &body, &is_free);
        if (result == RLF_OK && is_free) {
            result = is_partly_hidden(source, &body, &is_hidden);
        }
        if (result != RLF_OK) {
            return result;
        }
        if (is_free && (is_hidden || count % 2 == 0)) {
            bodies[count++] = body;
        }
    }
    *out_count = count;
    return RLF_OK;
}

double picture_enter_body(const rlf_body_state *body, rlf_vec3 origin, rlf_vec3 d)
{
    rlf_vec3 o = rlf_transform_inverse(&body->T_world_body, origin);
    rlf_vec3 v = rlf_rotate(rlf_quat_conjugate(body->T_world_body.q), d);
    if (body->shape.type == RLF_SHAPE_SPHERE) {
        double a = rlf_dot(v, v);
        double b = rlf_dot(o, v);
        double root = b * b - a * (rlf_dot(o, o) - body->shape.radius * body->shape.radius);
        return root > 0.0 ? (-b - sqrt(root)) / a : 0.0;
    }
    const double start[3] = {o.x, o.y, o.z};
    const double step[3] = {v.x, v.y, v.z};
    const double half = 0.5 * body->shape.size.x;
    double enter = 0.0;
    double leave = 1e9;
    for (int i = 0; i < 3; i++) {
        double p = (-half - start[i]) / step[i];
        double q = (half - start[i]) / step[i];
        enter = rlf_max(enter, rlf_min(p, q));
        leave = rlf_min(leave, rlf_max(p, q));
    }
    return enter < leave ? enter : 0.0;
}

rlf_vec3 picture_normal_of_body(const rlf_body_state *body, rlf_vec3 p)
{
    rlf_vec3 v = rlf_transform_inverse(&body->T_world_body, p);
    if (body->shape.type == RLF_SHAPE_SPHERE) {
        return rlf_rotate(body->T_world_body.q, rlf_normalize(v));
    }
    double x = v.x * v.x;
    double y = v.y * v.y;
    double z = v.z * v.z;
    rlf_vec3 face = {x >= y && x >= z ? v.x : 0.0, y > x && y >= z ? v.y : 0.0,
                     z > x && z > y ? v.z : 0.0};
    return rlf_rotate(body->T_world_body.q, rlf_normalize(face));
}

/* ---- samples -------------------------------------------------------------------------------- */

static rlf_vec3 sample_ray(const picture_truth *t, int32_t pixel, int32_t sample)
{
    double u = pixel % t->camera.width;
    double v = pixel / t->camera.width;
    if (sample < PICTURE_SAMPLES) {
        /* In 16 different columns and rows: on a grid of four an upright edge has five places. */
        u += (sample % 4 + 0.25 * (sample / 4) + 0.125) * 0.25 - 0.5;
        v += (sample / 4 + 0.25 * (sample % 4) + 0.125) * 0.25 - 0.5;
    }
    return rlf_vec3_make((u - t->camera.cx) / t->camera.fx, (v - t->camera.cy) / t->camera.fy, 1.0);
}

static void cast_bodies(picture_truth *t, const rlf_body_state *bodies, int32_t count)
{
    int32_t all = t->camera.width * t->camera.height;
    for (int32_t b = 0; b < count; b++) {
        const rlf_body_state *body = &bodies[b];
        rlf_vec3 c = rlf_sub(body->T_world_body.p, t->origin);
        double radius = rlf_shape_radius(&body->shape);
        for (int32_t i = 0; i < all; i++) {
            rlf_vec3 d = sample_ray(t, i, PICTURE_SAMPLES);
            rlf_vec3 aside = rlf_mad(c, d, -rlf_dot(c, d) / rlf_dot(d, d));
            for (int32_t k = 0; rlf_length(aside) < radius + 0.01 && k < CHANNELS; k++) {
                float z = (float)picture_enter_body(body, t->origin, sample_ray(t, i, k));
                float *at = &t->body_z[(size_t)i * CHANNELS + (size_t)k];
                *at = z > 0.0f && (!(*at > 0.0f) || z < *at) ? z : *at;
            }
        }
    }
}

static void list_pixels(picture_truth *t)
{
    for (int32_t i = 0; i < t->camera.width * t->camera.height; i++) {
        bool is_whole = true;
        for (int32_t k = 0; k < CHANNELS; k++) {
            is_whole = is_whole && t->body_z[(size_t)i * CHANNELS + (size_t)k] > 0.0f;
        }
        t->alpha[i] = is_whole ? 1.0f : -1.0f;
        if (is_whole) {
            t->pixels[t->count++] = i;
        }
    }
}

/* Sets out to 1 within `reach` pixels of one marked in `in`. */
static void dilate(const picture_truth *t, const uint8_t *in, int32_t reach, uint8_t *out)
{
    int32_t width = t->camera.width;
    int32_t height = t->camera.height;
    memset(out, 0, (size_t)width * (size_t)height);
    for (int32_t i = 0; i < width * height; i++) {
        for (int32_t y = i / width - reach; in[i] && y <= i / width + reach; y++) {
            int32_t x0 = i % width - reach > 0 ? i % width - reach : 0;
            int32_t x1 = i % width + reach < width - 1 ? i % width + reach : width - 1;
            if (y >= 0 && y < height) {
                memset(out + (size_t)y * (size_t)width + (size_t)x0, 1, (size_t)(x1 - x0 + 1));
            }
        }
    }
}

rlf_result picture_truth_init(picture_truth *t, const rlf_rig *rig, const rlf_body_state *bodies,
                              int32_t body_count)
{
    *t = (picture_truth){.camera = rig->color, .origin = rlf_neg(rig->T_color_depth.p)};
    size_t all = (size_t)t->camera.width * (size_t)t->camera.height;
    t->pixels = rlf_alloc_array(all, sizeof(*t->pixels));
    t->body_z = rlf_alloc_array(all * CHANNELS, sizeof(*t->body_z));
    t->alpha = rlf_alloc_array(all, sizeof(*t->alpha));
    t->gap = rlf_alloc_array(all, sizeof(*t->gap));
    uint8_t **masks[4] = {&t->label, &t->band, &t->close, &t->inner};
    bool has_all = t->pixels != NULL && t->body_z != NULL && t->alpha != NULL && t->gap != NULL;
    for (int i = 0; i < 4; i++) {
        *masks[i] = rlf_alloc(all);
        has_all = has_all && *masks[i] != NULL;
    }
    if (!has_all) {
        return RLF_ERROR_MEMORY;
    }
    cast_bodies(t, bodies, body_count);
    list_pixels(t);
    for (size_t i = 0; i < all; i++) {
        t->band[i] = t->alpha[i] < 0.0f;
    }
    dilate(t, t->band, INNER, t->inner);
    for (size_t i = 0; i < all; i++) {
        t->inner[i] = !t->inner[i];
    }
    return RLF_OK;
}

void picture_truth_finish(picture_truth *t)
{
    void *parts[8] = {t->pixels, t->body_z, t->alpha, t->gap,
                      t->label,  t->band,   t->close, t->inner};
    for (int i = 0; i < 8; i++) {
        rlf_free(parts[i]);
    }
    *t = (picture_truth){.count = 0};
}

/* The middle of every measured pixel of one tile. */
static rlf_result cast_tile(picture_truth *t, rlf_source *source, int32_t x0, int32_t y0)
{
    rlf_vec3 rays[TILE * TILE];
    int32_t pixels[TILE * TILE];
    float z[TILE * TILE];
    int32_t labels[TILE * TILE];
    int32_t count = 0;
    for (int32_t y = y0; y < y0 + TILE && y < t->camera.height; y++) {
        for (int32_t x = x0; x < x0 + TILE && x < t->camera.width; x++) {
            int32_t i = y * t->camera.width + x;
            if (t->alpha[i] >= 0.0f) {
                rays[count] = sample_ray(t, i, PICTURE_SAMPLES);
                pixels[count++] = i;
            }
        }
    }
    if (count == 0) {
        return RLF_OK;
    }
    rlf_result result = rlf_synthetic_cast(source, t->origin, rays, count, z, labels);
    for (int32_t k = 0; k < count; k++) {
        int32_t i = pixels[k];
        t->gap[i] = t->body_z[(size_t)i * CHANNELS + PICTURE_SAMPLES] - z[k];
        t->label[i] = (uint8_t)labels[k];
        t->alpha[i] = t->gap[i] < 0.0f ? 1.0f : 0.0f;
    }
    return result;
}

/* True when a measured pixel around shows what this one hides, or the other way round. */
static bool is_at_edge(const picture_truth *t, int32_t i)
{
    int32_t width = t->camera.width;
    for (int32_t k = 0; k < 9; k++) {
        int32_t x = i % width + k % 3 - 1;
        int32_t y = i / width + k / 3 - 1;
        bool is_inside = x >= 0 && x < width && y >= 0 && y < t->camera.height;
        int32_t j = y * width + x;
        if (is_inside && t->alpha[j] >= 0.0f && (t->gap[j] < 0.0f) != (t->gap[i] < 0.0f)) {
            return true;
        }
    }
    return false;
}

static rlf_result supersample(picture_truth *t, rlf_source *source, int32_t i)
{
    rlf_vec3 rays[PICTURE_SAMPLES];
    float z[PICTURE_SAMPLES];
    for (int32_t k = 0; k < PICTURE_SAMPLES; k++) {
        rays[k] = sample_ray(t, i, k);
    }
    rlf_result result = rlf_synthetic_cast(source, t->origin, rays, PICTURE_SAMPLES, z, NULL);
    int32_t shown = 0;
    for (int32_t k = 0; k < PICTURE_SAMPLES; k++) {
        shown += t->body_z[(size_t)i * CHANNELS + (size_t)k] < z[k];
    }
    t->alpha[i] = (float)shown / PICTURE_SAMPLES;
    return result;
}

rlf_result picture_truth_update(picture_truth *t, rlf_source *source)
{
    rlf_result result = RLF_OK;
    for (int32_t y = 0; y < t->camera.height; y += TILE) {
        for (int32_t x = 0; x < t->camera.width && result == RLF_OK; x += TILE) {
            result = cast_tile(t, source, x, y);
        }
    }
    uint8_t *edge = t->close;
    memset(edge, 0, (size_t)t->camera.width * (size_t)t->camera.height);
    for (int32_t k = 0; k < t->count && result == RLF_OK; k++) {
        if (is_at_edge(t, t->pixels[k])) {
            edge[t->pixels[k]] = 1;
        }
    }
    for (int32_t k = 0; k < t->count && result == RLF_OK; k++) {
        if (edge[t->pixels[k]]) {
            result = supersample(t, source, t->pixels[k]);
        }
    }
    uint8_t *seeds = t->band; /* dilated twice, so it is kept aside in between */
    dilate(t, edge, CLOSE, seeds);
    memcpy(t->close, seeds, (size_t)t->camera.width * (size_t)t->camera.height);
    dilate(t, t->close, BAND - CLOSE, t->band);
    return result;
}
