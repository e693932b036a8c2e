// BLAKE2b, after RFC 7693.
//
// SPDX-License-Identifier: MIT
#include "base/digest.h"

#include <stdio.h>
#include <string.h>

#include "base/attributes.h"

static const uint64_t iv[8] = {0x6A09E667F3BCC908, 0xBB67AE8584CAA73B, 0x3C6EF372FE94F82B, 0xA54FF53A5F1D36F1,
                               0x510E527FADE682D1, 0x9B05688C2B3E6C1F, 0x1F83D9ABFB41BD6B, 0x5BE0CD19137E2179};

// Section 2.7: which word of the message each round takes where. The last two rounds are the first two again.
static const uint8_t sigma[10][16] = {
    {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}, {14, 10, 4, 8, 9, 15, 13, 6, 1, 12, 0, 2, 11, 7, 5, 3},
    {11, 8, 12, 0, 5, 2, 15, 13, 10, 14, 3, 6, 7, 1, 9, 4}, {7, 9, 3, 1, 13, 12, 11, 14, 2, 6, 5, 10, 4, 0, 15, 8},
    {9, 0, 5, 7, 2, 4, 10, 15, 14, 1, 11, 12, 6, 8, 3, 13}, {2, 12, 6, 10, 0, 11, 8, 3, 4, 13, 7, 5, 15, 14, 1, 9},
    {12, 5, 1, 15, 14, 13, 4, 10, 0, 7, 6, 3, 9, 2, 8, 11}, {13, 11, 7, 14, 12, 1, 3, 9, 5, 0, 15, 4, 8, 6, 2, 10},
    {6, 15, 14, 9, 11, 3, 0, 8, 12, 2, 13, 7, 1, 4, 10, 5}, {10, 2, 8, 4, 7, 6, 1, 5, 15, 11, 9, 14, 3, 12, 13, 0},
};

enum { ROUNDS = 12, PARAMETERS = 0x01010000 }; // no key, one sequential tree (section 2.8)

RT_ALWAYS_INLINE uint64_t rotated(uint64_t word, unsigned by)
{
    return word >> by | word << (64 - by);
}

RT_ALWAYS_INLINE uint64_t little_endian(const unsigned char *bytes)
{
    uint64_t word = 0;
#pragma GCC unroll 8
    for (unsigned i = 8; i-- > 0;) {
        word = word << 8 | bytes[i];
    }
    return word;
}

// Section 3.1.
RT_ALWAYS_INLINE void mix(uint64_t *a, uint64_t *b, uint64_t *c, uint64_t *d, uint64_t x, uint64_t y)
{
    *a += *b + x;
    *d = rotated(*d ^ *a, 32);
    *c += *d;
    *b = rotated(*b ^ *c, 24);
    *a += *b + y;
    *d = rotated(*d ^ *a, 16);
    *c += *d;
    *b = rotated(*b ^ *c, 63);
}

// One round, whose number is a constant of the caller: all places are known then, and the words stay in registers.
RT_ALWAYS_INLINE void mix_all(uint64_t v[16], const uint64_t m[16], const uint8_t s[16])
{
    mix(&v[0], &v[4], &v[8], &v[12], m[s[0]], m[s[1]]);
    mix(&v[1], &v[5], &v[9], &v[13], m[s[2]], m[s[3]]);
    mix(&v[2], &v[6], &v[10], &v[14], m[s[4]], m[s[5]]);
    mix(&v[3], &v[7], &v[11], &v[15], m[s[6]], m[s[7]]);
    mix(&v[0], &v[5], &v[10], &v[15], m[s[8]], m[s[9]]);
    mix(&v[1], &v[6], &v[11], &v[12], m[s[10]], m[s[11]]);
    mix(&v[2], &v[7], &v[8], &v[13], m[s[12]], m[s[13]]);
    mix(&v[3], &v[4], &v[9], &v[14], m[s[14]], m[s[15]]);
}

// Section 3.2.
static void compress(Digest *digest, const unsigned char *block, uint64_t size, int is_last)
{
    uint64_t m[16], v[16];
    digest->total += size;
    for (size_t i = 0; i < 16; i++) {
        m[i] = little_endian(block + 8 * i);
        v[i] = i < 8 ? digest->state[i] : iv[i - 8];
    }
    v[12] ^= digest->total; // 2^64 bytes are never reached
    v[14] = is_last ? ~v[14] : v[14];
#pragma GCC unroll 12
    for (size_t round = 0; round < ROUNDS; round++) {
        mix_all(v, m, sigma[round % 10]);
    }
    for (size_t i = 0; i < 8; i++) {
        digest->state[i] ^= v[i] ^ v[i + 8];
    }
}

void digest_init(Digest *digest)
{
    *digest = (Digest){.total = 0};
    memcpy(digest->state, iv, sizeof iv);
    digest->state[0] ^= PARAMETERS ^ DIGEST_BYTES;
}

void digest_add(Digest *digest, const void *bytes, size_t size)
{
    const unsigned char *at = bytes;
    while (size > 0) {
        if (digest->filled == DIGEST_BLOCK) {
            compress(digest, digest->block, DIGEST_BLOCK, 0);
            digest->filled = 0;
        }
        for (; digest->filled == 0 && size > DIGEST_BLOCK; at += DIGEST_BLOCK, size -= DIGEST_BLOCK) {
            compress(digest, at, DIGEST_BLOCK, 0);
        }
        size_t room = DIGEST_BLOCK - digest->filled, part = size < room ? size : room;
        memcpy(digest->block + digest->filled, at, part);
        digest->filled += part;
        at += part;
        size -= part;
    }
}

void digest_end(Digest *digest, unsigned char out[DIGEST_BYTES])
{
    memset(digest->block + digest->filled, 0, DIGEST_BLOCK - digest->filled);
    compress(digest, digest->block, digest->filled, 1);
    for (size_t i = 0; i < DIGEST_BYTES; i++) {
        out[i] = (unsigned char)(digest->state[i / 8] >> 8 * (i % 8));
    }
}

void digest_text(const unsigned char digest[DIGEST_BYTES], char text[DIGEST_TEXT])
{
    for (size_t i = 0; i < DIGEST_BYTES; i++) {
        snprintf(text + 2 * i, 3, "%02x", digest[i]);
    }
}
