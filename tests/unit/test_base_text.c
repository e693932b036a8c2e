// Tests of base/text.h and base/number.h: growth, formats, and numbers both ways against the C library in the C locale.
//
// SPDX-License-Identifier: MIT
#include <float.h>
#include <inttypes.h>
#include <locale.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "base/text.h"
#include "unit/tap.h"

enum { LITERALS = 500000, DOUBLES = 200000 };

// splitmix64 (G. Steele, D. Lea, C. Flood, OOPSLA 2014).
static uint64_t random_next(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static unsigned random_below(uint64_t *state, unsigned bound)
{
    return (unsigned)(random_next(state) % bound);
}

static bool same_bits(double a, double b)
{
    return memcmp(&a, &b, sizeof(a)) == 0;
}

static void test_buffer(void)
{
    TextBuffer buffer;
    text_init(&buffer);
    tap_ok(strcmp(text_get(&buffer), "") == 0, "an empty buffer reads as nothing");
    text_append(&buffer, "sphere");
    text_append_char(&buffer, ' ');
    text_append_n(&buffer, "{ }", 1);
    text_printf(&buffer, " %d %s", 42, "x");
    tap_ok(strcmp(text_get(&buffer), "sphere { 42 x") == 0 && buffer.length == 13, "appends follow each other");
    text_clear(&buffer);
    tap_ok(buffer.length == 0 && buffer.capacity > 0 && strcmp(text_get(&buffer), "") == 0, "clear keeps the memory");
    for (int i = 0; i < 1000; i++) {
        text_printf(&buffer, "%*d", i % 700, i);
    }
    size_t expected = 0;
    for (int i = 0; i < 1000; i++) {
        expected += (size_t)snprintf(NULL, 0, "%*d", i % 700, i);
    }
    tap_ok(buffer.length == expected && strlen(text_get(&buffer)) == expected, "formatted text of any length fits");
    text_append_n(&buffer, "", SIZE_MAX / 2);
    tap_ok(buffer.failed && buffer.length == expected, "what does not fit is remembered as failed, the rest stays");
    text_clear(&buffer);
    text_append_n(&buffer, "a\0b", 3);
    tap_ok(!buffer.failed && buffer.length == 3 && memcmp(text_get(&buffer), "a\0b", 4) == 0, "zeros are text as well");
    text_fini(&buffer);
    tap_ok(!buffer.text && buffer.capacity == 0, "fini gives the memory back");
}

static void test_parse_table(void)
{
    static const struct {
        const char *text;
        NumberResult result;
        double value;
    } cases[] = {
        {"0", NUMBER_OK, 0},
        {"7", NUMBER_OK, 7},
        {".5", NUMBER_OK, 0.5},
        {"1.", NUMBER_OK, 1},
        {"1.e2", NUMBER_OK, 100},
        {"00012.50", NUMBER_OK, 12.5},
        {"1E+2", NUMBER_OK, 100},
        {"1e-2", NUMBER_OK, 0.01},
        {"0.1", NUMBER_OK, 0.1},
        {"9007199254740993", NUMBER_OK, 9007199254740992.0},
        {"9007199254740993.000000000000000000000000000001", NUMBER_OK, 9007199254740994.0},
        {"9007199254740992.999999999999999999999999999999", NUMBER_OK, 9007199254740992.0},
        {"18446744073709551615", NUMBER_OK, 18446744073709551616.0},
        {"0.00000000000000000000000000000000000000000000012345", NUMBER_OK, 1.2345e-46},
        {"1.7976931348623157e308", NUMBER_OK, DBL_MAX},
        {"1.7976931348623158e308", NUMBER_OK, DBL_MAX},
        {"1.7976931348623159e308", NUMBER_OVERFLOW, HUGE_VAL},
        {"1e309", NUMBER_OVERFLOW, HUGE_VAL},
        {"1e99999999999999999999999999", NUMBER_OVERFLOW, HUGE_VAL},
        {"0e99999999999999999999999999", NUMBER_OK, 0},
        {"1e-99999999999999999999999999", NUMBER_OK, 0},
        {"4.9e-324", NUMBER_OK, 4.9406564584124654e-324},
        {"2.4703282292062327e-324", NUMBER_OK, 0},
        {"2.4703282292062328e-324", NUMBER_OK, 4.9406564584124654e-324},
        {"2.2250738585072011e-308", NUMBER_OK, 2.2250738585072011e-308},
        {"", NUMBER_MALFORMED, 0},
        {".", NUMBER_MALFORMED, 0},
        {"e5", NUMBER_MALFORMED, 0},
        {".e5", NUMBER_MALFORMED, 0},
        {"1e", NUMBER_MALFORMED, 0},
        {"1e+", NUMBER_MALFORMED, 0},
        {"1e5.", NUMBER_MALFORMED, 0},
        {"1.2.3", NUMBER_MALFORMED, 0},
        {"1,5", NUMBER_MALFORMED, 0},
        {"-1", NUMBER_MALFORMED, 0},
        {"+1", NUMBER_MALFORMED, 0},
        {" 1", NUMBER_MALFORMED, 0},
        {"1 ", NUMBER_MALFORMED, 0},
        {"0x10", NUMBER_MALFORMED, 0},
        {"inf", NUMBER_MALFORMED, 0},
        {"nan", NUMBER_MALFORMED, 0},
    };
    for (size_t i = 0; i < RT_COUNT_OF(cases); i++) {
        double value = 0;
        NumberResult result = number_parse(cases[i].text, strlen(cases[i].text), &value);
        tap_ok(result == cases[i].result && (result == NUMBER_MALFORMED || same_bits(value, cases[i].value)),
               "`%s` reads as %.17g", cases[i].text, cases[i].value);
    }
    double value = 0;
    tap_ok(number_parse("12345", 2, &value) == NUMBER_OK && value == 12, "only `length` characters are read");
}

static void test_scan_table(void)
{
    static const struct {
        const char *text;
        size_t used; // 0: no number
        double value;
    } cases[] = {
        {"12,3", 2, 12},       {"1.5.2", 3, 1.5},   {"5.,", 2, 5},        {".5>", 2, 0.5},    {"1e3\n", 3, 1000},
        {"1e,", 2, 1},         {"2E+,", 3, 2},      {"3e-x", 3, 3},       {"0x10", 1, 0},     {"7", 1, 7},
        {"0.1 0.2", 3, 0.1},   {"1-2", 1, 1},       {"", 0, 0},           {".", 0, 0},        {"e5", 0, 0},
        {"-1", 0, 0},          {" 1", 0, 0},        {"nan", 0, 0},        {"1e-2e3", 4, 0.01}, {".5.5", 2, 0.5},
    };
    for (size_t i = 0; i < RT_COUNT_OF(cases); i++) {
        double value = 0;
        size_t used = 0;
        NumberResult result = number_scan(cases[i].text, strlen(cases[i].text), &value, &used);
        tap_ok(cases[i].used == 0 ? result == NUMBER_MALFORMED
                                  : result == NUMBER_OK && used == cases[i].used && same_bits(value, cases[i].value),
               "`%.4s` begins with %zu characters of a number", cases[i].text, cases[i].used);
    }
    double value;
    size_t used;
    tap_ok(number_scan("1e999,", 6, &value, &used) == NUMBER_OVERFLOW && used == 5, "an overflow has its length");
    tap_ok(number_scan("12345", 2, &value, &used) == NUMBER_OK && value == 12, "no more than `length` is scanned");
}

static void test_escapes(void)
{
    static const struct {
        const char *text, *meaning;
        size_t used; // 0: means nothing
    } cases[] = {
        {"\\n", "\n", 2},       {"\\\\", "\\", 2},         {"\\\"x", "\"", 2},           {"\\u0041", "A", 6},
        {"\\u00e9z", "\xff\xc3\xa9", 6}, {"\\u20AC", "\xff\xe2\x82\xac", 6}, {"\\u00g1", "", 0}, {"\\u12", "", 0},
        {"\\q", "", 0},        {"\\", "", 0},
    };
    for (size_t i = 0; i < RT_COUNT_OF(cases); i++) {
        TextBuffer buffer;
        text_init(&buffer);
        size_t used = text_append_escape(&buffer, cases[i].text, strlen(cases[i].text));
        tap_ok(used == cases[i].used && strcmp(text_get(&buffer), cases[i].meaning) == 0, "escape `%s`", cases[i].text);
        text_fini(&buffer);
    }
}

// Literals of a million digits: a long run of zeros on either side, and a tie that the last digit breaks.
static void test_parse_long(void)
{
    enum { LENGTH = 1000000 };
    char *text = malloc(LENGTH + 32);
    double value = 0;
    if (!text) {
        tap_ok(false, "memory for the test");
        return;
    }
    memset(text, '0', LENGTH);
    memcpy(text, "1", 1);
    snprintf(text + LENGTH, 32, "e-%d", LENGTH - 1);
    tap_ok(number_parse(text, strlen(text), &value) == NUMBER_OK && value == 1, "1000...000e-999999 is 1");
    text[0] = '.';
    text[LENGTH - 1] = '3';
    snprintf(text + LENGTH, 32, "e%d", LENGTH);
    tap_ok(number_parse(text, strlen(text), &value) == NUMBER_OK && value == 30, ".000...0003e1000000 is 30");
    memset(text, '0', LENGTH);
    memcpy(text, "9007199254740993.", 17);
    tap_ok(number_parse(text, LENGTH, &value) == NUMBER_OK && value == 9007199254740992.0, "a tie goes to even");
    text[LENGTH - 1] = '1';
    tap_ok(number_parse(text, LENGTH, &value) == NUMBER_OK && value == 9007199254740994.0,
           "a digit in the millionth place breaks the tie");
    free(text);
}

static void append_digits(TextBuffer *text, uint64_t *seed, unsigned count)
{
    for (unsigned i = 0; i < count; i++) {
        text_append_char(text, (char)('0' + random_below(seed, 10)));
    }
}

// Random literals of four make-ups; strtod, which glibc rounds correctly, is the oracle.
static void literal_random(TextBuffer *text, uint64_t *seed, int style)
{
    text_clear(text);
    if (style == 0) { // as programs write them
        text_printf(text, "%u.", random_below(seed, 2000));
        append_digits(text, seed, random_below(seed, 9));
    } else if (style == 1) { // 15 to 20 digits, small power
        append_digits(text, seed, random_below(seed, 4));
        text_append_char(text, '.');
        append_digits(text, seed, 15 + random_below(seed, 5));
        text_printf(text, "e%d", (int)random_below(seed, 60) - 30);
    } else if (style == 2) { // any double, to a random number of digits
        uint64_t bits = random_next(seed) >> 1;
        double value;
        memcpy(&value, &bits, sizeof(value));
        text_printf(text, "%.*e", (int)random_below(seed, 24), isfinite(value) ? value : 1.0);
    } else { // the middle of two doubles, exactly or nearly
        uint64_t fraction = random_next(seed) >> 12;
        uint64_t bits = fraction | (uint64_t)(1023 + random_below(seed, 52)) << 52;
        double value;
        memcpy(&value, &bits, sizeof(value));
        text_printf(text, "%.60Lf", (long double)value + (long double)(nextafter(value, INFINITY) - value) / 2);
        text->length -= random_below(seed, 50);
        text->text[text->length] = '\0';
    }
}

static void test_parse_random(const char *where)
{
    static const char *const styles[] = {"few digits", "many digits", "any double", "ties"};
    TextBuffer text;
    text_init(&text);
    for (int style = 0; style < 4; style++) {
        uint64_t seed = 20240917u + (uint64_t)style;
        int wrong = 0;
        for (int i = 0; i < LITERALS; i++) {
            double value = 0;
            literal_random(&text, &seed, style);
            NumberResult result = number_parse(text.text, text.length, &value);
            double expected = strtod(text.text, NULL);
            if (!same_bits(value, expected) || result != (isinf(expected) ? NUMBER_OVERFLOW : NUMBER_OK)) {
                if (wrong++ == 0) {
                    printf("# `%s`: %.17g, expected %.17g\n", text.text, value, expected);
                }
            }
        }
        tap_ok(wrong == 0, "%d literals equal strtod's, %s, %s", LITERALS, styles[style], where);
    }
    text_fini(&text);
}

static void test_from_decimal(void)
{
    uint64_t seed = 5;
    int wrong = 0;
    for (int i = 0; i < LITERALS; i++) {
        char text[48];
        uint64_t mantissa = random_next(&seed);
        mantissa >>= random_below(&seed, 64);
        int power = (int)random_below(&seed, 80) - 40;
        snprintf(text, sizeof(text), "%" PRIu64 "e%d", mantissa, power);
        wrong += !same_bits(number_from_decimal(mantissa, power), strtod(text, NULL));
    }
    tap_ok(wrong == 0, "%d mantissas and powers equal strtod's", LITERALS);
    tap_ok(number_from_decimal(0, -5000) == 0 && isinf(number_from_decimal(1, 5000)), "far powers");
}

static void test_append_table(void)
{
    static const struct {
        double value;
        const char *text;
    } cases[] = {
        {0.0, "0"},
        {-0.0, "-0"},
        {3, "3"},
        {-17, "-17"},
        {0.1, "0.1"},
        {-2.5, "-2.5"},
        {0.1 + 0.2, "0.30000000000000004"},
        {1.0 / 3, "0.3333333333333333"},
        {2.0 / 3, "0.6666666666666666"},
        {100, "100"},
        {123456.789, "123456.789"},
        {0.000001, "0.000001"},
        {0.0000001, "1e-7"},
        {1.5e-7, "1.5e-7"},
        {1e15, "1000000000000000"},
        {9007199254740992.0, "9007199254740992"},
        {1e20, "100000000000000000000"},
        {1e21, "1e21"},
        {1e23, "1e23"},
        {9.5367431640625e-07, "9.5367431640625e-7"},
        {9007199254740993e3, "9007199254740993000"},
        {DBL_MAX, "1.7976931348623157e308"},
        {DBL_MIN, "2.2250738585072014e-308"},
        {4.9406564584124654e-324, "5e-324"},
        {1e-323, "1e-323"},
        {9007199254740991.0, "9007199254740991"},
        {2251799813685249.5, "2251799813685249.5"},
        {HUGE_VAL, "inf"},
        {-HUGE_VAL, "-inf"},
    };
    TextBuffer text;
    text_init(&text);
    for (size_t i = 0; i < RT_COUNT_OF(cases); i++) {
        text_clear(&text);
        text_append_double(&text, cases[i].value);
        tap_ok(strcmp(text_get(&text), cases[i].text) == 0, "%.17g is written as `%s` (got `%s`)", cases[i].value,
               cases[i].text, text_get(&text));
    }
    text_clear(&text);
    text_append_double(&text, nan(""));
    tap_ok(strcmp(text_get(&text), "nan") == 0, "nan");
    text_fini(&text);
}

static int digits_of(const char *text)
{
    int count = 0, zeros = 0;
    for (; *text && *text != 'e'; text++) {
        if (*text >= '0' && *text <= '9') {
            zeros = *text == '0' ? zeros + 1 : 0;
            count += count > 0 || *text != '0';
        }
    }
    return count - zeros;
}

// The fewest digits that snprintf needs to come back; never fewer than the shortest.
static int digits_needed(double value)
{
    char text[40];
    for (int digits = 1; digits < 17; digits++) {
        snprintf(text, sizeof(text), "%.*e", digits - 1, value);
        if (strtod(text, NULL) == value) {
            return digits;
        }
    }
    return 17;
}

static double double_random(uint64_t *seed, int style)
{
    double value;
    uint64_t bits = random_next(seed) >> 1;
    if (style == 0) {
        double digits = random_below(seed, 2000000000);
        return digits / pow(10, random_below(seed, 10));
    }
    if (style == 1) {
        return (double)(bits >> 10) * 0x1p-53;
    }
    if (style == 2) { // powers of two, where the gaps on both sides differ
        return ldexp(1, (int)random_below(seed, 2098) - 1074);
    }
    bits = style == 3 ? bits : bits >> 11; // any double; mostly denormals
    memcpy(&value, &bits, sizeof(value));
    return isfinite(value) ? value : 1;
}

static void test_append_random(const char *where)
{
    static const char *const styles[] = {"few decimals", "unit interval", "powers of two", "any double", "denormals"};
    TextBuffer text;
    text_init(&text);
    for (int style = 0; style < 5; style++) {
        uint64_t seed = 77u + (uint64_t)style;
        int count = style == 0 || style == 1 ? DOUBLES : DOUBLES / 20;
        int wrong = 0, longer = 0;
        for (int i = 0; i < count; i++) {
            double value = double_random(&seed, style), back = 0;
            text_clear(&text);
            text_append_double(&text, value);
            if (number_parse(text.text, text.length, &back) != NUMBER_OK || !same_bits(value, back)) {
                wrong++;
            }
            longer += i % 20 == 0 && digits_of(text.text) > digits_needed(value);
        }
        tap_ok(wrong == 0, "%d doubles come back, %s, %s", count, styles[style], where);
        tap_ok(longer == 0, "and are as short as can be, %s, %s", styles[style], where);
    }
    text_fini(&text);
}

// Writes the source of a locale that has a decimal comma and little else, and the character map that goes with it.
static bool write_comma_locale(const char *source_path, const char *charmap_path)
{
    FILE *source = fopen(source_path, "w"), *charmap = fopen(charmap_path, "w");
    if (source && charmap) {
        fputs("escape_char /\nLC_NUMERIC\ndecimal_point \"<U002C>\"\nthousands_sep \"<U002E>\"\ngrouping 3;3\n"
              "END LC_NUMERIC\n", source);
        fputs("<code_set_name> ASCII\n<comment_char> %\n<escape_char> /\nCHARMAP\n", charmap);
        for (int code = 0; code < 128; code++) {
            fprintf(charmap, "<U%04X> /x%02x C%d\n", code, code, code);
        }
        fputs("END CHARMAP\n", charmap);
    }
    return !((source ? fclose(source) : EOF) | (charmap ? fclose(charmap) : EOF));
}

// Makes that locale in a folder and switches to it, so that none need be installed.
static bool set_comma_locale(const char *folder)
{
    char source[64], charmap[64], command[320];
    snprintf(source, sizeof(source), "%s/source", folder);
    snprintf(charmap, sizeof(charmap), "%s/charmap", folder);
    // It exits with 1 where categories are left out.
    snprintf(command, sizeof(command), "localedef -c -f %s -i %s %s/comma >%s/log 2>&1 || test -e %s/comma/LC_NUMERIC",
             charmap, source, folder, folder, folder);
    return write_comma_locale(source, charmap) && system(command) == 0 && setenv("LOCPATH", folder, 1) == 0 &&
           setlocale(LC_ALL, "comma") != NULL;
}

// Under a locale with a decimal comma nothing may change. The process's locale is switched for the check alone.
static void test_comma_locale(void)
{
    char folder[] = "/tmp/comma.XXXXXX", command[64];
    if (system("command -v localedef >/dev/null") != 0) {
        tap_skip("numbers under a locale with a decimal comma", "localedef is not installed");
        return;
    }
    bool is_set = mkdtemp(folder) && set_comma_locale(folder) && strcmp(localeconv()->decimal_point, ",") == 0;
    snprintf(command, sizeof(command), "rm -rf %s", folder);
    if (!tap_ok(system(command) == 0 && is_set, "a locale with a decimal comma is made")) {
        return;
    }
    test_parse_table();
    test_scan_table();
    test_escapes();
    test_append_table();
    setlocale(LC_ALL, "C");
    unsetenv("LOCPATH");
}

int main(void)
{
    test_buffer();
    test_parse_table();
    test_parse_long();
    test_parse_random("C locale");
    test_from_decimal();
    test_append_table();
    test_append_random("C locale");
    test_comma_locale();
    return tap_done();
}
