/* Whether the name of an output tells what will be in it. */
#define _POSIX_C_SOURCE 200809L
#include "output_name.h"

#include <string.h>
#include <strings.h>
#include <sys/stat.h>

/* What files of pictures, arrays, rooms, recordings and tables are called, here and elsewhere. */
static const char known[] =
    ".mcap .bag .db3 .oni .mkv .klg .sens .pcd .mp4 .y4m .avi .mov .webm .png .jpg .jpeg .bmp .tif "
    ".tiff .gif .webp .json .csv .tsv .txt .ply .obj .glb .gltf .stl .fbx .map .npy .npz .h5 .yaml "
    ".yml .xml .cameramodel .svg .pdf .html .zip";

static const char *ending_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash != NULL ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    return dot != NULL && dot > name ? dot : NULL;
}

static bool is_in(const char *ending, const char *list)
{
    const size_t length = strlen(ending);
    for (const char *word = list; *word != '\0'; word += strspn(word, " ")) {
        const size_t size = strcspn(word, " ");
        if (size == length && strncasecmp(word, ending, size) == 0) {
            return true;
        }
        word += size;
    }
    return false;
}

static bool is_device(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
}

bool output_name_has(const char *path, const char *endings)
{
    const char *ending = ending_of(path);
    return is_device(path) || (ending != NULL && is_in(ending, endings));
}

bool output_name_is_right(const char *path, const char *endings)
{
    const char *ending = ending_of(path);
    return output_name_has(path, endings) || ending == NULL || !is_in(ending, known);
}

bool output_name_is_folder(const char *path)
{
    struct stat status;
    const char *ending = ending_of(path);
    const bool is_there = stat(path, &status) == 0 && S_ISDIR(status.st_mode);
    return is_there || ending == NULL || !is_in(ending, known);
}
