// A line holds switches, names of files, or at last one `Key = value`, as POV-Ray's do; a word of the command line is
// read as a line is. A file's lines before its first [section] always count, those of a section where it is selected.
//
// SPDX-License-Identifier: MIT
#include "cli/povray_read.h"

#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "base/attributes.h"
#include "cli/povray_text.h"
#include "cli/terminal.h"

enum { INI_BYTES_MOST = 1 << 20 };

void povray_settings_init(PovraySettings *settings)
{
    *settings = (PovraySettings){.width = 160, .height = 120, .has_output = true, .type = 'N', .bits = 8, .method = 1,
                                 .depth = 3, .threshold = 0.3, .antialias_gamma = 2.5, .quality = 9, .clock = NAN,
                                 .end_column = -1.0, .end_row = -1.0,
                                 .initial_frame = 1, .final_frame = -1, .frame_step = 1, .final_clock = 1.0,
                                 .warning_level = 10};
    for (int i = 0; i < POVRAY_STREAMS; i++) {
        settings->consoles[i] = true;
    }
}

void povray_settings_fini(PovraySettings *settings)
{
    for (size_t i = 0; i < settings->text_count; i++) {
        free(settings->texts[i]);
    }
    free(settings->texts);
    free(settings->libraries);
    free(settings->declarations);
}

bool povray_find(const PovraySettings *settings, const char *name, char *path, size_t size)
{
    bool is_found = snprintf(path, size, "%s", name) < (int)size && access(path, F_OK) == 0;
    for (size_t i = 0; !is_found && name[0] != '/' && i < settings->library_count; i++) {
        is_found = snprintf(path, size, "%s/%s", settings->libraries[i], name) < (int)size && access(path, F_OK) == 0;
    }
    return is_found;
}

// ---- a line

static size_t skip_blanks(const char *text, PovraySpan line)
{
    size_t at = line.begin;
    while (at < line.end && isspace((unsigned char)text[at])) {
        at++;
    }
    return at;
}

// Past a quoted part, if it ends within the line; a lone quote is a character as others are.
static size_t skip_quoted(const char *text, size_t at, size_t end)
{
    const char *close = memchr(text + at + 1, text[at], end - at - 1);
    return close ? (size_t)(close - text) + 1 : at + 1;
}

// Where a comment begins, or the end.
static size_t find_comment(const char *text, PovraySpan line)
{
    size_t at = line.begin;
    while (at < line.end && text[at] != ';') {
        at = text[at] == '"' || text[at] == '\'' ? skip_quoted(text, at, line.end) : at + 1;
    }
    return at;
}

// The end of a word: at a blank that is neither quoted nor in brackets.
static size_t find_word_end(const char *text, PovraySpan line)
{
    size_t at = line.begin;
    while (at < line.end && !isspace((unsigned char)text[at])) {
        const char *close = text[at] == '[' ? memchr(text + at, ']', line.end - at) : NULL;
        at = text[at] == '"' || text[at] == '\'' ? skip_quoted(text, at, line.end)
             : close                             ? (size_t)(close - text) + 1
                                                 : at + 1;
    }
    return at;
}

static bool is_of_key(char c)
{
    return isalnum((unsigned char)c) || c == '_';
}

// `Key =`: where the key ends, or its beginning when there is none; *equals is where the sign stands.
static size_t find_key_end(const char *text, PovraySpan line, size_t *equals)
{
    size_t at = line.begin;
    while (at < line.end && is_of_key(text[at])) {
        at++;
    }
    *equals = skip_blanks(text, (PovraySpan){at, line.end});
    return at > line.begin && *equals < line.end && text[*equals] == '=' ? at : line.begin;
}

static rt_status fault_unknown(const PovrayText *text, PovraySpan span)
{
    const char *names[POVRAY_ROWS_MOST];
    char word[48], advice[POVRAY_ADVICE] = "";
    size_t count = 0, length = span.end - span.begin;
    for (const PovrayRow *row; (row = povray_row(count)); count++) {
        names[count] = row->key;
    }
    names[count] = NULL;
    bool is_switch = text->text[span.begin] == '+' || text->text[span.begin] == '-';
    snprintf(word, sizeof word, "%.*s", (int)(length < 47 ? length : 47), text->text + span.begin);
    if (!is_switch) {
        advise_value(word, names, advice, sizeof advice);
    }
    return povray_fault(text, "E0704", span, advice[0] ? advice : "rtlang --help=povray lists them",
                        "POV-Ray has no %s `%s`", is_switch ? "switch" : "option", word);
}

static rt_status read_key(const PovrayText *text, PovraySpan key, PovraySpan value)
{
    const PovrayRow *row = povray_row_of_key(text->text + key.begin, key.end - key.begin);
    value.begin = skip_blanks(text->text, value);
    while (value.end > value.begin && isspace((unsigned char)text->text[value.end - 1])) {
        value.end--;
    }
    return row ? povray_set(text, row, key, value) : fault_unknown(text, key);
}

// The row whose letters are the longest beginning of a switch behind its sign.
static const PovrayRow *find_switch(const char *letters, size_t length)
{
    const PovrayRow *row, *best = NULL;
    for (size_t i = 0; (row = povray_row(i)); i++) {
        size_t own = row->letters ? strlen(row->letters) : length + 1;
        if (own <= length && strncasecmp(row->letters, letters, own) == 0 &&
            (!best || own > strlen(best->letters))) {
            best = row;
        }
    }
    return best;
}

// What follows +F: a letter, and the bits.
static rt_status read_type(const PovrayText *text, PovraySpan value)
{
    static const char type[] = "Output_File_Type", bits[] = "Bits_Per_Color", grey[] = "Grayscale_Output";
    PovraySpan letter = {value.begin, value.begin + 1}, rest = {value.begin + 1, value.end};
    rt_status status = povray_set(text, povray_row_of_key(type, sizeof type - 1), letter, letter);
    if (status || rest.begin == rest.end) {
        return status;
    }
    if (tolower((unsigned char)text->text[rest.end - 1]) == 'g') {
        return povray_set_flag(text, povray_row_of_key(grey, sizeof grey - 1), rest, true);
    }
    // Only these two have a choice; for the others POV-Ray takes the number and forgets it.
    bool has_depths = text->settings->type == 'N' || text->settings->type == 'P';
    return has_depths ? povray_set(text, povray_row_of_key(bits, sizeof bits - 1), rest, rest) : RT_OK;
}

static rt_status read_switch(const PovrayText *text, PovraySpan word)
{
    bool on = text->text[word.begin] == '+';
    const PovrayRow *row = find_switch(text->text + word.begin + 1, word.end - word.begin - 1);
    if (!row) {
        return fault_unknown(text, word);
    }
    PovraySpan value = {word.begin + 1 + strlen(row->letters), word.end};
    bool has_value = value.begin < value.end;
    if (row->kind != POVRAY_BOOL && row->kind != POVRAY_ALL_ON) {
        return povray_set(text, row, word, value);
    }
    if (has_value && !row->value_key) {
        return fault_unknown(text, word);
    }
    rt_status status = povray_set_flag(text, row, word, on);
    if (status || !has_value) {
        return status;
    }
    if (strcmp(row->letters, "F") == 0) {
        return read_type(text, value);
    }
    return povray_set(text, povray_row_of_key(row->value_key, strlen(row->value_key)), value, value);
}

static bool ends_with(const char *text, PovraySpan word, const char *ending)
{
    size_t length = strlen(ending);
    return word.end - word.begin >= length && strncasecmp(text + word.end - length, ending, length) == 0;
}

// The name of a file: of options when it ends so, has a section, or is found with that ending; else of a scene.
static rt_status read_name(const PovrayText *text, PovraySpan word)
{
    static const char input[] = "Input_File_Name";
    const char *begin = text->text + word.begin, *slash = begin;
    for (size_t i = word.begin; i < word.end; i++) {
        slash = text->text[i] == '/' ? text->text + i : slash;
    }
    bool has_ending = memchr(slash, '.', (size_t)(text->text + word.end - slash)) != NULL;
    if (ends_with(text->text, word, ".ini") || ends_with(text->text, word, "]") || !has_ending) {
        return povray_read_file(text, word);
    }
    return povray_set(text, povray_row_of_key(input, sizeof input - 1), word, word);
}

static rt_status read_line(const PovrayText *text, PovraySpan line)
{
    rt_status status = RT_OK;
    line.end = find_comment(text->text, line);
    while (!status && (line.begin = skip_blanks(text->text, line)) < line.end) {
        size_t equals, key_end = find_key_end(text->text, line, &equals);
        if (key_end > line.begin) {
            return read_key(text, (PovraySpan){line.begin, key_end}, (PovraySpan){equals + 1, line.end});
        }
        PovraySpan word = {line.begin, find_word_end(text->text, line)};
        bool is_switch = text->text[word.begin] == '+' || text->text[word.begin] == '-';
        status = is_switch ? read_switch(text, word) : read_name(text, word);
        line.begin = word.end;
    }
    return status;
}

// ---- a file

static char *read_whole(const char *path)
{
    FILE *file = fopen(path, "re");
    char *text = file ? malloc(INI_BYTES_MOST + 1) : NULL;
    size_t length = text ? fread(text, 1, INI_BYTES_MOST + 1, file) : 0;
    bool fine = text && !ferror(file) && length <= INI_BYTES_MOST;
    errno = text && length > INI_BYTES_MOST ? EFBIG : errno;
    if (fine && memchr(text, '\0', length)) { // no text, of which the rest would be left out
        errno = EINVAL;
        fine = false;
    }
    if (file) {
        (void)fclose(file);
    }
    if (!fine) {
        free(text);
        return NULL;
    }
    text[length] = '\0';
    return text;
}

// A line that is `[label]`; *is_wanted says whether it is the section's.
static bool is_label(const char *text, PovraySpan line, const char *section, bool *is_wanted)
{
    size_t begin = skip_blanks(text, line);
    if (begin == line.end || text[begin] != '[') {
        return false;
    }
    const char *close = memchr(text + begin, ']', line.end - begin);
    PovraySpan label = {begin + 1, close ? (size_t)(close - text) : line.end};
    label.begin = skip_blanks(text, label);
    while (label.end > label.begin && isspace((unsigned char)text[label.end - 1])) {
        label.end--;
    }
    *is_wanted = section && strlen(section) == label.end - label.begin &&
                 strncasecmp(section, text + label.begin, label.end - label.begin) == 0;
    return true;
}

static rt_status read_lines(const PovrayText *text, const char *section, bool *has_section)
{
    bool is_wanted = true;
    rt_status status = RT_OK;
    PovraySpan line = {0, 0};
    for (; !status && text->text[line.begin]; line.begin = line.end + (text->text[line.end] == '\n')) {
        line.end = line.begin + strcspn(text->text + line.begin, "\n");
        size_t first = skip_blanks(text->text, line);
        if (is_label(text->text, line, section, &is_wanted)) {
            *has_section = *has_section || is_wanted;
        } else if (is_wanted && text->text[first] != '#') {
            status = read_line(text, line);
        }
    }
    return status;
}

static bool is_open(const PovrayText *text, const char *path)
{
    for (; text; text = text->outer) {
        if (text->path && strcmp(text->path, path) == 0) {
            return true;
        }
    }
    return false;
}

// The file itself; `text` has its name, and whose it is.
static rt_status read_text(PovrayText *text, const char *section, PovraySpan place)
{
    char real[PATH_MAX], *content = read_whole(text->name);
    if (!content || !realpath(text->name, real)) {
        rt_status status = povray_fault(text->outer, "E0502", place, NULL, "cannot read `%s`: %s", text->name,
                                        strerror(errno));
        free(content);
        return status;
    }
    if (is_open(text->outer, real)) {
        free(content);
        return povray_fault(text->outer, "E0707", place, NULL, "`%s` is being read already: it names itself",
                            text->name);
    }
    bool has_section = false;
    text->text = content;
    text->path = real;
    rt_status status = read_lines(text, section, &has_section);
    if (!status && section && !has_section) {
        (void)povray_fault(text->outer, "W0702", place, NULL, "`%s` has no section `%s`", text->name, section);
    }
    free(content);
    return status;
}

rt_status povray_read_file(const PovrayText *outer, PovraySpan span)
{
    const char *name = povray_keep(outer, span);
    char *file = name ? strdup(name) : NULL, path[PATH_MAX], with_ending[PATH_MAX];
    if (!file) {
        return rt_report(outer->session, "E0602", "out of memory reading options", NULL);
    }
    char *section = strchr(file, '['), *close = strrchr(file, ']');
    if (section && close > section) {
        *section++ = '\0';
        *close = '\0';
    }
    snprintf(with_ending, sizeof with_ending, "%s.ini", file);
    const char *dot = strrchr(file, '.');
    bool has_ending = dot && !strchr(dot, '/');
    rt_status status;
    if (povray_find(outer->settings, has_ending ? file : with_ending, path, sizeof path)) {
        PovrayText text = {.session = outer->session, .settings = outer->settings, .name = path, .outer = outer};
        status = read_text(&text, section, span);
    } else {
        status = povray_fault(outer, "E0501", span, has_ending ? NULL : "a scene is named with its ending, or by +I",
                              "`%s` not found", has_ending ? file : with_ending);
    }
    free(file);
    return status;
}

// ---- what is read before the command line

static bool is_there(char *path, size_t size, const char *folder, const char *name)
{
    return folder && folder[0] && snprintf(path, size, "%s%s", folder, name) < (int)size && access(path, R_OK) == 0;
}

// The first of POV-Ray's places; false when there is none. A folder `.` is the current one.
static bool find_povray_ini(char *path, size_t size, bool *is_unnamed)
{
    const char *home = getenv("HOME");
    const struct {
        const char *folder, *name;
    } places[] = {{home, "/.povray/3.7/povray.ini"}, {"/usr/local", "/etc/povray/3.7/povray.ini"},
                  {"/etc", "/povray/3.7/povray.ini"}, {home, "/.povrayrc"}, {"/usr/local", "/etc/povray.ini"},
                  {"/etc", "/povray.ini"}};
    *is_unnamed = false;
    if (is_there(path, size, getenv("POVINI"), "")) {
        return true;
    }
    *is_unnamed = is_there(path, size, ".", "/povray.ini");
    bool is_found = *is_unnamed;
    for (size_t i = 0; !is_found && i < RT_COUNT_OF(places); i++) {
        is_found = is_there(path, size, places[i].folder, places[i].name);
    }
    return is_found;
}

static rt_status read_povray_ini(const PovrayText *outer)
{
    char path[PATH_MAX];
    bool is_unnamed;
    if (!find_povray_ini(path, sizeof path, &is_unnamed)) {
        return RT_OK;
    }
    PovrayText text = {.session = outer->session, .settings = outer->settings, .name = path, .outer = outer,
                       .is_usual = !is_unnamed, .is_unnamed = is_unnamed};
    return read_text(&text, NULL, (PovraySpan){0, 0});
}

rt_status povray_read(rt_session *session, PovraySettings *settings, char **words, size_t count)
{
    size_t length = 1, at = 0;
    for (size_t i = 0; i < count; i++) {
        length += strlen(words[i]) + 1;
    }
    char *joined = calloc(length, 1);
    if (!joined) {
        return rt_report(session, "E0602", "out of memory reading options", NULL);
    }
    for (size_t i = 0; i < count; i++) {
        at += (size_t)sprintf(joined + at, "%s%s", i > 0 ? " " : "", words[i]);
    }
    PovrayText text = {.session = session, .settings = settings, .name = "command line", .text = joined};
    rt_status status = read_povray_ini(&text);
    at = 0;
    for (size_t i = 0; !status && i < count; i++) {
        PovraySpan word = {at, at + strlen(words[i])};
        status = read_line(&text, word);
        at = word.end + 1;
    }
    free(joined);
    return status;
}
