/* A pool of threads that take chunks of a range. Which thread takes which chunk varies from run to
 * run; the chunks themselves do not, so results that depend only on the chunk are reproducible. */
#define _POSIX_C_SOURCE 200809L
#include "relief/base.h"

#include <pthread.h>
#include <stdatomic.h>
#include <unistd.h>

#define WORKERS_MAX 64
/* Looks at a thing that is about to change before sleeping on it: some 10 us. A frame is dozens of
 * jobs in a row, and waking a sleeping thread costs more than a small one takes. */
#define LOOKS 20000

typedef struct worker {
    rlf_pool *pool;
    int32_t index;
    pthread_t thread;
} worker;

typedef struct range_job {
    rlf_range_fn fn;
    void *context;
    int32_t count, grain, chunk_count;
    uint32_t id; /* counts jobs */
} range_job;

struct rlf_pool {
    int32_t worker_count;
    pthread_mutex_t mutex; /* guards job, sleeper_count and is_stopping */
    pthread_cond_t start;  /* a new job, or stop */
    pthread_cond_t done;   /* the last chunk is done */
    range_job job;
    int32_t sleeper_count;
    bool is_stopping;
    _Atomic uint32_t news; /* changes with each job and with stop: what awake workers look at */
    /* Job id << 32 | next chunk: a worker that comes late takes no chunk of a job it has not read.
     */
    _Atomic uint64_t ticket;
    _Atomic int32_t left; /* chunks of the job that are not done */

    worker workers[WORKERS_MAX];
};

/* Next chunk of the job, or -1 when all are taken. */
static int32_t take_chunk(rlf_pool *pool, const range_job *job)
{
    uint64_t ticket = atomic_load(&pool->ticket);
    do {
        if ((uint32_t)(ticket >> 32) != job->id || (uint32_t)ticket >= (uint32_t)job->chunk_count) {
            return -1;
        }
    } while (!atomic_compare_exchange_weak(&pool->ticket, &ticket, ticket + 1));
    return (int32_t)(uint32_t)ticket;
}

/* The caller waits for chunks, not for workers: one that is still asleep delays nobody. */
static void do_chunks(rlf_pool *pool, const range_job *job, int32_t worker_index)
{
    for (int32_t chunk = take_chunk(pool, job); chunk >= 0; chunk = take_chunk(pool, job)) {
        int32_t begin = chunk * job->grain;
        int32_t end = job->count - begin < job->grain ? job->count : begin + job->grain;
        job->fn(job->context, begin, end, worker_index);
        if (atomic_fetch_sub(&pool->left, 1) == 1 && worker_index != 0) {
            pthread_mutex_lock(&pool->mutex);
            pthread_cond_signal(&pool->done);
            pthread_mutex_unlock(&pool->mutex);
        }
    }
}

/* Waits for a job other than `last` and copies it; false: stop. */
static bool next_job(rlf_pool *pool, uint32_t last, range_job *job)
{
    uint32_t news = last;
    for (int32_t i = 0; i < LOOKS && news == last; i++) {
        news = atomic_load(&pool->news);
    }
    pthread_mutex_lock(&pool->mutex);
    while (!pool->is_stopping && pool->job.id == last) {
        pool->sleeper_count++;
        pthread_cond_wait(&pool->start, &pool->mutex);
        pool->sleeper_count--;
    }
    *job = pool->job;
    bool is_stopping = pool->is_stopping;
    pthread_mutex_unlock(&pool->mutex);
    return !is_stopping;
}

static void *worker_main(void *argument)
{
    worker *self = argument;
    range_job job = {.id = 0};
    while (next_job(self->pool, job.id, &job)) {
        do_chunks(self->pool, &job, self->index);
    }
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
    atomic_store(&pool->news, pool->job.id + 1);
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

static range_job start_job(rlf_pool *pool, int32_t count, int32_t grain, rlf_range_fn fn,
                           void *context)
{
    pthread_mutex_lock(&pool->mutex);
    pool->job = (range_job){fn, context, count, grain, (count - 1) / grain + 1, pool->job.id + 1};
    range_job job = pool->job;
    atomic_store(&pool->left, job.chunk_count);
    atomic_store(&pool->ticket, (uint64_t)job.id << 32);
    atomic_store(&pool->news, job.id);
    if (pool->sleeper_count > 0) {
        pthread_cond_broadcast(&pool->start);
    }
    pthread_mutex_unlock(&pool->mutex);
    return job;
}

static void wait_done(rlf_pool *pool)
{
    for (int32_t i = 0; i < LOOKS; i++) {
        if (atomic_load(&pool->left) == 0) {
            return;
        }
    }
    pthread_mutex_lock(&pool->mutex);
    while (atomic_load(&pool->left) > 0) {
        pthread_cond_wait(&pool->done, &pool->mutex);
    }
    pthread_mutex_unlock(&pool->mutex);
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
    range_job job = start_job(pool, count, grain, fn, context);
    do_chunks(pool, &job, 0);
    wait_done(pool);
}
