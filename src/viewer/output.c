/* How the picture fills the window: with bars or cut, and with its corners where a projector needs
 * them. */
#include "viewer/state.h"

#define HANDLE 9 /* pixels of a corner's mark for every 540 of the window's height, each way */
#define FINE 0.1 /* of a step, with shift */

void viewer_toggle_fill(viewer *v)
{
    v->fills = !v->fills;
    v->is_present_due = true;
    viewer_show_message(v, v->fills ? "the picture fills the window, and is cut"
                                    : "the whole picture, with black bars");
}

void viewer_toggle_corners(viewer *v)
{
    viewer_corners *c = &v->corners;
    const char *path = v->options->corners_path;
    c->is_on = !c->is_on;
    c->is_held = false;
    v->window.needs_pointer = c->is_on;
    v->is_present_due = true;
    if (!c->is_on && path != NULL) {
        viewer_show_result(v, viewer_corners_save(c, path), "the corners are kept");
    }
}

void viewer_run_corners(viewer *v, const viewer_commands *commands)
{
    viewer_corners *c = &v->corners;
    if (commands->toggle_corners || (commands->solve_points && c->is_on)) {
        viewer_toggle_corners(v);
        return;
    }
    if (commands->next_object) {
        c->selected = (c->selected + 1) % 4;
    }
    if (commands->undo_points) {
        viewer_corners_reset(c);
    }
    if (commands->nudge_x != 0 || commands->nudge_y != 0) {
        const double step = commands->is_fine ? FINE : 1.0;
        viewer_corners_nudge(c, step * commands->nudge_x, step * commands->nudge_y);
    }
}

static bool place_of(const viewer *v, double x, double y, double out[2])
{
    int32_t width, height;
    viewer_get_area(v, &width, &height);
    out[0] = width > 0 ? x / width : 0.0;
    out[1] = height > 0 ? y / height : 0.0;
    return width > 0 && height > 0;
}

bool viewer_press_corner(viewer *v, const viewer_commands *commands)
{
    double at[2];
    if (!v->corners.is_on || !place_of(v, commands->press_x, commands->press_y, at)) {
        return false;
    }
    viewer_corners_pick(&v->corners, at[0], at[1]);
    v->is_present_due = true;
    return true;
}

void viewer_drag_corner(viewer *v)
{
    double x, y, at[2];
    viewer_window_get_cursor(&v->window, &x, &y);
    if (v->corners.is_held && place_of(v, x, y, at)) {
        v->is_present_due = viewer_corners_move(&v->corners, at[0], at[1]) || v->is_present_due;
    }
}

/* A square, filled where the arrows move it. */
static void draw_handle(viewer *v, double x, double y, bool is_selected, int32_t height)
{
    const int32_t reach = HANDLE * (height / 540 + 1), size = 2 * reach + 1;
    if (!viewer_clear_image(&v->marks, &v->marks_size, size, size)) {
        return;
    }
    for (int32_t i = 0; i < size * size; i++) {
        const int32_t column = i % size, row = i / size, rim = reach / 3 + 1;
        const bool is_rim = column < rim || row < rim || column >= size - rim || row >= size - rim;
        const uint8_t color[4] = {250, 190, 70, is_rim || is_selected ? 255 : 60};
        for (int k = 0; k < 4; k++) {
            v->marks.data[4 * (ptrdiff_t)i + k] = color[k];
        }
    }
    rlf_gl_presenter_draw_over(v->presenter, &v->marks, (int32_t)x - reach, (int32_t)y - reach,
                               height);
}

void viewer_draw_corners(viewer *v, int32_t width, int32_t height)
{
    for (int i = 0; i < 4 && v->corners.is_on; i++) {
        const double *at = v->corners.at + 2 * i;
        draw_handle(v, at[0] * width, at[1] * height, i == v->corners.selected, height);
    }
}
