/* printf and strtod follow the locale's decimal point, but files must not. */
#include "io/file.h"

#include "relief/math.h"

#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TOKEN_MAX 127

int io_number_format(double x, char out[IO_NUMBER_SIZE])
{
    char text[IO_NUMBER_SIZE];
    snprintf(text, sizeof(text), "%.9g", x);
    int length = 0;
    for (const char *c = text; *c != '\0'; c++) {
        bool is_number = strchr("0123456789+-einfa", *c) != NULL;
        if (is_number) {
            out[length++] = *c;
        } else if (length == 0 || out[length - 1] != '.') {
            out[length++] = '.'; /* a point of several bytes becomes one */
        }
    }
    out[length] = '\0';
    return length;
}

bool io_number_parse(const char *token, double *out)
{
    size_t length = strlen(token);
    const char *point = localeconv()->decimal_point;
    size_t point_length = strlen(point);
    char text[TOKEN_MAX + 1];
    if (length == 0 || length + point_length > TOKEN_MAX ||
        strspn(token, "0123456789+-.eE") != length) {
        return false; /* strspn also keeps out "inf", "nan" and hexadecimal */
    }
    const char *dot = strchr(token, '.');
    if (dot == NULL) {
        memcpy(text, token, length + 1);
    } else {
        size_t before = (size_t)(dot - token);
        memcpy(text, token, before);
        memcpy(text + before, point, point_length);
        memcpy(text + before + point_length, dot + 1, length - before);
    }
    char *end = NULL;
    *out = strtod(text, &end);
    return *end == '\0' && end != text && rlf_is_finite(*out);
}
