// The boundary between the library and the module that wraps MPI, which is loaded only by --mpi.
//
// The module is the one place that knows MPI: it gives messages between ranks. Calls are made by one thread at a
// time.
//
// SPDX-License-Identifier: MIT
#ifndef SHARE_MPI_MODULE_H
#define SHARE_MPI_MODULE_H

#include <stdbool.h>
#include <stddef.h>

// Raised with each change of the structures below; a module of another version is passed over.
#define MPI_MODULE_VERSION 2u
#define MPI_MODULE_FILE    "rtlang_mpi.so"
#define MPI_MODULE_SYMBOL  "rtlang_mpi_module"

typedef struct MpiModule {
    unsigned version; // stays the first member
    bool is_whole;    // false: there was no MPI where it was built
    // Joins the ranks, once a process; false where that cannot be.
    bool (*begin)(int *rank, int *ranks);
    void (*end)(void);
    // Ends all ranks at once.
    void (*stop)(int code);
    // A message to a rank. May wait until that rank receives.
    void (*send)(int to, const void *bytes, size_t length);
    // The same without waiting: `bytes` stay as they are until it is sent. NULL: no memory. What is asked whether it is
    // sent is released when it is.
    void *(*post)(int to, const void *bytes, size_t length);
    bool (*is_sent)(void *posted);
    // A message of any rank, if one is there: *bytes is to be freed. False: none, or no memory, which sets *failed.
    bool (*receive)(int *from, unsigned char **bytes, size_t *length, bool *failed);
    // What rank 0 has, to all. All ranks call it.
    void (*broadcast)(void *bytes, size_t length);
    // Some bytes of each rank, to all: theirs follow each other in `all`. All ranks call it with the same length.
    void (*gather)(const void *own, void *all, size_t length);
    // The name of the machine, and of the library, for messages.
    void (*describe)(char *machine, size_t machine_size, char *library, size_t library_size);
} MpiModule;

// The module's one symbol.
extern __attribute__((visibility("default"))) const MpiModule rtlang_mpi_module;

#endif
