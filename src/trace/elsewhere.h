// Spheres that are not all in this process: what rays ask of them, and what other processes answer.
//
// A shared geometry has, in the place of its table of spheres, an empty one with kernels that ask: a ray's question is
// looked up among those that the thread has asked before. What is not known yet counts as nothing met, or as shadow,
// and waits to be asked for; who traces gets the answers and traces again, until nothing is left to be asked. Then each
// ray has met what it meets in a whole scene, of the roots and by the order of declaration that one process goes by.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_ELSEWHERE_H
#define TRACE_ELSEWHERE_H

#include "trace/spheres.h"
#include "trace/trace.h"

// Without padding: questions are hashed and compared bit by bit, and sent as they are.
typedef struct SphereQuestion {
    Vec3 origin, direction;
    SphereData start;   // passed over; 0 and NaN: none
    double limit;       // t is less
    uint64_t is_shadow; // any sphere will do
} SphereQuestion;

enum { ANSWER_NOTHING = UINT32_MAX };

// The nearest sphere of some.
typedef struct SphereAnswer {
    double t;
    SphereData ball;
    Material material;
    uint32_t order;  // of declaration; ANSWER_NOTHING: none is met
    uint32_t inside; // the ball was met from its inside
} SphereAnswer;

typedef struct Elsewhere Elsewhere;
void elsewhere_free(Elsewhere *elsewhere);

// The materials that the shapes of such a geometry have; NULL: they have those of the scene.
const Material *geometry_materials(const Geometry *geometry);

// Turns a geometry into one that shares its spheres: its own become those that it answers of. At most so many threads
// ask. False when out of memory; the geometry is to be released anyway.
bool geometry_share(Geometry *geometry, const Scene *scene, int threads) RT_MUST_CHECK;

// What that takes beside the own spheres, at most.
size_t geometry_share_bytes(int threads);

// Of this process's own spheres; by a thread that may ask. False: it is one too many.
bool geometry_answer(const Geometry *geometry, const SphereQuestion *questions, size_t count,
                     SphereAnswer *answers) RT_MUST_CHECK;
// Blocks behind those of the own spheres that this takes.
size_t geometry_share_blocks(int threads);

// What the calling thread has asked for and must know; 0: all is known. They stay until geometry_learn.
size_t geometry_questions(const Geometry *geometry, const SphereQuestion **questions);
// The answers of all other processes to these, one list each, on end.
void geometry_learn(const Geometry *geometry, const SphereAnswer *answers, size_t lists);
// The thread's next rays have nothing to do with those before. False: a question of these could not be kept.
bool geometry_forget(const Geometry *geometry);

#endif
