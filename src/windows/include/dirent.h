/* Folders of Windows, as POSIX lists them: names in UTF-8. */
#ifndef RLF_WINDOWS_DIRENT_H
#define RLF_WINDOWS_DIRENT_H

struct dirent {
    char d_name[1024];
};
typedef struct win_folder DIR;

DIR *win_opendir(const char *path);
struct dirent *win_readdir(DIR *folder); /* valid until the next one */
void win_rewinddir(DIR *folder);
int win_closedir(DIR *folder);
int win_scandir(const char *path, struct dirent ***out, int (*wanted)(const struct dirent *entry),
                int (*compare)(const struct dirent **a, const struct dirent **b));
int win_alphasort(const struct dirent **a, const struct dirent **b);

#define opendir win_opendir
#define readdir win_readdir
#define rewinddir win_rewinddir
#define closedir win_closedir
#define scandir win_scandir
#define alphasort win_alphasort

#endif
