// The inner interface of the files that evaluate blocks: block.c drives, the files of the kinds do what the schema's
// tables cannot say.
//
// SPDX-License-Identifier: MIT
#ifndef EVAL_BLOCKS_H
#define EVAL_BLOCKS_H

#include "eval/run/run.h"
#include "scene/description.h"
#include "scene/form.h"

struct ObjectState {
    uint8_t kinds[WORD_COUNT];                  // SchemaKind that a word begins
    uint8_t properties[KIND_COUNT][WORD_COUNT]; // place in the kind's properties + 1
    uint8_t advice[WORD_COUNT];                 // place among the unsupported words + 1
    bool is_told[WORD_COUNT];                   // that rtlang has not this word
    const TextureDesc *defaults;                // of #default
    const SkySphereDesc *sky;                   // the last one so far, in the program's memory; NULL: none
    Span sky_span;
    struct KeptRainbow *rainbows, *last_rainbow; // in order, likewise
    const NormalDesc *camera_normal;             // of the last camera so far, likewise
    uint32_t groups;                             // unions so far that say what their members are filled with
    bool may_lack_weights;                       // the map that is read belongs to `average`
    bool uses_uv;                                // something so far lies on surfaces
    // A right-hand side is being evaluated: what rtlang has not is kept in `deferred` and reported when it is used.
    bool is_deferring;
    const UnsupportedDesc *deferred; // the first; NULL: none
};

// One block while it is read.
typedef struct Block {
    Eval *ev;
    const AstNode *node;
    Arena *arena; // where the objects inside it are kept
    Cursor cursor;
    Desc *record;
    SchemaKind kind;        // of its word
    SchemaKind is;          // of the record: another object kind after an identifier
    const Transform *moved; // see block_read_moved
    size_t arguments;       // that were given
    size_t items;           // properties so far
    bool has_name;          // it began with an identifier
    bool on_surface; // `uv_mapping` was said: at the start of a texture or part of one, before an object's texture
    bool is_plain, is_patterned; // a texture that begins with a part or a transform, or with a word of a pattern
    bool has_unsupported;
    bool is_lost; // with what it lacks it is nothing
    bool has_fault;
} Block;

// object.c

// The interface of this room to the text.
extern const EvalBuilder builder_of_scene;
// surface.c

// `uv_mapping` at the start of a texture, pigment or normal.
void surface_read_first(Block *block);
bool surface_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
// At the closing brace of what has this pattern: with `uv_mapping` it stays as it is now.
bool surface_close(Block *block, PatternPart *part) RT_MUST_CHECK;
bool surface_hold(Eval *ev, Arena *arena, PatternPart *part, Span span) RT_MUST_CHECK;
// Whether what came since then turns the bumps of what is on the surface, and how.
bool surface_moves(const PatternPart *part, const Transform *outer, Transform *later);
// Whether something of a texture is on the surface.
bool texture_asks_uv(const TextureDesc *texture);
// Puts all that a texture has onto the surface, with the layers below it if that is said.
bool texture_put_on_surface(Eval *ev, Arena *arena, TextureDesc *texture, bool with_below, Span span) RT_MUST_CHECK;

// Whether a word of the language begins a block, supported or not.
bool object_takes_braces(const Eval *ev, Symbol word);
// Evaluates `word { items }` to a record in the program arena (block.c and the files of the kinds).
bool eval_block(Eval *ev, const AstNode *block, Value *value) RT_MUST_CHECK;
// Layers: texture{} texture{}.
bool eval_texture_layers(Eval *ev, const AstNode *first, Value *value) RT_MUST_CHECK;
// One more, over `layers`; VALUE_NONE: there are none yet.
bool eval_texture_layer(Eval *ev, const AstNode *node, Value *layers) RT_MUST_CHECK;
// A block, or an identifier of an object, as a statement: adds it to the scene.
bool eval_place(Eval *ev, const AstNode *item) RT_MUST_CHECK;
// #default { items }
bool eval_default(Eval *ev, const AstNode *directive) RT_MUST_CHECK;

bool objects_init(Eval *ev) RT_MUST_CHECK;
// When the whole scene is read: places what only the last one of counts.
bool objects_finish(Eval *ev) RT_MUST_CHECK;
void objects_fini(Eval *ev);

// The transform around the whole scene, what undoes it, and the factor of lengths that no transform changes.
Transform world_transform(const Eval *ev);
Transform world_inverse(const Eval *ev);
double world_scale(const Eval *ev);
// Tells the scene of it.
void world_note(Eval *ev);

// block.c

// Fills *record with what a block of the kind is before anything is said in it.
void block_defaults(const Eval *ev, SchemaKind kind, Desc *record);

// Reads a block into *record, which holds the defaults, and its kind into *is. False when a fault was reported.
bool block_read(Eval *ev, const AstNode *node, SchemaKind kind, Arena *arena, Desc *record,
                SchemaKind *is) RT_MUST_CHECK;
// Where descriptions go that a block holds, and where the object is at first; NULL: it is not moved.
typedef struct BlockRoom {
    Arena *arena;
    const Transform *moved;
} BlockRoom;
// The same, with an object moved before what is said of it after its shape or name.
bool block_read_moved(Eval *ev, const AstNode *node, SchemaKind kind, BlockRoom room, Desc *record,
                      SchemaKind *is) RT_MUST_CHECK;
// The block, read into *record as by block_read, becomes a value that is kept for the whole program; what rtlang has
// not becomes one that is a fault where it is used.
bool block_read_declared(Eval *ev, const AstNode *node, SchemaKind kind, Desc *record, Value *value) RT_MUST_CHECK;
// Transforms what has been read of a block so far.
bool block_transform(Block *block, const Transform *transform) RT_MUST_CHECK;
// The kind that a word begins, KIND_NONE when it begins none.
SchemaKind block_kind(const Eval *ev, const AstNode *node);

// A transform's property, NULL for any other item.
const SchemaProperty *block_transform_word(const Block *block, const AstNode *item);

// True for a NAME or an element of an array, which may stand for a block.
bool block_is_name(const AstNode *item);

// misfit.c

// The kind as it is written: "sphere".
const char *block_word(const Block *block);
// An undeclared name that is nearer to one of the block's properties than to any name in scope.
bool block_is_misspelt(const Block *block, const AstNode *item);
// The undeclared name that an expression begins with, or the item itself: a misspelt property and the sign of its value
// look like an expression, `locaton -4*z`.
const AstNode *block_leading_name(const Block *block, const AstNode *item);
// A block whose word is unknown and near to that of an object.
bool block_is_misspelt_object(const Eval *ev, const AstNode *item);
// Reports a word that is no property of the block, with the nearest that is.
void block_unknown_property(Block *block, const AstNode *item);
// A colour that stands directly in a shape, and passing over it; false: a fault was reported.
bool block_is_idle_colour(Block *block, const AstNode *item) RT_MUST_CHECK;
bool block_pass_colour(Block *block) RT_MUST_CHECK;
void block_refuse_colour(Block *block, const AstNode *item);
bool block_is_capital(const Block *block, const AstNode *name); // no property begins so
bool block_is_lacking(const Block *block, Symbol symbol); // POV-Ray has the word here, and rtlang in other blocks only

// Marks the block as faulty and reports, unless it follows from a syntax fault inside the block; returns false.
bool block_fault(Block *block, DiagCode code, Span span, const char *format, ...) RT_PRINTF(4, 5);

// Tells, now or when it is used, that rtlang has not a word; `owner` as in UnsupportedDesc.
void block_unsupported(Eval *ev, const char *word, Span span, SchemaKind owner);
// A block of a kind that rtlang has not, or that nobody has.
void block_unknown(Eval *ev, const AstNode *item);
// The same as block_unsupported for an identifier that was declared with such a word.
void block_unsupported_name(Eval *ev, const UnsupportedDesc *what, Span use);
// The same for all that a declared block was read without.
void block_tell_lacks(Eval *ev, const Value *value, Span use);
// What `other` was read without, `value` was, too.
bool block_join_lacks(Eval *ev, Value *value, const Value *other, Span span) RT_MUST_CHECK;

// block_value.c
// Reads what follows a property's word, of a simple type, into its place in the record. False after a fault.
bool block_value(Block *block, const SchemaProperty *property, Span word) RT_MUST_CHECK;
// The same of one value, at `at`, and without looking at what stands there.
bool block_read_typed(Block *block, const SchemaProperty *property, void *at) RT_MUST_CHECK;
// True when the number is finite, else a fault.
bool block_finite(Block *block, double number, Span span, const char *word) RT_MUST_CHECK;
// Reads a vector of 2, or a number that stands for two of it; `what` says in a message what they are, as "a corner".
bool block_pair(Block *block, const char *what, double pair[2]) RT_MUST_CHECK;
// Whether a value comes next that is no word.
bool block_at_expression(Block *block);
// Where the next item is, or the block's end.
Span block_here(Block *block);

// transforms.c: the actions of the schema's transforms
bool transform_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool transform_close(Block *block) RT_MUST_CHECK;
// That of a word and the numbers after it: 1 or 3, of a matrix 12. False: it is none, or more is to be said of it.
bool transform_of_numbers(Symbol word, const double *numbers, unsigned count, Transform *transform) RT_MUST_CHECK;

// Reads all that stands in a block whose cursor is open, and closes it; as block_read.
bool block_read_items(Block *block, SchemaKind *is) RT_MUST_CHECK;

// pattern.c
bool pattern_solid_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool pattern_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool pattern_fractal_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool pattern_inside_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool pattern_wave_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
// Reports a word that has no meaning beside the pattern that there is, or beside none.
bool pattern_allows(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
// What lies along a pattern of which nothing is said.
const PatternMap *pattern_default_map(PatternType type);
bool pattern_close(Block *block) RT_MUST_CHECK; // of a pigment or texture
bool normal_close(Block *block) RT_MUST_CHECK;

// Whether something was said of bumps, but no pattern.
static inline bool normal_lacks_pattern(const NormalDesc *normal)
{
    return normal->part.pattern.type == PATTERN_NONE && normal->span.end > normal->span.begin;
}
// A pigment's colour begins with a colour word or with an identifier of a colour: POV-Ray takes nothing else.
bool block_begins_like_colour(Block *block, const AstNode *item);
// Whether an expression begins with the text of a macro, which its value tells what it is.
bool block_begins_with_macro(const Block *block, const AstNode *item);

// Whether a pattern may stand here: it must be the first word.
bool pattern_may_begin(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
// Whether a pattern or a map may follow what there is: a texture that begins with an identifier takes no other.
bool pattern_may_follow(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
// A pattern begins, with its words as they are before they are said; false: it cannot stand in this block.
bool pattern_begin(Block *block, PatternType type, const AstNode *item) RT_MUST_CHECK;
// The depth that may follow the pattern of a normal, unless normals do.
bool pattern_read_amount(Block *block) RT_MUST_CHECK;
// A function and what it gives at a point.
bool pattern_function_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
// A picture whose values are a pattern, heights or numbers of textures.
bool pattern_picture_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;

// pattern_slope.c
bool slope_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool slope_item_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool slope_close(Block *block) RT_MUST_CHECK;

// pattern_map.c
bool pattern_map_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool pattern_map_body(Block *block) RT_MUST_CHECK;
// The next texture of a material_map.
bool material_texture_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
// The blocks or colours that follow a pattern such as `checker`, those that are not said by default: its map.
bool pattern_read_blocks(Block *block, PatternType type, Span span) RT_MUST_CHECK;

// warp.c
bool warp_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
// Whether a word may stand where it stands in `warp { }`.
bool warp_allows(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool warp_type_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool warp_close(Block *block) RT_MUST_CHECK;
// Records of a pattern's warps, of which `last` was said last: Pattern.warps.
bool warps_place(Eval *ev, Scene *scene, const WarpDesc *last, Span span, uint32_t *first) RT_MUST_CHECK;

// formula.c
// Steps of a function of three numbers; what it is made of must be such as the renderer has.
bool formula_place(Eval *ev, Scene *scene, const Function *function, Span span, uint32_t *first) RT_MUST_CHECK;
// The same with patterns and pigments that are numbered as they are found; for this they are put behind `painted`, and
// a scene gets records of them that are not used.
typedef ARRAY(Painted *) PaintedList;
typedef struct FormulaBlock { // the block that a function stands in
    SchemaKind kind;
    Span span;
} FormulaBlock;
bool formula_make(Eval *ev, Scene *scene, const Function *function, FormulaBlock in, uint32_t *first,
                  PaintedList *painted) RT_MUST_CHECK;

// material.c
// A scene's record of a pigment that is moved by `outer`.
bool pigment_place(Eval *ev, Scene *scene, const PigmentDesc *pigment, const Transform *outer, Span span,
                   Pigment *out) RT_MUST_CHECK;
// A scene's record of bumps that are no texture's, in a space of their own.
bool normal_place(Eval *ev, Scene *scene, const NormalDesc *normal, Span span, uint32_t *index) RT_MUST_CHECK;
// True when nothing below a texture can be seen: it is of one colour that lets no light through.
bool texture_hides_all(const TextureDesc *texture);
// What a surface is beside its texture.
typedef struct MaterialSides {
    const InteriorDesc *interior; // what is inside; NULL: nothing was said
    const TextureDesc *filling;   // whose old finishes may say something of that
    bool is_hollow, is_double;
    uint32_t light_group; // as of a Compound
    MaterialIndex inner;  // what is seen from inside, or RECORD_NONE
} MaterialSides;
// The scene's record of a texture that is moved by `outer`.
bool material_place(Eval *ev, const TextureDesc *texture, const Transform *outer, const MaterialSides *sides, Span span,
                    MaterialIndex *index) RT_MUST_CHECK;

// texture.c
// Where an object or a material keeps its texture; NULL for other blocks.
const TextureDesc **texture_place(Block *block);
// Lays `top`, which may have layers of its own, over `below`. Both stay as they are; NULL after a fault.
const TextureDesc *texture_laid_over(Eval *ev, Arena *arena, const TextureDesc *top, const TextureDesc *below,
                                     Span span);
bool interior_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool material_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
// A leading name: its texture is laid over what there is, its interior, even none, takes the place of what there is.
bool material_take_name(Block *block, const MaterialDesc *material, Span span) RT_MUST_CHECK;
// Moves a texture with all that lies below it.
void texture_transform(TextureDesc *texture, const Transform *transform);
bool texture_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
// The same of what is seen from inside; NULL where a block has none.
const TextureDesc **inner_texture_place(Block *block);
bool inner_texture_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
// At an object's end: whoever has one has a texture, too.
bool inner_texture_fits(Block *block) RT_MUST_CHECK;
bool finish_irid_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool tiles_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool reflection_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool finish_close(Block *block) RT_MUST_CHECK;
bool reflection_close(Block *block) RT_MUST_CHECK;

// camera.c
bool camera_angle_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool camera_cylinder_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool camera_blur_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool camera_look_at_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
void camera_transform(Block *block, const Transform *transform);
bool camera_close(Block *block) RT_MUST_CHECK;
bool camera_normal_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
// The bumps of the last camera, once the scene has all else.
bool camera_finish(Eval *ev) RT_MUST_CHECK;
bool camera_place(Eval *ev, const CameraDesc *camera, Span span) RT_MUST_CHECK;

// light.c
bool light_type_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool light_shadowless_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool light_cone_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool light_area_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool light_close(Block *block) RT_MUST_CHECK;
bool light_point_at_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool light_look_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
void light_transform(LightDesc *light, const Transform *transform);
// `group`: 1 + one of Scene.light_groups, or 0.
bool light_place(Eval *ev, const LightDesc *light, const Transform *outer, uint32_t group) RT_MUST_CHECK;

// sky.c: sky_sphere and fog
bool sky_layer_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool sky_close(Block *block) RT_MUST_CHECK;
bool sky_place(Eval *ev, const SkySphereDesc *sky, Span span) RT_MUST_CHECK;
bool fog_close(Block *block) RT_MUST_CHECK;
bool fog_place(Eval *ev, const FogDesc *fog, Span span) RT_MUST_CHECK;

// rainbow.c
typedef struct KeptRainbow {
    RainbowDesc desc;
    Span span;
    struct KeptRainbow *next;
} KeptRainbow;
bool rainbow_map_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool rainbow_close(Block *block) RT_MUST_CHECK;
bool rainbow_keep(Eval *ev, const RainbowDesc *rainbow, Span span) RT_MUST_CHECK;
// Once the scene has its sky.
bool rainbows_finish(Eval *ev) RT_MUST_CHECK;

// image.c
// What the braces of image_pattern, bump_map or material_map say; NULL: a fault is reported.
const ImageDesc *image_read_numbers(Block *block, const AstNode *item, PatternType type) RT_MUST_CHECK;
bool image_map_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool image_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool image_body(Block *block) RT_MUST_CHECK; // of image_map
bool image_close(Block *block) RT_MUST_CHECK;
// The format that a word names; PICTURE_FORMATS: none.
PictureFormat image_format(const char *word);
// The expression that names a file stands next, and how its values are encoded may follow. PICTURE_FORMATS: its ending
// names the format. *span: of the name.
bool image_read_source(Block *block, PictureFormat format, PictureSource *source, Span *span) RT_MUST_CHECK;
// A scene's record of a picture that is laid over something.
bool image_place(Eval *ev, Scene *scene, const ImageDesc *image, uint32_t *index) RT_MUST_CHECK;

// settings.c
// A gamma after its word, whose name and place are for messages: a number, or `srgb`, which leaves *gamma as it is.
bool settings_read_gamma(Block *block, const char *name, Span word, GammaModel *model, double *gamma) RT_MUST_CHECK;
bool settings_gamma_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool settings_charset_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool settings_generator_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool settings_place(Eval *ev, SchemaKind kind, const Desc *record) RT_MUST_CHECK;

// extent.c
// min_extent and max_extent
bool builtin_extent(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
// The object that the first argument of a call names; false after a fault.
bool extent_object(Eval *ev, const AstNode *call, Value *object) RT_MUST_CHECK;
// Whether the inside of an object that is no union is more than what is in its box, or not what its surface is around;
// or whether that of a member is.
// The turn that takes z to `axis` by the shortest way, half a turn about x where that is not unique; then to `origin`.
Transform extent_frame(Vec3 axis, double across, double along, Vec3 origin);
bool extent_reaches_out(SchemaKind kind, const void *object, bool is_member);
// An object with a box, and what is done to it from outside.
typedef struct BoxOwner {
    SchemaKind kind;
    const void *object;
    Transform outer;
} BoxOwner;
// Its box; true: it has no end.
bool extent_box(const BoxOwner *owner, Vec3 *low, Vec3 *high);
// Whether a transform of the object itself is one that need not keep spheres. A sphere of a negative radius has its box
// inside out unless such a transform is around it.
bool extent_is_stretched(SchemaKind kind, const void *object);
// Tells of a transform that is about to be applied; `keeps_spheres`: it moves, turns or scales evenly.
bool extent_note(Block *block, const Transform *transform, bool keeps_spheres, Span span) RT_MUST_CHECK;

// mesh_corners.c
// What a face is drawn with that has other textures at its corners, and what it refers to.
typedef struct CornerBlend {
    TextureDesc texture;
    PatternMap map;
    PatternEntry entries[3];
} CornerBlend;
// Whether three textures may be those of a face's corners.
bool mesh_textures_blend(const TextureDesc *const corners[3]);
void mesh_blend(const MeshDesc *mesh, const MeshCorners *corners, CornerBlend *blend);

// mesh.c and mesh2.c
bool mesh_body(Block *block) RT_MUST_CHECK;
bool mesh2_body(Block *block) RT_MUST_CHECK;
bool mesh_close(Block *block) RT_MUST_CHECK;

// bicubic.c
bool bicubic_body(Block *block) RT_MUST_CHECK;

// height_field.c
bool height_field_body(Block *block) RT_MUST_CHECK;
bool height_field_close(Block *block) RT_MUST_CHECK;

// object.c
bool object_members(Block *block) RT_MUST_CHECK; // of a union
bool object_body(Block *block) RT_MUST_CHECK;    // of an object
bool union_close(Block *block) RT_MUST_CHECK;
bool light_group_close(Block *block) RT_MUST_CHECK; // what is read is a union
bool object_is_group(SchemaKind kind);              // a union, merge, intersection or difference
// How deep groups, and lights that look like groups, stand in one another in an object.
uint32_t object_depth(SchemaKind kind, const void *object);
bool object_is_statement(SchemaKind kind); // may stand outside of all braces

// clip.c
bool clip_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool inverse_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool clip_body(Block *block) RT_MUST_CHECK; // of clipped_by and bounded_by
// Moves what clips or bounds an object along with it.
bool clips_transform(Block *block, const Transform *transform) RT_MUST_CHECK;

// shape_class.c: what the language says of each kind of shape.

bool blob_box(const void *object, OwnBox *own);

typedef struct ShapeClass {
    bool is_flat;        // has no inside: clips and cuts nothing
    uint16_t corners_at; // three in the description, which bound it instead of `box`; 0: none
    // Drops signs that do not count. False: there is no such shape, which `fault` says by `code`.
    bool (*settle)(Desc *record);
    DiagCode code;
    const char *fault;
    bool (*close)(Block *block); // at the closing brace; false after a fault; NULL: `settle` is enough
    // Kind, numbers and map, before all transforms. Why there is nothing to draw, or NULL. Of a plane NULL.
    const char *(*form)(const void *object, Primitive *part);
    bool (*has_inside)(const void *object); // NULL: as `is_flat` says
    bool (*holds)(const void *object, Vec3 point,
                  bool is_turned);                // inside of it, or of it turned; NULL: not to be asked
    bool (*box)(const void *object, OwnBox *own); // false: in the space of the shape itself; it may be infinite
} ShapeClass;

// Of a kind that is no shape a row of nothing.
const ShapeClass *shape_class(SchemaKind kind);
// Whether a shape has no inside.
bool shape_is_flat(SchemaKind kind, const void *object);

// blob.c
bool blob_part_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool blob_close(Block *block) RT_MUST_CHECK;
// The texture of a blob whose components have some, as it lies in the blob's space; `own` is that of the others, under
// `outer`.
bool blob_blend(Eval *ev, const BlobDesc *blob, const TextureDesc *own, const Transform *outer,
                TextureDesc *blend) RT_MUST_CHECK;
const char *blob_form(const void *object, Primitive *primitive);
bool blob_holds(const void *object, Vec3 point, bool is_turned);

// shape_formula.c: functions of shapes; `head` is where in the list the steps begin. They are given what they ask, and
// made those of the scene that the primitive is put into.
bool shape_formula_host(Block *block, ShapeFormula *formula, size_t head, const PaintedList *painted) RT_MUST_CHECK;
bool shape_formula_place(Eval *ev, const ShapeFormula *formula, size_t head, Span span,
                         Primitive *primitive) RT_MUST_CHECK;

// Does that for a shape of any kind that has functions.
bool shape_place_functions(Eval *ev, const void *object, Primitive *primitive) RT_MUST_CHECK;

// ovus.c: these as in ShapeClass
const char *ovus_form(const void *object, Primitive *primitive);
bool ovus_has(const void *object, Vec3 point, bool is_turned);
bool ovus_box(const void *object, OwnBox *own);

// parametric.c
bool parametric_body(Block *block) RT_MUST_CHECK;
bool parametric_precompute_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool parametric_close(Block *block) RT_MUST_CHECK; // this and these as in ShapeClass
bool parametric_place(Eval *ev, const void *object, Primitive *primitive) RT_MUST_CHECK;
const char *parametric_form(const void *object, Primitive *primitive);
bool parametric_box(const void *object, OwnBox *own);

// isosurface.c
bool shape_function_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool contained_by_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool container_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool isosurface_evaluate_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool isosurface_close(Block *block) RT_MUST_CHECK;
// The shape that a container is made of, in its own space.
void container_set(const ContainerDesc *container, double low[3], double high[3]);
bool isosurface_place(Eval *ev, const void *object, Primitive *primitive) RT_MUST_CHECK;
const char *isosurface_form(const void *object, Primitive *primitive); // these as in ShapeClass
bool isosurface_has(const void *object, Vec3 point, bool is_turned);
bool isosurface_box(const void *object, OwnBox *own);

// outline.c: prisms and polygons
bool prism_body(Block *block) RT_MUST_CHECK;
bool polygon_body(Block *block) RT_MUST_CHECK;
const char *prism_form(const void *object, Primitive *primitive) RT_MUST_CHECK; // these as in ShapeClass
bool prism_holds(const void *object, Vec3 point, bool is_turned) RT_MUST_CHECK;
bool prism_box(const void *object, OwnBox *own) RT_MUST_CHECK;
const char *polygon_form(const void *object, Primitive *primitive) RT_MUST_CHECK;
bool polygon_box(const void *object, OwnBox *own) RT_MUST_CHECK;

// revolved.c: lathes and surfaces of revolution
bool lathe_body(Block *block) RT_MUST_CHECK;
bool sor_body(Block *block) RT_MUST_CHECK;
const char *lathe_form(const void *object, Primitive *primitive) RT_MUST_CHECK; // these as in ShapeClass
bool lathe_holds(const void *object, Vec3 point, bool is_turned) RT_MUST_CHECK;
bool lathe_box(const void *object, OwnBox *own);
const char *sor_form(const void *object, Primitive *primitive) RT_MUST_CHECK;
bool sor_has(const void *object, Vec3 point, bool is_turned) RT_MUST_CHECK;
bool sor_box(const void *object, OwnBox *own);

// superellipsoid.c
bool superellipsoid_body(Block *block) RT_MUST_CHECK;
const char *superellipsoid_form(const void *object, Primitive *primitive) RT_MUST_CHECK; // these as in ShapeClass
bool superellipsoid_has(const void *object, Vec3 point, bool is_turned) RT_MUST_CHECK;
bool superellipsoid_box(const void *object, OwnBox *own);

// sweep.c: sphere sweeps
bool sweep_body(Block *block) RT_MUST_CHECK;
const char *sweep_form(const void *object, Primitive *primitive) RT_MUST_CHECK; // these as in ShapeClass
bool sweep_has(const void *object, Vec3 point, bool is_turned) RT_MUST_CHECK;
bool sweep_box(const void *object, OwnBox *own);

// julia.c: Julia fractals
bool julia_body(Block *block) RT_MUST_CHECK;
bool polynomial_body(Block *block) RT_MUST_CHECK; // shape_class.c
bool julia_action(Block *block, const SchemaProperty *property, const AstNode *item) RT_MUST_CHECK;
bool julia_close(Block *block) RT_MUST_CHECK; // this and these as in ShapeClass
const char *julia_form(const void *object, Primitive *primitive) RT_MUST_CHECK;
bool julia_has(const void *object, Vec3 point, bool is_turned) RT_MUST_CHECK;
bool julia_box(const void *object, OwnBox *own);

// text.c: letters, as a union of prisms
bool text_body(Block *block) RT_MUST_CHECK;

// bicubic.c
bool bicubic_box(const void *object, OwnBox *own);

// shape.c
// At the closing brace of any shape.
bool shape_close(Block *block) RT_MUST_CHECK;
// A pigment, normal or finish in the place of the texture's own.
void texture_take_part(TextureDesc *texture, SchemaKind kind, const void *part);
typedef enum ShapeResult { SHAPE_FAULT, SHAPE_NOTHING, SHAPE_MADE } ShapeResult;
// A shape's kind, map and data after a transform; everything else in *primitive is as for an unclipped one. Nothing is
// reported: SHAPE_NOTHING: *why_nothing says why it has no extent; SHAPE_FAULT: the transform leaves nothing of it.
// `is_stretched`: it is a sphere that sphere_image_radius has found to be none after its transforms, or one whose turn
// is kept.
ShapeResult shape_form(SchemaKind kind, const void *object, const Transform *transform, bool is_stretched,
                       Primitive *primitive, const char **why_nothing) RT_MUST_CHECK;
// The same with a report of either, a warning or a fault.
ShapeResult shape_make(Eval *ev, SchemaKind kind, const void *object, const Transform *transform, bool is_stretched,
                       Primitive *primitive);
// When all is said of a shape: signs that do not count are dropped. False: there is no such shape.
bool shape_settle(SchemaKind kind, Desc *record) RT_MUST_CHECK;
// That of a bicubic patch, in bicubic.c, whose mesh the scene then has; SHAPE_NOTHING: it has no surface.
ShapeResult bicubic_make(Eval *ev, const PatchDesc *patch, const Transform *transform,
                         Primitive *primitive) RT_MUST_CHECK;
// The radius of a sphere under a transform; false when it is no sphere any more.
bool sphere_image_radius(double radius, const Transform *transform, double *image) RT_MUST_CHECK;
// A fault: the transforms leave nothing of a shape.
bool shape_flattened(Eval *ev, const ObjectPart *part);

// The object, or the name of one, that comes next; NULL: it is one that rtlang has not. False after a fault.
bool object_read_one(Block *block, const void **object, SchemaKind *kind) RT_MUST_CHECK;

// place_composite.c: the inside of an object, in a pattern's own space, as one of Scene.insides.
bool inside_place(Eval *ev, Scene *scene, const InsideDesc *inside, Span span, uint32_t *index) RT_MUST_CHECK;

// boxes.c
// Whether an object is a sphere of a negative radius that is not stretched.
bool box_is_inside_out(SchemaKind kind, const void *object);
// Such a sphere where it is refused: in a union or merge that is one object, and as what a light looks like.
bool box_fault(Eval *ev, Span span);
bool box_fault_of_look(Eval *ev, Span span);
// Such a sphere alone is not drawn, with a warning; at the end of a scene rtlang reports whether that was right.
bool box_leave_out(Eval *ev, Span span) RT_MUST_CHECK;
bool box_left_out_rightly(Eval *ev) RT_MUST_CHECK;
// Where a ray may start inside of the shape that was placed last, with parts from `first_primitive` on: in the owner's
// box.
bool box_note_start(Eval *ev, const BoxOwner *owner, size_t first_primitive) RT_MUST_CHECK;

// place.c: an object and all that is in it become scene records.
bool object_place(Eval *ev, SchemaKind kind, const void *object) RT_MUST_CHECK;
// A sphere of a plain material; false after a fault.
bool sphere_place_plain(Eval *ev, Vec3 centre, double radius, const Material *material, Span span) RT_MUST_CHECK;
// The same for any other shape, whose material is set.
bool primitive_place_plain(Eval *ev, Primitive *primitive, const Material *material, Span span) RT_MUST_CHECK;
// Whether what the scene takes, and so many bytes more, is within the limit of memory.
bool memory_has(const Eval *ev, size_t bytes);
// The same of the scene alone; what is beyond the limit is reported.
bool memory_suffices(Eval *ev, Span span) RT_MUST_CHECK;
enum { OPENED_BYTES = 16 << 10 }; // what a small thing takes of tracer and painter beside, above all rooms of arrays

#endif
