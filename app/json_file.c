/* jansson's text through the writer of whole files; what the machine is. */
#define _POSIX_C_SOURCE 200809L
#include "json_file.h"

#include "relief/base.h"
#include "relief/io.h"
#include "relief_build.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>
#include <time.h>
#include <unistd.h>

json_t *json_file_number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

rlf_result json_file_write(const char *path, json_t *root)
{
    char *text = root != NULL ? json_dumps(root, JSON_INDENT(2)) : NULL;
    json_decref(root);
    if (text == NULL) {
        return rlf_fail(RLF_ERROR_MEMORY, "%s: not enough memory for it", path);
    }
    rlf_result result = rlf_file_write(path, text, strlen(text));
    free(text);
    return result;
}

/* ---- the machine ----------------------------------------------------------------------------- */

#define TEXT 160

typedef struct machine {
    char cpu[TEXT], cores[16], system[TEXT], compiler[TEXT], version[32], date[16], load[TEXT];
} machine;

/* Value of the first line "KEY<separators>VALUE" of a file; out stays as it is when there is none.
 */
static void read_value(const char *path, const char *key, const char *separators, char out[TEXT])
{
    FILE *file = fopen(path, "r");
    char line[512];
    while (file != NULL && fgets(line, sizeof(line), file) != NULL) {
        if (strncmp(line, key, strlen(key)) == 0) {
            const char *value = line + strlen(key);
            value += strspn(value, separators);
            snprintf(out, TEXT, "%.*s", (int)strcspn(value, "\"\n"), value);
            break;
        }
    }
    if (file != NULL) {
        fclose(file);
    }
}

static machine describe(void)
{
    machine m = {.cpu = "unknown"};
    read_value("/proc/cpuinfo", "model name", " \t:", m.cpu);
    snprintf(m.cores, sizeof(m.cores), "%ld", sysconf(_SC_NPROCESSORS_ONLN));
    snprintf(m.load, sizeof(m.load), "unknown");
    read_value("/proc/loadavg", "", "", m.load);
    m.load[strcspn(m.load, " ")] = '\0';
    struct utsname name;
    char distribution[TEXT] = "";
    read_value("/etc/os-release", "PRETTY_NAME", "=\"", distribution);
    if (uname(&name) == 0) {
        snprintf(m.system, sizeof(m.system), "%.60s%s%.40s %.40s", distribution,
                 distribution[0] != '\0' ? ", " : "", name.sysname, name.machine);
    }
#if defined(__clang__)
    snprintf(m.compiler, sizeof(m.compiler), "%s", __VERSION__);
#elif defined(__GNUC__)
    snprintf(m.compiler, sizeof(m.compiler), "GCC %s", __VERSION__);
#else
    snprintf(m.compiler, sizeof(m.compiler), "unknown");
#endif
    snprintf(m.version, sizeof(m.version), "%d.%d.%d", RLF_VERSION_MAJOR, RLF_VERSION_MINOR,
             RLF_VERSION_PATCH);
    time_t now = time(NULL);
    struct tm day;
    if (gmtime_r(&now, &day) != NULL) {
        strftime(m.date, sizeof(m.date), "%Y-%m-%d", &day);
    }
    return m;
}

void machine_print(void)
{
    machine m = describe();
    printf("%s, %s cores, %s; %s; %s, %s build; Relief %s, commit %s, %s; load %s\n", m.cpu,
           m.cores, rlf_isa_name(), m.system, m.compiler, RELIEF_BUILD_TYPE, m.version,
           RELIEF_COMMIT, m.date, m.load);
}

json_t *machine_json(void)
{
    machine m = describe();
    return json_pack("{s:s, s:s, s:s, s:s, s:s, s:s, s:s, s:s, s:s, s:s}", "cpu", m.cpu, "cores",
                     m.cores, "isa", rlf_isa_name(), "system", m.system, "compiler", m.compiler,
                     "build", RELIEF_BUILD_TYPE, "version", m.version, "commit", RELIEF_COMMIT,
                     "date", m.date, "load", m.load);
}
