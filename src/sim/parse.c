/* "synthetic:NAME[?key=value[&key=value...]]" */
#include "sim/sensor.h"

#include <string.h>

#define PREFIX "synthetic:"
#define SCENES "room, empty, thesis, chair, book, hand, lift, swipe, carry, crossing, random, hands"
#define KEYS                                                                                       \
    "seed, person, frames, fps, speed, lamp, noise, edge_filter, color, push, grasp, gesture, "    \
    "view, "                                                                                       \
    "distance, body, size, hold, path"

/* A piece of the source string. */
typedef struct piece {
    const char *text;
    size_t length;
} piece;

static bool is_word(piece p, const char *word)
{
    return strlen(word) == p.length && memcmp(p.text, word, p.length) == 0;
}

static piece until(const char *text, const char *stops)
{
    piece p = {text, strcspn(text, stops)};
    return p;
}

/* Decimal digits only, at most `max`. */
static bool read_integer(piece p, uint64_t max, uint64_t *out)
{
    uint64_t value = 0;
    for (size_t i = 0; i < p.length; i++) {
        if (p.text[i] < '0' || p.text[i] > '9') {
            return false;
        }
        uint64_t digit = (uint64_t)(p.text[i] - '0');
        if (value > (max - digit) / 10) {
            return false;
        }
        value = 10 * value + digit;
    }
    *out = value;
    return p.length > 0;
}

/* Digits with an optional decimal point. */
static bool read_decimal(piece p, double *out)
{
    const char *point = memchr(p.text, '.', p.length);
    piece whole = {p.text, point != NULL ? (size_t)(point - p.text) : p.length};
    uint64_t value = 0;
    if (!read_integer(whole, 1000000, &value)) {
        return false;
    }
    *out = (double)value;
    if (point == NULL) {
        return true;
    }
    piece rest = {point + 1, p.length - whole.length - 1};
    double scale = 1.0;
    for (size_t i = 0; i < rest.length && i < 9; i++) {
        scale *= 10.0;
    }
    rest.length = rest.length < 9 ? rest.length : 9;
    bool is_number = read_integer(rest, 999999999, &value);
    *out += (double)value / scale;
    return is_number;
}

/* As read_decimal, but it may be negative. */
static bool read_signed(piece p, double *out)
{
    bool is_negative = p.length > 0 && p.text[0] == '-';
    piece digits = {p.text + (is_negative ? 1 : 0), p.length - (is_negative ? 1 : 0)};
    bool is_number = read_decimal(digits, out);
    *out = is_negative ? -*out : *out;
    return is_number;
}

/* Three numbers with commas between. */
static bool read_point(piece p, rlf_vec3 *out)
{
    double *parts[3] = {&out->x, &out->y, &out->z};
    for (int i = 0; i < 3; i++) {
        const char *comma = i < 2 ? memchr(p.text, ',', p.length) : p.text + p.length;
        if (comma == NULL) {
            return false;
        }
        piece number = {p.text, (size_t)(comma - p.text)};
        if (!read_signed(number, parts[i])) {
            return false;
        }
        p.length -= number.length + (i < 2 ? 1 : 0);
        p.text = i < 2 ? comma + 1 : comma;
    }
    return true;
}

static bool read_size(piece p, rlf_synthetic_def *def)
{
    if (is_word(p, "0")) {
        def->enable_color = false;
        return true;
    }
    const char *cross = memchr(p.text, 'x', p.length);
    if (cross == NULL) {
        return false;
    }
    piece left = {p.text, (size_t)(cross - p.text)};
    piece right = {cross + 1, p.length - left.length - 1};
    uint64_t width = 0;
    uint64_t height = 0;
    if (!read_integer(left, 4096, &width) || !read_integer(right, 4096, &height) || width == 0 ||
        height == 0) {
        return false;
    }
    def->enable_color = true;
    def->color_width = (int32_t)width;
    def->color_height = (int32_t)height;
    return true;
}

static bool read_switch(piece p, bool *out)
{
    *out = is_word(p, "1");
    return is_word(p, "0") || is_word(p, "1");
}

/* The index of one of `count` names. */
static bool read_name(piece p, const char *const *names, int count, int *out)
{
    int i = 0;
    while (i < count && !is_word(p, names[i])) {
        i++;
    }
    *out = i < count ? i : 0;
    return i < count;
}

static bool read_push(piece p, rlf_synthetic_push *out)
{
    static const char *const names[4] = {"none", "lift", "swipe", "carry"};
    int i = 0;
    bool is_good = read_name(p, names, 4, &i);
    *out = (rlf_synthetic_push)i;
    return is_good;
}

/* A grasp or a gesture, whose acts are those from `first` to `last`. */
static bool read_act(piece p, int first, int last, rlf_synthetic_act *out)
{
    for (int i = first; i <= last; i++) {
        if (is_word(p, rlf_synthetic_act_name((rlf_synthetic_act)i))) {
            *out = (rlf_synthetic_act)i;
            return true;
        }
    }
    return false;
}

/* As set_value, of scene "hands". */
static const char *set_hands(piece key, piece value, rlf_synthetic_hands_def *hands, bool *is_good)
{
    static const char *const views[3] = {"front", "above", "side"};
    static const char *const bodies[3] = {"cube", "ball", "can"};
    int i = 0;
    if (is_word(key, "grasp")) {
        *is_good = read_act(value, 0, RLF_SYNTHETIC_ACT_PASS, &hands->act);
        return "pinch_above, pinch_side, fist_bar, two_hands, scoop, under, throw or pass";
    }
    if (is_word(key, "gesture")) {
        *is_good = read_act(value, RLF_SYNTHETIC_ACT_OPEN, RLF_SYNTHETIC_ACT_WAVE, &hands->act);
        return "open, fist, pinch, point, flat, swipe or wave";
    }
    if (is_word(key, "view")) {
        *is_good = read_name(value, views, 3, &i);
        hands->view = (rlf_synthetic_view)i;
        return "front, above or side";
    }
    if (is_word(key, "body")) {
        *is_good = read_name(value, bodies, 3, &i);
        hands->body = (rlf_synthetic_body)i;
        return "cube, ball or can";
    }
    if (is_word(key, "distance")) {
        *is_good = read_decimal(value, &hands->distance) && hands->distance >= 0.6 &&
                   hands->distance <= 3.0;
        return "metres, 0.6 to 3";
    }
    if (is_word(key, "size")) {
        *is_good = read_decimal(value, &hands->size) &&
                   (hands->size == 0.0 || (hands->size >= 0.03 && hands->size <= 0.2));
        return "metres, 0.03 to 0.2, or 0";
    }
    if (is_word(key, "hold")) {
        *is_good = read_decimal(value, &hands->hold) && hands->hold <= 60.0;
        return "seconds, 0 to 60";
    }
    return NULL;
}

static bool read_path(piece p, rlf_synthetic_path *out)
{
    int i = 0;
    while (synth_path_name((rlf_synthetic_path)i) != NULL &&
           !is_word(p, synth_path_name((rlf_synthetic_path)i))) {
        i++;
    }
    const bool is_name = synth_path_name((rlf_synthetic_path)i) != NULL;
    *out = (rlf_synthetic_path)(is_name ? i : 0);
    return is_name;
}

/* What a key's value must be, in words; NULL when no such key exists. `is_good` says whether it is,
 * and then it has been set in *def. */
static const char *set_value(piece key, piece value, rlf_synthetic_def *def, bool *is_good)
{
    uint64_t number = 0;
    if (is_word(key, "seed")) {
        *is_good = read_integer(value, UINT64_MAX, &def->seed);
        return "a whole number";
    }
    if (is_word(key, "person")) {
        *is_good = read_integer(value, UINT64_MAX, &def->person);
        return "a whole number";
    }
    if (is_word(key, "frames")) {
        bool is_endless = is_word(value, "-1");
        *is_good = is_endless || read_integer(value, UINT32_MAX, &number);
        def->frame_count = is_endless ? -1 : (int64_t)number;
        return "-1 (endless) or a number of frames";
    }
    if (is_word(key, "fps")) {
        *is_good = read_decimal(value, &def->frames_per_second) && def->frames_per_second > 0.0 &&
                   def->frames_per_second <= 1000.0;
        return "frames per second above 0, at most 1000";
    }
    if (is_word(key, "speed")) {
        *is_good = read_decimal(value, &def->speed) && def->speed > 0.0 && def->speed <= 10.0;
        return "metres per second above 0, at most 10";
    }
    if (is_word(key, "lamp")) {
        *is_good = read_point(value, &def->lamp) && rlf_length(def->lamp) <= 20.0;
        return "X,Y,Z in metres, at most 20 away";
    }
    if (is_word(key, "noise")) {
        def->enable_structured_light = is_word(value, "steps");
        *is_good = def->enable_structured_light || read_switch(value, &def->enable_noise);
        return "0, 1 or steps";
    }
    if (is_word(key, "edge_filter")) {
        *is_good = read_switch(value, &def->enable_edge_filter);
        return "0 or 1";
    }
    if (is_word(key, "push")) {
        *is_good = read_push(value, &def->push);
        return "none, lift, swipe or carry";
    }
    if (is_word(key, "path")) {
        *is_good = read_path(value, &def->path);
        return "none, orbit, walk, handheld, look_away, fast, carried, bump or opposite";
    }
    if (is_word(key, "color")) {
        *is_good = read_size(value, def);
        return "WIDTHxHEIGHT, 1 to 4096 each, or 0 for none";
    }
    return set_hands(key, value, &def->hands, is_good);
}

static rlf_result parse_option(const char *source, piece option, rlf_synthetic_def *def)
{
    piece key = until(option.text, "=&");
    if (key.length >= option.length || option.text[key.length] != '=') {
        return rlf_fail(RLF_ERROR_INVALID, "%s: '%.*s' is not key=value; keys are " KEYS, source,
                        (int)option.length, option.text);
    }
    piece value = {option.text + key.length + 1, option.length - key.length - 1};
    bool is_good = false;
    const char *wanted = set_value(key, value, def, &is_good);
    if (wanted == NULL) {
        return rlf_fail(RLF_ERROR_INVALID, "%s: unknown key '%.*s'; use " KEYS, source,
                        (int)key.length, key.text);
    }
    rlf_synthetic_hands_def unused = def->hands;
    bool is_unused = false;
    if (def->scene != RLF_SYNTHETIC_HANDS && set_hands(key, value, &unused, &is_unused) != NULL) {
        return rlf_fail(RLF_ERROR_INVALID, "%s: %.*s is for scene hands only", source,
                        (int)key.length, key.text);
    }
    if (!is_good) {
        return rlf_fail(RLF_ERROR_INVALID, "%s: %.*s is '%.*s'; use %s", source, (int)key.length,
                        key.text, (int)value.length, value.text, wanted);
    }
    return RLF_OK;
}

rlf_result rlf_synthetic_parse(const char *source, rlf_synthetic_def *def)
{
    if (!RLF_ASSERT(source != NULL && def != NULL)) {
        return RLF_ERROR_INVALID;
    }
    if (strncmp(source, PREFIX, strlen(PREFIX)) != 0) {
        return rlf_fail(RLF_ERROR_INVALID, "%s: does not start with '" PREFIX "'", source);
    }
    rlf_synthetic_def parsed = rlf_synthetic_def_default();
    parsed.pool = def->cookie == parsed.cookie ? def->pool : NULL;
    piece name = until(source + strlen(PREFIX), "?");
    rlf_synthetic_scene scene = (rlf_synthetic_scene)0;
    while (synth_scene_name(scene) != NULL && !is_word(name, synth_scene_name(scene))) {
        scene = (rlf_synthetic_scene)(scene + 1);
    }
    if (synth_scene_name(scene) == NULL) {
        return rlf_fail(RLF_ERROR_INVALID, "%s: unknown scene '%.*s'; use " SCENES, source,
                        (int)name.length, name.text);
    }
    parsed.scene = scene;
    const char *next = name.text + name.length;
    while (*next != '\0') {
        piece option = until(next + 1, "&");
        rlf_result result = parse_option(source, option, &parsed);
        if (result != RLF_OK) {
            return result;
        }
        next = option.text + option.length;
    }
    *def = parsed;
    return RLF_OK;
}
