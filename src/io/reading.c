/* What open sources read, so that no writer overwrites it. */
#define _XOPEN_SOURCE 700 /* realpath */
#include "io/file.h"

#include <dirent.h>
#include <limits.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#define READINGS_MAX 256 /* at a time; more are not watched */

typedef struct entry {
    io_reading id;
    int32_t count;       /* of those that read it; 0 = the place is free */
    char path[PATH_MAX]; /* of a folder, without links; "" = a file */
} entry;

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static entry entries[READINGS_MAX];

/* Where the pictures of a clip lie, below its folder. */
static const char *const parts[] = {"depth", "rgb", "color", "image"};

static io_reading id_of(const struct stat *status)
{
    return (io_reading){(uint64_t)status->st_dev, (uint64_t)status->st_ino};
}

static bool is_same(const io_reading *a, const io_reading *b)
{
    return a->device == b->device && a->inode == b->inode;
}

/* Whether folder/name is that file or folder. */
static bool is_named(const io_reading *id, const char *folder, const char *name)
{
    char path[PATH_MAX];
    struct stat status;
    const int length = snprintf(path, sizeof(path), "%s/%s", folder, name);
    if (length < 0 || length >= (int)sizeof(path) || stat(path, &status) != 0) {
        return false;
    }
    const io_reading other = id_of(&status);
    return is_same(&other, id);
}

/* With the lock held; NULL = it is not read. */
static entry *find(const io_reading *id)
{
    for (int i = 0; i < READINGS_MAX; i++) {
        if (entries[i].count > 0 && is_same(&entries[i].id, id)) {
            return &entries[i];
        }
    }
    return NULL;
}

static void begin(const io_reading *id, const char *path)
{
    pthread_mutex_lock(&lock);
    entry *e = find(id);
    for (int i = 0; i < READINGS_MAX && e == NULL; i++) {
        if (entries[i].count == 0) {
            e = &entries[i];
            e->id = *id;
            if (realpath(path, e->path) == NULL) {
                e->path[0] = '\0';
            }
        }
    }
    if (e != NULL) {
        e->count++;
    }
    pthread_mutex_unlock(&lock);
}

static void end(const io_reading *id)
{
    pthread_mutex_lock(&lock);
    entry *e = find(id);
    if (e != NULL) {
        e->count--;
    }
    pthread_mutex_unlock(&lock);
}

void io_reading_begin_file(int descriptor)
{
    struct stat status;
    if (fstat(descriptor, &status) == 0) {
        const io_reading id = id_of(&status);
        begin(&id, "");
    }
}

void io_reading_end_file(int descriptor)
{
    struct stat status;
    if (fstat(descriptor, &status) == 0) {
        const io_reading id = id_of(&status);
        end(&id);
    }
}

io_reading io_reading_begin_folder(const char *path)
{
    struct stat status;
    if (stat(path, &status) != 0 || !S_ISDIR(status.st_mode)) {
        return (io_reading){0};
    }
    const io_reading id = id_of(&status);
    begin(&id, path);
    return id;
}

void io_reading_end_folder(io_reading *folder)
{
    end(folder);
    *folder = (io_reading){0};
}

/* ---- what is asked -------------------------------------------------------------------------- */

/* Of the kinds that a clip consists of; others may lie beside it. */
static bool is_of_clip(const char *path)
{
    static const char *const endings[] = {".png", ".jpg", ".jpeg", ".txt",  ".json",
                                          ".log", ".pcd", ".yml",  ".yaml", ".freiburg"};
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; dot != NULL && i < sizeof(endings) / sizeof(endings[0]); i++) {
        if (strcasecmp(dot, endings[i]) == 0) {
            return true;
        }
    }
    return false;
}

static bool is_below(const char *path, const char *folder)
{
    const size_t length = strlen(folder);
    return strncmp(path, folder, length) == 0 && path[length] == '/';
}

/* Whether a file that has several names has one of them in that folder. */
static bool has_name_in(const io_reading *id, const char *folder)
{
    DIR *directory = opendir(folder);
    bool is_found = false;
    for (struct dirent *d = directory != NULL ? readdir(directory) : NULL; d != NULL && !is_found;
         d = readdir(directory)) {
        is_found = is_named(id, folder, d->d_name);
    }
    if (directory != NULL) {
        closedir(directory);
    }
    return is_found;
}

static bool is_in_clip(const struct stat *status, const char *path)
{
    char place[PATH_MAX];
    if (realpath(path, place) == NULL || !is_of_clip(place)) {
        return false;
    }
    const io_reading id = id_of(status);
    bool is_found = false;
    for (int i = 0; i < READINGS_MAX && !is_found; i++) {
        const entry *e = &entries[i];
        if (e->count > 0 && e->path[0] != '\0') {
            is_found =
                is_below(place, e->path) || (status->st_nlink > 1 && has_name_in(&id, e->path));
        }
    }
    return is_found;
}

static rlf_result fail(const char *path)
{
    return rlf_fail(RLF_ERROR_INVALID, "%s: cannot be written while it is read: give another name",
                    path);
}

rlf_result io_reading_check_file(const char *path)
{
    struct stat status;
    if (stat(path, &status) != 0 || !S_ISREG(status.st_mode)) {
        return RLF_OK;
    }
    const io_reading id = id_of(&status);
    pthread_mutex_lock(&lock);
    const bool is_read = find(&id) != NULL || is_in_clip(&status, path);
    pthread_mutex_unlock(&lock);
    return is_read ? fail(path) : RLF_OK;
}

/* A clip's folder, or that of its pictures. */
static bool is_clip_folder(const io_reading *id)
{
    bool is_found = find(id) != NULL;
    for (int i = 0; i < READINGS_MAX && !is_found; i++) {
        const entry *e = &entries[i];
        for (size_t k = 0; k < sizeof(parts) / sizeof(parts[0]) && e->count > 0 && !is_found; k++) {
            is_found = e->path[0] != '\0' && is_named(id, e->path, parts[k]);
        }
    }
    return is_found;
}

rlf_result io_reading_check_folder(const char *path)
{
    struct stat status;
    if (stat(path, &status) != 0 || !S_ISDIR(status.st_mode)) {
        return RLF_OK;
    }
    const io_reading id = id_of(&status);
    pthread_mutex_lock(&lock);
    const bool is_read = is_clip_folder(&id);
    pthread_mutex_unlock(&lock);
    return is_read ? fail(path) : RLF_OK;
}
