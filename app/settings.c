/* Settings of the surface stage by name: the table and their text forms. */
#include "settings.h"

#include "relief/io.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Words of an enum, from 0 on. */
static const char *const normal_words[] = {"six_faces", "four_faces", "thesis", "inverse_depth",
                                           NULL};
static const char *const background_words[] = {"off", "average", "adaptive", NULL};
static const char *const segment_words[] = {"off", "thesis", "noise", "objects", NULL};
static const char *const front_words[] = {"off", "thesis", "noise", NULL};
static const char *const switch_words[] = {"off", "on", NULL};

typedef enum kind { KIND_SWITCH, KIND_WORD, KIND_COUNT, KIND_NUMBER } kind;

typedef struct setting {
    const char *name;
    kind kind;
    size_t offset; /* in rlf_reconstruct_def */
    const char *const *words;
    const char *meaning;
    bool is_lab; /* a step of the method, to be turned off where its worth is measured */
} setting;

#define AT(member) offsetof(rlf_reconstruct_def, member)

static const setting table[] = {
    {"flying_removal", KIND_SWITCH, AT(enable_flying_removal), switch_words,
     "mixed pixels at edges are dropped", true},
    {"fill", KIND_SWITCH, AT(enable_fill), switch_words, "small holes are filled", true},
    {"smoothing", KIND_SWITCH, AT(enable_smoothing), switch_words, "depth is averaged in planes",
     true},
    {"wide_planes", KIND_SWITCH, AT(enable_wide_planes), switch_words,
     "and in wider ones where the sensor is rough", true},
    {"steadying", KIND_SWITCH, AT(enable_steadying), switch_words,
     "still depth is averaged over time", true},
    {"hold", KIND_SWITCH, AT(enable_hold), switch_words, "dropped pixels keep what was seen", true},
    {"edge_normals", KIND_SWITCH, AT(enable_edge_normals), switch_words,
     "normals of creases and outlines", true},
    {"velocity", KIND_SWITCH, AT(enable_velocity), switch_words, "velocity per pixel and region",
     true},
    {"thickness", KIND_SWITCH, AT(enable_thickness), switch_words, "thickness per pixel", true},
    {"coast", KIND_SWITCH, AT(enable_coast), switch_words, "thin things go on where they are lost",
     true},
    {"color_sides", KIND_SWITCH, AT(enable_color_sides), switch_words,
     "colour tells the sides of edges", true},
    {"dilation", KIND_SWITCH, AT(enable_dilation), switch_words, "regions grow as in fig. 4.12",
     true},
    {"normal_method", KIND_WORD, AT(normal_method), normal_words, "without smoothing", false},
    {"normals_face_camera", KIND_SWITCH, AT(normals_face_camera), switch_words,
     "on: n.p < 0; off: n_z < 0 as in eq. 4.3", false},
    {"background_method", KIND_WORD, AT(background_method), background_words,
     "how the background is known", false},
    {"background_frames", KIND_COUNT, AT(background_frames), NULL, "frames averaged at the start",
     false},
    {"absorb_after_s", KIND_NUMBER, AT(absorb_after_s), NULL,
     "seconds until what is still becomes background; 0 never", false},
    {"foreground_threshold_m", KIND_NUMBER, AT(foreground_threshold_m), NULL,
     "average: metres off the background", false},
    {"foreground_sigmas", KIND_NUMBER, AT(foreground_sigmas), NULL,
     "adaptive: sigmas before the background", false},
    {"foreground_min_m", KIND_NUMBER, AT(foreground_min_m), NULL, "adaptive: and metres", false},
    {"background_segment", KIND_WORD, AT(background_segment), segment_words,
     "regions of the background", false},
    {"foreground_segment", KIND_WORD, AT(foreground_segment), front_words,
     "regions of the foreground", false},
    {"segment_tau_m", KIND_NUMBER, AT(segment_tau_m), NULL, "eq. 4.4 threshold, metres", false},
    {"min_region_points", KIND_COUNT, AT(min_region_points), NULL, "smaller regions are dropped",
     false},
    {"region_capacity", KIND_COUNT, AT(region_capacity), NULL, "most regions of a frame", false},
    {"depth_min_m", KIND_NUMBER, AT(depth_min_m), NULL, "nearer is too near, metres", false},
    {"depth_max_m", KIND_NUMBER, AT(depth_max_m), NULL, "farther is too far, metres", false},
};
#define SETTING_COUNT ((int)(sizeof(table) / sizeof(table[0])))

static const setting *find(const char *text, size_t length)
{
    for (int i = 0; i < SETTING_COUNT; i++) {
        if (strlen(table[i].name) == length && strncmp(table[i].name, text, length) == 0) {
            return &table[i];
        }
    }
    return NULL;
}

/* Index of a word, -1 for none. */
static int32_t find_word(const char *const *words, const char *text)
{
    for (int32_t i = 0; words[i] != NULL; i++) {
        if (strcmp(words[i], text) == 0) {
            return i;
        }
    }
    return -1;
}

/* Writes a value into the def; false when the text is not one of the setting's. */
static bool put(const setting *t, const char *text, rlf_reconstruct_def *def)
{
    void *member = (char *)def + t->offset;
    if (t->words != NULL) {
        int32_t word = find_word(t->words, text);
        if (word >= 0 && t->kind == KIND_SWITCH) {
            *(bool *)member = word == 1;
        } else if (word >= 0) {
            *(int *)member = word; /* the enums count from 0 as their words do */
        }
        return word >= 0;
    }
    char *end = NULL;
    double number = strtod(text, &end);
    bool is_number = end != text && *end == '\0';
    if (t->kind == KIND_COUNT) {
        bool is_count = is_number && number >= 0 && number <= INT32_MAX && number == floor(number);
        *(int32_t *)member = is_count ? (int32_t)number : 0;
        return is_count;
    }
    *(double *)member = number;
    return is_number;
}

static rlf_result refuse_value(const setting *t, const char *value)
{
    char allowed[80] = "a number";
    size_t used = 0;
    for (int i = 0; t->words != NULL && t->words[i] != NULL; i++) {
        used += (size_t)snprintf(allowed + used, sizeof(allowed) - used, "%s%s",
                                 i > 0 ? " or " : "", t->words[i]);
    }
    return rlf_fail(RLF_ERROR_INVALID, "%s: '%s' is not %s", t->name, value,
                    t->kind == KIND_COUNT ? "a count" : allowed);
}

/* The names with `between` them, into `out`. */
static void join_names(const char *between, char out[1024])
{
    out[0] = '\0';
    for (int i = 0; i < SETTING_COUNT; i++) {
        const size_t used = strlen(out);
        (void)snprintf(out + used, 1024 - used, "%s%s", i > 0 ? between : "", table[i].name);
    }
}

static rlf_result refuse_name(const char *text)
{
    char name[64];
    char nearest[64];
    char names[1024];
    const size_t length = strcspn(text, "=");
    if (text[length] == '\0') {
        return rlf_fail(RLF_ERROR_INVALID,
                        "'%s': use NAME=VALUE, as `relief list settings` lists them", text);
    }
    (void)snprintf(name, sizeof(name), "%.*s", (int)length, text);
    join_names(" ", names);
    if (rlf_word_nearest(names, name, nearest, sizeof(nearest))) {
        return rlf_fail(
            RLF_ERROR_INVALID,
            "there is no setting '%s': did you mean '%s'? `relief list settings` lists all", name,
            nearest);
    }
    join_names(", ", names);
    return rlf_fail(RLF_ERROR_INVALID,
                    "there is no setting '%s': `relief list settings` tells of %s", name, names);
}

rlf_result settings_add(setting_list *s, const char *text)
{
    const char *equals = strchr(text, '=');
    const setting *t = equals != NULL ? find(text, (size_t)(equals - text)) : NULL;
    if (t == NULL) {
        return refuse_name(text);
    }
    rlf_reconstruct_def scratch;
    if (!put(t, equals + 1, &scratch)) {
        return refuse_value(t, equals + 1);
    }
    if (s->count == SETTINGS_MAX) {
        return rlf_fail(RLF_ERROR_INVALID, "'%s': more than %d settings", text, SETTINGS_MAX);
    }
    s->texts[s->count++] = text;
    return RLF_OK;
}

void settings_apply(const setting_list *s, rlf_reconstruct_def *def)
{
    for (int32_t i = 0; i < s->count; i++) {
        const char *equals = strchr(s->texts[i], '=');
        put(find(s->texts[i], (size_t)(equals - s->texts[i])), equals + 1, def);
    }
}

static bool has_smoothing(const rlf_reconstruct_def *def)
{
    return def->enable_smoothing;
}

static bool has_steadying(const rlf_reconstruct_def *def)
{
    return def->enable_steadying;
}

static bool can_coast(const rlf_reconstruct_def *def)
{
    return def->enable_thickness && def->enable_velocity;
}

static bool has_color_to_fill(const rlf_reconstruct_def *def)
{
    return def->enable_fill && def->rig.has_color;
}

static bool is_average(const rlf_reconstruct_def *def)
{
    return def->background_method == RLF_BACKGROUND_AVERAGE;
}

static bool is_adaptive(const rlf_reconstruct_def *def)
{
    return def->background_method == RLF_BACKGROUND_ADAPTIVE;
}

static bool has_background(const rlf_reconstruct_def *def)
{
    return def->background_method != RLF_BACKGROUND_OFF;
}

static bool segments_as_thesis(const rlf_reconstruct_def *def)
{
    return def->background_segment == RLF_SEGMENT_THESIS ||
           def->foreground_segment == RLF_SEGMENT_THESIS;
}

static bool segments(const rlf_reconstruct_def *def)
{
    return def->background_segment != RLF_SEGMENT_OFF || def->foreground_segment != RLF_SEGMENT_OFF;
}

/* What a setting counts with only; a setting that is not here always counts. */
typedef struct need {
    const char *name;
    bool (*holds)(const rlf_reconstruct_def *def);
    const char *text;
} need;

static const need needs[] = {
    {"wide_planes", has_smoothing, "smoothing=on"},
    {"hold", has_steadying, "steadying=on"},
    {"edge_normals", has_smoothing, "smoothing=on"},
    {"coast", can_coast, "thickness=on and velocity=on"},
    {"color_sides", has_color_to_fill, "fill=on and a colour picture"},
    {"dilation", segments_as_thesis, "background_segment=thesis or foreground_segment=thesis"},
    {"background_frames", has_background, "a background_method other than off"},
    {"absorb_after_s", is_adaptive, "background_method=adaptive"},
    {"foreground_threshold_m", is_average, "background_method=average"},
    {"foreground_sigmas", is_adaptive, "background_method=adaptive"},
    {"foreground_min_m", is_adaptive, "background_method=adaptive"},
    {"segment_tau_m", segments_as_thesis, "background_segment=thesis or foreground_segment=thesis"},
    {"min_region_points", segments, "a background_segment or foreground_segment"},
};
#define NEED_COUNT ((int)(sizeof(needs) / sizeof(needs[0])))

const char *settings_need(const char *text, const rlf_reconstruct_def *def)
{
    size_t length = (size_t)(strchr(text, '=') - text);
    for (int i = 0; i < NEED_COUNT; i++) {
        const need *n = &needs[i];
        if (strlen(n->name) == length && strncmp(n->name, text, length) == 0) {
            return n->holds(def) ? NULL : n->text;
        }
    }
    return NULL;
}

void settings_warn(const setting_list *s, const rlf_reconstruct_def *def)
{
    for (int32_t i = 0; i < s->count; i++) {
        const char *text = settings_need(s->texts[i], def);
        if (text != NULL) {
            rlf_log(RLF_LOG_WARNING, "--set %s has no effect here: it needs %s", s->texts[i], text);
        }
    }
}

/* A setting's value as `--set` takes it. */
static const char *get(const setting *t, const rlf_reconstruct_def *def, char text[32])
{
    const void *member = (const char *)def + t->offset;
    switch (t->kind) {
    case KIND_SWITCH: return t->words[*(const bool *)member ? 1 : 0];
    case KIND_WORD: return t->words[*(const int *)member];
    case KIND_COUNT: snprintf(text, 32, "%d", (int)*(const int32_t *)member); return text;
    default: snprintf(text, 32, "%.4g", *(const double *)member); return text;
    }
}

void settings_print(const rlf_rig *rig, bool prints_all)
{
    rlf_reconstruct_def live = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, rig);
    rlf_reconstruct_def thesis = rlf_reconstruct_def_default(RLF_PROFILE_THESIS, rig);
    printf("%-23s %-14s %-14s %s\n", "name", "live", "thesis", "meaning");
    for (int i = 0; i < SETTING_COUNT; i++) {
        char a[32], b[32];
        if (table[i].is_lab && !prints_all) {
            continue;
        }
        printf("%-23s %-14s %-14s %s", table[i].name, get(&table[i], &live, a),
               get(&table[i], &thesis, b), table[i].meaning);
        for (int k = 0; table[i].kind == KIND_WORD && table[i].words[k] != NULL; k++) {
            printf("%s%s", k > 0 ? ", " : ": ", table[i].words[k]);
        }
        printf("\n");
    }
}

int32_t settings_count(void)
{
    return SETTING_COUNT;
}

void settings_look(int32_t index, const rlf_reconstruct_def *def, setting_view *out)
{
    const setting *t = &table[index];
    char text[64];
    char value[32];
    *out = (setting_view){.name = t->name,
                          .meaning = t->meaning,
                          .words = t->words,
                          .is_switch = t->kind == KIND_SWITCH};
    snprintf(out->value, sizeof(out->value), "%s", get(t, def, value));
    snprintf(text, sizeof(text), "%s=", t->name);
    out->need = settings_need(text, def);
}
