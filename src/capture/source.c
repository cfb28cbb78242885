/* The source object: caller's methods plus what is constant about them. */

#include "camera/checks.h"
#include "capture/depth_checks.h"

struct rlf_source {
    rlf_source_methods methods;
    rlf_source_info info;
    void *self;
    uint64_t given;
    range_watch range;
    char *corrected;      /* two planes of depth without its offset: of next, and of observe */
    rlf_frame_fn watcher; /* what observe calls when there is an offset */
    void *watcher_context;
};

static rlf_result check_info(const rlf_source_info *info)
{
    const double rate = info->frames_per_second;
    if (!(rate >= 0.0) || !rlf_is_finite(rate)) {
        return rlf_fail(RLF_ERROR_INVALID, "source: frames_per_second is %g; use 0 for unknown",
                        rate);
    }
    if (!rlf_vec3_is_finite(info->gravity)) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "source: gravity is not finite; use 0, 0, 0 for unknown");
    }
    return rig_check(&info->rig, "source");
}

rlf_result rlf_source_create_custom(const rlf_source_methods *methods, const rlf_source_info *info,
                                    void *self, rlf_source **out)
{
    if (!RLF_ASSERT(methods != NULL && methods->next != NULL && info != NULL && out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    *out = NULL;
    rlf_result result = check_info(info);
    if (result != RLF_OK) {
        return result;
    }
    rlf_source *source = rlf_alloc(sizeof(*source));
    const size_t plane = depth_offset_size(&info->rig);
    char *corrected = plane > 0 ? rlf_alloc_array(2, plane) : NULL;
    if (source == NULL || (plane > 0 && corrected == NULL)) {
        rlf_free(corrected);
        rlf_free(source);
        return RLF_ERROR_MEMORY;
    }
    *source = (rlf_source){.methods = *methods, .info = *info, .corrected = corrected};
    source->info.name[sizeof(source->info.name) - 1] = '\0';
    source->self = self;
    source->range = (range_watch){.min_m = info->rig.depth_min_m, .max_m = info->rig.depth_max_m};
    *out = source;
    return RLF_OK;
}

void rlf_source_destroy(rlf_source **source)
{
    if (source == NULL || *source == NULL) {
        return;
    }
    if ((*source)->methods.destroy != NULL) {
        (*source)->methods.destroy((*source)->self);
    }
    rlf_free((*source)->corrected);
    rlf_free(*source);
    *source = NULL;
}

const rlf_source_info *rlf_source_get_info(const rlf_source *source)
{
    return RLF_ASSERT(source != NULL) ? &source->info : NULL;
}

rlf_result rlf_source_next(rlf_source *source, rlf_frame *out_frame)
{
    if (!RLF_ASSERT(source != NULL && out_frame != NULL)) {
        return RLF_ERROR_INVALID;
    }
    rlf_frame frame = {.rig = &source->info.rig};
    rlf_result result = source->methods.next(source->self, &frame);
    frame.rig = &source->info.rig;
    if (result == RLF_OK) {
        result = rlf_frame_check(&source->info.rig, &frame, source->info.name);
    }
    if (result == RLF_OK) {
        if (source->corrected != NULL) {
            depth_offset_take(&source->info.rig, source->corrected, &frame);
        }
        range_watch_see(&source->range, source->info.name, &frame);
        *out_frame = frame;
        source->given++;
    }
    return result;
}

void rlf_source_expect_range(rlf_source *source, double min_m, double max_m)
{
    if (RLF_ASSERT(source != NULL)) {
        source->range.min_m = min_m;
        source->range.max_m = max_m;
    }
}

rlf_result rlf_source_restart(rlf_source *source)
{
    if (!RLF_ASSERT(source != NULL)) {
        return RLF_ERROR_INVALID;
    }
    if (source->methods.restart == NULL) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED, "%s: this source cannot start again; open it anew",
                        source->info.name);
    }
    return source->methods.restart(source->self);
}

rlf_result rlf_source_seek(rlf_source *source, int64_t index)
{
    if (!RLF_ASSERT(source != NULL)) {
        return RLF_ERROR_INVALID;
    }
    const rlf_source_info *info = &source->info;
    if (source->methods.seek == NULL) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED, "%s: this source has no position to go to",
                        info->name);
    }
    if (index < 0 || (info->frame_count >= 0 && index >= info->frame_count)) {
        return rlf_fail(RLF_ERROR_INVALID, "%s: there is no frame %lld: use 0 to %lld", info->name,
                        (long long)index, (long long)info->frame_count - 1);
    }
    return source->methods.seek(source->self, index);
}

static void watch(void *context, const rlf_frame *frame)
{
    const rlf_source *source = context;
    rlf_frame corrected = *frame;
    depth_offset_take(&source->info.rig, source->corrected + depth_offset_size(&source->info.rig),
                      &corrected);
    source->watcher(source->watcher_context, &corrected);
}

bool rlf_source_observe(rlf_source *source, rlf_frame_fn fn, void *context)
{
    if (!RLF_ASSERT(source != NULL) || source->methods.observe == NULL) {
        return false;
    }
    if (source->corrected == NULL) {
        source->methods.observe(source->self, fn, context);
        return true;
    }
    source->methods.observe(source->self, NULL, NULL); /* nobody reads what changes now */
    source->watcher = fn;
    source->watcher_context = context;
    if (fn != NULL) {
        source->methods.observe(source->self, watch, source);
    }
    return true;
}

rlf_source_status rlf_source_get_status(const rlf_source *source)
{
    rlf_source_status status = {.is_connected = true};
    if (!RLF_ASSERT(source != NULL)) {
        return status;
    }
    if (source->methods.status != NULL) {
        source->methods.status(source->self, &status);
    }
    status.given = source->given;
    return status;
}

const rlf_truth *rlf_source_get_truth(rlf_source *source)
{
    if (!RLF_ASSERT(source != NULL) || source->methods.truth == NULL) {
        return NULL;
    }
    return source->methods.truth(source->self);
}

void *rlf_source_get_self(const rlf_source *source, rlf_source_next_fn next)
{
    return source != NULL && source->methods.next == next ? source->self : NULL;
}
