/* What `relief run` shows without a SOURCE: cameras, the simulated room, recent recordings. */
#include "start_page.h"

#include "command.h"
#include "recent.h"
#include "relief/io.h"

#include <stdio.h>
#include <string.h>

#define CAMERAS_MAX (VIEWER_CHOICES_MAX - RECENT_MAX - 1)

/* The end of a path tells more than its beginning. */
static const char *end_of(const char *path)
{
    const size_t length = strlen(path);
    const size_t most = 60;
    return length > most ? path + (length - most) : path;
}

int32_t start_page_list(viewer_choice *out)
{
    int32_t count = 0;
    rlf_source_entry cameras[CAMERAS_MAX];
    const int32_t found = rlf_source_list(cameras, CAMERAS_MAX);
    for (int32_t i = 0; i < found && i < CAMERAS_MAX; i++) {
        viewer_choice *c = &out[count++];
        (void)snprintf(c->source, sizeof(c->source), "%.255s", cameras[i].source);
        (void)snprintf(c->text, sizeof(c->text), "camera: %.80s", cameras[i].description);
    }
    viewer_choice *room = &out[count++];
    (void)snprintf(room->source, sizeof(room->source), "synthetic:room");
    (void)snprintf(room->text, sizeof(room->text), "simulated room%s",
                   found <= 0 ? " (no camera is plugged in)" : "");
    recent_list recent;
    recent_load(&recent);
    for (int32_t i = 0; i < recent.count; i++) {
        viewer_choice *c = &out[count++];
        (void)snprintf(c->source, sizeof(c->source), "%.1023s", recent.paths[i]);
        (void)snprintf(c->text, sizeof(c->text), "recent: %s", end_of(recent.paths[i]));
    }
    return count;
}

static int32_t list_choices(void *context, viewer_choice *out)
{
    (void)context;
    return start_page_list(out);
}

int start_page_choose(char out[START_PAGE_SOURCE])
{
    viewer_choice choice;
    const rlf_result result = viewer_choose(list_choices, NULL, &command_interrupted, &choice);
    if (result == RLF_ERROR_DEVICE) {
        return command_usage("run", "needs a SOURCE: no start page: %s", rlf_error_text());
    }
    if (result != RLF_OK) {
        return result == RLF_END ? EXIT_DONE : command_failed();
    }
    (void)snprintf(out, START_PAGE_SOURCE, "%s", choice.source);
    return -1;
}
