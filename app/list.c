/* `relief list`: the sources, scenes and settings that there are to choose from. */
#include "command.h"
#include "options.h"
#include "relief/io.h"
#include "scene_files.h"
#include "settings.h"

#include <getopt.h>
#include <stdio.h>
#include <string.h>

#define DEVICES_MAX 64
#define KINDS_MAX 128
#define SOURCE_SIZE 64
#define COLUMNS 100

typedef struct kind_list {
    rlf_source_kind kinds[KINDS_MAX];
    int32_t count;
} kind_list;

static void print_help(void)
{
    printf("usage: relief list sources\n"
           "       relief list scenes\n"
           "       relief list settings [SOURCE] [OPTIONS]\n\n"
           "sources   cameras that are plugged in, and the kinds of source that this build can\n"
           "          open; what cannot be opened here has the reason and the cure\n"
           "scenes    that come with Relief: bodies and their motion, for --scene of run and\n"
           "          export, each with the source that it was made for\n"
           "settings  of the surface, for --set of run and export, with the values of both\n"
           "          profiles for SOURCE's camera (default synthetic:room)\n\n"
           "  --all             of settings: those of the laboratory, too\n"
           "%s\n"
           "examples:\n"
           "  relief list sources\n"
           "  relief list scenes\n"
           "  relief run synthetic:room --set depth_max_m=3\n",
           COMMAND_PLUGIN_HELP);
}

/* ---- sources -------------------------------------------------------------------------------- */

static int longer(size_t a, int b)
{
    return (int)a > b ? (int)a : b;
}

static void print_devices(void)
{
    static rlf_source_entry entries[DEVICES_MAX];
    const int32_t found = rlf_source_list(entries, DEVICES_MAX);
    const int32_t count = found < DEVICES_MAX ? found : DEVICES_MAX;
    int width = 0;
    for (int32_t i = 0; i < count; i++) {
        width = longer(strlen(entries[i].source), width);
    }
    printf("plugged in:\n");
    for (int32_t i = 0; i < count; i++) {
        printf("  %-*s  %s\n", width, entries[i].source, entries[i].description);
    }
    if (found > count) {
        printf("  and %d more\n", (int)(found - count));
    } else if (found == 0) {
        printf("  no camera that this build can use\n");
    }
}

static bool is_openable(const rlf_source_kind *kind)
{
    return kind->option == NULL;
}

static bool is_absent(const rlf_source_kind *kind)
{
    return kind->option != NULL;
}

/* How it is named on a command line. */
static void name_of(const rlf_source_kind *kind, char out[SOURCE_SIZE])
{
    const bool is_folder = strcmp(kind->scheme, "folder") == 0;
    snprintf(out, SOURCE_SIZE,
             is_folder       ? "FOLDER"
             : kind->is_live ? "%s:"
                             : "%s:FILE",
             kind->scheme);
}

static const char *or_dash(const char *text)
{
    return text != NULL ? text : "-";
}

/* Text from column `indent` on, in as many lines as it takes; the first one is begun already. */
static void print_wrapped(int indent, const char *before, const char *text)
{
    int column = indent + (int)strlen(before);
    printf("%s", before);
    while (*text != '\0') {
        const size_t length = strcspn(text, " ");
        if (column + (int)length > COLUMNS && column > indent) {
            printf("\n%*s", indent, "");
            column = indent;
        }
        printf("%.*s", (int)length, text);
        column += (int)length;
        text += length;
        if (*text == ' ') {
            text++;
            column++;
            printf(*text != '\0' && column + (int)strcspn(text, " ") <= COLUMNS ? " " : "");
        }
    }
    printf("\n");
}

static void print_below(int indent, const char *before, const char *text)
{
    if (text != NULL && text[0] != '\0') {
        printf("%*s", indent, "");
        print_wrapped(indent, before, text);
    }
}

/* Rows of those kinds for which `is_wanted`; what belongs to one row stands below it. */
static void print_kinds(const kind_list *list, bool (*is_wanted)(const rlf_source_kind *))
{
    int widths[2] = {(int)strlen("FOLDER"), 1};
    char name[SOURCE_SIZE];
    for (int32_t i = 0; i < list->count; i++) {
        name_of(&list->kinds[i], name);
        widths[0] = longer(strlen(name), widths[0]);
        widths[1] = longer(strlen(or_dash(list->kinds[i].extensions)), widths[1]);
    }
    const int indent = 2 + widths[0] + 2 + widths[1] + 2;
    for (int32_t i = 0; i < list->count; i++) {
        const rlf_source_kind *k = &list->kinds[i];
        if (!is_wanted(k)) {
            continue;
        }
        name_of(k, name);
        printf("  %-*s  %-*s  ", widths[0], name, widths[1], or_dash(k->extensions));
        print_wrapped(indent, "", or_dash(k->summary));
        print_below(indent, "keys: ", k->keys);
        if (k->plugin != NULL) {
            printf("%*splug-in %s\n", indent, "", k->plugin);
        }
        print_below(indent, is_absent(k) ? "to get it: " : "NOT HERE: ", k->unavailable);
    }
}

static bool has_any(const kind_list *list, bool (*is_wanted)(const rlf_source_kind *))
{
    for (int32_t i = 0; i < list->count; i++) {
        if (is_wanted(&list->kinds[i])) {
            return true;
        }
    }
    return false;
}

static void print_openable(const kind_list *list)
{
    printf("\ncan be opened (SOURCE, its files):\n");
    print_kinds(list, is_openable);
    printf(
        "  every recording takes ?key=value&...: camera=FILE (its calibration), loop=1, speed=X,\n"
        "  start=FRAME, count=N, drop=SHARE and seed=N (frames to lose), aligned=0|1\n"
        "  synthetic:NAME[?key=value&...]  a simulated room with ground truth\n"
        "    NAME: room, empty, thesis, chair, book, hand, lift, swipe, carry, crossing, random,\n"
        "    hands (keys: lab/measuring.md)\n"
        "    keys: seed, person (who it is; 1 = 1.75 m tall), frames, fps, speed, lamp (X,Y,Z),\n"
        "    noise (0|1|steps), edge_filter (0|1), color (WxH or 0), push "
        "(none|lift|swipe|carry),\n"
        "    path (none|orbit|walk|handheld|look_away|fast|carried|bump: how the camera moves;\n"
        "    opposite: it stands 5 m ahead and looks back)\n"
        "    random: room, people, camera and sensor drawn by the seed; with push something\n"
        "    that stood there is lifted, sweeps or carries at speed instead of people coming\n");
}

static int list_sources(void)
{
    static kind_list list;
    list.count = rlf_source_kind_list(list.kinds, KINDS_MAX);
    list.count = list.count < KINDS_MAX ? list.count : KINDS_MAX;
    print_devices();
    print_openable(&list);
    if (has_any(&list, is_absent)) {
        printf("\nthis build was made without:\n");
        print_kinds(&list, is_absent);
    }
    return EXIT_DONE;
}

/* ---- scenes and settings -------------------------------------------------------------------- */

static int list_scenes(void)
{
    static scene_entry entries[SCENES_MAX];
    const int32_t count = scene_files_list(entries, SCENES_MAX);
    int name = 0;
    int source = 0;
    if (count == 0) {
        fprintf(stderr, "relief list: no scene was installed with this command: give --scene a "
                        "file\n");
        return EXIT_FAILED;
    }
    for (int32_t i = 0; i < count; i++) {
        name = longer(strlen(entries[i].name), name);
        source = longer(strlen(entries[i].source), source);
    }
    for (int32_t i = 0; i < count; i++) {
        const scene_entry *e = &entries[i];
        printf("%-*s  %-*s  %s\n", name, e->name, source, e->source[0] != '\0' ? e->source : "any",
               e->about);
    }
    return EXIT_DONE;
}

static int list_settings(const char *source_name, bool lists_all)
{
    rlf_source *source = NULL;
    if (rlf_open_source(source_name, NULL, &source) != RLF_OK) {
        return command_failed();
    }
    settings_print(&rlf_source_get_info(source)->rig, lists_all);
    rlf_source_destroy(&source);
    return EXIT_DONE;
}

int list_main(int argc, char **argv)
{
    bool lists_all = false;
    const option_def options[] = {ROW_FLAG("all", &lists_all), ROW_PLUGIN, {0}};
    const int status = options_parse("list", argc, argv, options, print_help);
    if (status >= 0) {
        return status;
    }
    const char *what = optind < argc ? argv[optind] : "";
    const char *more = optind + 1 < argc ? argv[optind + 1] : NULL;
    const bool is_settings = strcmp(what, "settings") == 0;
    if (argc - optind > (is_settings ? 2 : 1)) {
        return command_usage("list", "takes no '%s'", is_settings ? argv[optind + 2] : more);
    }
    if (is_settings) {
        return list_settings(more != NULL ? more : "synthetic:room", lists_all);
    }
    if (strcmp(what, "sources") == 0) {
        return list_sources();
    }
    return strcmp(what, "scenes") == 0
               ? list_scenes()
               : command_usage("list", "'%s': use sources, scenes or settings", what);
}
