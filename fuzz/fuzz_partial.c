// Any bytes are a file of partial results, or none; what is taken of them is written again as the same bytes.
//
// A fuzzer hardly finds the checks of head and records: each file is tried as a head and records with right ones, too.
//
// SPDX-License-Identifier: MIT
#include <string.h>

#include "fuzz/fuzz.h"
#include "share/partial.h"

static void look_at(const uint8_t *data, size_t size)
{
    Partial partial;
    TextBuffer again;
    unsigned char *copy = malloc(size + 1);
    if (!copy) {
        return;
    }
    memcpy(copy, data, size);
    if (partial_take(&partial, copy, size) != PARTIAL_OK) {
        return;
    }
    text_init(&again);
    partial_append_head(&again, &partial.head);
    for (size_t i = 0; i < partial.records.count; i++) {
        partial_append(&again, &partial.records.items[i]);
    }
    FUZZ_HOLDS(again.failed || (again.length <= size && memcmp(again.text, data, again.length) == 0));
    int part, parts;
    FUZZ_HOLDS(!partial_head_part(&partial.head, &part, &parts) || (part >= 1 && part <= parts));
    text_fini(&again);
    partial_fini(&partial);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    PartialHead head = {{NULL}};
    TextBuffer sealed;
    bool is_whole = true;
    look_at(data, size);
    for (int i = 0; i < PARTIAL_FIELDS; i++) {
        is_whole = partial_head_set(&head, (PartialField)i, "1/2") && is_whole;
    }
    text_init(&sealed);
    if (is_whole) {
        partial_append_head(&sealed, &head);
    }
    for (size_t at = 0; is_whole && at + 9 <= size;) {
        size_t length = data[at + 8] < size - at - 9 ? data[at + 8] : size - at - 9;
        PartialRecord record = {.bytes = data + at + 9, .length = length};
        memcpy(&record.pass, data + at, 4);
        memcpy(&record.tile, data + at + 4, 4);
        partial_append(&sealed, &record);
        at += 9 + length;
    }
    if (is_whole && !sealed.failed) {
        look_at((const uint8_t *)sealed.text, sealed.length);
    }
    text_fini(&sealed);
    partial_head_fini(&head);
    return 0;
}
