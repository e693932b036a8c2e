// The inner interface of the files that write scene records as text.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_DUMP_H
#define SCENE_DUMP_H

#include "base/text.h"
#include "scene/scene.h"

// Each writes `before`, then a value in a form that reads back as the same bits.
void dump_number(TextBuffer *out, const char *before, double number);
void dump_vector(TextBuffer *out, const char *before, Vec3 vector);
void dump_rgb(TextBuffer *out, const char *before, Rgb colour);
void dump_rgbft(TextBuffer *out, const char *before, Rgbft colour);
// `<…>`
void dump_numbers(TextBuffer *out, const double *numbers, size_t count);

// `matrix <…>`, a line.
void dump_matrix(const Transform *transform, TextBuffer *out);

// Pattern, modifiers and place of a patterned pigment, without what lies along it.
void dump_pattern(const Scene *scene, const PatternedPigment *record, TextBuffer *out);
// What a pattern's formula calls, before it; the word with its formula; its warps, and the transforms between them.
void dump_formula_parts(const Scene *scene, const Pattern *pattern, TextBuffer *out);
void dump_formula(const Scene *scene, const Pattern *pattern, TextBuffer *out);
// The texture that a material is of a blob whose components have some; NULL: it is no such.
const Texture *dump_fields_of(const Scene *scene, MaterialIndex material);
// All of a parametric surface but its head.
void dump_parametric(const Scene *scene, const Primitive *primitive, TextBuffer *out);
// All of an isosurface but its head.
void dump_isosurface(const Scene *scene, const Primitive *primitive, TextBuffer *out);
void dump_warps(const Scene *scene, const Pattern *pattern, TextBuffer *out);

// Declarations of all interiors (I1, …), patterned pigments (P1, …) and textures (T1, …) of a scene, after those of its
// finishes.
void dump_textures(const Scene *scene, TextBuffer *out);
void dump_sky(const Scene *scene, TextBuffer *out);
// The name of the texture of a material.
void dump_texture_name(MaterialIndex material, const Scene *scene, TextBuffer *out);
// What fills a shape of a material: Scene.interiors, or RECORD_NONE.
uint32_t dump_interior_of(const Scene *scene, MaterialIndex material);
// Named where there is one, else as one that is empty.
void dump_interior_word(uint32_t interior, TextBuffer *out);
// The texture of a shape, which is its last property, its interior unless that is *around, and its end. A shape that is
// a body of its own in another one has none around.
void dump_texture(const Scene *scene, MaterialIndex material, const uint32_t *around, TextBuffer *out);

// Declarations of the meshes (Mesh1, …) whose faces have no textures of their own, before all shapes; and a part that
// is a mesh, up to its matrix.
void dump_meshes(const Scene *scene, TextBuffer *out);
void dump_mesh_part(const Scene *scene, const Primitive *primitive, TextBuffer *out);

// Shapes that are not plain ones. A composite that is_inside of a body leaves its interior to that, unless it is one of
// its own.
void dump_primitive(const Scene *scene, const Primitive *primitive, const uint32_t *around, TextBuffer *out);
void dump_composite(const Scene *scene, const Composite *composite, const uint32_t *around, bool is_inside,
                    TextBuffer *out);
// The object of one of Scene.insides.
void dump_inside(const Scene *inside, TextBuffer *out);

#endif
