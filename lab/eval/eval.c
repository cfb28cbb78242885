/* `relief-lab eval` runs each section by this, one seed and process at a time: its rows as text.
 *
 * A line is "row", scene, key, title, profile and value, or "real" and a figure of real clips, with
 * tabs between. Goals, bounds and means are Python's: lab/relief_lab. */
#include "command.h"
#include "eval/calibration/calibration.h"
#include "eval/oracle.h"
#include "eval/picture/picture.h"
#include "eval/random/random.h"
#include "eval/real/real.h"
#include "eval/real/run.h"
#include "eval/sections.h"
#include "eval/table.h"
#include "lab_commands.h"
#include "json_file.h"
#include "options.h"
#include "session.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct eval_options {
    const char *section;
    const char *folder; /* of files that are measured */
    const char *silhouettes;
    int64_t seed, frames; /* frames 0 = the section's own */
    int profile_mask;     /* bit of each rlf_profile */
    int32_t oracle;       /* bits of eval_oracle_part */
    bool is_whole;        /* section picture: every method on every frame */
    setting_list settings;
} eval_options;

typedef rlf_result (*section_fn)(eval_table *table, int64_t seed, int profile_mask);

static const struct {
    const char *name;
    section_fn run;
} sections[] = {
    {"picture", eval_picture_run},
    {"physics", eval_physics_run},
    {"known", eval_known_run},
    {"moving", eval_moving_run},
    {"standing", eval_standing_run},
    {"hands", eval_hands_run},
    {"gestures", eval_gestures_run},
    {"grasps", eval_grasps_run},
    {"calibration", eval_calibration_run},
    {"map", eval_map_run},
    {"sensed", eval_sensed_run},
};

static void print_help(void)
{
    printf(
        "usage: relief-lab-sections eval SECTION [OPTIONS]\n\n"
        "One section of relief-lab eval with one seed, its rows as text; \"machine\" tells what\n"
        "it runs on. The options are those of relief-lab eval but\n"
        "  --seed N          of noise and throws\n"
        "  --folder DIR      the files of sections chessboards and real\n"
        "  --whole           section picture: every method on every frame\n");
}

static bool take_profiles(const char *text, void *out)
{
    rlf_profile profile;
    const bool is_both = strcmp(text, "both") == 0;
    const bool is_one = !is_both && session_parse_profile(text, &profile);
    *(int *)out = is_one ? 1 << profile : 3;
    return is_both || is_one;
}

static int parse(int argc, char **argv, eval_options *o)
{
    *o = (eval_options){.seed = 1, .profile_mask = 3, .silhouettes = "out/silhouettes"};
    const option_def options[] = {
        {.name = "folder", .kind = OPTION_TEXT, .out = &o->folder},
        {.name = "silhouettes", .kind = OPTION_TEXT, .out = &o->silhouettes},
        {.name = "frames", .kind = OPTION_INT64, .out = &o->frames, .low = 0, .high = 100000},
        {.name = "seed", .kind = OPTION_INT64, .out = &o->seed, .low = 1, .high = INT32_MAX},
        {.name = "whole", .kind = OPTION_FLAG, .out = &o->is_whole},
        {.name = "profile",
         .kind = OPTION_CHOICE,
         .out = &o->profile_mask,
         .take = take_profiles,
         .choices = "use live, thesis or both"},
        {.name = "oracle",
         .kind = OPTION_CHOICE,
         .out = &o->oracle,
         .take = eval_oracle_parse,
         .choices = "list some of velocity,thickness,depth,normals,background,camera,pixels, or "
                    "all"},
        {.name = "set", .kind = OPTION_SET, .out = &o->settings},
        {0},
    };
    const int status = options_parse("eval", argc, argv, options, print_help);
    if (status < 0 && argc != optind + 1) {
        return command_usage("eval", "needs one SECTION");
    }
    o->section = status < 0 ? argv[optind] : NULL;
    return status;
}

static rlf_result run_named(const eval_options *o, eval_table *table, real_table *real)
{
    if (strcmp(o->section, EVAL_RANDOM) == 0) {
        return eval_random_run(table, o->seed);
    }
    if (strcmp(o->section, EVAL_RANDOM_PUSH) == 0) {
        return eval_random_push_run(table, o->seed);
    }
    if (strcmp(o->section, "chessboards") == 0 && o->folder != NULL) {
        return eval_chessboards_run(table, o->folder);
    }
    if (strcmp(o->section, "real") == 0 && o->folder != NULL) {
        const real_options options = {.folder = o->folder, .silhouettes = o->silhouettes};
        return real_run(real, &options);
    }
    for (size_t i = 0; i < sizeof(sections) / sizeof(sections[0]); i++) {
        if (strcmp(sections[i].name, o->section) == 0) {
            return sections[i].run(table, o->seed, o->profile_mask);
        }
    }
    return rlf_fail(RLF_ERROR_INVALID, "%s: is no section, or needs --folder", o->section);
}

static rlf_result run(const eval_options *o, eval_table *table, real_table *real)
{
    if (o->is_whole && strcmp(o->section, "picture") == 0) {
        return eval_picture_run_whole(table, o->seed, o->frames, o->oracle, o->profile_mask);
    }
    if (o->oracle != 0 && strcmp(o->section, "sensed") == 0) {
        return eval_sensed_run_oracle(table, o->seed, o->oracle);
    }
    return run_named(o, table, real);
}

static void print_rows(const eval_table *table, const real_table *real)
{
    for (int32_t i = 0; i < table->count; i++) {
        const eval_row *row = &table->rows[i];
        for (int profile = 0; profile < EVAL_PROFILES; profile++) {
            for (int32_t k = 0; k < row->count[profile]; k++) {
                printf("row\t%s\t%s\t%s\t%s\t%.17g\n", row->scene, row->key, row->title,
                       profile == RLF_PROFILE_LIVE ? "live" : "thesis", row->values[profile][k]);
            }
        }
    }
    for (int32_t i = 0; i < real->count; i++) {
        const real_row *row = &real->rows[i];
        printf("real\t%s\t%s\t%s\t%s\t%.17g\t%.17g\t%.17g\t%s\n", row->part, row->key, row->title,
               row->relation == '<' ? "<=" : ">=", row->goal, row->relief, row->baseline,
               row->baseline_name);
    }
}

static int print_machine(void)
{
    char *text = json_dumps(machine_json(), JSON_COMPACT);
    printf("%s\n", text != NULL ? text : "{}");
    free(text);
    return EXIT_DONE;
}

int eval_main(int argc, char **argv)
{
    eval_options options;
    const int status = parse(argc, argv, &options);
    if (status >= 0) {
        return status;
    }
    if (strcmp(options.section, "machine") == 0) {
        return print_machine();
    }
    eval_table *table = rlf_alloc(sizeof(*table));
    real_table *real = rlf_alloc(sizeof(*real));
    rlf_result result =
        table != NULL && real != NULL ? run(&options, table, real) : RLF_ERROR_MEMORY;
    if (result == RLF_OK && (table->is_full || real->is_full)) {
        result = rlf_fail(RLF_ERROR_CAPACITY, "%s: has more figures than a table", options.section);
    }
    if (result == RLF_OK && !command_interrupted) {
        print_rows(table, real);
    }
    rlf_free(table);
    rlf_free(real);
    return command_interrupted ? command_stopped("eval")
           : result == RLF_OK  ? EXIT_DONE
                               : command_failed();
}
