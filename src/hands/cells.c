/* Cells of the foreground, their roots and the way from them. */
#include "hands/cells.h"

#include <string.h>

#define CELL_M 0.014         /* side of a cell at the foreground's mean depth, metres */
#define CELLS_ACROSS 176     /* at most, along the picture's longer side */
#define SLANT_MAX 2.5f       /* depth over width of a surface that goes on: 68 degrees */
#define NOISE_SIGMAS 4.0     /* beyond that two depths differ */
#define BODY_RADIUS_M 0.11f  /* no limb, no hand and no head has a disc as large in it */
#define PIECE_LEAST_M2 0.002 /* a smaller piece is no hand: one seen edge-on has 30 cm^2 */
#define BRIDGE_M 0.2f        /* a hand hides the forearm that it is before by as much */
#define FOREARM_FROM_M 0.2f  /* from the root on there may be forearm */
#define HAND_MOST_M2 0.03    /* a spread hand and its wrist */
#define ARM_MOST_M2 0.09     /* a whole arm with its sleeve; what is larger has a body */
#define LESS_M 0.001f        /* a way that is shorter by less changes nothing */
#define MARGIN_SHARE 10      /* depth may begin this share of the picture inside its border */

static int32_t near_one(double x)
{
    return (int32_t)(x + 0.5);
}

/* Mean depth of a sample of the foreground; 0 when there is none. */
static double mean_depth(const rlf_surface *s)
{
    double sum = 0.0;
    int32_t count = 0;
    for (int32_t y = 0; y < s->height; y += 4) {
        for (int32_t i = y * s->width; i < (y + 1) * s->width; i += 4) {
            const bool counts = s->foreground[i] != 0 && s->depth[i] > 0.0f;
            sum += counts ? (double)s->depth[i] : 0.0;
            count += counts;
        }
    }
    return count > 0 ? sum / count : 0.0;
}

static void choose_step(hand_cells *c, const rlf_surface *s, double depth)
{
    const int32_t longer = s->width > s->height ? s->width : s->height;
    const double fx = rlf_max(s->camera.fx, 1.0);
    const int32_t least = (longer + CELLS_ACROSS - 1) / CELLS_ACROSS;
    const int32_t wanted = near_one(rlf_min(CELL_M * fx / depth, 16.0));
    c->step = wanted > least ? wanted : least;
    c->width = s->width / c->step;
    c->height = s->height / c->step;
    c->count = c->width * c->height;
    c->spacing = (float)(c->step / fx);
    c->noise = s->noise;
}

/* The nearest foreground pixel makes a cell: a finger counts against what is behind it. */
static void read_row(hand_cells *c, const rlf_surface *s, int32_t y)
{
    const uint8_t *foreground = s->foreground + (ptrdiff_t)y * s->width;
    const float *depth = s->depth + (ptrdiff_t)y * s->width;
    float *z = c->z + (ptrdiff_t)(y / c->step) * c->width;
    const int32_t end = c->width * c->step;
    for (int32_t x = 0; x < end; x++) {
        uint64_t eight = 1;
        if (x + 8 <= end) {
            memcpy(&eight, foreground + x, sizeof(eight));
        }
        if (eight == 0) {
            x += 7;
            continue;
        }
        float *cell = &z[x / c->step];
        if (foreground[x] != 0 && depth[x] > 0.0f && (*cell == 0.0f || depth[x] < *cell)) {
            *cell = depth[x];
        }
    }
}

static void read_cells(hand_cells *c, const rlf_surface *s)
{
    const size_t n = (size_t)c->count;
    memset(c->z, 0, n * sizeof(*c->z));
    memset(c->queued, 0, n);
    memset(c->root, HAND_ROOT_NONE, n);
    for (int32_t y = 0; y < c->height * c->step; y++) {
        read_row(c, s, y);
    }
    for (int32_t i = 0; i < c->count; i++) {
        c->reach[i] = CELL_FAR;
        if (c->z[i] > 0.0f) {
            c->noise_of[i] =
                (float)(NOISE_SIGMAS * rlf_depth_noise_sigma(&c->noise, (double)c->z[i]));
        }
    }
}

float hand_cells_way(const hand_cells *c, int32_t a, int32_t b, float cells)
{
    const int32_t near = c->z[a] < c->z[b] ? a : b;
    const float nearer = c->z[near];
    const float rise = c->z[a] < c->z[b] ? c->z[b] - nearer : c->z[a] - nearer;
    const float across = cells * c->spacing * nearer;
    if (!(nearer > 0.0f) || rise > SLANT_MAX * across + c->noise_of[near]) {
        return -1.0f;
    }
    const float noise = 0.5f * c->noise_of[near]; /* it makes no way longer */
    const float climb = rise > noise ? rise - noise : 0.0f;
    return climb > 0.0f ? sqrtf(across * across + climb * climb) : across;
}

/* A cell and its place. */
typedef struct place {
    int32_t cell, x, y;
} place;

static place place_of(const hand_cells *c, int32_t cell)
{
    return (place){cell, cell % c->width, cell / c->width};
}

/* The neighbour in direction k of eight or, over one cell without foreground, the next one, and the
 * way there; -1 when there is none or a depth step lies between. */
static int32_t neighbour(const hand_cells *c, place from, int32_t k, float *out_way)
{
    static const int32_t DX[8] = {1, -1, 0, 0, 1, -1, 1, -1}, DY[8] = {0, 0, 1, -1, 1, 1, -1, -1};
    const float length = k < 4 ? 1.0f : 1.41421356f;
    int32_t x = from.x, y = from.y;
    for (int32_t n = 1; n <= 2; n++) {
        x += DX[k];
        y += DY[k];
        if (x < 0 || y < 0 || x >= c->width || y >= c->height) {
            return -1;
        }
        const int32_t to = y * c->width + x;
        if (c->z[to] > 0.0f) {
            *out_way = hand_cells_way(c, from.cell, to, (float)n * length);
            return *out_way >= 0.0f ? to : -1;
        }
    }
    return -1;
}

static void relax(hand_cells *c, float *distance, int32_t from, int32_t to, float way,
                  int32_t *tail)
{
    if (to < 0 || distance[from] + way >= distance[to] - LESS_M) {
        return;
    }
    if (distance[to] >= CELL_FAR) {
        c->touched[c->touched_count++] = to;
    }
    distance[to] = distance[from] + way;
    if (distance == c->reach) {
        c->source[to] = c->source[from];
    }
    if (c->queued[to] == 0) {
        c->queued[to] = 1;
        c->queue[*tail] = to;
        *tail = *tail == c->count ? 0 : *tail + 1;
    }
}

static void relax_bridges(hand_cells *c, float *distance, int32_t from, int32_t *tail)
{
    for (int32_t k = 0; k < c->bridge_count; k++) {
        const int32_t *ends = c->bridge[k];
        const float z = c->z[ends[0]] - c->z[ends[1]];
        if (from == ends[0] || from == ends[1]) {
            relax(c, distance, from, from == ends[0] ? ends[1] : ends[0], z < 0.0f ? -z : z, tail);
        }
    }
}

void hand_cells_spread(hand_cells *c, float *distance, int32_t queued, float limit)
{
    int32_t head = 0;
    int32_t tail = queued;
    while (head != tail) {
        const int32_t from = c->queue[head];
        head = head == c->count ? 0 : head + 1;
        c->queued[from] = 0;
        const place at = place_of(c, from);
        for (int32_t k = 0; k < 8 && distance[from] < limit; k++) {
            float way = 0.0f;
            const int32_t to = neighbour(c, at, k, &way);
            relax(c, distance, from, to, way, &tail);
        }
        if (distance[from] < limit) {
            relax_bridges(c, distance, from, &tail);
        }
    }
}

static int32_t least(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

/* Both passes of the 5-7 chamfer: within 5 % of the true distance (Borgefors 1986). */
void hand_chamfer(int32_t *d, int32_t width, int32_t height)
{
    for (int32_t i = 0; i < width * height; i++) {
        int32_t v = d[i];
        if (v == 0) {
            continue;
        }
        const int32_t x = i % width;
        v = x > 0 ? least(v, d[i - 1] + 5) : v;
        if (i >= width) {
            v = least(v, d[i - width] + 5);
            v = x > 0 ? least(v, d[i - width - 1] + 7) : v;
            v = x < width - 1 ? least(v, d[i - width + 1] + 7) : v;
        }
        d[i] = v;
    }
    for (int32_t i = width * height - 1; i >= 0; i--) {
        int32_t v = d[i];
        if (v == 0) {
            continue;
        }
        const int32_t x = i % width;
        v = x < width - 1 ? least(v, d[i + 1] + 5) : v;
        if (i < width * (height - 1)) {
            v = least(v, d[i + width] + 5);
            v = x > 0 ? least(v, d[i + width - 1] + 7) : v;
            v = x < width - 1 ? least(v, d[i + width + 1] + 7) : v;
        }
        d[i] = v;
    }
}

/* Edges are cells without foreground, and both sides of a depth step. */
static void measure_discs(hand_cells *c)
{
    for (int32_t i = 0; i < c->count; i++) {
        c->disc[i] = 0;
        if (c->z[i] <= 0.0f) {
            continue;
        }
        const bool has_right = i % c->width < c->width - 1;
        const bool has_below = i < c->count - c->width;
        c->disc[i] = INT32_MAX / 2;
        if (((has_right && c->z[i + 1] > 0.0f && hand_cells_way(c, i, i + 1, 1.0f) < 0.0f) ||
             (has_below && c->z[i + c->width] > 0.0f &&
              hand_cells_way(c, i, i + c->width, 1.0f) < 0.0f))) {
            c->disc[i] = CHAMFER / 2;
        }
    }
    hand_chamfer(c->disc, c->width, c->height);
}

static int32_t add_root(hand_cells *c, int32_t cell, hand_root root, int32_t queued)
{
    if (c->z[cell] <= 0.0f || c->queued[cell] != 0) {
        return queued;
    }
    c->root[cell] = (uint8_t)root;
    c->source[cell] = cell;
    c->reach[cell] = 0.0f;
    c->queued[cell] = 1;
    c->queue[queued] = cell;
    return queued + 1;
}

static bool has_depth(const hand_cells *c, int32_t cell)
{
    const int32_t x = cell % c->width * c->step + c->step / 2;
    const int32_t y = cell / c->width * c->step + c->step / 2;
    return c->z[cell] > 0.0f || c->surface->depth[y * c->surface->width + x] > 0.0f;
}

/* The first cell with depth of a row or column, when it is foreground and near the border: cameras
 * have margins without depth. */
static int32_t add_border(hand_cells *c, int32_t first, int32_t stride, int32_t length,
                          int32_t queued)
{
    for (int32_t k = 0; k <= length / MARGIN_SHARE; k++) {
        const int32_t cell = first + k * stride;
        if (has_depth(c, cell)) {
            return add_root(c, cell, HAND_ROOT_BORDER, queued);
        }
    }
    return queued;
}

static int32_t add_roots(hand_cells *c)
{
    int32_t queued = 0;
    for (int32_t y = 0; y < c->height; y++) {
        const int32_t row = y * c->width;
        queued = add_border(c, row, 1, c->width, queued);
        queued = add_border(c, row + c->width - 1, -1, c->width, queued);
    }
    for (int32_t x = 0; x < c->width; x++) {
        queued = add_border(c, x, c->width, c->height, queued);
        queued = add_border(c, c->count - c->width + x, -c->width, c->height, queued);
    }
    for (int32_t i = 0; i < c->count; i++) {
        const float radius = (float)c->disc[i] / CHAMFER * c->spacing * c->z[i];
        if (radius >= BODY_RADIUS_M) {
            queued = add_root(c, i, HAND_ROOT_BODY, queued);
        }
    }
    return queued;
}

/* The rooted cell within four cells of this one that is least far behind it; -1 = none. */
static int32_t behind_cell(const hand_cells *c, int32_t cell)
{
    const int32_t x = cell % c->width;
    const int32_t y = cell / c->width;
    int32_t best = -1;
    for (int32_t k = 1; k <= 4; k++) {
        const int32_t at[4] = {x >= k ? cell - k : cell, x + k < c->width ? cell + k : cell,
                               y >= k ? cell - k * c->width : cell,
                               y + k < c->height ? cell + k * c->width : cell};
        for (int32_t side = 0; side < 4; side++) {
            const int32_t i = at[side];
            if (c->reach[i] < CELL_FAR && hand_cells_root(c, i) <= HAND_ROOT_BODY &&
                c->z[i] > c->z[cell] && (best < 0 || c->z[i] < c->z[best])) {
                best = i;
            }
        }
    }
    return best;
}

/* Lists a piece in the queue, from its first cell on, and returns how many cells it has. */
static int32_t list_piece(hand_cells *c, int32_t first)
{
    int32_t count = 1;
    c->queue[0] = first;
    c->root[first] = HAND_ROOT_ALONE;
    for (int32_t head = 0; head < count; head++) {
        const place at = place_of(c, c->queue[head]);
        for (int32_t k = 0; k < 8; k++) {
            float way;
            const int32_t to = neighbour(c, at, k, &way);
            if (to >= 0 && c->root[to] == HAND_ROOT_NONE) {
                c->root[to] = HAND_ROOT_ALONE;
                c->queue[count++] = to;
            }
        }
    }
    return count;
}

static void spread_from(hand_cells *c, int32_t cell)
{
    c->queue[0] = cell;
    hand_cells_spread(c, c->reach, 1, CELL_FAR);
}

static bool hides_forearm(const hand_cells *c, int32_t edge, int32_t behind)
{
    return edge >= 0 && c->z[behind] - c->z[edge] < BRIDGE_M && c->reach[behind] > FOREARM_FROM_M;
}

/* A piece that no root reaches is the hand before its arm, or a body by its size, which arms may
 * hide the middle of, or it hangs on its furthest end. */
static void root_piece(hand_cells *c, int32_t first)
{
    const int32_t count = list_piece(c, first);
    int32_t deepest = first, thickest = first, edge = -1, behind = -1;
    double area = 0.0;
    for (int32_t k = 0; k < count; k++) {
        const int32_t i = c->queue[k];
        const double side = (double)(c->spacing * c->z[i]);
        const int32_t other = behind_cell(c, i);
        area += side * side;
        deepest = c->z[i] > c->z[deepest] ? i : deepest;
        thickest = c->disc[i] > c->disc[thickest] ? i : thickest;
        if (other >= 0 && (edge < 0 || c->z[other] - c->z[i] < c->z[behind] - c->z[edge])) {
            edge = i;
            behind = other;
        }
    }
    if (area < PIECE_LEAST_M2) {
        return;
    }
    if (area < HAND_MOST_M2 && hides_forearm(c, edge, behind) && c->bridge_count < BRIDGES_MAX) {
        c->bridge[c->bridge_count][0] = behind;
        c->bridge[c->bridge_count++][1] = edge;
        spread_from(c, behind);
        return;
    }
    const hand_root alone = edge >= 0 ? HAND_ROOT_FRONT : HAND_ROOT_ALONE;
    const int32_t root = area > ARM_MOST_M2 ? thickest : deepest;
    c->source[root] = root;
    c->root[root] = (uint8_t)(area > ARM_MOST_M2 ? HAND_ROOT_BODY : alone);
    c->reach[root] = 0.0f;
    spread_from(c, root);
}

bool hand_cells_read(hand_cells *c, const rlf_surface *s)
{
    const double depth = mean_depth(s);
    if (!(depth > 0.0)) {
        return false;
    }
    choose_step(c, s, depth);
    c->surface = s;
    read_cells(c, s);
    measure_discs(c);
    c->touched_count = 0;
    c->bridge_count = 0;
    hand_cells_spread(c, c->reach, add_roots(c), CELL_FAR);
    for (int32_t i = 0; i < c->count; i++) {
        if (c->z[i] > 0.0f && c->reach[i] >= CELL_FAR && c->root[i] == HAND_ROOT_NONE) {
            root_piece(c, i);
        }
    }
    return true;
}
