#include "calibrate/calibrate.h"
rlf_result calibrate_report(const calibrate_options *options, const calibration *c)
{
    (void)options; (void)c;
    return rlf_fail(RLF_ERROR_UNSUPPORTED, "soon");
}
