/* SOURCE of a command line, taken apart. */
#include "io/file.h"
#include "io/source/address.h"

#include <string.h>

static rlf_result add_key(const char *source, char *text, io_address *out)
{
    char *equal = strchr(text, '=');
    if (equal == NULL || equal == text) {
        return rlf_fail(RLF_ERROR_INVALID, "%s: \"%s\" after the ? is no key=value", source, text);
    }
    *equal = '\0';
    for (int32_t i = 0; i < out->key_count; i++) {
        if (strcmp(out->keys[i], text) == 0) {
            return rlf_fail(RLF_ERROR_INVALID, "%s: the key \"%s\" is given twice", source, text);
        }
    }
    if (out->key_count == IO_ADDRESS_KEYS_MAX) {
        return rlf_fail(RLF_ERROR_INVALID, "%s: more than %d keys", source, IO_ADDRESS_KEYS_MAX);
    }
    out->keys[out->key_count] = text;
    out->values[out->key_count++] = equal + 1;
    return RLF_OK;
}

static rlf_result parse_keys(const char *source, char *query, io_address *out)
{
    while (query != NULL) {
        char *next = strchr(query, '&');
        if (next != NULL) {
            *next++ = '\0';
        }
        rlf_result result = add_key(source, query, out);
        if (result != RLF_OK) {
            return result;
        }
        query = next;
    }
    return RLF_OK;
}

rlf_result io_address_parse(const char *source, io_address *out)
{
    memset(out, 0, sizeof(*out));
    size_t length = strlen(source);
    if (length >= sizeof(out->text)) {
        return rlf_fail(RLF_ERROR_INVALID, "%.100s...: the path is too long: use a shorter one",
                        source);
    }
    memcpy(out->text, source, length + 1);
    out->scheme = "";
    out->place = out->text;
    if (io_path_exists(source)) {
        return RLF_OK;
    }
    size_t scheme = strspn(source, "abcdefghijklmnopqrstuvwxyz0123456789_-");
    if (scheme > 0 && source[scheme] == ':') {
        out->text[scheme] = '\0';
        out->scheme = out->text;
        out->place = out->text + scheme + 1;
    }
    char *query = strchr(out->text + (out->place - out->text), '?');
    if (query == NULL) {
        return RLF_OK;
    }
    *query = '\0';
    return parse_keys(source, query + 1, out);
}

const char *io_address_take(io_address *address, const char *key)
{
    for (int32_t i = 0; i < address->key_count; i++) {
        if (strcmp(address->keys[i], key) != 0) {
            continue;
        }
        const char *value = address->values[i];
        int32_t last = --address->key_count;
        address->keys[i] = address->keys[last];
        address->values[i] = address->values[last];
        return value;
    }
    return NULL;
}
