// Threads by POSIX.
#include "common/thread.h"

#include <sched.h>
#include <unistd.h>

static void *thread_main(void *argument) {
    Thread *thread = argument;
    thread->run(thread->context);
    return NULL;
}

bool thread_start(Thread *thread, void (*run)(void *context), void *context) {
    thread->run = run;
    thread->context = context;
    return pthread_create(&thread->handle, NULL, thread_main, thread) == 0;
}

void thread_join(Thread *thread) { pthread_join(thread->handle, NULL); }
void thread_yield(void) { sched_yield(); }

int thread_processors(void) {
    long count = sysconf(_SC_NPROCESSORS_ONLN);
    return count < 1 ? 1 : count > 1 << 16 ? 1 << 16 : (int)count;
}

void mutex_open(Mutex *mutex) { pthread_mutex_init(mutex, NULL); }
void mutex_close(Mutex *mutex) { pthread_mutex_destroy(mutex); }
void mutex_lock(Mutex *mutex) { pthread_mutex_lock(mutex); }
void mutex_unlock(Mutex *mutex) { pthread_mutex_unlock(mutex); }

void condition_open(Condition *condition) { pthread_cond_init(condition, NULL); }
void condition_close(Condition *condition) { pthread_cond_destroy(condition); }
void condition_wait(Condition *condition, Mutex *mutex) { pthread_cond_wait(condition, mutex); }
void condition_signal(Condition *condition) { pthread_cond_signal(condition); }
void condition_broadcast(Condition *condition) { pthread_cond_broadcast(condition); }
