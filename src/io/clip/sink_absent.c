/* MCAP files in a build without zstd and lz4. */
#include "io/clip/sink.h"

#include "base/messages.h"

rlf_result io_mcap_sink_open(const char *path, const rlf_source_info *info,
                             const rlf_recording_def *def, io_sink *out)
{
    (void)info;
    (void)def;
    (void)out;
    return rlf_fail(
        RLF_ERROR_UNSUPPORTED,
        "%s: this build was made without MCAP: record into a folder, FOLDER/, or " RLF_GET_PART(
            "libzstd-dev liblz4-dev", "script/bootstrap", "RELIEF_WITH_MCAP"),
        path);
}
