// A session: the state behind rt_session, private to src/api.
//
// SPDX-License-Identifier: MIT
#ifndef API_SESSION_H
#define API_SESSION_H

#include <stdatomic.h>
#include <stdbool.h>

#include "base/array.h"
#include "base/diag.h"
#include "base/intern.h"
#include "base/library.h"
#include "base/limits.h"
#include "base/source.h"
#include "base/text.h"
#include "eval/eval.h"
#include "forward/forward.h"
#include "image/image.h"
#include "image/picture_reader.h"
#include "render/inspect/overlay.h"
#include "render/render.h"
#include "rtlang/rtlang.h"
#include "rtlang/sharing.h"
#include "scene/scene.h"
#include "share/alone.h"
#include "share/ranks.h"
#include "trace/kept.h"

// Spheres of one array.
typedef struct SessionGroup {
    const char *name; // the source's
    size_t first, count; // Scene.spheres
    uint64_t base;     // of the source
    bool has_gaps;     // there are fewer spheres than elements
    MaterialIndex own; // the first of as many materials, RECORD_NONE: they share
} SessionGroup;

// A statement of the text: where it begins, and how many sources and shapes there were then.
typedef struct FrameStatement {
    uint64_t begin;
    size_t sources;
    uint32_t shapes;
} FrameStatement;

enum { FRAME_NAMES_MOST = 16 };

// Of an animation: what its camera, its lights and its last shapes are read from again, see frames.c.
typedef struct SessionFrames {
    bool is_expected, is_tried, is_lost; // lost: there was no memory for the statements
    size_t source, source_count;         // the scene's text, and all that there were in the end
    ARRAY(FrameStatement) statements;
    char *slice; // owned; NULL: the whole text is read again
    uint32_t kept_shapes; // the scene's first ones, which the slice does not make again
    bool moves_shapes;    // it makes others
    size_t first_shape;   // from there on
    const Scene *reading; // while it is read: what it is added to, and whether …
    uint64_t reading_base;
    uint32_t reading_shapes; // … these were there until that place
    bool is_past, is_in_order;
} SessionFrames;

// Work that other processes share, or that is kept for later: see sharing.c.
typedef struct SessionSharing {
    bool is_on; // rt_set_sharing
    bool is_part;
    int part, parts; // 1 of 1 unless is_part
    char *checkpoint; // all owned; NULL: none is kept
    double seconds;   // between writes
    bool resumes;
    char **joined; // parts that were traced before
    size_t joined_count;
    char *command; // kept in the file
    bool has_store;
    Store store; // of the picture that is traced, or was last
    Alone alone;
    bool has_ranks;
    Ranks ranks;
    bool is_sent;   // the scene came from rank 0, with …
    size_t file_count; // … what tells its files apart
    unsigned char files[DIGEST_BYTES];
    bool has_scene; // each rank has a part of it: see scene_share.c
    bool has_clear; // of which, together, something lets light through
    bool has_read;  // the ranks have ended reading, together
    EvalShare share;
    TileAsking asking;
} SessionSharing;

struct rt_session {
    rt_callbacks callbacks;
    Limits limits;
    bool is_untrusted; // pictures of a scene are PNG
    bool has_readers;  // pictures of other formats are read in a process of their own
    PictureReader reader;
    SourceMap *sources;
    InternTable *names;
    DiagSink diags;
    size_t diags_delivered; // records already handed to the client
    bool has_told_memory;   // that there is none
    bool is_json;           // the form of messages
    bool is_colored; // the text of messages, for a terminal
    rt_trace_form trace_form;
    int trace_digits; // of rt_trace_pixel's numbers; 0: as many as tell them apart
    TextBuffer said;        // in JSON: the scene's own line, not ended yet
    ARRAY(char *) include_paths;
    Library library; // searched after them
    ARRAY(char *) read_folders;
    ARRAY(char *) write_folders;
    ARRAY(EvalDeclaration) declarations; // names are owned
    char *header; // included before the scene; NULL: none; owned
    double clock;
    bool clock_on;
    EvalWorld world;
    bool no_literals;
    bool is_lenient;
    SessionFrames frames;
    char *provenance;                          // the options, in the program's words; NULL: files do not say; owned
    unsigned char scene_digest[DIGEST_BYTES];  // of the scene's text, where it has one
    bool has_digest;
    TextBuffer note; // that was read last
    TextBuffer left_out; // what a lenient evaluation left out
    int load_threads; // 0: as many as the machine has
    int width, height;
    struct {
        int left, top, width, height;
    } crop; // the part of the picture that is traced; of no width: all
    rt_precision precision;
    const char *isa; // of geometry_isa; NULL for the best
    Scene scene;
    bool loaded; // the scene is complete and valid
    bool is_built;  // by calls: rt_begin_scene
    bool is_broken; // a part of it could not be loaded
    bool is_checked, is_viewed; // as a whole since its shapes, since its camera or lights changed
    ARRAY(SessionGroup) groups;
    uint64_t array_bytes; // of all arrays that shapes were read from, as doubles
    GeometryKept kept;  // of the shapes as they are, moved by …
    Vec3 kept_origin;
    size_t past_errors, past_warnings; // of calls before the present one
    unsigned char *png;                // that was asked for last
    bool is_last, is_spent; // it is rendered once, and nothing else will use it; this is done
    Film film;
    struct {
        SamplingOptions sampling;
        rt_method method;
        uint64_t photons;
        rt_precision precision;
        bool is_sampled;
        Rgb sky_light;
        unsigned planes;
    } drawn;       // with which settings
    bool rendered; // the film holds a picture in linear light
    int threads;   // that rendered it
    SamplingOptions sampling;
    int max_trace_level; // 0: the scene's
    rt_method method;
    uint64_t photons; // of the forward methods
    ForwardCounts photon_counts;
    AntialiasOptions antialias; // method 0: none
    bool has_alpha;             // pictures have that channel
    unsigned planes;            // bits of rt_plane
    OverlayOptions overlay;
    bool has_cue_color; // else that of the scene's background
    SamplingError error;
    double seconds_left; // while rendering
    RenderStatistics statistics;
    const char *kernel;
    EvalNames names_declared;
    double parse_seconds, prepare_seconds, trace_seconds, write_seconds;
    SessionSharing sharing;
    atomic_bool cancel;
    TextBuffer dump;
};

// What a picture's file says of how it was made: nothing, but of sampled pictures.
enum { NOTES_MAX = 24 };
typedef struct SessionNotes {
    ImageNote items[NOTES_MAX];
    TextBuffer texts[NOTES_MAX];
    size_t count;
} SessionNotes;
// False when out of memory; session_free_notes is to be called anyway.
bool session_make_notes(const rt_session *session, SessionNotes *notes) RT_MUST_CHECK;
void session_free_notes(SessionNotes *notes);

// Whether errors of single pixels are known.
bool session_has_pixel_errors(const rt_session *session);
// The planes that the rendered picture has.
unsigned session_drawn_planes(const rt_session *session);

// The FilmPlane bits that the wanted planes and alpha take.
unsigned session_film_planes(const rt_session *session);

// Channels of a picture's planes, for a file of it.
typedef struct PlaneChannels {
    ImageChannel items[IMAGE_CHANNELS_MORE];
    int count;
    void *made[IMAGE_CHANNELS_MORE]; // owned
    int made_count;
} PlaneChannels;
// Those of some planes, within a whole picture where that is wanted. False when out of memory; plane_channels_fini is
// to be called anyway.
bool plane_channels_make(const rt_session *session, unsigned planes, bool is_whole, PlaneChannels *out) RT_MUST_CHECK;
void plane_channels_fini(PlaneChannels *channels);

// The picture with alpha as a fourth channel, its colours multiplied with it or not; released with image_fini. False when
// out of memory.
bool session_picture_with_alpha(const rt_session *session, bool is_multiplied, Image *image) RT_MUST_CHECK;

// Hands new diagnostics to the client.
void session_deliver(rt_session *session);

// The same for what the scene itself says.
void session_say(rt_session *session, rt_stream stream, const char *text, size_t length);

// Delivers, and turns what was reported into a status: RT_OK when `fine`, else the class of the first error.
rt_status session_status(rt_session *session, bool fine);
// Says that memory is exhausted, without taking any; RT_FAULT_LIMIT.
rt_status session_no_memory(rt_session *session);

// Adds to the message that a scene is not found what in its folder has nearly that name.
void session_suggest_scene(rt_session *session, const char *path);

// Calls work(session, argument) where the stack bears all that the limits of nesting allow, whatever the caller's thread
// has; returns what that returns.
rt_status session_run_deep(rt_session *session, rt_status (*work)(rt_session *session, void *argument), void *argument);

// Reports what became of writing `path`, and turns it into a status.
rt_status session_image_fault(rt_session *session, ImageStatus status, const char *path, const ImageError *error);

static inline bool sampling_is_wanted(const SamplingOptions *sampling)
{
    return sampling->is_adaptive || sampling->samples > 1.0;
}

// What the client wants of samples, and where it says nothing, what the camera of the loaded scene does: a lens wants
// rays.
static inline SamplingOptions session_sampling(const rt_session *session)
{
    SamplingOptions sampling = session->sampling;
    sampling.no_pixel_errors = sampling.no_pixel_errors && !(session->planes & RT_PLANE_ERROR);
    if (sampling.samples == 0.0 && !sampling.is_adaptive && session->scene.camera.blur_samples > 1) {
        const Camera *camera = &session->scene.camera;
        sampling.samples = camera->blur_samples;
        sampling.stop = (SamplingStop){camera->blur_variance, camera->blur_confidence, camera->blur_least};
    }
    return sampling;
}

static inline bool session_is_sampled(const rt_session *session)
{
    SamplingOptions sampling = session_sampling(session);
    return sampling_is_wanted(&sampling);
}

// How ranks read a scene of which each keeps a part; NULL: this one has all of it.
const EvalShare *session_scene_reading(rt_session *session);
// This rank has read the scene, or could not. Called by all ranks; false: one of them has failed meanwhile, reported.
bool session_scene_read(rt_session *session);
// What each rank has, `length` bytes, one after the other; to be freed. Called by all ranks.
void *session_scene_gather(rt_session *session, const void *own, size_t length);
// Reports of the scene what only all its spheres together show; called by all ranks.
bool session_scene_report(rt_session *session);
// The greatest of all ranks' budgets; {0} where the scene could not be loaded.
rt_status session_scene_budget(rt_session *session, rt_budget own, rt_budget *greatest);
// Of a scene of which each rank has a part: what refuses it and what all ranks must know of it. Called by all ranks once
// it is loaded; false: reported.
bool session_scene_agree(rt_session *session);
// The scene put near the origin as scene_recentre does, by all its spheres; called by all ranks.
Vec3 session_scene_recentre(rt_session *session);
// What rays ask of a prepared scene.
void session_scene_ask(rt_session *session, const Prepared *prepared);

// About how many rays go through the pixels of the next picture.
double session_camera_rays(const rt_session *session);

// The size of what is traced.
static inline int session_film_width(const rt_session *session)
{
    return session->crop.width ? session->crop.width : session->width;
}

static inline int session_film_height(const rt_session *session)
{
    return session->crop.width ? session->crop.height : session->height;
}

// Reads the pictures that a scene uses; reports the first that cannot be.
bool session_load_pictures(rt_session *session, Scene *scene);

// Evaluates a source and adds what it gives to the scene. `version` is that of the language at its beginning, 0: none.
bool session_evaluate(rt_session *session, Source *source, Scene *scene, double version);

// A call begins on a session that is built by calls: what was reported before is forgotten. False when it may not be made.
bool session_begin(rt_session *session) RT_MUST_CHECK;
// frames.c
void session_note_statement(void *client, Span span);
void session_note_slice(void *client, Span span);
void session_frames_fini(rt_session *session);
// Whether a loaded scene may be traced with the camera and lights that it has now, and with shapes that are new, too.
bool session_check_frame(rt_session *session, bool has_new_shapes) RT_MUST_CHECK;
// Whether a scene that is built by calls is one that may be traced; looks through it when it has changed.
bool session_is_whole(rt_session *session) RT_MUST_CHECK;

// Opens a scene file; reports why not.
bool session_open(rt_session *session, const char *path, Source **source);

// Whether the picture, and what the loaded scene needs beside it, fit the memory that may be taken; reports when not.
bool session_memory_suffices(rt_session *session);

// Opens the files of what is shared, if anything is; reports what cannot be had.
rt_status session_sharing_begin(rt_session *session) RT_MUST_CHECK;
// For RenderOptions; NULL: all is traced here and nothing kept.
const TileShare *session_sharing_table(const rt_session *session);
// Why rendering ended with RENDER_NOT_SHARED.
void session_sharing_report(rt_session *session);
void session_sharing_fini(SessionSharing *sharing);

// How many threads look at what is loaded.
int session_load_threads(const rt_session *session);

// What the scene may take, by the limits: more for more text, and more for more numbers in arrays.
size_t session_memory_granted(const rt_session *session);

// The film from the scene's working space to linear light. Legacy files stay as they are.
void session_film_to_linear(const Settings *settings, Film *film);

#endif
