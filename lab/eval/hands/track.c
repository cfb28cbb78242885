/* Palms, finger tips and gestures that were found, against the true hand. */
#include "eval/hands/hands.h"
#include "eval/measures/percent.h"

#define SEEN_S 2.6    /* the hand is raised */
#define NEAR_M 0.15   /* from the true palm: it is this hand */
#define FRAMES_LATE 4 /* a gesture may be so late */
#define TIP_M 0.03    /* from a true tip: it is that one */
#define COVER_M 0.08  /* what is nearer hides the hand */
#define FAR_M 2.5
#define FARTHEST_M 3.0

/* Sums over frames. */
typedef struct track_sums {
    int64_t frames, found, tips, tip_strays, stretched, tips_seen, judged, right;
    int64_t open_judged, open_right; /* of open and fist alone */
    int64_t swipes, waves;
    double palm, tip, ms;
} track_sums;

/* The middle of what is seen of a tip: between its end and its side towards the camera. */
static rlf_vec3 seen_tip(const rlf_synthetic_hand *hand, int finger)
{
    rlf_vec3 end = hand->joints[finger][3];
    rlf_vec3 along = rlf_normalize(rlf_sub(end, hand->joints[finger][2]));
    rlf_vec3 side = rlf_normalize(rlf_sub(along, rlf_normalize(end)));
    return rlf_mad(end, side, hand->tip_radius[finger]);
}

/* What is seen in the direction of the palm's middle: its skin, or fingers that are folded over it.
 */
static rlf_vec3 seen_palm(const hands_run *run, const rlf_synthetic_hand *hand)
{
    const rlf_vec3 eye = {0, 0, 0}, ray = rlf_scale(hand->palm, 1.0 / hand->palm.z);
    float z = 0.0f;
    (void)rlf_synthetic_cast(run->source, eye, &ray, 1, &z, NULL);
    return hand->palm.z - (double)z < COVER_M ? rlf_scale(ray, (double)z) : hand->palm;
}

static const rlf_hand *nearest_hand(const rlf_hands *found, rlf_vec3 palm)
{
    const rlf_hand *best = NULL;
    double least = NEAR_M;
    for (int32_t i = 0; found != NULL && i < found->count; i++) {
        double distance = rlf_length(rlf_sub(found->hand[i].palm, palm));
        bool is_best = found->hand[i].confidence >= RLF_HAND_SURE && distance < least;
        best = is_best ? &found->hand[i] : best;
        least = is_best ? distance : least;
    }
    return best;
}

static double nearest_tip(const rlf_hand *hand, rlf_vec3 p)
{
    double least = 1e9;
    for (int32_t i = 0; i < hand->tip_count; i++) {
        least = rlf_min(least, rlf_length(rlf_sub(hand->tip[i], p)));
    }
    return least;
}

/* Found tips against true ones, and how many stretched fingers were found. */
static void add_tips(const rlf_hand *hand, const rlf_synthetic_hand *truth, track_sums *sums)
{
    for (int32_t i = 0; i < hand->tip_count; i++) {
        double least = 1e9;
        for (int f = 0; f < 5; f++) {
            least = rlf_min(least, rlf_length(rlf_sub(seen_tip(truth, f), hand->tip[i])));
        }
        sums->tips += least < TIP_M;
        sums->tip += least < TIP_M ? least : 0.0;
        sums->tip_strays += least >= TIP_M;
    }
    bool is_point = truth->gesture == RLF_SYNTHETIC_GESTURE_POINT;
    for (int f = 0; f < 5 && (is_point || truth->gesture == RLF_SYNTHETIC_GESTURE_OPEN); f++) {
        if (!is_point || f == 1) {
            sums->stretched++;
            sums->tips_seen += nearest_tip(hand, seen_tip(truth, f)) < TIP_M;
        }
    }
}

static void add_events(const rlf_hands *found, track_sums *sums)
{
    for (int32_t i = 0; found != NULL && i < found->event_count; i++) {
        rlf_hand_event_kind kind = found->event[i].kind;
        sums->swipes += kind == RLF_HAND_EVENT_SWIPE_LEFT || kind == RLF_HAND_EVENT_SWIPE_RIGHT;
        sums->waves += kind == RLF_HAND_EVENT_WAVE;
    }
}

/* `age`: frames for which the hand has shown this gesture. */
static void add_frame(const hands_run *run, const rlf_synthetic_hand *truth, int32_t age,
                      track_sums *sums)
{
    rlf_vec3 palm = seen_palm(run, truth);
    const rlf_hand *hand = nearest_hand(run->frame.hands, palm);
    sums->frames++;
    sums->ms += run->frame.times.hands_ms;
    if (truth->gesture != RLF_SYNTHETIC_GESTURE_NONE && age >= FRAMES_LATE) {
        bool is_right = hand != NULL && (int)hand->gesture == (int)truth->gesture;
        bool is_open = truth->gesture <= RLF_SYNTHETIC_GESTURE_FIST;
        sums->judged++;
        sums->right += is_right;
        sums->open_judged += is_open;
        sums->open_right += is_open && is_right;
    }
    if (hand != NULL) {
        sums->found++;
        sums->palm += rlf_length(rlf_sub(hand->palm, palm));
        add_tips(hand, truth, sums);
    }
}

static rlf_result track(const rlf_synthetic_def *def, track_sums *sums)
{
    hands_run run;
    rlf_synthetic_hand truth[RLF_SYNTHETIC_HANDS_MAX];
    int32_t count = 0, age = 0, last = -1;
    rlf_result result = hands_open(def, &run);
    if (result != RLF_OK) {
        return result;
    }
    result = rlf_pipeline_set_hands(run.pipeline, true);
    while (result == RLF_OK && run.frame.time_s < run.task.end - 0.05) {
        result = hands_step_until(&run, run.frame.time_s + 0.02);
        result = result == RLF_OK
                     ? rlf_synthetic_get_hands(run.source, run.frame.time_s, truth, &count)
                     : result;
        if (result == RLF_OK && run.frame.time_s > SEEN_S) {
            age = (int)truth[0].gesture == last ? age + 1 : 0;
            last = (int)truth[0].gesture;
            add_frame(&run, &truth[0], age, sums);
            add_events(run.frame.hands, sums);
        }
    }
    hands_close(&run);
    return result;
}

static void add(eval_table *table, const char *key, const char *title, double value)
{
    eval_table_add(table, GESTURES_SECTION, key, title, RLF_PROFILE_LIVE, value);
}

static double mean(double sum, int64_t count, double scale)
{
    return count > 0 ? scale * sum / (double)count : NAN;
}

static void report_near(eval_table *table, const track_sums *s)
{
    add(table, "hand_found_percent", "a raised hand at 0.75 to 1.2 m: found, %",
        eval_percent(s->found, s->frames));
    add(table, "palm_mm", "  palm off by, mm", mean(s->palm, s->found, 1e3));
    add(table, "tip_mm", "  finger tips off by, mm", mean(s->tip, s->tips, 1e3));
    add(table, "tips_seen_percent", "  stretched fingers found, %",
        eval_percent(s->tips_seen, s->stretched));
    add(table, "tip_strays_percent", "  tips that are none, %",
        eval_percent(s->tip_strays, s->tips + s->tip_strays));
    add(table, "gestures_percent", "  gestures right after four frames, %",
        eval_percent(s->right, s->judged));
    add(table, "hands_ms", "  cost of a frame, ms", mean(s->ms, s->frames, 1.0));
}

/* One act at a distance, seen from anywhere. */
static rlf_result run_act(int64_t seed, rlf_synthetic_act act, double distance, track_sums *sums)
{
    eval_random r = eval_random_start((uint64_t)(seed * 1000 + 600 + (int)act));
    rlf_synthetic_def def = hands_draw(act, &r, (uint64_t)(seed * 100 + 50 + (int)act));
    def.hands.distance = distance > 0.0 ? distance : def.hands.distance;
    return track(&def, sums);
}

static rlf_result run_near(eval_table *table, int64_t seed)
{
    static const struct {
        const char *key, *title;
    } rows[5] = {{"open_percent", "    open, %"},
                 {"fist_percent", "    fist, %"},
                 {"pinch_percent", "    pinch, %"},
                 {"point_percent", "    point, %"},
                 {"flat_percent", "    flat, which is open, %"}};
    track_sums all = {0};
    double right[5];
    rlf_result result = RLF_OK;
    for (int act = RLF_SYNTHETIC_ACT_OPEN; act <= RLF_SYNTHETIC_ACT_FLAT && result == RLF_OK;
         act++) {
        int64_t before = all.right, judged = all.judged;
        result = run_act(seed, (rlf_synthetic_act)act, 0.0, &all);
        right[act - RLF_SYNTHETIC_ACT_OPEN] = eval_percent(all.right - before, all.judged - judged);
    }
    if (result == RLF_OK) {
        report_near(table, &all);
        for (int i = 0; i < 5; i++) {
            add(table, rows[i].key, rows[i].title, right[i]);
        }
    }
    return result;
}

static rlf_result run_events(eval_table *table, int64_t seed)
{
    track_sums swipes = {0}, waves = {0};
    rlf_result result = run_act(seed, RLF_SYNTHETIC_ACT_SWIPE, 0.0, &swipes);
    result = result == RLF_OK ? run_act(seed, RLF_SYNTHETIC_ACT_WAVE, 0.0, &waves) : result;
    add(table, "swipes_seen", "  swipes told, of 3", (double)swipes.swipes);
    add(table, "waves_seen", "  waves told, of 1 or more", (double)waves.waves);
    return result;
}

rlf_result hands_track_run(eval_table *table, int64_t seed)
{
    track_sums far = {0}, farthest = {0};
    rlf_result result = run_near(table, seed);
    result = result == RLF_OK ? run_events(table, seed) : result;
    for (int act = RLF_SYNTHETIC_ACT_OPEN; act <= RLF_SYNTHETIC_ACT_FIST && result == RLF_OK;
         act++) {
        result = run_act(seed, (rlf_synthetic_act)act, FAR_M, &far);
        result = result == RLF_OK ? run_act(seed, (rlf_synthetic_act)act, FARTHEST_M, &farthest)
                                  : result;
    }
    if (result == RLF_OK) {
        add(table, "far_open_fist_percent", "open or fist right at 2.5 m, %",
            eval_percent(far.open_right, far.open_judged));
        add(table, "far_found_percent", "found at 3 m, %",
            eval_percent(farthest.found, farthest.frames));
        add(table, "far_palm_mm", "palm off by at 3 m, mm",
            mean(farthest.palm, farthest.found, 1e3));
    }
    return result;
}
