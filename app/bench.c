/* `relief bench`: milliseconds per stage of both profiles beside this machine's memory floor. */
#include "command.h"
#include "session.h"
#include "timing.h"

#include <getopt.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Bytes per pixel that a surface holds, what the stage must write at least once: front sheet depth
 * 4, normal 12, velocity 12, thickness 4, label 4, reason 1, foreground 1; background depth 4,
 * normal 12, label 4. */
#define SURFACE_BYTES_PER_PIXEL 58
#define DEPTH_BYTES_PER_PIXEL 2
#define FLOOR_REPEATS 30

typedef struct bench_case {
    const char *name;
    rlf_profile profile;
    int32_t scale_factor;
} bench_case;

static const bench_case cases[] = {
    {"live_1", RLF_PROFILE_LIVE, 1},
    {"live_8", RLF_PROFILE_LIVE, 8},
    {"thesis_1", RLF_PROFILE_THESIS, 1},
    {"thesis_8", RLF_PROFILE_THESIS, 8},
};
#define CASE_COUNT ((int)(sizeof(cases) / sizeof(cases[0])))

typedef struct bench_options {
    const char *source;
    const char *json_path;
    int64_t frames;
    int32_t threads;
} bench_options;

typedef struct bench_row {
    timing times;
    int32_t width, height;
    double floor_ms;
} bench_row;

static void print_help(void)
{
    printf(
        "usage: relief bench [OPTIONS]\n\n"
        "Times capture, surface, physics and render with the two thrown cubes, headless, for\n"
        "both profiles at scale factors 1 and 8; medians over the frames. The floor is the time\n"
        "to read one depth frame and write one surface once with cold caches on this machine.\n\n"
        "  --source SOURCE   default synthetic:room\n"
        "  --frames N        default 150 (at least 100 for a fair median)\n"
        "  --threads N       default 1; 0 = one per processor\n"
        "  --json FILE       write the figures as JSON too\n\n"
        "examples:\n"
        "  relief bench\n"
        "  relief bench --threads 2 --json bench.json\n");
}

static const struct option long_options[] = {
    {"source", required_argument, NULL, 's'},  {"frames", required_argument, NULL, 'f'},
    {"threads", required_argument, NULL, 't'}, {"json", required_argument, NULL, 'j'},
    {"help", no_argument, NULL, 'h'},          {0},
};

static int parse(int argc, char **argv, bench_options *o)
{
    *o = (bench_options){.source = "synthetic:room", .frames = 150, .threads = 1};
    int64_t threads = 1;
    int option;
    while ((option = getopt_long(argc, argv, "h", long_options, NULL)) != -1) {
        if (option == 'h') {
            print_help();
            return EXIT_DONE;
        }
        if (option == 's') {
            o->source = optarg;
        } else if (option == 'j') {
            o->json_path = optarg;
        } else if (option == 'f') {
            if (!command_parse_int(optarg, 1, 100000, &o->frames)) {
                return command_usage("bench", "--frames '%s': use 1 to 100000", optarg);
            }
        } else if (option == 't') {
            if (!command_parse_int(optarg, 0, 64, &threads)) {
                return command_usage("bench", "--threads '%s': use 0 to 64", optarg);
            }
        } else {
            return EXIT_USAGE;
        }
    }
    o->threads = (int32_t)threads;
    return argc != optind ? command_usage("bench", "takes no argument; use --source") : -1;
}

/* Median time to read the input and write the outputs once, both out of cache: the buffers are
 * pushed out by writing 64 MiB in between. */
static double measure_floor_ms(int32_t width, int32_t height)
{
    const size_t flush_size = (size_t)64 << 20;
    size_t pixels = (size_t)width * (size_t)height;
    size_t in_size = pixels * DEPTH_BYTES_PER_PIXEL;
    size_t out_size = pixels * SURFACE_BYTES_PER_PIXEL;
    unsigned char *in = rlf_alloc(in_size);
    unsigned char *out = rlf_alloc(out_size);
    unsigned char *flush = rlf_alloc(flush_size);
    static timing_series series;
    memset(&series, 0, sizeof(series));
    for (int i = 0; in != NULL && out != NULL && flush != NULL && i < FLOOR_REPEATS; i++) {
        memset(flush, i, flush_size);
        int64_t start = rlf_clock_ns();
        for (size_t done = 0; done < out_size; done += in_size) {
            size_t rest = out_size - done;
            if (done == 0) {
                memcpy(out, in, rest < in_size ? rest : in_size);
            } else {
                memset(out + done, i, rest < in_size ? rest : in_size);
            }
        }
        timing_add(&series, (double)(rlf_clock_ns() - start) * 1e-6);
    }
    rlf_free(in);
    rlf_free(out);
    rlf_free(flush);
    return timing_percentile(&series, 50);
}

static rlf_result run_case(const bench_case *c, const bench_options *o, bench_row *row)
{
    session_options options = session_options_default();
    options.source = o->source;
    options.use_default_scene = true;
    options.profile = c->profile;
    options.scale_factor = c->scale_factor;
    options.thread_count = o->threads;
    session s;
    rlf_result result = session_open(&options, &s);
    if (result != RLF_OK) {
        return result;
    }
    for (int64_t i = 0; result == RLF_OK && i < o->frames && !command_interrupted;) {
        rlf_pipeline_output frame;
        result = rlf_pipeline_step(s.pipeline, &frame);
        if (result == RLF_OK) {
            const rlf_stage_times *t = &frame.times;
            timing_add_frame(&row->times, t,
                             t->capture_ms + t->surface_ms + t->physics_ms + t->render_ms);
            row->width = frame.surface->width;
            row->height = frame.surface->height;
            i++;
        } else if (result == RLF_NO_FRAME) {
            result = RLF_OK;
        }
    }
    session_close(&s);
    row->floor_ms = measure_floor_ms(row->width, row->height);
    return result == RLF_END ? RLF_OK : result;
}

static double fps(const bench_row *row)
{
    double ms = timing_percentile(&row->times.frame, 50);
    return ms > 0.0 ? 1000.0 / ms : 0.0;
}

static void print_rows(const bench_row *rows, const bench_options *o)
{
    printf("%s, two cubes, headless, %lld frames, threads %d; median ms\n", o->source,
           (long long)o->frames, (int)o->threads);
    printf("%-10s %9s %8s %8s %8s %8s %8s %8s %8s %8s %10s\n", "case", "grid", "capture", "surface",
           "physics", "render", "loop", "p95", "fps", "floor", "surf/floor");
    for (int i = 0; i < CASE_COUNT; i++) {
        const timing *t = &rows[i].times;
        char grid[24];
        snprintf(grid, sizeof(grid), "%dx%d", (int)rows[i].width, (int)rows[i].height);
        double surface = timing_percentile(&t->surface, 50);
        printf("%-10s %9s %8.3f %8.3f %8.3f %8.3f %8.3f %8.3f %8.1f %8.3f %10.1f\n", cases[i].name,
               grid, timing_percentile(&t->capture, 50), surface,
               timing_percentile(&t->physics, 50), timing_percentile(&t->render, 50),
               timing_percentile(&t->frame, 50), timing_percentile(&t->frame, 95), fps(&rows[i]),
               rows[i].floor_ms, rows[i].floor_ms > 0.0 ? surface / rows[i].floor_ms : 0.0);
    }
    printf("the thesis reports 10 frames per second at 64x53 (3.4 GHz Xeon, Quadro K2000)\n");
}

static rlf_result write_json(const bench_row *rows, const bench_options *o)
{
    json_t *root = json_object();
    json_object_set_new(root, "source", json_string(o->source));
    json_object_set_new(root, "frames", json_integer(o->frames));
    json_object_set_new(root, "threads", json_integer(o->threads));
    for (int i = 0; i < CASE_COUNT; i++) {
        const timing *t = &rows[i].times;
        json_t *values = json_pack(
            "{s:i, s:i, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f}", "width", (int)rows[i].width,
            "height", (int)rows[i].height, "capture_ms", timing_percentile(&t->capture, 50),
            "surface_ms", timing_percentile(&t->surface, 50), "physics_ms",
            timing_percentile(&t->physics, 50), "render_ms", timing_percentile(&t->render, 50),
            "loop_ms", timing_percentile(&t->frame, 50), "loop_p95_ms",
            timing_percentile(&t->frame, 95), "fps", fps(&rows[i]), "floor_ms", rows[i].floor_ms);
        json_object_set_new(root, cases[i].name, values);
    }
    int failed = json_dump_file(root, o->json_path, JSON_INDENT(2));
    json_decref(root);
    return failed ? rlf_fail(RLF_ERROR_IO, "%s: cannot be written; choose another --json file",
                             o->json_path)
                  : RLF_OK;
}

int bench_main(int argc, char **argv)
{
    bench_options options;
    int status = parse(argc, argv, &options);
    if (status >= 0) {
        return status;
    }
    bench_row *rows = rlf_alloc_array(CASE_COUNT, sizeof(*rows)); /* large: samples */
    if (rows == NULL) {
        return command_failed();
    }
    rlf_result result = RLF_OK;
    for (int i = 0; i < CASE_COUNT && result == RLF_OK; i++) {
        fprintf(stderr, "%s (%d of %d)\n", cases[i].name, i + 1, CASE_COUNT);
        result = run_case(&cases[i], &options, &rows[i]);
    }
    if (result == RLF_OK) {
        print_rows(rows, &options);
    }
    if (result == RLF_OK && options.json_path != NULL) {
        result = write_json(rows, &options);
    }
    rlf_free(rows);
    return result == RLF_OK ? EXIT_DONE : command_failed();
}
