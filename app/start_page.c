/* What there is to choose without a SOURCE: cameras, the simulated room, recent recordings, scenes.
 */
#include "start_page.h"

#include "command.h"
#include "recent.h"
#include "relief/io.h"
#include "scene_list.h"

#include <stdio.h>
#include <string.h>

#define CAMERAS_MAX 16

/* The end of a path tells more than its beginning. */
static const char *end_of(const char *path)
{
    const size_t length = strlen(path);
    const size_t most = 60;
    return length > most ? path + (length - most) : path;
}

int32_t start_page_list(rlf_window_choice *out)
{
    int32_t count = 0;
    rlf_source_entry cameras[CAMERAS_MAX];
    const int32_t found = rlf_source_list(cameras, CAMERAS_MAX);
    for (int32_t i = 0; i < found && i < CAMERAS_MAX; i++) {
        rlf_window_choice *c = &out[count++];
        (void)snprintf(c->source, sizeof(c->source), "%.255s", cameras[i].source);
        c->scene[0] = '\0';
        (void)snprintf(c->text, sizeof(c->text), "camera: %.80s", cameras[i].description);
    }
    rlf_window_choice *room = &out[count++];
    (void)snprintf(room->source, sizeof(room->source), "synthetic:room");
    room->scene[0] = '\0';
    (void)snprintf(room->text, sizeof(room->text), "simulated room%s",
                   found <= 0 ? " (no camera is plugged in)" : "");
    recent_list recent;
    recent_load(&recent);
    for (int32_t i = 0; i < recent.count; i++) {
        rlf_window_choice *c = &out[count++];
        (void)snprintf(c->source, sizeof(c->source), "%.1023s", recent.paths[i]);
        c->scene[0] = '\0';
        (void)snprintf(c->text, sizeof(c->text), "recent: %s", end_of(recent.paths[i]));
    }
    return count;
}

static int32_t list_choices(void *context, rlf_window_choice *out)
{
    (void)context;
    const int32_t count = start_page_list(out);
    return count + scene_list_played(out + count, RLF_WINDOW_CHOICES_MAX - count);
}

rlf_result start_page_choose(rlf_window_choice *out)
{
    return rlf_window_choose(list_choices, NULL, &command_interrupted, out);
}
