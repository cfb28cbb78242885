/* What the subcommands of `relief` share: messages, and numbers read from their options. */
#define _POSIX_C_SOURCE 200809L
#include "command.h"

#include "relief/io.h"

#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

const char *command_program = "relief";

int command_usage(const char *command, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fprintf(stderr, "%s %s: ", command_program, command);
    vfprintf(stderr, format, arguments);
    fprintf(stderr, " (see `%s %s --help`)\n", command_program, command);
    va_end(arguments);
    return EXIT_USAGE;
}

int command_set(const char *command, setting_list *s, const char *text)
{
    return settings_add(s, text) == RLF_OK ? -1
                                           : command_usage(command, "--set: %s", rlf_error_text());
}

int command_failed(void)
{
    fprintf(stderr, "%s: %s\n", command_program, rlf_error_text());
    return EXIT_FAILED;
}

int command_stopped(const char *command)
{
    fprintf(stderr, "%s %s: stopped before the end; nothing was written\n", command_program,
            command);
    return 128 + command_interrupted;
}

int command_done(void)
{
    return command_interrupted ? 128 + command_interrupted : EXIT_DONE;
}

const char *command_frames(int64_t count)
{
    return count == 1 ? "frame" : "frames";
}

double command_tidy(double value, int decimals)
{
    double half = 0.5;
    for (int i = 0; i < decimals; i++) {
        half *= 0.1;
    }
    return value <= 0.0 && value >= -half ? 0.0 : value;
}

int command_not_opened(const char *command)
{
    return command_interrupted ? command_stopped(command) : command_failed();
}

bool command_parse_int(const char *text, int64_t low, int64_t high, int64_t *out)
{
    char *end = NULL;
    long long value = strtoll(text, &end, 10);
    if (end == text || *end != '\0' || value < low || value > high) {
        return false;
    }
    *out = value;
    return true;
}

bool command_parse_list(const char *text, int64_t low, int64_t high, int capacity, int64_t *out,
                        int *out_count)
{
    *out_count = 0;
    for (const char *rest = text; *out_count < capacity;) {
        char number[24];
        size_t length = strcspn(rest, ",");
        if (length >= sizeof(number)) {
            return false;
        }
        memcpy(number, rest, length);
        number[length] = '\0';
        if (!command_parse_int(number, low, high, &out[*out_count])) {
            return false;
        }
        ++*out_count;
        if (rest[length] == '\0') {
            return true;
        }
        rest += length + 1;
    }
    return false;
}

bool command_parse_range(const char *text, int64_t *out_begin, int64_t *out_end)
{
    const int64_t limit = INT64_C(1000000000);
    const char *colon = strchr(text, ':');
    *out_begin = 0;
    *out_end = limit;
    if (colon == NULL) {
        return command_parse_int(text, 1, limit, out_end);
    }
    char first[32];
    size_t length = (size_t)(colon - text);
    if (length >= sizeof(first)) {
        return false;
    }
    memcpy(first, text, length);
    first[length] = '\0';
    if (length > 0 && !command_parse_int(first, 0, limit, out_begin)) {
        return false;
    }
    if (colon[1] != '\0' && !command_parse_int(colon + 1, 1, limit, out_end)) {
        return false;
    }
    return *out_begin < *out_end;
}

/* ---- standard streams ------------------------------------------------------------------------ */

void streams_open(void)
{
    for (int i = STDIN_FILENO; i <= STDERR_FILENO; i++) {
        /* open takes the lowest number that is free, which is this one. */
        if (fcntl(i, F_GETFD) < 0 && errno == EBADF && open("/dev/null", O_RDWR) < 0) {
            return;
        }
    }
}

int streams_end(int status)
{
    errno = 0;
    const bool is_full = fflush(stdout) != 0 || ferror(stdout) != 0;
    if (!is_full || status != EXIT_DONE) {
        return status;
    }
    if (errno == 0) { /* an earlier write failed; the next one tells why */
        clearerr(stdout);
        (void)(putchar('\n') != EOF && fflush(stdout) == 0);
    }
    fprintf(stderr, "relief: standard output cannot be written: %s: check what reads it\n",
            errno != 0 ? strerror(errno) : "an earlier write failed");
    return EXIT_FAILED;
}

/* ---- Ctrl-C, SIGTERM and SIGHUP -------------------------------------------------------------- */

/* `timeout` and a terminal that closes send one signal to the command and again to its group. */
#define SAME_NS 500000000

volatile sig_atomic_t command_interrupted;

static struct timespec first; /* when it came */

static long long since_first_ns(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (long long)(now.tv_sec - first.tv_sec) * 1000000000 + now.tv_nsec - first.tv_nsec;
}

/* The first one asks the command to end; another one, later, ends it at once. */
static void on_interrupt(int signal_number)
{
    const int errno_before = errno;
    if (!command_interrupted) {
        clock_gettime(CLOCK_MONOTONIC, &first);
        command_interrupted = signal_number;
    } else if (since_first_ns() > SAME_NS) {
        signal(signal_number, SIG_DFL);
        raise(signal_number); /* once this handler has returned */
    }
    errno = errno_before;
}

void command_catch_interrupts(void)
{
    static const int signals[3] = {SIGINT, SIGTERM, SIGHUP};
    struct sigaction action;
    memset(&action, 0, sizeof(action));
    action.sa_handler = on_interrupt;
    sigemptyset(&action.sa_mask);
    for (int i = 0; i < 3; i++) {
        sigaddset(&action.sa_mask, signals[i]);
    }
    for (int i = 0; i < 3; i++) {
        struct sigaction before;
        const bool is_ignored = signals[i] == SIGHUP && sigaction(SIGHUP, NULL, &before) == 0 &&
                                before.sa_handler == SIG_IGN; /* nohup */
        if (!is_ignored) {
            sigaction(signals[i], &action, NULL);
        }
    }
    struct sigaction ignore;
    memset(&ignore, 0, sizeof(ignore));
    ignore.sa_handler = SIG_IGN; /* a closed pipe is reported by the writer instead */
    sigaction(SIGPIPE, &ignore, NULL);
    sigaction(SIGXFSZ, &ignore, NULL); /* and so is a file that has grown to its limit */
}

/* ---- names of outputs ------------------------------------------------------------------------ */

/* What files of pictures, arrays, rooms, recordings and tables are called, here and elsewhere. */
static const char known[] =
    ".mcap .bag .db3 .oni .mkv .klg .sens .pcd .mp4 .y4m .avi .mov .webm .png .jpg .jpeg .bmp .tif "
    ".tiff .gif .webp .json .csv .tsv .txt .ply .obj .glb .gltf .stl .fbx .map .npy .npz .h5 .yaml "
    ".yml .xml .cameramodel .svg .pdf .html .zip";

static const char *ending_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash != NULL ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    return dot != NULL && dot > name ? dot : NULL;
}

static bool is_in(const char *ending, const char *list)
{
    const size_t length = strlen(ending);
    for (const char *word = list; *word != '\0'; word += strspn(word, " ")) {
        const size_t size = strcspn(word, " ");
        if (size == length && strncasecmp(word, ending, size) == 0) {
            return true;
        }
        word += size;
    }
    return false;
}

static bool is_device(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
}

bool output_name_has(const char *path, const char *endings)
{
    const char *ending = ending_of(path);
    return is_device(path) || (ending != NULL && is_in(ending, endings));
}

bool output_name_is_right(const char *path, const char *endings)
{
    const char *ending = ending_of(path);
    return output_name_has(path, endings) || ending == NULL || !is_in(ending, known);
}

bool output_name_is_folder(const char *path)
{
    struct stat status;
    const char *ending = ending_of(path);
    const bool is_there = stat(path, &status) == 0 && S_ISDIR(status.st_mode);
    return is_there || ending == NULL || !is_in(ending, known);
}

/* ---- near names ------------------------------------------------------------------------------ */

/* Appends; what has no room is cut. */
static void append(char out[SUGGEST_TEXT], const char *before, const char *text)
{
    const size_t used = strlen(out);
    (void)snprintf(out + used, SUGGEST_TEXT - used, "%s%s", before, text);
}

static void join(const char *const *names, const char *between, char out[SUGGEST_TEXT])
{
    for (int i = 0; names[i] != NULL; i++) {
        append(out, i > 0 ? between : "", names[i]);
    }
}

const char *suggest_text(const char *text, const char *const *names, bool lists_all,
                         char out[SUGGEST_TEXT])
{
    char words[SUGGEST_TEXT] = "";
    char nearest[64];
    join(names, " ", words);
    out[0] = '\0';
    const bool is_near = rlf_word_nearest(words, text, nearest, sizeof(nearest));
    if (is_near) {
        append(out, "did you mean '", nearest);
        append(out, "'?", "");
    }
    if (names[0] != NULL && (lists_all || !is_near)) {
        append(out, is_near ? " there are " : "there are ", "");
        join(names, ", ", out);
    }
    return out;
}
