/* Whole files in, whole files out. */
#ifndef RLF_IO_FILE_H
#define RLF_IO_FILE_H

#include "relief/base.h"

#include <stdbool.h>
#include <stdio.h>

#define IO_PATH_MAX 4096 /* bytes of a path, with its ending zero */

/* Content of a file in memory; `name` is what error lines call it. */
typedef struct io_bytes {
    const char *name;
    const uint8_t *data;
    size_t size;
} io_bytes;

/* A text without the mark that some editors put before it (EF BB BF). */
io_bytes io_bytes_unmarked(const io_bytes *text);
/* How many lines a text has at most. */
size_t io_bytes_lines(const io_bytes *text);

/* Memory that grows to the largest file read so far. Free with io_buffer_free. */
typedef struct io_buffer {
    uint8_t *data;
    size_t capacity;
} io_buffer;

/* Makes room for `size` bytes; the old content is lost. */
rlf_result io_buffer_reserve(io_buffer *buffer, size_t size);
void io_buffer_free(io_buffer *buffer);

/* Makes room for `more` items behind the `count` of a list that has room for *room; they are moved,
 * and *items with them. */
rlf_result io_list_grow(void **items, int32_t count, int64_t more, int32_t *room, size_t size);

/* A regular file that is read here and there. */
typedef struct io_file {
    char path[IO_PATH_MAX];
    int descriptor; /* -1 = none */
    int64_t size;   /* bytes */
} io_file;

/* Opens a regular file; pipes and devices, which could keep the caller waiting, are refused. `cure`
 * ends the error line when the file is not there. On failure nothing is open. */
rlf_result io_file_open(io_file *file, const char *path, const char *cure);
void io_file_close(io_file *file);
/* At most `size` bytes from `position` on; returns how many there were. Thread-safe. */
size_t io_file_read_at(const io_file *file, int64_t position, void *out, size_t size);
/* Exactly `size` bytes into the buffer, with the file's name in *out. RLF_ERROR_IO when they are
 * not all there. */
rlf_result io_file_read_bytes(const io_file *file, int64_t position, size_t size, io_buffer *buffer,
                              io_bytes *out);

/* Reads a whole regular file of at most `limit` bytes. *out points into the buffer and has the name
 * `path`. `cure` as above. */
rlf_result io_file_read(const char *path, size_t limit, const char *cure, io_buffer *buffer,
                        io_bytes *out);

/* Whether there is anything of that name, and whether that is a folder. */
bool io_path_exists(const char *path);
bool io_path_is_folder(const char *path);
/* Whether the folder holds anything of that name. */
bool io_folder_has(const char *folder, const char *name);

/* folder/name, or name alone when it is absolute. */
rlf_result io_path_join(const char *folder, const char *name, char out[IO_PATH_MAX]);

/* A file being written, under a name of its own until it is whole: FILE.PID-N.part, which nobody
 * else has and which follows no link. A target that exists and is no regular file (a pipe,
 * /dev/null) is written directly, because renaming onto it would replace the device. */
typedef struct io_out_file {
    FILE *stream;
    int write_errno; /* of the first failed write; 0 = none */
    bool is_direct;
    char path[IO_PATH_MAX];
    char part[IO_PATH_MAX]; /* what is written to; equals path when is_direct */
} io_out_file;

/* Opens; refuses folders. */
rlf_result io_out_open(io_out_file *file, const char *path);
rlf_result io_out_write(io_out_file *file, const void *data, size_t size);
/* `count` numbers of `size` bytes, little-endian. */
rlf_result io_out_write_numbers(io_out_file *file, const void *numbers, size_t count, size_t size);
/* RLF_OK given: flushes, closes and gives the file its name. An error given, or met: removes the
 * part file. Returns the first error. */
rlf_result io_out_close(io_out_file *file, rlf_result result);

/* The two steps of closing, for files that shall appear together or not at all: all are finished,
 * and then all get their names or all are removed. */
rlf_result io_out_finish(io_out_file *file, rlf_result result);
rlf_result io_out_settle(const io_out_file *file, rlf_result result);

/* Opens a file that is written in place, so that what was written is kept when the program is
 * killed, and empties it. An error while another program writes it. */
rlf_result io_out_open_in_place(const char *path, int *out_descriptor);

/* ---- Decimal numbers with a point, whatever the program's locale says ---- */

#define IO_NUMBER_SIZE 32 /* bytes that io_number_format may write, with the ending zero */

/* Nine significant digits ("%.9g"). Returns the length. */
int io_number_format(double x, char out[IO_NUMBER_SIZE]);

/* Reads a whole token, e.g. "-1.5e3". False when it is not a finite number. */
bool io_number_parse(const char *token, double *out);

/* What open sources read, so that no writer overwrites it: files and folders by device and inode,
 * which links do not hide. */

/* A folder that is read; all zero = none. */
typedef struct io_reading {
    uint64_t device, inode;
} io_reading;

/* An open file is being read from now on, and no more: both while it is open. */
void io_reading_begin_file(int descriptor);
void io_reading_end_file(int descriptor);
/* So is a folder, with the pictures and lists in it. */
io_reading io_reading_begin_folder(const char *path);
void io_reading_end_folder(io_reading *folder);

/* RLF_ERROR_INVALID when writing that file would change what is being read. */
rlf_result io_reading_check_file(const char *path);
/* The same of files that get names of their own in a folder. */
rlf_result io_reading_check_folder(const char *path);

#endif
