/* A window that nobody attends: its source is opened again when it ends, fails or falls silent. */
#include "viewer/state.h"

#include <stdio.h>
#include <string.h>

#define WAIT_NS 1000000000      /* before the first attempt: a plug that is pulled and put back */
#define WAIT_MAX_NS 30000000000 /* a machine that waits all night has time */
#define SILENT_S 10             /* cameras give their first frame within five */
#define SILENT_MAX_S 160

bool viewer_kiosk_is_on(const viewer *v)
{
    return v->options->is_kiosk && v->options->on_open != NULL;
}

void viewer_kiosk_lose(viewer *v, const char *why)
{
    rlf_log(RLF_LOG_WARNING, "kiosk: the source is gone: %s", why);
    v->kiosk.is_lost = true;
    v->kiosk.lost_ns = rlf_clock_ns();
    v->kiosk.wait_ns = WAIT_NS;
    v->kiosk.again_ns = v->kiosk.lost_ns + WAIT_NS;
    v->kiosk.why[0] = '\0';
    v->has_frame = v->is_at_end = v->is_step_due = v->is_redraw_due = false;
    v->grab.is_on = v->place.is_on = false;
    v->stage.source = NULL; /* the program closes it before it opens it again */
    v->stage.playback = NULL;
    viewer_end_recording(v);
}

void viewer_kiosk_note_silence(viewer *v)
{
    kiosk *k = &v->kiosk;
    k->silent_limit_s = k->silent_limit_s > 0 ? k->silent_limit_s : SILENT_S;
    if (viewer_kiosk_is_on(v) && v->silent_s >= k->silent_limit_s) {
        char why[64];
        (void)snprintf(why, sizeof why, "no frame for %d s", (int)v->silent_s);
        k->silent_limit_s *= k->silent_limit_s < SILENT_MAX_S ? 2 : 1; /* a slow starter */
        viewer_kiosk_lose(v, why);
    }
}

void viewer_kiosk_try(viewer *v, int64_t now_ns)
{
    kiosk *k = &v->kiosk;
    if (k->is_lost) {
        v->is_step_due = v->is_redraw_due = false; /* whatever keys ask for */
    }
    if (!k->is_lost || now_ns < k->again_ns) {
        return;
    }
    if (viewer_open_stage(v, RLF_WINDOW_OPEN_AGAIN, "")) {
        rlf_log(RLF_LOG_WARNING, "kiosk: the source is there again, after %lld s",
                (long long)((rlf_clock_ns() - k->lost_ns) / (int64_t)VIEWER_NS_PER_S));
        k->is_lost = false;
        return;
    }
    if (strcmp(k->why, rlf_error_text()) != 0) { /* a night of one error is one line */
        (void)snprintf(k->why, sizeof k->why, "%s", rlf_error_text());
        rlf_log(RLF_LOG_WARNING, "kiosk: not yet: %s", k->why);
    }
    k->wait_ns = 2 * k->wait_ns < WAIT_MAX_NS ? 2 * k->wait_ns : WAIT_MAX_NS;
    k->again_ns = rlf_clock_ns() + k->wait_ns;
}
