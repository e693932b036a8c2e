// Flat faces that lie in one plane, overlap and are turned to the camera: of a floor and a tile in it, of two boxes of
// one height. Of each plane the faces are swept along one axis, and those whose rectangles overlap are compared as
// polygons.
//
// Works on shapes that stand alone: what a composite leaves of a face is known to rays only. Equal shapes are those of
// scene/coincident.c. Faces of one material are passed over, since nothing shows which of them is seen.
//
// SPDX-License-Identifier: MIT
#include "scene/faces.h"

#include <math.h>
#include <stdlib.h>

#include "base/cleared.h"
#include "base/pages.h"
#include "scene/primitive_reach.h"
#include "scene/primitive.h"
#include "scene/range.h"

enum {
    COMPARED_MOST = 1 << 24, // rectangles, which take some tenths of a second
};

typedef struct FacePlane {
    Vec3 normal; // of unit length, out of the shape
    double distance;
} FacePlane;

typedef struct Face {
    FacePlane plane;
    double reach; // sum of the magnitudes of the terms of a corner's product with the normal
    uint32_t corner_count; // 0: all of the plane
    Vec3 corners[FACE_CORNERS_MOST];
    bool is_flat; // has no inside: seen from both sides
    MaterialIndex material;
    uint8_t hidden;
    uint32_t order;
    uint64_t source;
    const char *word;
} Face;

// Where a face is found again: planes of the scene first, then parts.
typedef struct FaceRef {
    uint64_t key; // of the plane that it lies in, rounded
    uint32_t item, face;
} FaceRef;

typedef struct Rectangle {
    double low[2], high[2]; // in two of the coordinates
    FaceRef ref;
    const Face *face; // it, made once
} Rectangle;

typedef struct Faces {
    const Scene *scene;
    Pages key_pages;
    uint64_t *keys; // of all faces, in their order
    FaceRef *refs;  // those whose plane another may have
    size_t count;   // of refs
    double unit;    // of distances in keys
    size_t compared;
    uint64_t reported; // the order, + 1, of the shape that was reported last
} Faces;

// ---- faces of shapes

static uint32_t face_count(const Primitive *primitive)
{
    const PrimitiveClass *class = primitive_class(primitive->kind);
    bool has_none = primitive->node != NODE_NONE || (primitive->flags & PRIMITIVE_UNSEEN) || !class->face_count;
    return has_none ? 0 : class->face_count(primitive);
}

static FacePlane plane_of_part(const Primitive *primitive, uint32_t number)
{
    FacePlane plane;
    if (primitive->kind == PRIMITIVE_PLANE) {
        plane = (FacePlane){primitive->data[0], primitive->data[1].x};
    } else {
        const PrimitiveClass *class = primitive_class(primitive->kind);
        Vec3 corner = transform_point(&primitive->to_world, class->corner(primitive, number, 0));
        plane.normal = vec3_normalize(transform_normal(&primitive->to_object, class->face_normal(number)));
        plane.distance = vec3_dot(plane.normal, corner);
    }
    if (primitive->flags & PRIMITIVE_INVERSE) {
        plane.normal = vec3_neg(plane.normal);
        plane.distance = -plane.distance;
    }
    return plane;
}

static const Primitive *ref_part(const Scene *scene, FaceRef ref)
{
    return &scene->primitives.items[ref.item - scene->planes.count];
}

static FacePlane plane_at(const Scene *scene, FaceRef ref)
{
    if (ref.item < scene->planes.count) {
        const Plane *plane = &scene->planes.items[ref.item];
        return (FacePlane){plane->normal, plane->distance};
    }
    return plane_of_part(ref_part(scene, ref), ref.face);
}

static Face face_at(const Scene *scene, FaceRef ref)
{
    Face face = {.plane = plane_at(scene, ref), .word = "plane"};
    if (ref.item < scene->planes.count) {
        const Plane *plane = &scene->planes.items[ref.item];
        face.reach = fabs(plane->distance);
        face.material = plane->material;
        face.order = plane->order;
        face.source = plane->source;
        return face;
    }
    const Primitive *primitive = ref_part(scene, ref);
    const PrimitiveClass *class = primitive_class(primitive->kind);
    bool is_plane = primitive->kind == PRIMITIVE_PLANE;
    face.reach = is_plane ? fabs(face.plane.distance) : primitive_reach(primitive, face.plane.normal);
    face.corner_count = class->corner_count(primitive);
    for (uint32_t i = 0; i < face.corner_count; i++) {
        face.corners[i] = transform_point(&primitive->to_world, class->corner(primitive, ref.face, i));
    }
    face.is_flat = primitive_kind_is_flat(primitive->kind);
    face.hidden = primitive->hidden;
    face.material = primitive->material;
    face.order = primitive->order;
    face.source = primitive->source;
    face.word = class->word;
    return face;
}

// ---- two of them

// Shapes that coincident.c reports.
static bool are_equal(const Scene *scene, FaceRef a, FaceRef b)
{
    size_t planes = scene->planes.count;
    return a.item >= planes && b.item >= planes && scene_primitives_coincide(ref_part(scene, a), ref_part(scene, b));
}

// Whether the camera is on the side that the face is seen from.
static bool is_turned_to(const Face *face, const Camera *camera)
{
    if (face->is_flat) {
        return true;
    }
    return camera->type == CAMERA_ORTHOGRAPHIC ? vec3_dot(face->plane.normal, camera->direction) < 0.0
                                               : vec3_dot(face->plane.normal, camera->location) > face->plane.distance;
}

// Whether all of `a` lies in the plane of `b`, but for rounding.
static bool lies_in(const Face *a, const Face *b)
{
    for (uint32_t i = 0; i < a->corner_count; i++) {
        Vec3 p = a->corners[i], n = b->plane.normal;
        double terms = fabs(p.x * n.x) + fabs(p.y * n.y) + fabs(p.z * n.z);
        if (!(fabs(vec3_dot(p, n) - b->plane.distance) <=
              TRANSFORM_ROUNDING * (terms + a->reach + b->reach))) {
            return false;
        }
    }
    return a->corner_count > 0;
}

typedef struct Interval {
    double low, high, terms;
} Interval;

static Interval along(const Face *face, Vec3 axis)
{
    Interval found = {(double)INFINITY, -(double)INFINITY, 0.0};
    for (uint32_t i = 0; i < face->corner_count; i++) {
        Vec3 p = face->corners[i];
        double at = vec3_dot(p, axis);
        found.low = fmin(found.low, at);
        found.high = fmax(found.high, at);
        found.terms = fmax(found.terms, fabs(p.x * axis.x) + fabs(p.y * axis.y) + fabs(p.z * axis.z));
    }
    return found;
}

// Whether an edge of `a` has all of `b` beyond it, or no more of it on this side than rounding may have put there.
static bool separates(const Face *a, const Face *b)
{
    for (uint32_t i = 0; i < a->corner_count; i++) {
        Vec3 edge = vec3_sub(a->corners[(i + 1) % a->corner_count], a->corners[i]);
        Vec3 axis = vec3_cross(a->plane.normal, edge);
        Interval one = along(a, axis), other = along(b, axis);
        if (fmin(one.high, other.high) - fmax(one.low, other.low) <=
            2.0 * TRANSFORM_ROUNDING * (one.terms + other.terms)) {
            return true;
        }
    }
    return false;
}

static bool overlap(const Face *a, const Face *b)
{
    if (a->corner_count == 0 || b->corner_count == 0) {
        return a->corner_count == 0 ? lies_in(b, a) : lies_in(a, b);
    }
    return lies_in(a, b) && lies_in(b, a) && !separates(a, b) && !separates(b, a);
}

static void compare(Faces *faces, const Rectangle *one, const Rectangle *other, DiagSink *diags)
{
    const Camera *camera = &faces->scene->camera;
    const Face *a = one->face, *b = other->face;
    if (a->order == b->order || !hidden_meet(a->hidden, b->hidden) ||
        scene_materials_are_equal(faces->scene, a->material, b->material) ||
        are_equal(faces->scene, one->ref, other->ref) || !is_turned_to(a, camera) || !is_turned_to(b, camera) ||
        !overlap(a, b)) {
        return;
    }
    const Face *first = a->order < b->order ? a : b, *second = first == a ? b : a;
    if (faces->reported != second->order + UINT64_C(1) &&
        diag_report(diags, DIAG_W0444, scene_source_span(second->source),
                    "a face of this %s coincides with one of a %s that was declared before it", second->word,
                    first->word) &&
        first->source) {
        diag_note(diags, scene_source_span(first->source), "where both are, this one is seen, the other is not");
    }
    faces->reported = second->order + UINT64_C(1);
}

// ---- all of them

static uint64_t mix(uint64_t hash, double number)
{
    hash = (hash ^ (fabs(number) < 0x1p62 ? (uint64_t)(int64_t)number : 0)) * UINT64_C(0xff51afd7ed558ccd);
    return hash ^ hash >> 33;
}

// Of a plane, whichever side of it is out. Numbers that rounding has made different are the same here, but for one in
// some thousands; those that are the same by chance are distinguished by `overlap`.
static uint64_t plane_key(const Faces *faces, const FacePlane *plane)
{
    const Vec3 way = {0.61, 0.53, 0.59}; // at right angles to no plane that anybody would write
    double sign = vec3_dot(plane->normal, way) < 0.0 ? -1.0 : 1.0;
    uint64_t hash = mix(0, nearbyint(sign * plane->normal.x * 0x1p30));
    hash = mix(hash, nearbyint(sign * plane->normal.y * 0x1p30));
    hash = mix(hash, nearbyint(sign * plane->normal.z * 0x1p30));
    return mix(hash, nearbyint(sign * plane->distance / faces->unit));
}

static int by_key(const void *a, const void *b)
{
    const FaceRef *one = a, *other = b;
    return one->key != other->key     ? (one->key > other->key) - (one->key < other->key)
           : one->item != other->item ? (one->item > other->item) - (one->item < other->item)
                                      : (one->face > other->face) - (one->face < other->face);
}

static int by_low(const void *a, const void *b)
{
    const Rectangle *one = a, *other = b;
    return (one->low[0] > other->low[0]) - (one->low[0] < other->low[0]);
}

// The two coordinates in which a plane of that normal is seen widest.
static Rectangle rectangle(const Face *face, Vec3 normal, FaceRef ref)
{
    const double n[3] = {fabs(normal.x), fabs(normal.y), fabs(normal.z)};
    int dropped = n[0] > n[1] ? (n[0] > n[2] ? 0 : 2) : n[1] > n[2] ? 1 : 2;
    Rectangle out = {.ref = ref, .face = face};
    for (int k = 0; k < 2; k++) {
        int axis = k < dropped ? k : k + 1;
        out.low[k] = face->corner_count ? (double)INFINITY : -(double)INFINITY;
        out.high[k] = -out.low[k];
        for (uint32_t i = 0; i < face->corner_count; i++) {
            const double p[3] = {face->corners[i].x, face->corners[i].y, face->corners[i].z};
            out.low[k] = fmin(out.low[k], p[axis]);
            out.high[k] = fmax(out.high[k], p[axis]);
        }
    }
    return out;
}

static bool sweep(Faces *faces, const FaceRef *refs, size_t count, DiagSink *diags)
{
    Rectangle *list = calloc(count, sizeof *list);
    Face *all = list ? calloc(count, sizeof *all) : NULL;
    if (!all) {
        free(list);
        return false;
    }
    Vec3 normal = plane_at(faces->scene, refs[0]).normal;
    for (size_t i = 0; i < count; i++) {
        all[i] = face_at(faces->scene, refs[i]);
        list[i] = rectangle(&all[i], normal, refs[i]);
    }
    qsort(list, count, sizeof *list, by_low);
    for (size_t i = 0; i < count; i++) {
        for (size_t j = i + 1; j < count && list[j].low[0] < list[i].high[0] && faces->compared < COMPARED_MOST; j++) {
            faces->compared++;
            if (list[j].low[1] < list[i].high[1] && list[i].low[1] < list[j].high[1]) {
                compare(faces, &list[i], &list[j], diags);
            }
        }
    }
    free(all);
    free(list);
    return true;
}

static size_t item_count(const Scene *scene)
{
    return scene->planes.count + scene->primitives.count;
}

static uint32_t item_faces(const Scene *scene, size_t item)
{
    return item < scene->planes.count ? 1 : face_count(&scene->primitives.items[item - scene->planes.count]);
}

// About what the terms of distances come to.
static double item_reach(const Scene *scene, size_t item)
{
    const double side = 0x1.279a74590331cp-1; // of 1/sqrt(3) each: a unit normal along no axis
    if (item < scene->planes.count) {
        return fabs(scene->planes.items[item].distance);
    }
    const Primitive *primitive = &scene->primitives.items[item - scene->planes.count];
    return primitive->kind == PRIMITIVE_PLANE ? fabs(primitive->data[1].x)
                                              : primitive_reach(primitive, vec3(side, side, side));
}

// Counts the faces; keys need the greatest length first. False when out of memory.
static bool collect(Faces *faces, size_t *count)
{
    const Scene *scene = faces->scene;
    double reach = 0.0;
    *count = 0;
    for (size_t item = 0; item < item_count(scene); item++) {
        uint32_t own = item_faces(scene, item);
        reach = own > 0 ? fmax(reach, item_reach(scene, item)) : reach;
        *count += own;
    }
    faces->unit = reach > 0.0 && isfinite(reach) ? ldexp(1.0, ilogb(reach) - 40) : 1.0;
    if (*count < 2) {
        return true;
    }
    if (!pages_take(&faces->key_pages, *count * sizeof *faces->keys)) {
        return false;
    }
    faces->keys = faces->key_pages.memory;
    size_t at = 0;
    for (size_t item = 0; item < item_count(scene); item++) {
        for (uint32_t i = 0, own = item_faces(scene, item); i < own; i++) {
            FacePlane plane = plane_at(scene, (FaceRef){0, (uint32_t)item, i});
            faces->keys[at++] = plane_key(faces, &plane);
        }
    }
    return true;
}

typedef struct KeyBits {
    uint64_t *once, *again;
    size_t mask;
} KeyBits;

static bool is_again(const KeyBits *bits, uint64_t key)
{
    size_t at = key & bits->mask;
    return bits->again[at / 64] >> at % 64 & 1;
}

static size_t count_again(const Faces *faces, const KeyBits *bits, size_t count)
{
    size_t found = 0;
    for (size_t i = 0; i < count; i++) {
        found += is_again(bits, faces->keys[i]);
    }
    return found;
}

// Leaves out the faces whose plane no other has: a bit for each hash of a key that was seen once, and one for those
// that were seen again. False when out of memory.
static bool keep_shared(Faces *faces, size_t count)
{
    const Scene *scene = faces->scene;
    size_t size = 64;
    while (size < 8 * count) {
        size *= 2;
    }
    KeyBits bits = {.once = cleared_new(size / 32, sizeof(uint64_t)), .mask = size - 1};
    if (!bits.once) {
        return false;
    }
    bits.again = bits.once + size / 64;
    for (size_t i = 0; i < count; i++) {
        size_t at = faces->keys[i] & bits.mask;
        uint64_t bit = UINT64_C(1) << at % 64;
        bits.again[at / 64] |= bits.once[at / 64] & bit;
        bits.once[at / 64] |= bit;
    }
    size_t most = count_again(faces, &bits, count), face = 0;
    faces->refs = malloc((most + 1) * sizeof *faces->refs);
    for (size_t item = 0; faces->refs && most > 0 && item < item_count(scene); item++) {
        for (uint32_t i = 0, own = item_faces(scene, item); i < own; i++, face++) {
            if (is_again(&bits, faces->keys[face])) {
                faces->refs[faces->count++] = (FaceRef){faces->keys[face], (uint32_t)item, i};
            }
        }
    }
    free(bits.once);
    return faces->refs != NULL;
}

bool scene_warn_of_faces(const Scene *scene, DiagSink *diags)
{
    Faces faces = {.scene = scene};
    if (item_count(scene) >= UINT32_MAX || !diag_is_on(diags, DIAG_W0444)) {
        return true;
    }
    size_t count;
    bool fine = collect(&faces, &count) && (count < 2 || keep_shared(&faces, count));
    pages_give(&faces.key_pages);
    if (faces.count > 1) {
        qsort(faces.refs, faces.count, sizeof *faces.refs, by_key);
    }
    for (size_t begin = 0, end; fine && begin < faces.count; begin = end) {
        for (end = begin + 1; end < faces.count && faces.refs[end].key == faces.refs[begin].key; end++) {
        }
        fine = end - begin < 2 || sweep(&faces, faces.refs + begin, end - begin, diags);
    }
    free(faces.refs);
    return fine;
}
