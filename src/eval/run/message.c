// The text streams: what #debug, #render and #statistics say becomes lines as POV-Ray's console shows them.
//
// Owns the line that is not ended yet; a last line without its newline is never shown, as in POV-Ray. Knows nothing of
// values.
//
// SPDX-License-Identifier: MIT
#include <string.h>

#include "eval/values/characters.h"
#include "eval/run/run.h"

// Measured: a line of more than 80 bytes is broken before the last blank or tab at 61 to 80, which begins the next
// line; without one, after 80 bytes.
enum { LINE_BREAK_FIRST = 61, LINE_BREAK_LAST = 80 };

static size_t break_at(const char *text, size_t length)
{
    if (length <= LINE_BREAK_LAST) {
        return length;
    }
    for (size_t at = LINE_BREAK_LAST; at >= LINE_BREAK_FIRST; at--) {
        if (text[at] == ' ' || text[at] == '\t') {
            return at;
        }
    }
    return LINE_BREAK_LAST;
}

static void send(Eval *ev, EvalStream stream, const char *text, size_t length)
{
    ev->message_bytes += length;
    if (ev->options.message != NULL) {
        ev->options.message(ev->options.client, stream, text, length);
    }
}

static void send_line(Eval *ev, EvalStream stream, const char *text, size_t length)
{
    char line[LINE_BREAK_LAST + 1];
    do {
        size_t part = break_at(text, length);
        memcpy(line, text, part);
        line[part] = '\n';
        send(ev, stream, line, part + 1);
        text += part;
        length -= part;
    } while (length > 0);
}

static void fault_many(Eval *ev, uint64_t most, Span span)
{
    char bytes[LIMITS_BYTES_TEXT];
    limits_bytes_text(most, bytes);
    if (eval_report(ev, DIAG_E0609, span, "more than %s of messages", bytes)) {
        diag_suggest(ev->options.diags, "if all of them are wanted, `--max-messages` allows more");
    }
    ev->stop = true;
}

bool message_count_bytes(Eval *ev, size_t bytes, Span span)
{
    uint64_t most = ev->options.limits->message_bytes;
    if (ev->message_bytes + ev->line.length + bytes > most) {
        fault_many(ev, most, span);
        return false;
    }
    ev->message_bytes += bytes;
    return true;
}

void message_write(Eval *ev, EvalStream stream, const char *text, size_t length, Span span)
{
    uint64_t most = ev->options.limits->message_bytes;
    size_t bytes;
    for (const char *at = text; at < text + length; at += bytes) {
        if (ev->message_bytes + ev->line.length >= most) {
            fault_many(ev, most, span);
            return;
        }
        unsigned code = character_at(at, text + length, &bytes);
        if (ev->line.failed) {
            eval_no_memory(ev, span);
            return;
        }
        if (code == '\n') {
            send_line(ev, stream, text_get(&ev->line), ev->line.length);
            text_clear(&ev->line);
        } else {
            // The console shows other characters than ASCII, and zeros, as blanks.
            text_append_char(&ev->line, code >= 0x80 || code == 0 ? ' ' : (char)code);
        }
    }
    if (ev->line.failed) {
        eval_no_memory(ev, span);
    }
}
