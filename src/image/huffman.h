// Prefix codes as deflate has them (RFC 1951, section 3.2.2): from how often symbols come to the bits of each.
//
// SPDX-License-Identifier: MIT
#ifndef IMAGE_HUFFMAN_H
#define IMAGE_HUFFMAN_H

#include <stdint.h>

enum { HUFFMAN_SYMBOLS_MOST = 288, HUFFMAN_BITS_MOST = 15 };

// The length of each symbol's code, of `most` bits or less; 0 where its count is 0. A symbol that is alone has 1 bit.
// Counts are below 2^16.
void huffman_lengths(const uint32_t *counts, int symbols, int most, uint8_t *lengths);

// The codes, their first bit lowest; 0 where the length is 0.
void huffman_codes(const uint8_t *lengths, int symbols, uint16_t *codes);

#endif
