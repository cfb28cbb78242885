/* What is in a folder, for the small list that files are chosen from. Knows no window. */
#ifndef RLF_VIEWER_FILES_H
#define RLF_VIEWER_FILES_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define VIEWER_FILES_MAX 512
#define VIEWER_FILES_PATH 1024

typedef struct viewer_file {
    char name[256];
    bool is_folder;
} viewer_file;

typedef struct viewer_files {
    char folder[VIEWER_FILES_PATH];     /* absolute */
    viewer_file list[VIEWER_FILES_MAX]; /* folders first, each by name */
    int32_t count;
} viewer_files;

/* Looks into `name` of the folder, ".." being the one above it; "" = the folder itself, which is
 * the working folder at first. Of files those whose name ends as one of `endings` (".glb .obj"),
 * NULL = all; hidden ones are left out. False, and all as it was, when it cannot be read. */
bool viewer_files_enter(viewer_files *files, const char *name, const char *endings);
/* Path of one of the list, "" for an empty name: the folder's. False when it is too long. */
bool viewer_files_path(const viewer_files *files, const char *name, char out[VIEWER_FILES_PATH]);

#ifdef __cplusplus
}
#endif

#endif
