#include "preview/share.h"

#include "preview/internal.h"

#include <pthread.h>
#include <stdatomic.h>

typedef struct Share {
    void (*item)(void *context, int k);
    void *context;
    atomic_int next;
    int count;
} Share;

static void *take_items(void *context) {
    Share *share = context;
    for (int k; (k = atomic_fetch_add(&share->next, 1)) < share->count;) share->item(share->context, k);
    return NULL;
}

void share_out(int threads, int count, void (*item)(void *context, int k), void *context) {
    Share share = {.item = item, .context = context, .count = count};
    atomic_init(&share.next, 0);
    pthread_t others[THREAD_LIMIT];
    int started = 0;
    const int wanted = (threads < count ? threads : count) - 1;

    // a thread that cannot be created only makes it slower
    while (started < wanted && started < THREAD_LIMIT && !pthread_create(&others[started], NULL, take_items, &share))
        started++;
    take_items(&share);
    for (int i = 0; i < started; i++) pthread_join(others[i], NULL);
}
