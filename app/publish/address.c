/* `--publish`: "ws:PORT", "osc:HOST:PORT", "ros2:/NAME" and their keys. */
#include "publish/inside.h"

#include "command.h"

#include <stdio.h>
#include <string.h>

#define LOOPBACK "127.0.0.1"

/* "[HOST:]PORT"; the host is `host` where none is given. */
static bool read_place(const char *text, int64_t least_port, char host[PUBLISH_HOST], int32_t *port)
{
    const char *colon = strrchr(text, ':');
    const size_t length = colon != NULL ? (size_t)(colon - text) : 0;
    int64_t number = 0;
    if ((colon != NULL && length == 0) || length >= PUBLISH_HOST || strcspn(text, ":/ ") < length ||
        !command_parse_int(colon != NULL ? colon + 1 : text, least_port, 65535, &number)) {
        return false;
    }
    if (length > 0) {
        memcpy(host, text, length);
        host[length] = '\0';
    }
    *port = (int32_t)number;
    return true;
}

bool publish_take(const char *text, void *list)
{
    publish_list *all = list;
    publish_address a = {.host = LOOPBACK,
                         .listen_host = LOOPBACK,
                         .listen_port = -1,
                         .every = 1,
                         .is_osc = strncmp(text, "osc:", 4) == 0};
    if (strncmp(text, "ros2:/", 6) == 0) {
        const bool has_room = all->count < PUBLISH_MAX && strlen(text) < sizeof a.ros2 / 2;
        (void)snprintf(a.ros2, sizeof a.ros2, "%s", text);
        if (has_room) {
            all->items[all->count++] = a;
        }
        return has_room;
    }
    const char *place = strchr(text, ':');
    const bool is_known = a.is_osc || strncmp(text, "ws:", 3) == 0;
    if (!is_known || all->count == PUBLISH_MAX ||
        !read_place(place + 1, a.is_osc ? 1 : 0, a.host, &a.port)) {
        return false;
    }
    all->items[all->count++] = a;
    return true;
}

/* The keys follow their address. */
static publish_address *last(void *list)
{
    publish_list *all = list;
    return &all->items[all->count - 1];
}

bool publish_take_every(const char *text, void *list)
{
    int64_t number = 0;
    const bool is_good = command_parse_int(text, 1, 1000, &number);
    last(list)->every = (int32_t)number;
    return is_good && last(list)->ros2[0] == '\0';
}

bool publish_take_listen(const char *text, void *list)
{
    publish_address *a = last(list);
    return a->is_osc && read_place(text, 0, a->listen_host, &a->listen_port);
}

bool publish_take_origin(const char *text, void *list)
{
    publish_address *a = last(list);
    a->origin = text;
    return !a->is_osc && a->ros2[0] == '\0' && text[0] != '\0';
}

/* What follows the name: the library reads it. */
static bool add_ros2_key(publish_address *a, const char *key, const char *text)
{
    const size_t length = strlen(a->ros2);
    if (length == 0) {
        return false;
    }
    const int got = snprintf(a->ros2 + length, sizeof a->ros2 - length, "%c%s=%s",
                             strchr(a->ros2, '?') != NULL ? '&' : '?', key, text);
    return got > 0 && (size_t)got < sizeof a->ros2 - length;
}

bool publish_take_profile(const char *text, void *list)
{
    return add_ros2_key(last(list), "profile", text);
}

bool publish_take_domain(const char *text, void *list)
{
    return add_ros2_key(last(list), "domain", text);
}

/* ---- origins --------------------------------------------------------------------------------- */

bool publish_origin_is_right(const char *text, const char *origin)
{
    static const char *const own[] = {"http://localhost", "https://localhost", "http://127.0.0.1",
                                      "https://127.0.0.1"};
    if (text[0] == '\0' || strcmp(text, "file://") == 0 ||
        (origin != NULL && strcmp(text, origin) == 0)) {
        return true; /* no browser, a page of this machine's disk, or the one that was named */
    }
    for (size_t i = 0; i < sizeof own / sizeof own[0]; i++) {
        const size_t length = strlen(own[i]);
        const bool is_begun = strncmp(text, own[i], length) == 0;
        if (is_begun && (text[length] == '\0' || text[length] == ':')) {
            return text[length] == '\0' ||
                   strspn(text + length + 1, "0123456789") == strlen(text + length + 1);
        }
    }
    return false;
}
