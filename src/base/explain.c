// Explanations: the texts of base/diag_texts.def, laid out for a terminal or as Markdown.
//
// Turns a code into text. Owns the table of texts, which is constant. Knows nothing of single messages.
//
// SPDX-License-Identifier: MIT
#include "base/explain.h"

#include <string.h>
#include <strings.h>

enum { TERMINAL_COLUMNS = 80, DOCUMENT_COLUMNS = 120 };

typedef struct Explanation {
    const char *wrong; // a scene, or in words
    const char *right; // the scene corrected; NULL when `wrong` is no scene
    const char *text;
} Explanation;

static const Explanation explanations[DIAG_CODE_COUNT] = {
#define TEXT(code, wrong, right, text) [DIAG_##code] = {wrong, right, text},
#define SITUATION(code, example, text) [DIAG_##code] = {example, NULL, text},
#include "base/diag_texts.def"
#undef TEXT
#undef SITUATION
};

bool explain_find(const char *name, DiagCode *code)
{
    for (int i = 0; i < DIAG_CODE_COUNT; i++) {
        if (strcasecmp(name, diag_code_name((DiagCode)i)) == 0) {
            *code = (DiagCode)i;
            return true;
        }
    }
    return false;
}

static const char *severity_name(DiagCode code)
{
    return diag_code_severity(code) == DIAG_ERROR ? "error" : "warning";
}

void explain_write(DiagCode code, TextBuffer *out)
{
    const Explanation *explanation = &explanations[code];
    text_printf(out, "%s: %s (%s, exit code %d%s)\n\n", diag_code_name(code), diag_code_summary(code),
                severity_name(code), (int)diag_code_class(code), diag_code_is_extra(code) ? ", with -Wall only" : "");
    if (explanation->right) {
        text_printf(out, "    wrong: %s\n    right: %s\n\n", explanation->wrong, explanation->right);
    } else {
        text_printf(out, "    for example: %s\n\n", explanation->wrong);
    }
    text_append_wrapped(out, explanation->text, 0, 0, TERMINAL_COLUMNS);
}

static void append_section(TextBuffer *out, DiagCode code)
{
    const Explanation *explanation = &explanations[code];
    text_printf(out, "### %s: %s\n\n", diag_code_name(code), diag_code_summary(code));
    size_t start = out->length;
    text_printf(out, "*%s, exit code %d%s.*", severity_name(code), (int)diag_code_class(code),
                diag_code_is_extra(code) ? ", with `-Wall` only" : "");
    text_append_char(out, ' ');
    text_append_wrapped(out, explanation->text, out->length - start, 0, DOCUMENT_COLUMNS);
    text_append_char(out, '\n');
    if (explanation->right) {
        text_printf(out, "```\nwrong: %s\nright: %s\n```\n\n", explanation->wrong, explanation->right);
    } else {
        text_printf(out, "For example: %s.\n\n", explanation->wrong);
    }
}

void explain_write_reference(TextBuffer *out)
{
    static const char *const groups[] = {"Text and syntax", "Names and types",     "Values",
                                         "The scene as a whole", "Files", "Limits", "Command line"};
    for (size_t group = 0; group < RT_COUNT_OF(groups); group++) {
        text_printf(out, "## %s\n\n", groups[group]);
        for (int code = 0; code < DIAG_CODE_COUNT; code++) {
            if (diag_code_name((DiagCode)code)[2] == (char)('1' + group)) {
                append_section(out, (DiagCode)code);
            }
        }
    }
}
