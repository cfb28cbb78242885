/* camera.json: any bytes give a usable rig or an error line. */
#include "fuzz.h"

#include "io/calibration/calibration.h"

#include <stdlib.h>

static const char *const seeds[] = {
    "{\"depth\":{\"width\":64,\"height\":48,\"fx\":60,\"fy\":61,\"cx\":31.5,\"cy\":23.5,"
    "\"units_per_metre\":5000}}",
    "{\"depth\":{\"width\":64,\"height\":48,\"fx\":60,\"fy\":61,\"cx\":31.5,\"cy\":23.5,"
    "\"units_per_metre\":1000,\"depth_min_m\":0.5,\"depth_max_m\":4.5,\"noise\":[0,0,0.001],"
    "\"distortion_model\":\"plumb_bob\",\"distortion\":[0.1,0.2,0,0,0.1]},"
    "\"color\":{\"width\":96,\"height\":54,\"fx\":80,\"fy\":80,\"cx\":48,\"cy\":27,"
    "\"distortion_model\":\"rational_polynomial\",\"distortion\":[1,2,0,0,3,1,2,3]},"
    "\"depth_to_color\":{\"rotation\":[[1,0,0],[0,1,0],[0,0,1]],\"translation\":[0.05,0,0]}}"};

size_t fuzz_seed(int index, uint8_t *out, size_t capacity)
{
    int count = (int)(sizeof seeds / sizeof seeds[0]);
    return index < count ? fuzz_copy(seeds[index], out, capacity) : 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    io_bytes file = {"camera.json", data, size};
    rlf_rig rig;
    double units = 0.0;
    if (io_rig_parse(&file, &rig, &units) == RLF_OK &&
        (rlf_camera_check(&rig.depth, "depth") != RLF_OK || !(units >= 1.0))) {
        abort();
    }
    return 0;
}
