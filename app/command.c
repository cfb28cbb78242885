/* What the subcommands of `relief` share: messages, and numbers read from their options. */
#include "command.h"

#include "relief/io.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *command_program = "relief";

int command_usage(const char *command, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fprintf(stderr, "%s %s: ", command_program, command);
    vfprintf(stderr, format, arguments);
    fprintf(stderr, " (see `%s %s --help`)\n", command_program, command);
    va_end(arguments);
    return EXIT_USAGE;
}

int command_set(const char *command, setting_list *s, const char *text)
{
    return settings_add(s, text) == RLF_OK ? -1
                                           : command_usage(command, "--set: %s", rlf_error_text());
}

int command_failed(void)
{
    fprintf(stderr, "%s: %s\n", command_program, rlf_error_text());
    return EXIT_FAILED;
}

int command_stopped(const char *command)
{
    fprintf(stderr, "%s %s: stopped before the end; nothing was written\n", command_program,
            command);
    return 128 + command_interrupted;
}

int command_done(void)
{
    return command_interrupted ? 128 + command_interrupted : EXIT_DONE;
}

const char *command_frames(int64_t count)
{
    return count == 1 ? "frame" : "frames";
}

double command_tidy(double value, int decimals)
{
    double half = 0.5;
    for (int i = 0; i < decimals; i++) {
        half *= 0.1;
    }
    return value <= 0.0 && value >= -half ? 0.0 : value;
}

int command_not_opened(const char *command)
{
    return command_interrupted ? command_stopped(command) : command_failed();
}

bool command_parse_int(const char *text, int64_t low, int64_t high, int64_t *out)
{
    char *end = NULL;
    long long value = strtoll(text, &end, 10);
    if (end == text || *end != '\0' || value < low || value > high) {
        return false;
    }
    *out = value;
    return true;
}

bool command_parse_list(const char *text, int64_t low, int64_t high, int capacity, int64_t *out,
                        int *out_count)
{
    *out_count = 0;
    for (const char *rest = text; *out_count < capacity;) {
        char number[24];
        size_t length = strcspn(rest, ",");
        if (length >= sizeof(number)) {
            return false;
        }
        memcpy(number, rest, length);
        number[length] = '\0';
        if (!command_parse_int(number, low, high, &out[*out_count])) {
            return false;
        }
        ++*out_count;
        if (rest[length] == '\0') {
            return true;
        }
        rest += length + 1;
    }
    return false;
}

bool command_parse_range(const char *text, int64_t *out_begin, int64_t *out_end)
{
    const int64_t limit = INT64_C(1000000000);
    const char *colon = strchr(text, ':');
    *out_begin = 0;
    *out_end = limit;
    if (colon == NULL) {
        return command_parse_int(text, 1, limit, out_end);
    }
    char first[32];
    size_t length = (size_t)(colon - text);
    if (length >= sizeof(first)) {
        return false;
    }
    memcpy(first, text, length);
    first[length] = '\0';
    if (length > 0 && !command_parse_int(first, 0, limit, out_begin)) {
        return false;
    }
    if (colon[1] != '\0' && !command_parse_int(colon + 1, 1, limit, out_end)) {
        return false;
    }
    return *out_begin < *out_end;
}
