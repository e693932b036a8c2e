// Reads POV-Ray's options: words of a command line, and .ini files with their sections, into PovraySettings.
//
// Reports what is wrong at its place in the file or the command line. Knows nothing of what options do.
//
// SPDX-License-Identifier: MIT
#ifndef CLI_POVRAY_READ_H
#define CLI_POVRAY_READ_H

#include <stdbool.h>
#include <stddef.h>

#include "cli/povray_table.h"
#include "rtlang/rtlang.h"

// The defaults of POV-Ray.
void povray_settings_init(PovraySettings *settings);
void povray_settings_fini(PovraySettings *settings);

// Reads the povray.ini that POV-Ray reads, if there is one, then the words, which are `count` of argv. Messages go to
// the session. RT_OK, or the status of the first fault, at which reading ends.
rt_status povray_read(rt_session *session, PovraySettings *settings, char **words, size_t count);

// The path of a file that is named so: as it is, else in one of the folders of Library_Path; false when there is none.
bool povray_find(const PovraySettings *settings, const char *name, char *path, size_t size);

// Writes a file of options that says the same again; false when it could not, for a reason in errno.
bool povray_write_ini(const PovraySettings *settings, const char *path);

#endif
