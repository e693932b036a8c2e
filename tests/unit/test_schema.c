// The schema's tables: every word is a reserved word of the language, every offset lies inside its description,
// defaults are in range, and no kind has a word twice.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "ast/words.h"
#include "scene/description.h"
#include "tap.h"

static const size_t type_sizes[] = {
    [TYPE_FLAG] = sizeof(bool),
    [TYPE_SWITCH] = sizeof(bool),
    [TYPE_NUMBER] = sizeof(double),
    [TYPE_OPTIONAL_NUMBER] = sizeof(double),
    [TYPE_SHARE] = sizeof(double),
    [TYPE_SHARE_PAIR] = 2 * sizeof(double),
    [TYPE_INTEGER] = sizeof(int),
    [TYPE_VECTOR] = sizeof(Vec3),
    [TYPE_COLOUR] = sizeof(Rgbft),
    [TYPE_RGB] = sizeof(Rgb),
    [TYPE_BLOCK] = 0,
    [TYPE_ACTION] = 0,
};

static bool is_reserved(InternTable *names, const char *word)
{
    Symbol symbol = intern_find(names, word, strlen(word));
    return symbol != SYMBOL_NONE && symbol < WORD_COUNT;
}

static bool default_is_in_range(const SchemaBlock *kind, const SchemaProperty *property)
{
    double number;
    if (property->type == TYPE_INTEGER) {
        int integer;
        memcpy(&integer, (const char *)kind->defaults + property->at, sizeof integer);
        number = integer;
    } else {
        memcpy(&number, (const char *)kind->defaults + property->at, sizeof number);
    }
    const SchemaRange *range = &property->range;
    return (range->low_is_open ? number > range->low : number >= range->low) && number <= range->high;
}

static void check_property(const SchemaBlock *kind, const SchemaProperty *property)
{
    tap_ok(property->at + type_sizes[property->type] <= kind->size && property->given < kind->size,
           "%s.%s lies inside its description", kind->word, property->word);
    tap_ok((property->type == TYPE_ACTION || property->type == TYPE_BLOCK) == (property->action != ACTION_NONE),
           "%s.%s has an action exactly if its type needs one", kind->word, property->word);
    tap_ok(property->doc && property->doc[0], "%s.%s is explained", kind->word, property->word);
    if (property->range.policy != RANGE_ANY) {
        tap_ok(default_is_in_range(kind, property), "%s.%s: the default is in range", kind->word, property->word);
    }
}

static void check_kind(InternTable *names, SchemaKind index)
{
    const SchemaBlock *kind = schema_kind(index);
    const SchemaProperty *property, *other;
    tap_ok(is_reserved(names, kind->word), "`%s` is a reserved word", kind->word);
    tap_ok(kind->size <= sizeof(Desc) && kind->defaults, "%s fits a Desc", kind->word);
    for (size_t i = 0; i < kind->arguments.count; i++) {
        check_property(kind, &kind->arguments.items[i]);
    }
    for (size_t i = 0; (property = schema_property(index, i)); i++) {
        bool is_single = true;
        for (size_t j = 0; j < i && (other = schema_property(index, j)); j++) {
            is_single = is_single && strcmp(property->word, other->word) != 0;
        }
        tap_ok(is_single && is_reserved(names, property->word), "%s.%s is a reserved word, once", kind->word,
               property->word);
        check_property(kind, property);
    }
}

static void check_unsupported(InternTable *names)
{
    const SchemaUnsupported *entry;
    for (size_t i = 0; (entry = schema_unsupported(i)); i++) {
        bool is_supported = false;
        for (size_t kind = KIND_NONE + 1; entry->is_kind && kind < KIND_UNSUPPORTED; kind++) {
            is_supported = is_supported || strcmp(entry->word, schema_kind((SchemaKind)kind)->word) == 0;
        }
        tap_ok(is_reserved(names, entry->word) && !is_supported, "`%s` is reserved and not supported", entry->word);
    }
}

static void check_reference(void)
{
    TextBuffer out;
    text_init(&out);
    schema_write_reference(&out);
    tap_ok(!out.failed && strstr(text_get(&out), "### camera") &&
               strstr(text_get(&out), "| `location` | vector | <0, 0, 0> |"),
           "the reference has the camera's location with its default");
    tap_ok(strstr(text_get(&out), "| `ambient` | colour, rgb | <0.1, 0.1, 0.1> |") != NULL,
           "single precision defaults are written short");
    text_fini(&out);
}

int main(void)
{
    InternTable *names = intern_new(1 << 20);
    if (!names || !words_intern(names)) {
        return 1;
    }
    for (size_t kind = KIND_NONE + 1; kind < KIND_UNSUPPORTED; kind++) {
        check_kind(names, (SchemaKind)kind);
    }
    check_unsupported(names);
    check_reference();
    intern_free(names);
    return tap_done();
}
