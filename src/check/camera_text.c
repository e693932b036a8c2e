// Finds the cameras of a scene's text: the word, a brace, and the brace that closes it.
//
// SPDX-License-Identifier: MIT
#include "check/camera_text.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

// What was read of a text so far.
typedef struct Walk {
    FILE *in, *out;
    int depth;     // of braces
    int camera_at; // the depth of the camera that is open, or -1
    bool is_named; // the last word was `camera`, and nothing has followed
} Walk;

static int copy_one(Walk *walk)
{
    int c = fgetc(walk->in);

    if (c != EOF) {
        fputc(c, walk->out);
    }
    return c;
}

static int peek(Walk *walk)
{
    int c = fgetc(walk->in);

    if (c != EOF) {
        ungetc(c, walk->in);
    }
    return c;
}

static void copy_string(Walk *walk)
{
    int c;

    while ((c = copy_one(walk)) != EOF && c != '"') {
        if (c == '\\') {
            copy_one(walk);
        }
    }
}

static void copy_line(Walk *walk)
{
    int c = copy_one(walk);

    while (c != EOF && c != '\n') {
        c = copy_one(walk);
    }
}

// Comments of this kind nest.
static void copy_comment(Walk *walk)
{
    int depth = 1, c;

    copy_one(walk);
    while (depth > 0 && (c = copy_one(walk)) != EOF) {
        if (c == '/' && peek(walk) == '*') {
            depth++;
            copy_one(walk);
        } else if (c == '*' && peek(walk) == '/') {
            depth--;
            copy_one(walk);
        }
    }
}

static void copy_word(Walk *walk, int first)
{
    char word[8] = {(char)first};
    size_t length = 1;

    while (isalnum(peek(walk)) || peek(walk) == '_') {
        int c = copy_one(walk);
        if (length + 1 < sizeof word) {
            word[length] = (char)c;
        }
        length++;
    }
    walk->is_named = length == strlen("camera") && memcmp(word, "camera", length) == 0;
}

// Returns whether a camera ended.
static bool copy_token(Walk *walk, int c, const char *words)
{
    bool was_named = walk->is_named, ends = c == '}' && walk->depth - 1 == walk->camera_at;

    if (ends) {
        fprintf(walk->out, " %s ", words);
        walk->camera_at = -1;
    }
    walk->depth += (c == '{') - (c == '}');
    if (c == '{' && was_named && walk->camera_at < 0) {
        walk->camera_at = walk->depth - 1;
    }
    fputc(c, walk->out);
    if (c == '"') {
        copy_string(walk);
    } else if (c == '/' && peek(walk) == '/') {
        copy_line(walk);
    } else if (c == '/' && peek(walk) == '*') {
        copy_comment(walk);
    } else if (isalpha(c) || c == '_') {
        copy_word(walk, c);
    } else if (!isspace(c)) {
        walk->is_named = false;
    }
    return ends;
}

bool camera_text_write(const char *scene, const char *words, const char *copy)
{
    Walk walk = {.in = fopen(scene, "rb"), .out = fopen(copy, "wb"), .camera_at = -1};
    bool has_camera = false;
    int c;

    while (walk.in && walk.out && (c = fgetc(walk.in)) != EOF) {
        has_camera = copy_token(&walk, c, words) || has_camera;
    }
    bool is_read = walk.in && !ferror(walk.in);
    bool is_written = walk.out && !ferror(walk.out);
    if (walk.in) {
        fclose(walk.in);
    }
    return walk.out && fclose(walk.out) == 0 && is_written && is_read && has_camera;
}
