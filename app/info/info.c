/* `relief info SOURCE`. */
#include "command.h"
#include "info/info.h"
#include "options.h"
#include "relief/io.h"

#include <getopt.h>
#include <stdio.h>

#define ENDLESS_FRAMES 60 /* of a source that has no end and is not live */

typedef struct info_options {
    const char *source, *json_path;
    int64_t seconds, frame_limit;
    bool asks_noise, asks_up;
} info_options;

static void print_help(void)
{
    printf("usage: relief info SOURCE [OPTIONS]\n\n"
           "Tells what a source is: cameras, range, rate, lost frames, missing pixels, noise over\n"
           "time, poses, and how far colour is off depth at edges. Reads a clip to its end.\n\n"
           "  --seconds N       of a live source, default 3\n"
           "  --frames N        read no more than N frames (a source without end: 60)\n"
           "  --noise           instead: the sensor's noise by distance, of a still scene\n"
           "  --up              instead: where floors, tables and walls say that up is, how the\n"
           "                    camera looks, and how far off that is from a groundtruth.txt\n"
           "  --json FILE       the same as numbers (not of --up)\n"
           "%s\n"
           "examples:\n  relief info synthetic:room\n  relief info path/to/clip --json clip.json\n"
           "  relief info path/to/clip --noise --frames 30\n",
           COMMAND_PLUGIN_HELP);
}

static int parse(int argc, char **argv, info_options *o)
{
    o->seconds = 3;
    const option_def options[] = {
        ROW_INT64("seconds", &o->seconds, 1, 3600),
        ROW_INT64("frames", &o->frame_limit, 1, 1000000000),
        ROW_FILE("json", &o->json_path, ".json"),
        ROW_FLAG("noise", &o->asks_noise),
        ROW_FLAG("up", &o->asks_up),
        ROW_PLUGIN,
        {0},
    };
    int status = options_parse("info", argc, argv, options, print_help);
    if (status >= 0) {
        return status;
    }
    if (argc - optind != 1) {
        return command_usage("info", "needs one SOURCE");
    }
    if (o->asks_up && (o->asks_noise || o->json_path != NULL)) {
        return command_usage("info", "--up goes without --noise and --json");
    }
    o->source = argv[optind];
    return -1;
}

/* RLF_NO_FRAME: stopped before there was one. */
static rlf_result tell(const info_options *o, rlf_source *source)
{
    const rlf_source_info *info = rlf_source_get_info(source);
    const bool is_endless = info->frame_count < 0 && !info->is_live;
    const int64_t usual = is_endless || info->is_live ? ENDLESS_FRAMES : INT64_MAX;
    const int64_t most = o->frame_limit > 0 ? o->frame_limit : usual;
    if (o->asks_noise) {
        return info_noise_run(source, o->source, most, o->json_path);
    }
    if (o->asks_up) {
        return info_up(source, o->source, most);
    }
    const survey_options limits = {
        .seconds = (double)o->seconds,
        .frame_limit = o->frame_limit == 0 && is_endless ? ENDLESS_FRAMES : o->frame_limit,
    };
    static survey s;
    rlf_result result = survey_run(source, &limits, &s);
    if (result != RLF_OK) {
        return result;
    }
    if (command_interrupted && s.frames == 0) {
        return RLF_NO_FRAME;
    }
    report_print(info, &s);
    return o->json_path != NULL ? report_write_json(info, &s, o->json_path) : RLF_OK;
}

int info_main(int argc, char **argv)
{
    info_options o = {0};
    int status = parse(argc, argv, &o);
    if (status >= 0) {
        return status;
    }
    if (o.json_path != NULL && rlf_file_check(o.json_path) != RLF_OK) {
        return command_failed();
    }
    rlf_source *source = NULL;
    if (rlf_open_source(o.source, NULL, &source) != RLF_OK) {
        return command_not_opened("info");
    }
    rlf_result result = tell(&o, source);
    rlf_source_destroy(&source);
    if (result == RLF_NO_FRAME) {
        return command_stopped("info");
    }
    return result == RLF_OK ? EXIT_DONE : command_failed();
}
