/* Lists of timestamped files: depth.txt and rgb.txt of the TUM RGB-D layout. */
#ifndef RLF_IO_FRAME_LIST_H
#define RLF_IO_FRAME_LIST_H

#include "io/file.h"

#define IO_LIST_FILE_MAX ((size_t)256 << 20)

typedef struct io_list_entry {
    int64_t time_ns;
    int32_t line;     /* in the file, from 1 */
    const char *name; /* as written, usually relative to the folder */
} io_list_entry;

/* Entries in order of time; equal times keep the order of the file. */
typedef struct io_frame_list {
    io_list_entry *entries;
    int32_t count;
    char *text; /* holds the names */
} io_frame_list;

/* Lines "SECONDS NAME", or in another unit that is beyond doubt (time_unit.h), which is told; empty
 * lines and lines that start with # are skipped. Times that go backwards are sorted, with a
 * warning. */
rlf_result io_frame_list_parse(const io_bytes *file, io_frame_list *out);
void io_frame_list_free(io_frame_list *list);

#endif
