// A digest of bytes: BLAKE2b with 256 bits (RFC 7693), which `b2sum -l 256` prints too.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_DIGEST_H
#define BASE_DIGEST_H

#include <stddef.h>
#include <stdint.h>

enum { DIGEST_BYTES = 32, DIGEST_TEXT = 2 * DIGEST_BYTES + 1, DIGEST_BLOCK = 128 };

typedef struct Digest {
    uint64_t state[8];
    uint64_t total;  // bytes that went into the state
    size_t filled;   // of `block`; the last block stays there until the end
    unsigned char block[DIGEST_BLOCK];
} Digest;

void digest_init(Digest *digest);
void digest_add(Digest *digest, const void *bytes, size_t size);
void digest_end(Digest *digest, unsigned char out[DIGEST_BYTES]);

// In hexadecimal.
void digest_text(const unsigned char digest[DIGEST_BYTES], char text[DIGEST_TEXT]);

#endif
