// Flat faces that lie in one plane, overlap and are turned to the camera: of a floor and a tile in it, of two boxes of
// one height. Of each plane the faces are swept along one axis, and those whose rectangles overlap are compared as
// polygons.
//
// Works on shapes that stand alone: what a composite leaves of a face is known to rays only. Equal shapes are those of
// scene/twins.c. Faces of one material are passed over, since nothing shows which of them is seen.
//
// SPDX-License-Identifier: MIT
#include "scene/faces.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "scene/part.h"

enum {
    CORNERS_MOST = 16,       // of the polygon in a disc
    COMPARED_MOST = 1 << 24, // rectangles, which take some tenths of a second
};

// What rounding does to a point of a face beside the sum of the magnitudes of its terms: the bound of docs/numerics.md,
// "Composites".
#define FACE_ERROR (48.0 * (DBL_EPSILON / 2))

typedef struct Face {
    Vec3 normal; // of unit length, out of the shape
    double distance;
    double reach;          // sum of the magnitudes of the terms of a corner's product with the normal
    uint32_t corner_count; // 0: the whole plane
    Vec3 corners[CORNERS_MOST];
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
} Rectangle;

typedef struct Faces {
    const Scene *scene;
    FaceRef *refs;
    size_t count;
    double unit; // of distances in keys
    size_t compared;
    uint64_t told; // the order, + 1, of the shape that was told of last
} Faces;

// ---- faces of shapes

static uint32_t face_count(const Part *part)
{
    if (part->node != NODE_NONE || (part->flags & PART_UNSEEN)) {
        return 0;
    }
    switch (part->kind) {
    case PART_BALL:
        return 0;
    case PART_BOX:
        return 6;
    case PART_CONE:
        return part->flags & PART_OPEN ? 0 : part->data[0].x > 0.0 ? 2 : 1;
    case PART_DISC:
        return part->data[0].x > 0.0 ? CORNERS_MOST : 1;
    default:
        return 1;
    }
}

static void face_add(Face *face, const Transform *m, Vec3 corner)
{
    face->corners[face->corner_count++] = transform_point(m, corner);
}

// A polygon in the circle of that radius.
static void face_round(Face *face, const Transform *m, double z, double radius)
{
    for (int i = 0; i < CORNERS_MOST; i++) {
        double angle = 2.0 * M_PI * i / CORNERS_MOST;
        face_add(face, m, vec3(radius * cos(angle), radius * sin(angle), z));
    }
}

// One of the pieces of a ring, its inner edge just outside of the hole.
static void face_ring(Face *face, const Transform *m, double hole, uint32_t number)
{
    double begin = 2.0 * M_PI * number / CORNERS_MOST, end = 2.0 * M_PI * (number + 1) / CORNERS_MOST;
    double inner = fmin(1.0, hole / cos(M_PI / CORNERS_MOST));
    face_add(face, m, vec3(cos(begin), sin(begin), 0.0));
    face_add(face, m, vec3(cos(end), sin(end), 0.0));
    face_add(face, m, vec3(inner * cos(end), inner * sin(end), 0.0));
    face_add(face, m, vec3(inner * cos(begin), inner * sin(begin), 0.0));
}

static Vec3 face_box(Face *face, const Part *part, uint32_t number)
{
    const double low[3] = {part->data[0].x, part->data[0].y, part->data[0].z};
    const double high[3] = {part->data[1].x, part->data[1].y, part->data[1].z};
    uint32_t axis = number / 2;
    double normal[3] = {0.0, 0.0, 0.0};
    normal[axis] = number % 2 ? 1.0 : -1.0;
    for (int i = 0; i < 4; i++) {
        double p[3];
        p[axis] = number % 2 ? high[axis] : low[axis];
        p[(axis + 1) % 3] = i == 1 || i == 2 ? high[(axis + 1) % 3] : low[(axis + 1) % 3];
        p[(axis + 2) % 3] = i >= 2 ? high[(axis + 2) % 3] : low[(axis + 2) % 3];
        face_add(face, &part->to_world, vec3(p[0], p[1], p[2]));
    }
    return vec3(normal[0], normal[1], normal[2]);
}

static void face_of_part(Face *face, const Part *part, uint32_t number)
{
    Vec3 normal = vec3(0.0, 0.0, 1.0);
    face->is_flat = part->kind >= PART_DISC;
    switch (part->kind) {
    case PART_BOX:
        normal = face_box(face, part, number);
        break;
    case PART_CONE:
        face_round(face, &part->to_world, number, number ? part->data[0].x : 1.0);
        normal.z = number ? 1.0 : -1.0;
        break;
    case PART_DISC:
        if (part->data[0].x > 0.0) {
            face_ring(face, &part->to_world, part->data[0].x, number);
        } else {
            face_round(face, &part->to_world, 0.0, 1.0);
        }
        break;
    default:
        face_add(face, &part->to_world, vec3(0.0, 0.0, 0.0));
        face_add(face, &part->to_world, vec3(1.0, 0.0, 0.0));
        face_add(face, &part->to_world, vec3(0.0, 1.0, 0.0));
    }
    face->normal = vec3_normalize(transform_normal(&part->to_object, normal));
    face->distance = vec3_dot(face->normal, face->corners[0]);
    face->reach = part_reach(part, face->normal);
}

static Face face_at(const Scene *scene, FaceRef ref)
{
    Face face = {.word = "plane"};
    if (ref.item < scene->planes.count) {
        const Plane *plane = &scene->planes.items[ref.item];
        face.normal = plane->normal;
        face.distance = plane->distance;
        face.reach = fabs(plane->distance);
        face.material = plane->material;
        face.order = plane->order;
        face.source = plane->source;
        return face;
    }
    const Part *part = &scene->parts.items[ref.item - scene->planes.count];
    if (part->kind == PART_PLANE) {
        face.normal = part->data[0];
        face.distance = part->data[1].x;
        face.reach = fabs(face.distance);
    } else {
        face_of_part(&face, part, ref.face);
    }
    if (part->flags & PART_INVERSE) {
        face.normal = vec3_neg(face.normal);
        face.distance = -face.distance;
    }
    face.hidden = part->hidden;
    face.material = part->material;
    face.order = part->order;
    face.source = part->source;
    face.word = part_word(part->kind);
    return face;
}

// ---- two of them

// Shapes that twins.c tells of.
static bool are_equal(const Scene *scene, FaceRef a, FaceRef b)
{
    size_t planes = scene->planes.count;
    if (a.item < planes || b.item < planes) {
        return false;
    }
    const Part *one = &scene->parts.items[a.item - planes], *other = &scene->parts.items[b.item - planes];
    bool equal = vec3_equal(one->data[0], other->data[0]) && vec3_equal(one->data[1], other->data[1]);
    equal = one->kind >= PART_TRIANGLE ? other->kind >= PART_TRIANGLE : one->kind == other->kind && equal;
    for (int i = 0; i < 12 && equal; i++) {
        equal = one->to_world.m[i / 3][i % 3] == other->to_world.m[i / 3][i % 3];
    }
    return equal;
}

// Whether the camera is on the side that the face is seen from.
static bool is_turned_to(const Face *face, const Camera *camera)
{
    if (face->is_flat) {
        return true;
    }
    return camera->type == CAMERA_ORTHOGRAPHIC ? vec3_dot(face->normal, camera->direction) < 0.0
                                               : vec3_dot(face->normal, camera->location) > face->distance;
}

// Whether all of `a` lies in the plane of `b`, but for rounding.
static bool lies_in(const Face *a, const Face *b)
{
    for (uint32_t i = 0; i < a->corner_count; i++) {
        Vec3 p = a->corners[i], n = b->normal;
        double terms = fabs(p.x * n.x) + fabs(p.y * n.y) + fabs(p.z * n.z);
        if (!(fabs(vec3_dot(p, n) - b->distance) <= FACE_ERROR * (terms + a->reach + b->reach))) {
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
        Vec3 axis = vec3_cross(a->normal, edge);
        Interval one = along(a, axis), other = along(b, axis);
        if (fmin(one.high, other.high) - fmax(one.low, other.low) <= 2.0 * FACE_ERROR * (one.terms + other.terms)) {
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

static void compare(Faces *faces, const Face *a, FaceRef other, FaceRef ref, DiagSink *diags)
{
    const uint8_t all = HIDDEN_CAMERA | HIDDEN_SHADOW | HIDDEN_MIRROR;
    const Camera *camera = &faces->scene->camera;
    Face b = face_at(faces->scene, other);
    if (a->order == b.order || a->material == b.material || ((a->hidden | b.hidden) & all) == all ||
        are_equal(faces->scene, ref, other) || !is_turned_to(a, camera) || !is_turned_to(&b, camera) ||
        !overlap(a, &b)) {
        return;
    }
    const Face *first = a->order < b.order ? a : &b, *second = first == a ? &b : a;
    if (faces->told != second->order + UINT64_C(1) &&
        diag_report(diags, DIAG_W0444, scene_source_span(second->source),
                    "a face of this %s coincides with one of a %s that was declared before it", second->word,
                    first->word) &&
        first->source) {
        diag_note(diags, scene_source_span(first->source), "where both are, this one is seen, the other is not");
    }
    faces->told = second->order + UINT64_C(1);
}

// ---- all of them

static uint64_t mix(uint64_t hash, double number)
{
    hash = (hash ^ (fabs(number) < 0x1p62 ? (uint64_t)(int64_t)number : 0)) * UINT64_C(0xff51afd7ed558ccd);
    return hash ^ hash >> 33;
}

// Of a plane, whichever side of it is out. Numbers that rounding has made different are the same here, but for one in
// some thousands; those that are the same by chance are told apart by `overlap`.
static uint64_t plane_key(const Faces *faces, const Face *face)
{
    const Vec3 way = {0.61, 0.53, 0.59}; // at right angles to no plane that anybody would write
    double sign = vec3_dot(face->normal, way) < 0.0 ? -1.0 : 1.0;
    uint64_t hash = mix(0, nearbyint(sign * face->normal.x * 0x1p30));
    hash = mix(hash, nearbyint(sign * face->normal.y * 0x1p30));
    hash = mix(hash, nearbyint(sign * face->normal.z * 0x1p30));
    return mix(hash, nearbyint(sign * face->distance / faces->unit));
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
    Rectangle out = {.ref = ref};
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
    if (!list) {
        return false;
    }
    Vec3 normal = face_at(faces->scene, refs[0]).normal;
    for (size_t i = 0; i < count; i++) {
        Face face = face_at(faces->scene, refs[i]);
        list[i] = rectangle(&face, normal, refs[i]);
    }
    qsort(list, count, sizeof *list, by_low);
    for (size_t i = 0; i < count; i++) {
        Face face = face_at(faces->scene, list[i].ref);
        for (size_t j = i + 1; j < count && list[j].low[0] < list[i].high[0] && faces->compared < COMPARED_MOST; j++) {
            faces->compared++;
            if (list[j].low[1] < list[i].high[1] && list[i].low[1] < list[j].high[1]) {
                compare(faces, &face, list[j].ref, list[i].ref, diags);
            }
        }
    }
    free(list);
    return true;
}

// Keys need the greatest length first.
static bool collect(Faces *faces)
{
    const Scene *scene = faces->scene;
    size_t most = scene->planes.count;
    for (size_t i = 0; i < scene->parts.count; i++) {
        most += face_count(&scene->parts.items[i]);
    }
    faces->refs = most >= 2 ? calloc(most, sizeof *faces->refs) : NULL;
    if (!faces->refs) {
        return most < 2;
    }
    double reach = 0.0;
    for (size_t item = 0; item < scene->planes.count + scene->parts.count; item++) {
        uint32_t count = item < scene->planes.count ? 1 : face_count(&scene->parts.items[item - scene->planes.count]);
        for (uint32_t i = 0; i < count; i++) {
            FaceRef ref = {0, (uint32_t)item, i};
            reach = fmax(reach, face_at(scene, ref).reach);
            faces->refs[faces->count++] = ref;
        }
    }
    faces->unit = reach > 0.0 && isfinite(reach) ? ldexp(1.0, ilogb(reach) - 40) : 1.0;
    for (size_t i = 0; i < faces->count; i++) {
        Face face = face_at(scene, faces->refs[i]);
        faces->refs[i].key = plane_key(faces, &face);
    }
    return true;
}

bool scene_warn_of_faces(const Scene *scene, DiagSink *diags)
{
    Faces faces = {.scene = scene};
    if (scene->planes.count + scene->parts.count >= UINT32_MAX || !diag_is_on(diags, DIAG_W0444)) {
        return true;
    }
    bool fine = collect(&faces);
    if (fine && faces.count > 1) {
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
