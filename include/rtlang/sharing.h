/* A picture on which several processes work: parts in files, and ranks of MPI.
 *
 * SPDX-License-Identifier: MIT */
#ifndef RTLANG_SHARING_H
#define RTLANG_SHARING_H

#include "rtlang/rtlang.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A picture on which several processes work, or one that is stopped and continued. The bytes of its file are those of
 * one run. */
typedef struct rt_sharing {
    int part, parts;          /* trace this part of the picture alone, from 1, of so many; 0, 0: all of it */
    const char *checkpoint;   /* a file that is made, and has what is done so far; NULL: none */
    double seconds;           /* after as many it is written to, at the next tile that is done; 0: at each tile */
    int resume;               /* not 0: begin with what the checkpoint has, if there is one */
    const char *const *joined; /* files of all parts, which are not traced again */
    size_t joined_count;
    const char *command; /* a text that the files keep, for rt_read_command; or NULL */
} rt_sharing;
/* For the calls of rt_render that follow; NULL: nothing is shared any more. Wants rt_set_provenance before the scene is
 * loaded: what files hold of another scene, version or provenance is not taken. Of a part rt_write_part can be asked,
 * and nothing else of its picture. RT_FAULT_USAGE when numbers are no part, or a part is to be joined, too. */
RT_API rt_status rt_set_sharing(rt_session *session, const rt_sharing *sharing);
/* After rt_render of a part. */
RT_API rt_status rt_write_part(rt_session *session, const char *path);
/* What rt_sharing.command was when a part or checkpoint was made. *command is valid until the next call on the
 * session. */
RT_API rt_status rt_read_command(rt_session *session, const char *path, const char **command);

/* Ranks of MPI, which share the tiles of each picture that is rendered from here on: each of them loads the same scene
 * and makes the same calls, and rank 0 has the picture. Loads the module for MPI, which begins it once a process. */
RT_API rt_status rt_join_ranks(rt_session *session, int *rank, int *ranks);
/* Each rank keeps a part of the spheres of the scenes that are loaded from here on, and asks the others for what its
 * rays meet: for scenes that are larger than a machine. RT_FAULT_USAGE without ranks, or once a scene is loaded. */
RT_API rt_status rt_share_scene(rt_session *session);
/* rt_load_file by rank 0 alone, which sends the scene to the others; called by all. Not with rt_share_scene. */
RT_API rt_status rt_load_file_of_ranks(rt_session *session, const char *path);
/* After the scene is loaded, or could not be, with `status`; called by all ranks. RT_OK where each is ready to render
 * the same picture; else what the worst has, and rank 0 reports the first rank that is not, *first. */
RT_API rt_status rt_agree_with_ranks(rt_session *session, rt_status status, int *first);
/* The worst status of all ranks; called by all. */
RT_API rt_status rt_worst_of_ranks(rt_session *session, rt_status status);
/* The end, for all; and at once, for one that cannot continue while others wait for it. No call on ranks may follow. */
RT_API void rt_leave_ranks(rt_session *session);
RT_API void rt_stop_ranks(rt_session *session, int code);

#ifdef __cplusplus
}
#endif

#endif
