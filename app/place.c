/* `relief place`: poses of known objects from picked points, without a window. */
#include "command.h"
#include "options.h"
#include "picture_file.h"
#include "session.h"

#include <getopt.h>
#include <stdio.h>
#include <string.h>

typedef struct place_options {
    session_options session;
    const char *object; /* NULL = all that have points in the scene */
    const char *picks[RLF_KNOWN_POINTS_MAX];
    int32_t pick_count;
    bool has_too_many;
    bool keeps_picks; /* not refined */
    int32_t frames;
    const char *out_path, *picture_path;
} place_options;

static void print_help(void)
{
    printf(
        "usage: relief place SOURCE --scene FILE [OPTIONS]\n\n"
        "Finds where the known objects of a scene are: models of real things, which then hide\n"
        "and collide in their place. Poses come from 3 to 6 points, those of the scene or picks.\n"
        "\n"
        "  --scene FILE          with \"known_objects\" (docs/formats.md); required\n"
        "  --object NAME         place this one alone\n"
        "  --pick POINT@U,V      its POINT is seen at the picture's pixel U,V; 3 to 6 times\n"
        "  --pick POINT=X,Y,Z    or it is there in the world, metres\n"
        "                        POINT: three letters, l c r, t c b, n c f, as ltn for the left\n"
        "                        top near corner; of a hull v and a vertex; or x,y,z\n"
        "  --no-refine           keep what the picks give, do not fit the surface\n"
        "  --frames N            frames to look at before, default 15\n"
        "  --out FILE            the scene with the poses; may be the same file\n"
        "  --picture FILE        PNG of the last frame with the models as wireframes\n"
        "  --threads N           default: one per processor\n\n"
        "examples:\n"
        "  relief place synthetic:room --scene scenes/known.json\n"
        "  relief place clip --scene s.json --object crate --pick ltn@412,300 \\\n"
        "      --pick rtn@520,302 --pick lbn@415,371 --out placed.json\n");
}

static bool take_pick(const char *text, void *out)
{
    place_options *o = out;
    if (o->pick_count == RLF_KNOWN_POINTS_MAX) {
        o->has_too_many = true;
        return true;
    }
    o->picks[o->pick_count++] = text;
    return true;
}

static int parse(int argc, char **argv, place_options *o)
{
    *o = (place_options){.session = session_options_default(), .frames = 15};
    const option_def options[] = {
        {.name = "scene", .kind = OPTION_SCENE, .out = &o->session.scene_path},
        ROW_TEXT("object", &o->object),
        ROW_CHOICE("pick", o, take_pick, ""),
        ROW_FLAG("no-refine", &o->keeps_picks),
        ROW_INT32("frames", &o->frames, 1, 100000),
        ROW_FILE("out", &o->out_path, ".json"),
        ROW_FILE("picture", &o->picture_path, ".png"),
        ROW_INT32("threads", &o->session.thread_count, 1, 64),
        {0},
    };
    int status = options_parse("place", argc, argv, options, print_help);
    if (status >= 0) {
        return status;
    }
    if (argc - optind != 1) {
        return command_usage("place", argc == optind ? "needs a SOURCE" : "takes one SOURCE only");
    }
    if (o->session.scene_path == NULL) {
        return command_usage("place", "needs --scene FILE");
    }
    if (o->pick_count > 0 && o->object == NULL) {
        return command_usage("place", "--pick needs --object NAME");
    }
    if (o->has_too_many || (o->pick_count > 0 && o->pick_count < RLF_KNOWN_POINTS_MIN)) {
        return command_usage("place", "%s%d picks: give %d to %d",
                             o->has_too_many ? "more than " : "", (int)o->pick_count,
                             RLF_KNOWN_POINTS_MIN, RLF_KNOWN_POINTS_MAX);
    }
    o->session.source = argv[optind];
    return -1;
}

/* "POINT@U,V" or "POINT=X,Y,Z". */
static rlf_result read_pick(const char *text, const rlf_known_def *def, rlf_known_point *out)
{
    char name[64];
    char rest;
    size_t length = strcspn(text, "@=");
    rlf_vec3 *m = &out->model, *w = &out->world;
    bool is_good = length < sizeof(name) && text[length] != '\0';
    out->has_pixel = is_good && text[length] == '@';
    if (is_good) {
        memcpy(name, text, length);
        name[length] = '\0';
        const char *place = text + length + 1;
        is_good = out->has_pixel
                      ? sscanf(place, "%lf,%lf%c", &out->pixel[0], &out->pixel[1], &rest) == 2
                      : sscanf(place, "%lf,%lf,%lf%c", &w->x, &w->y, &w->z, &rest) == 3;
    }
    is_good = is_good && (sscanf(name, "%lf,%lf,%lf%c", &m->x, &m->y, &m->z, &rest) == 3 ||
                          rlf_known_name_point(&def->shape, name, m));
    return is_good ? RLF_OK
                   : rlf_fail(RLF_ERROR_INVALID,
                              "--pick %.40s: use POINT@U,V or POINT=X,Y,Z with a point that "
                              "\"%s\" has",
                              text, def->name);
}

/* What is to be placed gets its points. */
static rlf_result choose(const place_options *o, rlf_scene *scene)
{
    bool is_found = o->object == NULL;
    for (int32_t i = 0; i < scene->known_count; i++) {
        rlf_known_def *def = &scene->known[i];
        def->refine = def->refine && !o->keeps_picks;
        if (o->object == NULL || strcmp(def->name, o->object) != 0) {
            continue;
        }
        is_found = true;
        for (int32_t k = 0; k < o->pick_count; k++) {
            def->points[k] = (rlf_known_point){.has_pixel = false};
            rlf_result result = read_pick(o->picks[k], def, &def->points[k]);
            if (result != RLF_OK) {
                return result;
            }
        }
        def->point_count = o->pick_count > 0 ? o->pick_count : def->point_count;
        if (def->point_count == 0) {
            return rlf_fail(RLF_ERROR_INVALID,
                            "known object \"%s\" has no points in %s: add --pick", def->name,
                            o->session.scene_path);
        }
    }
    return is_found ? RLF_OK
                    : rlf_fail(RLF_ERROR_INVALID, "%s: has no known object \"%.60s\"",
                               o->session.scene_path, o->object);
}

static void print_fit(const rlf_known_def *def, const rlf_known_fit *fit)
{
    const rlf_pose *T = &fit->T_world_model;
    printf("%s\n  position     %.4f %.4f %.4f\n  orientation  %.5f %.5f %.5f %.5f\n", def->name,
           command_tidy(T->p.x, 4), command_tidy(T->p.y, 4), command_tidy(T->p.z, 4),
           command_tidy(T->q.x, 5), command_tidy(T->q.y, 5), command_tidy(T->q.z, 5),
           command_tidy(T->q.w, 5));
    if (fit->depth_count > 0) {
        printf("  picks        %d of %d with depth, off by %.1f mm, %.1f px\n",
               (int)fit->depth_count, (int)def->point_count, 1000.0 * fit->pick_rms,
               fit->pick_rms_px);
    }
    if (fit->surface_count > 0) {
        printf("  surface      %d points, off by %.1f mm\n", (int)fit->surface_count,
               1000.0 * fit->surface_rms);
    }
}

static rlf_result place_all(const place_options *o, rlf_scene *models, rlf_pipeline *pipeline)
{
    for (int32_t i = 0; i < models->known_count; i++) {
        rlf_known_def *def = &models->known[i];
        bool is_chosen = o->object == NULL || strcmp(def->name, o->object) == 0;
        if (!def->has_pose && (def->point_count == 0 || !is_chosen)) {
            printf("%s\n  %s\n", def->name,
                   def->point_count > 0 ? "left as it is" : "no pose yet: use --object and --pick");
            continue;
        }
        rlf_known_fit fit;
        rlf_result result = rlf_pipeline_set_known(pipeline, def, &fit);
        if (result != RLF_OK) {
            return result;
        }
        print_fit(def, &fit);
        def->T_world_model = fit.T_world_model;
        def->has_pose = true;
    }
    return RLF_OK;
}

static rlf_result save(const place_options *o, const rlf_scene *models, rlf_pipeline *pipeline)
{
    rlf_result result = RLF_OK;
    rlf_pipeline_output frame;
    if (o->picture_path != NULL) {
        rlf_pipeline_set_view(pipeline, RLF_VIEW_KNOWN);
        result = rlf_pipeline_redraw(pipeline, &frame);
        result =
            result == RLF_OK ? rlf_png_write_rgba(o->picture_path, &frame.render.image) : result;
    }
    if (result == RLF_OK && o->out_path != NULL) {
        result = rlf_scene_save_known(o->session.scene_path, models->known, models->known_count,
                                      o->out_path);
    }
    return result;
}

/* Frames until the surface has settled, or the source ends. */
static rlf_result look(const place_options *o, session *s)
{
    rlf_pipeline_output frame;
    int32_t seen = 0;
    rlf_result result = RLF_OK;
    while (result >= RLF_OK && result != RLF_END && seen < o->frames && !command_interrupted) {
        result = rlf_pipeline_step(s->pipeline, &frame);
        seen += result == RLF_OK ? 1 : 0;
    }
    if (result >= RLF_OK && seen == 0) {
        return rlf_fail(RLF_ERROR_IO, "%s: has no frame with depth", o->session.source);
    }
    return result >= RLF_OK ? RLF_OK : result;
}

/* The models are set once the surface has settled, not by the pipeline's first frame. */
static rlf_result run(place_options *o, rlf_scene *models)
{
    session s;
    rlf_scene empty = {.gravity = models->gravity, .border = models->border};
    o->session.scene = &empty;
    o->session.enable_render = o->picture_path != NULL;
    rlf_result result = session_open(&o->session, &s);
    if (result != RLF_OK) {
        return result;
    }
    result = look(o, &s);
    if (result == RLF_OK && !command_interrupted) {
        result = place_all(o, models, s.pipeline);
    }
    if (result == RLF_OK && !command_interrupted) {
        result = save(o, models, s.pipeline);
    }
    session_close(&s);
    return result;
}

int place_main(int argc, char **argv)
{
    place_options options;
    int status = parse(argc, argv, &options);
    if (status >= 0) {
        return status;
    }
    rlf_scene models;
    if (rlf_scene_load(options.session.scene_path, &models) != RLF_OK) {
        return command_failed();
    }
    rlf_result result = choose(&options, &models);
    if (result == RLF_OK && models.known_count == 0) {
        result =
            rlf_fail(RLF_ERROR_INVALID, "%s: has no \"known_objects\"", options.session.scene_path);
    }
    if (result == RLF_OK) {
        result = run(&options, &models);
    }
    rlf_scene_destroy(&models);
    if (result != RLF_OK) {
        return command_failed();
    }
    return command_interrupted ? command_stopped("place") : EXIT_DONE;
}
