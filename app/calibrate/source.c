#include "calibrate/calibrate.h"
rlf_result calibrate_source(const calibrate_options *options, calibration *c)
{
    (void)options; (void)c;
    return rlf_fail(RLF_ERROR_UNSUPPORTED, "soon");
}
