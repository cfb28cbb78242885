/* Threads where there are none: one thread, so that locks are free and no worker starts. A pool
 * goes on with its caller alone, and any number of workers gives the same bits. */
#ifndef RLF_WEB_PTHREAD_H
#define RLF_WEB_PTHREAD_H

#include <errno.h>

typedef int pthread_t, pthread_mutex_t, pthread_cond_t;
#define PTHREAD_MUTEX_INITIALIZER 0

static inline int pthread_mutex_init(pthread_mutex_t *mutex, const void *attributes)
{
    (void)mutex;
    (void)attributes;
    return 0;
}
static inline int pthread_mutex_lock(pthread_mutex_t *mutex)
{
    (void)mutex;
    return 0;
}
static inline int pthread_mutex_unlock(pthread_mutex_t *mutex)
{
    (void)mutex;
    return 0;
}
static inline int pthread_mutex_destroy(pthread_mutex_t *mutex)
{
    (void)mutex;
    return 0;
}
static inline int pthread_cond_init(pthread_cond_t *condition, const void *attributes)
{
    (void)condition;
    (void)attributes;
    return 0;
}
static inline int pthread_cond_wait(pthread_cond_t *condition, pthread_mutex_t *mutex)
{
    (void)condition;
    (void)mutex;
    return 0;
}
static inline int pthread_cond_signal(pthread_cond_t *condition)
{
    (void)condition;
    return 0;
}
static inline int pthread_cond_broadcast(pthread_cond_t *condition)
{
    (void)condition;
    return 0;
}
static inline int pthread_cond_destroy(pthread_cond_t *condition)
{
    (void)condition;
    return 0;
}
static inline int pthread_create(pthread_t *thread, const void *attributes,
                                 void *(*run)(void *context), void *context)
{
    (void)thread;
    (void)attributes;
    (void)run;
    (void)context;
    return EAGAIN;
}
static inline int pthread_join(pthread_t thread, void **out_result)
{
    (void)thread;
    (void)out_result;
    return EAGAIN;
}

#endif
