// Materials: the description of a texture becomes scene records, moved to where its object stands.
//
// A texture of one pigment without a pattern is a plain material; everything else is a tree of records, each different
// one of which the scene keeps once. Knows nothing of shapes.
//
// SPDX-License-Identifier: MIT
#include "base/number.h"
#include "eval/build/blocks.h"
#include "eval/build/shared_maps.h"

enum { TREE_DEPTH_WEIGHT = 2 }; // of native recursion, see eval_deepen

typedef struct Builder {
    Eval *ev;
    Scene *scene;
    Span span; // of the object that needs the texture
    SharedMaps *shared;
    bool has_surface; // there is one whose coordinates may be asked for
} Builder;

static bool add_texture(const Builder *builder, const TextureDesc *texture, const Transform *outer, uint32_t *index,
                        MapCost *cost);
static bool add_pigment(const Builder *builder, const PigmentDesc *pigment, const Transform *outer, Pigment *out,
                        uint64_t *patterns);

static bool may_ask_uv(const Builder *builder, const PatternPart *part)
{
    return !part->on_surface || builder->has_surface ||
           eval_fault(builder->ev, DIAG_E0251, builder->span,
                      "`uv_mapping` of a pigment that lies on no surface is not supported by rtlang");
}

// A pattern must be found back from the world.
static bool place_pattern(const Builder *builder, const PatternPart *part, const Transform *outer, Transform *whole)
{
    Transform back;
    if (!may_ask_uv(builder, part)) {
        return false;
    }
    *whole = part->on_surface ? *part->on_surface : transform_compose(part->transform, *outer);
    for (int row = 0; row < 4; row++) {
        for (int column = 0; column < 3; column++) {
            whole->m[row][column] += 0.0; // -0 becomes 0, so that what is written and read again is the same
        }
    }
    return (transform_is_finite(whole) && transform_invert(whole, &back)) ||
           eval_fault(builder->ev, DIAG_E0345, builder->span, "the transforms leave a flat or infinite pattern");
}

static bool no_memory(const Builder *builder)
{
    return eval_no_memory(builder->ev, builder->span);
}

// Of what lies along a pattern: only one entry counts at a point, two that are neighbours, or all of them. `most` is
// that of the entry that has most, `sum` that of all.
static uint64_t count_at_point(const Pattern *pattern, uint64_t most, uint64_t sum)
{
    bool is_one = pattern_info((PatternType)pattern->type)->form == PATTERN_OF_BLOCKS;
    if (is_one && pattern->frequency == 0.0) {
        return most;
    }
    return pattern->type == PATTERN_AVERAGE || sum < 2 * most ? sum : 2 * most;
}

static void add_cost(SharedMap *made, MapCost own)
{
    made->most.ways = own.ways > made->most.ways ? own.ways : made->most.ways;
    made->most.patterns = own.patterns > made->most.patterns ? own.patterns : made->most.patterns;
    made->sum.ways += made->sum.ways > COST_MOST ? 0 : own.ways;
    made->sum.patterns += made->sum.patterns > COST_MOST ? 0 : own.patterns;
}

static MapCost cost_at_point(const Pattern *pattern, const SharedMap *made)
{
    return (MapCost){.ways = count_at_point(pattern, made->most.ways, made->sum.ways),
                     .patterns = 1 + count_at_point(pattern, made->most.patterns, made->sum.patterns)};
}

// Lists are made from their ends, so that equal ends are kept once.
static bool add_new_pigment_entries(const Builder *builder, const PatternMap *map, SharedMap *made)
{
    Transform identity = transform_identity();
    *made = (SharedMap){.first = RECORD_NONE};
    for (size_t i = map->count; i-- > 0;) {
        const PatternEntry *from = &map->entries[i];
        PigmentEntry entry = {.at = from->at, .pigment = pigment_of(from->colour), .next = made->first};
        MapCost own = {0};
        if (!eval_step(builder->ev, builder->span) ||
            (from->pigment && !add_pigment(builder, from->pigment, &identity, &entry.pigment, &own.patterns))) {
            return false;
        }
        if (!scene_add_pigment_entry(builder->scene, &entry, &made->first)) {
            return no_memory(builder);
        }
        add_cost(made, own);
    }
    return true;
}

static bool has_pigments(const PatternMap *map)
{
    bool found = false;
    for (size_t i = 0; !found && i < map->count; i++) {
        found = map->entries[i].pigment != NULL;
    }
    return found;
}

typedef bool AddEntries(const Builder *builder, const PatternMap *map, SharedMap *made);

// Visits a map, unless that was done before.
static bool add_map(const Builder *builder, const PatternMap *map, AddEntries *add, SharedMap *made)
{
    uint32_t place;
    bool is_new;
    if (!shared_maps_place(builder->shared, map, &place, &is_new)) {
        return no_memory(builder);
    }
    if (is_new) {
        if (!add(builder, map, made)) {
            return false;
        }
        builder->shared->made.items[place] = *made;
    }
    *made = builder->shared->made.items[place];
    return true;
}

// A pigment of one colour becomes a pattern of two entries of it.
static bool pigment_as_pattern(const Builder *builder, const Pigment *pigment, uint32_t *index)
{
    if (pigment->pattern != RECORD_NONE) {
        *index = pigment->pattern;
        return true;
    }
    PatternedPigment record = {
        .to_world = transform_identity(), .pattern = {.type = PATTERN_PLANAR, .octaves = 1}, .entries = RECORD_NONE};
    PigmentEntry entry = {.at = 0.0, .pigment = *pigment, .next = RECORD_NONE};
    return (scene_add_pigment_entry(builder->scene, &entry, &record.entries) &&
            scene_add_pattern(builder->scene, &record, index)) ||
           no_memory(builder);
}

// What a pattern takes its values from, and the warps on the way to it.
static bool place_source(const Builder *builder, const PatternPart *part, Pattern *pattern, uint64_t *patterns)
{
    Transform identity = transform_identity();
    Pigment pigment;
    *patterns = 0;
    if (part->warps && !warps_place(builder->ev, builder->scene, part->warps, builder->span, &pattern->warps)) {
        return false;
    }
    if (pattern->type == PATTERN_SLOPE && (pattern->flags & PATTERN_TO_POINT)) { // a point of the scene
        Transform world = world_transform(builder->ev);
        pattern->vector = transform_point(&world, pattern->vector);
    }
    if (pattern->type == PATTERN_FUNCTION) {
        return formula_place(builder->ev, builder->scene, part->function, builder->span, &pattern->image);
    }
    if (pattern->type == PATTERN_OBJECT) {
        return inside_place(builder->ev, builder->scene, part->inside, builder->span, &pattern->image);
    }
    if (pattern->type != PATTERN_IMAGE_MAP && pattern_is_picture(pattern->type)) {
        return image_place(builder->ev, builder->scene, part->image, &pattern->image);
    }
    if (pattern->type != PATTERN_PIGMENT) {
        return true;
    }
    Builder apart = *builder;
    apart.has_surface = false; // what a pattern is made of is not given where it lies
    if (!add_pigment(&apart, part->pigment, &identity, &pigment, patterns)) {
        return false;
    }
    return pigment_as_pattern(builder, &pigment, &pattern->image);
}

static bool add_patterned(const Builder *builder, const PigmentDesc *pigment, const Transform *outer, Pigment *out,
                          uint64_t *patterns)
{
    const PatternPart *part = &pigment->part;
    const PatternMap *map = part->map ? part->map : pattern_default_map((PatternType)part->pattern.type);
    SharedMap made = {.first = RECORD_NONE};
    bool is_picture = part->pattern.type == PATTERN_IMAGE_MAP;
    uint64_t of_source;
    PatternedPigment record = {.pattern = part->pattern, .entries = RECORD_NONE};
    if (!place_pattern(builder, part, outer, &record.to_world) ||
        !place_source(builder, part, &record.pattern, &of_source) ||
        (is_picture && !image_place(builder->ev, builder->scene, part->image, &record.pattern.image)) ||
        (!is_picture && !(has_pigments(map) ? add_map(builder, map, add_new_pigment_entries, &made)
                                            : add_new_pigment_entries(builder, map, &made)))) {
        return false;
    }
    record.entries = made.first;
    *patterns = cost_at_point(&record.pattern, &made).patterns + of_source;
    *out = (Pigment){.pattern = 0};
    return scene_add_pattern(builder->scene, &record, &out->pattern) || no_memory(builder);
}

static bool add_pigment(const Builder *builder, const PigmentDesc *pigment, const Transform *outer, Pigment *out,
                        uint64_t *patterns)
{
    *patterns = 0;
    if (pigment->part.pattern.type == PATTERN_NONE) {
        *out = pigment_of(pigment->colour);
        return true;
    }
    if (!eval_deepen(builder->ev, TREE_DEPTH_WEIGHT, builder->span)) {
        return false;
    }
    bool is_added = add_patterned(builder, pigment, outer, out, patterns);
    eval_shallow(builder->ev, TREE_DEPTH_WEIGHT);
    return is_added;
}

// ---- bumps

static bool add_normal(const Builder *builder, const NormalDesc *normal, const Transform *outer, bool keeps_length,
                       uint32_t *index, uint64_t *patterns);

static bool add_slopes(const Builder *builder, const PatternMap *map, uint32_t *first)
{
    *first = RECORD_NONE;
    for (size_t i = map->count; i-- > 0;) {
        const PatternEntry *from = &map->entries[i];
        SlopeEntry entry = {.at = from->at, .height = from->height, .slope = from->slope, .next = *first};
        if (!eval_step(builder->ev, builder->span)) {
            return false;
        }
        if (!scene_add_slope_entry(builder->scene, &entry, first)) {
            return no_memory(builder);
        }
    }
    return true;
}

static bool add_new_normal_entries(const Builder *builder, const PatternMap *map, SharedMap *made)
{
    Transform identity = transform_identity();
    *made = (SharedMap){.first = RECORD_NONE};
    for (size_t i = map->count; i-- > 0;) {
        NormalEntry entry = {.at = map->entries[i].at, .next = made->first};
        MapCost own = {0};
        if (!eval_step(builder->ev, builder->span) ||
            !add_normal(builder, map->entries[i].normal, &identity, false, &entry.normal, &own.patterns)) {
            return false;
        }
        if (!scene_add_normal_entry(builder->scene, &entry, &made->first)) {
            return no_memory(builder);
        }
        add_cost(made, own);
    }
    return true;
}

// Bumps that lie on a surface and are turned in space: the only entry of an average that is.
static bool turn_normal(const Builder *builder, const Transform *to_world, uint32_t flags, uint32_t *index)
{
    const NormalDesc *plain = schema_kind(KIND_NORMAL)->defaults;
    NormalEntry entry = {.at = 1.0, .normal = *index, .next = RECORD_NONE};
    Normal record = {
        .to_world = *to_world,
        .pattern = plain->part.pattern,
        .amount = number_single(plain->amount),
        .accuracy = number_single(plain->accuracy),
        .slopes = RECORD_NONE,
        .flags = flags | NORMAL_IS_TURNED,
    };
    record.pattern.type = PATTERN_AVERAGE;
    return (scene_add_normal_entry(builder->scene, &entry, &record.entries) &&
            scene_add_normal(builder->scene, &record, index)) ||
           no_memory(builder);
}

static bool add_one_normal(const Builder *builder, const NormalDesc *normal, const Transform *outer, bool keeps_length,
                           uint32_t *index, uint64_t *patterns)
{
    SharedMap made = {.first = RECORD_NONE};
    Normal record = {
        .to_world = transform_identity(),
        .pattern = normal->part.pattern,
        .amount = number_single(normal->amount),
        .accuracy = number_single(normal->accuracy),
        .slopes = RECORD_NONE,
        .entries = RECORD_NONE,
        .flags = keeps_length || normal->keeps_length ? NORMAL_KEEPS_LENGTH : 0,
    };
    uint64_t of_source;
    if (!place_pattern(builder, &normal->part, outer, &record.to_world) ||
        !place_source(builder, &normal->part, &record.pattern, &of_source) ||
        (normal->part.map && !add_map(builder, normal->part.map, add_new_normal_entries, &made)) ||
        (normal->slopes && !normal->part.map && !pattern_info((PatternType)record.pattern.type)->blocks &&
         !add_slopes(builder, normal->slopes, &record.slopes))) {
        return false;
    }
    record.entries = made.first;
    *patterns = cost_at_point(&record.pattern, &made).patterns + of_source;
    return (scene_add_normal(builder->scene, &record, index) || no_memory(builder)) &&
           (!surface_moves(&normal->part, outer, &record.to_world) ||
            turn_normal(builder, &record.to_world, record.flags, index));
}

static bool add_normal(const Builder *builder, const NormalDesc *normal, const Transform *outer, bool keeps_length,
                       uint32_t *index, uint64_t *patterns)
{
    if (!eval_deepen(builder->ev, TREE_DEPTH_WEIGHT, builder->span)) {
        return false;
    }
    bool is_added = add_one_normal(builder, normal, outer, keeps_length, index, patterns);
    eval_shallow(builder->ev, TREE_DEPTH_WEIGHT);
    return is_added;
}

static bool has_bumps(const TextureDesc *texture)
{
    const NormalDesc *normal = &texture->normal;
    return normal->part.pattern.type != PATTERN_NONE && (normal->amount != 0.0 || normal->part.map);
}

// Every layer needs a pattern for its bumps, seen or not.
static bool layers_have_patterns(Eval *ev, const TextureDesc *layer)
{
    for (; layer; layer = layer->below) {
        if (normal_lacks_pattern(&layer->normal)) {
            return eval_fault(ev, DIAG_E0253, layer->normal.span, "a normal needs a pattern");
        }
    }
    return true;
}

// How many rays bumps and exponents of mirrors may send on from one point, but for those of flat layers without.
static unsigned layers_ways(const TextureDesc *top)
{
    unsigned ways = 0;
    for (const TextureDesc *layer = top; layer; layer = layer->below) {
        const Finish *finish = &layer->finish;
        bool has_mirror = !rgb_is_black(finish->reflection_min) || !rgb_is_black(finish->reflection_max);
        bool has_power = has_mirror && finish->reflection_exponent != 1.0;
        ways += has_power || (has_bumps(layer) && (layer == top || has_mirror));
    }
    return ways;
}

// ---- textures

// A texture that is no layer below another; those below it are looked over with it.
static bool add_top_texture(const Builder *builder, const TextureDesc *texture, const Transform *outer, uint32_t *index,
                            MapCost *cost)
{
    bool is_layer = texture->part.pattern.type == PATTERN_NONE;
    if ((is_layer && !layers_have_patterns(builder->ev, texture)) ||
        !add_texture(builder, texture, outer, index, cost)) {
        return false;
    }
    cost->ways = is_layer ? layers_ways(texture) : cost->ways;
    return true;
}

static bool add_new_texture_entries(const Builder *builder, const PatternMap *map, SharedMap *made)
{
    Transform identity = transform_identity();
    MapCost own;
    *made = (SharedMap){.first = RECORD_NONE};
    for (size_t i = map->count; i-- > 0;) {
        TextureEntry entry = {.at = map->entries[i].at, .next = made->first};
        if (!eval_step(builder->ev, builder->span) ||
            !add_top_texture(builder, map->entries[i].texture, &identity, &entry.texture, &own)) {
            return false;
        }
        if (!scene_add_texture_entry(builder->scene, &entry, &made->first)) {
            return no_memory(builder);
        }
        add_cost(made, own);
    }
    return true;
}

bool texture_hides_all(const TextureDesc *texture)
{
    return texture->part.pattern.type == PATTERN_NONE && texture->pigment.part.pattern.type == PATTERN_NONE &&
           texture->pigment.colour.filter == 0.0 && texture->pigment.colour.transmit == 0.0;
}

static bool add_texture_pattern(const Builder *builder, const TextureDesc *texture, const Transform *outer,
                                Texture *record, MapCost *cost)
{
    SharedMap made;
    uint64_t of_source;
    if (!place_pattern(builder, &texture->part, outer, &record->to_world) ||
        !place_source(builder, &texture->part, &record->pattern, &of_source) ||
        !add_map(builder, texture->part.map, add_new_texture_entries, &made)) {
        return false;
    }
    record->entries = made.first;
    *cost = cost_at_point(&record->pattern, &made);
    cost->patterns += of_source;
    return true;
}

// One layer and those below it; ways are counted for all of them together.
static bool add_layers(const Builder *builder, const TextureDesc *texture, const Transform *moved, Texture *record,
                       MapCost *cost)
{
    uint64_t of_pigment = 0, of_normal = 0;
    MapCost of_below = {0};
    if (!add_pigment(builder, &texture->pigment, moved, &record->pigment, &of_pigment) ||
        (has_bumps(texture) &&
         !add_normal(builder, &texture->normal, moved, texture->keeps_length, &record->normal, &of_normal)) ||
        (texture->below && !texture_hides_all(texture) &&
         !add_texture(builder, texture->below, moved, &record->below, &of_below))) {
        return false;
    }
    *cost = (MapCost){0, of_pigment + of_normal + of_below.patterns};
    return true;
}

// Likewise a pattern of textures.
static bool turn_texture(const Builder *builder, const Transform *to_world, const Finish *finish, uint32_t *index)
{
    const TextureDesc *plain = schema_kind(KIND_TEXTURE)->defaults;
    TextureEntry entry = {.at = 1.0, .texture = *index, .next = RECORD_NONE};
    Texture record = {
        .pigment = pigment_of((Rgbft){0.0, 0.0, 0.0, 0.0, 0.0}),
        .below = RECORD_NONE,
        .to_world = *to_world,
        .pattern = plain->part.pattern,
        .normal = RECORD_NONE,
    };
    record.pattern.type = PATTERN_AVERAGE;
    return (scene_add_finish(builder->scene, finish, &record.finish) &&
            scene_add_texture_entry(builder->scene, &entry, &record.entries) &&
            scene_add_texture(builder->scene, &record, index)) ||
           no_memory(builder);
}

static bool add_one_texture(const Builder *builder, const TextureDesc *texture, const Transform *outer, uint32_t *index,
                            MapCost *cost)
{
    Texture record = {
        .pigment = pigment_of((Rgbft){0.0, 0.0, 0.0, 0.0, 0.0}),
        .below = RECORD_NONE,
        .to_world = transform_identity(),
        .pattern = texture->part.pattern,
        .entries = RECORD_NONE,
        .normal = RECORD_NONE,
    };
    Transform moved = transform_compose(texture->part.transform, *outer);
    if (!scene_add_finish(builder->scene, &texture->finish, &record.finish)) {
        return no_memory(builder);
    }
    if (!(texture->part.pattern.type != PATTERN_NONE ? add_texture_pattern(builder, texture, outer, &record, cost)
                                                     : add_layers(builder, texture, &moved, &record, cost))) {
        return false;
    }
    return (scene_add_texture(builder->scene, &record, index) || no_memory(builder)) &&
           (!surface_moves(&texture->part, outer, &record.to_world) ||
            turn_texture(builder, &record.to_world, &texture->finish, index));
}

static bool add_texture(const Builder *builder, const TextureDesc *texture, const Transform *outer, uint32_t *index,
                        MapCost *cost)
{
    if (!eval_deepen(builder->ev, TREE_DEPTH_WEIGHT, builder->span)) {
        return false;
    }
    bool is_added = add_one_texture(builder, texture, outer, index, cost);
    eval_shallow(builder->ev, TREE_DEPTH_WEIGHT);
    return is_added;
}

// The interior, with what an old finish says of it; a plain one is none.
static bool add_interior(const Builder *builder, const TextureDesc *texture, const InteriorDesc *description,
                         uint32_t *index)
{
    static const Interior empty = {.ior = 1.0};
    Interior interior = description ? description->interior : empty;
    // In single precision, as in POV-Ray: many bounces in glass make the rounding visible.
    interior.ior = number_single(texture->ior > 0.0 ? texture->ior : interior.ior > 0.0 ? interior.ior : 1.0);
    if (interior.fade_distance == 0.0) {
        interior.fade_power = 0.0;
        interior.fade_colour = rgb_grey(0.0);
    }
    interior.fade_distance *= world_scale(builder->ev);
    *index = RECORD_NONE;
    return (interior.ior == 1.0 && interior.fade_distance == 0.0 && interior.caustics == 0.0) ||
           scene_add_interior(builder->scene, &interior, index) || no_memory(builder);
}

static bool patterns_fit(const Builder *builder, uint64_t patterns)
{
    return patterns <= SCENE_PATTERNS_MOST ||
           eval_fault(builder->ev, DIAG_E0611, builder->span, "this is made of more than %d patterns at one point",
                      (int)SCENE_PATTERNS_MOST);
}

bool pigment_place(Eval *ev, Scene *scene, const PigmentDesc *pigment, const Transform *outer, Span span, Pigment *out)
{
    SharedMaps shared = {0};
    Builder builder = {ev, scene, span, &shared, false};
    uint64_t patterns;
    bool is_added = add_pigment(&builder, pigment, outer, out, &patterns);
    shared_maps_fini(&shared);
    return is_added && patterns_fit(&builder, patterns);
}

bool normal_place(Eval *ev, Scene *scene, const NormalDesc *normal, Span span, uint32_t *index)
{
    SharedMaps shared = {0};
    Builder builder = {ev, scene, span, &shared, false};
    Transform identity = transform_identity();
    uint64_t patterns;
    bool is_added = add_normal(&builder, normal, &identity, false, index, &patterns);
    shared_maps_fini(&shared);
    return is_added && patterns_fit(&builder, patterns);
}

bool material_place(Eval *ev, const TextureDesc *texture, const Transform *outer, const MaterialSides *sides, Span span,
                    MaterialIndex *index)
{
    SharedMaps shared = {0};
    Builder builder = {ev, ev->scene, span, &shared, true};
    Compound compound = {.is_hollow = sides->is_hollow,
                         .inner = sides->inner,
                         .light_group = sides->light_group,
                         .is_double = sides->is_double};
    MapCost cost;
    if (texture_asks_uv(texture)) {
        world_note(ev);
    }
    if (!add_interior(&builder, sides->filling, sides->interior, &compound.interior)) {
        return false;
    }
    bool is_plain = texture->part.pattern.type == PATTERN_NONE && texture->pigment.part.pattern.type == PATTERN_NONE;
    if (is_plain && !has_bumps(texture) && (!texture->below || texture_hides_all(texture)) &&
        compound.interior == RECORD_NONE && compound.inner == RECORD_NONE && compound.light_group == 0 &&
        !compound.is_double) {
        Finish finish = texture->finish;
        finish.flags |= sides->is_hollow ? FINISH_HOLLOW : 0;
        return layers_have_patterns(ev, texture) &&
               (scene_add_material(ev->scene, texture->pigment.colour, &finish, index) || eval_no_memory(ev, span));
    }
    bool is_added = add_top_texture(&builder, texture, outer, &compound.texture, &cost);
    shared_maps_fini(&shared);
    if (!is_added) {
        return false;
    }
    if (cost.ways > SCENE_NORMALS_MOST) {
        return eval_fault(ev, DIAG_E0295, span, "the bumps and exponents of this texture send on more than %d rays",
                          (int)SCENE_NORMALS_MOST);
    }
    return patterns_fit(&builder, cost.patterns) &&
           (scene_add_compound(ev->scene, &compound, index) || eval_no_memory(ev, span));
}
