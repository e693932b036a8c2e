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
Material look_material(const rt_look *look, size_t element, FinishIndex finish);

// What an array must be like.
typedef enum ArrayRule { ARRAY_FINITE, ARRAY_NOT_NEGATIVE, ARRAY_COLOR } ArrayRule;
typedef struct ArrayCheck {
    const char *what; // "center", for messages
    const rt_array *array;
    int numbers; // of an element
    ArrayRule rule;
} ArrayCheck;

// Whether all arrays are as they must be; reports the first element that is not, at base + its number. Colours that look
// like bytes are warned of.
bool arrays_are_fine(rt_session *session, const ArrayCheck *checks, int check_count, size_t count,
                     uint64_t base) RT_MUST_CHECK;

// Reports a call that was made out of order, or with an argument that it does not take.
rt_status session_misuse(rt_session *session, const char *message, const char *suggestion);

// The same of a call that rt_begin_scene must come before.
rt_status session_not_begun(rt_session *session, const char *function);

// Evaluates a piece of text into a scene of its own, for what calls say in numbers; the scene is the caller's to
// free. What the text says wrong is reported under the name. False after a fault.
bool session_read_piece(rt_session *session, const char *name, const char *text, Scene *scene) RT_MUST_CHECK;

// The finish that a text says, among the scene's; reports what is wrong with it.
bool session_read_finish(rt_session *session, const char *finish, FinishIndex *index) RT_MUST_CHECK;

#endif
