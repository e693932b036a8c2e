// The schema as Markdown: a table for each kind of block, and the groups that kinds share.
//
// Turns the tables of schema.c into the reference in docs/language.md. Knows nothing of what a property means.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "base/attributes.h"
#include "scene/schema.h"

static const char *const type_names[] = {
    [TYPE_FLAG] = "alone",
    [TYPE_SWITCH] = "alone, or a truth value",
    [TYPE_NUMBER] = "number",
    [TYPE_OPTIONAL_NUMBER] = "alone, or a number",
    [TYPE_SHARE] = "[`albedo`] number",
    [TYPE_SHARE_PAIR] = "[`albedo`] number [, number]",
    [TYPE_INTEGER] = "whole number",
    [TYPE_VECTOR] = "vector",
    [TYPE_NUMBERS] = "`<…>`",
    [TYPE_COLOUR] = "colour",
    [TYPE_RGB] = "colour, rgb",
    [TYPE_BLOCK] = "`{ … }`",
    [TYPE_ACTION] = "see right",
};

// A default as it is written: the shortest number that is the same in the precision the description has.
static void write_numbers(TextBuffer *out, const double *numbers, size_t count, bool is_single)
{
    text_append(out, count > 1 ? "<" : "");
    for (size_t i = 0; i < count; i++) {
        text_append(out, i ? ", " : "");
        if (is_single) {
            text_printf(out, "%.7g", numbers[i]);
        } else {
            text_append_double(out, numbers[i]);
        }
    }
    text_append(out, count > 1 ? ">" : "");
}

static void write_default(TextBuffer *out, const SchemaBlock *kind, const SchemaProperty *property)
{
    const char *at = (const char *)kind->defaults + property->at;
    double numbers[5];
    bool flag;
    int integer;
    switch (property->type) {
    case TYPE_FLAG:
    case TYPE_SWITCH:
        memcpy(&flag, at, sizeof flag);
        text_append(out, flag ? "on" : "off");
        break;
    case TYPE_NUMBER:
    case TYPE_OPTIONAL_NUMBER:
    case TYPE_SHARE:
    case TYPE_SHARE_PAIR:
        memcpy(numbers, at, sizeof *numbers);
        write_numbers(out, numbers, 1, false);
        break;
    case TYPE_INTEGER:
        memcpy(&integer, at, sizeof integer);
        text_printf(out, "%d", integer);
        break;
    case TYPE_VECTOR:
        memcpy(numbers, at, 3 * sizeof *numbers);
        write_numbers(out, numbers, 3, false);
        break;
    case TYPE_RGB:
        memcpy(numbers, at, 3 * sizeof *numbers);
        write_numbers(out, numbers, 3, true);
        break;
    case TYPE_COLOUR:
        memcpy(numbers, at, 5 * sizeof *numbers);
        write_numbers(out, numbers, 5, true);
        break;
    case TYPE_NUMBERS:
    case TYPE_BLOCK:
    case TYPE_ACTION: break;
    }
}

static void write_range(TextBuffer *out, const SchemaRange *range)
{
    static const char *const policies[] = {
        [RANGE_ANY] = "", [RANGE_FAULT] = "error", [RANGE_WARN] = "warning", [RANGE_CLAMP] = "warning, nearest",
        [RANGE_RAISE] = "below: warning, nearest; above: error"};
    if (range->policy == RANGE_ANY) {
        return;
    }
    bool has_low = isfinite(range->low);
    if (has_low) {
        text_append(out, range->low_is_open ? "> " : ">= ");
        text_append_double(out, range->low);
    }
    if (isfinite(range->high)) {
        text_append(out, has_low ? ", <= " : "<= ");
        text_append_double(out, range->high);
    }
    text_printf(out, " (else %s)", policies[range->policy]);
}

static void write_row(TextBuffer *out, const SchemaBlock *kind, const SchemaProperty *property, bool is_argument)
{
    text_printf(out, is_argument ? "| *%s* | %s | " : "| `%s` | %s | ", property->word, type_names[property->type]);
    if (!is_argument) {
        write_default(out, kind, property);
    } else {
        text_append(out, property->is_optional ? "may be left out" : "needed");
    }
    text_append(out, " | ");
    write_range(out, &property->range);
    text_printf(out, " | %s%s |\n", property->is_first ? "stands first; " : "", property->doc);
}

// The groups that kinds share.
static const SchemaList *transforms(void)
{
    return &schema_kind(KIND_TRANSFORM)->groups[1];
}

static const SchemaList *object_modifiers(void)
{
    return &schema_kind(KIND_OBJECT)->groups[0];
}

static const SchemaList *patterns(void)
{
    return &schema_kind(KIND_PIGMENT)->groups[1];
}

static bool is_shared(const SchemaList *list)
{
    return list->items == transforms()->items || list->items == object_modifiers()->items ||
           list->items == patterns()->items;
}

// What a kind takes of the shared groups, on a line of their own. Returns what parts it from the next one.
static const char *append_takes(TextBuffer *out, const char *between, const char *group)
{
    text_printf(out, "%sTakes %s.", between, group);
    return " ";
}

static void write_kind(TextBuffer *out, const SchemaBlock *kind)
{
    text_printf(out, "### %s%s%s\n\n%s", kind->word, kind->inside ? " in " : "", kind->inside ? kind->inside : "",
                kind->doc);
    const char *between = "\n";
    for (size_t i = 0; i < SCHEMA_GROUPS; i++) {
        if (kind->groups[i].items == object_modifiers()->items) {
            between = append_takes(out, between, "object modifiers");
        } else if (kind->groups[i].items == patterns()->items) {
            between = append_takes(out, between, "patterns");
        } else if (kind->groups[i].items == transforms()->items) {
            between = append_takes(out, between, "transforms");
        }
    }
    text_append(out, "\n\n");
    size_t own = is_shared(&kind->groups[0]) ? 0 : kind->groups[0].count;
    if (kind->arguments.count + own == 0) {
        return;
    }
    text_append(out, "| word | takes | default | range | |\n|---|---|---|---|---|\n");
    for (size_t i = 0; i < kind->arguments.count; i++) {
        write_row(out, kind, &kind->arguments.items[i], true);
    }
    for (size_t i = 0; i < own; i++) {
        write_row(out, kind, &kind->groups[0].items[i], false);
    }
    text_append(out, "\n");
}

static void write_group(TextBuffer *out, const char *title, const SchemaList *list)
{
    text_printf(out, "### %s\n\n| word | |\n|---|---|\n", title);
    for (size_t i = 0; i < list->count; i++) {
        text_printf(out, "| `%s` | %s |\n", list->items[i].word, list->items[i].doc);
    }
    text_append(out, "\n");
}

void schema_write_reference(TextBuffer *out)
{
    for (size_t kind = KIND_NONE + 1; kind < KIND_UNSUPPORTED; kind++) {
        write_kind(out, schema_kind((SchemaKind)kind));
    }
    write_group(out, "Object modifiers", object_modifiers());
    write_group(out, "Patterns", patterns());
    write_group(out, "Transforms", transforms());
}
