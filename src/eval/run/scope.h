// How names are kept, for those who look one up at every turn of a loop. What may be done with them is in run.h.
//
// SPDX-License-Identifier: MIT
#ifndef EVAL_SCOPE_H
#define EVAL_SCOPE_H

#include "eval/run/run.h"

typedef struct Binding Binding;
struct Binding {
    Value own;         // the first member, see scope.c
    Value *variable;   // &own, or what a parameter by reference stands for
    ValueArray *array; // of which the variable is an element, or NULL
    Binding *hidden;   // the meaning of the same name further out
    Binding *next;     // in the same level
    Symbol name;       // SYMBOL_NONE after #undef
    uint32_t level;    // 0: global
    bool is_given;     // by the scene, not before it
    bool is_used;      // it was looked for since
    bool is_retired;   // what `own` owns, see values/kept.h
    bool is_counted;   // as a reference, by the array or by the binding that it stands for
    unsigned reference_count;
};

typedef struct Level {
    ArenaMark mark;
    Binding *locals;
} Level;

struct Scope {
    Arena arena; // of locals
    ARRAY(Binding *) innermost;
    ARRAY(Level) levels; // level n is items[n - 1]
    uint64_t looked_at;  // names, for suggestions
    Binding *undefined;  // globals whose own values are not given back yet
    Binding *spare;      // others of them, for reuse
};

// The innermost meaning of a name, or NULL. This is not a use of it.
static inline Binding *scope_binding(const Eval *ev, Symbol name)
{
    return name < ev->scope->innermost.count ? ev->scope->innermost.items[name] : NULL;
}

// As scope_find.
static inline Value *scope_look(const Eval *ev, Symbol name)
{
    Binding *binding = scope_binding(ev, name);
    if (RT_UNLIKELY(binding == NULL)) {
        return NULL;
    }
    binding->is_used = true;
    return binding->variable;
}

// The variable of a name that is a number, which another number may take the place of by itself: not an element of an array; else NULL.
static inline Value *scope_number(const Binding *binding)
{
    bool is_plain = binding != NULL && binding->array == NULL && binding->variable->kind == VALUE_NUMBER;
    return is_plain ? binding->variable : NULL;
}

#endif
