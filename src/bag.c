#include "bag.h"

#include <string.h>

#include "vector.h"

static size_t capacity_columns(const struct ast_bag *bag) {
    return (size_t)bag->lead + (size_t)bag->capacity * ((size_t)bag->n + 1);
}

void ast_bag_layout(struct ast_bag *bag, int dim, int stride, int lead, int n, int capacity, int keep_first,
                    struct ast_arena *arena) {
    bag->keep_first = keep_first && capacity > 1;
    bag->dim = dim;
    bag->stride = stride;
    bag->lead = lead;
    bag->n = n;
    bag->capacity = capacity;
    bag->columns = ast_arena_take(arena, (size_t)stride * capacity_columns(bag), sizeof *bag->columns);
    bag->rank = ast_arena_take(arena, (size_t)capacity, sizeof *bag->rank);
    bag->basis_mean = ast_arena_take(arena, (size_t)capacity * (size_t)n, sizeof *bag->basis_mean);
    bag->say = ast_arena_take(arena, (size_t)capacity, sizeof *bag->say);
    bag->changed = ast_arena_take(arena, capacity_columns(bag), sizeof *bag->changed);
    ast_bag_clear(bag);
}

void ast_bag_clear(struct ast_bag *bag) {
    bag->count = 0;
    bag->oldest = bag->keep_first;
    ast_bag_mark(bag);
}

void ast_bag_mark(struct ast_bag *bag) {
    if (bag->changed != NULL) memset(bag->changed, 1, capacity_columns(bag));
}

int ast_bag_columns(const struct ast_bag *bag) {
    return bag->lead + bag->count * (bag->n + 1);
}

float *ast_bag_basis(const struct ast_bag *bag, int slot) {
    return bag->columns + (size_t)(bag->lead + slot * (bag->n + 1)) * (size_t)bag->stride;
}

float *ast_bag_mean(const struct ast_bag *bag, int slot) {
    return ast_bag_basis(bag, slot) + (size_t)bag->n * (size_t)bag->stride;
}

int ast_bag_next(const struct ast_bag *bag) {
    return bag->count < bag->capacity ? bag->count : bag->oldest;
}

void ast_bag_add(struct ast_bag *bag, const float *mean, const float *basis, int rank) {
    const int slot = ast_bag_next(bag);
    const size_t bytes = (size_t)bag->dim * sizeof(float);
    for (int l = 0; l < bag->n; l++)
        memcpy(ast_bag_basis(bag, slot) + (size_t)l * (size_t)bag->stride, basis + (size_t)l * (size_t)bag->stride, bytes);
    memcpy(ast_bag_mean(bag, slot), mean, bytes);
    bag->rank[slot] = rank;
    bag->say[slot] = 0.0f;
    if (bag->count < bag->capacity)
        bag->count++;
    else
        bag->oldest = bag->oldest + 1 < bag->capacity ? bag->oldest + 1 : bag->keep_first;
    ast_bag_derive(bag, slot);
}

void ast_bag_derive(struct ast_bag *bag, int slot) {
    const float *mean = ast_bag_mean(bag, slot), *basis = ast_bag_basis(bag, slot);
    memset(bag->changed + bag->lead + slot * (bag->n + 1), 1, (size_t)bag->n + 1);
    for (int l = 0; l < bag->n; l++)
        bag->basis_mean[slot * bag->n + l] = ast_dot(basis + (size_t)l * (size_t)bag->stride, mean, bag->dim);
}

int ast_bag_slot(const struct ast_bag *bag, int index) {
    const int kept = bag->keep_first;
    if (index < kept) return index;
    return kept + (bag->oldest - kept + index - kept) % (bag->capacity - kept);
}
