// Cameras: what stands in the braces becomes the four vectors of a Camera.
//
// POV-Ray collects everything first, whatever its order; at the closing brace the angle sets the length of the
// direction, look_at turns the vectors, and the transforms come last. Before `#version 3.5` each word takes effect where
// it stands, on what has been said by then. Measured on POV-Ray 3.7.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "eval/build/blocks.h"

enum { BLUR_SAMPLES_MAX = 1 << 24 };

static const double radians_per_degree = 0x1.1df46a2529d39p-6; // pi / 180

static CameraType camera_type(const CameraDesc *camera)
{
    CameraType type = CAMERA_TYPES - 1;
    while (type > CAMERA_PERSPECTIVE && !camera->types[type]) {
        type--;
    }
    return type;
}

// The second angle of a spherical camera; half of the first when it is left out.
static bool read_vertical_angle(Block *block)
{
    static const SchemaProperty number = {"angle", TYPE_NUMBER, ACTION_NONE,
                                          .at = offsetof(CameraDesc, angle_vertical_deg),
                                          .range = {RANGE_FAULT, false, 0.0, (double)INFINITY}};
    CameraDesc *camera = &block->record->camera;
    cursor_take_comma(&block->cursor);
    const AstNode *value = cursor_peek(&block->cursor);
    camera->angle_vertical_deg = camera->angle_deg / 2.0;
    return !value || value->kind == AST_WORD || !cursor_at_value(&block->cursor) ||
           block_value(block, &number, value->span);
}

// Whether each word takes effect where it stands.
static bool is_in_order(const Block *block)
{
    return block->ev->version < 3.5;
}

// `direction` gets the length that makes the picture so wide. The wide cameras keep theirs.
static void set_direction_by_angle(CameraDesc *camera)
{
    if (camera->has_angle && camera->angle_deg != 0.0 && camera_type(camera) <= CAMERA_ORTHOGRAPHIC) {
        double half_angle = camera->angle_deg * radians_per_degree / 2.0;
        double length = 0.5 * vector_length(camera->right) / tan(half_angle);
        camera->direction = vec3_scale(length, vector_unit(camera->direction));
    }
}

// Turns the camera so that look_at is in the middle; only lengths and handedness of the vectors are kept.
static bool turn_to_look_at(Block *block)
{
    CameraDesc *camera = &block->record->camera;
    Vec3 way = vec3_sub(camera->look_at, camera->location);
    // POV-Ray takes a sine up to 3e-11 as parallel and one of 1e-10 as not. It also refuses a distance below 1e-5,
    // which would forbid small scenes; here only the same point is refused.
    const double least_sine = 5e-11;
    if (!(vector_length(way) > 0.0)) {
        return block_fault(block, DIAG_E0346, block->node->span, "the camera cannot look at its own location");
    }
    Vec3 ahead = vector_unit(way);
    Vec3 across = vec3_cross(vector_unit(camera->sky), ahead);
    // Where the three do not say it, as with `up z`, POV-Ray draws a mirrored picture. Measured on all such pairings.
    double hand = vec3_dot(vec3_cross(camera->up, camera->direction), camera->right) > 0.0 ? 1.0 : -1.0;
    Vec3 side = vector_unit(across);
    if (vector_length(across) < least_sine) {
        eval_warn(block->ev, DIAG_W0347, block->node->span,
                  "the camera looks along its `sky`; `right` is used as it is given");
        side = vector_unit(camera->right);
    }
    Vec3 top = vec3_cross(ahead, side);
    camera->direction = vec3_scale(vector_length(camera->direction), ahead);
    camera->right = vec3_scale(hand * vector_length(camera->right), side);
    camera->up = vec3_scale(vector_length(camera->up), top);
    return true;
}

bool camera_angle_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    static const SchemaProperty number = {"angle", TYPE_NUMBER, ACTION_NONE, .at = offsetof(CameraDesc, angle_deg)};
    CameraDesc *camera = &block->record->camera;
    (void)property;
    camera->has_angle = true;
    const AstNode *value = cursor_peek(&block->cursor);
    bool has_value = value && value->kind != AST_WORD && cursor_at_value(&block->cursor);
    CameraType type = camera_type(camera);
    if (!has_value && type == CAMERA_ORTHOGRAPHIC) {
        camera->angle_deg = 0.0;
        return true;
    }
    Span span = has_value ? value->span : item->span;
    if (!block_value(block, &number, item->span)) {
        return false;
    }
    bool is_flat = type == CAMERA_PERSPECTIVE || type == CAMERA_ORTHOGRAPHIC;
    if (camera->angle_deg < 0.0 || (is_flat && camera->angle_deg >= 180.0)) {
        return block_fault(block, DIAG_E0341, span, "`angle` must be at least 0%s, not %g",
                           is_flat ? " and less than 180" : "", camera->angle_deg);
    }
    if (is_in_order(block)) {
        set_direction_by_angle(camera);
    }
    return type != CAMERA_SPHERICAL || read_vertical_angle(block);
}

bool camera_look_at_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    static const SchemaProperty point = {"look_at", TYPE_VECTOR, ACTION_NONE, .at = offsetof(CameraDesc, look_at),
                                         .given = offsetof(CameraDesc, has_look_at)};
    (void)property;
    return block_value(block, &point, item->span) && (!is_in_order(block) || turn_to_look_at(block));
}

static void move(CameraDesc *camera, const Transform *transform)
{
    camera->location = transform_point(transform, camera->location);
    camera->direction = transform_direction(transform, camera->direction);
    camera->right = transform_direction(transform, camera->right);
    camera->up = transform_direction(transform, camera->up);
}

void camera_transform(Block *block, const Transform *transform)
{
    CameraDesc *camera = &block->record->camera;
    if (is_in_order(block)) {
        move(camera, transform);
    } else {
        camera->transform = transform_compose(camera->transform, *transform);
    }
}

// The kind of cylinder follows.
bool camera_cylinder_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    double number;
    const AstNode *value = cursor_peek(&block->cursor);
    Span span = value ? value->span : item->span;
    if (!value || !cursor_at_value(&block->cursor)) {
        return block_fault(block, DIAG_E0253, item->span, "`%s` needs a number after it", property->word);
    }
    if (!cursor_number(&block->cursor, &number, &span)) {
        return false;
    }
    if (!(trunc(number) >= 1.0 && trunc(number) <= 4.0)) {
        return block_fault(block, DIAG_E0341, span, "the `cylinder` of a camera must be 1, 2, 3 or 4, not %g", number);
    }
    block->record->camera.types[CAMERA_CYLINDER_1 + (int)number - 1] = true;
    return true;
}

// One number is the most, two are the least and the most.
bool camera_blur_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    static const SchemaProperty values[] = {
        {"blur_samples", TYPE_INTEGER, ACTION_NONE, .at = offsetof(CameraDesc, blur_samples[0]),
         .range = {RANGE_FAULT, false, 1.0, BLUR_SAMPLES_MAX}},
        {"blur_samples", TYPE_INTEGER, ACTION_NONE, .at = offsetof(CameraDesc, blur_samples[1]),
         .range = {RANGE_FAULT, false, 1.0, BLUR_SAMPLES_MAX}},
    };
    CameraDesc *camera = &block->record->camera;
    (void)property;
    camera->blur_samples[1] = 0;
    if (!block_value(block, &values[0], item->span)) {
        return false;
    }
    cursor_take_comma(&block->cursor);
    const AstNode *next = cursor_peek(&block->cursor);
    bool has_more = next && next->kind != AST_WORD && cursor_at_value(&block->cursor);
    return !has_more || block_value(block, &values[1], item->span);
}

// Bumps begin as if nothing had been said of them.
bool camera_normal_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    Eval *ev = block->ev;
    Desc record;
    SchemaKind is;
    (void)property;
    memcpy(&record, schema_kind(KIND_NORMAL)->defaults, schema_kind(KIND_NORMAL)->size);
    if (!block_read(ev, item, KIND_NORMAL, &ev->program, &record, &is)) {
        return false;
    }
    if (normal_lacks_pattern(&record.normal)) {
        return block_fault(block, DIAG_E0253, item->span, "a normal needs a pattern");
    }
    block->record->camera.normal = arena_copy(&ev->program, &record.normal, sizeof record.normal);
    return block->record->camera.normal || eval_no_memory(ev, item->span);
}

// The size of an orthographic picture is that of a perspective one at the distance of look_at, unless right or up say
// it.
static void set_orthographic_size(CameraDesc *camera, Vec3 location, double direction_length)
{
    if ((camera->has_right || camera->has_up) && !camera->has_angle) {
        return;
    }
    double factor = vector_length(vec3_sub(camera->look_at, location)) / direction_length;
    camera->right = vec3_scale(factor, camera->right);
    camera->up = vec3_scale(factor, camera->up);
}

static bool resolve(Block *block)
{
    CameraDesc *camera = &block->record->camera;
    if (!is_in_order(block)) {
        set_direction_by_angle(camera);
        double direction_length = vector_length(camera->direction);
        if (camera->has_look_at && !turn_to_look_at(block)) {
            return false;
        }
        if (camera_type(camera) == CAMERA_ORTHOGRAPHIC) {
            set_orthographic_size(camera, camera->location, direction_length);
        }
    }
    // Transforms do not change it. Measured, as is the distance of 1.
    camera->focal_distance =
        camera->has_focal_point ? vector_length(vec3_sub(camera->focal_point, camera->location)) : 1.0;
    return true;
}

// What cannot be drawn: POV-Ray's own picture of an orthographic camera with a lens is a smear.
static bool lens_fits(Block *block)
{
    const CameraDesc *camera = &block->record->camera;
    if (camera->aperture == 0.0 || camera->blur_samples[0] == 0) {
        return true;
    }
    if (camera_type(camera) != CAMERA_PERSPECTIVE) {
        return block_fault(block, DIAG_E0341, block->node->span, "only a perspective camera has an `aperture`");
    }
    return camera->focal_distance > 0.0 ||
           block_fault(block, DIAG_E0341, block->node->span, "`focal_point` must be away from the camera's location");
}

// POV-Ray's other cameras with bumps see the points of a picture in other places.
static bool normal_fits(Block *block)
{
    const CameraDesc *camera = &block->record->camera;
    if (!camera->normal || (camera_type(camera) <= CAMERA_ORTHOGRAPHIC && camera->aperture == 0.0)) {
        return true;
    }
    return block_fault(block, DIAG_E0341, block->node->span,
                       "only a perspective or orthographic camera without `aperture` has a `normal`");
}

bool camera_close(Block *block)
{
    CameraDesc *camera = &block->record->camera;
    if (camera->types[CAMERA_SPHERICAL] && is_in_order(block)) {
        return block_fault(block, DIAG_E0341, block->node->span, "a `spherical` camera needs `#version 3.5` or later");
    }
    if (!block->has_name && !(resolve(block) && lens_fits(block) && normal_fits(block))) {
        return false;
    }
    move(camera, &camera->transform);
    camera->transform = transform_identity();
    return (vec3_is_finite(camera->location) && vec3_is_finite(camera->direction) && vec3_is_finite(camera->right) &&
            vec3_is_finite(camera->up)) ||
           block_fault(block, DIAG_E0340, block->node->span, "the camera leaves the range of numbers");
}

bool camera_place(Eval *ev, const CameraDesc *camera, Span span)
{
    Scene *scene = ev->scene;
    if (scene->has_camera) {
        eval_warn(ev, DIAG_W0406, span, "more than one camera: only the last one counts");
    }
    Transform world = world_transform(ev);
    CameraType type = camera_type(camera);
    // The wide cameras take no lengths from their vectors but those on the screen.
    bool has_lengths = type == CAMERA_PERSPECTIVE || camera_type_moves(type);
    Transform turn = has_lengths ? world : transform_identity();
    double unit = vec3_length(transform_direction(&world, vec3(1.0, 0.0, 0.0)));
    bool has_lens = camera->aperture != 0.0 && camera->blur_samples[0] > 0, has_least = camera->blur_samples[1] != 0;
    scene->has_camera = true;
    static const double default_angles[CAMERA_TYPES] = {
        [CAMERA_FISHEYE] = 90.0, [CAMERA_ULTRA_WIDE_ANGLE] = 90.0, [CAMERA_SPHERICAL] = 360.0,
        [CAMERA_CYLINDER_1] = 90.0, [CAMERA_CYLINDER_2] = 90.0, [CAMERA_CYLINDER_3] = 90.0, [CAMERA_CYLINDER_4] = 90.0};
    bool is_given = camera->has_angle && default_angles[type] > 0.0;
    double angle = is_given ? camera->angle_deg : default_angles[type];
    scene->camera = (Camera){
        .type = type,
        .angle = angle,
        .angle_vertical = type != CAMERA_SPHERICAL ? 0.0 : is_given ? camera->angle_vertical_deg : angle / 2.0,
        .location = transform_point(&world, camera->location),
        .direction = transform_direction(&turn, camera->direction),
        .right = transform_direction(&turn, camera->right),
        .up = transform_direction(&turn, camera->up),
        .lens_radius = has_lens ? unit * fabs(camera->aperture) / 4.0 : 0.0,
        .focal_distance = has_lens ? unit * camera->focal_distance : 1.0,
        .blur_samples = has_lens ? camera->blur_samples[has_least] : 0,
        .blur_least = has_lens && has_least ? camera->blur_samples[0] : 0,
        .blur_confidence = has_lens ? camera->confidence : 0.0,
        .blur_variance = has_lens ? camera->variance : 0.0,
        .span = span,
    };
    ev->objects->camera_normal = camera->normal;
    return true;
}

bool camera_finish(Eval *ev)
{
    const NormalDesc *normal = ev->objects->camera_normal;
    Camera *camera = &ev->scene->camera;
    bool has_bumps = normal && normal->part.pattern.type != PATTERN_NONE && (normal->amount != 0.0 || normal->part.map);
    if (!has_bumps || ev->stop) {
        return true;
    }
    if (!normal_place(ev, ev->scene, normal, camera->span, &camera->bumps)) {
        return false;
    }
    camera->bumps++;
    return true;
}
