// Finding and loading the OpenImageIO module.
//
// SPDX-License-Identifier: MIT
#ifndef IMAGE_MODULE_H
#define IMAGE_MODULE_H

#include "image/image.h"
#include "image/oiio_module.h"

// The module, or NULL with the loader's message, or where it was looked for, in `error`. It is looked for in the places
// of base/install.h. Once loaded it stays in the process; another call then costs little. May be called from any
// thread.
const OiioModule *module_load(ImageError *error) RT_MUST_CHECK;

#endif
