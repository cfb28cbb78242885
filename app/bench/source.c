/* Wall, floor, walking capsules and standing plates, ray by ray, with a Kinect v2's noise. */
#include "bench/bench.h"

#include <string.h>

#define WALL_M 3.2
#define FLOOR_M 1.0
#define PLATE_M 2.6
#define PLATE_SPAN_M 2.4 /* the plates stand on a square this wide ... */
#define PLATE_FILL 0.7   /* ... and take this share of its width and of its height */
#define PERSON_RADIUS_M 0.18
#define PERSON_TOP_M (-0.6)
#define ROW_M 2.2         /* people side by side share this breadth ... */
#define ROW_Z_M 2.0       /* ... so far away ... */
#define ROW_PEOPLE_M 1.44 /* ... and fill so much of it ... */
#define ROW_SWAY_M 0.25   /* ... all swaying alike */
#define NOISE_COUNT 65536

typedef struct room_source {
    bench_room room;
    rlf_rig rig;
    int64_t frame;
    uint16_t *depth;
    float *noise; /* normal numbers */
} room_source;

/* Depth at which a ray meets a standing capsule's trunk; 0 where it does not. Its cylinder is
 * enough: cost does not ask for round shoulders. */
static double hit_person(rlf_vec3 ray, double x, double z, double radius)
{
    double a = ray.x * ray.x + 1.0;
    double b = ray.x * x + z;
    double root = b * b - a * (x * x + z * z - radius * radius);
    if (root < 0.0) {
        return 0.0;
    }
    double depth = (b - sqrt(root)) / a;
    return depth > 0.3 && ray.y * depth > PERSON_TOP_M ? depth : 0.0;
}

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

/* Depth at which a ray meets person k; 0 where it does not. */
static double hit_one(const room_source *s, rlf_vec3 ray, int32_t k)
{
    double phase = (double)s->frame / 45.0;
    if (s->room.side_by_side) {
        double pitch = ROW_M / s->room.people, radius = 0.5 * ROW_PEOPLE_M / s->room.people;
        double x = pitch * (k + 0.5) - 0.5 * ROW_M + ROW_SWAY_M * rlf_sin(3.0 * phase);
        return hit_person(ray, x, ROW_Z_M, radius);
    }
    double x = 1.1 * rlf_sin(phase + 1.7 * k);
    return hit_person(ray, x, 1.6 + 0.12 * (k % 8), PERSON_RADIUS_M);
}

static double cast(const room_source *s, rlf_vec3 ray, int32_t columns)
{
    double z = ray.y > 1e-6 ? rlf_min(FLOOR_M / ray.y, WALL_M) : WALL_M;
    if (s->frame < BENCH_EMPTY_FRAMES) {
        return z;
    }
    if (s->room.plates > 0 && is_on_plate(ray, s->room.plates, columns)) {
        z = rlf_min(z, PLATE_M);
    }
    for (int32_t k = 0; k < s->room.people; k++) {
        double person = hit_one(s, ray, k);
        z = person > 0.0 ? rlf_min(z, person) : z;
    }
    return z;
}

static rlf_result next(void *self, rlf_frame *out)
{
    room_source *s = self;
    const rlf_camera *c = &s->rig.depth;
    int32_t columns = plate_columns(s->room.plates);
    uint32_t at = (uint32_t)s->frame * 40503u;
    for (int32_t i = 0; i < c->width * c->height; i++) {
        rlf_vec3 ray = {(i % c->width - c->cx) / c->fx, (double)(i / c->width - c->cy) / c->fy, 1};
        double z = cast(s, ray, columns);
        at = at * 1664525u + 1013904223u; /* Knuth, TAOCP 2, table 3.3.4-1 */
        double noise = s->noise[at >> 16];
        double mm = 1000.0 * (z + noise * rlf_depth_noise_sigma(&s->rig.noise, z)) + 0.5;
        s->depth[i] = (uint16_t)mm;
    }
    *out = (rlf_frame){.sequence = (uint64_t)s->frame,
                       .time_ns = s->frame * INT64_C(33333333),
                       .depth_u16 = s->depth,
                       .depth_stride = c->width * (ptrdiff_t)sizeof(uint16_t),
                       .depth_units_per_metre = 1000.0};
    s->frame++;
    return RLF_OK;
}

static void destroy(void *self)
{
    room_source *s = self;
    rlf_free(s->depth);
    rlf_free(s->noise);
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
    rig.T_color_depth = rlf_pose_identity();
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
    s->depth = rlf_alloc_array((size_t)room->width * (size_t)room->height, sizeof(*s->depth));
    s->noise = rlf_alloc_array(NOISE_COUNT, sizeof(*s->noise));
    if (s->depth == NULL || s->noise == NULL) {
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
