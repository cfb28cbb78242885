/* What a recording of Relief's own says beside its pictures. */
#ifndef RLF_IO_MCAP_ORIGIN_H
#define RLF_IO_MCAP_ORIGIN_H

#include "io/clip/clip.h"
#include "io/mcap/read.h"

/* The channel of that type and topic that has messages; -1 = none. */
int32_t io_mcap_find_topic(const io_mcap_reader *reader, io_ros_type type, const char *topic);
/* What ROS has no message for, from the metadata; nonsense changes nothing. */
double io_mcap_number(const io_mcap_reader *reader, const char *key, double low, double high,
                      double otherwise);
/* What its source said beside the calibration; without the notes. */
void io_mcap_read_origin(const io_mcap_reader *reader, io_clip_origin *out);
/* The notes of its frames, in a new array that *origin borrows; NULL when there are none. */
io_frame_note *io_mcap_read_notes(io_mcap_reader *reader, io_clip_origin *origin);

#endif
