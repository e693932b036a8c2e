// The language server: messages about scenes while they are written, by the Language Server Protocol 3.17 on standard input
// and output.
//
// SPDX-License-Identifier: MIT
#ifndef CLI_LSP_H
#define CLI_LSP_H

#include "cli/options.h"

// Until the client says `exit`, or its end of the pipe closes. 0 after `shutdown`, else 1.
int lsp_run(const Options *options);

#endif
