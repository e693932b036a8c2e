#!/bin/sh
# Makes configure from configure.ac, in a fresh checkout.
# SPDX-License-Identifier: MIT
set -e
cd "$(dirname "$0")"
mkdir -p m4 build-aux
autoreconf --install --force
