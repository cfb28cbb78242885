/* A caller's mistake is a safe no-op: each public function outside physics and files, called with
 * NULL where none is allowed, reports it and changes nothing. The error line is then that of this
 * call and not of an earlier one. */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "count_assert.h"
#include "relief/relief.h"

#include <string.h>

static const rlf_camera camera = {
    .width = 64, .height = 48, .fx = 50, .fy = 50, .cx = 32, .cy = 24};
static const rlf_camera nowhere = {.width = 0};
static double number;
static rlf_vec3 place;
static rlf_result result; /* of calls that give one */

/* NAME(call): a function that makes the call. */
#define CALL(name, call)                                                                           \
    static void name(void)                                                                         \
    {                                                                                              \
        call;                                                                                      \
    }

CALL(camera_check, result = rlf_camera_check(NULL, "camera"))
CALL(camera_check_who, result = rlf_camera_check(&camera, NULL))
CALL(camera_project, (void)rlf_camera_project(NULL, place, &number, &number))
CALL(camera_project_out, (void)rlf_camera_project(&camera, place, NULL, &number))
CALL(camera_unproject, (void)rlf_camera_unproject(NULL, 1, 1, &place))
CALL(camera_unproject_out, (void)rlf_camera_unproject(&camera, 1, 1, NULL))
CALL(camera_decimate, (void)rlf_camera_decimate(NULL, 2))
CALL(camera_decimate_by_0, (void)rlf_camera_decimate(&camera, 0))
CALL(camera_resize, (void)rlf_camera_resize(NULL, 8, 8))
CALL(camera_resize_of_nothing, (void)rlf_camera_resize(&nowhere, 8, 8))
CALL(camera_projection, (void)rlf_camera_projection(NULL, 1, 2))
CALL(registration_create, result = rlf_registration_create(NULL, NULL, NULL, NULL, NULL, NULL))
CALL(registration_apply, (void)rlf_registration_apply(NULL, NULL, NULL, NULL))
CALL(registration_align, (void)rlf_registration_align(NULL, NULL, NULL))
CALL(registration_find_pixels, (void)rlf_registration_find_pixels(NULL, NULL, 0, 4, NULL))
CALL(mesh_indices, (void)rlf_mesh_indices(2, 2, NULL))
CALL(mesh_indices_valid, (void)rlf_mesh_indices_valid(NULL, 1, NULL))
CALL(mesh_indices_region, (void)rlf_mesh_indices_region(NULL, NULL, 1, NULL))
CALL(surface_find_up, (void)rlf_surface_find_up(NULL, &place))
CALL(reconstruct_create, result = rlf_reconstruct_create(NULL, NULL))
CALL(reconstruct_process, result = rlf_reconstruct_process(NULL, NULL, NULL))
CALL(reconstruct_reset, (void)rlf_reconstruct_reset(NULL))
CALL(reconstruct_set_times, (void)rlf_reconstruct_set_times(NULL, NULL))
CALL(scene_create_two_cubes, result = rlf_scene_create_two_cubes(NULL))
CALL(pipeline_def_default, (void)rlf_pipeline_def_default(RLF_PROFILE_LIVE, NULL, NULL))
CALL(pipeline_create, result = rlf_pipeline_create(NULL, NULL))
CALL(pipeline_set_compositor, result = rlf_pipeline_set_compositor(NULL, NULL))
CALL(pipeline_get_compositor_def, (void)rlf_pipeline_get_compositor_def(NULL))
CALL(pipeline_set_views, result = rlf_pipeline_set_views(NULL, NULL, 1))
CALL(pipeline_set_orbit, (void)rlf_pipeline_set_orbit(NULL, NULL))
CALL(pipeline_set_plot, (void)rlf_pipeline_set_plot(NULL, true))
CALL(pipeline_set_legend, rlf_pipeline_set_legend(NULL, true))
CALL(pipeline_set_view, (void)rlf_pipeline_set_view(NULL, RLF_VIEW_DEPTH))
CALL(pipeline_set_overlay, (void)rlf_pipeline_set_overlay(NULL, NULL, 0))
CALL(pipeline_step, result = rlf_pipeline_step(NULL, NULL))
CALL(pipeline_redraw, result = rlf_pipeline_redraw(NULL, NULL))
CALL(pipeline_set_surface_times, (void)rlf_pipeline_set_surface_times(NULL, NULL))
CALL(pipeline_restart, result = rlf_pipeline_restart(NULL))
CALL(pipeline_set_known, result = rlf_pipeline_set_known(NULL, NULL, NULL))
CALL(pipeline_get_known, (void)rlf_pipeline_get_known(NULL, NULL))
CALL(pipeline_get_world, (void)rlf_pipeline_get_world(NULL))
CALL(compositor_create_custom, result = rlf_compositor_create_custom(NULL, NULL, NULL))
CALL(compositor_create_soft, result = rlf_compositor_create_soft(NULL, NULL))
CALL(compositor_name, (void)rlf_compositor_name(NULL))
CALL(compositor_render, result = rlf_compositor_render(NULL, NULL, NULL))
CALL(view_parse, (void)rlf_view_parse(NULL, NULL))
CALL(draw_text, (void)rlf_draw_text(NULL, 0, 0, 1, NULL))
CALL(room_look, rlf_room_look(NULL, NULL, NULL, NULL, NULL, NULL))
CALL(view_legend, (void)rlf_view_legend(RLF_VIEW_DEPTH, NULL))
CALL(legend_draw, rlf_legend_draw(NULL, NULL))
CALL(source_create_custom, result = rlf_source_create_custom(NULL, NULL, NULL, NULL))
CALL(source_get_info, (void)rlf_source_get_info(NULL))
CALL(source_next, result = rlf_source_next(NULL, NULL))
CALL(source_restart, result = rlf_source_restart(NULL))
CALL(source_seek, result = rlf_source_seek(NULL, 0))
CALL(source_get_status, (void)rlf_source_get_status(NULL))
CALL(source_observe, (void)rlf_source_observe(NULL, NULL, NULL))
CALL(source_get_truth, (void)rlf_source_get_truth(NULL))
CALL(known_name_point, (void)rlf_known_name_point(NULL, NULL, NULL))
CALL(align_points, result = rlf_align_points(NULL, NULL, 3, NULL, NULL))
CALL(known_solve, result = rlf_known_solve(NULL, NULL, NULL))
CALL(known_refine, (void)rlf_known_refine(NULL, NULL, NULL))
CALL(model_create, result = rlf_model_create(NULL, NULL))
CALL(model_texture_level, (void)rlf_model_texture_level(NULL, 0, NULL, NULL))
CALL(synthetic_create, result = rlf_synthetic_create(NULL, NULL))
CALL(synthetic_parse, result = rlf_synthetic_parse(NULL, NULL))
CALL(synthetic_distance, result = rlf_synthetic_distance(NULL, place, NULL, NULL, NULL))
CALL(synthetic_cast, result = rlf_synthetic_cast(NULL, place, NULL, 1, NULL, NULL))
CALL(synthetic_get_down, result = rlf_synthetic_get_down(NULL, NULL))
CALL(synthetic_nearest, result = rlf_synthetic_nearest(NULL, 0, place, NULL))

static const struct {
    const char *name;
    void (*make)(void);
} calls[] = {
    {"camera_check", camera_check},
    {"camera_check_who", camera_check_who},
    {"camera_project", camera_project},
    {"camera_project_out", camera_project_out},
    {"camera_unproject", camera_unproject},
    {"camera_unproject_out", camera_unproject_out},
    {"camera_decimate", camera_decimate},
    {"camera_decimate_by_0", camera_decimate_by_0},
    {"camera_resize", camera_resize},
    {"camera_resize_of_nothing", camera_resize_of_nothing},
    {"camera_projection", camera_projection},
    {"registration_create", registration_create},
    {"registration_apply", registration_apply},
    {"registration_align", registration_align},
    {"registration_find_pixels", registration_find_pixels},
    {"mesh_indices", mesh_indices},
    {"mesh_indices_valid", mesh_indices_valid},
    {"mesh_indices_region", mesh_indices_region},
    {"surface_find_up", surface_find_up},
    {"reconstruct_create", reconstruct_create},
    {"reconstruct_process", reconstruct_process},
    {"reconstruct_reset", reconstruct_reset},
    {"reconstruct_set_times", reconstruct_set_times},
    {"scene_create_two_cubes", scene_create_two_cubes},
    {"pipeline_def_default", pipeline_def_default},
    {"pipeline_create", pipeline_create},
    {"pipeline_set_compositor", pipeline_set_compositor},
    {"pipeline_get_compositor_def", pipeline_get_compositor_def},
    {"pipeline_set_views", pipeline_set_views},
    {"pipeline_set_orbit", pipeline_set_orbit},
    {"pipeline_set_plot", pipeline_set_plot},
    {"pipeline_set_legend", pipeline_set_legend},
    {"pipeline_set_view", pipeline_set_view},
    {"pipeline_set_overlay", pipeline_set_overlay},
    {"pipeline_step", pipeline_step},
    {"pipeline_redraw", pipeline_redraw},
    {"pipeline_set_surface_times", pipeline_set_surface_times},
    {"pipeline_restart", pipeline_restart},
    {"pipeline_set_known", pipeline_set_known},
    {"pipeline_get_known", pipeline_get_known},
    {"pipeline_get_world", pipeline_get_world},
    {"compositor_create_custom", compositor_create_custom},
    {"compositor_create_soft", compositor_create_soft},
    {"compositor_name", compositor_name},
    {"compositor_render", compositor_render},
    {"view_parse", view_parse},
    {"draw_text", draw_text},
    {"room_look", room_look},
    {"view_legend", view_legend},
    {"legend_draw", legend_draw},
    {"source_create_custom", source_create_custom},
    {"source_get_info", source_get_info},
    {"source_next", source_next},
    {"source_restart", source_restart},
    {"source_seek", source_seek},
    {"source_get_status", source_get_status},
    {"source_observe", source_observe},
    {"source_get_truth", source_get_truth},
    {"known_name_point", known_name_point},
    {"align_points", align_points},
    {"known_solve", known_solve},
    {"known_refine", known_refine},
    {"model_create", model_create},
    {"model_texture_level", model_texture_level},
    {"synthetic_create", synthetic_create},
    {"synthetic_parse", synthetic_parse},
    {"synthetic_distance", synthetic_distance},
    {"synthetic_cast", synthetic_cast},
    {"synthetic_get_down", synthetic_get_down},
    {"synthetic_nearest", synthetic_nearest},
};

static void calls_with_null_are_safe_and_say_so(void **state)
{
    (void)state;
    int count = 0, wrong = 0;
    rlf_set_assert(count_assert, &count);
    for (size_t i = 0; i < sizeof(calls) / sizeof(calls[0]); i++) {
        count = 0;
        result = RLF_ERROR_INVALID;
        rlf_fail(RLF_ERROR_IO, "of an earlier call");
        calls[i].make();
        const bool is_told = strcmp(rlf_error_text(), "of an earlier call") != 0;
        if (count == 0 || !is_told || result != RLF_ERROR_INVALID) {
            print_error("%s: %d assertions, result %d, '%s'\n", calls[i].name, count, (int)result,
                        rlf_error_text());
            wrong++;
        }
    }
    rlf_set_assert(NULL, NULL);
    assert_int_equal(wrong, 0);
}

static rlf_pipeline *make_pipeline(rlf_source **source)
{
    rlf_synthetic_def room = rlf_synthetic_def_default();
    room.scene = RLF_SYNTHETIC_EMPTY;
    room.color_width = 64;
    room.color_height = 36;
    assert_int_equal(rlf_synthetic_create(&room, source), RLF_OK);
    rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, *source, NULL);
    rlf_pipeline *pipeline = NULL;
    assert_int_equal(rlf_pipeline_create(&def, &pipeline), RLF_OK);
    return pipeline;
}

/* A view that is none is refused by both calls, and a missing line is an empty one. */
static void pipeline_refuses_views_that_are_none(void **state)
{
    (void)state;
    rlf_source *source = NULL;
    rlf_pipeline *pipeline = make_pipeline(&source);
    const int none[] = {-7, 99, RLF_VIEW_COUNT};
    int count = 0;
    rlf_set_assert(count_assert, &count);
    for (int i = 0; i < 3; i++) {
        const rlf_view view = (rlf_view)none[i];
        rlf_pipeline_set_view(pipeline, view);
        assert_int_equal(rlf_pipeline_set_views(pipeline, &view, 1), RLF_ERROR_INVALID);
    }
    assert_int_equal(count, 6);
    const char *const lines[] = {"first", NULL};
    rlf_pipeline_set_overlay(pipeline, lines, 2);
    assert_int_equal(count, 6);
    rlf_pipeline_set_overlay(pipeline, lines, -1);
    assert_int_equal(count, 7);
    rlf_set_assert(NULL, NULL);
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(calls_with_null_are_safe_and_say_so),
        cmocka_unit_test(pipeline_refuses_views_that_are_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
