/* What a recording keeps of a frame that its pictures and their times do not tell. */
#ifndef RLF_IO_CLIP_FRAME_NOTE_H
#define RLF_IO_CLIP_FRAME_NOTE_H

#include "relief/frame.h"

/* Colour farther in time than this shows something else than the depth (one and a half frames at
 * 30 per second; TUM clips differ by up to 20 ms). */
#define IO_COLOR_GAP_MAX_NS INT64_C(50000000)

#define IO_FRAME_NOTE_TEXT 128

/* A frame is as usual when its number is one more than that of the frame before (0 for the first),
 * its flags are those of the whole recording, and its colour is the picture nearest in time. */
typedef struct io_frame_note {
    int64_t time_ns; /* of the frame */
    uint64_t sequence;
    uint32_t flags;
    bool has_color;
    int64_t color_time_ns;
} io_frame_note;

/* Follows the frames of a recording and says which of them are not as usual. */
typedef struct io_frame_notes {
    uint32_t flags;        /* of the whole recording */
    bool has_color_camera; /* else no frame has colour, which is as usual */
    bool has_last, has_color;
    uint64_t last_sequence;
    int64_t color_ns[2];  /* the last two pictures */
    io_frame_note opener; /* the first frame with the last picture, while it is not noted */
} io_frame_notes;

/* Writes at most two notes: of this frame, and of an earlier one to which this frame's picture is
 * nearer than its own. Returns how many. */
int32_t io_frame_notes_add(io_frame_notes *notes, const rlf_frame *frame, io_frame_note out[2]);

/* One line of JSON. */
void io_frame_note_print(const io_frame_note *note, char out[IO_FRAME_NOTE_TEXT]);
/* False for a text that is none. */
bool io_frame_note_parse(const char *text, io_frame_note *out);

/* The note of the frame with that time, of a list that is sorted by time; NULL = there is none. */
const io_frame_note *io_frame_note_find(const io_frame_note *notes, int32_t count, int64_t time_ns);
void io_frame_notes_sort(io_frame_note *notes, int32_t count);

#endif
