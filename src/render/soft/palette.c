/* Colours that mean something. */
#include "render/soft/draw.h"

/* From pale yellow over orange and purple to dark blue: lightness falls all the way, so that the
 * order of depths is seen without a legend, in grey too. */
static const uint8_t near_far[7][3] = {{253, 240, 160}, {252, 190, 90}, {240, 130, 70},
                                       {205, 75, 100},  {145, 45, 130}, {75, 30, 125},
                                       {20, 20, 75}};

soft_color soft_color_near_far(double t)
{
    double at = rlf_clamp(t, 0.0, 1.0) * 6.0;
    int32_t first = at < 6.0 ? (int32_t)at : 5;
    double w = at - first;
    int32_t c[3];
    for (int i = 0; i < 3; i++) {
        c[i] = (int32_t)(near_far[first][i] * (1.0 - w) + near_far[first + 1][i] * w + 0.5);
    }
    return soft_rgb(c[0], c[1], c[2]);
}

soft_color soft_color_hue(double turn, double value)
{
    double at = 6.0 * (turn - (double)(int32_t)turn);
    at = at < 0.0 ? at + 6.0 : at;
    int32_t c[3];
    for (int i = 0; i < 3; i++) {
        /* Each channel is full for a third of the wheel, with ramps of a sixth on either side. */
        double distance = at - 2.0 * i;
        distance = distance < 0.0 ? -distance : distance;
        distance = distance > 3.0 ? 6.0 - distance : distance;
        c[i] = (int32_t)(255.0 * rlf_clamp(value, 0.0, 1.0) * rlf_clamp(2.0 - distance, 0.0, 1.0) +
                         0.5);
    }
    return soft_rgb(c[0], c[1], c[2]);
}

soft_color soft_color_label(int32_t label)
{
    if (label <= 0) {
        return soft_rgb(0, 0, 0);
    }
    /* Steps of the golden ratio round the wheel keep successive labels far apart. */
    const double golden = 0.6180339887498949;
    soft_color c = soft_color_hue((label % 1000) * golden, label % 2 == 0 ? 0.95 : 0.75);
    return soft_rgb(40 + c.r * 215 / 255, 40 + c.g * 215 / 255, 40 + c.b * 215 / 255);
}

soft_color soft_color_reason(rlf_reason reason)
{
    static const uint8_t colors[RLF_REASON_COUNT][3] = {
        {70, 110, 80}, {250, 220, 60}, {60, 90, 200}, {20, 20, 20},
        {230, 60, 60}, {170, 70, 200}, {90, 90, 90},  {90, 210, 220}};
    int i = (int)reason >= 0 && reason < RLF_REASON_COUNT ? (int)reason : 0;
    return soft_rgb(colors[i][0], colors[i][1], colors[i][2]);
}

static int32_t unit_to_byte(double x)
{
    return (int32_t)(rlf_clamp(0.5 + 0.5 * x, 0.0, 1.0) * 255.0 + 0.5);
}

soft_color soft_color_normal(rlf_vec3 n)
{
    if (n.x == 0.0 && n.y == 0.0 && n.z == 0.0) {
        return soft_rgb(0, 0, 0);
    }
    return soft_rgb(unit_to_byte(n.x), unit_to_byte(-n.y), unit_to_byte(-n.z));
}

soft_color soft_color_velocity(rlf_vec3 v)
{
    double turn = rlf_atan2(v.y, v.x) / (2.0 * RLF_PI) + 1.0;
    double share = rlf_clamp(rlf_length(v) / SOFT_SPEED_FULL_M_S, 0.0, 1.0);
    return soft_color_hue(turn, 0.35 + 0.65 * share);
}

soft_color soft_color_thickness(double metres)
{
    return soft_color_near_far(1.0 - metres / SOFT_THICKNESS_FULL_M);
}

soft_color soft_color_contact(rlf_contact_other other)
{
    switch (other) {
    case RLF_CONTACT_BODY: return soft_rgb(90, 220, 255);
    case RLF_CONTACT_FOREGROUND: return soft_rgb(120, 255, 120);
    case RLF_CONTACT_BACKGROUND: break;
    }
    return soft_rgb(255, 220, 60);
}

soft_color soft_color_foreground(void)
{
    return soft_rgb(60, 230, 120);
}

soft_color soft_color_unseen(void)
{
    return soft_rgb(70, 72, 78);
}

soft_color soft_color_known(void)
{
    return soft_rgb(90, 255, 160);
}

soft_color soft_color_path(void)
{
    return soft_rgb(255, 190, 60);
}

soft_color soft_color_dark(void)
{
    return soft_rgb(18, 20, 24);
}
