/* What the window tells its user: over the picture until it was read, in the panel until others
 * have taken its place. */
#include "viewer/state.h"

#include <stdio.h>
#include <string.h>

#define SHORTEST_S 3.0
#define PER_LETTER_S 0.06 /* 16 letters a second are read by most */

static void tell(viewer *v, const char *text, bool is_error)
{
    if (text[0] == '\0') {
        return;
    }
    if (is_error && v->options->is_kiosk) { /* nobody reads it on the wall */
        rlf_log(RLF_LOG_WARNING, "%s", text);
        return;
    }
    if (v->message_count == 0 || strcmp(v->messages[0].text, text) != 0) {
        memmove(v->messages + 1, v->messages, sizeof v->messages - sizeof v->messages[0]);
        v->message_count += v->message_count < VIEWER_MESSAGES_MAX ? 1 : 0;
    }
    viewer_message *m = &v->messages[0];
    (void)snprintf(m->text, sizeof m->text, "%s", text);
    const double seconds = SHORTEST_S + PER_LETTER_S * (double)strlen(m->text);
    m->end_ns = rlf_clock_ns() + (int64_t)(seconds * VIEWER_NS_PER_S);
    m->is_error = is_error;
    v->is_present_due = true;
}

void viewer_show_message(viewer *v, const char *text)
{
    tell(v, text, false);
}

void viewer_show_error(viewer *v, const char *text)
{
    tell(v, text, true);
}

void viewer_show_result(viewer *v, rlf_result result, const char *text)
{
    tell(v, result == RLF_OK ? text : rlf_error_text(), result != RLF_OK);
}

void viewer_end_old_messages(viewer *v, int64_t now_ns)
{
    for (int32_t i = 0; i < v->message_count; i++) {
        viewer_message *m = &v->messages[i];
        if (m->end_ns != 0 && now_ns > m->end_ns) {
            m->end_ns = 0;
            v->is_present_due = true;
        }
    }
}
