/* Recursive descent over lines; nested at most DEPTH_MAX deep, so that no file exhausts the stack.
 */
#include "io/calibration/calibration.h"

#include "io/file.h"

#include <stdarg.h>
#include <string.h>

#define DEPTH_MAX 16
#define SCALAR_MAX 4096 /* bytes of one value */

typedef struct reader {
    const char *file;
    const char *at, *end;
    const char *line_begin;
    int line, depth;
    rlf_result result;
} reader;

RLF_PRINTF(2, 3) static json_t *fail(reader *r, const char *format, ...)
{
    char problem[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(problem, sizeof(problem), format, arguments);
    va_end(arguments);
    if (r->result == RLF_OK) {
        r->result = rlf_fail(RLF_ERROR_FORMAT, "%s:%d: %s: see docs/formats.md for what is read",
                             r->file, r->line, problem);
    }
    return NULL;
}

static char peek(const reader *r)
{
    return r->at < r->end ? *r->at : '\0';
}

static bool is_at_end(const reader *r)
{
    return r->at >= r->end;
}

static void skip_line_end(reader *r)
{
    while (r->at < r->end && *r->at != '\n') {
        r->at++;
    }
    if (r->at < r->end) {
        r->at++;
        r->line++;
    }
    r->line_begin = r->at;
}

static void skip_blanks(reader *r)
{
    while (peek(r) == ' ' || peek(r) == '\t' || peek(r) == '\r') {
        r->at++;
    }
}

/* Blanks, comments and the ends of lines. */
static void skip_space(reader *r)
{
    for (;;) {
        skip_blanks(r);
        if (!is_at_end(r) && (*r->at == '\n' || *r->at == '#')) {
            skip_line_end(r);
        } else {
            return;
        }
    }
}

static json_t *string_value(reader *r, const char *text, size_t length)
{
    json_t *value = json_stringn(text, length);
    return value != NULL ? value : fail(r, "holds bytes that are no UTF-8 text");
}

/* In quotes of either kind; a backslash keeps the next byte. */
static json_t *read_quoted(reader *r)
{
    char text[SCALAR_MAX];
    size_t length = 0;
    const char quote = *r->at++;
    while (!is_at_end(r) && *r->at != quote && *r->at != '\n') {
        r->at += *r->at == '\\' && quote == '"' && r->at + 1 < r->end ? 1 : 0;
        if (length == sizeof(text)) {
            return fail(r, "a text is longer than %d bytes", SCALAR_MAX);
        }
        text[length++] = *r->at++;
    }
    if (peek(r) != quote) {
        return fail(r, "a text in quotes does not end");
    }
    r->at++;
    return string_value(r, text, length);
}

/* A number, true, false, null, or a text. */
static json_t *plain_value(reader *r, const char *text, size_t length)
{
    char token[64];
    double number = 0.0;
    if (length < sizeof(token)) {
        memcpy(token, text, length);
        token[length] = '\0';
        if (io_number_parse(token, &number)) {
            return json_real(number);
        }
        if (strcmp(token, "true") == 0 || strcmp(token, "false") == 0) {
            return json_boolean(token[0] == 't');
        }
        if (length == 0 || strcmp(token, "null") == 0 || strcmp(token, "~") == 0) {
            return json_null();
        }
    }
    return length <= SCALAR_MAX ? string_value(r, text, length)
                                : fail(r, "a text is longer than %d bytes", SCALAR_MAX);
}

/* Up to a byte of `stops`, a comment or the line's end. */
static json_t *read_plain(reader *r, const char *stops)
{
    const char *begin = r->at;
    while (!is_at_end(r) && *r->at != '\n' && *r->at != '\0' && strchr(stops, *r->at) == NULL &&
           !(*r->at == '#' && (r->at == begin || r->at[-1] == ' ' || r->at[-1] == '\t'))) {
        r->at++;
    }
    const char *end = r->at;
    while (end > begin && (end[-1] == ' ' || end[-1] == '\t' || end[-1] == '\r')) {
        end--;
    }
    if (begin < end && strchr("&*|>@`", *begin) != NULL) {
        return fail(r, "\"%c\" begins a kind of YAML value that is not read", *begin);
    }
    return plain_value(r, begin, (size_t)(end - begin));
}

static bool is_quote(char c)
{
    return c == '"' || c == '\'';
}

/* Puts a member under its key; takes the value. */
static bool put(reader *r, json_t *map, const char *key, json_t *value)
{
    if (value != NULL && json_object_get(map, key) != NULL) {
        json_decref(value);
        value = fail(r, "%.60s is given twice", key);
    }
    return value != NULL && json_object_set_new(map, key, value) == 0;
}

/* ---- [1, 2] and {a: 1} ---------------------------------------------------------------------- */

static json_t *read_flow(reader *r);

/* "key:" of a flow map or a block; the text stays the returned value's. */
static json_t *read_key(reader *r)
{
    json_t *key = is_quote(peek(r)) ? read_quoted(r) : read_plain(r, ":,[]{}");
    skip_blanks(r);
    if (key != NULL && peek(r) != ':') {
        json_decref(key);
        return fail(r, "a key with a colon is missing");
    }
    r->at++;
    if (key != NULL && !json_is_string(key)) {
        json_decref(key);
        return fail(r, "a key is no text");
    }
    return key;
}

static bool read_flow_item(reader *r, json_t *out, bool is_map)
{
    if (!is_map) {
        json_t *value = read_flow(r);
        return value != NULL && json_array_append_new(out, value) == 0;
    }
    json_t *key = read_key(r);
    bool is_read = key != NULL;
    if (is_read) {
        skip_space(r);
        is_read = put(r, out, json_string_value(key), read_flow(r));
    }
    json_decref(key);
    return is_read;
}

static json_t *read_flow_items(reader *r, bool is_map)
{
    const char close = is_map ? '}' : ']';
    json_t *out = is_map ? json_object() : json_array();
    r->at++;
    for (;;) {
        skip_space(r);
        if (peek(r) == close) {
            r->at++;
            return out;
        }
        if (is_at_end(r)) {
            fail(r, "the file ends within %s", is_map ? "{...}" : "[...]");
            break;
        }
        if (!read_flow_item(r, out, is_map)) {
            break;
        }
        skip_space(r);
        if (peek(r) == ',') {
            r->at++;
        } else if (peek(r) != close) {
            fail(r, "a comma or %c is missing", close);
            break;
        }
    }
    json_decref(out);
    return NULL;
}

static json_t *read_flow(reader *r)
{
    const char c = peek(r);
    if (c == '[' || c == '{') {
        if (r->depth >= DEPTH_MAX) {
            return fail(r, "is nested deeper than %d", DEPTH_MAX);
        }
        r->depth++;
        json_t *out = read_flow_items(r, c == '{');
        r->depth--;
        return out;
    }
    if (c == 'b' && r->at + 1 < r->end && is_quote(r->at[1])) { /* Python's bytes */
        r->at++;
    }
    return is_quote(peek(r)) ? read_quoted(r) : read_plain(r, ",[]{}");
}

/* ---- blocks --------------------------------------------------------------------------------- */

/* Goes to the next line with content and returns its indentation; -1 at the document's end. */
static int next_line(reader *r)
{
    for (;;) {
        r->at = r->line_begin;
        while (peek(r) == ' ') {
            r->at++;
        }
        const int indent = (int)(r->at - r->line_begin);
        skip_blanks(r);
        if (is_at_end(r)) {
            return -1;
        }
        if (*r->at != '\n' && *r->at != '#') {
            const bool is_mark = indent == 0 && r->end - r->at >= 3 &&
                                 (memcmp(r->at, "---", 3) == 0 || memcmp(r->at, "...", 3) == 0);
            return is_mark ? -1 : indent;
        }
        skip_line_end(r);
        if (is_at_end(r)) {
            return -1;
        }
    }
}

static bool is_item(const reader *r)
{
    return peek(r) == '-' && r->at + 1 < r->end &&
           (r->at[1] == ' ' || r->at[1] == '\n' || r->at[1] == '\r');
}

/* What stands on the rest of a line: nothing may follow it. */
static json_t *read_inline(reader *r)
{
    const char c = peek(r);
    json_t *value = c == '[' || c == '{' || is_quote(c) ? read_flow(r) : read_plain(r, "");
    skip_blanks(r);
    if (value != NULL && !is_at_end(r) && *r->at != '\n' && *r->at != '#') {
        json_decref(value);
        return fail(r, "more follows than one value");
    }
    skip_line_end(r);
    return value;
}

static json_t *read_list(reader *r, int indent)
{
    json_t *out = json_array();
    while (next_line(r) == indent && is_item(r)) {
        r->at++;
        skip_blanks(r);
        json_t *value = read_inline(r);
        if (value == NULL || json_array_append_new(out, value) != 0) {
            json_decref(out);
            return NULL;
        }
    }
    return out;
}

static json_t *read_map(reader *r, int indent);

/* The value of a key at `indent`: on its line, or on those below that are further in. */
static json_t *read_member(reader *r, int indent)
{
    skip_blanks(r);
    while (peek(r) == '!') { /* a tag, as !!opencv-matrix */
        while (!is_at_end(r) && *r->at != ' ' && *r->at != '\n' && *r->at != '\r') {
            r->at++;
        }
        skip_blanks(r);
    }
    if (!is_at_end(r) && *r->at != '\n' && *r->at != '#') {
        return read_inline(r);
    }
    skip_line_end(r);
    const int below = next_line(r);
    if (below >= indent && is_item(r)) {
        return read_list(r, below);
    }
    if (below <= indent) {
        return json_null();
    }
    if (r->depth >= DEPTH_MAX) {
        return fail(r, "is nested deeper than %d", DEPTH_MAX);
    }
    if (peek(r) == '[' || peek(r) == '{') {
        return read_inline(r);
    }
    r->depth++;
    json_t *out = read_map(r, below);
    r->depth--;
    return out;
}

static json_t *read_map(reader *r, int indent)
{
    json_t *out = json_object();
    int at = next_line(r);
    while (r->result == RLF_OK && at == indent) {
        json_t *key = is_item(r) ? fail(r, "a list stands where keys are") : read_key(r);
        if (key == NULL || !put(r, out, json_string_value(key), read_member(r, indent))) {
            fail(r, "not enough memory");
        }
        json_decref(key);
        at = r->result == RLF_OK ? next_line(r) : -1;
    }
    if (r->result == RLF_OK && at > indent) {
        fail(r, "is further in than the lines above");
    }
    if (r->result != RLF_OK) {
        json_decref(out);
        return NULL;
    }
    return out;
}

/* Past "%YAML:1.0" and the "---" before a document. */
static void skip_head(reader *r)
{
    for (;;) {
        skip_space(r);
        const bool is_first = r->at == r->line_begin;
        if (is_first && (peek(r) == '%' || (r->end - r->at >= 3 && memcmp(r->at, "---", 3) == 0))) {
            skip_line_end(r);
        } else {
            return;
        }
    }
}

rlf_result io_calibration_text_parse(const io_bytes *file, json_t **out)
{
    const io_bytes text = io_bytes_unmarked(file);
    const char *begin = (const char *)text.data;
    reader r = {
        .file = file->name, .at = begin, .end = begin + text.size, .line_begin = begin, .line = 1};
    if (text.size > IO_CALIBRATION_FILE_MAX) {
        return rlf_fail(RLF_ERROR_FORMAT, "%s: is no calibration file: it is larger than 1 MiB",
                        file->name);
    }
    skip_head(&r);
    json_t *top = NULL;
    if (is_at_end(&r)) {
        fail(&r, "is empty");
    } else if (*r.at == '{') {
        top = read_flow(&r);
        skip_space(&r);
        if (top != NULL && !is_at_end(&r)) {
            fail(&r, "more follows than one {...}");
        }
    } else {
        top = read_map(&r, next_line(&r));
        if (top != NULL && next_line(&r) >= 0) {
            fail(&r, "is further out than the first line");
        }
    }
    if (r.result != RLF_OK) {
        json_decref(top);
        return r.result;
    }
    *out = top;
    return top != NULL ? RLF_OK : rlf_fail(RLF_ERROR_MEMORY, "%s: not enough memory", file->name);
}
