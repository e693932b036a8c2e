// Finding and loading the modules that wrap a library which only some runs need.
//
// SPDX-License-Identifier: MIT
#ifndef IMAGE_MODULE_H
#define IMAGE_MODULE_H

#include "image/image.h"
#include "image/jpeg_module.h"
#include "image/oiio_module.h"

// Sets a module. IMAGE_NO_MODULE: there is none, and `error` has the loader's message, or where it was looked for;
// IMAGE_NO_MEMORY: no room for the libraries that it loads. It is looked for in the places of base/install.h. Once loaded
// it stays in the process; another call then costs little. May be called from any thread.
ImageStatus module_load_jpeg(const JpegModule **module, ImageError *error) RT_MUST_CHECK;
ImageStatus module_load_oiio(const OiioModule **module, ImageError *error) RT_MUST_CHECK;

#endif
