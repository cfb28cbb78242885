/* Wall, floor, walking people and standing plates, ray by ray, with a Kinect v2's noise, without
 * the pixels beside people's outlines, and with a colour camera. */
#include "bench/bench.h"
#include "bench/people.h"

#include <math.h>
#include <string.h>

#define WALL_M 3.2
#define FLOOR_M 1.0
#define PLATE_M 2.6
#define PLATE_SPAN_M 2.4 /* the plates stand on a square this wide ... */
#define PLATE_FILL 0.7   /* ... and take this share of its width and of its height */
#define ROW_PITCH_M 0.47 /* people side by side: so far from one to the next ... */
#define ROW_Z_M 1.03     /* ... as far away as this times the root of their number ... */
#define ROW_SWAY 0.05    /* ... and all swaying alike, by this share of that */
#define STRIDE 0.35      /* of people who walk: how far their legs lean */
#define COLOR_WIDTH 960
#define COLOR_HEIGHT 540
#define COLOR_F 540.7 /* pixels, and the baseline: a Kinect v2's */
#define BASELINE_M 0.052
#define OUTLINE_STEP 0.04f /* share of the depth, from people to what is behind them */
#define NOISE_COUNT 65536

typedef struct room_source {
    bench_room room;
    rlf_rig rig;
    int64_t frame;
    int32_t columns; /* of plates */
    people people;   /* of the frame, from one of the cameras */
    uint16_t *depth;
    float *z;     /* of the frame, without noise; negative where somebody is */
    float *noise; /* normal numbers */
    uint8_t *color;
} room_source;

/* The plates' rows and columns: the least square that holds them all. */
static int32_t plate_columns(int32_t plates)
{
    int32_t columns = 1;
    while (columns * columns < plates) {
        columns++;
    }
    return columns;
}

static bool is_on_plate(rlf_vec3 ray, int32_t plates, int32_t columns)
{
    double pitch = PLATE_SPAN_M / columns;
    double x = (ray.x * PLATE_M + 0.5 * PLATE_SPAN_M) / pitch;
    double y = (ray.y * PLATE_M + 0.5 * PLATE_SPAN_M + 0.2) / pitch;
    if (x < 0.0 || y < 0.0 || x >= columns || y >= columns) {
        return false;
    }
    int32_t column = (int32_t)x, row = (int32_t)y;
    return row * columns + column < plates && x - column < PLATE_FILL && y - row < PLATE_FILL;
}

/* Where everybody is in this frame. */
static void place_people(room_source *s)
{
    double phase = (double)s->frame / 45.0;
    int32_t count = s->frame < BENCH_EMPTY_FRAMES ? 0 : s->room.people;
    s->people.count = 0;
    for (int32_t k = 0; k < count; k++) {
        if (s->room.side_by_side) {
            double z = ROW_Z_M * sqrt((double)count), sway = ROW_SWAY * z * rlf_sin(3.0 * phase);
            people_add(&s->people, ROW_PITCH_M * (k + 0.5 - 0.5 * count) + sway, z, 0.0);
        } else {
            double x = 1.1 * rlf_sin(phase + 1.7 * k), stride = STRIDE * rlf_sin(5.0 * phase + k);
            people_add(&s->people, x, 1.6 + 0.12 * (k % 8), stride);
        }
    }
}

/* What a ray from a camera so far to the right meets: its depth, negative of people, and a colour.
 */
static double cast(const room_source *s, rlf_vec3 ray, double right, const uint8_t **out_rgb)
{
    static const uint8_t wall[3] = {176, 172, 160}, ground[3] = {122, 98, 70};
    static const uint8_t plate[3] = {60, 90, 150};
    static const uint8_t cloths[PEOPLE_NOBODY][3] = {
        {205, 160, 135}, {150, 40, 45}, {45, 55, 85}, {30, 28, 28}};
    double z = ray.y > 1e-6 ? rlf_min(FLOOR_M / ray.y, WALL_M) : WALL_M;
    const rlf_vec3 on_plates = {ray.x + right / PLATE_M, ray.y, 1.0};
    *out_rgb = z < WALL_M ? ground : wall;
    if (s->frame >= BENCH_EMPTY_FRAMES && s->room.plates > 0 && PLATE_M < z &&
        is_on_plate(on_plates, s->room.plates, s->columns)) {
        z = PLATE_M;
        *out_rgb = plate;
    }
    people_cloth cloth;
    double person = people_hit(&s->people, ray, &cloth);
    bool is_person = person > 0.0 && person < z;
    *out_rgb = is_person ? cloths[cloth] : *out_rgb;
    return is_person ? -person : z;
}

static rlf_vec3 ray_at(const rlf_camera *c, int32_t i)
{
    return (rlf_vec3){(i % c->width - c->cx) / c->fx, (double)(i / c->width - c->cy) / c->fy, 1};
}

/* The colours of what is seen, with a grain of some steps. */
static void draw_color(room_source *s)
{
    const rlf_camera *c = &s->rig.color;
    people_shift(&s->people, BASELINE_M);
    for (int32_t i = 0; i < c->width * c->height; i++) {
        const uint8_t *rgb;
        cast(s, ray_at(c, i), BASELINE_M, &rgb);
        uint32_t grain = ((uint32_t)i * 2654435769u) >> 29;
        for (int32_t k = 0; k < 3; k++) {
            s->color[4 * i + k] = (uint8_t)(rgb[k] + grain);
        }
        s->color[4 * i + 3] = 255;
    }
}

/* One of the pixels is somebody, and the other one is farther away. */
static bool is_beside(float a, float b)
{
    float nearer = fabsf(a) < fabsf(b) ? a : b;
    return nearer < 0.0f && fabsf(fabsf(a) - fabsf(b)) > OUTLINE_STEP * fabsf(nearer);
}

/* A pixel next to people's outlines, on either side, or every second one of the next but one: a
 * driver drops it. */
static bool is_outline(const room_source *s, int32_t i)
{
    static const int32_t steps[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    int32_t width = s->rig.depth.width, height = s->rig.depth.height;
    uint32_t hash = ((uint32_t)i + 7919u * (uint32_t)s->frame) * 2654435769u;
    int32_t reach = hash >> 31 != 0 ? 2 : 1;
    for (int32_t k = 0; k < 4 * reach; k++) {
        int32_t x = i % width + steps[k % 4][0] * (1 + k / 4);
        int32_t y = i / width + steps[k % 4][1] * (1 + k / 4);
        bool inside = x >= 0 && y >= 0 && x < width && y < height;
        if (inside && is_beside(s->z[i], s->z[y * width + x])) {
            return true;
        }
    }
    return false;
}

static rlf_result next(void *self, rlf_frame *out)
{
    room_source *s = self;
    const rlf_camera *c = &s->rig.depth;
    uint32_t at = (uint32_t)s->frame * 40503u;
    place_people(s);
    for (int32_t i = 0; i < c->width * c->height; i++) {
        const uint8_t *rgb;
        s->z[i] = (float)cast(s, ray_at(c, i), 0.0, &rgb);
    }
    for (int32_t i = 0; i < c->width * c->height; i++) {
        double z = fabs((double)s->z[i]);
        at = at * 1664525u + 1013904223u; /* Knuth, TAOCP 2, table 3.3.4-1 */
        double noise = s->noise[at >> 16];
        double mm = 1000.0 * (z + noise * rlf_depth_noise_sigma(&s->rig.noise, z)) + 0.5;
        s->depth[i] = is_outline(s, i) ? 0 : (uint16_t)mm;
    }
    draw_color(s);
    *out = (rlf_frame){.sequence = (uint64_t)s->frame,
                       .time_ns = s->frame * INT64_C(33333333),
                       .depth_u16 = s->depth,
                       .depth_stride = c->width * (ptrdiff_t)sizeof(uint16_t),
                       .depth_units_per_metre = 1000.0,
                       .color = {s->color, COLOR_WIDTH, COLOR_HEIGHT, 4 * COLOR_WIDTH}};
    s->frame++;
    return RLF_OK;
}

static void destroy(void *self)
{
    room_source *s = self;
    rlf_free(s->depth);
    rlf_free(s->z);
    rlf_free(s->noise);
    rlf_free(s->color);
    rlf_free(s);
}

/* A Kinect v2 with other pixels: the same view, so the same surfaces. */
static rlf_rig make_rig(const bench_room *room)
{
    rlf_rig rig;
    memset(&rig, 0, sizeof(rig));
    rig.depth.width = room->width;
    rig.depth.height = room->height;
    rig.depth.fx = rig.depth.fy = 365.5 / 512.0 * room->width;
    rig.depth.cx = 0.5 * (room->width - 1);
    rig.depth.cy = 0.5 * (room->height - 1);
    rig.has_color = true;
    rig.color = (rlf_camera){.width = COLOR_WIDTH,
                             .height = COLOR_HEIGHT,
                             .fx = COLOR_F,
                             .fy = COLOR_F,
                             .cx = 0.5 * (COLOR_WIDTH - 1),
                             .cy = 0.5 * (COLOR_HEIGHT - 1)};
    rig.T_color_depth = rlf_pose_identity();
    rig.T_color_depth.p.x = -BASELINE_M;
    rig.depth_min_m = 0.5;
    rig.depth_max_m = 4.5;
    rig.noise = (rlf_depth_noise){0.0015, -0.0005, 0.0003};
    return rig;
}

static void fill_noise(float *noise)
{
    uint64_t state = 1;
    for (int32_t i = 0; i < NOISE_COUNT; i++) {
        double sum = -6.0; /* twelve uniform numbers have variance 1 */
        for (int k = 0; k < 12; k++) {
            state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
            sum += (double)(state >> 11) / 9007199254740992.0;
        }
        noise[i] = (float)sum;
    }
}

rlf_result bench_source_create(const bench_room *room, rlf_source **out)
{
    room_source *s = rlf_alloc(sizeof(*s));
    if (s == NULL) {
        return RLF_ERROR_MEMORY;
    }
    s->room = *room;
    s->rig = make_rig(room);
    s->columns = plate_columns(room->plates);
    s->depth = rlf_alloc_array((size_t)room->width * (size_t)room->height, sizeof(*s->depth));
    s->noise = rlf_alloc_array(NOISE_COUNT, sizeof(*s->noise));
    s->z = rlf_alloc_array((size_t)room->width * (size_t)room->height, sizeof(*s->z));
    s->color = rlf_alloc_array((size_t)COLOR_WIDTH * COLOR_HEIGHT, 4);
    if (s->depth == NULL || s->z == NULL || s->noise == NULL || s->color == NULL) {
        destroy(s);
        return RLF_ERROR_MEMORY;
    }
    fill_noise(s->noise);
    rlf_source_methods methods = {.next = next, .destroy = destroy};
    rlf_source_info info = {
        .name = "bench room", .rig = s->rig, .frame_count = -1, .frames_per_second = 30.0};
    rlf_result result = rlf_source_create_custom(&methods, &info, s, out);
    if (result != RLF_OK) {
        destroy(s);
    }
    return result;
}
