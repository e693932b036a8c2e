// Storage of texts and arrays that variables own: taken from lists of free blocks, given back when the variable gets
// another value or ends.
//
// Each variable and each element of an array owns its storage alone. What is replaced may still be seen by an
// expression that is being computed, so it is retired first and given back where nothing can see it any more: between
// two items of a cursor. An outer expression may see what was stored before that cursor was opened only, hence `since`.
// An array one of whose elements is a macro's parameter waits until the call ends.
//
// SPDX-License-Identifier: MIT
#ifndef EVAL_VALUES_KEPT_H
#define EVAL_VALUES_KEPT_H

#include "eval/values/value.h"

// Room for so many bytes, or NULL. `is_array`: a ValueArray begins there, whose elements are given back with it.
void *kept_take(Eval *ev, size_t size, bool is_array) RT_MUST_CHECK;

static inline bool kept_is_owned(const Value *value)
{
    return value->kind == VALUE_STRING || value->kind == VALUE_ARRAY;
}

// Those of a value that owns storage: at once, where nobody can see it, or as soon as it is known that nobody does.
void kept_give_back(Eval *ev, const Value *value);
void kept_retire(Eval *ev, const Value *value);

// A variable's value, which another one takes the place of.
static inline void kept_replace(Eval *ev, Value *variable, const Value *value)
{
    Value old = *variable;
    *variable = *value;
    if (RT_UNLIKELY(kept_is_owned(&old))) {
        kept_retire(ev, &old);
    }
}

// Whether enough is retired for a look at it to be worth its time.
static inline bool kept_is_due(const Eval *ev)
{
    return ev->kept.retired_bytes > ev->kept.settle_at;
}

// Gives back what was retired and stored later than number `since`.
void kept_settle(Eval *ev, uint64_t since);
void kept_init(Eval *ev);
void kept_fini(Eval *ev);

#endif
