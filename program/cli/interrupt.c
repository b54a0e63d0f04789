#include "cli/interrupt.h"

#include <signal.h>
#include <stddef.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

// The only statics of the program: a signal handler cannot exchange data in another way.
static volatile sig_atomic_t interrupt_flag, interrupt_second, interrupt_left;
enum { DRAFTS_MAX = 8 };
static const char *volatile interrupt_drafts[DRAFTS_MAX];

static void note_signal(int number) {
    (void)number;
    interrupt_second = (sig_atomic_t)(time(NULL) & 0x3fffffff);
    interrupt_flag = 1;
    struct sigaction plain = {.sa_handler = SIG_DFL};
    sigaction(SIGINT, &plain, NULL);
    sigaction(SIGTERM, &plain, NULL);
}

static void remove_drafts(void) {
    for (int i = 0; i < DRAFTS_MAX; i++)
        if (interrupt_drafts[i]) unlink(interrupt_drafts[i]);
}

static void replace_draft(const char *old, const char *draft) {
    for (int i = 0; i < DRAFTS_MAX; i++)
        if (interrupt_drafts[i] == old) {
            interrupt_drafts[i] = draft;
            return;
        }
}

void interrupt_own(const char *draft) {
    if (draft) replace_draft(NULL, draft);
}

void interrupt_disown(const char *draft) {
    if (draft) replace_draft(draft, NULL);
}

void interrupt_shield(void) {
    atexit(remove_drafts);
    struct sigaction ignore = {.sa_handler = SIG_IGN};
    sigaction(SIGPIPE, &ignore, NULL);
}

void interrupt_watch(void) {
    struct sigaction note = {.sa_handler = note_signal, .sa_flags = SA_RESTART};
    sigemptyset(&note.sa_mask);
    sigaddset(&note.sa_mask, SIGINT);
    sigaddset(&note.sa_mask, SIGTERM);
    sigaction(SIGINT, &note, NULL);
    sigaction(SIGTERM, &note, NULL);
}

bool interrupt_asked(void) { return interrupt_flag != 0; }

bool interrupt_overdue(void) {
    if (!interrupt_flag || (time(NULL) & 0x3fffffff) - interrupt_second < 2) return false;
    interrupt_left = 1;
    return true;
}

bool interrupt_left_work(void) { return interrupt_left != 0; }
