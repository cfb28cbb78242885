/* What is beside a model's silhouette, and how much of a pixel it covers. */
#include "known/layer.h"

#include <string.h>

#define LEGS 8 /* times the reach: as much of a model may come between a rim and what is behind */
#define SAMPLES 4 /* across and down a pixel that a silhouette cuts */

void *known_reserve(void *array, int32_t count, int32_t more, int32_t *capacity, size_t size)
{
    if (count + more <= *capacity && array != NULL) {
        return array;
    }
    int32_t grown = 2 * (count + more);
    void *fresh = rlf_alloc_array((size_t)grown, size);
    if (fresh != NULL) {
        if (count > 0) {
            memcpy(fresh, array, (size_t)count * size);
        }
        rlf_free(array);
        *capacity = grown;
    }
    return fresh;
}

static bool reserve_rims(known_layer *l, int32_t more)
{
    void *fresh = known_reserve(l->rims, l->rim_count, more, &l->rim_capacity, sizeof(*l->rims));
    l->rims = fresh != NULL ? fresh : l->rims;
    return fresh != NULL;
}

static bool reserve_edges(known_layer *l, int32_t more)
{
    void *fresh =
        known_reserve(l->edges, l->edge_count, more, &l->edge_capacity, sizeof(*l->edges));
    l->edges = fresh != NULL ? fresh : l->edges;
    return fresh != NULL;
}

/* Nearest covered pixel within reach; false when there is none. */
static bool nearest_covered(const known_layer *layer, int32_t x, int32_t y, int32_t out[2])
{
    int32_t best = layer->reach * layer->reach + 1;
    int32_t w = layer->camera.width, h = layer->camera.height;
    for (int32_t dy = -layer->reach; dy <= layer->reach; dy++) {
        for (int32_t dx = -layer->reach; dx <= layer->reach; dx++) {
            int32_t d2 = dx * dx + dy * dy;
            if (d2 < best && x + dx >= 0 && y + dy >= 0 && x + dx < w && y + dy < h &&
                layer->at[(y + dy) * w + x + dx] != 0) {
                best = d2;
                out[0] = dx;
                out[1] = dy;
            }
        }
    }
    return best <= layer->reach * layer->reach;
}

/* A pixel next to (x, y), or itself, whose middle the model does not cover, or covers: -1 when
 * there is none. The nearest ones come first. */
static int32_t find_beside(const known_layer *layer, int32_t x, int32_t y, bool is_covered)
{
    static const int8_t steps[9][2] = {{0, 0},   {-1, 0}, {1, 0},  {0, -1}, {0, 1},
                                       {-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
    for (int i = 0; i < 9; i++) {
        int32_t u = x + steps[i][0], v = y + steps[i][1];
        bool is_inside = u >= 0 && v >= 0 && u < layer->camera.width && v < layer->camera.height;
        if (is_inside && (layer->at[v * layer->camera.width + u] != 0) == is_covered) {
            return v * layer->camera.width + u;
        }
    }
    return -1;
}

/* The covered pixel next to (x, y), which may be that itself, and the way out from there. */
typedef struct way_out {
    int32_t x, y, step[2];
    double distance; /* of (x, y), pixels */
} way_out;

/* False far from the silhouette. */
static bool find_way_out(const known_layer *layer, int32_t x, int32_t y, way_out *out)
{
    const int32_t w = layer->camera.width;
    *out = (way_out){.x = x, .y = y};
    if (layer->at[y * w + x] != 0) {
        int32_t outside = find_beside(layer, x, y, false);
        out->step[0] = outside % w - x;
        out->step[1] = outside / w - y;
        return outside >= 0;
    }
    int32_t d[2] = {0, 0};
    if (!nearest_covered(layer, x, y, d)) {
        return false;
    }
    *out = (way_out){x + d[0], y + d[1], {-d[0], -d[1]}, sqrt((double)(d[0] * d[0] + d[1] * d[1]))};
    return true;
}

/* The first pixel from `distance` on that has the model nowhere within reach: another leg of it may
 * come in between. -1 when there is none near. */
static int32_t find_beyond(const known_layer *layer, const way_out *way, int32_t distance,
                           int32_t *out_distance)
{
    const double sx = way->step[0], sy = way->step[1], unit = 1.0 / sqrt(sx * sx + sy * sy);
    const int32_t w = layer->camera.width, h = layer->camera.height;
    for (int32_t k = distance; k <= distance + LEGS * layer->reach; k++) {
        int32_t x = (int32_t)rlf_clamp(way->x + sx * unit * k + 0.5, 0, w - 1);
        int32_t y = (int32_t)rlf_clamp(way->y + sy * unit * k + 0.5, 0, h - 1);
        int32_t d[2];
        if (layer->at[y * w + x] == 0 && !nearest_covered(layer, x, y, d)) {
            *out_distance = k;
            return y * w + x;
        }
    }
    return -1;
}

/* In an inner corner the way out leads along another edge: then the shortest way of all. */
static int32_t find_shortest(const known_layer *layer, const way_out *way, int32_t distance)
{
    int32_t best = -1;
    int32_t shortest = INT32_MAX;
    for (int32_t i = 0; i < 9; i++) {
        const way_out other = {way->x, way->y, {i % 3 - 1, i / 3 - 1}, way->distance};
        int32_t at = 0;
        int32_t beyond = i != 4 ? find_beyond(layer, &other, distance, &at) : -1;
        if (beyond >= 0 && at < shortest) {
            shortest = at;
            best = beyond;
        }
    }
    return best;
}

/* Where to look for what is behind a rim. */
static void find_behind(const known_layer *layer, const way_out *way, known_rim *rim)
{
    const int32_t out = layer->reach + 2;
    int32_t near_at = out, far_at = 2 * out;
    rim->beyond = find_beyond(layer, way, out, &near_at);
    if (rim->beyond < 0) {
        near_at = far_at = INT32_MAX;
        rim->beyond = find_shortest(layer, way, out);
    }
    rim->farther = near_at == out ? find_beyond(layer, way, near_at + out, &far_at) : -1;
    if (rim->beyond < 0) {
        rim->beyond = rim->pixel.index; /* nowhere: then it is no mixture */
    }
    /* Not from farther away, where what is behind may be something else. */
    bool is_plane = near_at == out && far_at == 2 * out && rim->farther >= 0;
    rim->farther = is_plane ? rim->farther : rim->beyond;
    rim->steps = (float)((out - way->distance) / out);
}

/* The pixels around a model and its own last ones, each with the depths of the covered pixel next
 * to it, and two pixels farther out, where sensors no longer show the model. */
bool known_add_rims(known_layer *layer, pixel_rect r)
{
    const rlf_camera *camera = &layer->camera;
    int32_t w = camera->width, h = camera->height, reach = layer->reach;
    for (int32_t y = r.y0 > reach ? r.y0 - reach : 0; y < r.y1 + reach && y < h; y++) {
        if (!reserve_rims(layer, w)) {
            return false;
        }
        for (int32_t x = r.x0 > reach ? r.x0 - reach : 0; x < r.x1 + reach && x < w; x++) {
            way_out way;
            rlf_vec3 ray;
            if (!find_way_out(layer, x, y, &way) || !rlf_camera_unproject(camera, x, y, &ray)) {
                continue;
            }
            known_rim *rim = &layer->rims[layer->rim_count++];
            rim->pixel = layer->pixels[layer->at[way.y * w + way.x] - 1];
            rim->pixel.index = y * w + x;
            rim->pixel.ray_x = (float)ray.x;
            rim->pixel.ray_y = (float)ray.y;
            find_behind(layer, &way, rim);
        }
    }
    return true;
}

/* Share of a pixel that a model covers, 0..255. */
static uint8_t share_of(const known_layer *layer, const known_form *form, int32_t x, int32_t y)
{
    int32_t hits = 0;
    for (int32_t k = 0; k < SAMPLES * SAMPLES; k++) {
        double u = x + (k % SAMPLES + 0.5) / SAMPLES - 0.5;
        double v = y + (k / SAMPLES + 0.5) / SAMPLES - 0.5;
        rlf_vec3 ray;
        double z[2];
        hits += known_form_cast(form, &layer->camera, u, v, &ray, z) ? 1 : 0;
    }
    return (uint8_t)(255 * hits / (SAMPLES * SAMPLES));
}

/* The pixels that a model's silhouette cuts. */
bool known_add_edges(known_layer *layer, const known_form *form, pixel_rect r)
{
    const rlf_camera *camera = &layer->camera;
    pixel_rect wide = {r.x0 > 0 ? r.x0 - 1 : 0, r.y0 > 0 ? r.y0 - 1 : 0,
                       r.x1 < camera->width ? r.x1 + 1 : r.x1,
                       r.y1 < camera->height ? r.y1 + 1 : r.y1};
    for (int32_t y = wide.y0; y < wide.y1; y++) {
        if (!reserve_edges(layer, camera->width)) {
            return false;
        }
        for (int32_t x = wide.x0; x < wide.x1; x++) {
            int32_t covered = find_beside(layer, x, y, true);
            int32_t outside = find_beside(layer, x, y, false);
            if (covered >= 0 && outside >= 0) {
                const known_pixel *p = &layer->pixels[layer->at[covered] - 1];
                layer->edges[layer->edge_count++] = (known_edge){
                    y * camera->width + x, outside, p->near, p->front, share_of(layer, form, x, y)};
            }
        }
    }
    return true;
}
