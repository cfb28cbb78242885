/* `relief measure SOURCE`: thesis table 5.1 for any source. */
#include "command.h"
#include "measure/noise.h"
#include "measure/points.h"
#include "session.h"

#include <getopt.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SCALES_MAX 8

typedef struct measure_options {
    const char *source;
    rlf_profile profile;
    setting_list settings;
    int64_t frames; /* -1 = all */
    int32_t scales[SCALES_MAX];
    int scale_count;
    const char *csv_path, *json_path;
    bool noise; /* the sensor's noise instead of the table */
} measure_options;

static void print_help(void)
{
    printf(
        "usage: relief measure SOURCE [OPTIONS]\n\n"
        "The experiment of the thesis's section 5.1.2 on any source: points per frame that the\n"
        "sensor did not deliver, averaged over the frames, in four cases:\n"
        "  a  whole scene, no moving object     c  whole scene, moving object\n"
        "  b  centre (77.59 %%), no moving object  d  centre, moving object\n"
        "with the thesis's estimate of wrong normals (4 per missing point), the counted share\n"
        "(missing or more than 30 deg off) where the source knows the truth, and the reasons.\n\n"
        "  --frames N        default: all frames of the source\n"
        "  --scale LIST      scale factors, default 8,1\n"
        "  --profile NAME    thesis (default) or live: whose normals are counted\n"
        "  --set NAME=VALUE  a setting of the surface (see `relief settings`); any number\n"
        "  --csv FILE        the rows as CSV\n"
        "  --json FILE       the rows as JSON\n"
        "  --noise           instead: the sensor's noise by distance, of a still scene\n\n"
        "examples:\n"
        "  relief measure synthetic:thesis\n"
        "  relief measure path/to/clip --scale 8 --csv table.csv\n"
        "  relief measure path/to/clip --noise --frames 30\n");
}

static const struct option long_options[] = {
    {"frames", required_argument, NULL, 'f'},
    {"scale", required_argument, NULL, 's'},
    {"profile", required_argument, NULL, 'p'},
    {"csv", required_argument, NULL, 'c'},
    {"json", required_argument, NULL, 'j'},
    {"noise", no_argument, NULL, 'n'},
    {"set", required_argument, NULL, 'o'},
    {"help", no_argument, NULL, 'h'},
    {0},
};

static bool parse_scales(const char *text, measure_options *o)
{
    o->scale_count = 0;
    for (const char *rest = text; o->scale_count < SCALES_MAX;) {
        char number[8];
        size_t length = strcspn(rest, ",");
        int64_t scale;
        if (length == 0 || length >= sizeof(number)) {
            return false;
        }
        memcpy(number, rest, length);
        number[length] = '\0';
        if (!command_parse_int(number, 1, 64, &scale)) {
            return false;
        }
        o->scales[o->scale_count++] = (int32_t)scale;
        if (rest[length] == '\0') {
            return true;
        }
        rest += length + 1;
    }
    return false;
}

/* Returns -1 to go on, or an exit status. */
static int take_option(int option, measure_options *o)
{
    switch (option) {
    case 'c': o->csv_path = optarg; return -1;
    case 'j': o->json_path = optarg; return -1;
    case 'n': o->noise = true; return -1;
    case 'f':
        return command_parse_int(optarg, 1, 1000000000, &o->frames)
                   ? -1
                   : command_usage("measure", "--frames '%s': use 1 or more", optarg);
    case 's':
        return parse_scales(optarg, o)
                   ? -1
                   : command_usage("measure", "--scale '%s': use up to %d numbers from 1 to 64",
                                   optarg, SCALES_MAX);
    case 'p':
        return session_parse_profile(optarg, &o->profile)
                   ? -1
                   : command_usage("measure", "--profile '%s': use live or thesis", optarg);
    case 'o': return command_set("measure", &o->settings, optarg);
    case 'h': print_help(); return EXIT_DONE;
    default: return EXIT_USAGE;
    }
}

static int parse(int argc, char **argv, measure_options *o)
{
    *o = (measure_options){
        .profile = RLF_PROFILE_THESIS, .frames = -1, .scales = {8, 1}, .scale_count = 2};
    int option;
    while ((option = getopt_long(argc, argv, "h", long_options, NULL)) != -1) {
        int status = take_option(option, o);
        if (status >= 0) {
            return status;
        }
    }
    if (argc - optind != 1) {
        return command_usage("measure", "needs one SOURCE");
    }
    if (!o->noise && o->frames >= 0 && o->frames < 6) {
        return command_usage("measure", "--frames %d: use 6 or more", (int)o->frames);
    }
    if (o->noise && o->csv_path != NULL) {
        return command_usage("measure", "--noise writes no CSV; use --json");
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

static rlf_result measure_scale(const measure_options *o, int32_t scale, measure_points *out)
{
    session_options options = session_options_default();
    options.source = o->source;
    options.profile = o->profile;
    options.settings = o->settings;
    options.scale_factor = scale;
    options.enable_render = false;
    session s;
    rlf_result result = session_open(&options, &s);
    if (result != RLF_OK) {
        return result;
    }
    if (rlf_source_get_info(s.source)->frame_count < 0 && o->frames < 0) {
        session_close(&s);
        return rlf_fail(RLF_ERROR_INVALID, "%s: has no end; add --frames N", o->source);
    }
    result = measure_frames(o, &s, out);
    session_close(&s);
    if (result == RLF_OK && out->width == 0 && !command_interrupted) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: too few frames; the first 5 are needed for the background", o->source);
    }
    return result;
}

static void print_row(const measure_points *m, int32_t scale, measure_case index)
{
    const measure_counts *c = &m->cases[index];
    char grid[24], counted[16];
    snprintf(grid, sizeof(grid), "%dx%d", (int)m->width, (int)m->height);
    snprintf(counted, sizeof(counted), measure_counted_percent(c) < 0.0 ? "-" : "%.2f",
             measure_counted_percent(c));
    printf("%5d %9s %4s %6lld %7lld %10.3f %7.2f %9.2f %8s  ", (int)scale, grid,
           measure_case_name(index), (long long)c->frames, (long long)c->points, measure_missing(c),
           measure_missing_percent(c), measure_estimated_percent(c), counted);
    for (int r = 1; r < RLF_REASON_COUNT; r++) {
        if (c->reasons[r] > 0) {
            printf(" %s %.1f", rlf_reason_name((rlf_reason)r),
                   (double)c->reasons[r] / (double)c->frames);
        }
    }
    printf("\n");
}

static void print_table(const measure_options *o, const measure_points *rows)
{
    printf("%s, profile %s; missing points per frame, averaged\n", o->source,
           o->profile == RLF_PROFILE_LIVE ? "live" : "thesis");
    printf("%5s %9s %4s %6s %7s %10s %7s %9s %8s   %s\n", "scale", "grid", "case", "frames",
           "points", "missing", "%", "est. bad", "bad %", "by reason, per frame");
    for (int i = 0; i < o->scale_count; i++) {
        for (int c = 0; c < MEASURE_CASE_COUNT; c++) {
            print_row(&rows[i], o->scales[i], (measure_case)c);
        }
    }
    printf("the thesis (table 5.1, 64x53): a 165.468, b 15.548, c 188.573, d 57.113; its estimate "
           "of wrong\nnormals in d is 8.67 %%\n");
}

static rlf_result write_csv(const measure_options *o, const measure_points *rows)
{
    FILE *file = fopen(o->csv_path, "w");
    if (file == NULL) {
        return rlf_fail(RLF_ERROR_IO, "%s: cannot be written; choose another --csv file",
                        o->csv_path);
    }
    fprintf(file, "scale,width,height,case,frames,points,missing,missing_percent,"
                  "estimated_bad_percent,counted_bad_percent");
    for (int r = 0; r < RLF_REASON_COUNT; r++) {
        fprintf(file, ",reason_%d", r);
    }
    fprintf(file, "\n");
    for (int i = 0; i < o->scale_count; i++) {
        for (int k = 0; k < MEASURE_CASE_COUNT; k++) {
            const measure_counts *c = &rows[i].cases[k];
            double counted = measure_counted_percent(c);
            fprintf(file, "%d,%d,%d,%s,%lld,%lld,%.9g,%.9g,%.9g,", (int)o->scales[i],
                    (int)rows[i].width, (int)rows[i].height, measure_case_name((measure_case)k),
                    (long long)c->frames, (long long)c->points, measure_missing(c),
                    measure_missing_percent(c), measure_estimated_percent(c));
            if (counted >= 0.0) {
                fprintf(file, "%.9g", counted);
            }
            for (int r = 0; r < RLF_REASON_COUNT; r++) {
                fprintf(file, ",%.9g",
                        c->frames > 0 ? (double)c->reasons[r] / (double)c->frames : 0.0);
            }
            fprintf(file, "\n");
        }
    }
    bool is_bad = ferror(file) != 0;
    is_bad = fclose(file) != 0 || is_bad;
    return is_bad ? rlf_fail(RLF_ERROR_IO, "%s: write failed; is the disk full?", o->csv_path)
                  : RLF_OK;
}

static json_t *case_json(const measure_points *m, int32_t scale, measure_case index)
{
    const measure_counts *c = &m->cases[index];
    json_t *reasons = json_object();
    for (int r = 0; r < RLF_REASON_COUNT; r++) {
        double mean = c->frames > 0 ? (double)c->reasons[r] / (double)c->frames : 0.0;
        json_object_set_new(reasons, rlf_reason_name((rlf_reason)r), json_real(mean));
    }
    double counted = measure_counted_percent(c);
    return json_pack("{s:i, s:i, s:i, s:s, s:I, s:I, s:f, s:f, s:f, s:o, s:o}", "scale", (int)scale,
                     "width", (int)m->width, "height", (int)m->height, "case",
                     measure_case_name(index), "frames", (json_int_t)c->frames, "points",
                     (json_int_t)c->points, "missing", measure_missing(c), "missing_percent",
                     measure_missing_percent(c), "estimated_bad_percent",
                     measure_estimated_percent(c), "counted_bad_percent",
                     counted < 0.0 ? json_null() : json_real(counted), "reasons", reasons);
}

static rlf_result write_json(const measure_options *o, const measure_points *rows)
{
    json_t *cases = json_array();
    for (int i = 0; i < o->scale_count; i++) {
        for (int c = 0; c < MEASURE_CASE_COUNT; c++) {
            json_array_append_new(cases, case_json(&rows[i], o->scales[i], (measure_case)c));
        }
    }
    json_t *root = json_pack("{s:s, s:s, s:o}", "source", o->source, "profile",
                             o->profile == RLF_PROFILE_LIVE ? "live" : "thesis", "rows", cases);
    int failed = json_dump_file(root, o->json_path, JSON_INDENT(2));
    json_decref(root);
    return failed ? rlf_fail(RLF_ERROR_IO, "%s: cannot be written; choose another --json file",
                             o->json_path)
                  : RLF_OK;
}

int measure_main(int argc, char **argv)
{
    measure_options options;
    int status = parse(argc, argv, &options);
    if (status >= 0) {
        return status;
    }
    if (options.noise) {
        rlf_result noise = measure_noise_run(options.source, options.frames, options.json_path);
        return noise == RLF_OK ? EXIT_DONE : command_failed();
    }
    measure_points rows[SCALES_MAX];
    memset(rows, 0, sizeof(rows));
    rlf_result result = RLF_OK;
    for (int i = 0; i < options.scale_count && result == RLF_OK; i++) {
        result = measure_scale(&options, options.scales[i], &rows[i]);
    }
    if (result == RLF_OK) {
        print_table(&options, rows);
    }
    if (result == RLF_OK && options.csv_path != NULL) {
        result = write_csv(&options, rows);
    }
    if (result == RLF_OK && options.json_path != NULL) {
        result = write_json(&options, rows);
    }
    return result == RLF_OK ? EXIT_DONE : command_failed();
}
