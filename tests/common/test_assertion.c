// An assertion ends the program where assertions are on, and computes nothing where they are off.
#include "support/support.h"

#include "common/assertion.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

static int evaluated;

static bool look(bool answer) {
    evaluated++;
    return answer;
}

TEST(a_broken_invariant_ends_the_program) {
    pid_t child = fork();
    if (child == 0) {
        if (!freopen("/dev/null", "w", stderr)) _exit(2);
        SINGE_ASSERT(look(false));
        _exit(0);
    }
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
#ifdef SINGE_ASSERTIONS
    assert_false(WIFEXITED(status) && WEXITSTATUS(status) == 0);
#else
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
#endif
}

TEST(true_assertions_continue) {
    evaluated = 0;
    SINGE_ASSERT(look(true));
#ifdef SINGE_ASSERTIONS
    assert_int_equal(evaluated, 1);
#else
    assert_int_equal(evaluated, 0);
#endif
}
