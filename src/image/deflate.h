// Bytes to a piece of a deflate stream (RFC 1951): runs of one byte and prefix codes, nothing else. For filtered rows of
// renderings, whose runs are what can be found at once.
//
// SPDX-License-Identifier: MIT
#ifndef IMAGE_DEFLATE_H
#define IMAGE_DEFLATE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { DEFLATE_BLOCK = 0xffff }; // bytes that a block takes in

// Room to work in, of one thread; it need not be set.
typedef struct DeflateRoom {
    uint16_t tokens[DEFLATE_BLOCK + 1];
    uint32_t counts[2][512];
    uint32_t patterns[512]; // of each token: its bits, and how many in the uppermost byte
} DeflateRoom;

// Bytes that a piece may take, and be written to while it is made.
size_t deflate_most(size_t size);

// Packs at least one byte; returns the size of what it wrote to `packed`. The piece refers to nothing before it and ends
// at a byte; the last one of a stream ends it.
size_t deflate_piece(DeflateRoom *room, const unsigned char *bytes, size_t size, bool is_last, unsigned char *packed);

#endif
