/* Calibration of recordings that hold none. */
#define _POSIX_C_SOURCE 200809L
#include "io/clip/clip.h"

#include "relief/io.h"
#include "io/file.h"

#include <string.h>
#include <sys/stat.h>

static bool exists(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && S_ISREG(status.st_mode);
}

static bool find_file(const char *place, char out[IO_PATH_MAX])
{
    const char *slash = strrchr(place, '/');
    const char *name = slash != NULL ? slash + 1 : place;
    const char *dot = strrchr(name, '.');
    const int stem = (int)(dot != NULL && dot > name ? dot - place : (ptrdiff_t)strlen(place));
    int length = snprintf(out, IO_PATH_MAX, "%.*s.json", stem, place);
    if (length > 0 && length < IO_PATH_MAX && exists(out)) {
        return true;
    }
    length = snprintf(out, IO_PATH_MAX, "%.*scamera.json", (int)(name - place), place);
    return length > 0 && length < IO_PATH_MAX && exists(out);
}

rlf_result io_rig_beside(const rlf_address *address, rlf_rig *out, double *out_units_per_metre,
                         bool *out_found)
{
    char path[IO_PATH_MAX];
    *out_found = true;
    if (address->rig != NULL) {
        *out = *address->rig;
        *out_units_per_metre = address->units_per_metre;
        return RLF_OK;
    }
    *out_found = find_file(address->place, path);
    return *out_found ? rlf_rig_load(path, out, out_units_per_metre) : RLF_OK;
}
