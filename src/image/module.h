// Finding and loading the OpenImageIO module.
//
// SPDX-License-Identifier: MIT
#ifndef IMAGE_MODULE_H
#define IMAGE_MODULE_H

#include "image/image.h"
#include "image/oiio_module.h"

// The module, or NULL with the loader's message in `error`. It is looked for in $RTLANG_MODULE_DIR, in the folder that
// the build installs it to, beside the running program and in `.libs` there. Once loaded it stays in the process;
// another call then costs next to nothing. May be called from any thread.
const OiioModule *module_load(ImageError *error) RT_MUST_CHECK;

#endif
