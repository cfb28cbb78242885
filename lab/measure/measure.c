/* `relief-lab measure SOURCE`: thesis table 5.1 for any source. */
#include "command.h"
#include "lab_commands.h"
#include "measure/table.h"
#include "options.h"
#include "session.h"

#include <getopt.h>
#include <stdio.h>
#include <string.h>

typedef struct measure_options {
    const char *source;
    rlf_profile profile;
    int64_t frames; /* -1 = all */
    int32_t scales[MEASURE_SCALES_MAX];
    int32_t scale_count;
    setting_list settings;
    const char *csv_path, *json_path;
} measure_options;

static void print_help(void)
{
    printf(
        "usage: relief-lab measure SOURCE [OPTIONS]\n\n"
        "The experiment of the thesis's section 5.1.2 on any source: points per frame that the\n"
        "sensor did not deliver, averaged over the frames, in four cases:\n"
        "  a  whole scene, no moving object     c  whole scene, moving object\n"
        "  b  centre (77.59 %%), no moving object  d  centre, moving object\n"
        "with the thesis's estimate of wrong normals (4 per missing point), the counted share\n"
        "(missing or more than 30 deg off) where the source knows the truth, and the reasons.\n\n"
        "  --frames N        default: all frames of the source\n"
        "  --scale LIST      scale factors, default 8,1\n"
        "  --profile NAME    thesis (default) or live: whose normals are counted\n"
        "  --set NAME=VALUE  a setting of the surface (see `relief list settings`); any number\n"
        "  --csv FILE        the rows as CSV\n"
        "  --json FILE       the rows as JSON\n\n"
        "examples:\n"
        "  relief-lab measure synthetic:thesis\n"
        "  relief-lab measure path/to/clip --scale 8 --csv table.csv\n");
}

/* "8,1" into the scales of the measure_options. */
static bool take_scales(const char *text, void *out)
{
    measure_options *o = out;
    int64_t scales[MEASURE_SCALES_MAX];
    int count = 0;
    bool is_good = command_parse_list(text, 1, 64, MEASURE_SCALES_MAX, scales, &count);
    for (int i = 0; i < count; i++) {
        o->scales[i] = (int32_t)scales[i];
    }
    o->scale_count = count;
    return is_good;
}

static int parse(int argc, char **argv, measure_options *o)
{
    *o = (measure_options){
        .profile = RLF_PROFILE_THESIS, .frames = -1, .scales = {8, 1}, .scale_count = 2};
    const option_def options[] = {
        {.name = "frames", .kind = OPTION_INT64, .out = &o->frames, .low = 1, .high = 1000000000},
        {.name = "scale",
         .kind = OPTION_CHOICE,
         .out = o,
         .take = take_scales,
         .choices = "use up to 8 numbers from 1 to 64"},
        {.name = "profile", .kind = OPTION_PROFILE, .out = &o->profile},
        {.name = "csv", .kind = OPTION_FILE, .out = &o->csv_path, .choices = ".csv"},
        {.name = "json", .kind = OPTION_FILE, .out = &o->json_path, .choices = ".json"},
        {.name = "set", .kind = OPTION_SET, .out = &o->settings},
        {0},
    };
    int status = options_parse("measure", argc, argv, options, print_help);
    if (status >= 0) {
        return status;
    }
    if (argc - optind != 1) {
        return command_usage("measure", "needs one SOURCE");
    }
    if (o->frames >= 0 && o->frames < 6) {
        return command_usage("measure", "--frames %d: use 6 or more", (int)o->frames);
    }
    o->source = argv[optind];
    return -1;
}

static rlf_result measure_frames(const measure_options *o, session *s, measure_points *out)
{
    rlf_result result = RLF_OK;
    for (int64_t i = 0; (o->frames < 0 || i < o->frames) && !command_interrupted;) {
        rlf_pipeline_output frame;
        result = rlf_pipeline_step(s->pipeline, &frame);
        if (result == RLF_NO_FRAME) {
            continue;
        }
        if (result != RLF_OK) {
            break;
        }
        measure_points_add(out, frame.surface, rlf_source_get_truth(s->source), frame.frame.rig);
        i++;
    }
    return result == RLF_END ? RLF_OK : result;
}

/* Before the work, and once more with the source open, since what it reads is not written. */
static rlf_result check_files(const measure_options *o)
{
    rlf_result result = o->json_path != NULL ? rlf_file_check(o->json_path) : RLF_OK;
    return result == RLF_OK && o->csv_path != NULL ? rlf_file_check(o->csv_path) : result;
}

static rlf_result measure_scale(const measure_options *o, int32_t scale, measure_points *out)
{
    session_options options = session_options_default();
    options.source = o->source;
    options.profile = o->profile;
    options.scale_factor = scale;
    options.enable_render = false;
    options.settings = o->settings;
    session s;
    rlf_result result = session_open(&options, &s);
    if (result != RLF_OK) {
        return result;
    }
    if (rlf_source_get_info(s.source)->frame_count < 0 && o->frames < 0) {
        session_close(&s);
        return rlf_fail(RLF_ERROR_INVALID, "%s: has no end; add --frames N", o->source);
    }
    result = check_files(o);
    result = result == RLF_OK ? measure_frames(o, &s, out) : result;
    session_close(&s);
    if (result == RLF_OK && out->width == 0 && !command_interrupted) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: too few frames with depth; the first 5 are needed for the background",
                        o->source);
    }
    return result;
}

/* What the first reading of a source has said, the others need not say again. */
static void log_once(void *context, rlf_log_level level, const char *line)
{
    const int32_t *scale = context;
    if (level <= RLF_LOG_WARNING && *scale == 0) {
        fprintf(stderr, "relief: %s%s\n", level == RLF_LOG_WARNING ? "warning: " : "", line);
    }
}

static rlf_result measure_table(const measure_options *o)
{
    measure_points points[MEASURE_SCALES_MAX];
    memset(points, 0, sizeof(points));
    rlf_result result = RLF_OK;
    static int32_t i;
    rlf_set_log(log_once, &i);
    for (i = 0; i < o->scale_count && result == RLF_OK; i++) {
        result = measure_scale(o, o->scales[i], &points[i]);
    }
    measure_report report = {.source = o->source,
                             .profile = o->profile,
                             .scales = o->scales,
                             .points = points,
                             .count = o->scale_count};
    if (result != RLF_OK || command_interrupted) {
        return result;
    }
    measure_print(&report);
    if (o->csv_path != NULL) {
        result = measure_write_csv(&report, o->csv_path);
    }
    if (result == RLF_OK && o->json_path != NULL) {
        result = measure_write_json(&report, o->json_path);
    }
    return result;
}

int measure_main(int argc, char **argv)
{
    measure_options options;
    int status = parse(argc, argv, &options);
    if (status >= 0) {
        return status;
    }
    if (check_files(&options) != RLF_OK) {
        return command_failed();
    }
    const rlf_result result = measure_table(&options);
    if (command_interrupted) {
        return command_stopped("measure");
    }
    return result == RLF_OK ? EXIT_DONE : command_failed();
}
