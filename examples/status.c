#include "status.h"

#include <asttrack.h>

const char *status_name(int32_t status) {
    return status == AST_TRACKING ? "tracking" : status == AST_UNCERTAIN ? "uncertain" : "lost";
}
