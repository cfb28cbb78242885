/* What is in a folder. */
#include "windows/posix.h"

#include "windows/wide.h"

#include <dirent.h>
#include <errno.h>
#include <stdbool.h>
#include <windows.h>

struct win_folder {
    wchar_t pattern[WIDE_MAX];
    HANDLE search;
    WIN32_FIND_DATAW found;
    bool has_found; /* and not yet told */
    struct dirent entry;
};

static void begin(DIR *folder)
{
    folder->search = FindFirstFileW(folder->pattern, &folder->found);
    folder->has_found = folder->search != INVALID_HANDLE_VALUE;
}

DIR *win_opendir(const char *path)
{
    char pattern[PATH_MAX];
    const int length = snprintf(pattern, sizeof(pattern), "%s/*", path);
    DIR *folder = calloc(1, sizeof(*folder));
    if (folder == NULL || length < 0 || length >= (int)sizeof(pattern) ||
        !win_wide(pattern, folder->pattern)) {
        free(folder);
        return NULL;
    }
    begin(folder);
    if (!folder->has_found) {
        win_fail();
        free(folder);
        return NULL;
    }
    return folder;
}

void win_rewinddir(DIR *folder)
{
    FindClose(folder->search);
    begin(folder);
}

struct dirent *win_readdir(DIR *folder)
{
    if (!folder->has_found && !FindNextFileW(folder->search, &folder->found)) {
        return NULL;
    }
    folder->has_found = false;
    const bool fits =
        win_narrow(folder->found.cFileName, folder->entry.d_name, sizeof(folder->entry.d_name));
    return fits ? &folder->entry : win_readdir(folder);
}

int win_closedir(DIR *folder)
{
    FindClose(folder->search);
    free(folder);
    return 0;
}

int win_alphasort(const struct dirent **a, const struct dirent **b)
{
    return strcmp((*a)->d_name, (*b)->d_name);
}

static int by_name(const void *a, const void *b)
{
    return strcmp((*(struct dirent *const *)a)->d_name, (*(struct dirent *const *)b)->d_name);
}

/* The copy is of the name alone. */
static bool add(const struct dirent *entry, struct dirent ***list, int count)
{
    const size_t size = strlen(entry->d_name) + 1;
    struct dirent **longer = realloc(*list, ((size_t)count + 1) * sizeof(*longer));
    struct dirent *copy = longer != NULL ? malloc(size) : NULL;
    *list = longer != NULL ? longer : *list;
    if (copy == NULL) {
        return false;
    }
    memcpy(copy, entry, size);
    longer[count] = copy;
    return true;
}

int win_scandir(const char *path, struct dirent ***out, int (*wanted)(const struct dirent *entry),
                int (*compare)(const struct dirent **a, const struct dirent **b))
{
    DIR *folder = win_opendir(path);
    *out = NULL;
    if (folder == NULL) {
        return -1;
    }
    int count = 0;
    for (struct dirent *e = win_readdir(folder); e != NULL; e = win_readdir(folder)) {
        if ((wanted == NULL || wanted(e)) && add(e, out, count)) {
            count++;
        }
    }
    win_closedir(folder);
    if (compare != NULL && count > 0) { /* always alphasort */
        qsort(*out, (size_t)count, sizeof(**out), by_name);
    }
    return count;
}
