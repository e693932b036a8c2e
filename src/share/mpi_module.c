// Messages between ranks, by MPI 3.1: see mpi_module.h.
//
// SPDX-License-Identifier: MIT
#include "share/mpi_module.h"

#include "share/optional.h"

#ifdef WITH_MPI
#include <limits.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum {
    MESSAGE_TAG = 1,
    PIECE = 1 << 30, // counts of MPI 3 are of int
    FEW_BYTES = 64,
    SHORT_BYTES = 256,
    BUFFER_BYTES = 8 << 20, // some short messages to each of thousands of ranks
    LOOKS_AT_ONCE = 100,
    PAUSE_FIRST = 50000, // nanoseconds
    PAUSE_MOST = 1000000,
};

static bool begin_once(void)
{
    int provided = MPI_THREAD_SINGLE;
    void *buffer = malloc(BUFFER_BYTES);
    if (!buffer || MPI_Init_thread(NULL, NULL, MPI_THREAD_SERIALIZED, &provided) != MPI_SUCCESS ||
        provided < MPI_THREAD_SERIALIZED) {
        free(buffer);
        return false;
    }
    return MPI_Buffer_attach(buffer, BUFFER_BYTES) == MPI_SUCCESS;
}

static bool begin(int *rank, int *ranks)
{
    int is_there = 0;
    if (MPI_Initialized(&is_there) != MPI_SUCCESS || (!is_there && !begin_once())) {
        return false;
    }
    return MPI_Comm_rank(MPI_COMM_WORLD, rank) == MPI_SUCCESS && MPI_Comm_size(MPI_COMM_WORLD, ranks) == MPI_SUCCESS;
}

static void end(void)
{
    void *buffer = NULL;
    int size;
    MPI_Buffer_detach(&buffer, &size);
    free(buffer);
    MPI_Finalize();
}

static void stop(int code)
{
    MPI_Abort(MPI_COMM_WORLD, code);
}

// MPI itself reports a fault and ends all ranks: its errors are fatal unless a program asks for another way. What is
// short goes through a buffer, so that two ranks that send to each other never wait for each other.
static void send_message(int to, const void *bytes, size_t length)
{
    if (length <= SHORT_BYTES) {
        MPI_Bsend((void *)bytes, (int)length, MPI_BYTE, to, MESSAGE_TAG, MPI_COMM_WORLD);
        return;
    }
    MPI_Send((void *)bytes, (int)length, MPI_BYTE, to, MESSAGE_TAG, MPI_COMM_WORLD);
}

static void *post(int to, const void *bytes, size_t length)
{
    MPI_Request *request = malloc(sizeof *request);
    if (request) {
        MPI_Isend((void *)bytes, (int)length, MPI_BYTE, to, MESSAGE_TAG, MPI_COMM_WORLD, request);
    }
    return request;
}

static bool is_sent(void *posted)
{
    int is_done = 0;
    MPI_Test(posted, &is_done, MPI_STATUS_IGNORE);
    if (is_done) {
        free(posted);
    }
    return is_done != 0;
}

static bool receive_message(int *from, unsigned char **bytes, size_t *length, bool *failed)
{
    int is_there = 0, count = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, MESSAGE_TAG, MPI_COMM_WORLD, &is_there, &status);
    if (!is_there) {
        return false;
    }
    MPI_Get_count(&status, MPI_BYTE, &count);
    *bytes = malloc((size_t)count + 1);
    if (!*bytes) {
        return *failed = true, false;
    }
    *from = status.MPI_SOURCE;
    *length = (size_t)count;
    MPI_Recv(*bytes, count, MPI_BYTE, *from, MESSAGE_TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return true;
}

// For ranks that may come much later: a blocking call of most MPIs takes a processor meanwhile.
static void wait_for(MPI_Request *request)
{
    struct timespec pause = {.tv_nsec = PAUSE_FIRST};
    int is_done = 0;
    for (int i = 0; i < LOOKS_AT_ONCE && !is_done; i++) {
        MPI_Test(request, &is_done, MPI_STATUS_IGNORE);
    }
    while (!is_done) {
        nanosleep(&pause, NULL);
        pause.tv_nsec = 2 * pause.tv_nsec < PAUSE_MOST ? 2 * pause.tv_nsec : PAUSE_MOST;
        MPI_Test(request, &is_done, MPI_STATUS_IGNORE);
    }
}

// Of many bytes, it has been said before how many: then all are there.
static void broadcast(void *bytes, size_t length)
{
    MPI_Request request;
    if (length <= FEW_BYTES) {
        MPI_Ibcast(bytes, (int)length, MPI_BYTE, 0, MPI_COMM_WORLD, &request);
        wait_for(&request);
        return;
    }
    for (size_t at = 0; at < length; at += PIECE) {
        int piece = (int)(length - at < PIECE ? length - at : PIECE);
        MPI_Bcast((unsigned char *)bytes + at, piece, MPI_BYTE, 0, MPI_COMM_WORLD);
    }
}

static void gather(const void *own, void *all, size_t length)
{
    MPI_Request request;
    MPI_Iallgather((void *)own, (int)length, MPI_BYTE, all, (int)length, MPI_BYTE, MPI_COMM_WORLD, &request);
    wait_for(&request);
}

static void describe(char *machine, size_t machine_size, char *library, size_t library_size)
{
    char name[MPI_MAX_PROCESSOR_NAME] = "", version[MPI_MAX_LIBRARY_VERSION_STRING] = "";
    int length;
    MPI_Get_processor_name(name, &length);
    MPI_Get_library_version(version, &length);
    version[strcspn(version, ",\n")] = '\0';
    snprintf(machine, machine_size, "%s", name);
    snprintf(library, library_size, "%s", version);
}

const MpiModule rtlang_mpi_module = {.version = MPI_MODULE_VERSION,
                                     .is_whole = true,
                                     .begin = begin,
                                     .end = end,
                                     .stop = stop,
                                     .send = send_message,
                                     .post = post,
                                     .is_sent = is_sent,
                                     .receive = receive_message,
                                     .broadcast = broadcast,
                                     .gather = gather,
                                     .describe = describe};
#else
const MpiModule rtlang_mpi_module = {.version = MPI_MODULE_VERSION};
#endif
