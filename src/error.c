/* Texts of the return codes, and what this library says of itself. */
#include "asttrack.h"
#include "backend.h"

#define TEXT(x) #x
#define VERSION_TEXT(major, minor, patch) TEXT(major) "." TEXT(minor) "." TEXT(patch)

const char *ast_strerror(int code) {
    switch (code) {
    case AST_OK: return "no error";
    case AST_E_NULL: return "a required pointer is NULL";
    case AST_E_CONFIG: return "a configuration field is out of range";
    case AST_E_STRUCT_SIZE: return "the configuration's struct_size does not fit this library";
    case AST_E_ARENA: return "the memory block is smaller than ast_mem_size";
    case AST_E_OUT_OF_MEMORY: return "out of memory";
    case AST_E_NO_HEAP: return "this build has no heap: give ast_init a memory block";
    case AST_E_THREAD: return "the threads of the configuration cannot be started";
    case AST_E_FRAME: return "the frame has no pixels, an illegal size, or a stride below its width";
    case AST_E_BOX: return "the box is not finite, has a side below one pixel, or lies outside the frame";
    case AST_E_NOT_STARTED: return "the tracker has not been started";
    case AST_E_RANGE: return "an index or a count is out of range";
    case AST_E_BACKEND: return "the linear-algebra backend failed";
    case AST_E_BUFFER: return "the buffer is too small";
    case AST_E_CORRUPT: return "the saved state is truncated or altered";
    case AST_E_MISMATCH: return "the saved state belongs to another configuration or format version";
    default: return "unknown error code";
    }
}

const char *ast_version(void) {
    return VERSION_TEXT(AST_VERSION_MAJOR, AST_VERSION_MINOR, AST_VERSION_PATCH);
}

const char *ast_backend(void) {
    return ast_default_linalg()->name;
}
