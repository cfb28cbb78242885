/* Recursive descent over elements; nested at most DEPTH_MAX deep. */
#include "io/calibration/calibration.h"

#include "io/file.h"

#include <string.h>

#define DEPTH_MAX 16
#define NAME_MAX_SIZE 64  /* of an element, with the ending zero */
#define TOKEN_MAX_SIZE 64 /* of a number */

typedef struct reader {
    const char *file;
    const char *begin, *at, *end;
    int depth;
    rlf_result result;
} reader;

static json_t *fail(reader *r, const char *problem)
{
    int line = 1;
    for (const char *c = r->begin; c < r->at; c++) {
        line += *c == '\n' ? 1 : 0;
    }
    if (r->result == RLF_OK) {
        r->result = rlf_fail(RLF_ERROR_FORMAT,
                             "%s:%d: %s: of XML only OpenCV's FileStorage is read; write .yml or "
                             "JSON, as in docs/calibration.md",
                             r->file, line, problem);
    }
    return NULL;
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

static bool starts(const reader *r, const char *text)
{
    const size_t length = strlen(text);
    return (size_t)(r->end - r->at) >= length && memcmp(r->at, text, length) == 0;
}

/* Past the next `text`; false when there is none. */
static bool pass(reader *r, const char *text)
{
    while (r->at < r->end && !starts(r, text)) {
        r->at++;
    }
    if (r->at >= r->end) {
        return false;
    }
    r->at += strlen(text);
    return true;
}

/* Blanks, comments, and <?...?>. */
static void skip(reader *r)
{
    while (r->at < r->end) {
        if (is_blank(*r->at)) {
            r->at++;
        } else if (!(starts(r, "<!--") && pass(r, "-->")) && !(starts(r, "<?") && pass(r, "?>"))) {
            return;
        }
    }
}

/* "<name attributes>"; the cursor is behind it. False when there is none. */
static bool open_element(reader *r, char name[NAME_MAX_SIZE])
{
    size_t length = 0;
    if (r->at >= r->end || *r->at != '<' || starts(r, "</")) {
        return false;
    }
    r->at++;
    while (r->at < r->end && !is_blank(*r->at) && *r->at != '>' && *r->at != '/' &&
           length + 1 < NAME_MAX_SIZE) {
        name[length++] = *r->at++;
    }
    name[length] = '\0';
    return length > 0 && pass(r, ">");
}

static bool close_element(reader *r, const char *name)
{
    const size_t length = strlen(name);
    if (!starts(r, "</")) {
        return false;
    }
    r->at += 2;
    if (!starts(r, name) || (size_t)(r->end - r->at) <= length || r->at[length] != '>') {
        return false;
    }
    r->at += length + 1;
    return true;
}

static json_t *token_value(const char *text, size_t length)
{
    char token[TOKEN_MAX_SIZE];
    double number = 0.0;
    if (length < sizeof(token)) {
        memcpy(token, text, length);
        token[length] = '\0';
        if (io_number_parse(token, &number)) {
            return json_real(number);
        }
    }
    return json_stringn(text, length);
}

/* One value, or all that blanks divide where the first one is a number. */
static json_t *read_text(reader *r)
{
    const char *from = r->at;
    while (r->at < r->end && *r->at != '<') {
        r->at++;
    }
    const char *to = r->at;
    while (to > from && is_blank(to[-1])) {
        to--;
    }
    json_t *all = json_array();
    const bool is_quoted = from < to && *from == '"';
    while (from < to && !is_quoted) {
        const char *token = from;
        while (from < to && !is_blank(*from)) {
            from++;
        }
        json_array_append_new(all, token_value(token, (size_t)(from - token)));
        while (from < to && is_blank(*from)) {
            from++;
        }
    }
    if (json_array_size(all) > 1 && json_is_number(json_array_get(all, 0))) {
        return all;
    }
    json_t *one =
        json_array_size(all) == 1 ? json_incref(json_array_get(all, 0)) : json_stringn("", 0);
    json_decref(all);
    return one;
}

static json_t *read_content(reader *r);

static json_t *read_elements(reader *r)
{
    json_t *out = json_object();
    char name[NAME_MAX_SIZE];
    while (r->result == RLF_OK && open_element(r, name)) {
        json_t *value = read_content(r);
        if (value == NULL || !close_element(r, name)) {
            json_decref(value);
            fail(r, "an element does not end");
        } else if (strcmp(name, "_") == 0) {
            json_decref(value); /* an item of a list: points of the board */
        } else if (json_object_get(out, name) != NULL) {
            json_decref(value);
            fail(r, "an element is given twice");
        } else if (json_object_set_new(out, name, value) != 0) {
            fail(r, "a name is no UTF-8 text");
        }
        skip(r);
    }
    if (r->result != RLF_OK) {
        json_decref(out);
        return NULL;
    }
    return out;
}

static json_t *read_content(reader *r)
{
    skip(r);
    if (r->at >= r->end || *r->at != '<' || starts(r, "</")) {
        return read_text(r);
    }
    if (r->depth >= DEPTH_MAX) {
        return fail(r, "is nested too deeply");
    }
    r->depth++;
    json_t *out = read_elements(r);
    r->depth--;
    return out;
}

rlf_result io_calibration_xml_parse(const io_bytes *file, json_t **out)
{
    const io_bytes text = io_bytes_unmarked(file);
    const char *begin = (const char *)text.data;
    reader r = {.file = file->name, .begin = begin, .at = begin, .end = begin + text.size};
    char name[NAME_MAX_SIZE];
    json_t *top = NULL;
    skip(&r);
    if (!open_element(&r, name) || strcmp(name, "opencv_storage") != 0) {
        fail(&r, "is not <opencv_storage>");
    } else {
        skip(&r);
        top = read_elements(&r);
        if (top != NULL && !close_element(&r, name)) {
            fail(&r, "<opencv_storage> does not end");
        }
    }
    if (r.result != RLF_OK) {
        json_decref(top);
        return r.result;
    }
    *out = top;
    return top != NULL ? RLF_OK : rlf_fail(RLF_ERROR_MEMORY, "%s: not enough memory", file->name);
}
