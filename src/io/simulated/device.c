/* Simulated cameras stay plugged in while programs open and close them. */
#include "io/simulated/device.h"

#include <pthread.h>
#include <stdio.h>
#include <string.h>

#define NAME_SIZE 64
#define DEVICES_MAX 64

typedef struct device {
    char name[NAME_SIZE];
    int64_t plugged_ns;
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

rlf_result simulated_device_find(const char *name, int64_t *out_plugged_ns)
{
    if (strlen(name) >= NAME_SIZE) {
        return rlf_fail(RLF_ERROR_INVALID, "simulated:%.20s...: the name is longer than %d bytes",
                        name, NAME_SIZE - 1);
    }
    rlf_result result = RLF_OK;
    pthread_mutex_lock(&mutex);
    device *d = find(name);
    if (d == NULL && device_count < DEVICES_MAX) {
        d = &devices[device_count++];
        (void)snprintf(d->name, sizeof(d->name), "%s", name);
        d->plugged_ns = rlf_clock_ns();
    }
    if (d != NULL) {
        *out_plugged_ns = d->plugged_ns;
    } else {
        result =
            rlf_fail(RLF_ERROR_CAPACITY, "simulated:%s: more than %d of them", name, DEVICES_MAX);
    }
    pthread_mutex_unlock(&mutex);
    return result;
}
