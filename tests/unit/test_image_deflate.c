// Pieces of deflate streams: zlib unpacks what was packed, whatever it is, and would not have packed runs much smaller.
//
// SPDX-License-Identifier: MIT
#include "image/deflate.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "image/adler.h"
#include "image/huffman.h"
#include "unit/random.h"
#include "unit/tap.h"

enum { MOST = 200000, ALPHABETS = 6 };

static unsigned char bytes[MOST], unpacked[MOST + 1], packed[2 * MOST];
static DeflateRoom room;

// Bytes of few kinds or all, in runs or not.
static void fill_evenly(Random *random, size_t size, unsigned kinds, unsigned run)
{
    unsigned left = 0;
    for (size_t i = 0; i < size; i++, left -= left > 0) {
        if (i > 0 && left > 0) {
            bytes[i] = bytes[i - 1];
        } else {
            bytes[i] = (unsigned char)(random_below(random, kinds) * 37);
            left = run > 0 ? random_below(random, run) : 0;
        }
    }
}

// Byte k as often as the k-th Fibonacci number says: codes would be longer than 15 bits.
static void fill_steeply(size_t size)
{
    size_t at = 0;
    for (size_t k = 0, one = 1, two = 1; at < size; k++) {
        for (size_t i = 0; i < one && at < size; i++) {
            bytes[at++] = (unsigned char)(k * 11 % 256);
        }
        size_t next = one + two;
        one = two;
        two = next;
    }
    for (size_t i = 1; i < size; i++) { // runs apart, in an order that repeats itself only after all of them
        size_t other = i * 40503 % size;
        unsigned char byte = bytes[i];
        bytes[i] = bytes[other];
        bytes[other] = byte;
    }
}

static bool unpacks(const unsigned char *from, size_t from_size, size_t size)
{
    z_stream stream = {.next_in = (unsigned char *)from, .avail_in = (uInt)from_size, .next_out = unpacked,
                       .avail_out = (uInt)size + 1};
    bool fine = inflateInit2(&stream, -15) == Z_OK && inflate(&stream, Z_FINISH) == Z_STREAM_END &&
                stream.avail_in == 0 && stream.total_out == size && memcmp(bytes, unpacked, size) == 0;
    inflateEnd(&stream);
    return fine;
}

// In one piece, and in pieces that follow each other.
static bool packs(Random *random, size_t size)
{
    size_t whole = deflate_piece(&room, bytes, size, true, packed);
    if (whole > deflate_most(size) || !unpacks(packed, whole, size)) {
        return false;
    }
    size_t at = 0, end = 0;
    while (at < size) {
        size_t part = 1 + random_below(random, (unsigned)(size - at)), most = deflate_most(part);
        size_t more = deflate_piece(&room, bytes + at, part, at + part == size, packed + end);
        if (more > most || end + more + 64 > sizeof packed) {
            return false;
        }
        at += part;
        end += more;
    }
    return unpacks(packed, end, size);
}

static size_t zlib_size(size_t size)
{
    z_stream stream = {.next_in = bytes, .avail_in = (uInt)size, .next_out = packed, .avail_out = sizeof packed};
    bool fine = deflateInit2(&stream, 1, Z_DEFLATED, -15, 8, Z_RLE) == Z_OK && deflate(&stream, Z_FINISH) == Z_STREAM_END;
    size_t packed_size = stream.total_out;
    deflateEnd(&stream);
    return fine ? packed_size : 0;
}

static void check_random(Random *random)
{
    static const unsigned kinds[ALPHABETS] = {1, 2, 3, 20, 200, 256};
    for (int a = 0; a < ALPHABETS; a++) {
        bool fine = true, sums = true;
        double worst = 0.0;
        for (int turn = 0; turn < 60; turn++) {
            size_t size = 1 + random_below(random, turn < 30 ? 40 : turn < 55 ? 5000 : MOST);
            fill_evenly(random, size, kinds[a], turn % 3 == 0 ? 0 : turn % 3 == 1 ? 6 : 700);
            fine = fine && packs(random, size);
            sums = sums && adler_of(bytes, size) == adler32_z(1, bytes, size);
            size_t own = deflate_piece(&room, bytes, size, true, packed), other = zlib_size(size);
            double ratio = (double)own / (double)(other + 100); // the codes of a short text are longer than it is
            worst = ratio > worst ? ratio : worst;
        }
        tap_ok(fine, "%u kinds of bytes: unpacked as they were", kinds[a]);
        tap_ok(sums, "%u kinds of bytes: checksums", kinds[a]);
        tap_ok(worst < 1.03, "%u kinds of bytes: %.3f of zlib's size, at most", kinds[a], worst);
    }
}

// A prefix code: no longer than it may be, complete, and no worse than the counts allow.
static void check_limit(void)
{
    uint32_t counts[30];
    uint8_t lengths[30];
    for (int most = 5; most <= HUFFMAN_BITS_MOST; most++) {
        counts[0] = counts[1] = 1;
        for (int i = 2; i < 30; i++) {
            counts[i] = i < 24 ? counts[i - 1] + counts[i - 2] : 0;
        }
        huffman_lengths(counts, 30, most, lengths);
        unsigned taken = 0, right = 1;
        for (int i = 0; i < 30; i++) {
            taken += lengths[i] > 0 ? 1u << (most - lengths[i]) : 0;
            right &= counts[i] == 0 ? lengths[i] == 0 : lengths[i] >= 1 && lengths[i] <= most;
            right &= i == 0 || counts[i] == 0 || lengths[i] <= lengths[i - 1];
        }
        tap_ok(right && taken == 1u << most, "a code of %d bits at most", most);
    }
}

int main(void)
{
    Random random = {random_seed(NULL)};
    check_random(&random);
    fill_steeply(DEFLATE_BLOCK);
    tap_ok(packs(&random, DEFLATE_BLOCK), "codes that would be too long");
    memset(bytes, 7, MOST);
    tap_ok(packs(&random, MOST) && deflate_piece(&room, bytes, MOST, true, packed) < 600, "one run");
    check_limit();
    return tap_done();
}
