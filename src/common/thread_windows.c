// Threads by Windows: slim locks and condition variables, which need not be freed.
#include "common/thread.h"

#include <process.h>
#include <windows.h>

_Static_assert(sizeof(SRWLOCK) == sizeof(Mutex), "a Mutex holds an SRWLOCK");
_Static_assert(sizeof(CONDITION_VARIABLE) == sizeof(Condition), "a Condition holds a CONDITION_VARIABLE");

static unsigned __stdcall thread_main(void *argument) {
    Thread *thread = argument;
    thread->run(thread->context);
    return 0;
}

bool thread_start(Thread *thread, void (*run)(void *context), void *context) {
    thread->run = run;
    thread->context = context;
    thread->handle = (void *)_beginthreadex(NULL, 0, thread_main, thread, 0, NULL);
    return thread->handle != NULL;
}

void thread_join(Thread *thread) {
    WaitForSingleObject(thread->handle, INFINITE);
    CloseHandle(thread->handle);
}

void thread_yield(void) { SwitchToThread(); }

int thread_processors(void) {
    SYSTEM_INFO info;
    GetSystemInfo(&info);
    return info.dwNumberOfProcessors < 1 ? 1 : (int)info.dwNumberOfProcessors;
}

void mutex_open(Mutex *mutex) { InitializeSRWLock((SRWLOCK *)mutex); }
void mutex_close(Mutex *mutex) { (void)mutex; }
void mutex_lock(Mutex *mutex) { AcquireSRWLockExclusive((SRWLOCK *)mutex); }
void mutex_unlock(Mutex *mutex) { ReleaseSRWLockExclusive((SRWLOCK *)mutex); }

void condition_open(Condition *condition) { InitializeConditionVariable((CONDITION_VARIABLE *)condition); }
void condition_close(Condition *condition) { (void)condition; }
void condition_wait(Condition *condition, Mutex *mutex) {
    SleepConditionVariableSRW((CONDITION_VARIABLE *)condition, (SRWLOCK *)mutex, INFINITE, 0);
}
void condition_signal(Condition *condition) { WakeConditionVariable((CONDITION_VARIABLE *)condition); }
void condition_broadcast(Condition *condition) { WakeAllConditionVariable((CONDITION_VARIABLE *)condition); }
