// What placing keeps on the way down to a shape, and what its two files ask of each other: place.c places objects,
// place_composite.c what is cut.
//
// SPDX-License-Identifier: MIT
#ifndef EVAL_BUILD_PLACE_H
#define EVAL_BUILD_PLACE_H

#include "eval/build/blocks.h"

// The clips of the unions around an object, the innermost first.
typedef struct ClipChain ClipChain;
struct ClipChain {
    const ClipChain *next;
    const Clip *clips;
    const Transform *outer; // of all around the object that they clip
    bool clips_all;         // and not a member of a union that is one object
    bool is_bound;          // they only say which rays see it
};

typedef struct Placement {
    Transform outer;
    const TextureDesc *texture;      // of the nearest object around that has one, else #default's
    Transform texture_outer;         // of the texture
    const TextureDesc *inner;        // likewise of what is seen from inside, or NULL: as from outside
    Transform inner_outer;           // of that
    const InteriorDesc *interior;    // of the nearest one that has one, or NULL
    uint32_t body;                     // Scene.bodies that it is in, or RECORD_NONE
    const ClipChain *clips;
    const BoxOwner *whole; // the outermost union around that is one object, or NULL
    uint32_t light_group;  // 1 + one of Scene.light_groups that it is in; 0: it is in none
    bool takes_lights;     // they are that group's
    bool is_double, says_double; // double_illuminate, of the outermost object that says so or not
    bool is_inner, is_hollow; // inside of another object, whose word on this counts
    bool is_stretched;        // extent_is_stretched, of any object around
    bool is_look;             // of a light
    uint8_t hidden;
    bool is_hidden_fixed; // what members say of no_image and the like does not count
} Placement;

// Whether there is room, by count and memory, for one more object. False after a report.
bool place_may_add(Eval *ev, Span span) RT_MUST_CHECK;

// Whether a texture of a shape asks where on it a point is.
bool placement_asks_uv(const Placement *at);

// HiddenFrom bits of what an object says.
uint8_t place_hidden(const ObjectPart *part);

// A group is hollow when it says so or its last member is; `hollow off` does not take back what that one says.
// Measured.
bool place_is_hollow(SchemaKind kind, const void *object);

// The material of an object, which is `primitive`. `inner_body`: Primitive.body of a leaf, else 0. What fills the first
// shape of a body that is filled fills the body.
bool place_material(Eval *ev, const void *object, const Primitive *primitive, const Placement *at, uint32_t inner_body,
                    MaterialIndex *material) RT_MUST_CHECK;

// The materials of a mesh's own textures, which move with it.
bool place_face_materials(Eval *ev, const MeshDesc *mesh, const Placement *at, Primitive *primitive) RT_MUST_CHECK;

// What bounds an object in front of what clips and bounds it already, in `link`, where POV-Ray has a bound say which
// rays see the object: of a group, a polynomial or text, and of any member of a group that is one object. Of other
// shapes it removes the bound.
const ClipChain *place_bounds(Eval *ev, SchemaKind kind, const void *object, const Placement *outer, bool is_member,
                              const ClipChain *clips, ClipChain *link);

// Whether anything in the chain clips, and does not only bound.
bool place_is_clipped(const ClipChain *chain);

// Whether anything is left to clip `shape`; NULL for what has no end or is not a single shape.
bool place_clips_matter(Eval *ev, const ClipChain *chain, const Primitive *shape);

// A light among shapes that are cut. False after a report: it looks like something.
bool place_has_no_look(Eval *ev, const LightDesc *light) RT_MUST_CHECK;

// A group that is cut, or a shape that is clipped, as one composite. `inner` is the object's own placement, within
// `outer`.
bool place_composite(Eval *ev, SchemaKind kind, const void *object, const Placement *outer,
                     const Placement *inner) RT_MUST_CHECK;

#endif
