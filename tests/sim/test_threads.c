// The same bytes for any number of threads, and on the host's scheduler.
#include "scenes.h"

#ifdef SINGE_THREADS_ONLY
enum { CELLS = 20, STEPS = 24, THREADS_MAX = 4 };
#else
enum { CELLS = 44, STEPS = 40, THREADS_MAX = 8 };
#endif

static TestBytes run(SingeSimDef def) {
    OwnTestScene scene = scene_make(&def, CELLS);
    test_steps(scene.sim, STEPS);
    SingeStats stats = singe_sim_stats(scene.sim);
    assert_true(stats.mass_burnt > 0 && stats.mass_removed > 0);
    TestBytes bytes = test_save(scene.sim);
    return bytes;
}

static void equal(const TestBytes *expected, TestBytes bytes, const char *what) {
    if (bytes.size != expected->size || memcmp(bytes.data, expected->data, bytes.size))
        fail_msg("%s: other bytes", what);
    free(bytes.data);
}

/// A scheduler that runs odd-sized ranges last to first.
typedef struct Host {
    long jobs;
    int odd;
} Host;

typedef struct HostJob {
    SingeTaskFn *run;
    void *task;
    int count, grain;
} HostJob;

static HostJob pending;

static void *host_enqueue(void *context, SingeTaskFn *function, void *task, int count, int grain) {
    ((Host *)context)->jobs++;
    pending = (HostJob){function, task, count, grain};
    return &pending;
}

static void host_finish(void *context, void *token) {
    Host *host = context;
    const HostJob job = *(HostJob *)token;
    int end = job.count;

    while (end > 0) {
        int size = job.grain + host->odd++ % 13, begin = end - size;
        if (begin < job.grain) begin = 0;
        job.run(job.task, begin, end);
        end = begin;
    }
}

TEST(any_number_of_threads_gives_the_same_bytes) {
    SingeSimDef def = scene_def();
    OwnTestBytes expected = run(def);
    for (int threads = 2; threads <= THREADS_MAX; threads += threads < 4 ? 1 : 4) {
        def.thread_count = threads;
        char what[16] = "n threads";
        what[0] = (char)('0' + threads);
        equal(&expected, run(def), what);
    }

    def.thread_count = 1;
    Host host = {0};
    def.tasks = (SingeTasks){host_enqueue, host_finish, &host};
    equal(&expected, run(def), "the host's scheduler");
    assert_true(host.jobs > STEPS);
}
