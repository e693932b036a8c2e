// The table of signatures. Owns nothing.
//
// SPDX-License-Identifier: MIT
#include "base/magic.h"

#include <string.h>

#include "base/attributes.h"

#define MAGIC(signature, kind, help)    {signature, sizeof(signature) - 1, kind, help, false}
#define MAGIC_TEXT(signature, kind, help) {signature, sizeof(signature) - 1, kind, help, true}

#define UNPACK "unpack it first"
#define AS_TEXT "save it as plain text"

static const Magic table[] = {
    MAGIC("\x89PNG\r\n\x1a\n", "a PNG picture", NULL),
    MAGIC("\xff\xd8\xff", "a JPEG picture", NULL),
    MAGIC("\x76\x2f\x31\x01", "an OpenEXR picture", NULL),
    MAGIC("GIF87a", "a GIF picture", NULL),
    MAGIC("GIF89a", "a GIF picture", NULL),
    MAGIC("II*\0", "a TIFF picture", NULL),
    MAGIC("MM\0*", "a TIFF picture", NULL),
    MAGIC("II+\0", "a TIFF picture", NULL),
    MAGIC("MM\0+", "a TIFF picture", NULL),
    MAGIC("RIFF????WEBP", "a WebP picture", NULL),
    MAGIC_TEXT("#?RADIANCE", "a Radiance picture", NULL),
    MAGIC("P4\n", "a PBM picture", NULL),
    MAGIC("P5\n", "a PGM picture", NULL),
    MAGIC("P6\n", "a PPM picture", NULL),
    MAGIC("BM????\0\0\0\0", "a BMP picture", NULL),
    MAGIC_TEXT("%PDF-", "a PDF document", NULL),
    MAGIC_TEXT("{\\rtf", "an RTF document", AS_TEXT),
    MAGIC_TEXT("<!DOCTYPE", "an HTML page", NULL),
    MAGIC_TEXT("<html", "an HTML page", NULL),
    MAGIC_TEXT("<?xml", "an XML document", NULL),
    MAGIC("\xd0\xcf\x11\xe0", "an Office document", AS_TEXT),
    MAGIC("\x7f" "ELF", "a program (ELF)", NULL),
    MAGIC("MZ", "a program for Windows", NULL),
    MAGIC("PK\3\4", "a zip archive", UNPACK),
    MAGIC("\x1f\x8b", "a file packed by gzip", UNPACK),
    MAGIC("BZh", "a file packed by bzip2", UNPACK),
    MAGIC("\xfd" "7zXZ", "a file packed by xz", UNPACK),
    MAGIC("\x28\xb5\x2f\xfd", "a file packed by zstd", UNPACK),
    MAGIC("7z\xbc\xaf\x27\x1c", "a 7z archive", UNPACK),
    MAGIC("BLENDER", "a file of Blender", NULL),
    MAGIC("\xff\xfe", "UTF-16 text", "save it as UTF-8"),
    MAGIC("\xfe\xff", "UTF-16 text", "save it as UTF-8"),
};

static bool fits(const Magic *magic, const char *bytes, size_t length)
{
    for (size_t i = 0; i < magic->length; i++) {
        if (i >= length || (bytes[i] != magic->signature[i] && magic->signature[i] != '?')) {
            return false;
        }
    }
    return true;
}

// Without a mark at its beginning: every second byte of its first characters is zero.
static bool is_utf16(const char *bytes, size_t length, size_t zero)
{
    enum { LOOKED_AT = 8 };
    for (size_t i = 0; i < LOOKED_AT; i++) {
        if (i >= length || (bytes[i] == '\0') != (i % 2 == zero)) {
            return i >= 4 && i >= length;
        }
    }
    return true;
}

static const Magic *find(const char *bytes, size_t length, bool is_text)
{
    for (size_t i = 0; i < RT_COUNT_OF(table); i++) {
        if ((table[i].is_text || !is_text) && fits(&table[i], bytes, length)) {
            return &table[i];
        }
    }
    return NULL;
}

const Magic *magic_of_bytes(const char *bytes, size_t length)
{
    static const Magic utf16 = MAGIC("", "UTF-16 text", "save it as UTF-8");
    return is_utf16(bytes, length, 1) || is_utf16(bytes, length, 0) ? &utf16 : find(bytes, length, false);
}

const Magic *magic_of_text(const char *bytes, size_t length)
{
    return find(bytes, length, true);
}
