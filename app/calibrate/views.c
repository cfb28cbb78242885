/* Memory and names of views. */
#include "calibrate/views.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

rlf_result calibrate_views_create(const calibrate_board *board, calibrate_views *out)
{
    *out = (calibrate_views){.board = *board, .capacity = CALIBRATE_VIEWS_MAX};
    out->views = rlf_alloc_array(CALIBRATE_VIEWS_MAX, sizeof(*out->views));
    return out->views != NULL ? RLF_OK : RLF_ERROR_MEMORY;
}

void calibrate_views_destroy(calibrate_views *v)
{
    for (int32_t i = 0; i < v->count; i++) {
        for (int c = 0; c < CALIBRATE_CAMERAS; c++) {
            rlf_free(v->views[i].sight[c].points);
        }
    }
    rlf_free(v->views);
    *v = (calibrate_views){.count = 0};
}

calibrate_view *calibrate_views_add(calibrate_views *v)
{
    if (v->count == v->capacity) {
        return NULL;
    }
    calibrate_view *view = &v->views[v->count++];
    *view =
        (calibrate_view){.is_used = true, .T_first_board = rlf_pose_identity(), .offset_m = NAN};
    return view;
}

rlf_result calibrate_sight_resize(calibrate_sight *sight, int32_t count)
{
    rlf_free(sight->points);
    *sight = (calibrate_sight){.sigma = 1.0};
    sight->points = rlf_alloc_array((size_t)count, sizeof(*sight->points));
    sight->count = sight->points != NULL ? count : 0;
    return sight->points != NULL ? RLF_OK : RLF_ERROR_MEMORY;
}

void calibrate_board_point(const calibrate_board *board, int32_t id, double *out_x, double *out_y)
{
    *out_x = (id % board->columns - 0.5 * (board->columns - 1)) * board->square_m;
    *out_y = (id / board->columns - 0.5 * (board->rows - 1)) * board->square_m;
}

void calibrate_view_leave(calibrate_view *view, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(view->reason, sizeof(view->reason), format, arguments);
    va_end(arguments);
    view->is_used = false;
}

const char *calibrate_view_name(const calibrate_view *view)
{
    return view->name[0][0] != '\0' ? view->name[0] : view->name[1];
}

int32_t calibrate_views_used(const calibrate_views *v, int32_t camera)
{
    int32_t count = 0;
    for (int32_t i = 0; i < v->count; i++) {
        const calibrate_view *view = &v->views[i];
        count += view->is_used && (camera < 0 || view->sight[camera].count > 0);
    }
    return count;
}
