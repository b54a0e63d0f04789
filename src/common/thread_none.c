// WebAssembly has one thread here: none can be started, so nothing is ever contended or waited for.
#include "common/thread.h"

bool thread_start(Thread *thread, void (*run)(void *context), void *context) {
    (void)thread, (void)run, (void)context;
    return false;
}

void thread_join(Thread *thread) { (void)thread; }
void thread_yield(void) {}
int thread_processors(void) { return 1; }

void mutex_open(Mutex *mutex) { (void)mutex; }
void mutex_close(Mutex *mutex) { (void)mutex; }
void mutex_lock(Mutex *mutex) { (void)mutex; }
void mutex_unlock(Mutex *mutex) { (void)mutex; }

void condition_open(Condition *condition) { (void)condition; }
void condition_close(Condition *condition) { (void)condition; }
void condition_wait(Condition *condition, Mutex *mutex) { (void)condition, (void)mutex; }
void condition_signal(Condition *condition) { (void)condition; }
void condition_broadcast(Condition *condition) { (void)condition; }
