// A fork-join pool. A job is cut into ranges of `grain` items which threads take from a shared counter;
// which thread takes which range does not matter, since items are independent. Workers spin for a
// short while between jobs (a step has many short ones) and then block.
#include "base/pool.h"

#include "base/error.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>

enum { POOL_SPINS = 200, POOL_THREADS_MAX = 64 };

struct Pool {
    SingeTasks tasks; ///< the host's scheduler, when set
    int thread_count;
    pthread_t threads[POOL_THREADS_MAX];
    pthread_mutex_t mutex;
    pthread_cond_t wake, done;
    // the job: written under the mutex before `generation` is raised
    SingeTaskFn *run;
    void *context;
    int count, grain;
    bool quit;
    atomic_llong next; ///< runs past `count` by a grain a thread
    atomic_uint generation;
    atomic_int working; ///< workers that have not left the job yet
};

static void pool_take_ranges(Pool *pool, SingeTaskFn *run, void *context, int count, int grain) {
    for (;;) {
        long long begin = atomic_fetch_add(&pool->next, grain);
        if (begin >= count) return;
        run(context, (int)begin, (int)(begin + grain < count ? begin + grain : count));
    }
}

static void *pool_worker(void *argument) {
    Pool *pool = argument;
    unsigned seen = 0;
    for (;;) {
        for (int spin = 0; spin < POOL_SPINS && atomic_load(&pool->generation) == seen; spin++) sched_yield();
        pthread_mutex_lock(&pool->mutex);
        while (atomic_load(&pool->generation) == seen && !pool->quit) pthread_cond_wait(&pool->wake, &pool->mutex);
        seen = atomic_load(&pool->generation);
        SingeTaskFn *run = pool->run;
        void *context = pool->context;
        int count = pool->count, grain = pool->grain;
        bool quit = pool->quit;
        pthread_mutex_unlock(&pool->mutex);
        if (quit) return NULL;
        pool_take_ranges(pool, run, context, count, grain);
        if (atomic_fetch_sub(&pool->working, 1) == 1) {
            pthread_mutex_lock(&pool->mutex);
            pthread_cond_signal(&pool->done);
            pthread_mutex_unlock(&pool->mutex);
        }
    }
}

SingeResult pool_create(Memory *memory, SingeTasks tasks, int thread_count, Pool **out) {
    *out = NULL;
    Pool *pool = memory_new(memory, 1, sizeof *pool);
    if (!pool) return SINGE_ERROR_MEMORY;
    pool->tasks = tasks;
    pthread_mutex_init(&pool->mutex, NULL);
    pthread_cond_init(&pool->wake, NULL);
    pthread_cond_init(&pool->done, NULL);
    if (thread_count > POOL_THREADS_MAX) thread_count = POOL_THREADS_MAX;
    pool->thread_count = 1;
    // a thread that cannot be had is done without: results are the same
    if (!tasks.enqueue)
        while (pool->thread_count < thread_count &&
               pthread_create(&pool->threads[pool->thread_count], NULL, pool_worker, pool) == 0)
            pool->thread_count++;
    *out = pool;
    return SINGE_OK;
}

void pool_destroy(Memory *memory, Pool *pool) {
    if (!pool) return;
    pthread_mutex_lock(&pool->mutex);
    pool->quit = true;
    atomic_fetch_add(&pool->generation, 1);
    pthread_cond_broadcast(&pool->wake);
    pthread_mutex_unlock(&pool->mutex);
    for (int i = 1; i < pool->thread_count; i++) pthread_join(pool->threads[i], NULL);
    pthread_mutex_destroy(&pool->mutex);
    pthread_cond_destroy(&pool->wake);
    pthread_cond_destroy(&pool->done);
    memory_free(memory, (void *)&pool, 1, sizeof *pool);
}

void pool_for(Pool *pool, int count, int grain, SingeTaskFn *run, void *context) {
    if (count <= 0) return;
    if (!pool || (!pool->tasks.enqueue && pool->thread_count == 1) || count <= grain) {
        run(context, 0, count);
        return;
    }
    if (pool->tasks.enqueue) {
        void *token = pool->tasks.enqueue(pool->tasks.context, run, context, count, grain);
        pool->tasks.finish(pool->tasks.context, token);
        return;
    }
    // about four ranges a thread even out the load without much counting
    int even = (count - 1) / (4 * pool->thread_count) + 1;
    if (grain < even) grain = even;
    pthread_mutex_lock(&pool->mutex);
    pool->run = run, pool->context = context, pool->count = count, pool->grain = grain;
    atomic_store(&pool->next, 0);
    atomic_store(&pool->working, pool->thread_count - 1);
    atomic_fetch_add(&pool->generation, 1);
    pthread_cond_broadcast(&pool->wake);
    pthread_mutex_unlock(&pool->mutex);
    pool_take_ranges(pool, run, context, count, grain);
    for (int spin = 0; spin < POOL_SPINS && atomic_load(&pool->working) > 0; spin++) sched_yield();
    if (atomic_load(&pool->working) == 0) return;
    pthread_mutex_lock(&pool->mutex);
    while (atomic_load(&pool->working) > 0) pthread_cond_wait(&pool->done, &pool->mutex);
    pthread_mutex_unlock(&pool->mutex);
}

typedef struct PoolSum {
    PoolSumFn *sum;
    void *context;
    double *partial;
    int count;
} PoolSum;

static void pool_sum_blocks(void *task, int begin, int end) {
    PoolSum *job = task;
    for (int block = begin; block < end; block++) {
        int first = block * POOL_BLOCK, rest = job->count - first;
        job->partial[block] = job->sum(job->context, first, first + (rest < POOL_BLOCK ? rest : POOL_BLOCK));
    }
}

double pool_sum(Pool *pool, int count, PoolSumFn *sum, void *context, double *partial) {
    PoolSum job = {sum, context, partial, count};
    int blocks = pool_blocks(count);
    pool_for(pool, blocks, 4, pool_sum_blocks, &job);
    double total = 0;
    for (int block = 0; block < blocks; block++) total += partial[block];
    return total;
}
