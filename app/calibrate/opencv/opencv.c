/* Opens the shim by its name, to which the command's run path leads, built or installed; or by the
 * path in $RELIEF_OPENCV_LIBRARY. */
#include "calibrate/opencv/opencv.h"

#include "base/messages.h"
#include "relief/base.h"

#include <dlfcn.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CURE                                                                                       \
    "`relief calibrate` needs OpenCV: " RLF_GET_PART(                                              \
        "libopencv-calib3d-dev (for ChArUco boards libopencv-contrib-dev, too)",                   \
        "script/bootstrap --all", "RELIEF_WITH_OPENCV")

static relief_opencv_api functions;
static char reason[512];
static bool is_loaded;
static pthread_once_t once = PTHREAD_ONCE_INIT;

static bool load_all(void *object)
{
    bool has_all = true;
#define LOAD(result, name, parameters)                                                             \
    {                                                                                              \
        void *symbol = dlsym(object, "relief_opencv_" #name);                                      \
        memcpy(&functions.name, &symbol, sizeof(symbol));                                          \
        has_all = has_all && symbol != NULL;                                                       \
    }
    RELIEF_OPENCV_FUNCTIONS(LOAD)
#undef LOAD
    return has_all;
}

static void load(void)
{
    const char *named = getenv("RELIEF_OPENCV_LIBRARY");
    void *object = dlopen(named != NULL && *named != '\0' ? named : "librelief_opencv.so",
                          RTLD_NOW | RTLD_LOCAL);
    if (object == NULL) {
        const char *fault = dlerror();
        const bool is_absent = strstr(fault, "librelief_opencv.so: cannot open") != NULL;
        snprintf(reason, sizeof(reason), "%s%s%.200s%s", CURE, is_absent ? "" : " (",
                 is_absent ? "" : fault, is_absent ? "" : ")");
        return;
    }
    is_loaded = load_all(object) && functions.version() == RELIEF_OPENCV_VERSION;
    if (!is_loaded) {
        snprintf(reason, sizeof(reason),
                 "librelief_opencv.so is of another version of Relief: "
                 "install both from one build");
    }
}

const relief_opencv_api *opencv_get(void)
{
    pthread_once(&once, load);
    if (!is_loaded) {
        rlf_fail(RLF_ERROR_UNSUPPORTED, "%s", reason);
        return NULL;
    }
    return &functions;
}
