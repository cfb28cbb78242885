/* The logs of a run: frames.csv, bodies.csv, contacts.csv and hands.csv; trajectory.txt once the
 * camera moves. */
#include "relief/io.h"
#include "io/file.h"

#include <stdarg.h>
#include <string.h>

#define ROW_SIZE 1024 /* two quoted names and sixteen numbers need less */

typedef struct row {
    char text[ROW_SIZE];
    size_t length;
} row;

struct rlf_csv_log {
    io_out_file frames, bodies, contacts, hands, trajectory;
    char folder[IO_PATH_MAX];
    bool has_moved;
};

static void add_bytes(row *r, const char *text, size_t length)
{
    if (r->length > 0 && r->length + 1 < ROW_SIZE) {
        r->text[r->length++] = ',';
    }
    for (size_t i = 0; i < length && r->length + 1 < ROW_SIZE; i++) {
        r->text[r->length++] = text[i];
    }
}

static void add_numbers(row *r, const double *x, int count)
{
    for (int i = 0; i < count; i++) {
        char text[IO_NUMBER_SIZE];
        const int length = io_number_format(x[i], text);
        add_bytes(r, text, (size_t)length);
    }
}

/* Quoted where it must be: RFC 4180. */
static void add_name(row *r, const char *name)
{
    char text[2 * RLF_NAME_MAX + 2];
    size_t length = 0;
    bool is_quoted = strpbrk(name, ",\"\r\n") != NULL;
    if (is_quoted) {
        text[length++] = '"';
    }
    for (size_t i = 0; name[i] != '\0' && i < RLF_NAME_MAX; i++) {
        if (name[i] == '"') {
            text[length++] = '"';
        }
        text[length++] = name[i];
    }
    if (is_quoted) {
        text[length++] = '"';
    }
    add_bytes(r, text, length);
}

/* Fields of a row, by their kinds: i int64_t, n double, s const char *, v rlf_vec3, q rlf_quat. */
static void add(row *r, const char *kinds, ...)
{
    va_list fields;
    va_start(fields, kinds);
    for (; *kinds != '\0'; kinds++) {
        char text[IO_NUMBER_SIZE];
        double x[4] = {0};
        int count = 0;
        if (*kinds == 'i') {
            const long long number = va_arg(fields, int64_t);
            add_bytes(r, text, (size_t)snprintf(text, sizeof(text), "%lld", number));
        } else if (*kinds == 's') {
            add_name(r, va_arg(fields, const char *));
        } else if (*kinds == 'v') {
            const rlf_vec3 v = va_arg(fields, rlf_vec3);
            x[0] = v.x, x[1] = v.y, x[2] = v.z;
            count = 3;
        } else if (*kinds == 'q') {
            const rlf_quat q = va_arg(fields, rlf_quat);
            x[0] = q.x, x[1] = q.y, x[2] = q.z, x[3] = q.w;
            count = 4;
        } else {
            x[0] = va_arg(fields, double);
            count = 1;
        }
        add_numbers(r, x, count);
    }
    va_end(fields);
}

static rlf_result end_row(io_out_file *file, row *r)
{
    r->text[r->length++] = '\n';
    return io_out_write(file, r->text, r->length);
}

static rlf_result open_one(io_out_file *file, const char *folder, const char *name,
                           const char *header)
{
    char path[IO_PATH_MAX];
    rlf_result result = io_path_join(folder, name, path);
    result = result == RLF_OK ? io_out_open(file, path) : result;
    return result == RLF_OK ? io_out_write(file, header, strlen(header)) : result;
}

static rlf_result open_all(rlf_csv_log *log, const char *folder)
{
    const struct {
        io_out_file *file;
        const char *name, *header;
    } files[] = {
        {&log->frames, "frames.csv",
         "frame,time_s,valid,missing,foreground,regions,capture_ms,surface_ms,physics_ms,"
         "render_ms\n"},
        {&log->bodies, "bodies.csv", "frame,time_s,body,px,py,pz,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz\n"},
        {&log->contacts, "contacts.csv",
         "frame,time_s,body,other,px,py,pz,nx,ny,nz,separation,impulse,surface_speed\n"},
        {&log->hands, "hands.csv",
         "frame,time_s,hand,side,px,py,pz,vx,vy,vz,gesture,pinch_m,holding,confidence\n"}};
    rlf_result result = RLF_OK;
    for (int i = 0; i < 4 && result == RLF_OK; i++) {
        result = open_one(files[i].file, folder, files[i].name, files[i].header);
    }
    return result;
}

/* Closes all; they appear together or, when one cannot be written, not at all. */
static rlf_result close_all(rlf_csv_log *log, rlf_result result)
{
    io_out_file *const files[5] = {&log->frames, &log->bodies, &log->contacts, &log->hands,
                                   &log->trajectory};
    const int count = log->has_moved ? 5 : 4;
    for (int i = 0; i < count; i++) {
        result = io_out_finish(files[i], result);
    }
    for (int i = 0; i < count; i++) {
        result = io_out_settle(files[i], result);
    }
    return result;
}

rlf_result rlf_csv_log_open(const char *folder, rlf_csv_log **out)
{
    if (!RLF_ASSERT(folder != NULL && out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    *out = NULL;
    rlf_result result = rlf_make_folder(folder);
    if (result != RLF_OK) {
        return result;
    }
    rlf_csv_log *log = rlf_alloc(sizeof(*log));
    if (log == NULL) {
        return RLF_ERROR_MEMORY;
    }
    (void)snprintf(log->folder, sizeof(log->folder), "%s", folder);
    result = open_all(log, folder);
    if (result != RLF_OK) {
        close_all(log, result);
        rlf_free(log);
        return result;
    }
    *out = log;
    return RLF_OK;
}

static rlf_result write_frame(rlf_csv_log *log, const rlf_pipeline_output *output)
{
    const rlf_surface *s = output->surface;
    row r = {.length = 0};
    add(&r, "iniiiinnnn", output->frame_index, output->time_s, (int64_t)s->valid_count,
        (int64_t)s->width * s->height - s->valid_count, (int64_t)s->foreground_count,
        (int64_t)s->region_count, output->times.capture_ms, output->times.surface_ms,
        output->times.physics_ms, output->times.render_ms);
    return end_row(&log->frames, &r);
}

static rlf_result write_bodies(rlf_csv_log *log, const rlf_pipeline_output *output)
{
    const rlf_snapshot *snapshot = output->snapshot;
    rlf_result result = RLF_OK;
    for (int32_t i = 0; i < snapshot->body_count && result == RLF_OK; i++) {
        const rlf_body_state *body = &snapshot->bodies[i];
        row r = {.length = 0};
        add(&r, "insvqvv", output->frame_index, output->time_s, body->name, body->T_world_body.p,
            body->T_world_body.q, body->velocity, body->angular_velocity);
        result = end_row(&log->bodies, &r);
    }
    return result;
}

static bool has_id(const rlf_body_state *body, rlf_body_id id)
{
    return body->id.index1 == id.index1 && body->id.generation == id.generation;
}

/* Usually the body stands at its index; after removals it is looked for. */
static const char *name_of(const rlf_snapshot *snapshot, rlf_body_id id)
{
    int64_t guess = (int64_t)id.index1 - 1;
    if (guess >= 0 && guess < snapshot->body_count && has_id(&snapshot->bodies[guess], id)) {
        return snapshot->bodies[guess].name;
    }
    for (int32_t i = 0; i < snapshot->body_count; i++) {
        if (has_id(&snapshot->bodies[i], id)) {
            return snapshot->bodies[i].name;
        }
    }
    for (int32_t i = 0; i < snapshot->known_count; i++) {
        if (has_id(&snapshot->known[i], id)) {
            return snapshot->known[i].name;
        }
    }
    return "removed"; /* it left the world's bounds in this very frame */
}

static const char *other_name(const rlf_snapshot *snapshot, const rlf_contact *contact)
{
    switch (contact->other) {
    case RLF_CONTACT_BODY: return name_of(snapshot, contact->other_body);
    case RLF_CONTACT_BACKGROUND: return "background";
    case RLF_CONTACT_FOREGROUND: return "foreground";
    }
    return "unknown";
}

static rlf_result write_contacts(rlf_csv_log *log, const rlf_pipeline_output *output)
{
    const rlf_snapshot *snapshot = output->snapshot;
    rlf_result result = RLF_OK;
    for (int32_t i = 0; i < snapshot->contact_count && result == RLF_OK; i++) {
        const rlf_contact *contact = &snapshot->contacts[i];
        row r = {.length = 0};
        add(&r, "inssvvnnn", output->frame_index, output->time_s, name_of(snapshot, contact->body),
            other_name(snapshot, contact), contact->point, contact->normal, contact->separation,
            contact->impulse, contact->surface_speed);
        result = end_row(&log->contacts, &r);
    }
    return result;
}

static const char *held_name(const rlf_snapshot *snapshot, uint64_t holding)
{
    const rlf_body_id id = {(uint32_t)holding, (uint32_t)(holding >> 32)};
    return id.index1 != 0 ? name_of(snapshot, id) : "";
}

/* In the world's frame, as the bodies are; only what is rather a hand than not. */
static rlf_result write_hands(rlf_csv_log *log, const rlf_pipeline_output *output)
{
    static const char *const sides[] = {"unknown", "left", "right"};
    const int32_t count = output->hands != NULL ? output->hands->count : 0;
    const rlf_pose *T = &output->T_world_camera;
    rlf_result result = RLF_OK;
    for (int32_t i = 0; i < count && result == RLF_OK; i++) {
        const rlf_hand *hand = &output->hands->hand[i];
        if (hand->confidence < RLF_HAND_SURE) {
            continue;
        }
        row r = {.length = 0};
        add(&r, "inisvvsnsn", output->frame_index, output->time_s, (int64_t)hand->id,
            sides[hand->side], rlf_transform(T, hand->palm), rlf_rotate(T->q, hand->velocity),
            rlf_gesture_name(hand->gesture), hand->pinch_width,
            held_name(output->snapshot, hand->holding), hand->confidence);
        result = end_row(&log->hands, &r);
    }
    return result;
}

/* As TUM's tools read it, from the first frame on that a camera moves in; a frame that could not be
 * placed is left out. */
static rlf_result write_trajectory(rlf_csv_log *log, const rlf_pipeline_output *output)
{
    rlf_result result = RLF_OK;
    if (output->track == NULL || output->track->health == RLF_TRACK_LOST) {
        return RLF_OK;
    }
    if (!log->has_moved) {
        log->has_moved = true;
        result = open_one(&log->trajectory, log->folder, "trajectory.txt",
                          "# time tx ty tz qx qy qz qw: seconds, metres; the camera in the "
                          "world\n");
    }
    const rlf_pose T = output->T_world_camera;
    char text[ROW_SIZE];
    const int length = snprintf(text, sizeof(text), "%.6f %.6f %.6f %.6f %.8f %.8f %.8f %.8f\n",
                                (double)output->frame.time_ns * 1e-9, T.p.x, T.p.y, T.p.z, T.q.x,
                                T.q.y, T.q.z, T.q.w);
    return result == RLF_OK ? io_out_write(&log->trajectory, text, (size_t)length) : result;
}

rlf_result rlf_csv_log_write(rlf_csv_log *log, const rlf_pipeline_output *output)
{
    if (!RLF_ASSERT(log != NULL && output != NULL) ||
        !RLF_ASSERT(output->surface != NULL && output->snapshot != NULL)) {
        return RLF_ERROR_INVALID;
    }
    rlf_result result = write_frame(log, output);
    result = result == RLF_OK ? write_bodies(log, output) : result;
    result = result == RLF_OK ? write_contacts(log, output) : result;
    result = result == RLF_OK ? write_hands(log, output) : result;
    return result == RLF_OK ? write_trajectory(log, output) : result;
}

rlf_result rlf_csv_log_close(rlf_csv_log **log)
{
    if (log == NULL || *log == NULL) {
        return RLF_OK;
    }
    rlf_result result = close_all(*log, RLF_OK);
    rlf_free(*log);
    *log = NULL;
    return result;
}
