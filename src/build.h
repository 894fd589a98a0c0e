/* What a build may choose by a flag, and what holds without one. Arduino's builder gives a library no flags, and compiles every
 * file of src/: the choices for its small processors are made here. The public header, which sketches include alone, knows the same
 * of the first two in AST_MEM_REAL_ and AST_MEM_LANES_. */
#ifndef AST_BUILD_H
#define AST_BUILD_H

#ifdef ARDUINO
#define AST_DEFAULT_REAL float
#define AST_DEFAULT_LANES 4
#define AST_NO_LAPACKE /* an empty src/linalg_lapacke.c */
#else
#define AST_DEFAULT_REAL double
#define AST_DEFAULT_LANES 16
#endif

/* The number type of src/real.h. */
#ifndef AST_REAL
#define AST_REAL AST_DEFAULT_REAL
#endif

/* Vectors that are worked on side by side; the element l of each is in lane l. A processor without vectors gains nothing from many,
 * and saves memory and stack with few (4, 8 or 16); the number changes no bit of a result. */
#ifndef AST_LANES
#define AST_LANES AST_DEFAULT_LANES
#endif
#if AST_LANES != 4 && AST_LANES != 8 && AST_LANES != 16
#error "AST_LANES: say 4, 8 or 16"
#endif

/* A build without a heap has no threads either: making one takes memory from it. */
#if (defined(AST_NO_HEAP) || defined(ARDUINO)) && !defined(AST_NO_THREADS)
#define AST_NO_THREADS
#endif

#endif
