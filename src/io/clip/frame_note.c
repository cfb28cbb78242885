/* What a recording keeps of a frame that its pictures and their times do not tell. */
#include "io/clip/clip.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

static uint64_t gap(int64_t a, int64_t b)
{
    return a > b ? (uint64_t)a - (uint64_t)b : (uint64_t)b - (uint64_t)a;
}

/* Whether a reader that takes the nearest picture takes this frame's own, as far as is known. */
static bool is_color_usual(const io_frame_notes *n, const io_frame_note *f)
{
    if (!f->has_color) {
        return false;
    }
    const uint64_t own = gap(f->color_time_ns, f->time_ns);
    const bool is_next = !n->has_color || f->color_time_ns > n->color_ns[1];
    const bool is_nearest = !n->has_color || own < gap(n->color_ns[1], f->time_ns);
    return own <= (uint64_t)IO_COLOR_GAP_MAX_NS && is_next && is_nearest;
}

int32_t io_frame_notes_add(io_frame_notes *n, const rlf_frame *frame, io_frame_note out[2])
{
    const io_frame_note f = {.time_ns = frame->time_ns,
                             .sequence = frame->sequence,
                             .flags = frame->flags,
                             .has_color = n->has_color_camera && frame->color.data != NULL,
                             .color_time_ns =
                                 frame->color_time_ns != 0 ? frame->color_time_ns : frame->time_ns};
    int32_t count = 0;
    const bool is_new = f.has_color && (!n->has_color || f.color_time_ns != n->color_ns[1]);
    if (is_new && n->opener.has_color &&
        gap(f.color_time_ns, n->opener.time_ns) < gap(n->opener.color_time_ns, n->opener.time_ns)) {
        out[count++] = n->opener;
    }
    const bool is_usual = f.sequence == (n->has_last ? n->last_sequence + 1 : 0) &&
                          f.flags == n->flags && (!n->has_color_camera || is_color_usual(n, &f));
    if (!is_usual) {
        out[count++] = f;
    }
    if (is_new) {
        n->color_ns[0] = n->color_ns[1];
        n->color_ns[1] = f.color_time_ns;
        n->opener = is_usual ? f : (io_frame_note){0};
        n->has_color = true;
    }
    n->has_last = true;
    n->last_sequence = f.sequence;
    return count;
}

void io_frame_note_print(const io_frame_note *f, char out[IO_FRAME_NOTE_TEXT])
{
    char color[32] = "null";
    if (f->has_color) {
        (void)snprintf(color, sizeof(color), "%" PRId64, f->color_time_ns);
    }
    (void)snprintf(out, IO_FRAME_NOTE_TEXT,
                   "{\"stamp_ns\": %" PRId64 ", \"sequence\": %" PRIu64
                   ", \"flags\": %u, \"color_ns\": %s}",
                   f->time_ns, f->sequence, (unsigned)f->flags, color);
}

bool io_frame_note_parse(const char *text, io_frame_note *out)
{
    unsigned flags = 0;
    *out = (io_frame_note){0};
    const int count = sscanf(text,
                             "{\"stamp_ns\": %" SCNd64 ", \"sequence\": %" SCNu64
                             ", \"flags\": %u, \"color_ns\": %" SCNd64,
                             &out->time_ns, &out->sequence, &flags, &out->color_time_ns);
    out->flags = flags;
    out->has_color = count == 4;
    return count >= 3;
}

static int compare_times(const void *a, const void *b)
{
    const io_frame_note *x = a;
    const io_frame_note *y = b;
    return (x->time_ns > y->time_ns) - (x->time_ns < y->time_ns);
}

void io_frame_notes_sort(io_frame_note *notes, int32_t count)
{
    if (count > 1) {
        qsort(notes, (size_t)count, sizeof(notes[0]), compare_times);
    }
}

const io_frame_note *io_frame_note_find(const io_frame_note *notes, int32_t count, int64_t time_ns)
{
    const io_frame_note wanted = {.time_ns = time_ns};
    return count > 0 ? bsearch(&wanted, notes, (size_t)count, sizeof(notes[0]), compare_times)
                     : NULL;
}
