// Room: how many shapes a scene may have, and how many bytes its records may take, for whoever adds to it.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_ROOM_H
#define SCENE_ROOM_H

#include "base/limits.h"
#include "scene/scene.h"

// A fault: the scene has as many shapes as it may have.
void scene_report_full(const Limits *limits, DiagSink *diags, Span span);

// Whether so many more shapes are within the limit; reports at the span when not.
static inline bool scene_has_room(const Scene *scene, uint64_t more, const Limits *limits, DiagSink *diags, Span span)
{
    uint64_t shapes = scene_shapes_in_all(scene);
    if (shapes <= limits->objects && more <= limits->objects - shapes) {
        return true;
    }
    scene_report_full(limits, diags, span);
    return false;
}

// Whether so many more bytes are; `beside` are taken for other purposes already. Reports nothing.
static inline bool scene_memory_has(const Scene *scene, size_t beside, size_t more, size_t limit)
{
    size_t taken = beside + scene_bytes(scene);
    return taken <= limit && more <= limit - taken;
}

#endif
