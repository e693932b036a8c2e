// A block is looked at twice: for its tokens, bytes and runs, and to write their codes. What a token's bits are, those of
// its run's length and distance among them, is worked out once for each kind of token.
//
// SPDX-License-Identifier: MIT
#include "image/deflate.h"

#include <endian.h>
#include <string.h>

#include "base/attributes.h"
#include "image/huffman.h"

enum {
    TOKENS = 512,    // 0 to 255: a byte; from 256 on: as many more of the byte before, and RUN_LEAST
    RUN_LEAST = 3,   // section 3.2.5
    RUN_MOST = 258,
    TOKEN_END = 256, // as a symbol; and as a token it is one that follows all others
    SYMBOLS = 286,
    SYMBOL_RUNS = 257,
    ORDERS = 19,     // symbols of the code that lengths of codes have
    ORDER_BITS_MOST = 7,
    BLOCK_STORED = 0,
    BLOCK_CODED = 2, // with codes of its own
};

// ---- bits

typedef struct BitWriter {
    unsigned char *next;
    uint64_t bits; // the lowest `held` are still to be written
    unsigned held;
} BitWriter;

// Writes all whole bytes, and more beyond them.
RT_ALWAYS_INLINE void bits_flush(BitWriter *writer)
{
    uint64_t bytes = htole64(writer->bits);
    memcpy(writer->next, &bytes, sizeof bytes);
    writer->next += writer->held / 8;
    writer->bits >>= writer->held & ~7u;
    writer->held &= 7;
}

// Not yet written: as many as 56 may be put between two calls of bits_flush.
RT_ALWAYS_INLINE void bits_hold(BitWriter *writer, uint64_t bits, unsigned count)
{
    writer->bits |= bits << writer->held;
    writer->held += count;
}

static void bits_put(BitWriter *writer, unsigned bits, unsigned count)
{
    bits_hold(writer, bits, count);
    bits_flush(writer);
}

// Ends the byte that is begun.
static void bits_align(BitWriter *writer)
{
    bits_hold(writer, 0, -writer->held & 7);
    bits_flush(writer);
}

// ---- tokens

RT_ALWAYS_INLINE uint32_t load_32(const unsigned char *bytes)
{
    uint32_t word;
    memcpy(&word, bytes, sizeof word);
    return word;
}

// Whether the byte and two more are the one before.
RT_ALWAYS_INLINE bool is_run(const unsigned char *bytes)
{
    uint32_t word = load_32(bytes - 1);
    return word == (word << 8 | word >> 24);
}

// How many bytes, of `most`, are the one before.
static size_t run_length(const unsigned char *bytes, size_t most)
{
    size_t i = 0;
    for (; i + sizeof(uint64_t) <= most; i += sizeof(uint64_t)) {
        if (memcmp(bytes + i, bytes + i - 1, sizeof(uint64_t)) != 0) {
            break;
        }
    }
    while (i < most && bytes[i] == bytes[-1]) {
        i++;
    }
    return i;
}

// Adds a token; two tables, so that the same one twice need not wait for itself.
RT_ALWAYS_INLINE size_t token_add(DeflateRoom *room, size_t count, unsigned token)
{
    room->tokens[count] = (uint16_t)token;
    room->counts[count % 2][token]++;
    return count + 1;
}

// Returns how many there are.
static size_t tokens_find(DeflateRoom *room, const unsigned char *bytes, size_t size)
{
    size_t count = 0, i = 1;
    memset(room->counts, 0, sizeof room->counts);
    count = token_add(room, count, bytes[0]);
    while (i + RUN_LEAST <= size) {
        if (RT_LIKELY(!is_run(bytes + i))) {
            count = token_add(room, count, bytes[i++]);
            continue;
        }
        for (size_t left = run_length(bytes + i, size - i), part; left >= RUN_LEAST; left -= part, i += part) {
            part = left < RUN_MOST ? left : RUN_MOST;
            count = token_add(room, count, TOKEN_END + (unsigned)part - RUN_LEAST);
        }
    }
    for (; i < size; i++) {
        count = token_add(room, count, bytes[i]);
    }
    return count;
}

// ---- codes

// The symbol of a run's length, and its further bits (section 3.2.5).
static int run_symbol(unsigned token, int *more)
{
    unsigned beyond = token - TOKEN_END;
    *more = 0;
    if (beyond == RUN_MOST - RUN_LEAST) {
        return SYMBOLS - 1;
    }
    while (beyond >> *more >= 8) {
        ++*more;
    }
    return SYMBOL_RUNS + 4 * *more + (int)(beyond >> *more);
}

typedef struct Codes {
    uint8_t lengths[SYMBOLS + 1]; // the last is that of the one distance, 1
    uint16_t codes[SYMBOLS];
    int symbols; // up to the last that is used
    size_t bits; // of all tokens and the end
} Codes;

static void codes_make(const DeflateRoom *room, Codes *codes)
{
    uint32_t counts[SYMBOLS] = {0};
    counts[TOKEN_END] = 1;
    codes->bits = 0;
    for (unsigned token = 0; token < TOKENS; token++) {
        uint32_t count = room->counts[0][token] + room->counts[1][token];
        int more = 0;
        counts[token < TOKEN_END ? (int)token : run_symbol(token, &more)] += count;
        codes->bits += token < TOKEN_END ? 0 : count * (size_t)(more + 1);
    }
    huffman_lengths(counts, SYMBOLS, HUFFMAN_BITS_MOST, codes->lengths);
    huffman_codes(codes->lengths, SYMBOLS, codes->codes);
    for (int i = 0; i < SYMBOLS; i++) {
        codes->bits += counts[i] * (size_t)codes->lengths[i];
        codes->symbols = counts[i] > 0 ? i + 1 : codes->symbols;
    }
    codes->lengths[codes->symbols] = 1;
}

static void patterns_make(DeflateRoom *room, const Codes *codes)
{
    for (unsigned token = 0; token < TOKENS; token++) {
        int more = 0, symbol = token < TOKEN_END ? (int)token : run_symbol(token, &more), length = codes->lengths[symbol];
        uint32_t beyond = (token - TOKEN_END) & ((1u << more) - 1);
        uint32_t bits = codes->codes[symbol] | beyond << length; // a run's distance is a bit that is 0
        room->patterns[token] = bits | (uint32_t)(length + more + (token < TOKEN_END ? 0 : 1)) << 24;
    }
}

// The lengths of codes as symbols of a code of their own (section 3.2.7).
typedef struct Header {
    int count;
    uint8_t symbols[SYMBOLS + 1], more[SYMBOLS + 1]; // the bits that follow a symbol
    uint8_t lengths[ORDERS];
    uint16_t codes[ORDERS];
    int orders; // lengths that are told
    size_t bits;
} Header;

static const uint8_t order_more[ORDERS] = {[16] = 2, [17] = 3, [18] = 7};
static const uint8_t order_places[ORDERS] = {16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15};

static void header_add(Header *header, int symbol, int more)
{
    header->symbols[header->count] = (uint8_t)symbol;
    header->more[header->count++] = (uint8_t)more;
}

// As many of one length as there are in a row.
static void header_add_row(Header *header, int length, int row)
{
    if (length > 0) {
        header_add(header, length, 0);
        row--;
    }
    while (row >= 3) {
        int most = length > 0 ? 6 : 138, part = row < most ? row : most;
        int symbol = length > 0 ? 16 : part > 10 ? 18 : 17;
        header_add(header, symbol, part - (symbol == 18 ? 11 : 3));
        row -= part;
    }
    for (; row > 0; row--) {
        header_add(header, length, 0);
    }
}

static void header_make(const Codes *codes, Header *header)
{
    int lengths = codes->symbols + 1;
    header->count = 0;
    for (int i = 0, row; i < lengths; i += row) {
        for (row = 1; i + row < lengths && codes->lengths[i + row] == codes->lengths[i];) {
            row++;
        }
        header_add_row(header, codes->lengths[i], row);
    }
    uint32_t counts[ORDERS] = {0};
    for (int i = 0; i < header->count; i++) {
        counts[header->symbols[i]]++;
    }
    huffman_lengths(counts, ORDERS, ORDER_BITS_MOST, header->lengths);
    huffman_codes(header->lengths, ORDERS, header->codes);
    header->orders = ORDERS;
    while (header->orders > 4 && header->lengths[order_places[header->orders - 1]] == 0) {
        header->orders--;
    }
    header->bits = 3 + 5 + 5 + 4 + 3 * (size_t)header->orders;
    for (int i = 0; i < ORDERS; i++) {
        header->bits += counts[i] * (size_t)(header->lengths[i] + order_more[i]);
    }
}

static void header_write(const Codes *codes, const Header *header, bool is_last, BitWriter *writer)
{
    bits_put(writer, is_last | BLOCK_CODED << 1, 3);
    bits_put(writer, (unsigned)codes->symbols - 257, 5);
    bits_put(writer, 0, 5); // one distance
    bits_put(writer, (unsigned)header->orders - 4, 4);
    for (int i = 0; i < header->orders; i++) {
        bits_put(writer, header->lengths[order_places[i]], 3);
    }
    for (int i = 0; i < header->count; i++) {
        int symbol = header->symbols[i];
        bits_put(writer, header->codes[symbol], header->lengths[symbol]);
        bits_put(writer, header->more[i], order_more[symbol]);
    }
}

// ---- blocks

static void tokens_write(const DeflateRoom *room, size_t count, BitWriter *writer)
{
    BitWriter own = *writer; // which stays in registers
    for (size_t i = 0; i < count; i++) {
        uint32_t pattern = room->patterns[room->tokens[i]];
        bits_hold(&own, pattern & 0xffffff, pattern >> 24);
        bits_flush(&own);
    }
    *writer = own;
}

static void stored_write(const unsigned char *bytes, size_t size, bool is_last, BitWriter *writer)
{
    bits_put(writer, is_last | BLOCK_STORED << 1, 3);
    bits_align(writer);
    bits_put(writer, (unsigned)size, 16);
    bits_put(writer, ~(unsigned)size & 0xffff, 16);
    memcpy(writer->next, bytes, size);
    writer->next += size;
}

static void block_write(DeflateRoom *room, const unsigned char *bytes, size_t size, bool is_last, BitWriter *writer)
{
    Codes codes;
    Header header;
    size_t count = tokens_find(room, bytes, size);
    codes_make(room, &codes);
    header_make(&codes, &header);
    if (header.bits + codes.bits >= 8 * size) {
        stored_write(bytes, size, is_last, writer);
        return;
    }
    patterns_make(room, &codes);
    header_write(&codes, &header, is_last, writer);
    tokens_write(room, count, writer);
    bits_put(writer, codes.codes[TOKEN_END], codes.lengths[TOKEN_END]);
}

size_t deflate_most(size_t size)
{
    enum { BLOCK_HEAD = 5, END = 5, BEYOND = 8 }; // a stored block's head; an empty block; what bits_flush writes
    return size + (size / DEFLATE_BLOCK + 1) * BLOCK_HEAD + END + BEYOND;
}

size_t deflate_piece(DeflateRoom *room, const unsigned char *bytes, size_t size, bool is_last, unsigned char *packed)
{
    BitWriter writer = {packed, 0, 0};
    for (size_t part; size > 0; bytes += part, size -= part) {
        part = size < DEFLATE_BLOCK ? size : DEFLATE_BLOCK;
        block_write(room, bytes, part, is_last && part == size, &writer);
    }
    if (is_last) {
        bits_align(&writer);
    } else {
        stored_write(bytes, 0, false, &writer);
    }
    return (size_t)(writer.next - packed);
}
