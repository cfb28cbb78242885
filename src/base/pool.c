/* A pool of threads that take chunks of a range. Which thread takes which chunk varies from run to
 * run; the chunks themselves do not, so results that depend only on the chunk are reproducible. */
#define _POSIX_C_SOURCE 200809L
#include "relief/base.h"

#include <pthread.h>
#include <stdatomic.h>
#include <unistd.h>

#define WORKERS_MAX 64

typedef struct worker {
    rlf_pool *pool;
    int32_t index;
    pthread_t thread;
} worker;

struct rlf_pool {
    int32_t worker_count;
    pthread_mutex_t mutex;
    pthread_cond_t start; /* a new job, or stop */
    pthread_cond_t done;  /* the last worker finished the job */
    uint64_t job;         /* counts jobs; workers compare with the last they did */
    bool is_stopping;
    int32_t busy_count;

    rlf_range_fn fn;
    void *context;
    int32_t count, grain;
    atomic_int next_chunk;

    worker workers[WORKERS_MAX];
};

static void take_chunks(rlf_pool *pool, int32_t worker_index)
{
    int32_t chunk_count = (pool->count - 1) / pool->grain + 1;
    for (;;) {
        int32_t chunk = atomic_fetch_add_explicit(&pool->next_chunk, 1, memory_order_relaxed);
        if (chunk >= chunk_count) {
            return;
        }
        int32_t begin = chunk * pool->grain;
        int32_t end = pool->count - begin < pool->grain ? pool->count : begin + pool->grain;
        pool->fn(pool->context, begin, end, worker_index);
    }
}

static void *worker_main(void *argument)
{
    worker *self = argument;
    rlf_pool *pool = self->pool;
    uint64_t last_job = 0;
    pthread_mutex_lock(&pool->mutex);
    for (;;) {
        while (!pool->is_stopping && pool->job == last_job) {
            pthread_cond_wait(&pool->start, &pool->mutex);
        }
        if (pool->is_stopping) {
            break;
        }
        last_job = pool->job;
        pthread_mutex_unlock(&pool->mutex);
        take_chunks(pool, self->index);
        pthread_mutex_lock(&pool->mutex);
        if (--pool->busy_count == 0) {
            pthread_cond_signal(&pool->done);
        }
    }
    pthread_mutex_unlock(&pool->mutex);
    return NULL;
}

static int32_t processor_count(void)
{
    long count = sysconf(_SC_NPROCESSORS_ONLN);
    return count < 1 ? 1 : (count > WORKERS_MAX ? WORKERS_MAX : (int32_t)count);
}

rlf_result rlf_pool_create(int32_t worker_count, rlf_pool **out_pool)
{
    if (!RLF_ASSERT(out_pool != NULL)) {
        return RLF_ERROR_INVALID;
    }
    *out_pool = NULL;
    if (worker_count < 0 || worker_count > WORKERS_MAX) {
        return rlf_fail(RLF_ERROR_INVALID, "worker count %d: use 0 (all processors) to %d",
                        (int)worker_count, WORKERS_MAX);
    }
    rlf_pool *pool = rlf_alloc(sizeof(*pool));
    if (pool == NULL) {
        return RLF_ERROR_MEMORY;
    }
    int32_t wanted = worker_count == 0 ? processor_count() : worker_count;
    pool->worker_count = 1;
    pthread_mutex_init(&pool->mutex, NULL);
    pthread_cond_init(&pool->start, NULL);
    pthread_cond_init(&pool->done, NULL);
    for (int32_t i = 1; i < wanted; i++) {
        worker *w = &pool->workers[i];
        w->pool = pool;
        w->index = i;
        if (pthread_create(&w->thread, NULL, worker_main, w) != 0) {
            rlf_log(RLF_LOG_WARNING, "only %d of %d worker threads could be started", (int)i - 1,
                    (int)wanted - 1);
            break;
        }
        pool->worker_count = i + 1;
    }
    *out_pool = pool;
    return RLF_OK;
}

void rlf_pool_destroy(rlf_pool **pool_pointer)
{
    if (pool_pointer == NULL || *pool_pointer == NULL) {
        return;
    }
    rlf_pool *pool = *pool_pointer;
    *pool_pointer = NULL;
    pthread_mutex_lock(&pool->mutex);
    pool->is_stopping = true;
    pthread_cond_broadcast(&pool->start);
    pthread_mutex_unlock(&pool->mutex);
    for (int32_t i = 1; i < pool->worker_count; i++) {
        pthread_join(pool->workers[i].thread, NULL);
    }
    pthread_cond_destroy(&pool->done);
    pthread_cond_destroy(&pool->start);
    pthread_mutex_destroy(&pool->mutex);
    rlf_free(pool);
}

int32_t rlf_pool_worker_count(const rlf_pool *pool)
{
    return pool != NULL ? pool->worker_count : 1;
}

void rlf_parallel_for(rlf_pool *pool, int32_t count, int32_t grain, rlf_range_fn fn, void *context)
{
    if (!RLF_ASSERT(fn != NULL && grain >= 1) || count <= 0) {
        return;
    }
    if (pool == NULL || pool->worker_count == 1 || count <= grain) {
        for (int32_t begin = 0; begin < count;) {
            int32_t end = count - begin < grain ? count : begin + grain;
            fn(context, begin, end, 0);
            begin = end;
        }
        return;
    }
    pthread_mutex_lock(&pool->mutex);
    pool->fn = fn;
    pool->context = context;
    pool->count = count;
    pool->grain = grain;
    atomic_store(&pool->next_chunk, 0);
    pool->busy_count = pool->worker_count - 1;
    pool->job++;
    pthread_cond_broadcast(&pool->start);
    pthread_mutex_unlock(&pool->mutex);
    take_chunks(pool, 0);
    pthread_mutex_lock(&pool->mutex);
    while (pool->busy_count > 0) {
        pthread_cond_wait(&pool->done, &pool->mutex);
    }
    pthread_mutex_unlock(&pool->mutex);
}
