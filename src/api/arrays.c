// What is wrong with arrays: every number is looked at before any is taken, on several threads.
//
// Owns nothing. Knows nothing of what the arrays become.
//
// SPDX-License-Identifier: MIT
#include "api/arrays.h"

#include <math.h>
#include <stdatomic.h>
#include <stdio.h>

#include "base/parallel.h"
#include "scene/range.h"

typedef struct Look {
    const ArrayCheck *check;
    atomic_size_t bad, bytes; // the first element that is wrong, and that has a colour like bytes; SIZE_MAX: none
} Look;

static bool number_is_fine(ArrayRule rule, double number)
{
    return rule == ARRAY_NOT_NEGATIVE ? number >= 0.0 && isfinite(number)
           : rule == ARRAY_COLOR      ? isfinite((float)number)
                                      : isfinite(number);
}

static bool element_is_fine(const ArrayCheck *check, size_t element)
{
    bool is_fine = true;
    for (int k = 0; k < check->numbers; k++) {
        is_fine = number_is_fine(check->rule, array_number(check->array, element, k)) && is_fine;
    }
    return is_fine;
}

static bool is_like_bytes(const ArrayCheck *check, size_t element)
{
    return check->rule == ARRAY_COLOR &&
           rgb_is_like_bytes(array_number(check->array, element, 0), array_number(check->array, element, 1),
                             array_number(check->array, element, 2));
}

static void note_least(atomic_size_t *least, size_t element)
{
    size_t known = atomic_load(least);
    while (element < known && !atomic_compare_exchange_weak(least, &known, element)) {
    }
}

static void look_work(void *client, size_t begin, size_t end)
{
    Look *look = client;
    for (size_t i = begin; i < end; i++) {
        if (!element_is_fine(look->check, i)) {
            note_least(&look->bad, i);
            return;
        }
        if (is_like_bytes(look->check, i)) {
            note_least(&look->bytes, i);
        }
    }
}

static Span element_span(uint64_t base, size_t element)
{
    return (Span){base + element, base + element + 1};
}

static void report_bad(rt_session *session, const ArrayCheck *check, size_t element, uint64_t base)
{
    int k = 0;
    while (k < check->numbers - 1 && number_is_fine(check->rule, array_number(check->array, element, k))) {
        k++;
    }
    double number = array_number(check->array, element, k);
    char place[32] = "";
    if (check->numbers > 1) {
        snprintf(place, sizeof place, "number %d of ", k);
    }
    diag_report(&session->diags, DIAG_E0460, element_span(base, element), "%sthe %s must be %s, not %g", place,
                check->what, check->rule == ARRAY_NOT_NEGATIVE ? "0 or more, and finite" : "finite", number);
}

static bool check_one(rt_session *session, const ArrayCheck *check, size_t count, uint64_t base)
{
    Look look = {.check = check, .bad = SIZE_MAX, .bytes = SIZE_MAX};
    bool is_same = check->array->stride == 0;
    if (array_is_given(check->array) && count > 0) {
        parallel_share(session_load_threads(session), is_same ? 1 : count, SPHERE_RUN, look_work, &look);
    }
    if (look.bad != SIZE_MAX) {
        report_bad(session, check, look.bad, base);
        return false;
    }
    if (look.bytes != SIZE_MAX &&
        diag_report(&session->diags, DIAG_W0211, element_span(base, look.bytes), "this colour looks like bytes")) {
        diag_suggest(&session->diags, "components go from 0 to 1: divide by 255");
    }
    return session->diags.error_count == 0;
}

bool arrays_are_fine(rt_session *session, const ArrayCheck *checks, int check_count, size_t count, uint64_t base)
{
    bool is_fine = true;
    for (int i = 0; i < check_count; i++) {
        is_fine = check_one(session, &checks[i], count, base) && is_fine;
    }
    return is_fine;
}
