// Drawing a scene at each save.
//
// SPDX-License-Identifier: MIT
#ifndef WATCH_DRAW_H
#define WATCH_DRAW_H

#include "watch/board.h"
#include "watch/sentry.h"
#include "watch/watch.h"

// Draws now and at each save, and puts on the board what comes of it, until the sentry says that it is over.
void draw_until_end(const WatchJob *job, Board *board, Sentry *sentry);

#endif
