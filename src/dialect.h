/* What these sources need to be C++ as well: some projects compile all that they hold as C++. */
#ifndef AST_DIALECT_H
#define AST_DIALECT_H

#ifdef __cplusplus
#define restrict __restrict
/* A pointer to no type becomes one to any type by itself, as it does in C. */
struct ast_memory {
    void *address;
    ast_memory(void *place) : address(place) {
    }
    template <typename Type> operator Type *() const {
        return static_cast<Type *>(address);
    }
};
#else
typedef void *ast_memory;
#endif

#endif
