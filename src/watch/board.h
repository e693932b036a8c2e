// The board: what the page shows of a scene, written by the one thread that draws and read by those that answer.
//
// Owns its pictures and texts. Whoever writes holds the lock and ends with board_change, which wakes those that wait.
//
// SPDX-License-Identifier: MIT
#ifndef WATCH_BOARD_H
#define WATCH_BOARD_H

#include <pthread.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/text.h"
#include "rtlang/rtlang.h"

enum { BOARD_POINTS = 32 };

typedef enum BoardState { BOARD_READING, BOARD_DRAWING, BOARD_DONE, BOARD_FAULT } BoardState;

// A PNG file, and the save that it shows.
typedef struct BoardPicture {
    unsigned char *bytes; // owned; NULL: there is none
    size_t length;
    uint64_t id; // counts pictures
    uint64_t save;
} BoardPicture;

// A picture of a save: when it was there, and how far off it was.
typedef struct BoardPoint {
    double seconds, error, samples;
} BoardPoint;

// What becomes of a picture that POV-Ray draws on request.
typedef enum PeerState { PEER_MISSING, PEER_IDLE, PEER_DRAWING, PEER_DONE, PEER_FAULT } PeerState;

typedef struct Board {
    pthread_mutex_t lock;
    pthread_cond_t changed;
    uint64_t change; // counts changes
    bool is_over;
    const char *scene;
    int width, height;
    double target; // error at which drawing ends
    uint64_t save; // counts saves, from 1
    double begun;  // when the save was seen, by the clock
    BoardState state;
    BoardPicture picture; // the last one that there was, of an older save when this one has a fault
    bool is_coarse;
    double first_seconds;      // from the save to its first picture; 0: there is none yet
    double done, seconds_left; // of what is being drawn; seconds below 0: not known
    rt_error error;            // of the picture
    BoardPoint points[BOARD_POINTS];
    size_t point_count;
    TextBuffer messages; // elements of a JSON array
    TextBuffer said;     // by the scene, as it is
    PeerState peer_state;
    BoardPicture peer;
    uint64_t peer_asked; // the save of which POV-Ray's picture was asked for last
    double peer_seconds;
    TextBuffer peer_fault;
} Board;

bool board_init(Board *board) RT_MUST_CHECK;
void board_fini(Board *board);
void board_lock(Board *board);
void board_unlock(Board *board);
void board_change(Board *board); // wakes those that wait, and unlocks

// Puts a copy of a PNG file into one of the board's pictures; false when out of memory, which leaves the old one.
bool board_set_picture(BoardPicture *picture, const unsigned char *bytes, size_t length, uint64_t save) RT_MUST_CHECK;

// Waits, with the lock, until there was a change after that one, the end, or that many seconds.
void board_wait(Board *board, uint64_t after, double seconds);

// All but the pictures, as one JSON object; with the lock.
void board_write(const Board *board, TextBuffer *out);

#endif
