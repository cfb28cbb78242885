/* Lists of pictures made from the names in a folder. */
#ifndef RLF_IO_FOLDER_NUMBERED_FILES_H
#define RLF_IO_FOLDER_NUMBERED_FILES_H

#include "io/folder/frame_list.h"

#define IO_NUMBERED_RATE 30 /* frames per second when the names hold numbers only */

/* Files of folder/sub ("" = the folder itself) whose names begin with `prefix`, go on with a number
 * and end with one of `endings` (NULL after the last). Times are number / 30 s, or, of names like
 * 000012-000000400320.png, the microseconds after the minus. In order of time. No such folder gives
 * an empty list. */
rlf_result io_numbered_list(const char *folder, const char *sub, const char *prefix,
                            const char *const *endings, io_frame_list *out);

#endif
