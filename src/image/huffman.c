// Code lengths by A. Moffat and J. Katajainen, "In-place calculation of minimum-redundancy codes", WADS 1995; where one is
// longer than it may be, as in Annex K.3 of JPEG (ITU-T T.81): two of the longest codes take the place of a shorter one.
//
// SPDX-License-Identifier: MIT
#include "image/huffman.h"

#include <string.h>

enum { SYMBOL_BITS = 9, COUNT_BITS = 16 }; // of a key: the symbol is below its count

// Sorts by counts: by their lower bytes, then, keeping that order, by their upper ones.
static void keys_sort(uint32_t *keys, int count)
{
    uint32_t other[HUFFMAN_SYMBOLS_MOST];
    for (int shift = SYMBOL_BITS; shift < SYMBOL_BITS + COUNT_BITS; shift += 8) {
        uint16_t places[256 + 1] = {0};
        for (int i = 0; i < count; i++) {
            places[(keys[i] >> shift & 0xff) + 1]++;
        }
        for (int byte = 1; byte < 256; byte++) {
            places[byte] = (uint16_t)(places[byte] + places[byte - 1]);
        }
        for (int i = 0; i < count; i++) {
            other[places[keys[i] >> shift & 0xff]++] = keys[i];
        }
        memcpy(keys, other, (size_t)count * sizeof *keys);
    }
}

// Turns counts in rising order, two at least, into the depths of a tree's leaves, in falling order.
static void depths_find(uint32_t *a, int count)
{
    int leaf = 0, root = 0;
    for (int next = 0; next < count - 1; next++) { // counts of inner nodes, later their parents
        uint32_t sum = 0;
        for (int child = 0; child < 2; child++) {
            if (leaf >= count || (root < next && a[root] < a[leaf])) {
                sum += a[root];
                a[root++] = (uint32_t)next;
            } else {
                sum += a[leaf++];
            }
        }
        a[next] = sum;
    }
    a[count - 2] = 0; // depths of inner nodes
    for (int next = count - 3; next >= 0; next--) {
        a[next] = a[a[next]] + 1;
    }
    int inner = count - 2, to = count - 1;
    uint32_t open = 1; // nodes of this depth
    for (uint32_t depth = 0; open > 0; depth++) {
        uint32_t used = 0;
        for (; inner >= 0 && a[inner] == depth; inner--) {
            used++;
        }
        for (; open > used; open--) {
            a[to--] = depth;
        }
        open = 2 * used;
    }
}

// Leaves of each depth, none deeper than `most`, so that they still are a code.
static void depths_limit(const uint32_t *depths, int count, int most, int leaves[HUFFMAN_BITS_MOST + 1])
{
    uint32_t taken = 0, all = UINT32_C(1) << most;
    memset(leaves, 0, (HUFFMAN_BITS_MOST + 1) * sizeof *leaves);
    for (int i = 0; i < count; i++) {
        int depth = depths[i] < (uint32_t)most ? (int)depths[i] : most;
        leaves[depth]++;
        taken += all >> depth;
    }
    for (; taken > all; taken--) { // one of the deepest becomes the sibling of one that goes down a step
        int depth = most - 1;
        while (leaves[depth] == 0) {
            depth--;
        }
        leaves[depth]--;
        leaves[depth + 1] += 2;
        leaves[most]--;
    }
}

void huffman_lengths(const uint32_t *counts, int symbols, int most, uint8_t *lengths)
{
    uint32_t keys[HUFFMAN_SYMBOLS_MOST], depths[HUFFMAN_SYMBOLS_MOST];
    int leaves[HUFFMAN_BITS_MOST + 1], used = 0;
    for (int i = 0; i < symbols; i++) {
        lengths[i] = 0;
        if (counts[i] > 0) {
            keys[used++] = counts[i] << SYMBOL_BITS | (uint32_t)i;
        }
    }
    keys_sort(keys, used);
    for (int i = 0; i < used; i++) {
        depths[i] = keys[i] >> SYMBOL_BITS;
    }
    if (used < 2) {
        depths[0] = 1;
    } else {
        depths_find(depths, used);
    }
    depths_limit(depths, used, most, leaves);
    for (int at = 0, depth = most; at < used; at++) { // the rarest first
        while (leaves[depth] == 0) {
            depth--;
        }
        leaves[depth]--;
        lengths[keys[at] & ((1 << SYMBOL_BITS) - 1)] = (uint8_t)depth;
    }
}

// The lowest bits the other way round.
static unsigned bits_reversed(unsigned bits, int count)
{
    bits = (bits & 0x5555) << 1 | (bits >> 1 & 0x5555);
    bits = (bits & 0x3333) << 2 | (bits >> 2 & 0x3333);
    bits = (bits & 0x0f0f) << 4 | (bits >> 4 & 0x0f0f);
    bits = (bits & 0x00ff) << 8 | (bits >> 8 & 0x00ff);
    return bits >> (16 - count);
}

void huffman_codes(const uint8_t *lengths, int symbols, uint16_t *codes)
{
    unsigned of_length[HUFFMAN_BITS_MOST + 1] = {0}, next[HUFFMAN_BITS_MOST + 1] = {0};
    for (int i = 0; i < symbols; i++) {
        of_length[lengths[i]]++;
    }
    of_length[0] = 0;
    for (int length = 1; length <= HUFFMAN_BITS_MOST; length++) {
        next[length] = (next[length - 1] + of_length[length - 1]) << 1;
    }
    for (int i = 0; i < symbols; i++) {
        codes[i] = lengths[i] > 0 ? (uint16_t)bits_reversed(next[lengths[i]]++, lengths[i]) : 0;
    }
}
