/* Result names and the calling thread's error line. */
#include "relief/base.h"

#include "base/messages.h"

#include <stdio.h>

static _Thread_local char error_text[RLF_ERROR_LINE_SIZE];

const char *rlf_result_name(rlf_result result)
{
    switch (result) {
    case RLF_OK: return "RLF_OK";
    case RLF_NO_FRAME: return "RLF_NO_FRAME";
    case RLF_END: return "RLF_END";
    case RLF_ERROR_INVALID: return "RLF_ERROR_INVALID";
    case RLF_ERROR_MEMORY: return "RLF_ERROR_MEMORY";
    case RLF_ERROR_IO: return "RLF_ERROR_IO";
    case RLF_ERROR_FORMAT: return "RLF_ERROR_FORMAT";
    case RLF_ERROR_UNSUPPORTED: return "RLF_ERROR_UNSUPPORTED";
    case RLF_ERROR_CAPACITY: return "RLF_ERROR_CAPACITY";
    case RLF_ERROR_DEVICE: return "RLF_ERROR_DEVICE";
    }
    return "unknown result";
}

void rlf_error_line_set(const char *text)
{
    (void)snprintf(error_text, sizeof(error_text), "%s", text);
    rlf_line_clean(error_text);
}

const char *rlf_error_text(void)
{
    return error_text;
}
