// Threads, mutexes and conditions: POSIX's, Windows' own, or none in WebAssembly. A Mutex or a Condition must not be moved while it is in
// use.
#pragma once

#include <stdbool.h>

#ifdef _WIN32
typedef void *ThreadHandle;
typedef struct Mutex {
    void *lock;
} Mutex; ///< an SRWLOCK
typedef struct Condition {
    void *variable;
} Condition;            ///< a CONDITION_VARIABLE
#elif defined(__wasm__) // one thread: nothing can be started, nobody waits
typedef int ThreadHandle, Mutex, Condition;
#else
#include <pthread.h>
typedef pthread_t ThreadHandle;
typedef pthread_mutex_t Mutex;
typedef pthread_cond_t Condition;
#endif

/// A running thread. It must not be moved until it is joined.
typedef struct Thread {
    ThreadHandle handle;
    void (*run)(void *context);
    void *context;
} Thread;

/// Starts run(context) on a new thread. False if none can be created.
bool thread_start(Thread *thread, void (*run)(void *context), void *context);
/// Waits until the thread has returned.
void thread_join(Thread *thread);
/// Lets another thread run.
void thread_yield(void);
/// Processors that may run threads, at least 1.
int thread_processors(void);

void mutex_open(Mutex *mutex);
void mutex_close(Mutex *mutex);
void mutex_lock(Mutex *mutex);
void mutex_unlock(Mutex *mutex);

void condition_open(Condition *condition);
void condition_close(Condition *condition);
/// Releases the mutex, waits for a signal, and takes the mutex again. May return without a signal.
void condition_wait(Condition *condition, Mutex *mutex);
void condition_signal(Condition *condition);
void condition_broadcast(Condition *condition);
