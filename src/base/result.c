/* Result names and the calling thread's error line. */
#include "relief/base.h"
#include "base/line.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define ERROR_TEXT_SIZE 1024

static _Thread_local char error_text[ERROR_TEXT_SIZE];

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

rlf_result rlf_fail(rlf_result result, const char *format, ...)
{
    if (!RLF_ASSERT(format != NULL)) {
        return RLF_ERROR_INVALID;
    }
    /* Formatted into a copy first: an argument may be the old error line. */
    char text[ERROR_TEXT_SIZE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof(text), format, arguments);
    va_end(arguments);
    rlf_line_clean(text);
    memcpy(error_text, text, sizeof(error_text));
    return result;
}

const char *rlf_error_text(void)
{
    return error_text;
}
