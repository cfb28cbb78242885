/* The surface stage: one frame through all steps into the next slot of the ring. */
#include "surface/color_side.h"
#include "surface/ego_motion.h"
#include "surface/objects/objects.h"
#include "surface/shadow.h"
#include "surface/thickness/static.h"
#include "surface/depth/depth.h"
#include "surface/steps.h"
#include "surface/thin/thin.h"

#include "base/cookie.h"

#include <string.h>

/* Pixels: the steps of a smaller frame, some 10 microseconds each, are done before another thread
 * has woken. */
enum { LEAST_SHARED = 8192 };

static void set_grid(rlf_reconstruct *stage)
{
    rlf_grid *grid = &stage->grid;
    grid->factor = stage->def.scale_factor;
    grid->camera = rlf_camera_decimate(&stage->def.rig.depth, grid->factor);
    grid->width = grid->camera.width;
    grid->height = grid->camera.height;
    grid->count = grid->width * grid->height;
}

rlf_result rlf_reconstruct_create(const rlf_reconstruct_def *def, rlf_reconstruct **out)
{
    if (!RLF_ASSERT(def != NULL && out != NULL && def->cookie == RLF_DEF_COOKIE)) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "reconstruct: the def is not from rlf_reconstruct_def_default");
    }
    *out = NULL;
    rlf_result result = rlf_reconstruct_def_check(def);
    if (result != RLF_OK) {
        return result;
    }
    rlf_reconstruct *stage = rlf_alloc(sizeof *stage);
    if (stage == NULL) {
        return RLF_ERROR_MEMORY;
    }
    stage->def = *def;
    set_grid(stage);
    if (stage->grid.count < LEAST_SHARED) {
        stage->def.pool = NULL;
    }
    if (!rlf_stage_allocate(stage)) {
        rlf_reconstruct_destroy(&stage);
        return RLF_ERROR_MEMORY;
    }
    rlf_reconstruct_reset(stage);
    *out = stage;
    return RLF_OK;
}

void rlf_reconstruct_destroy(rlf_reconstruct **stage)
{
    if (stage == NULL || *stage == NULL) {
        return;
    }
    rlf_stage_release(*stage);
    rlf_free(*stage);
    *stage = NULL;
}

void rlf_reconstruct_reset(rlf_reconstruct *stage)
{
    if (!RLF_ASSERT(stage != NULL)) {
        return;
    }
    rlf_background_reset(&stage->background, &stage->grid);
    static_reset(&stage->background.thick);
    temporal_reset(&stage->steady, stage->grid.count);
    rlf_objects_reset(stage->objects, stage->grid.count);
    stage->family.count = 0;
    thin_reset(&stage->thin, &stage->grid);
    rlf_color_side_reset(stage);
    rlf_ego_motion_reset(&stage->ego);
    rlf_shadow_reset(&stage->shadow);
    stage->previous = NULL;
}

static rlf_result check_frame(const rlf_reconstruct *stage, const rlf_frame *frame)
{
    const rlf_camera *camera = &stage->def.rig.depth;
    if ((frame->depth_u16 == NULL) == (frame->depth_f32 == NULL)) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "reconstruct: frame %llu: set exactly one of depth_u16 and depth_f32",
                        (unsigned long long)frame->sequence);
    }
    ptrdiff_t sample = frame->depth_u16 != NULL ? 2 : 4;
    if (frame->depth_stride < sample * camera->width || frame->depth_stride % sample != 0) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "reconstruct: frame %llu: depth_stride is %lld; use at least %lld bytes, a "
                        "multiple of %d",
                        (unsigned long long)frame->sequence, (long long)frame->depth_stride,
                        (long long)(sample * camera->width), (int)sample);
    }
    double units = frame->depth_units_per_metre;
    if (frame->depth_u16 != NULL && (!(units > 0.0) || !rlf_is_finite(units))) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "reconstruct: frame %llu: depth_units_per_metre is %g; use 1000 for mm",
                        (unsigned long long)frame->sequence, units);
    }
    if (frame->rig != NULL &&
        (frame->rig->depth.width != camera->width || frame->rig->depth.height != camera->height)) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "reconstruct: frame %llu is %d x %d, the stage was made for %d x %d",
                        (unsigned long long)frame->sequence, (int)frame->rig->depth.width,
                        (int)frame->rig->depth.height, (int)camera->width, (int)camera->height);
    }
    return RLF_OK;
}

/* Depth and, with them, normals of the planes that explain the pixels. */
static void make_planes(rlf_reconstruct *stage, const float *depth, float *smooth, rlf_slot *slot)
{
    rlf_normals_job job = rlf_normals_job_make(stage, depth, slot->normal);
    job.smooth = smooth;
    job.frames = stage->work.zero_plane; /* less than one is one */
    if (stage->steady.frames != NULL) {
        rlf_lasting_measure(stage, depth);
        job.frames = stage->steady.frames;
        job.lasting = stage->steady.lasting.sigma;
    }
    rlf_normals_plane_fit(&job);
    rlf_normals_widen(stage, &job);
}

/* Normals at creases, of what no plane explains and of what was filled: outlines and what is beside
 * them go on from sharp creases, not from blended ones. */
static void complete_planes(rlf_reconstruct *stage, rlf_slot *slot)
{
    if (stage->def.enable_edge_normals) {
        rlf_normals_crease(stage, slot);
    }
    if (stage->steady.votes != NULL) {
        vote_lead(stage, slot, stage->work.was_seen);
    }
    if (stage->def.enable_fill && stage->def.enable_edge_normals) {
        const contour_scratch scratch = {{stage->scratch.contour.normal[0],
                                          stage->scratch.contour.normal[1],
                                          stage->scratch.contour.normal[2]},
                                         stage->scratch.contour.mark,
                                         stage->scratch.contour.front};
        rlf_normals_contour(stage, slot, stage->work.was_seen, &scratch);
    }
    rlf_normals_job job = rlf_normals_job_make(stage, slot->depth, slot->normal);
    rlf_normals_plane_complete(&job);
    rlf_stage_add_time(stage, RLF_SURFACE_COMPLETE);
}

/* Depth as it came, and without mixed pixels. */
static void read_depth(rlf_reconstruct *stage, const rlf_frame *frame, uint8_t *reason)
{
    rlf_work *work = &stage->work;
    depth_read(stage, frame, work->raw, reason);
    if (stage->def.background_method == RLF_BACKGROUND_ADAPTIVE) {
        rlf_ego_motion_watch(stage, work->raw);
    }
    rlf_stage_add_time(stage, RLF_SURFACE_READ);
    if (stage->def.enable_flying_removal) {
        flying_remove(stage, work->raw, work->kept, reason);
        rlf_stage_add_time(stage, RLF_SURFACE_FLYING);
    } else {
        memcpy(work->kept, work->raw, (size_t)stage->grid.count * sizeof *work->kept);
    }
}

/* Says where thin things must be though nothing is seen. */
static void track_thin(rlf_reconstruct *stage, const rlf_slot *slot)
{
    const thin_in in = {.grid = &stage->grid,
                        .noise = &stage->def.rig.noise,
                        .before = stage->previous,
                        .dt = rlf_stage_elapsed_s(stage, slot),
                        .depth = stage->work.kept,
                        .visited = stage->scratch.thin.visited};
    if (stage->thin.expected != NULL) {
        thin_track(&in, &stage->thin);
    }
}

/* Dropped pixels are recalled, noise is averaged over time. */
static void average_over_time(rlf_reconstruct *stage, uint8_t *reason)
{
    rlf_work *work = &stage->work;
    if (stage->def.enable_steadying) {
        if (stage->def.enable_hold) {
            temporal_recall(stage, work->raw, work->kept, reason, stage->scratch.temporal.change);
        }
        temporal_mean(stage, work->kept, reason, stage->scratch.temporal.lag);
        rlf_stage_add_time(stage, RLF_SURFACE_STEADY);
    }
}

/* Noise is averaged within planes, which have normals. */
static void smooth(rlf_reconstruct *stage, rlf_slot *slot)
{
    const float *kept = stage->work.kept;
    if (stage->def.enable_smoothing) {
        make_planes(stage, kept, slot->depth, slot);
        oversmooth_undo(stage, kept, slot->depth, slot->normal);
        rlf_stage_add_time(stage, RLF_SURFACE_SMOOTH);
    } else {
        memcpy(slot->depth, kept, (size_t)stage->grid.count * sizeof *kept);
    }
}

/* Small holes are filled; what was filled, and what no plane explains, gets normals. */
static void fill(rlf_reconstruct *stage, const rlf_frame *frame, rlf_slot *slot)
{
    if (stage->def.enable_fill) {
        rlf_shadow_learn(stage, stage->work.kept);
        rlf_color_side_start(stage, frame);
        rlf_fill_holes(stage, slot);
        rlf_color_side_learn(stage);
        rlf_stage_add_time(stage, RLF_SURFACE_FILL);
    }
    if (stage->def.enable_smoothing) {
        complete_planes(stage, slot);
    }
}

/* Thesis 4.4.1: the background's normals are computed once; per frame only the foreground's point
 * cloud has normals computed, by itself. */
static void make_layered_normals(rlf_reconstruct *stage, rlf_normals_job *job, rlf_slot *slot)
{
    const background_image *image = background_image_newest(stage);
    float *front = stage->scratch.layered.front;
    int32_t count = stage->grid.count;
    for (int32_t i = 0; i < count; i++) {
        front[i] = slot->foreground[i] ? slot->depth[i] : 0.0f;
    }
    job->depth = front;
    rlf_normals_compute(job);
    for (int k = 0; k < 3; k++) {
        for (int32_t i = 0; i < count; i++) {
            bool behind = !slot->foreground[i] && slot->depth[i] > 0.0f;
            slot->normal[k][i] = behind ? image->normal[k][i] : slot->normal[k][i];
        }
    }
}

static void make_normals(rlf_reconstruct *stage, rlf_slot *slot)
{
    rlf_normals_job job = rlf_normals_job_make(stage, slot->depth, slot->normal);
    bool exact = stage->def.normal_method == RLF_NORMALS_INVERSE_DEPTH;
    if (exact && stage->def.enable_smoothing && job.face_camera) {
        if (stage->steady.votes != NULL) {
            vote_normals(stage, slot);
        }
        return; /* the rest was made with the depth */
    }
    if (stage->def.enable_fill &&
        exact) { /* what was filled must not shape the normals of what was seen */
        job.depth = stage->work.kept;
        job.filled = slot->depth;
    }
    bool layered = stage->def.background_method == RLF_BACKGROUND_AVERAGE && !exact &&
                   background_image_newest(stage) != NULL;
    if (layered) {
        make_layered_normals(stage, &job, slot);
    } else {
        rlf_normals_compute(&job);
    }
}

/* Puts the background's regions first, so that the foreground's follow. */
static void copy_background_regions(const background_image *image, rlf_slot *slot)
{
    slot->foreground_region_first = image == NULL ? 0 : image->region_count;
    if (image == NULL) {
        return;
    }
    memcpy(slot->regions, image->regions, (size_t)image->region_count * sizeof *slot->regions);
    if (slot->region_points != NULL) {
        memcpy(slot->region_points, image->region_points,
               (size_t)image->point_count * sizeof *slot->region_points);
    }
}

static rlf_layer_in front_layer(const rlf_reconstruct *stage, const rlf_slot *slot)
{
    const rlf_slot *before = stage->previous;
    bool off = stage->def.background_method == RLF_BACKGROUND_OFF;
    rlf_layer_in in = {.layer = RLF_LAYER_FOREGROUND,
                       .method = stage->def.foreground_segment,
                       .depth = slot->depth,
                       .mask = off ? NULL : slot->foreground,
                       .spans = off ? NULL : stage->work.front,
                       .color = stage->has_color ? stage->work.color : NULL,
                       .has_components = stage->has_components,
                       .component_count = stage->component_count};
    if (before != NULL) {
        in.previous_label = before->label;
        in.previous_mask = off ? NULL : before->foreground;
        in.previous = before->regions + before->foreground_region_first;
        in.previous_count = before->foreground_region_count;
        in.elapsed_ns = rlf_stage_elapsed_ns(stage, slot);
    }
    return in;
}

/* What belongs to no region is noise. */
static void drop_pieces(const rlf_reconstruct *stage, rlf_slot *slot)
{
    const rlf_runs *runs = &stage->work.runs;
    for (int32_t y = 0; y < stage->grid.height; y++) {
        uint8_t *row = slot->foreground + (ptrdiff_t)y * stage->grid.width;
        for (int32_t r = runs->first[y]; r < runs->first[y + 1]; r++) {
            const rlf_run *run = &runs->run[r];
            if (run->component <= 0) {
                memset(row + run->x0, 0, (size_t)(run->x1 - run->x0));
            }
        }
    }
}

static rlf_layer_out segment_front(rlf_reconstruct *stage, rlf_slot *slot)
{
    const background_image *image = background_image_newest(stage);
    int32_t offset = image == NULL ? 0 : image->point_count;
    rlf_layer_in in = front_layer(stage, slot);
    rlf_layer_out out = {slot->regions + slot->foreground_region_first,
                         slot->region_points == NULL ? NULL : slot->region_points + offset, 0, 0};
    rlf_layer_segment(stage, &in, &out);
    for (int32_t r = 0; r < out.region_count && out.points != NULL; r++) {
        out.regions[r].first_point += offset;
    }
    if (in.method == RLF_SEGMENT_NOISE && in.mask != NULL) {
        if (out.points == NULL) { /* lists are complete already */
            rlf_region_adopt(stage, slot->depth, &out);
        }
        drop_pieces(stage, slot);
    }
    return out;
}

typedef struct label_job {
    const rlf_reconstruct *stage;
    const int32_t *background;
    rlf_slot *slot;
    int32_t valid[RLF_IMAGE_SIZE_MAX / RLF_ROW_GRAIN]; /* per chunk */
} label_job;

static void label_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    label_job *job = context;
    const rlf_slot *slot = job->slot;
    int32_t width = job->stage->grid.width;
    ptrdiff_t at = (ptrdiff_t)begin * width;
    job->valid[begin / RLF_ROW_GRAIN] =
        rlf_kernel_label_row(slot->depth + at, slot->foreground + at, job->background + at,
                             (end - begin) * width, slot->label + at);
}

/* Labels where the front sheet shows the background, and how much it shows. */
static void label_background(rlf_reconstruct *stage, rlf_slot *slot)
{
    const background_image *image = background_image_newest(stage);
    label_job job = {.stage = stage,
                     .background = image != NULL ? image->label : stage->work.zero_labels,
                     .slot = slot};
    rlf_parallel_for(stage->def.pool, stage->grid.height, RLF_ROW_GRAIN, label_rows, &job);
    slot->surface.valid_count = 0;
    for (int32_t y = 0; y < stage->grid.height; y += RLF_ROW_GRAIN) {
        slot->surface.valid_count += job.valid[y / RLF_ROW_GRAIN];
    }
}

/* While the background is learnt, what is seen is taken to be it: regions from the first frame on.
 */
static void segment_first(rlf_reconstruct *stage, rlf_slot *slot)
{
    const rlf_slot *before = stage->previous;
    rlf_layer_in in = {.layer = RLF_LAYER_BACKGROUND,
                       .method = stage->def.background_segment,
                       .depth = slot->depth,
                       .normal = slot->normal,
                       .color = stage->has_color ? stage->work.color : NULL};
    if (before != NULL) {
        in.previous_label = before->label;
        in.previous = before->regions;
        in.previous_count = before->foreground_region_first;
        in.elapsed_ns = rlf_stage_elapsed_ns(stage, slot);
    }
    rlf_layer_out out = {slot->regions, slot->region_points, 0, 0};
    rlf_layer_segment(stage, &in, &out);
    slot->foreground_region_first = out.region_count;
    rlf_region_write_labels(stage, &out, slot->label);
    /* The steps that follow read the runs as the foreground's, and there is none. */
    memset(stage->work.runs.first, 0,
           (size_t)(stage->grid.height + 1) * sizeof *stage->work.runs.first);
}

static void make_regions(rlf_reconstruct *stage, rlf_slot *slot)
{
    copy_background_regions(background_image_newest(stage), slot);
    bool off = stage->def.background_method == RLF_BACKGROUND_OFF;
    bool has_front = off || stage->background.state == RLF_BACKGROUND_READY;
    rlf_layer_out out = {NULL, NULL, 0, 0};
    if (has_front) {
        out = segment_front(stage, slot);
    }
    slot->foreground_region_count = out.region_count;
    label_background(stage, slot);
    if (has_front) {
        rlf_region_write_labels(stage, &out, slot->label);
    } else if (stage->objects != NULL) {
        segment_first(stage, slot);
    }
}

static int32_t count_foreground(const rlf_reconstruct *stage, const rlf_slot *slot)
{
    int32_t count = 0;
    for (int32_t i = 0; i < stage->grid.count; i++) {
        count += slot->foreground[i];
    }
    return count;
}

static void publish(rlf_reconstruct *stage, const rlf_frame *frame, rlf_slot *slot)
{
    const background_image *image = background_image_newest(stage);
    rlf_surface *s = &slot->surface;
    s->sequence = frame->sequence;
    s->width = stage->grid.width;
    s->height = stage->grid.height;
    s->scale_factor = stage->grid.factor;
    s->camera = stage->grid.camera;
    s->noise = stage->def.rig.noise;
    s->ray_x = stage->grid.ray_x;
    s->ray_y = stage->grid.ray_y;
    s->depth = slot->depth;
    s->normal_x = slot->normal[0];
    s->normal_y = slot->normal[1];
    s->normal_z = slot->normal[2];
    s->velocity_x = slot->velocity[0];
    s->velocity_y = slot->velocity[1];
    s->velocity_z = slot->velocity[2];
    s->thickness = slot->thickness;
    s->label = slot->label;
    s->reason = slot->reason;
    s->foreground = slot->foreground;
    const float *none = stage->work.zero_plane;
    s->background_depth = image == NULL ? none : image->depth;
    s->background_normal_x = image == NULL ? none : image->normal[0];
    s->background_normal_y = image == NULL ? none : image->normal[1];
    s->background_normal_z = image == NULL ? none : image->normal[2];
    s->background_label = image == NULL ? stage->work.zero_labels : image->label;
    const float *thickness = static_newest(stage);
    int32_t publications = stage->background.thick.publications;
    s->background_thickness = thickness == NULL ? none : thickness;
    s->background_version = image == NULL ? 0 : (int64_t)image->version + publications;
    s->background_state = stage->background.state;
    s->camera_moves = stage->ego.moves;
    s->regions = slot->regions;
    s->region_count = slot->foreground_region_first + slot->foreground_region_count;
    s->region_points = slot->region_points;
    s->foreground_count = count_foreground(stage, slot);
}

rlf_result rlf_reconstruct_process(rlf_reconstruct *stage, const rlf_frame *frame,
                                   const rlf_surface **out_surface)
{
    if (!RLF_ASSERT(stage != NULL && frame != NULL && out_surface != NULL)) {
        return rlf_fail(RLF_ERROR_INVALID, "reconstruct: NULL argument");
    }
    *out_surface = NULL;
    rlf_result result = check_frame(stage, frame);
    if (result != RLF_OK) {
        return result;
    }
    stage->current = (stage->current + 1) % RLF_RECONSTRUCT_SURFACES;
    rlf_slot *slot = &stage->ring[stage->current];
    slot->surface.time_ns = frame->time_ns;
    rlf_stage_start_times(stage);
    read_depth(stage, frame, slot->reason);
    track_thin(stage, slot);
    average_over_time(stage, slot->reason);
    smooth(stage, slot);
    fill(stage, frame, slot);
    rlf_color_sample(stage, frame, slot->depth);
    rlf_background_update(stage, slot);
    rlf_color_learn(stage, slot->foreground);
    rlf_stage_add_time(stage, RLF_SURFACE_BACKGROUND);
    make_normals(stage, slot);
    rlf_stage_add_time(stage, RLF_SURFACE_NORMALS);
    make_regions(stage, slot);
    rlf_stage_add_time(stage, RLF_SURFACE_SEGMENT);
    if (stage->def.enable_velocity) {
        rlf_velocity_estimate(stage, slot);
        thin_keep_velocity(&stage->thin, stage->previous, &stage->grid, slot);
        rlf_stage_add_time(stage, RLF_SURFACE_VELOCITY);
    }
    if (stage->def.enable_thickness) {
        rlf_thickness_estimate(stage, slot, stage->work.kept);
        thin_write(&stage->thin, &stage->grid, stage->background.mean, slot);
        static_advance(stage);
        rlf_stage_add_time(stage, RLF_SURFACE_THICKNESS);
    }
    rlf_ego_motion_remember(stage, slot);
    publish(stage, frame, slot);
    rlf_stage_add_time(stage, RLF_SURFACE_PUBLISH);
    stage->previous = slot;
    *out_surface = &slot->surface;
    return RLF_OK;
}
