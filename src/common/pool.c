// A fork-join pool. A job is cut into pieces of `grain` items; the remaining ones are [first, last) in one word. A thread
// takes a fixed share of them at a time, so ranges are long at first and short when threads have to end together. The
// caller takes them from the front and workers from the back, so that from job to job most items stay with the thread
// whose cache they are in. Which thread takes which range does not matter for the result, since items are independent.
//
// A job is over when its pieces are done, not when every worker has seen it: a worker that sleeps, or is preempted,
// delays nobody. A thread reads the job only after it has taken a range, and the job stays until that is done.
//
// Idle workers watch for the next job for a short while, as a step has many, and then block; no more of them watch, or
// are woken, than there are processors to run them.
#include "common/pool.h"

#include "common/clock.h"
#include "common/error.h"
#include "common/thread.h"

#include <stdatomic.h>

enum { POOL_PAUSES = 50, POOL_THREADS_MAX = 64 };

/// s, that a thread watches for another before it sleeps. To be woken costs some 15 us of the one that wakes and 25 us of
/// delay, several times as much on a virtual machine whose processors sleep, too.
static const double POOL_WATCH = 200e-6;

struct Pool {
    SingeTasks tasks; ///< the host's scheduler, when set
    int thread_count, processors;
    Thread threads[POOL_THREADS_MAX];
    Mutex mutex;
    Condition wake, over;
    // the job: written while no range is left, published by `left`
    SingeTaskFn *run;
    void *context;
    int count, grain, pieces;
    _Atomic uint64_t left;       ///< pieces: first << 32 | last
    atomic_uint done;            ///< pieces
    atomic_uint generation;      ///< of jobs
    atomic_int watching, asleep; ///< workers
    atomic_bool caller_asleep;
    atomic_bool quit;
    SingeCancel cancel;
    atomic_bool cancelled; ///< the host has said so
};

static inline void pool_pause(void) {
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#elif defined(__aarch64__)
    __asm__ volatile("yield");
#endif
}

/// Waits for a short while until a word is `value`, or with `leaves` until it is not. False if that was in vain.
static bool pool_watch(const atomic_uint *word, unsigned value, bool leaves) {
    const double start = clock_seconds();
    do {
        for (int i = 0; i < POOL_PAUSES; i++) {
            if ((atomic_load(word) == value) != leaves) return true;
            pool_pause();
        }
        thread_yield(); // to a thread that has work, if there is one
    } while (clock_seconds() - start < POOL_WATCH);

    return false;
}

/// Takes pieces [*first, *last) from the front or the back. False when none are left.
static bool pool_take(Pool *pool, bool back, uint32_t *first, uint32_t *last) {
    uint64_t left = atomic_load_explicit(&pool->left, memory_order_relaxed);
    for (;;) {
        *first = (uint32_t)(left >> 32);
        *last = (uint32_t)left;
        if (*first >= *last) return false;

        const uint32_t share = (*last - *first) / (2 * (uint32_t)pool->thread_count), taken = share > 1 ? share : 1;
        const uint64_t rest = back ? left - taken : left + ((uint64_t)taken << 32);
        if (atomic_compare_exchange_weak(&pool->left, &left, rest)) {
            if (back) *first = *last - taken;
            else *last = *first + taken;
            return true;
        }
    }
}

static void pool_run_ranges(Pool *pool, bool back) {
    uint32_t first, last;
    while (pool_take(pool, back, &first, &last)) {
        const unsigned pieces = (unsigned)pool->pieces, taken = last - first;
        const int begin = (int)first * pool->grain;
        const int end = (int)last == pool->pieces ? pool->count : (int)last * pool->grain;
        pool->run(pool->context, begin, end);

        // the job may change from here on
        if (atomic_fetch_add(&pool->done, taken) + taken == pieces && atomic_load(&pool->caller_asleep)) {
            mutex_lock(&pool->mutex);
            condition_signal(&pool->over);
            mutex_unlock(&pool->mutex);
        }
    }
}

static void pool_worker(void *argument) {
    Pool *pool = argument;
    unsigned seen = 0;
    while (!atomic_load(&pool->quit)) {
        // watches for a while
        bool found = false;
        if (atomic_fetch_add(&pool->watching, 1) + 1 < pool->processors)
            found = pool_watch(&pool->generation, seen, true);
        atomic_fetch_sub(&pool->watching, 1);

        // then sleeps
        if (!found) {
            mutex_lock(&pool->mutex);
            atomic_fetch_add(&pool->asleep, 1); // before the generation is read: see pool_for
            while (atomic_load(&pool->generation) == seen) condition_wait(&pool->wake, &pool->mutex);
            atomic_fetch_sub(&pool->asleep, 1);
            mutex_unlock(&pool->mutex);
        }

        seen = atomic_load(&pool->generation);
        pool_run_ranges(pool, true);
    }
}

SingeResult pool_create(Memory *memory, SingeTasks tasks, int thread_count, Pool **out) {
    *out = NULL;
    Pool *pool = memory_new(memory, 1, sizeof *pool);
    if (!pool) return SINGE_ERROR_MEMORY;
    pool->tasks = tasks;

    int processors = thread_processors();
    pool->processors = processors > POOL_THREADS_MAX ? POOL_THREADS_MAX : processors;
    mutex_open(&pool->mutex);
    condition_open(&pool->wake);
    condition_open(&pool->over);
    if (thread_count > POOL_THREADS_MAX) thread_count = POOL_THREADS_MAX;

    // works without threads that cannot be created: results are the same
    int count = 1;
    if (!tasks.enqueue)
        while (count < thread_count && thread_start(&pool->threads[count], pool_worker, pool)) count++;
    pool->thread_count = count;
    *out = pool;
    return SINGE_OK;
}

void pool_destroy(Memory *memory, Pool *pool) {
    if (!pool) return;

    atomic_store(&pool->quit, true);
    mutex_lock(&pool->mutex);
    atomic_fetch_add(&pool->generation, 1);
    condition_broadcast(&pool->wake);
    mutex_unlock(&pool->mutex);
    for (int i = 1; i < pool->thread_count; i++) thread_join(&pool->threads[i]);

    mutex_close(&pool->mutex);
    condition_close(&pool->wake);
    condition_close(&pool->over);
    memory_free(memory, (void *)&pool, 1, sizeof *pool);
}

int pool_threads(const Pool *pool) {
    if (!pool) return 1;
    return pool->tasks.enqueue ? POOL_THREADS_MAX : pool->thread_count; // of a host's scheduler nothing is known
}

void pool_set_cancel(Pool *pool, SingeCancel cancel) {
    pool->cancel = cancel;
    atomic_store(&pool->cancelled, false);
}

bool pool_cancelled(Pool *pool) {
    if (!pool || !pool->cancel.asked) return false;
    if (atomic_load_explicit(&pool->cancelled, memory_order_relaxed)) return true;
    if (!pool->cancel.asked(pool->cancel.context)) return false;
    atomic_store(&pool->cancelled, true);
    return true;
}

SingeResult pool_check_cancelled(Pool *pool, const char *stage, SingeError *error) {
    if (!pool_cancelled(pool)) return SINGE_OK;
    return error_set(error, SINGE_ERROR_CANCELLED, stage, -1, "the step was given up, as the host has asked");
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

    const int pieces = (count - 1) / grain + 1;
    pool->run = run;
    pool->context = context;
    pool->count = count;
    pool->grain = grain;
    pool->pieces = pieces;
    atomic_store(&pool->done, 0);
    atomic_store(&pool->left, (uint64_t)pieces);

    // wakes as many sleepers as the pieces and processors can use, less the threads awake. The generation is raised
    // before `asleep` is read: a worker that is not counted as asleep here sees the new generation before it sleeps
    atomic_fetch_add(&pool->generation, 1);
    int asleep = atomic_load(&pool->asleep), awake = pool->thread_count - asleep;
    int useful = pieces < pool->processors ? pieces : pool->processors;
    if (asleep > 0 && awake < useful) {
        mutex_lock(&pool->mutex);
        for (; awake < useful && asleep > 0; awake++, asleep--) condition_signal(&pool->wake);
        mutex_unlock(&pool->mutex);
    }

    pool_run_ranges(pool, false);

    // waits until the pieces taken by others are done
    if (pool_watch(&pool->done, (unsigned)pieces, false)) return;
    mutex_lock(&pool->mutex);
    atomic_store(&pool->caller_asleep, true);
    while (atomic_load(&pool->done) != (unsigned)pieces) condition_wait(&pool->over, &pool->mutex);
    atomic_store(&pool->caller_asleep, false);
    mutex_unlock(&pool->mutex);
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
    pool_for(pool, blocks, 1, pool_sum_blocks, &job);
    double total = 0;
    for (int block = 0; block < blocks; block++) total += partial[block];
    return total;
}
