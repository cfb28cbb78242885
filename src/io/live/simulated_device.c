/* Simulated cameras stay plugged in while programs open and close them. */
#include "io/live/simulated.h"

#include <pthread.h>
#include <stdio.h>
#include <string.h>

#define NAME_SIZE 64
#define DEVICES_MAX 64

typedef struct device {
    char name[NAME_SIZE];
    int64_t start_ns;
} device;

static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
static device devices[DEVICES_MAX];
static int32_t device_count;

static device *find(const char *name)
{
    for (int32_t i = 0; i < device_count; i++) {
        if (strcmp(devices[i].name, name) == 0) {
            return &devices[i];
        }
    }
    return NULL;
}

int64_t simulated_device_start(const char *name)
{
    pthread_mutex_lock(&mutex);
    const device *d = find(name);
    const int64_t start_ns = d != NULL ? d->start_ns : rlf_clock_ns();
    pthread_mutex_unlock(&mutex);
    return start_ns;
}

rlf_result simulated_device_note(const char *name)
{
    if (strlen(name) >= NAME_SIZE) {
        return rlf_fail(RLF_ERROR_INVALID, "simulated:%.20s...: the name is longer than %d bytes",
                        name, NAME_SIZE - 1);
    }
    pthread_mutex_lock(&mutex);
    const bool is_known = find(name) != NULL;
    const bool has_room = device_count < DEVICES_MAX;
    if (!is_known && has_room) {
        device *d = &devices[device_count++];
        (void)snprintf(d->name, sizeof(d->name), "%s", name);
        d->start_ns = rlf_clock_ns();
    }
    pthread_mutex_unlock(&mutex);
    return is_known || has_room ? RLF_OK
                                : rlf_fail(RLF_ERROR_CAPACITY, "simulated:%s: more than %d of them",
                                           name, DEVICES_MAX);
}
