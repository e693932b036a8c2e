// Questions between ranks of which each holds a part of the scene: threads that trace ask all others and wait, and
// answer what others ask meanwhile.
//
// Turns a thread's questions into messages, and messages into answers; knows neither rays nor MPI. One thread of the
// rank sends and receives; all others come here only.
//
// SPDX-License-Identifier: MIT
#ifndef SHARE_ASKING_H
#define SHARE_ASKING_H

#include <pthread.h>
#include <stdint.h>

#include "base/array.h"
#include "render/records/tile_share.h"
#include "share/mpi_module.h"

typedef struct AskingMessage {
    int rank;             // to which it goes, or from which it came
    unsigned char *bytes; // owned
    size_t length;
    void *handle; // of a message on its way
} AskingMessage;

typedef ARRAY(AskingMessage) AskingMessages;

// A thread that waits for answers.
typedef struct AskingWait {
    int32_t number;
    int left;             // answers that are not here
    unsigned char *lists; // those that are, one list a rank; owned by the thread
    size_t length;        // of each
    struct AskingWait *next;
} AskingWait;

typedef struct Asking {
    const TileAsking *table; // NULL: each rank has the whole scene
    const MpiModule *module;
    int rank, ranks;
    unsigned char question, answer; // the first bytes of messages
    pthread_mutex_t lock;           // of all below
    AskingMessages to_send, on_their_way, questions;
    AskingWait *waits;
    int32_t last; // number of a wait
    bool has_failed;
} Asking;

bool asking_init(Asking *asking, const MpiModule *module, int rank, int ranks, unsigned char question,
                 unsigned char answer) RT_MUST_CHECK;
void asking_fini(Asking *asking);

// TileShare.settle; `is_over` tells whether no answers are to be waited for.
TileSettled asking_settle(Asking *asking, bool (*is_over)(void *client), void *client);
// Answers one list of questions, if there is one. Whether there was.
bool asking_help(Asking *asking);

// A message of any kind, whose bytes are taken over: it goes with the others.
void asking_post(Asking *asking, int to, unsigned char *bytes, size_t length);

// Of the thread that talks. A message that came, which is taken over; false: it is none of these.
bool asking_take(Asking *asking, int from, unsigned char *bytes, size_t length);
// Sends what is to be sent. Whether anything was.
bool asking_send(Asking *asking);
// Whether nothing is on its way.
bool asking_is_quiet(Asking *asking);

#endif
