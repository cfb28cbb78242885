/* Still and different poses. No lens is known yet: tilt shows as one side longer than the other. */
#include "calibrate/solve.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define STILL_SHARE (0.5 / 640.0) /* of the width: a board that moved less has not moved */
#define STILL_PICTURES 3          /* in a row, so that exposure and depth are of a board at rest */
#define OTHER_SHARE 0.04          /* of the width: a board that moved more is another view */
#define TILT_RATIO 1.07           /* of opposite sides: about 20 degrees at arm's length */

static double distance(const calibrate_sight *a, const calibrate_sight *b)
{
    double sum = 0.0;
    int32_t count = 0;
    for (int32_t i = 0; i < a->count; i++) {
        for (int32_t k = 0; k < b->count; k++) {
            if (a->points[i].x == b->points[k].x && a->points[i].y == b->points[k].y) {
                sum += hypot(a->points[i].u - b->points[k].u, a->points[i].v - b->points[k].v);
                count++;
                break;
            }
        }
    }
    return count > 0 ? sum / count : INFINITY;
}

void calibrate_picker_destroy(calibrate_picker *p)
{
    rlf_free(p->last.points);
    *p = (calibrate_picker){.still = 0};
}

static bool keep_last(calibrate_picker *p, const calibrate_sight *sight)
{
    if (calibrate_sight_resize(&p->last, sight->count) != RLF_OK) {
        return false;
    }
    memcpy(p->last.points, sight->points, (size_t)sight->count * sizeof(*sight->points));
    return true;
}

calibrate_pick calibrate_picker_next(calibrate_picker *p, const calibrate_views *views,
                                     const calibrate_sight *sight)
{
    const double width = views->width[1];
    if (sight->count == 0) {
        p->last.count = 0;
        p->still = 0;
        return CALIBRATE_PICK_NONE;
    }
    const bool is_still = p->last.count > 0 && distance(&p->last, sight) < STILL_SHARE * width;
    p->still = is_still ? p->still + 1 : 0;
    if (!keep_last(p, sight) || p->still + 1 < STILL_PICTURES) {
        return CALIBRATE_PICK_MOVING;
    }
    for (int32_t i = 0; i < views->count; i++) {
        if (distance(&views->views[i].sight[1], sight) < OTHER_SHARE * width) {
            return CALIBRATE_PICK_KNOWN;
        }
    }
    return CALIBRATE_PICK_TAKE;
}

/* Length of the lattice's side: 0 left, 1 right, 2 top, 3 bottom; 0 where a corner is missing. */
static double side_length(const calibrate_board *board, const calibrate_sight *sight, int side)
{
    const int32_t last = board->columns * board->rows - 1;
    const int32_t ends[CALIBRATE_SIDES][2] = {{0, last - board->columns + 1},
                                              {board->columns - 1, last},
                                              {0, board->columns - 1},
                                              {last - board->columns + 1, last}};
    if (sight->count != last + 1) {
        return 0.0;
    }
    const calibrate_point *a = &sight->points[ends[side][0]], *b = &sight->points[ends[side][1]];
    return hypot(a->u - b->u, a->v - b->v);
}

void calibrate_picker_took(calibrate_picker *p, const calibrate_views *views,
                           const calibrate_sight *sight)
{
    for (int side = 0; side < CALIBRATE_SIDES; side++) {
        const double near = side_length(&views->board, sight, side);
        const double far = side_length(&views->board, sight, side ^ 1);
        p->tilts[side] = p->tilts[side] || (far > 0.0 && near > TILT_RATIO * far);
    }
}

bool calibrate_picker_wish(const calibrate_picker *p, const calibrate_views *views, char *out,
                           size_t size)
{
    static const char *const sides[CALIBRATE_SIDES] = {"left", "right", "top", "bottom"};
    calibrate_coverage cover;
    char tilts[64] = "";
    calibrate_cover(views, 1, &cover);
    for (int side = 0; side < CALIBRATE_SIDES && !views->board.is_charuco; side++) {
        const size_t length = strlen(tilts);
        if (!p->tilts[side]) {
            snprintf(tilts + length, sizeof(tilts) - length, "%s%s", length > 0 ? ", " : "",
                     sides[side]);
        }
    }
    snprintf(out, size, "%s%s%s%s%s", cover.missing[0] != '\0' ? "the board in the picture's " : "",
             cover.missing, cover.missing[0] != '\0' && tilts[0] != '\0' ? "; " : "",
             tilts[0] != '\0' ? "tilted so that this side is nearer: " : "", tilts);
    return out[0] != '\0';
}
