// Finding and loading the modules that wrap a library which only some runs need.
//
// SPDX-License-Identifier: MIT
#ifndef IMAGE_MODULE_H
#define IMAGE_MODULE_H

#include "image/image.h"
#include "image/jpeg_module.h"
#include "image/oiio_module.h"

// A module, or NULL with the loader's message, or where it was looked for, in `error`. It is looked for in the places of
// base/install.h. Once loaded it stays in the process; another call then costs little. May be called from any thread.
const JpegModule *module_load_jpeg(ImageError *error) RT_MUST_CHECK;
const OiioModule *module_load_oiio(ImageError *error) RT_MUST_CHECK;

#endif
