/* Hands as marks over the picture. */
#include "pipeline/hands.h"

#include <string.h>

#define CIRCLE 24
#define CROSS_M 0.008
#define ARROW_M 0.1
#define RAY_M 1.0

typedef struct pen {
    hand_stage *stage;
    uint8_t color[3];
} pen;

static void draw(const pen *p, rlf_vec3 from, rlf_vec3 to, const char *text)
{
    hand_stage *stage = p->stage;
    if (stage->mark_count < RLF_HANDS_MAX * HAND_MARKS_EACH) {
        rlf_mark *mark = &stage->marks[stage->mark_count++];
        *mark = (rlf_mark){.from = from, .to = to, .text = text};
        memcpy(mark->color, p->color, sizeof(mark->color));
    }
}

static void draw_disc(const pen *p, rlf_vec3 centre, rlf_vec3 normal, double radius)
{
    const rlf_vec3 a = rlf_scale(rlf_perpendicular(normal), radius);
    const rlf_vec3 b = rlf_cross(normal, a);
    rlf_vec3 last = rlf_add(centre, a);
    for (int32_t k = 1; k <= CIRCLE; k++) {
        const double angle = 2.0 * RLF_PI * k / CIRCLE;
        const rlf_vec3 next = rlf_mad(rlf_mad(centre, a, rlf_cos(angle)), b, rlf_sin(angle));
        draw(p, last, next, NULL);
        last = next;
    }
}

static void draw_cross(const pen *p, rlf_vec3 at)
{
    const rlf_vec3 x = {CROSS_M, 0, 0}, y = {0, CROSS_M, 0};
    draw(p, rlf_sub(at, x), rlf_add(at, x), NULL);
    draw(p, rlf_sub(at, y), rlf_add(at, y), NULL);
}

static size_t append(char *word, size_t length, const char *text)
{
    while (*text != '\0' && length + 1 < HAND_WORD_SIZE) {
        word[length++] = *text++;
    }
    word[length] = '\0';
    return length;
}

/* As "3 left open 87 %". */
static void write_word(char *word, const rlf_hand *h)
{
    static const char *const sides[] = {"", " left", " right"};
    const int32_t percent = (int32_t)(100.0 * h->confidence + 0.5);
    char number[12];
    size_t length = 0;
    for (int32_t part = 0; part < 2; part++) {
        int32_t value = part == 0 ? h->id : percent;
        size_t at = sizeof(number) - 1;
        number[at] = '\0';
        do {
            number[--at] = (char)('0' + value % 10);
            value /= 10;
        } while (value > 0);
        length = append(word, length, number + at);
        if (part == 0) {
            length = append(word, length, sides[h->side]);
            length = append(word, length, " ");
            length = append(word, length, rlf_gesture_name(h->gesture));
            length = append(word, length, " ");
        }
    }
    append(word, length, "%");
}

static void draw_hand(hand_stage *stage, const rlf_hand *h, int32_t index)
{
    const bool is_sure = h->confidence >= RLF_HAND_SURE;
    const pen palm = {stage, {is_sure ? 120 : 150, is_sure ? 255 : 150, is_sure ? 120 : 150}};
    const pen tips = {stage, {255, 90, 90}};
    const pen pinch = {stage, {255, 230, 60}};
    draw_disc(&palm, h->palm, h->normal, h->palm_radius);
    draw(&palm, h->palm, rlf_mad(h->palm, h->arm_direction, -ARROW_M), NULL);
    for (int32_t k = 0; k < h->tip_count; k++) {
        draw_cross(&tips, h->tip[k]);
    }
    if (h->gesture == RLF_GESTURE_PINCH) {
        draw_disc(&pinch, h->pinch_point, h->normal, CROSS_M);
    } else if (h->gesture == RLF_GESTURE_POINT && h->tip_count > 0) {
        draw(&pinch, h->tip[0], rlf_mad(h->tip[0], h->point_direction, RAY_M), NULL);
    }
    write_word(stage->words[index], h);
    draw(&palm, h->palm, h->palm, stage->words[index]);
}

void hand_stage_draw(hand_stage *stage)
{
    stage->mark_count = 0;
    for (int32_t k = 0; stage->last != NULL && k < stage->last->count; k++) {
        draw_hand(stage, &stage->last->hand[k], k);
    }
}
