// Work shared among threads: fixed blocks, so that results do not depend on the number of threads.
#pragma once

#include "common/memory.h"

typedef struct Pool Pool;

/// Items in one block of a reduction. Part of the numerics: sums are taken block by block.
enum { POOL_BLOCK = 1024 };

/// Items of some 10 ns in the shortest range that is worth a thread of its own.
enum { POOL_GRAIN = 256 };

/// A pool of `thread_count` threads (the caller is one of them), or one that hands its work to
/// `tasks` when that is set.
SingeResult pool_create(Memory *memory, SingeTasks tasks, int thread_count, Pool **pool);
void pool_destroy(Memory *memory, Pool *pool);

/// Threads that may share a job, the caller among them.
int pool_threads(const Pool *pool);

/// Sets what pool_cancelled asks, and forgets its answer.
void pool_set_cancel(Pool *pool, SingeCancel cancel);
/// Whether the host has asked to give up what is under way; on any thread. Once true, until pool_set_cancel. A NULL pool is
/// never asked.
bool pool_cancelled(Pool *pool);
/// The error of a stage that was given up, or SINGE_OK.
SingeResult pool_check_cancelled(Pool *pool, const char *stage, SingeError *error);

/// Calls run(context, begin, end) over [0, count) in ranges of at least `grain` items, and returns when all are done.
/// Items must be independent. A NULL pool runs everything in the calling thread.
void pool_for(Pool *pool, int count, int grain, SingeTaskFn *run, void *context);

/// Sum over [0, count): sum(context, begin, end) is called for fixed blocks of POOL_BLOCK items and the
/// blocks are added in order. `partial` holds pool_blocks(count) doubles.
typedef double PoolSumFn(void *context, int begin, int end);
double pool_sum(Pool *pool, int count, PoolSumFn *sum, void *context, double *partial);
static inline int pool_blocks(int count) { return count / POOL_BLOCK + (count % POOL_BLOCK > 0); }
