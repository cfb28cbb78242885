/* What a pixel's reason code says. */
#include "relief/surface.h"

const char *rlf_reason_name(rlf_reason reason)
{
    switch (reason) {
    case RLF_REASON_OK: return "ok";
    case RLF_REASON_TOO_NEAR: return "too near";
    case RLF_REASON_TOO_FAR: return "too far";
    case RLF_REASON_NO_RETURN: return "no return";
    case RLF_REASON_FLYING: return "flying";
    case RLF_REASON_PARALLAX_SHADOW: return "parallax shadow";
    case RLF_REASON_OUTSIDE_LENS: return "outside the lens";
    case RLF_REASON_FILLED: return "filled";
    case RLF_REASON_COUNT: break;
    }
    return "unknown";
}
