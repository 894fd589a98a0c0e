#define AST_NO_HEAP
#define PREFIX no_heap
#include "support_heap_rename.h"
#include "tracker.c"
