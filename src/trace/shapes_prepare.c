// Scene primitives and composites made ready for rays: lengths scaled, boxes found, the bounded ones put into a tree.
//
// SPDX-License-Identifier: MIT
#include <float.h>
#include <stdlib.h>

#include "base/intern.h"
#include "scene/primitive_reach.h"
#include "trace/csg_bounds.h"
#include "trace/csg_primitives.h"
#include "trace/shapes_clusters.h"

enum {
    LOOSE_MOST = 8,  // items that are asked for each ray for being far from all others
    FAR_RATIO = 512, // how many times as far as the others, of a tree whose numbers have 2^22
};

// The same as ldexp where the power is a number.
static double times_power(double x, int exponent, double power)
{
    return RT_LIKELY(isfinite(power)) ? x * power : ldexp(x, exponent);
}

static bool is_convex(const Primitive *primitive, const PrimitiveClass *class)
{
    return primitive->kind == PRIMITIVE_POLYNOMIAL ? polynomial_is_convex(primitive->list.items)
                                                   : class->interval_count <= 1 && !class->is_mesh;
}

static PreparedPrimitive primitive_of(const Primitive *primitive, int exponent, double down, double up)
{
    const PrimitiveClass *class = primitive_class(primitive->kind);
    PreparedPrimitive prepared = {
        .kind = (uint8_t)primitive->kind,
        .family = (uint8_t) class->family,
        .traits =
            (uint8_t)((class->interval_count == 0 ? TRAIT_FLAT : 0) | (is_convex(primitive, class) ? TRAIT_CONVEX : 0) |
                      (class->is_sized ? TRAIT_SIZED : 0) | (class->is_mesh ? TRAIT_MESH : 0)),
        .flags = primitive->flags,
        .hidden = primitive->hidden,
        .flips = primitive->flags & PRIMITIVE_INVERSE,
        .node = primitive->node,
        .composite = NODE_NONE,
        .twin = SLOT_NONE,
        .material = primitive->material,
        .order = primitive->order,
        .body = primitive->body,
        .interval_most = primitive_interval_most(primitive),
    };
    memcpy(prepared.data, primitive->data, sizeof prepared.data);
    prepared.films = prepared_classes[prepared.kind].films;
    prepared.unseen = (uint8_t)(prepared_classes[prepared.kind].unseen | (primitive->flags & PRIMITIVE_OPEN ? ~1 : 0));
    prepared.traits |= prepared_classes[prepared.kind].turns ? TRAIT_TURNS : 0;
    prepared.traits |= prepared_classes[prepared.kind].met || primitive_is_flat(&prepared) ? TRAIT_SHEET : 0;
    if (primitive->kind == PRIMITIVE_PLANE) {
        prepared.data[1].x = ldexp(primitive->data[1].x, -exponent);
        return prepared;
    }
    const double *origin = primitive->to_world.m[3];
    prepared.centre = vec3(times_power(origin[0], -exponent, down), times_power(origin[1], -exponent, down),
                           times_power(origin[2], -exponent, down));
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 3; column++) {
            prepared.to_world.m[row][column] = times_power(primitive->to_world.m[row][column], -exponent, down);
            prepared.to_object.m[row][column] = times_power(primitive->to_object.m[row][column], exponent, up);
        }
    }
    primitive_measure(&prepared);
    if (primitive->kind == PRIMITIVE_POLYNOMIAL || primitive->kind == PRIMITIVE_BLOB) {
        prepared.columns = vec3_scale(POLYNOMIAL_ROUNDING, prepared.columns); // their roots are known to so much less
    }
    return prepared;
}

// The box of a primitive's surface, moved outward by the error of its support (see scene/part.c).
static Bounds part_bounds(const Primitive *primitive, int exponent, double down)
{
    if (primitive->kind == PRIMITIVE_PLANE) {
        return BOUNDS_ALL;
    }
    double low[3], high[3];
    bool is_along_axes = primitive->kind == PRIMITIVE_SPHERE && primitive_map_is_diagonal(primitive->to_world.m);
    for (int axis = 0; axis < 3; axis++) {
        if (is_along_axes) { // what the general way comes to
            double half = fabs(primitive->to_world.m[axis][axis]), middle = primitive->to_world.m[3][axis];
            double error = 12.0 * (DBL_EPSILON / 2) * (half + fabs(middle));
            high[axis] = times_power(middle + half + error, -exponent, down);
            low[axis] = times_power(middle - half - error, -exponent, down);
            continue;
        }
        Vec3 n = vec3(axis == 0, axis == 1, axis == 2);
        double error = 12.0 * (DBL_EPSILON / 2) * primitive_reach(primitive, n);
        primitive_span(primitive, n, &low[axis], &high[axis]);
        high[axis] = times_power(high[axis] + error, -exponent, down);
        low[axis] = times_power(low[axis] - error, -exponent, down);
    }
    return (Bounds){vec3(low[0], low[1], low[2]), vec3(high[0], high[1], high[2])};
}

// ---- composites

enum { UNSEEN_FEW = 64 }; // primitives of a composite among which each ray looks for such as bound it

// Whether a primitive bounds all that is seen of a composite, and a ray meets it where it is inside of it: rays ask
// such ones before all others.
static bool bounds_all(const ShapeTable *table, const CsgTree *csg, const PreparedPrimitive *primitive)
{
    const TreeNode *bound = &table->nodes[primitive->node];
    return bound->op == NODE_BOUND && bound->parent == csg->first_node && bound->child_count == 1 &&
           !bound->is_inverse && primitive_is_convex(primitive) && !primitive_is_flat(primitive) &&
           (primitive->flags & PRIMITIVE_UNSEEN) && !(primitive->flags & PRIMITIVE_INVERSE);
}

// What follows from the nodes around a primitive.
static void csg_place_primitive(ShapeTable *table, PreparedPrimitive *primitive)
{
    if (node_is_joined(&table->nodes[primitive->node])) {
        primitive->node = table->nodes[primitive->node].parent;
    }
    primitive->is_needed =
        !(primitive->flags & PRIMITIVE_INVERSE) && !(primitive->traits & TRAIT_SHEET) && !primitive_is_mesh(primitive);
    for (uint32_t at = primitive->node; at != NODE_NONE; at = table->nodes[at].parent) {
        const TreeNode *node = &table->nodes[at];
        primitive->flips = primitive->flips != node->is_inverse;
        primitive->is_needed = primitive->is_needed && node_is_all(node) && !node->is_inverse;
        primitive->bounds = primitive->bounds || node->op == NODE_BOUND;
    }
    primitive->decides = primitive->is_needed && primitive_is_convex(primitive);
}

static void csg_init(ShapeTable *table, const Composite *composite, uint32_t index)
{
    CsgTree *csg = &table->csg_trees[index];
    *csg = (CsgTree){.first_node = composite->first_node,
                     .node_count = composite->node_count,
                     .first_primitive = composite->first_primitive,
                     .primitive_count = composite->primitive_count,
                     .hidden = composite->hidden,
                     .interval_most = 1,
                     .is_convex = true,
                     .order = composite->order};
    const TreeNode *root = &table->nodes[csg->first_node];
    uint32_t children = 0, bounds = 0, first_bounds = 0; // primitives at the root; nodes that bound; those asked first
    for (uint32_t i = csg->first_node; i < csg->first_node + csg->node_count; i++) {
        bounds += table->nodes[i].op == NODE_BOUND;
    }
    csg->is_meet = csg->is_plain = node_is_all(root) && !root->is_inverse;
    for (uint32_t i = composite->first_primitive; i < composite->first_primitive + composite->primitive_count; i++) {
        PreparedPrimitive *primitive = &table->primitives[i];
        csg->seen_count = primitive->flags & PRIMITIVE_UNSEEN ? csg->seen_count : i + 1 - composite->first_primitive;
        primitive->composite = index;
        csg->is_plain = csg->is_plain && primitive_is_convex(primitive) && !primitive_is_flat(primitive);
        csg->is_convex = csg->is_convex && primitive_is_convex(primitive);
        csg->interval_most =
            primitive->interval_most > csg->interval_most ? primitive->interval_most : csg->interval_most;
        csg->crossing_count += primitive_is_mesh(primitive)   ? MESH_CROSSINGS
                               : primitive_is_flat(primitive) ? 2
                                                              : 2 * primitive->interval_most;
        if (primitive_is_mesh(primitive)) {
            primitive->mesh.cursor = csg->mesh_count++;
        }
        csg_place_primitive(table, primitive);
        first_bounds += bounds_all(table, csg, primitive);
        children += primitive->node == csg->first_node;
        csg->is_meet = csg->is_meet && (primitive->decides || primitive->bounds);
    }
    csg->has_bounds = bounds > first_bounds || (bounds > 0 && csg->primitive_count - csg->seen_count > UNSEEN_FEW);
    csg->asks_bounds = bounds > 0 && !csg->has_bounds;
    csg->is_meet = csg->is_meet && !csg->has_bounds && children == root->child_count;
    csg->is_plain =
        csg->is_plain && !csg->has_bounds && children == root->child_count && csg->primitive_count <= CSG_PLAIN_MOST;
}

// ---- meshes

// The table of a mesh, built when it is met first; NULL when out of memory or cancelled.
static const MeshTable *mesh_table(ShapeTable *table, InternTable *known, const Mesh *mesh, int threads,
                                   const atomic_bool *cancel)
{
    Symbol number = intern_text(known, (const char *)&mesh, sizeof mesh);
    if (number == SYMBOL_NONE || number <= table->mesh_count) {
        return number == SYMBOL_NONE ? NULL : table->meshes[number - 1];
    }
    MeshTable *made = mesh_table_new(mesh, threads, cancel);
    if (made) {
        table->meshes[table->mesh_count++] = made;
    }
    return made;
}

static bool fill_meshes(ShapeTable *table, const Scene *scene, InternTable *known, int threads,
                        const atomic_bool *cancel)
{
    uint64_t faces = 0;
    for (uint32_t i = 0; i < table->primitive_count; i++) {
        const Primitive *primitive = &scene->primitives.items[i];
        PreparedPrimitive *prepared = &table->primitives[i];
        if (!primitive_is_mesh(prepared)) {
            continue;
        }
        prepared->mesh.table = mesh_table(table, known, primitive->mesh.mesh, threads, cancel);
        if (!prepared->mesh.table || faces + primitive->mesh.mesh->face_count >= 1u << SHAPE_INDEX_BITS) {
            return false;
        }
        prepared->mesh.materials =
            scene->face_materials.items ? scene->face_materials.items + primitive->mesh.materials : NULL;
        prepared->mesh.first_face = (uint32_t)faces;
        faces += primitive->mesh.mesh->face_count;
        table->mesh_solids[table->mesh_solid_count++] = i;
    }
    return true;
}

// What meshes have beside numbers.
static bool meshes_init(ShapeTable *table, const Scene *scene, int threads, const atomic_bool *cancel)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < table->primitive_count; i++) {
        count += primitive_class(scene->primitives.items[i].kind)->is_mesh;
    }
    if (count == 0) {
        return true;
    }
    InternTable *known = intern_new(SIZE_MAX);
    table->meshes = calloc(count, sizeof *table->meshes);
    table->mesh_solids = calloc(count, sizeof *table->mesh_solids);
    bool is_fine = known && table->meshes && table->mesh_solids && fill_meshes(table, scene, known, threads, cancel);
    intern_free(known);
    return is_fine;
}

// ---- the tree

typedef struct Work {
    Bounds *solids, *nodes; // the roots' boxes are those of their csg_trees; nodes: twice as many, the rest spare
    ShapeItem *bounded;
    Bounds *clusters;
    Pages primitive_pages, bounded_pages, ref_pages;
    const atomic_bool *cancel; // of building the tree
} Work;

static const Bounds *item_bounds(const ShapeTable *table, const Work *work, ShapeItem item)
{
    uint32_t index = item_index(item), tree = index - table->primitive_count;
    return index < table->primitive_count ? &work->solids[index]
           : tree < table->csg_count      ? &work->nodes[table->csg_trees[tree].first_node]
                                          : &work->clusters[tree - table->csg_count];
}

// Of those only quadrics are asked in lanes.
static void add_unbounded(ShapeTable *table, ShapeItem item)
{
    bool has_lanes = (item & ITEM_LANES) && primitive_is_quadric(&table->primitives[item_index(item)]);
    table->items[table->unbounded_count++] = has_lanes ? item : item_index(item);
}

static void add_item(ShapeTable *table, Work *work, ShapeItem item, const Bounds *bounds)
{
    if (bounds_are_empty(*bounds)) {
        return; // nothing is left of what is cut with one another
    }
    if (bounds_are_finite(*bounds)) {
        work->bounded[table->bounded_count++] = item;
    } else {
        add_unbounded(table, item);
    }
}

// How far from a place a box reaches, along any axis.
static double bounds_reach(const Bounds *bounds, Vec3 from)
{
    Vec3 low = vec3_sub(from, bounds->low), high = vec3_sub(bounds->high, from);
    return fmax(fmax(fmax(low.x, low.y), low.z), fmax(fmax(high.x, high.y), high.z));
}

static int double_order(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// The middle one of some of the items by what is measured of them; `share` in place of 1/2 gives another rank.
typedef double (*Measure)(const Bounds *bounds, Vec3 from, int axis);
static double middle_of(const ShapeTable *table, const Work *work, Measure measure, Vec3 from, int axis, double share)
{
    enum { SAMPLES = 512 };
    double samples[SAMPLES];
    uint32_t count = 0, step = table->bounded_count / SAMPLES + 1;
    for (uint32_t i = 0; i < table->bounded_count; i += step) {
        samples[count++] = measure(item_bounds(table, work, work->bounded[i]), from, axis);
    }
    qsort(samples, count, sizeof samples[0], double_order);
    return samples[(uint32_t)(share * count)];
}

static double measure_place(const Bounds *bounds, Vec3 from, int axis)
{
    (void)from;
    return axis == 0 ? bounds->low.x : axis == 1 ? bounds->low.y : bounds->low.z;
}

static double measure_reach(const Bounds *bounds, Vec3 from, int axis)
{
    (void)axis;
    return bounds_reach(bounds, from);
}

// A tree's boxes have the digits of a float beside the whole tree's size: a few items that are much larger than the
// others, or much farther away, would blur all of them. Such items stand with the unbounded ones.
static void part_with_far(ShapeTable *table, Work *work)
{
    if (table->bounded_count <= 2 * LOOSE_MOST) {
        return;
    }
    Vec3 origin = {0.0, 0.0, 0.0}, middle;
    middle.x = middle_of(table, work, measure_place, origin, 0, 0.5);
    middle.y = middle_of(table, work, measure_place, origin, 1, 0.5);
    middle.z = middle_of(table, work, measure_place, origin, 2, 0.5);
    double limit = FAR_RATIO * middle_of(table, work, measure_reach, middle, 0, 0.5);
    uint32_t far = 0, kept = 0;
    for (uint32_t i = 0; i < table->bounded_count; i++) {
        far += bounds_reach(item_bounds(table, work, work->bounded[i]), middle) > limit;
    }
    if (far == 0 || far > LOOSE_MOST) {
        return;
    }
    for (uint32_t i = 0; i < table->bounded_count; i++) {
        ShapeItem item = work->bounded[i];
        if (bounds_reach(item_bounds(table, work, item), middle) > limit) {
            add_unbounded(table, item);
        } else {
            work->bounded[kept++] = item;
        }
    }
    table->bounded_count = kept;
}

static Bounds items_bounds(const ShapeTable *table, const Work *work, const ShapeItem *from, uint32_t count)
{
    Bounds all = BOUNDS_NONE;
    for (uint32_t i = 0; i < count; i++) {
        const Bounds *own = item_bounds(table, work, from[i]);
        all = (Bounds){vec3_least(all.low, own->low), vec3_greatest(all.high, own->high)};
    }
    return all;
}

// Items that go to places of the table from `to` on.
typedef struct ItemsToPlace {
    const ShapeItem *from;
    uint32_t count, to;
} ItemsToPlace;

// The tree of some items, which with their boxes go to places of the table in its order.
static bool tree_init(ShapeTable *table, Work *work, Bvh *tree, const ItemsToPlace *items, int threads)
{
    const ShapeItem *from = items->from;
    const uint32_t count = items->count, to = items->to;
    BvhRef *refs = work->ref_pages.memory;
    Bounds all = items_bounds(table, work, from, count);
    bvh_place(tree, all.low, all.high);
    for (uint32_t i = 0; i < count; i++) {
        const Bounds *own = item_bounds(table, work, from[i]);
        refs[i] = bvh_ref(tree, own->low, own->high, i);
    }
    bool done = bvh_build(tree, refs, count, BVH_LEAF_ONE, threads, work->cancel);
    for (uint32_t i = 0; done && i < count; i++) {
        table->items[table->unbounded_count + to + i] = from[bvh_ref_index(&refs[i])];
        memcpy(table->boxes[to + i].low, refs[i].low, sizeof table->boxes[to + i].low);
        memcpy(table->boxes[to + i].high, refs[i].high, sizeof table->boxes[to + i].high);
    }
    return done;
}

static double measure_size(const Bounds *bounds, Vec3 from, int axis)
{
    (void)from;
    (void)axis;
    return vec3_max_abs(vec3_sub(bounds->high, bounds->low));
}

static bool is_blurred(const ShapeTable *table, const Work *work)
{
    Bounds all = items_bounds(table, work, work->bounded, table->bounded_count);
    double size = middle_of(table, work, measure_size, all.low, 0, 0.5);
    return table->bounded_count >= 2 * CLUSTER_LEAST &&
           size_is_blurred(size, vec3_max_abs(vec3_sub(all.high, all.low)));
}

// Each run of items becomes a cluster, an item that stands in their place among the others; behind these all theirs.
static bool clusters_init(ShapeTable *table, Work *work, const PlacedItem *placed, const ItemRun *runs, uint32_t count)
{
    uint32_t all = table->bounded_count, kept = 0, at = 0;
    table->clusters = calloc(count, sizeof *table->clusters);
    work->clusters = malloc(count * sizeof *work->clusters);
    ShapeItem *inner = malloc(all * sizeof *inner);
    if (!table->clusters || !work->clusters || !inner) {
        free(inner);
        return false;
    }
    for (uint32_t c = 0; c <= count; c++) {
        ItemRun run = c < count ? runs[c] : (ItemRun){all, all};
        for (; at < run.begin; at++) {
            work->bounded[kept++] = placed[at].item;
        }
        for (; at < run.end; at++) {
            inner[table->clustered_count++] = placed[at].item;
        }
        if (c < count) {
            work->bounded[kept++] = table->primitive_count + table->csg_count + c;
        }
    }
    table->bounded_count = kept;
    bool done = true;
    for (uint32_t c = 0, first = 0; done && c < count; c++) {
        ShapeCluster *cluster = &table->clusters[c];
        uint32_t own = runs[c].end - runs[c].begin;
        work->clusters[c] = items_bounds(table, work, inner + first, own);
        cluster->items = table->items + table->unbounded_count + kept + first;
        cluster->boxes = table->boxes + kept + first;
        done = tree_init(table, work, &cluster->tree, &(ItemsToPlace){inner + first, own, kept + first}, 1);
        table->cluster_count++;
        first += own;
    }
    free(inner);
    return done;
}

static bool clusters_part(ShapeTable *table, Work *work)
{
    ItemRun runs[CLUSTERS_MOST];
    PlacedItem *placed = malloc(table->bounded_count * sizeof *placed);
    if (!placed) {
        return false;
    }
    for (uint32_t i = 0; i < table->bounded_count; i++) {
        placed[i] = (PlacedItem){item_bounds(table, work, work->bounded[i]), work->bounded[i]};
    }
    uint32_t count = clusters_find(placed, table->bounded_count, runs);
    bool done = count == 0 || (count != UINT32_MAX && clusters_init(table, work, placed, runs, count));
    free(placed);
    return done;
}

// Room for all boxes, clusters' among them, and the trees.
static bool trees_init(ShapeTable *table, Work *work, int threads)
{
    size_t most = table->bounded_count + (size_t)CLUSTERS_MOST;
    if (!pages_take(&work->ref_pages, table->bounded_count * sizeof(BvhRef)) ||
        !pages_take(&table->box_pages, most * sizeof *table->boxes)) {
        return false;
    }
    table->boxes = table->box_pages.memory;
    return (!is_blurred(table, work) || clusters_part(table, work)) &&
           tree_init(table, work, &table->tree, &(ItemsToPlace){work->bounded, table->bounded_count, 0}, threads);
}

static bool items_init(ShapeTable *table, Work *work, int threads)
{
    for (uint32_t i = 0; i < table->primitive_count; i++) {
        if (table->primitives[i].node == NODE_NONE) {
            add_item(table, work, i | (primitive_has_lanes(&table->primitives[i]) ? ITEM_LANES : 0), &work->solids[i]);
        }
    }
    for (uint32_t i = 0; i < table->csg_count; i++) {
        CsgTree *csg = &table->csg_trees[i];
        Bounds *root = &work->nodes[csg->first_node];
        *root = csg_measure(table, csg, work->solids, work->nodes, work->nodes + table->node_count);
        if (csg->primitive_count > 0) {
            add_item(table, work, table->primitive_count + i, root);
        }
        if (!csg_parts_init(table, csg, work->solids, work->nodes, threads, work->cancel)) {
            return false;
        }
    }
    part_with_far(table, work);
    return table->bounded_count == 0 || trees_init(table, work, threads);
}

// What the table and the work on it need; what was taken is given back in any case.
static bool storage_take(ShapeTable *table, const Scene *scene, Work *work)
{
    size_t most = scene->primitives.count + scene->composites.count;
    work->nodes = malloc((2 * scene->nodes.count + 1) * sizeof *work->nodes);
    table->nodes = malloc((scene->nodes.count + 1) * sizeof *table->nodes);
    table->csg_trees = calloc(scene->composites.count + 1, sizeof *table->csg_trees); // without trees of primitives
    if (!work->nodes || !table->nodes || !table->csg_trees ||
        !pages_take(&work->primitive_pages, scene->primitives.count * sizeof *work->solids) ||
        !pages_take(&work->bounded_pages, most * sizeof *work->bounded) ||
        !pages_take(&table->primitive_pages, scene->primitives.count * sizeof *table->primitives) ||
        !pages_take(&table->item_pages, (most + CLUSTERS_MOST) * sizeof *table->items)) {
        return false;
    }
    work->solids = work->primitive_pages.memory;
    work->bounded = work->bounded_pages.memory;
    table->primitives = table->primitive_pages.memory;
    table->items = table->item_pages.memory;
    return true;
}

static bool asks_world(uint8_t kind)
{
    return kind == PRIMITIVE_ISOSURFACE || kind == PRIMITIVE_PARAMETRIC || kind == PRIMITIVE_JULIA;
}

bool shapes_init(ShapeTable *table, const Scene *scene, int exponent, int threads, const atomic_bool *cancel)
{
    *table = (ShapeTable){
        .primitive_count = (uint32_t)scene->primitives.count,
        .node_count = (uint32_t)scene->nodes.count,
        .csg_count = (uint32_t)scene->composites.count,
        .isosurfaces = {.scale = ldexp(1.0, exponent) / scene->text_unit},
    };
    if (table->primitive_count == 0) {
        return true;
    }
    Work work = {.cancel = cancel};
    bool done = storage_take(table, scene, &work);
    if (done) {
        double down = ldexp(1.0, -exponent), up = ldexp(1.0, exponent);
        for (uint32_t i = 0; i < table->primitive_count; i++) {
            table->primitives[i] = primitive_of(&scene->primitives.items[i], exponent, down, up);
            if (asks_world(table->primitives[i].kind)) {
                table->primitives[i].isosurface.world = &table->isosurfaces;
            }
            work.solids[i] = part_bounds(&scene->primitives.items[i], exponent, down);
        }
        done = meshes_init(table, scene, threads, cancel);
        csg_nodes_init(table, scene);
        for (uint32_t i = 0; i < table->csg_count; i++) {
            csg_init(table, &scene->composites.items[i], i);
        }
        done = done && items_init(table, &work, threads);
    }
    free(work.nodes);
    free(work.clusters);
    pages_give(&work.primitive_pages);
    pages_give(&work.bounded_pages);
    pages_give(&work.ref_pages);
    return done;
}

void shapes_fini(ShapeTable *table)
{
    for (uint32_t i = 0; table->csg_trees && i < table->csg_count; i++) {
        csg_parts_fini(&table->csg_trees[i]);
    }
    free(table->nodes);
    free(table->csg_trees);
    for (uint32_t i = 0; i < table->mesh_count; i++) {
        mesh_table_free(table->meshes[i]);
    }
    free(table->meshes);
    free(table->mesh_solids);
    pages_give(&table->primitive_pages);
    pages_give(&table->item_pages);
    pages_give(&table->box_pages);
    bvh_fini(&table->tree);
    for (uint32_t i = 0; i < table->cluster_count; i++) {
        bvh_fini(&table->clusters[i].tree);
    }
    free(table->clusters);
    *table = (ShapeTable){0};
}

size_t shapes_bytes(const ShapeTable *table)
{
    size_t own = 0;
    for (uint32_t i = 0; i < table->mesh_count; i++) {
        own += mesh_table_bytes(table->meshes[i]);
    }
    for (uint32_t i = 0; i < table->csg_count; i++) {
        own += csg_parts_bytes(&table->csg_trees[i]);
    }
    for (uint32_t i = 0; i < table->cluster_count; i++) {
        own += sizeof *table->clusters + table->clusters[i].tree.node_count * sizeof(BvhNode);
    }
    return own + table->primitive_count * sizeof *table->primitives + table->node_count * sizeof *table->nodes +
           table->csg_count * sizeof *table->csg_trees +
           (table->unbounded_count + table->bounded_count + table->clustered_count) * sizeof *table->items +
           (table->bounded_count + table->clustered_count) * sizeof *table->boxes +
           table->tree.node_count * sizeof *table->tree.nodes;
}
