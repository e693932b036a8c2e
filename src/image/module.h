// The modules that wrap the libraries of picture formats.
//
// SPDX-License-Identifier: MIT
#ifndef IMAGE_MODULE_H
#define IMAGE_MODULE_H

#include "image/image.h"
#include "image/jpeg_module.h"
#include "image/oiio_module.h"

// Sets a module, as base/module.h loads it. IMAGE_NO_MODULE: there is none, and `error` says why; IMAGE_NO_MEMORY: no
// room for the libraries that it loads.
ImageStatus module_load_jpeg(const JpegModule **module, ImageError *error) RT_MUST_CHECK;
ImageStatus module_load_oiio(const OiioModule **module, ImageError *error) RT_MUST_CHECK;

#endif
