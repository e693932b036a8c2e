// Makes the reserved words' symbols equal to their place in ast/words.def and gives their classes.
//
// Owns two constant tables made from that list. Knows nothing of what a word means.
//
// SPDX-License-Identifier: MIT
#include "ast/words.h"

#include <string.h>

static const char *const word_texts[WORD_COUNT] = {
    [WORD_NONE] = "",
#define WORD(name, class) [W_##name] = #name,
#include "ast/words.def"
#undef WORD
};

static const unsigned char word_classes[WORD_COUNT] = {
    [WORD_NONE] = WORD_IDENTIFIER,
#define WORD(name, class) [W_##name] = WORD_##class,
#include "ast/words.def"
#undef WORD
};

bool words_intern(InternTable *table)
{
    for (unsigned word = WORD_NONE + 1; word < WORD_COUNT; word++) {
        if (intern_text(table, word_texts[word], strlen(word_texts[word])) != word) {
            return false;
        }
    }
    return true;
}

WordClass word_class(Symbol symbol)
{
    return symbol < WORD_COUNT ? (WordClass)word_classes[symbol] : WORD_IDENTIFIER;
}
