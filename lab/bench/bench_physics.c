/* Milliseconds of physics per 1/60 s: showers of cubes on the live surface of the synthetic room,
 * in which a person walks. A new surface comes 30 times a second; rlf_world_advance is timed,
 * and what makes the collider's grid of a new surface. Prints, for each count of cubes, the
 * cost of each phase. */
#include "bench_physics.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define COUNTS_MAX 8

typedef struct options {
    int32_t counts[COUNTS_MAX];
    int32_t count_count;
    double seconds;
    int32_t scale_factor;
    int32_t workers;
    int32_t pixels; /* cubes at three scale factors; 0: the counts at one */
    uint64_t seed;
    const char *json_path;
} options;

static void print_help(void)
{
    printf(
        "usage: bench_physics [OPTIONS]\n\n"
        "Showers of 10 cm cubes on the synthetic room, 512x424, a person walking, a new surface\n"
        "30 times a second. Times each physics step of 1/60 s and counts cubes that get lost.\n\n"
        "  --bodies N,N,...  default 2,100,1000,5000 (at most 8 counts)\n"
        "  --seconds S       simulated time with the person, default 12; 2 s without follow\n"
        "  --scale N         keep every N-th pixel of a row and column, default 1\n"
        "  --pixels N        instead: N cubes at scale factors 1, 2 and 4 beside one another\n"
        "  --workers N       default 1\n"
        "  --seed N          of the sensor's noise, default 1\n"
        "  --json FILE       write the figures as JSON too\n");
}

static bool parse_counts(const char *text, options *o)
{
    char *end = NULL;
    o->count_count = 0;
    do {
        long value = strtol(text, &end, 10);
        if (end == text || value < 1 || value > 100000 || o->count_count == COUNTS_MAX) {
            return false;
        }
        o->counts[o->count_count++] = (int32_t)value;
        text = end + 1;
    } while (*end == ',');
    return *end == '\0';
}

static bool parse_number(const char *text, double low, double high, double *out)
{
    char *end = NULL;
    *out = strtod(text, &end);
    return end != text && *end == '\0' && *out >= low && *out <= high;
}

static bool parse(int argc, char **argv, options *o)
{
    static const struct option LONG[] = {
        {"bodies", required_argument, NULL, 'b'},
        {"seconds", required_argument, NULL, 't'},
        {"scale", required_argument, NULL, 'c'},
        {"workers", required_argument, NULL, 'w'},
        {"seed", required_argument, NULL, 's'},
        {"json", required_argument, NULL, 'j'},
        {"pixels", required_argument, NULL, 'p'},
        {"help", no_argument, NULL, 'h'},
        {0},
    };
    *o = (options){.counts = {2, 100, 1000, 5000}, .count_count = 4, .seconds = 12};
    double scale = 1, workers = 1, seed = 1, pixels = 0;
    bool is_good = true;
    int option;
    while (is_good && (option = getopt_long(argc, argv, "h", LONG, NULL)) != -1) {
        switch (option) {
        case 'b': is_good = parse_counts(optarg, o); break;
        case 't': is_good = parse_number(optarg, 0.1, 3600, &o->seconds); break;
        case 'c': is_good = parse_number(optarg, 1, 64, &scale); break;
        case 'w': is_good = parse_number(optarg, 1, 64, &workers); break;
        case 'p': is_good = parse_number(optarg, 1, 100000, &pixels); break;
        case 's': is_good = parse_number(optarg, 1, 1e9, &seed); break;
        case 'j': o->json_path = optarg; break;
        default: is_good = false; break;
        }
    }
    o->scale_factor = (int32_t)scale;
    o->workers = (int32_t)workers;
    o->pixels = (int32_t)pixels;
    o->seed = (uint64_t)seed;
    return is_good && optind == argc;
}

static const char *const PHASES[SHOWER_PHASES] = {"poured", "ploughed", "at rest"};

static void print_phases(const shower *s)
{
    for (shower_phase phase = 0; phase < SHOWER_PHASES; phase++) {
        shower_cost cost = shower_cost_of(s, phase);
        if (cost.step_count > 0) {
            printf("%7d  %-9s %6.1f %9.3f %9.3f %9.3f\n", (int)s->count, PHASES[phase],
                   cost.step_count / (2.0 * ROOM_HZ), cost.median_ms, cost.p95_ms, cost.mean_ms);
        }
    }
}

static void print_parts(const shower *s)
{
    const rlf_world_times *t = &s->times;
    double n = s->step_count;
    printf(
        "%7d %8.3f %8.3f | %7.3f %7.3f %7.3f %7.3f %7.3f %7.3f %7.3f %7.3f | %6d %5d %6d %7d %6.1f "
        "%6d\n",
        (int)s->count, shower_worst_step(s), shower_busiest_second(s), shower_grid_mean(s),
        t->wake_ms / n, t->surface_ms / n, t->pairs_ms / n, t->impacts_ms / n, t->solve_ms / n,
        t->move_ms / n, (t->sleep_ms + t->publish_ms) / n, (int)s->asleep_count, (int)s->lost_count,
        (int)s->hidden_count, (int)s->through_count, 2.0 * (double)s->deep_sum / n,
        (int)s->alloc_count);
}

static void print_rows(const shower *showers, const options *o, const room *r)
{
    printf("synthetic room, %dx%d, %d worker(s); %.0f s with a person and %.0f s without; ms per "
           "1/60 s\n",
           (int)r->grid.width, (int)r->grid.height, (int)o->workers, o->seconds, SHOWER_SETTLE);
    printf("%7s  %-9s %6s %9s %9s %9s\n", "cubes", "phase", "s", "median", "p95", "mean");
    for (int32_t i = 0; i < o->count_count; i++) {
        print_phases(&showers[i]);
    }
    printf("\n%7s %8s %8s | %7s %7s %7s %7s %7s %7s %7s %7s | %6s %5s %6s %7s %6s %6s\n", "cubes",
           "worst", "busiest", "grid", "wake", "surface", "pairs", "impact", "solve", "move",
           "rest", "asleep", "lost", "hidden", "through", "deep", "allocs");
    for (int32_t i = 0; i < o->count_count; i++) {
        print_parts(&showers[i]);
    }
    printf(
        "poured: until a second after the last cubes are dropped; ploughed: from then on, while "
        "a person walks; at rest: in the last second\n"
        "worst: step; busiest: mean of the costliest second; the parts are means of all steps\n"
        "grid: what the collider's grid needs of it, once per new surface; in all but the parts\n"
        "lost: 0.3 s or more inside floor, walls or furniture, or gone; hidden: those of them "
        "that are where no picture shows it\n"
        "through: 0.3 s or more %.0f mm in the true person in view, or in on one side and out on "
        "another\n"
        "deep: pairs that overlap by more than %.0f mm, mean of all frames\n",
        1e3 * SHOWER_DEEP, 1e3 * SHOWER_DEEP);
}

static void write_row(FILE *file, const shower *s)
{
    shower_cost worst = shower_worst_cost(s);
    fprintf(file, "{\"cubes\": %d, \"median_ms\": %.4f, \"p95_ms\": %.4f, ", (int)s->count,
            worst.median_ms, worst.p95_ms);
    for (shower_phase phase = 0; phase < SHOWER_PHASES; phase++) {
        shower_cost cost = shower_cost_of(s, phase);
        fprintf(file,
                "\"%s\": {\"steps\": %d, \"median_ms\": %.4f, \"p95_ms\": %.4f, \"mean_ms\": "
                "%.4f}, ",
                PHASES[phase], (int)cost.step_count, cost.median_ms, cost.p95_ms, cost.mean_ms);
    }
    fprintf(file,
            "\"worst_ms\": %.4f, \"busiest_ms\": %.4f, \"asleep\": %d, \"lost\": %d, "
            "\"hidden\": %d, \"through\": %d, \"grid_ms\": %.4f, \"deep\": %.2f, \"allocs\": %d}",
            shower_worst_step(s), shower_busiest_second(s), (int)s->asleep_count,
            (int)s->lost_count, (int)s->hidden_count, (int)s->through_count, shower_grid_mean(s),
            2.0 * (double)s->deep_sum / s->step_count, (int)s->alloc_count);
}

static int write_json(const shower *showers, const options *o)
{
    FILE *file = fopen(o->json_path, "w");
    if (file == NULL) {
        fprintf(stderr, "bench_physics: %s: cannot be written\n", o->json_path);
        return 1;
    }
    fprintf(file, "{\n  \"seconds\": %g, \"scale\": %d, \"workers\": %d, \"rows\": [", o->seconds,
            (int)o->scale_factor, (int)o->workers);
    for (int32_t i = 0; i < o->count_count; i++) {
        fprintf(file, "%s\n    ", i > 0 ? "," : "");
        write_row(file, &showers[i]);
    }
    fprintf(file, "\n  ]\n}\n");
    return fclose(file) == 0 ? 0 : 1;
}

/* One surface, and all showers on it. */
static bool play_frame(shower *showers, const options *o, room *r, int32_t frame)
{
    bool is_good = (frame != (int32_t)(o->seconds * ROOM_HZ) || room_empty(r)) && room_next(r);
    for (int32_t i = 0; i < o->count_count && is_good; i++) {
        is_good = shower_step(&showers[i], r);
    }
    return is_good;
}

/* Plays the counts and prints them. Returns the exit status. */
static int play_counts(const options *o, rlf_pool *pool)
{
    static shower showers[COUNTS_MAX];
    room r;
    bool is_good = room_open(&r, o->seed, o->scale_factor);
    for (int32_t i = 0; i < o->count_count && is_good; i++) {
        is_good = shower_open(&showers[i], o->counts[i], o->seconds, pool);
    }
    int32_t frames = (int32_t)((o->seconds + SHOWER_SETTLE) * ROOM_HZ);
    for (int32_t k = 0; k < frames && is_good; k++) {
        is_good = play_frame(showers, o, &r, k);
    }
    int status = is_good ? 0 : 1;
    if (is_good) {
        print_rows(showers, o, &r);
        status = o->json_path != NULL ? write_json(showers, o) : 0;
    } else {
        fprintf(stderr, "bench_physics: %s\n", rlf_error_text());
    }
    for (int32_t i = 0; i < o->count_count; i++) {
        shower_close(&showers[i]);
    }
    room_close(&r);
    return status;
}

int main(int argc, char **argv)
{
    options o;
    if (!parse(argc, argv, &o)) {
        print_help();
        return 2;
    }
    rlf_pool *pool = NULL;
    int status = 1;
    if (rlf_pool_create(o.workers, &pool) != RLF_OK ||
        (o.pixels > 0 && !pixels_run(o.pixels, o.seconds, o.seed, pool))) {
        fprintf(stderr, "bench_physics: %s\n", rlf_error_text());
    } else {
        status = o.pixels > 0 ? 0 : play_counts(&o, pool);
    }
    rlf_pool_destroy(&pool);
    return status;
}
