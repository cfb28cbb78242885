/* Pictures of a folder that nothing lists, in the order of their names. */
#ifndef RLF_IO_FOLDER_NAMED_FILES_H
#define RLF_IO_FOLDER_NAMED_FILES_H

#include "io/folder/frame_list.h"

/* Files of folder/sub ("" = the folder itself) whose names hold `word` ("" = any) and end with one
 * of `endings` (NULL after the last), in natural order: 2 before 10. The n-th is n / 30 s. No such
 * folder gives an empty list. */
rlf_result io_named_list(const char *folder, const char *sub, const char *word,
                         const char *const *endings, io_frame_list *out);
/* Gives both lists the times of the numbers in their names (the last of each name), where all have
 * one. Else pictures go together one by one, if there are as many of depth as of colour. False:
 * nobody knows which go together. */
bool io_named_pair(io_frame_list *depth, io_frame_list *color);

#endif
