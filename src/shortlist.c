#include "shortlist.h"

/* Lets the root of a heap, whose least number is at the root, sink to where it belongs. */
static void sink(float *heap, int count) {
    int at = 0;
    for (;;) {
        int least = at;
        for (int child = 2 * at + 1; child <= 2 * at + 2 && child < count; child++)
            if (heap[child] < heap[least]) least = child;
        if (least == at) return;
        const float moved = heap[at];
        heap[at] = heap[least];
        heap[least] = moved;
        at = least;
    }
}

static void rise(float *heap, int at) {
    while (at > 0 && heap[at] < heap[(at - 1) / 2]) {
        const float moved = heap[at];
        heap[at] = heap[(at - 1) / 2];
        heap[(at - 1) / 2] = moved;
        at = (at - 1) / 2;
    }
}

/* The least of the `wanted` greatest promises. */
static float threshold(const float *promise, int count, int wanted, float *heap) {
    for (int i = 0; i < count; i++) {
        if (i < wanted) {
            heap[i] = promise[i];
            rise(heap, i);
        } else if (promise[i] > heap[0]) {
            heap[0] = promise[i];
            sink(heap, wanted);
        }
    }
    return heap[0];
}

static void swap(float *values, int i, int j) {
    const float moved = values[i];
    values[i] = values[j];
    values[j] = moved;
}

void ast_shortlist(struct ast_cloud *cloud, float *promise, int wanted, float *heap) {
    const float least = threshold(promise, cloud->count, wanted, heap);
    int above = 0;
    for (int i = 0; i < cloud->count; i++) above += promise[i] > least;
    int equal = wanted - above, taken = 0; /* of those at the threshold, how many there is room for */
    for (int i = 0; i < cloud->count && taken < wanted; i++) {
        const int at_threshold = promise[i] == least;
        if (promise[i] < least || (at_threshold && equal == 0)) continue;
        equal -= at_threshold;
        swap(promise, i, taken);
        swap(cloud->x, i, taken);
        swap(cloud->y, i, taken);
        swap(cloud->scale, i, taken);
        taken++;
    }
}
