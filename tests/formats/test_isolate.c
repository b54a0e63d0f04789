// A function in a child: its answer, its errors, its crashes, and what it may take of memory and time.
#include "common/clock.h"
#include "formats/isolate.h"
#include "format_test.h"

#include <errno.h>
#include <pthread.h>
#include <signal.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <time.h>

static const IsolateLimits few = {64 << 20, 1};

// the answer and the error of a case
static Bytes got;
static SingeError why;

static SingeResult run(IsolateWork *work, void *context, Bytes *answer, SingeError *error) {
    SingeResult result = isolate_run("a.mesh", work, context, few, (SingeAllocator){0}, answer, error);
    assert_int_equal(waitpid(-1, NULL, WNOHANG), -1); // none is left behind
    assert_int_equal(errno, ECHILD);

    if (result) {
        assert_null(answer->data);
        assert_int_equal(error->code, result);
        assert_message(error, "a.mesh");
    }

    return result;
}

// ---- answers

enum { MANY = 3000017 };

static SingeResult put_many(void *context, IsolateAnswer *answer, SingeError *error) {
    (void)error;
    const uint8_t *bytes = context;
    isolate_put(answer, bytes, 11);
    isolate_put(answer, bytes + 11, MANY - 11);
    return SINGE_OK;
}

static SingeResult put_nothing(void *context, IsolateAnswer *answer, SingeError *error) {
    (void)context, (void)answer, (void)error;
    return SINGE_OK;
}

static uint8_t *many(void) {
    uint8_t *bytes = malloc(MANY);
    for (uint32_t i = 0; i < MANY; i++) bytes[i] = (uint8_t)(i * 2654435761u >> 13);
    return bytes;
}

TEST(answers_arrive_complete) {
    uint8_t *bytes = many();

    if (run(put_many, bytes, &got, &why)) fail_msg("%s", why.message);
    assert_int_equal(got.size, MANY);
    assert_memory_equal(got.data, bytes, MANY);
    assert_int_equal(got.data[MANY], 0);
    bytes_free(&got);
    if (run(put_nothing, NULL, &got, &why)) fail_msg("%s", why.message);
    assert_int_equal(got.size, 0);
    bytes_free(&got);
    free(bytes);
}

static SingeResult refuse_work(void *context, IsolateAnswer *answer, SingeError *error) {
    (void)context;
    isolate_put(answer, "some of it", 10);
    error->element = 17;
    strcpy(error->stage, "mesh");
    strcpy(error->message, "a.mesh:17: no good");
    return SINGE_ERROR_MESH;
}

TEST(errors_come_as_they_were) {
    assert_int_equal(run(refuse_work, NULL, &got, &why), SINGE_ERROR_MESH);
    assert_string_equal(why.message, "a.mesh:17: no good");
    assert_string_equal(why.stage, "mesh");
    assert_int_equal(why.element, 17);
    assert_int_equal(isolate_run("a.mesh", refuse_work, NULL, few, (SingeAllocator){0}, &got, NULL), SINGE_ERROR_MESH);
}

TEST(failing_memory_of_the_parent_is_reported) {
    uint8_t *bytes = many();
    test_allocations_fail(0, isolate_run("a.mesh", put_many, bytes, few, allocator, &got, &why), bytes_free(&got));
    free(bytes);
}

// ---- crashes

static SingeResult crash(void *context, IsolateAnswer *answer, SingeError *error) {
    (void)error;
    isolate_put(answer, "some of it", 10);
    raise(*(int *)context);
    return SINGE_OK;
}

static SingeResult stop(void *context, IsolateAnswer *answer, SingeError *error) {
    (void)answer, (void)error;
    exit(*(int *)context);
}

TEST(crashes_are_reported) {
    static const int signals[] = {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGKILL};

    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++) {
        char number[24];
        snprintf(number, sizeof number, "signal %d", signals[i]);
        assert_int_equal(run(crash, (void *)(uintptr_t)&signals[i], &got, &why), SINGE_ERROR_FORMAT);
        assert_message(&why, number);
    }

    // a library that ends the process gives no answer, whatever its exit code
    for (int code = 0; code < 3; code++) {
        assert_int_equal(run(stop, &code, &got, &why), SINGE_ERROR_FORMAT);
        assert_message(&why, "stopped");
    }
}

static volatile sig_atomic_t noted;
static void note(int number) { noted = number; }

TEST(interrupts_stop_the_child) {
    struct sigaction before, own = {.sa_handler = note};
    int number = SIGINT;
    sigaction(SIGINT, &own, &before); // is not the child's
    assert_int_equal(run(crash, &number, &got, &why), SINGE_ERROR_STATE);
    assert_message(&why, "interrupted");
    sigaction(SIGINT, &before, NULL);
    assert_int_equal(noted, 0);
}

// ---- limits

static SingeResult spin(void *context, IsolateAnswer *answer, SingeError *error) {
    (void)context, (void)answer, (void)error;
    for (volatile unsigned i = 0;; i++) {
    }
    return SINGE_OK;
}

static SingeResult wait_long(void *context, IsolateAnswer *answer, SingeError *error) {
    (void)context, (void)answer, (void)error;
    for (;;) pause();
    return SINGE_OK;
}

TEST(time_is_limited) {
    double start = clock_seconds();

    assert_int_equal(run(spin, NULL, &got, &why), SINGE_ERROR_LIMIT);
    assert_message(&why, "more than 1 s");
    IsolateLimits short_time = {64 << 20, 0.1};
    assert_int_equal(isolate_run("a.mesh", wait_long, NULL, short_time, (SingeAllocator){0}, &got, &why),
                     SINGE_ERROR_LIMIT);
    assert_message(&why, "more than 0.1 s");
    assert_true(clock_seconds() - start < 8);
}

static SingeResult take_slowly(void *context, IsolateAnswer *answer, SingeError *error) {
    (void)context, (void)answer, (void)error;
    for (;;) {
        char *block = malloc(1 << 20);
        memset(block, 1, 1 << 20); // crashes without memory
        nanosleep(&(struct timespec){.tv_nsec = 100000}, NULL);
    }

    return SINGE_OK;
}

static SingeResult take_at_once(void *context, IsolateAnswer *answer, SingeError *error) {
    (void)answer;
    void *block = malloc(*(size_t *)context);
    if (block) return SINGE_OK;
    strcpy(error->message, "cannot be read"); // for another reason, says the library
    return SINGE_ERROR_FORMAT;
}

static SingeResult answer_too_much(void *context, IsolateAnswer *answer, SingeError *error) {
    (void)error;
    for (;;) isolate_put(answer, context, 1 << 16);
    return SINGE_OK;
}

TEST(memory_is_limited) {
    IsolateLimits slow = {64 << 20, 20};
    assert_int_equal(isolate_run("a.mesh", take_slowly, NULL, slow, (SingeAllocator){0}, &got, &why),
                     SINGE_ERROR_LIMIT);
    assert_message(&why, "more than 67 MB of memory");
    static char block[1 << 16];
    assert_int_equal(run(answer_too_much, block, &got, &why), SINGE_ERROR_LIMIT);
    assert_message(&why, "more than 67 MB of memory");
#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    size_t size = (size_t)1 << 33;
    assert_int_equal(run(take_at_once, &size, &got, &why), SINGE_ERROR_LIMIT);
    assert_message(&why, "more than 67 MB of memory");
#endif
    size_t little = 1 << 20;
    assert_int_equal(run(take_at_once, &little, &got, &why), SINGE_OK);
    bytes_free(&got);
}

// ---- what is the parent's

static SingeResult print(void *context, IsolateAnswer *answer, SingeError *error) {
    (void)answer, (void)error;
    fputs("from the child", stderr);
    fputs("twice", context);
    return SINGE_OK;
}

TEST(files_of_the_parent_stay_as_they_are) {
    FILE *file = tmpfile();
    assert_non_null(file);
    fputs("once", file); // still in the buffer, of which the child has a copy
    assert_int_equal(run(print, file, &got, NULL), SINGE_OK);
    bytes_free(&got);
    fflush(file);
    assert_int_equal(ftell(file), 4);
    assert_int_equal(lseek(fileno(file), 0, SEEK_END), 4);
    fclose(file);
}

// In a child of the test's own, whose code tells what happened.
static int without_descriptors(void) {
    for (int i = 0; i < 3; i++) close(i);
    uint8_t *bytes = many();
    Bytes answer;
    SingeResult result = isolate_run("a.mesh", put_many, bytes, few, (SingeAllocator){0}, &answer, NULL);
    return result == SINGE_OK && answer.size == MANY ? 0 : 1;
}

TEST(closed_descriptors_do_no_harm) {
    int status;
    pid_t child = fork();
    if (child == 0) _exit(without_descriptors());
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(status, 0);
}

TEST(signals_do_not_cut_the_wait) {
    struct sigaction before, own = {.sa_handler = note}; // without SA_RESTART
    struct itimerval often = {{0, 500}, {0, 500}}, never = {{0, 0}, {0, 0}};
    uint8_t *bytes = many();
    sigaction(SIGALRM, &own, &before);
    setitimer(ITIMER_REAL, &often, NULL);

    SingeResult result = run(put_many, bytes, &got, &why);
    setitimer(ITIMER_REAL, &never, NULL);
    sigaction(SIGALRM, &before, NULL);
    if (result) fail_msg("%s", why.message);
    assert_int_equal(noted, SIGALRM);
    noted = 0;
    assert_memory_equal(got.data, bytes, MANY);
    bytes_free(&got);
    free(bytes);
}

TEST(a_parent_that_ignores_its_children_gets_answers) {
    uint8_t *bytes = many();

    signal(SIGCHLD, SIG_IGN);
    SingeResult result = run(put_many, bytes, &got, &why);
    signal(SIGCHLD, SIG_DFL);
    if (result) fail_msg("%s", why.message);
    assert_int_equal(got.size, MANY);
    bytes_free(&got);
    free(bytes);
}

#ifdef __linux__
static SingeResult say_and_wait(void *context, IsolateAnswer *answer, SingeError *error) {
    (void)write(*(int *)context, "x", 1);
    return wait_long(context, answer, error);
}

// Only the child of the child holds an end of the pipe, so the pipe closes when it is gone.
TEST(the_child_ends_with_its_parent) {
    int ends[2];
    char byte;
    assert_int_equal(pipe(ends), 0);

    pid_t parent = fork();
    if (parent == 0) {
        IsolateLimits limits = {64 << 20, 1000};
        (void)!isolate_run("a.mesh", say_and_wait, &ends[1], limits, (SingeAllocator){0}, &got, NULL);
        _exit(0);
    }

    close(ends[1]);
    assert_int_equal(read(ends[0], &byte, 1), 1);
    kill(parent, SIGKILL);
    assert_int_equal(waitpid(parent, NULL, 0), parent);
    assert_int_equal(read(ends[0], &byte, 1), 0); // and does not wait for ever
    close(ends[0]);
}

static void *sleep_on(void *context) {
    char byte;
    (void)!read(*(int *)context, &byte, 1);
    return NULL;
}

TEST(other_threads_are_refused) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    skip(); // they have threads of their own
#endif
    int ends[2];
    pthread_t thread;
    assert_int_equal(pipe(ends), 0);
    assert_int_equal(pthread_create(&thread, NULL, sleep_on, &ends[0]), 0);
    assert_int_equal(run(put_nothing, NULL, &got, &why), SINGE_ERROR_STATE);
    assert_message(&why, "threads");
    close(ends[1]);
    pthread_join(thread, NULL);
    close(ends[0]);
}
#endif
