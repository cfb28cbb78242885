/* `relief bench`: time and memory of every stage of both profiles. */
#include "bench/bench.h"
#include "bench/peers.h"
#include "command.h"

#include <getopt.h>
#include <stdio.h>
#include <string.h>

static void print_help(void)
{
    printf(
        "usage: relief bench [OPTIONS]\n\n"
        "Times capture, surface and its steps, physics and render with the two thrown cubes,\n"
        "headless, for both profiles at scale factors 1 and 8: median and 95th percentile over\n"
        "the frames, and the memory of each stage. The floor is the time of a plain loop that\n"
        "reads one depth frame and writes one surface, out of cache, run after every frame.\n"
        "Then how the cost grows with pixels, regions, people and bodies.\n\n"
        "  --source SOURCE   default synthetic:room\n"
        "  --frames N        default 150 (at least 100 for a fair median)\n"
        "  --threads N       default 1; 0 = one per processor\n"
        "  --quick           leave the growth out\n"
        "  --json FILE       write every row as JSON too\n"
        "  --peer-clip FILE  write FILE and FILE.gt, what other libraries are timed on, and stop\n"
        "  --peers FILE      print their results beside ours (script/bench --peers does both)\n"
        "  --compare FILE    print ratios to an earlier --json file, old / new\n\n"
        "examples:\n"
        "  relief bench\n"
        "  relief bench --threads 2 --json new.json --compare old.json\n");
}

static const struct option long_options[] = {
    {"source", required_argument, NULL, 's'},
    {"frames", required_argument, NULL, 'f'},
    {"threads", required_argument, NULL, 't'},
    {"quick", no_argument, NULL, 'q'},
    {"json", required_argument, NULL, 'j'},
    {"compare", required_argument, NULL, 'c'},
    {"peer-clip", required_argument, NULL, 'w'},
    {"peers", required_argument, NULL, 'p'},
    {"help", no_argument, NULL, 'h'},
    {0},
};

/* Returns -1 to go on, or an exit status. */
static int take_option(int option, bench_options *o)
{
    int64_t threads;
    switch (option) {
    case 's': o->source = optarg; return -1;
    case 'j': o->json_path = optarg; return -1;
    case 'c': o->compare_path = optarg; return -1;
    case 'w': o->clip_path = optarg; return -1;
    case 'p': o->peers_path = optarg; return -1;
    case 'q': o->is_quick = true; return -1;
    case 'f':
        return command_parse_int(optarg, 1, 100000, &o->frames)
                   ? -1
                   : command_usage("bench", "--frames '%s': use 1 to 100000", optarg);
    case 't':
        if (!command_parse_int(optarg, 0, 64, &threads)) {
            return command_usage("bench", "--threads '%s': use 0 to 64", optarg);
        }
        o->threads = (int32_t)threads;
        return -1;
    case 'h': print_help(); return EXIT_DONE;
    default: return EXIT_USAGE;
    }
}

static int parse(int argc, char **argv, bench_options *o)
{
    *o = (bench_options){.source = "synthetic:room", .frames = 150, .threads = 1};
    int option;
    while ((option = getopt_long(argc, argv, "h", long_options, NULL)) != -1) {
        int status = take_option(option, o);
        if (status >= 0) {
            return status;
        }
    }
    return argc != optind ? command_usage("bench", "takes no argument; use --source") : -1;
}

static rlf_result write_clip(const char *path)
{
    bench_clip clip;
    rlf_result result = bench_clip_create(&clip);
    if (result == RLF_OK) {
        result = bench_clip_write(&clip, path);
        bench_clip_destroy(&clip);
    }
    return result;
}

static rlf_result run(const bench_options *o, bench_table *table)
{
    if (o->clip_path != NULL) {
        return write_clip(o->clip_path);
    }
    rlf_result result = bench_cases_run(o, table);
    if (result == RLF_OK) {
        bench_cases_print(o, table);
    }
    if (result == RLF_OK && !o->is_quick) {
        result = bench_sweeps_run(o, table);
        if (result == RLF_OK) {
            bench_sweeps_print(table);
        }
    }
    if (result == RLF_OK && o->peers_path != NULL) {
        result = bench_peers_run(o, table);
    }
    if (result == RLF_OK && o->compare_path != NULL) {
        result = bench_compare(o, table);
    }
    if (result == RLF_OK && o->json_path != NULL) {
        result = bench_write_json(o, table);
    }
    return result;
}

int bench_main(int argc, char **argv)
{
    bench_options options;
    int status = parse(argc, argv, &options);
    if (status >= 0) {
        return status;
    }
    bench_memory_start();
    bench_table *table = rlf_alloc(sizeof(*table));
    if (table == NULL) {
        return command_failed();
    }
    rlf_result result = run(&options, table);
    rlf_free(table);
    return result == RLF_OK ? EXIT_DONE : command_failed();
}
