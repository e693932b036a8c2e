// The language's words for editors: the schema's, and the functions, constants and colour words.
//
// SPDX-License-Identifier: MIT
#include "ast/words.h"
#include "base/attributes.h"
#include "rtlang/rtlang.h"
#include "scene/schema.h"

static const struct {
    const char *word;
    WordClass class;
} reserved[] = {
#define WORD(name, class) {#name, WORD_##class},
#include "ast/words.def"
#undef WORD
};

static const char *class_doc(WordClass class)
{
    return class == WORD_BUILTIN    ? "a function"
           : class == WORD_CONSTANT ? "a value"
           : class == WORD_COLOUR   ? "of a colour"
           : class == WORD_ARRAY    ? "an array of values"
           : class == WORD_FUNCTION ? "a function of the scene's own"
                                    : NULL;
}

int rt_get_word(size_t i, rt_word *word)
{
    for (int kind = KIND_NONE + 1; kind < KIND_UNSUPPORTED; kind++) {
        const SchemaBlock *block = schema_kind((SchemaKind)kind);
        const SchemaProperty *property;
        if (i == 0) {
            *word = (rt_word){block->word, "", block->doc};
            return 1;
        }
        i--;
        for (size_t k = 0; (property = schema_property((SchemaKind)kind, k)); k++, i--) {
            if (i == 0) {
                *word = (rt_word){property->word, block->word, property->doc};
                return 1;
            }
        }
    }
    for (size_t k = 0; k < RT_COUNT_OF(reserved); k++) {
        const char *doc = class_doc(reserved[k].class);
        if (doc && i-- == 0) {
            *word = (rt_word){reserved[k].word, "", doc};
            return 1;
        }
    }
    return 0;
}
