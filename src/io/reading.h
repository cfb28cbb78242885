/* What open sources read, so that no writer overwrites it: files and folders by device and inode,
 * which links do not hide. Thread-safe. */
#ifndef RLF_IO_READING_H
#define RLF_IO_READING_H

#include "relief/base.h"

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
