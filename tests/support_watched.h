/* What watches this build, 1 or 0 each: SANITIZED, a sanitizer with an allocator of its own; WATCHED, that or valgrind, under which
 * everything takes several times as long, or twenty: tests that only repeat themselves are shorter then. */
#ifndef SUPPORT_WATCHED_H
#define SUPPORT_WATCHED_H

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define SANITIZED 1
#endif
#endif
#ifndef SANITIZED
#define SANITIZED 0
#endif

/* `make memcheck` says so. */
#ifdef AST_TEST_VALGRIND
#define WATCHED 1
#else
#define WATCHED SANITIZED
#endif

#endif
