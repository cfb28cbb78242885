/* Reads a folder. */
#define _XOPEN_SOURCE 700
#include "viewer/files.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static int compare(const void *a, const void *b)
{
    const viewer_file *one = a, *other = b;
    return one->is_folder != other->is_folder ? (one->is_folder ? -1 : 1)
                                              : strcmp(one->name, other->name);
}

static bool is_wanted(const char *name, const char *endings)
{
    const char *dot = strrchr(name, '.');
    const char *found = dot != NULL && endings != NULL ? strstr(endings, dot) : NULL;
    const size_t length = dot != NULL ? strlen(dot) : 0;
    return endings == NULL || (found != NULL && (found[length] == ' ' || found[length] == '\0'));
}

bool viewer_files_path(const viewer_files *files, const char *name, char out[VIEWER_FILES_PATH])
{
    const size_t end = strlen(files->folder);
    const bool has_slash = end > 0 && files->folder[end - 1] == '/';
    const int length = name[0] == '\0' ? snprintf(out, VIEWER_FILES_PATH, "%s", files->folder)
                                       : snprintf(out, VIEWER_FILES_PATH, "%s%s%s", files->folder,
                                                  has_slash ? "" : "/", name);
    return length > 0 && length < VIEWER_FILES_PATH;
}

static void read_all(viewer_files *files, DIR *folder, const char *endings)
{
    const struct dirent *entry;
    files->count = 0;
    while (files->count < VIEWER_FILES_MAX && (entry = readdir(folder)) != NULL) {
        char path[VIEWER_FILES_PATH];
        struct stat status;
        viewer_file *file = &files->list[files->count];
        if (entry->d_name[0] == '.' || strlen(entry->d_name) >= sizeof file->name ||
            !viewer_files_path(files, entry->d_name, path) || stat(path, &status) != 0) {
            continue;
        }
        file->is_folder = S_ISDIR(status.st_mode);
        (void)snprintf(file->name, sizeof file->name, "%s", entry->d_name);
        files->count += file->is_folder || is_wanted(file->name, endings) ? 1 : 0;
    }
    qsort(files->list, (size_t)files->count, sizeof *files->list, compare);
}

bool viewer_files_enter(viewer_files *files, const char *name, const char *endings)
{
    char path[VIEWER_FILES_PATH] = ".";
    if (files->folder[0] != '\0' && !viewer_files_path(files, name, path)) {
        return false;
    }
    char *whole = realpath(path, NULL);
    DIR *folder = whole != NULL && strlen(whole) < sizeof files->folder ? opendir(whole) : NULL;
    if (folder != NULL) {
        (void)snprintf(files->folder, sizeof files->folder, "%s", whole);
        read_all(files, folder, endings);
        (void)closedir(folder);
    }
    free(whole);
    return folder != NULL;
}
