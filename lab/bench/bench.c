/* `relief-lab bench`: time and memory of every stage of both profiles. */
#include "bench/bench.h"
#include "bench/live.h"
#include "bench/peers.h"
#include "command.h"
#include "lab_commands.h"
#include "json_file.h"
#include "options.h"

#include <getopt.h>
#include <stdio.h>
#include <string.h>

static void print_help(void)
{
    printf(
        "usage: relief-lab bench [OPTIONS]\n\n"
        "Times capture, surface and its steps, physics and render with the two thrown cubes,\n"
        "headless, for both profiles at scale factors 1 and 8: median and 95th percentile over\n"
        "the frames, and the memory of each stage. The floor is the time of a plain loop that\n"
        "reads one depth frame and writes one surface, out of cache, run after every frame.\n"
        "Then how the cost grows with pixels, regions, people and bodies.\n\n"
        "  --source SOURCE   default synthetic:room\n"
        "  --frames N        default 150 (at least 100 for a fair median)\n"
        "  --threads N       default 1; 0 = one per processor\n"
        "  --quick           leave the growth out\n"
        "  --live            instead: the source as a camera in real time: how late its pictures\n"
        "                    are, how soon it shows and is missed; default of --source then\n"
        "                    synthetic:room?color=480x270\n"
        "  --json FILE       write every row as JSON too\n"
        "  --peer-clip FILE  write FILE and FILE.gt, what other libraries are timed on, and stop\n"
        "  --peers FILE      print their results beside ours (script/bench --peers does both)\n"
        "  --compare FILE    print ratios to an earlier --json file, old / new\n\n"
        "examples:\n"
        "  relief-lab bench\n"
        "  relief-lab bench --threads 2 --json new.json --compare old.json\n");
}

static int parse(int argc, char **argv, bench_options *o)
{
    *o = (bench_options){.frames = 150, .threads = 1};
    const option_def options[] = {
        {.name = "source", .kind = OPTION_TEXT, .out = &o->source},
        {.name = "frames", .kind = OPTION_INT64, .out = &o->frames, .low = 1, .high = 100000},
        {.name = "threads", .kind = OPTION_INT32, .out = &o->threads, .low = 0, .high = 64},
        {.name = "quick", .kind = OPTION_FLAG, .out = &o->is_quick},
        {.name = "live", .kind = OPTION_FLAG, .out = &o->is_live},
        {.name = "json", .kind = OPTION_FILE, .out = &o->json_path, .choices = ".json"},
        {.name = "peer-clip", .kind = OPTION_TEXT, .out = &o->clip_path},
        {.name = "peers", .kind = OPTION_TEXT, .out = &o->peers_path},
        {.name = "compare", .kind = OPTION_TEXT, .out = &o->compare_path},
        {0},
    };
    int status = options_parse("bench", argc, argv, options, print_help);
    if (status < 0 && argc != optind) {
        return command_usage("bench", "takes no argument; use --source");
    }
    if (o->source == NULL) { /* a small picture: to make it must not be what is measured */
        o->source = o->is_live ? "synthetic:room?color=480x270" : "synthetic:room";
    }
    return status;
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

/* What would fail after minutes fails now. */
static rlf_result check(const bench_options *o)
{
    rlf_result result = o->json_path != NULL ? rlf_file_check(o->json_path) : RLF_OK;
    if (result == RLF_OK && o->compare_path != NULL) {
        result = bench_compare_check(o->compare_path);
    }
    return result == RLF_OK && o->peers_path != NULL ? bench_peers_check(o->peers_path) : result;
}

static rlf_result run(const bench_options *o, bench_table *table)
{
    if (o->clip_path != NULL) {
        return write_clip(o->clip_path);
    }
    if (o->is_live) {
        return bench_live(o->source, o->threads);
    }
    json_t *peers = NULL;
    rlf_result result = check(o);
    result = result == RLF_OK ? bench_cases_run(o, table) : result;
    if (result == RLF_OK && !command_interrupted) {
        machine_print();
        bench_cases_print(o, table);
    }
    if (result == RLF_OK && !o->is_quick && !command_interrupted) {
        result = bench_sweeps_run(o, table);
        if (result == RLF_OK && !command_interrupted) {
            bench_sweeps_print(table);
        }
    }
    if (result == RLF_OK && o->peers_path != NULL && !command_interrupted) {
        result = bench_peers_run(o, table, &peers);
    }
    if (result == RLF_OK && o->compare_path != NULL && !command_interrupted) {
        result = bench_compare(o, table);
    }
    if (result == RLF_OK && o->json_path != NULL && !command_interrupted) {
        result = bench_write_json(o, table, json_incref(peers));
    }
    json_decref(peers);
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
    if (command_interrupted) {
        return command_stopped("bench");
    }
    return result == RLF_OK ? EXIT_DONE : command_failed();
}
