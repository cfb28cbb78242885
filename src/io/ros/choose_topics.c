/* Which topics are depth and colour. */
#define _POSIX_C_SOURCE 200809L
#include "io/ros/recording.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

static bool has(const char *topic, const char *word)
{
    const size_t length = strlen(word);
    for (; *topic != '\0'; topic++) {
        if (strncasecmp(topic, word, length) == 0) {
            return true;
        }
    }
    return false;
}

static bool is_infrared(const char *topic)
{
    return has(topic, "infra") || has(topic, "/ir/") || has(topic, "/ir_");
}

int32_t io_ros_common_parts(const char *a, const char *b)
{
    int32_t count = 0;
    for (; *a != '\0' && *a == *b; a++, b++) {
        count += a[1] == '/' && b[1] == '/' ? 1 : 0;
    }
    return count;
}

/* How likely a topic of depth pictures is the one that is meant: one named so, as the camera made
 * it, with its calibration, before a copy of it. 0 = it is no depth. */
static int32_t depth_score(const io_ros_topics *topics, const io_ros_topic *t)
{
    if (t->kind != IO_ROS_PICTURE_DEPTH || has(t->name, "confidence") ||
        has(t->name, "disparity")) {
        return 0;
    }
    return 16 + (has(t->name, "depth") ? 8 : 0) - (is_infrared(t->name) ? 12 : 0) -
           (has(t->name, "aligned") ? 1 : 0) - (has(t->name, "compressed") ? 1 : 0) +
           (io_ros_has_info(topics, t) ? 4 : 0);
}

/* The same for colour; infrared serves where there is none. */
static int32_t color_score(const io_ros_topics *topics, const io_ros_topic *t, const char *depth)
{
    const bool is_grey = t->kind == IO_ROS_PICTURE_GREY;
    if (t->kind != IO_ROS_PICTURE_COLOR && !is_grey) {
        return 0;
    }
    const bool is_other = has(t->name, "fisheye") || has(t->name, "confidence") ||
                          has(t->name, "depth") || has(t->name, "disparity");
    const int32_t score = 8 + (has(t->name, "rgb") || has(t->name, "color") ? 8 : 0) -
                          (is_other || is_infrared(t->name) ? 16 : 0) - (is_grey ? 4 : 0) +
                          (io_ros_has_info(topics, t) ? 4 : 0) -
                          (has(t->name, "compressed") ? 1 : 0) +
                          2 * io_ros_common_parts(t->name, depth);
    return score > 0 || is_other ? score : 1;
}

/* The best topic of depth, or with `depth` named, of colour to go with it; more pictures first
 * where two score alike; -1 = none. `frame`: only of that frame_id, unless NULL. */
static int32_t find_best(const io_ros_topics *topics, const char *depth, const char *frame)
{
    int32_t best = -1, best_score = 0;
    for (int32_t i = 0; i < topics->picture_count; i++) {
        const io_ros_topic *t = &topics->pictures[i];
        const bool is_of = frame == NULL || strcmp(frame, t->frame_id) == 0;
        const int32_t score = !is_of          ? 0
                              : depth == NULL ? depth_score(topics, t)
                                              : color_score(topics, t, depth);
        const bool is_longer = best >= 0 && t->count > topics->pictures[best].count;
        if (score > best_score || (score > 0 && score == best_score && is_longer)) {
            best = i;
            best_score = score;
        }
    }
    return best;
}

/* The topics of pictures and what they hold, of depth alone or all. */
static const char *list_topics(const io_ros_topics *topics, int32_t without, bool wants_depth,
                               char *out, size_t size)
{
    size_t length = 0;
    snprintf(out, size, " none");
    for (int32_t i = 0; i < topics->picture_count && length + 1 < size; i++) {
        const io_ros_topic *t = &topics->pictures[i];
        if (i != without && (!wants_depth || depth_score(topics, t) > 0)) {
            const int got = snprintf(out + length, size - length, "%s %s (%.40s)",
                                     length > 0 ? "," : "", t->name, t->encoding);
            length += got > 0 ? (size_t)got : 0;
        }
    }
    return out;
}

/* Counts of 16 bits may be an infrared picture, too. */
static bool can_be_color(const io_ros_topic *t)
{
    const bool is_counts =
        strncmp(t->encoding, "32FC1", 5) != 0 && strstr(t->encoding, "compressedDepth") == NULL;
    return t->kind != IO_ROS_PICTURE_NONE && (t->kind != IO_ROS_PICTURE_DEPTH || is_counts);
}

static int32_t find_named(const io_ros_topics *topics, const char *name, bool wants_depth)
{
    for (int32_t i = 0; i < topics->picture_count; i++) {
        const io_ros_topic *t = &topics->pictures[i];
        if (strcmp(t->name, name) == 0 &&
            (wants_depth ? t->kind == IO_ROS_PICTURE_DEPTH : can_be_color(t))) {
            return i;
        }
    }
    return -1;
}

#define DEPTH_KINDS "16UC1, mono16, 32FC1, compressedDepth, or PNG of 16-bit grey"

static rlf_result fail_depth(const io_ros_topics *topics, const char *wished)
{
    char list[512];
    const char *also = topics->strangers[0] != '\0' ? "; not read:" : "";
    list_topics(topics, -1, false, list, sizeof(list));
    if (wished != NULL) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: depth=%.100s: holds no depth pictures of that topic (" DEPTH_KINDS
                        "): its topics of pictures are:%s%s%s",
                        topics->name, wished, list, also, topics->strangers);
    }
    return rlf_fail(RLF_ERROR_FORMAT,
                    "%s: holds no depth pictures (" DEPTH_KINDS
                    "): %s the camera's depth topic too; its topics of pictures are:%s%s%s",
                    topics->name, topics->is_live ? "publish" : "record", list, also,
                    topics->strangers);
}

static rlf_result fail_color(const io_ros_topics *topics, const char *wished)
{
    char list[512];
    return rlf_fail(
        RLF_ERROR_INVALID,
        "%s: color=%.100s: holds no pictures of that topic: its topics of pictures are:%s",
        topics->name, wished, list_topics(topics, -1, false, list, sizeof(list)));
}

/* Depth of the colour camera's pixels, when nothing else joins the two. */
static int32_t prefer_aligned(const io_ros_topics *topics, int32_t depth, int32_t color)
{
    const io_ros_topic *d = &topics->pictures[depth];
    const io_ros_topic *c = &topics->pictures[color];
    char list[512];
    if (strcmp(d->frame_id, c->frame_id) == 0 || !io_ros_has_info(topics, c) ||
        topics->is_joined(topics->self, d->frame_id, c->frame_id)) {
        return depth;
    }
    const int32_t aligned = find_best(topics, NULL, c->frame_id);
    if (aligned < 0 || !io_ros_has_info(topics, &topics->pictures[aligned])) {
        return depth;
    }
    rlf_log(RLF_LOG_WARNING,
            "%s: no transform leads from %s to %s, so depth is that of %s, which the colour camera "
            "sees; ?depth=TOPIC takes another:%s",
            topics->name, d->frame_id, c->frame_id, topics->pictures[aligned].name,
            list_topics(topics, aligned, true, list, sizeof(list)));
    return aligned;
}

rlf_result io_ros_choose(const io_ros_topics *topics, const char *depth, const char *color,
                         int32_t *out_depth, int32_t *out_color)
{
    *out_color = -1;
    *out_depth = depth != NULL ? find_named(topics, depth, true) : find_best(topics, NULL, NULL);
    if (*out_depth < 0) {
        return fail_depth(topics, depth);
    }
    if (color == NULL) {
        *out_color = find_best(topics, topics->pictures[*out_depth].name, NULL);
    } else if (strcmp(color, "none") != 0) {
        *out_color = find_named(topics, color, false);
        if (*out_color < 0) {
            return fail_color(topics, color);
        }
    }
    if (depth == NULL && *out_color >= 0) {
        *out_depth = prefer_aligned(topics, *out_depth, *out_color);
    }
    return RLF_OK;
}
