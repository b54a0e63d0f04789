// The pool: every item once for any split, sums bitwise equal for any number of threads, the host's hook.
#include "support/support.h"

#include "common/pool.h"

#include <stdatomic.h>
#include <time.h>

enum { ITEMS_MAX = 10007 };

typedef struct Tally {
    unsigned char seen[ITEMS_MAX + 1];
    int count, grain;
    atomic_bool small; ///< a range below the grain that is not the last one
} Tally;

static void tally_range(void *task, int begin, int end) {
    Tally *tally = task;
    for (int i = begin; i < end; i++) tally->seen[i]++;
    if (end - begin < tally->grain && end != tally->count) atomic_store(&tally->small, true);
}

static Pool *make_pool(Memory *memory, int threads) {
    Pool *pool;
    assert_int_equal(pool_create(memory, (SingeTasks){0}, threads, &pool), SINGE_OK);
    return pool;
}

static void check_once(Pool *pool, int count, int grain) {
    static Tally tally;
    memset(&tally, 0, sizeof tally);
    tally.count = count, tally.grain = grain;
    pool_for(pool, count, grain, tally_range, &tally);
    for (int i = 0; i < count; i++)
        if (tally.seen[i] != 1) fail_msg("item %d of %d was seen %d times at grain %d", i, count, tally.seen[i], grain);
    assert_int_equal(tally.seen[count < 0 ? 0 : count], 0);
    assert_false(tally.small);
}

TEST(every_item_is_visited_once) {
    static const int counts[] = {-3, 0, 1, 2, 3, 7, 64, 65, 1000, 1024, 4097, ITEMS_MAX};
    static const int grains[] = {1, 2, 7, 64, 1024, 20000};
    Memory memory = memory_make((SingeAllocator){0});

    for (int threads = 1; threads <= 8; threads++) {
        Pool *pool = make_pool(&memory, threads);
        for (size_t c = 0; c < sizeof counts / sizeof *counts; c++)
            for (size_t g = 0; g < sizeof grains / sizeof *grains; g++) check_once(pool, counts[c], grains[g]);
        pool_destroy(&memory, pool);
    }

    check_once(NULL, 100, 3);
    assert_int_equal(memory.held, 0);
}

static void bump(void *task, int begin, int end) {
    int *values = task;
    for (int i = begin; i < end; i++) values[i] = values[i] * 3 + 1;
}

/// Many short jobs in a row: a job that began before the last one ended, or a wake-up that got lost, shows.
TEST(jobs_follow_each_other) {
    Memory memory = memory_make((SingeAllocator){0});
    static int values[97];
    for (int threads = 2; threads <= 5; threads++) {
        Pool *pool = make_pool(&memory, threads);
        memset(values, 0, sizeof values);

        unsigned expected = 0;
        for (int job = 0; job < 15; job++) expected = expected * 3 + 1;

        for (int round = 0; round < 100; round++) {
            memset(values, 0, sizeof values);
            for (int job = 0; job < 15; job++) pool_for(pool, 97, 1 + job % 5, bump, values);
            for (int i = 0; i < 97; i++) assert_int_equal(values[i], (int)expected);
        }

        pool_destroy(&memory, pool);
    }
}

static void slow_item(void *task, int begin, int end) {
    atomic_int *done = task;
    for (int i = begin; i < end; i++) {
        nanosleep(&(struct timespec){0, 300000}, NULL);
        atomic_fetch_add(done, 1);
    }
}

/// Threads that are still at work when the others have nothing left to do.
TEST(slow_ranges_are_waited_for) {
    Memory memory = memory_make((SingeAllocator){0});
    for (int threads = 2; threads <= 5; threads++) {
        Pool *pool = make_pool(&memory, threads);
        for (int round = 0; round < 20; round++) {
            atomic_int done = 0;
            pool_for(pool, 5 + round % 4, 1, slow_item, &done);
            assert_int_equal(atomic_load(&done), 5 + round % 4);
        }

        pool_destroy(&memory, pool);
    }
}

/// A pool that never gets a job, and one that is destroyed right after it.
TEST(idle_pools_end) {
    Memory memory = memory_make((SingeAllocator){0});
    for (int i = 0; i < 50; i++) {
        Pool *pool = make_pool(&memory, 4);
        int values[8] = {0};
        if (i & 1) pool_for(pool, 8, 1, bump, values);
        pool_destroy(&memory, pool);
    }

    pool_destroy(&memory, NULL);
    assert_int_equal(memory.held, 0);
}

static double sum_range(void *context, int begin, int end) {
    const double *values = context;
    double sum = 0;
    for (int i = begin; i < end; i++) sum += values[i];
    return sum;
}

TEST(sums_are_bitwise_equal) {
    enum { COUNT = 123457 };
    Memory memory = memory_make((SingeAllocator){0});
    double *values = malloc(COUNT * sizeof *values), *partial = malloc((size_t)pool_blocks(COUNT) * sizeof *partial);
    assert_true(values && partial);

    uint32_t random = 1;
    for (int i = 0; i < COUNT; i++) {
        random = random * 1664525u + 1013904223u;
        values[i] = ((double)random / 4294967296.0 - 0.5) * (i % 7 ? 1 : 1e10); // cancels badly: order matters
    }

    static const int counts[] = {0, 1, 1023, 1024, 1025, 50000, COUNT};
    for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
        double expected = 0;
        for (int first = 0; first < counts[c]; first += POOL_BLOCK)
            expected += sum_range(values, first, first + POOL_BLOCK < counts[c] ? first + POOL_BLOCK : counts[c]);

        for (int threads = 1; threads <= 8; threads++) {
            Pool *pool = make_pool(&memory, threads);
            double sum = pool_sum(pool, counts[c], sum_range, values, partial);
            assert_memory_equal(&sum, &expected, sizeof sum);
            pool_destroy(&memory, pool);
        }
    }

    free(values);
    free(partial);
}

TEST(blocks_cover_every_item) {
    assert_int_equal(pool_blocks(0), 0);
    assert_int_equal(pool_blocks(1), 1);
    assert_int_equal(pool_blocks(POOL_BLOCK), 1);
    assert_int_equal(pool_blocks(POOL_BLOCK + 1), 2);
    assert_int_equal(pool_blocks(INT32_MAX), 1 << 21);
}

static void ranges_end(void *task, int begin, int end) {
    atomic_bool *bad = task;
    if (begin < 0 || end <= begin) atomic_store(bad, true);
}

/// Counters must not run over at the end of the index type.
TEST(the_largest_count_does_not_overflow) {
    Memory memory = memory_make((SingeAllocator){0});
    Pool *pool = make_pool(&memory, 3);
    atomic_bool bad = false;
    pool_for(pool, INT32_MAX, 1 << 30, ranges_end, &bad);
    assert_false(bad);
    pool_destroy(&memory, pool);
}

/// A host's scheduler that runs ranges backwards when `finish` asks for them.
typedef struct Host {
    SingeTaskFn *run;
    void *task;
    int count, grain, enqueued, finished;
} Host;

static void *host_enqueue(void *context, SingeTaskFn *run, void *task, int count, int grain) {
    Host *host = context;
    *host = (Host){run, task, count, grain, host->enqueued + 1, host->finished};
    return host;
}

static void host_finish(void *context, void *token) {
    Host *host = context;
    assert_ptr_equal(token, host);

    for (int end = host->count; end > 0;) {
        int begin = end > host->grain ? end - host->grain : 0;
        if (begin < host->grain) begin = 0;
        host->run(host->task, begin, end);
        end = begin;
    }

    host->finished++;
}

TEST(a_host_may_run_the_ranges) {
    Memory memory = memory_make((SingeAllocator){0});
    Host host = {0};
    Pool *pool;

    assert_int_equal(pool_create(&memory, (SingeTasks){host_enqueue, host_finish, &host}, 8, &pool), SINGE_OK);
    static int values[1000];
    pool_for(pool, 1000, 64, bump, values);
    for (int i = 0; i < 1000; i++) assert_int_equal(values[i], 1);
    assert_int_equal(host.enqueued, 1);
    assert_int_equal(host.finished, 1);
    pool_destroy(&memory, pool);
}

TEST(pools_need_memory) {
    TestAllocator hook = {.fail_at = 1};
    Memory memory = memory_make(test_allocator(&hook));
    Pool *pool;
    assert_int_equal(pool_create(&memory, (SingeTasks){0}, 4, &pool), SINGE_ERROR_MEMORY);
    assert_null(pool);
}
