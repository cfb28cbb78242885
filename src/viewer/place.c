/* The order of points, and what picks and keys do with them. */
#include "viewer/mouse.h"

#include <stdio.h>
#include <string.h>

#define CROSS_PX 6
#define VERTICES_MAX 12 /* of a hull that are asked for */
#define NAME 16         /* characters of a point, "v12", and its end */

/* ---- points --------------------------------------------------------------------------------- */

static const char *const box_points[] = {"ltn", "rtn", "rbn", "lbn", "ltf", "rtf", "rbf", "lbf"};
static const char *const round_points[] = {"ltc", "rtc", "ctn", "lbc", "rbc", "cbn"};
static const char *const ball_points[] = {"ctc", "lcc", "rcc", "cbc", "ccn"};

static int32_t point_count(const rlf_shape *shape)
{
    switch (shape->type) {
    case RLF_SHAPE_BOX: return 8;
    case RLF_SHAPE_SPHERE: return 5;
    case RLF_SHAPE_CAPSULE:
    case RLF_SHAPE_CYLINDER: return 6;
    case RLF_SHAPE_HULL: break;
    }
    int32_t vertices = shape->hull != NULL ? shape->hull->vertex_count : 0;
    return vertices < VERTICES_MAX ? vertices : VERTICES_MAX;
}

static void point_name(const rlf_shape *shape, int32_t index, char out[NAME])
{
    switch (shape->type) {
    case RLF_SHAPE_BOX: (void)snprintf(out, NAME, "%s", box_points[index]); break;
    case RLF_SHAPE_SPHERE: (void)snprintf(out, NAME, "%s", ball_points[index]); break;
    case RLF_SHAPE_CAPSULE:
    case RLF_SHAPE_CYLINDER: (void)snprintf(out, NAME, "%s", round_points[index]); break;
    case RLF_SHAPE_HULL: (void)snprintf(out, NAME, "v%d", (int)index); break;
    }
}

/* "left top near" for "ltn". */
static void point_words(const rlf_shape *shape, int32_t index, char out[64])
{
    static const char letters[] = "lrtbnf";
    static const char *const words[] = {"left ", "right ", "top ", "bottom ", "near ", "far "};
    char name[NAME];
    point_name(shape, index, name);
    if (shape->type == RLF_SHAPE_HULL) {
        rlf_vec3 p = shape->hull->vertices[index];
        (void)snprintf(out, 64, "vertex %d (%.2f %.2f %.2f) ", (int)index, p.x, p.y, p.z);
        return;
    }
    out[0] = '\0';
    for (const char *c = name; *c != '\0'; c++) {
        const char *letter = strchr(letters, *c);
        if (letter != NULL) {
            size_t length = strlen(out);
            (void)snprintf(out + length, 64 - length, "%s", words[letter - letters]);
        }
    }
}

/* ---- mode ----------------------------------------------------------------------------------- */

static void choose(viewer_place *place, const rlf_pipeline *pipeline, int32_t object)
{
    int32_t count;
    const rlf_known_def *list = rlf_pipeline_get_known(pipeline, &count);
    place->object = object < count ? object : 0;
    place->def = list[place->object];
    place->def.point_count = 0;
    place->next = 0;
}

bool viewer_place_toggle(viewer_place *place, const rlf_pipeline *pipeline,
                         char text[VIEWER_PLACE_TEXT])
{
    int32_t count;
    (void)rlf_pipeline_get_known(pipeline, &count);
    text[0] = '\0';
    if (!place->is_on && count == 0) {
        (void)snprintf(text, VIEWER_PLACE_TEXT, "the scene has no known_objects to place");
        return false;
    }
    place->is_on = !place->is_on;
    if (place->is_on) {
        choose(place, pipeline, place->object);
    }
    return true;
}

static void solve(viewer_place *place, rlf_pipeline *pipeline, char text[VIEWER_PLACE_TEXT])
{
    rlf_known_fit fit;
    if (place->def.point_count < RLF_KNOWN_POINTS_MIN) {
        (void)snprintf(text, VIEWER_PLACE_TEXT, "pick %d points at least", RLF_KNOWN_POINTS_MIN);
        return;
    }
    rlf_result result = rlf_pipeline_set_known(pipeline, &place->def, &fit);
    place->def.point_count = 0;
    place->next = 0;
    if (result != RLF_OK) {
        (void)snprintf(text, VIEWER_PLACE_TEXT, "%.127s", rlf_error_text());
        return;
    }
    place->def.T_world_model = fit.T_world_model;
    place->def.has_pose = true;
    (void)snprintf(text, VIEWER_PLACE_TEXT, "placed: picks off by %.1f px, surface by %.1f mm",
                   fit.pick_rms_px, 1000.0 * fit.surface_rms);
}

void viewer_place_pick(viewer_place *place, rlf_pipeline *pipeline, double u, double v,
                       char text[VIEWER_PLACE_TEXT])
{
    char name[NAME];
    rlf_known_def *def = &place->def;
    text[0] = '\0';
    if (!place->is_on || place->next >= point_count(&def->shape)) {
        return;
    }
    rlf_known_point *point = &def->points[def->point_count++];
    *point = (rlf_known_point){.has_pixel = true, .pixel = {u, v}};
    point_name(&def->shape, place->next++, name);
    (void)rlf_known_name_point(&def->shape, name, &point->model);
    if (def->point_count == RLF_KNOWN_POINTS_MAX || place->next == point_count(&def->shape)) {
        solve(place, pipeline, text);
    }
}

void viewer_place_act(viewer_place *place, rlf_pipeline *pipeline, viewer_place_action action,
                      char text[VIEWER_PLACE_TEXT])
{
    text[0] = '\0';
    if (!place->is_on) {
        return;
    }
    switch (action) {
    case VIEWER_PLACE_NEXT_OBJECT: choose(place, pipeline, place->object + 1); break;
    case VIEWER_PLACE_SKIP:
        if (++place->next >= point_count(&place->def.shape)) {
            solve(place, pipeline, text);
        }
        break;
    case VIEWER_PLACE_UNDO: /* from the first point on: a skip cannot be told from a pick */
        place->def.point_count = 0;
        place->next = 0;
        break;
    case VIEWER_PLACE_SOLVE: solve(place, pipeline, text); break;
    }
}

void viewer_place_nudge(viewer_place *place, rlf_pipeline *pipeline, const rlf_pose *T_world_camera,
                        rlf_vec3 shift, double turn, char text[VIEWER_PLACE_TEXT])
{
    text[0] = '\0';
    if (!place->is_on || !place->def.has_pose) {
        return;
    }
    rlf_known_def moved = place->def;
    moved.point_count = 0;
    rlf_pose *T = &moved.T_world_model;
    T->p = rlf_add(T->p, rlf_rotate(T_world_camera->q, shift));
    rlf_vec3 vertical = rlf_rotate(T_world_camera->q, rlf_vec3_make(0, turn, 0));
    T->q = rlf_quat_normalize(rlf_quat_mul(rlf_quat_from_rotation_vector(vertical), T->q));
    if (rlf_pipeline_set_known(pipeline, &moved, NULL) != RLF_OK) {
        (void)snprintf(text, VIEWER_PLACE_TEXT, "%.127s", rlf_error_text());
        return;
    }
    place->def.T_world_model = *T;
}

/* ---- screen --------------------------------------------------------------------------------- */

void viewer_place_hint(const viewer_place *place, char text[VIEWER_PLACE_TEXT])
{
    char words[64] = "";
    text[0] = '\0';
    if (!place->is_on) {
        return;
    }
    if (place->next < point_count(&place->def.shape)) {
        point_words(&place->def.shape, place->next, words);
    }
    (void)snprintf(text, VIEWER_PLACE_TEXT, "place %.40s: click its %spoint, %d of 3 to 6",
                   place->def.name, words, (int)place->def.point_count + 1);
}

static void draw_dot(const rlf_image_rgba8 *image, int32_t x, int32_t y)
{
    if (x >= 0 && y >= 0 && x < image->width && y < image->height) {
        static const uint8_t yellow[4] = {255, 240, 60, 255};
        memcpy(rlf_rgba8_row(image, y) + 4 * (ptrdiff_t)x, yellow, 4);
    }
}

void viewer_place_draw(const viewer_place *place, const rlf_image_rgba8 *image)
{
    for (int32_t i = 0; place->is_on && i < place->def.point_count; i++) {
        int32_t x = (int32_t)(place->def.points[i].pixel[0] + 0.5);
        int32_t y = (int32_t)(place->def.points[i].pixel[1] + 0.5);
        for (int32_t k = -CROSS_PX; k <= CROSS_PX; k++) {
            draw_dot(image, x + k, y);
            draw_dot(image, x, y + k);
        }
    }
}
