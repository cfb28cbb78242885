/* What the number of pixels costs physics: the same showers on the same frames at three scale
 * factors, frame by frame beside one another. */
#include "bench_physics.h"

#include <stdio.h>

#define SCALES 3

static const int32_t FACTORS[SCALES] = {1, 2, 4};
static const char *const PHASES[SHOWER_PHASES] = {"poured", "ploughed", "at rest"};

static bool play(room *rooms, shower *showers, double seconds)
{
    int32_t frames = (int32_t)((seconds + SHOWER_SETTLE) * ROOM_HZ);
    bool is_good = true;
    for (int32_t k = 0; k < frames && is_good; k++) {
        for (int32_t i = 0; i < SCALES && is_good; i++) {
            is_good = (k != (int32_t)(seconds * ROOM_HZ) || room_empty(&rooms[i])) &&
                      room_next(&rooms[i]) && shower_step(&showers[i], &rooms[i]);
        }
    }
    return is_good;
}

static void print(const room *rooms, const shower *showers, int32_t count)
{
    printf("%d cubes, median ms per 1/60 s, and of that with all pixels\n%-9s", (int)count, "");
    for (int32_t i = 0; i < SCALES; i++) {
        printf("     %4dx%-4d     ", (int)rooms[i].grid.width, (int)rooms[i].grid.height);
    }
    printf("\n");
    for (shower_phase phase = 0; phase < SHOWER_PHASES; phase++) {
        double whole = shower_cost_of(&showers[0], phase).median_ms;
        printf("%-9s", PHASES[phase]);
        for (int32_t i = 0; i < SCALES; i++) {
            double median = shower_cost_of(&showers[i], phase).median_ms;
            printf("%9.3f (%5.2f) ", median, whole > 0.0 ? median / whole : 0.0);
        }
        printf("\n");
    }
    printf("%-9s", "its grid");
    for (int32_t i = 0; i < SCALES; i++) {
        double grid = shower_grid_mean(&showers[i]), whole = shower_grid_mean(&showers[0]);
        printf("%9.3f (%5.2f) ", grid, whole > 0.0 ? grid / whole : 0.0);
    }
    printf("\n");
}

bool pixels_run(int32_t count, double seconds, uint64_t seed, rlf_pool *pool)
{
    room rooms[SCALES] = {0};
    shower showers[SCALES] = {0};
    bool is_good = true;
    for (int32_t i = 0; i < SCALES && is_good; i++) {
        is_good = room_open(&rooms[i], seed, FACTORS[i]) &&
                  shower_open(&showers[i], count, seconds, pool);
    }
    is_good = is_good && play(rooms, showers, seconds);
    if (is_good) {
        print(rooms, showers, count);
    }
    for (int32_t i = 0; i < SCALES; i++) {
        shower_close(&showers[i]);
        room_close(&rooms[i]);
    }
    return is_good;
}
