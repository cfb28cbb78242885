/* `relief-lab eval`: every accuracy figure, both profiles side by side, against its goal and its
 * bound.
 */
#include "command.h"
#include "lab_commands.h"
#include "eval/bounds.h"
#include "eval/calibration/calibration.h"
#include "eval/oracle.h"
#include "eval/picture/picture.h"
#include "eval/random/random.h"
#include "eval/real/real.h"
#include "eval/real/run.h"
#include "eval/report.h"
#include "eval/run.h"
#include "eval/sections.h"
#include "eval/table.h"
#include "options.h"
#include "session.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PICTURE "picture" /* by itself with every method, on every frame */
#define PICTURE_FRAMES 100
#define SENSED "sensed" /* with --oracle its throws alone */

typedef struct eval_options {
    const char *section; /* NULL = all of them */
    const char *normals_path;
    const char *chessboards; /* folder; NULL = not asked for */
    const char *json_path;
    real_options real; /* folder NULL = not asked for */
    int64_t frames;    /* 0 = each scene's own */
    int64_t seeds, threads;
    int profile_mask;     /* bit of each rlf_profile */
    int32_t oracle;       /* bits of eval_oracle_part */
    int64_t rooms;        /* drawn at random */
    bool is_random;       /* only these */
    bool is_tuning;       /* their even seeds */
    bool is_bounded;      /* only what has bounds */
    const char *left_out; /* a scene or section; NULL = none */
    setting_list settings;
} eval_options;

/* One section with one seed; tasks run on different threads. */
typedef struct eval_task {
    const char *section;
    int64_t seed;
    const eval_options *options;
    eval_table *table;
    rlf_result result;
    char error[256];
} eval_task;

typedef struct task_list {
    eval_task *tasks;
    int32_t count;
} task_list;

typedef rlf_result (*section_fn)(eval_table *table, int64_t seed, int profile_mask);

typedef struct section {
    const char *name;
    section_fn run;
    const char *title;
} section;

/* Beside the synthetic scenes. */
static const section sections[] = {
    {PICTURE, eval_picture_run, "what hides bodies, at the colour camera"},
    {"simulator", eval_simulator_run, "the simulated sensor beside table 5.1 of the thesis"},
    {"planes", eval_planes_run, "planes without noise, and one with holes"},
    {"plate", eval_plate_run, "a moving plate before a still wall"},
    {"physics", eval_physics_run, "bodies in free flight, at rest, pushed and thrown"},
    {"known", eval_known_run, "models of known things: poses, what they hide, what hits them"},
    {"start", eval_start_run, "what stood starts to move, and carries or pushes bodies"},
    {"moving", eval_moving_run, "the camera moves: its pose against the map"},
    {"standing", eval_standing_run, "cameras that stand, and that are moved and put down"},
    {"memory", eval_memory_run, "the room behind people: per pixel, and from a map"},
    {"hands", eval_hands_run, "scripted hands grasp, carry and throw"},
    {"gestures", eval_gestures_run, "palms, finger tips and gestures of scripted hands"},
    {"calibration", eval_calibration_run, "cameras from pictures of a board, where they are known"},
    {"map", eval_map_run, "the room fused from a moving camera, against the true one"},
    {"map_cost", eval_map_cost_run, "CPU time of tracking and fusing a frame, memory of a room"},
    {SENSED, eval_sensed_run, "the same on what the sensor shows, against the true scene"},
};
#define SECTION_NAMES_MAX 64
#define SECTION_COUNT ((int)(sizeof(sections) / sizeof(sections[0])))

/* Rooms drawn at random: each is a task, with a seed of its own. */
static bool is_random_section(const char *name)
{
    return strcmp(name, EVAL_RANDOM) == 0 || strcmp(name, EVAL_RANDOM_PUSH) == 0;
}

static const section *find_section(const char *name)
{
    for (int i = 0; i < SECTION_COUNT; i++) {
        if (strcmp(sections[i].name, name) == 0) {
            return &sections[i];
        }
    }
    return NULL;
}

static void print_help(void)
{
    printf(
        "usage: relief-lab eval [OPTIONS]\n\n"
        "Measures accuracy where the truth is known, for both profiles: mean over the seeds with\n"
        "its 95 %% confidence interval, beside the goal. Exit status 1 when a figure of profile\n"
        "live is outside its bound.\n\n"
        "  --scene NAME      only this one, with every figure:\n");
    for (int32_t i = 0; i < eval_scene_count; i++) {
        printf("                      %-11s %s\n", eval_scenes[i].name, eval_scenes[i].title);
    }
    for (int i = 0; i < SECTION_COUNT; i++) {
        printf("                      %-11s %s\n", sections[i].name, sections[i].title);
    }
    printf(
        "                      random    rooms, people and sensors drawn at random\n"
        "                      push      in them, what stood there lifts, sweeps and carries\n"
        "  --random          the same as --scene random\n"
        "  --rooms N         drawn at random: seeds 1, 3, 5, ... of N rooms, default 20\n"
        "  --bounded         only scenes and sections with bounds: no rooms, no start\n"
        "  --without NAME    leave that scene or section out\n"
        "  --tune            seeds 2, 4, 6, ... instead: for tuning, never reported\n"
        "  --normals DIR     clean depth with true normals: folders of depth.bin, normal.png and\n"
        "                    params.txt (lab/measuring.md); only this unless --scene is given\n"
        "  --chessboards DIR left*.jpg and right*.jpg of a 9x6 board (OpenCV's 13 pairs); only "
        "this\n"
        "                    unless --scene is given\n"
        "  --real DIR        real recordings, each figure beside a simple baseline; only this\n"
        "                    unless --scene is given; skipped where there is no DIR\n"
        "  --silhouettes DIR what script/silhouettes made; default out/silhouettes\n"
        "  --seeds N         seeds 1..N of noise and throws, default 3\n"
        "  --frames N        frames per scene, default as long as its story\n"
        "  --profile NAME    live, thesis or both (default)\n"
        "  --set NAME=VALUE  a setting of the surface (see `relief list settings`) in place of "
        "the\n"
        "                    profiles', in the scenes (not in the sections)\n"
        "  --oracle LIST     what of the surface is the truth: in section sensed velocity,\n"
        "                    thickness, depth, normals, background, or all; in section picture\n"
        "                    depth, background, camera (depth as the colour camera sees it), "
        "pixels\n"
        "                    (each a body's or not, as its middle is); only profile live\n"
        "  --threads N       default 0 = one per processor\n"
        "  --json FILE       everything: seeds, values, means, intervals, goals, bounds\n\n"
        "examples:\n"
        "  relief-lab eval\n"
        "  relief-lab eval --scene chair --seeds 10 --json chair.json\n"
        "  relief-lab eval --normals path/to/frames\n"
        "  relief-lab eval --real path/to/clips --json real.json\n");
}

static bool take_profiles(const char *text, void *out)
{
    rlf_profile profile;
    bool is_both = strcmp(text, "both") == 0;
    bool is_one = !is_both && session_parse_profile(text, &profile);
    *(int *)out = is_one ? 1 << profile : 3;
    return is_both || is_one;
}

static bool take_scene(const char *text, void *out)
{
    *(const char **)out = text;
    return eval_scene_find(text) != NULL || find_section(text) != NULL || is_random_section(text);
}

/* -1, or an exit status when the section asked for has no such oracle. */
static int check_oracle(const eval_options *o)
{
    const char *name = o->section != NULL ? o->section : "";
    const int32_t of_picture =
        EVAL_ORACLE_DEPTH | EVAL_ORACLE_BACKGROUND | EVAL_ORACLE_CAMERA | EVAL_ORACLE_PIXELS;
    const int32_t known = strcmp(name, SENSED) == 0    ? EVAL_ORACLE_SURFACE
                          : strcmp(name, PICTURE) == 0 ? of_picture
                                                       : 0;
    return (o->oracle & ~known) == 0
               ? -1
               : command_usage("eval", "--oracle is for --scene " SENSED " (velocity, thickness, "
                                       "depth, normals, background) and " PICTURE
                                       " (depth, background, camera, pixels)");
}

/* Names of all scenes and sections, ended with NULL. */
static const char *const *section_names(void)
{
    static const char *names[SECTION_NAMES_MAX];
    int count = 0;
    for (int32_t i = 0; i < eval_scene_count && count < SECTION_NAMES_MAX - 2; i++) {
        names[count++] = eval_scenes[i].name;
    }
    for (int i = 0; i < SECTION_COUNT && count < SECTION_NAMES_MAX - 2; i++) {
        names[count++] = sections[i].name;
    }
    names[count++] = "random";
    return names;
}

static int parse(int argc, char **argv, eval_options *o)
{
    const char *const *names = section_names();
    *o = (eval_options){
        .seeds = 3, .profile_mask = 3, .rooms = 20, .real = {.silhouettes = "out/silhouettes"}};
    const option_def options[] = {
        {.name = "scene",
         .kind = OPTION_CHOICE,
         .out = &o->section,
         .take = take_scene,
         .choices = "is not one of them",
         .names = names},
        {.name = "without",
         .kind = OPTION_CHOICE,
         .out = &o->left_out,
         .take = take_scene,
         .choices = "is not one of them",
         .names = names},
        {.name = "normals", .kind = OPTION_TEXT, .out = &o->normals_path},
        {.name = "chessboards", .kind = OPTION_TEXT, .out = &o->chessboards},
        {.name = "real", .kind = OPTION_TEXT, .out = &o->real.folder},
        {.name = "silhouettes", .kind = OPTION_TEXT, .out = &o->real.silhouettes},
        {.name = "frames", .kind = OPTION_INT64, .out = &o->frames, .low = 20, .high = 100000},
        {.name = "seeds", .kind = OPTION_INT64, .out = &o->seeds, .low = 1, .high = EVAL_SEEDS_MAX},
        {.name = "rooms", .kind = OPTION_INT64, .out = &o->rooms, .low = 1, .high = EVAL_SEEDS_MAX},
        {.name = "random", .kind = OPTION_FLAG, .out = &o->is_random},
        {.name = "bounded", .kind = OPTION_FLAG, .out = &o->is_bounded},
        {.name = "tune", .kind = OPTION_FLAG, .out = &o->is_tuning},
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
        {.name = "threads", .kind = OPTION_INT64, .out = &o->threads, .low = 0, .high = 64},
        {.name = "json", .kind = OPTION_FILE, .out = &o->json_path, .choices = ".json"},
        {.name = "set", .kind = OPTION_SET, .out = &o->settings},
        {0},
    };
    int status = options_parse("eval", argc, argv, options, print_help);
    o->section = o->is_random ? EVAL_RANDOM : o->section;
    status = status < 0 ? check_oracle(o) : status;
    return status < 0 && argc != optind ? command_usage("eval", "takes no SOURCE") : status;
}

static rlf_result run_task(const eval_task *task)
{
    const eval_options *o = task->options;
    const eval_scene *scene = eval_scene_find(task->section);
    if (scene != NULL) {
        int64_t frames = o->frames > 0 ? o->frames : scene->frames;
        return eval_scene_run(task->table, scene, task->seed, frames, o->profile_mask,
                              &o->settings);
    }
    if (strcmp(task->section, EVAL_RANDOM) == 0) {
        return eval_random_run(task->table, task->seed, o->frames, &o->settings);
    }
    if (strcmp(task->section, EVAL_RANDOM_PUSH) == 0) {
        return eval_random_push_run(task->table, task->seed);
    }
    if (o->section != NULL && strcmp(o->section, PICTURE) == 0) {
        return eval_picture_run_whole(task->table, task->seed,
                                      o->frames > 0 ? o->frames : PICTURE_FRAMES, o->oracle,
                                      o->profile_mask);
    }
    if (o->oracle != 0) {
        return eval_sensed_run_oracle(task->table, task->seed, o->oracle);
    }
    return find_section(task->section)->run(task->table, task->seed, o->profile_mask);
}

/* From the end of the list, where the longest are, so that no thread is left with one of them. */
static void run_tasks(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const task_list *list = context;
    for (int32_t i = begin; i < end && !command_interrupted; i++) {
        eval_task *task = &list->tasks[list->count - 1 - i];
        task->result = run_task(task);
        if (task->result != RLF_OK) { /* the error line is the thread's own */
            snprintf(task->error, sizeof(task->error), "%s", rlf_error_text());
        }
        fprintf(stderr, "%s, seed %lld done\n", task->section, (long long)task->seed);
    }
}

/* Files are measured by themselves. */
static bool has_pictures(const eval_options *o)
{
    return o->normals_path != NULL || o->real.folder != NULL || o->chessboards != NULL;
}

/* In the order of the report. */
static int32_t list_tasks(const eval_options *o, eval_task *tasks)
{
    int32_t count = 0;
    for (int32_t s = 0; s < eval_scene_count + SECTION_COUNT; s++) {
        const char *name =
            s < eval_scene_count ? eval_scenes[s].name : sections[s - eval_scene_count].name;
        bool is_whole = !has_pictures(o);
        bool is_wanted = o->section != NULL ? strcmp(o->section, name) == 0
                                            : is_whole && (!o->is_bounded || eval_has_bounds(name));
        is_wanted = is_wanted && (o->left_out == NULL || strcmp(o->left_out, name) != 0);
        for (int64_t seed = 1; is_wanted && seed <= o->seeds; seed++) {
            tasks[count++] = (eval_task){.section = name, .seed = seed, .options = o};
        }
    }
    const bool has_rooms =
        o->section != NULL ? is_random_section(o->section) : !has_pictures(o) && !o->is_bounded;
    for (int32_t i = 0; has_rooms && i < o->rooms; i++) {
        tasks[count++] = (eval_task){.section = o->section != NULL ? o->section : EVAL_RANDOM,
                                     .seed = eval_random_seed(i, o->is_tuning),
                                     .options = o};
    }
    return count;
}

static rlf_result run_all(const eval_options *o, eval_task *tasks, int32_t count, eval_table *table)
{
    rlf_pool *pool = NULL;
    rlf_result result = rlf_pool_create((int32_t)o->threads, &pool);
    for (int32_t i = 0; i < count && result == RLF_OK; i++) {
        tasks[i].table = rlf_alloc(sizeof(*tasks[i].table));
        result = tasks[i].table != NULL ? RLF_OK : RLF_ERROR_MEMORY;
    }
    if (result == RLF_OK) {
        task_list list = {tasks, count};
        rlf_parallel_for(pool, count, 1, run_tasks, &list);
    }
    for (int32_t i = 0; i < count; i++) {
        if (result == RLF_OK && tasks[i].result != RLF_OK) {
            result = rlf_fail(tasks[i].result, "%s", tasks[i].error);
        }
        if (result == RLF_OK) {
            eval_table_merge(table, tasks[i].table);
        }
        rlf_free(tasks[i].table);
    }
    rlf_pool_destroy(&pool);
    return result;
}

static rlf_result measure(const eval_options *o, eval_table *table)
{
    size_t capacity =
        (size_t)(eval_scene_count + SECTION_COUNT) * (size_t)o->seeds + (size_t)o->rooms;
    eval_task *tasks = rlf_alloc_array(capacity, sizeof(*tasks));
    if (tasks == NULL) {
        return RLF_ERROR_MEMORY;
    }
    rlf_result result = run_all(o, tasks, list_tasks(o, tasks), table);
    rlf_free(tasks);
    if (result == RLF_OK && o->normals_path != NULL) {
        result = eval_public_run(table, o->normals_path, o->profile_mask);
    }
    if (result == RLF_OK && o->chessboards != NULL) {
        result = eval_chessboards_run(table, o->chessboards);
    }
    return result;
}

/* Measures and reports; the table of real recordings is empty unless it was asked for. */
static rlf_result run(const eval_options *o, eval_table *table, real_table *real,
                      int32_t *out_outside)
{
    rlf_result result = measure(o, table);
    if (result == RLF_OK && o->real.folder != NULL && !command_interrupted) {
        result = real_run(real, &o->real);
        real_add_headlines(real, table);
    }
    if (result != RLF_OK || command_interrupted) {
        return result;
    }
    eval_report_options report = {.print_all = o->section != NULL,
                                  .is_whole = o->frames == 0,
                                  .json_path = o->json_path,
                                  .seeds = o->seeds,
                                  .real = o->real.folder != NULL ? real : NULL};
    const bool is_random = o->section != NULL && is_random_section(o->section);
    report.print_all = report.print_all && !is_random;
    result = eval_report(table, &report, out_outside);
    eval_random_report(table, is_random ? o->section : EVAL_RANDOM, o->is_tuning);
    eval_columns_report(table);
    return result;
}

int eval_main(int argc, char **argv)
{
    eval_options options;
    int status = parse(argc, argv, &options);
    if (status >= 0) {
        return status;
    }
    if (options.json_path != NULL && rlf_file_check(options.json_path) != RLF_OK) {
        return command_failed();
    }
    eval_table *table = rlf_alloc(sizeof(*table));
    real_table *real = rlf_alloc(sizeof(*real));
    int32_t outside = 0;
    rlf_result result =
        table != NULL && real != NULL ? run(&options, table, real, &outside) : RLF_ERROR_MEMORY;
    bool is_full = result == RLF_OK && (table->is_full || real->is_full);
    rlf_free(table);
    rlf_free(real);
    if (command_interrupted) {
        return command_stopped("eval");
    }
    if (result != RLF_OK) {
        return command_failed();
    }
    return outside > 0 || is_full ? EXIT_FAILED : EXIT_DONE;
}
