// Arrays of a client, read where they are, and what may be wrong with their numbers.
//
// SPDX-License-Identifier: MIT
#ifndef API_ARRAYS_H
#define API_ARRAYS_H

#include <string.h>

#include "api/session.h"

static inline double array_number(const rt_array *array, size_t element, int number)
{
    const char *at = (const char *)array->data + (ptrdiff_t)element * array->stride + number * array->step;
    double wide;
    float narrow;
    if (array->number == RT_FLOAT32) {
        memcpy(&narrow, at, sizeof narrow);
        return (double)narrow;
    }
    memcpy(&wide, at, sizeof wide);
    return wide;
}

// A zero is positive, as in text.
static inline Vec3 array_vector(const rt_array *array, size_t element, int first)
{
    return vec3(array_number(array, element, first) + 0.0, array_number(array, element, first + 1) + 0.0,
                array_number(array, element, first + 2) + 0.0);
}

static inline bool array_is_given(const rt_array *array)
{
    return array->data != NULL;
}

// The colour of an element as a material of a finish; white where none is given.
static inline Material look_material(const rt_look *look, size_t element, FinishIndex finish)
{
    const rt_array *colors = &look->colors;
    Material material = {1.0F, 1.0F, 1.0F, 0.0F, 0.0F, finish};
    if (array_is_given(colors)) {
        material.red = (float)array_number(colors, element, 0);
        material.green = (float)array_number(colors, element, 1);
        material.blue = (float)array_number(colors, element, 2);
        material.filter = look->color_numbers == 5 ? (float)array_number(colors, element, 3) : 0.0F;
        material.transmit =
            look->color_numbers >= 4 ? (float)array_number(colors, element, look->color_numbers - 1) : 0.0F;
    }
    return material;
}

// What an array must be like.
typedef enum ArrayRule { ARRAY_FINITE, ARRAY_NOT_NEGATIVE, ARRAY_COLOR } ArrayRule;
typedef struct ArrayCheck {
    const char *what; // "center", for messages
    const rt_array *array;
    int numbers; // of an element
    ArrayRule rule;
} ArrayCheck;

// Whether all arrays are as they must be; reports the first element that is not, at base + its number. Colours that
// look like bytes are warned of.
bool arrays_are_fine(rt_session *session, const ArrayCheck *checks, int check_count, size_t count,
                     uint64_t base) RT_MUST_CHECK;

// A list of elements that a call adds.
typedef struct ShapeList {
    rt_session *session;
    Source *source;
    uint64_t base; // of the source
    FinishIndex finish;
} ShapeList;

// What a call adds: so many elements of arrays, and what all of them look like.
typedef struct ShapeArrays {
    const char *name; // for messages
    size_t count;
    const ArrayCheck *checks;
    int check_count;
    const rt_look *look;
} ShapeArrays;

bool look_is_known(const rt_look *look);
ArrayCheck look_check(const rt_look *look);
Span shape_list_span(const ShapeList *list, size_t element);

// Numbers the elements, and reads the finish. False after a fault, with nothing taken.
bool shape_list_begin(ShapeList *list, rt_session *session, const ShapeArrays *arrays) RT_MUST_CHECK;
// Whether so many more records may be taken; reports when not.
bool shape_list_has_room(const ShapeList *list, size_t count, size_t bytes_each) RT_MUST_CHECK;
// Warns that an element is not drawn.
void shape_list_warn(const ShapeList *list, size_t element, const char *why);

// Reports that memory is exhausted; false.
bool session_no_room(rt_session *session, Span span);
// The status of a call, all of whose messages are handed over.
rt_status session_finish_call(rt_session *session, bool fine);

// Reports a call that was made out of order, or with an argument that it does not take.
rt_status session_misuse(rt_session *session, const char *message, const char *suggestion);

// The same of a call that rt_begin_scene must come before.
rt_status session_not_begun(rt_session *session, const char *function);

// The finish that a text says, among the scene's; reports what is wrong with it.
bool session_read_finish(rt_session *session, const char *finish, FinishIndex *index) RT_MUST_CHECK;

#endif
