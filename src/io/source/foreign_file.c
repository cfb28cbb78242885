/* What `ros2 bag` writes besides MCAP files, and packed files. */
#define _POSIX_C_SOURCE 200809L
#include "io/file.h"
#include "io/source/backends.h"

#include <dirent.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

static bool ends_with(const char *text, const char *end)
{
    const size_t length = strlen(text), end_length = strlen(end);
    return length > end_length && strcasecmp(text + length - end_length, end) == 0;
}

/* The first file by name that ends so, and how many there are. */
static int32_t find_files(const char *folder, const char *end, char out[256])
{
    int32_t count = 0;
    DIR *entries = opendir(folder);
    out[0] = '\0';
    for (struct dirent *e; entries != NULL && (e = readdir(entries)) != NULL;) {
        if (ends_with(e->d_name, end)) {
            const bool is_first = count++ == 0 || strcmp(e->d_name, out) < 0;
            if (is_first) {
                snprintf(out, 256, "%.255s", e->d_name);
            }
        }
    }
    if (entries != NULL) {
        closedir(entries);
    }
    return count;
}

static rlf_result fail_database(const char *source)
{
    return rlf_fail(RLF_ERROR_UNSUPPORTED,
                    "%s: is a ROS 2 recording (or its folder) in SQLite (.db3), which is not read: "
                    "turn it into "
                    "MCAP with `ros2 bag convert`",
                    source);
}

static rlf_result check_folder(const char *source, const char *path)
{
    char name[256];
    const int32_t count = find_files(path, ".mcap", name);
    if (count > 0) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED,
                        "%s: is the folder of a ROS 2 recording of %d file%s: give a file, such as "
                        "%s",
                        source, (int)count, count > 1 ? "s" : "", name);
    }
    if (find_files(path, ".db3", name) > 0) {
        return fail_database(source);
    }
    if (find_files(path, ".zstd", name) > 0) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED,
                        "%s: is the folder of a ROS 2 recording that is packed file by file: "
                        "unpack %s with `zstd -d` and give what it becomes",
                        source, name);
    }
    return RLF_OK;
}

rlf_result io_foreign_check(const char *source, const char *path)
{
    static const struct {
        const char *end, *tool;
    } packed[] = {{".zstd", "zstd -d"}, {".zst", "zstd -d"},  {".gz", "gzip -d"},
                  {".xz", "xz -d"},     {".bz2", "bzip2 -d"}, {".zip", "unzip"},
                  {".tar", "tar xf"},   {".tgz", "tar xf"},   {".7z", "7z x"}};
    if (!io_path_exists(path)) {
        return RLF_OK;
    }
    if (io_path_is_folder(path)) {
        const bool is_recording =
            io_folder_has(path, "metadata.yaml") && !io_folder_has(path, "depth.txt");
        return is_recording ? check_folder(source, path) : RLF_OK;
    }
    if (ends_with(path, ".db3")) {
        return fail_database(source);
    }
    for (size_t i = 0; i < sizeof(packed) / sizeof(packed[0]); i++) {
        if (ends_with(path, packed[i].end)) {
            return rlf_fail(RLF_ERROR_UNSUPPORTED,
                            "%s: is a packed file: unpack it with `%s` and give what it becomes",
                            source, packed[i].tool);
        }
    }
    return RLF_OK;
}
