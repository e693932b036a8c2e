// The checksum of a zlib stream (RFC 1950, section 2.2), several bytes at once; zlib's adler32_combine puts sums together.
//
// SPDX-License-Identifier: MIT
#ifndef IMAGE_ADLER_H
#define IMAGE_ADLER_H

#include <stddef.h>
#include <stdint.h>

// Adler-32 of the bytes, of a stream that begins with them.
uint32_t adler_of(const unsigned char *bytes, size_t size);

#endif
